"""A tree that is made again for other numbers is the one that lark makes, place by place."""

from __future__ import annotations

import random
import re
from typing import Any

import pytest
from lark import Token, UnexpectedInput
from seeds_kit import some

import gcxform as gx
from gcxform.flow.translated import translated
from gcxform.flow.tree_shapes import TreeShapes
from gcxform.modal.state import Reading
from gcxform.plugin.registry import default_registry
from gcxform.syntax import grammar_cache
from gcxform.syntax.source import Source

LINES = {
    "siemens_computed": (
        *("R1=0.5", "R10=R1+2.5*(R2-1)", "N10 G1 X=R1+1 Y2.5 Z-3", "N10.5 X=1", "X=10/2 Y5 F100"),
        *("R1=5EX3", "R1=-R2", "IF R1>=2 GOTOF N20", 'MSG("depth 5")', "DEF REAL A1=2, B[3]"),
        *(
            "FOR R1=1 TO 10",
            "A1[2,3]=SET(1,2.5,.5)",
            "X=AC(5+R1) CR=2",
            "P5",
            "L10 P3",
            "/1 G1 X=R2",
        ),
        *("/1 G1 X=R2", "G1 X0.000 Y0.0000 Z=R1 ;note 5", "'H1F'", "R1='B101'+3", "G4 F=R1*2"),
    ),
    "fagor_computed": (
        *("P1=2", "XP1 Y[P1*2.5+1] Z-3", "N10 P1=3", "N10: P1=P2+.5", "$IF P1 > 2", "G1 X10I Y=5"),
        *("$FOR P1=1,10,2", "$GOTO N10", "P1=SIN[30.5]*2", "V.G.TOR[5]", "#CALL 10 A5", "X-P1"),
    ),
    "heidenhain_computed": (
        *(
            "Q1 = 5 + Q2 * 3.5",
            "Q10=2,5*SIN 30",
            "FN 0: Q5 = +10",
            "FN 9: IF +Q1 EQU +3 GOTO LBL 5",
        ),
        *("FN 1: Q1 = -Q2 + +5.5", "Q1 = ( 2 + 3 ) ^ 2", "FN 4: Q1 = +4 DIV +Q2", "Q1=PI*5%3"),
    ),
}
NUMBERS = ("0", "5", "12", "345", "1.5", "2.", ".25", "10", "007", "0.000", "1EX2", "3EX-1", "20,5")


def told(node: Any) -> object:
    """Return a tree with all of its places."""
    if isinstance(node, Token):
        return node.type, str(node), node.start_pos
    meta = node.meta
    place = None if meta.empty else (meta.start_pos, meta.end_pos)
    return str(node.data), place, [told(child) for child in node.children]


@pytest.mark.parametrize("grammar", LINES)
def test_trees_are_larks(grammar: str) -> None:
    lark = grammar_cache.grammar("gcxform_grammars", grammar)
    shapes, draw = TreeShapes(lark), random.Random(7)
    read = 0
    for _ in range(len(some(20_000)) // 20):
        line = draw.choice(LINES[grammar])
        much = draw.choice((0.2, 1.0))
        text = re.sub(
            r"[0-9]+(?:\.[0-9]*)?|\.[0-9]+",
            lambda n: draw.choice(NUMBERS) if draw.random() < much else n[0],  # noqa: B023
            line,
        )
        try:
            tree = told(lark.parse(text))
        except UnexpectedInput:
            with pytest.raises(UnexpectedInput):
                shapes.parse(text)
            continue
        assert told(shapes.parse(text)) == tree, text
        read += 1
    assert read > 100
    assert len(shapes._makers) < read


@pytest.mark.parametrize(
    ("name", "lines", "blocks"),
    [
        (
            "siemens",
            [
                "G90 G1 F9 X=5 Z=R1",
                "X=15 Z=R1",
                "X=-.5 Z=R1",
                "X=5 Z=R12",
                "X7 Z=R12 ;to 5 mm",
                "X7 ;to 5 mm",
                "X8 ;to 6 mm",
            ],
            [
                "G90 G1 X5 Z2 F9",
                "X15 Z2",
                "X-0.5 Z2",
                "X5 Z3",
                "X7 Z3 (to 5 mm)",
                "X7 (to 5 mm)",
                "X8 (to 6 mm)",
            ],
        ),
        ("heidenhain", ["9 * - 12 mm", "10 * - 12 mm", "110 * - 3"], ["(12 mm)", "(12 mm)", "(3)"]),
    ],
)
def test_what_is_no_number_of_a_line_is_of_its_shape(
    name: str, lines: list[str], blocks: list[str]
) -> None:
    head = {"siemens": ["R1=2 R12=3"], "heidenhain": ["0 BEGIN PGM A MM"]}[name]
    tail = {"siemens": ["M30"], "heidenhain": ["999 END PGM A MM"]}[name]
    text = "\n".join([*head, *lines, *tail, ""]).encode()
    dialect: type[gx.Dialect] = default_registry().dialect(name)
    found = translated(Source.of_bytes(text, "a"), dialect, Reading()).text.decode().splitlines()
    assert found[-1 - len(lines) : -1] == blocks
