"""A fault in each table of the shipped dialects, made by rule: `check_dialect` finds every one.

The faults are those that write wrong programs: two acts that are merged, two that are swapped, a
word that nobody hears, a reset that is missing, a wrong unit. What each has to say is the kit's
affair; `tests/test_planted_dialects.py` asks for the sentences.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations
from typing import Any

import pytest

import gcxform as gx
from gcxform import vocabulary as v
from gcxform.dialect.codes import Effect
from gcxform.plugin.registry import default_registry
from gcxform.testing import check_dialect
from gcxform.testing.tables import check_declared

DIALECTS = default_registry().dialects
NAMES = ("fanuc", "haas", "linuxcnc", "grbl")
Kind = type[gx.Dialect]


def changed(base: Kind, **values: Any) -> Kind:
    return type("Acme", (base,), {"__doc__": "Acme.", "name": "acme", **values})


ACTS = (
    ("G43", "G49"),
    ("G43.1", "G49"),
    ("G52", "G92"),
    ("G28", "G53"),
    ("G68", "G69"),
    ("G54", "G52"),
    ("G92", "G10"),
    ("G90", "G20"),
    ("G17", "G93"),
    ("G28", "G28.1"),
    ("G92", "G92.1"),
    ("G51.1", "G50.1"),
    ("G41", "G49"),
    ("G4", "G53"),
)
"""Pairs of codes whose acts are two."""


def merged_and_swapped(base: Kind) -> Iterator[tuple[str, Kind]]:
    table = base.codes
    for one, two in ACTS:
        if one in table and two in table and table[one] != table[two]:
            yield (
                f"{one} and {two} swapped",
                changed(base, codes={**table, one: table[two], two: table[one]}),
            )
            yield f"{two} as {one}", changed(base, codes={**table, two: table[one]})


def unheard(base: Kind) -> Iterator[tuple[str, Kind]]:
    """Take from codes the word by which they say which one is meant."""
    for name, code in base.codes.items():
        words = {"length": "H", "work": "P", "set-work": "LP", "rotate": "R", "scale": "P"}
        for letter in words.get(code.act, "D" if code.group == "cutter-comp" else ""):
            if letter in code.takes and code.effect is not Effect.BARRIER:
                less = replace(code, takes=code.takes.replace(letter, ""))
                yield f"{name} without {letter}", changed(base, codes={**base.codes, name: less})


def units(base: Kind) -> Iterator[tuple[str, Kind]]:
    for letter, unit in base.point_rule.dwell.items():
        for factor in (1000.0, 0.001, 60.0):
            wrong = {**base.point_rule.dwell, letter: unit * factor}
            rule = replace(base.point_rule, dwell=wrong)
            yield f"G4 {letter} in {unit * factor:g} s", changed(base, point_rule=rule)
    for name, code in base.codes.items():
        if code.lengths:
            blind = replace(code, lengths="")
            yield f"{name} without lengths", changed(base, codes={**base.codes, name: blind})


def resets(base: Kind) -> Iterator[tuple[str, Kind]]:
    rule = base.program_rule
    for group in rule.resets_at_end:
        less = {k: c for k, c in rule.resets_at_end.items() if k != group}
        other = replace(rule, resets_at_end=less)
        yield f"the end leaves the {group}", changed(base, program_rule=other)
    ends = {"G40": "G41", "G49": "", "G80": "G81", "G69": "", "G15": "", "G50": "", "G50.1": ""}
    for name, begins in ends.items():
        if name in base.codes and (not begins or begins in base.codes):
            table = {k: c for k, c in base.codes.items() if k != name}
            yield f"no {name}", changed(base, codes=table)


def m_codes(base: Kind) -> Iterator[tuple[str, Kind]]:
    table = base.m_codes
    for one, two in combinations((0, 2, 3, 5, 8, 9), 2):
        if table[one] != table[two]:
            other = {**table, one: table[two], two: table[one]}
            yield f"M{one} and M{two} swapped", changed(base, m_codes=other)
    for one, two in ((0, 2), (3, 8), (3, 9)):
        yield f"M{two} as M{one}", changed(base, m_codes={**table, two: table[one]})


RULES = (merged_and_swapped, unheard, units, resets, m_codes)
FAULTS = [
    (f"{name}: {said}", kind)
    for name in NAMES
    for rule in RULES
    for said, kind in rule(DIALECTS[name])
]


def found(kind: Kind) -> bool:
    """Whether the kit finds something; what the tables alone do not show costs programs."""
    for check in (check_declared, check_dialect):
        try:
            check(kind)
        except AssertionError:
            return True
    return False


def test_every_fault_is_found():
    assert len(FAULTS) > 150
    missed = [said for said, kind in FAULTS if not found(kind)]
    assert not missed


# --- what a plugin says of itself excuses no merging ---


def okuma(base: Kind, code: gx.Code) -> Kind:
    return changed(
        base,
        codes={**base.codes, "G15": code},
        differs={"G15": "a manual", "G16": "a manual"},
    )


@pytest.mark.parametrize("base", ["fanuc", "grbl"])
@pytest.mark.parametrize(
    "code",
    [
        v.frame("frame", "work"),
        v.inert("frame", "H"),
        v.inert("work", "H"),
        v.inert("non-modal", "H"),
    ],
)
def test_two_work_offsets_are_never_one(base, code):
    """Okuma's G15 H1 and G15 H2: H is heard, or the table does not pass."""
    with pytest.raises(AssertionError, match="G15"):
        check_dialect(okuma(DIALECTS[base], code))


def test_work_offsets_by_h_are_two():
    kind = okuma(gx.Dialect, v.frame("frame", "work", "H"))
    check_dialect(kind)
    path = gx.read(b"G90 G21 G94 G17\nG15 H1\nG0 X1 Y1 Z1\nG15 H2\nG0 X1 Y1 Z1\nM30\n", kind).path
    assert [path.frames[k].work for k in path.frame] == ["G15 H1", "G15 H2"]
