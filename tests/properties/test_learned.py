"""Lines that are learnt become what they become one by one, in every language that learns."""

from __future__ import annotations

import random
import re
from collections.abc import Callable, Sequence
from typing import Any

import pytest
from seeds_kit import LONG, shares

import gcxform as gx
from gcxform.flow import split_numbers, translation
from gcxform.flow.translated import Translated, translated_so_far
from gcxform.machine.machine import Tool
from gcxform.modal.state import Reading
from gcxform.plugin.registry import default_registry
from gcxform.syntax.source import Source

TOOLS = {n: Tool(length=10.0 * n, radius=1.0) for n in range(1, 4)}
READINGS = [
    Reading(stays=stays, units="mm", tools=TOOLS, start=start)
    for stays in (False, True)
    for start in ({}, {"X": 0.0, "Y": 0.0, "Z": 5.0, "A": 0.0})
]
SIEMENS = (
    *("G{m} X{a} Y{b}", "G1 X{a} Y{b} Z=R1", "X{a} Y{b} Z{c}", "X={a} Y={b}", "N{n} X{a}"),
    *("N{n} G1 X{a} Y{b} F{f}", "G3 X={a} Y={b} CR={r}", "G2 X{a} Y{b} I{c} J{r}", "CR={r} X{a}"),
    *("G2 X{a} Y{b} AR={f}", "G{d}", "G{d} X{a}", "X=IC({a})", "X=AC({a}) Y{b}", "A=DC({f})"),
    *("A{f} X{a}", "R1={c}", "R{k}=R1+{a}", "X=R1+{a} Y{b}", "X=R1 Y=R{k} F{f}", "TRANS X{a}"),
    *("ATRANS Y{b}", "ROT RPL={f}", "TRANS", "T{k}", "M6", "T{k} M6", "D1", "D0", "M{k}", "S{f}"),
    *("S{f} M3", "G54", "G55", "G500", "G17", "G18", "G64", "G4 F{r}", "G41 X{a}", "G40", "F{f}"),
    *("; note {n}", "X{a} ; to {n}", 'MSG("{n}")', "STOPRE", "MCALL CYCLE81(5,0,2,-{r})", "MCALL"),
    *("G94", "G95", "G93", "G710", "G700", "AP={f} RP={r}", "G111 X{a} Y{b}", "G110 X{a}", "SOFT"),
    *("SUPA G0 Z{a} D0", "X{a} X{b}", "G1 G2", "Q{a}", "IF R1>{a} GOTOF E{k}", "$AC_X={a}", "RET"),
    *("R{k}=-(R1*2+{r})/4", "X={r}+R1*2 Y=-R2", "R{k}=SIN({f})*R2", "X=R2/R3", "R1={a} R2=R1"),
    *("G1 X=R1 R2={r}", "N{n} X=R1 ; c {n}", "Z=AC(R1)", "X=IC(R2*2)", "R{k}=R{k}+1", "F=R1*10"),
    *("R0{k}={a}", "X=R1 Y={a}", "R{k}={n}", "X=MAXVAL(R1,{r})", "R{k}=ROUND(R1)", "r1=r2 ; {a}"),
    *("R1=R2 R1={r}", "R1={r} M8", "X=R1 M8", "X=R1EX2", "R1=2EX1", "N{n} R1={r}", "/R1={r}"),
    *("X{a}M8", "n{n} g1 x{a}", "TRAORI", "TRAFOOF", "X=R9", "R9=$A_IN[1]", "CYCLE800({a})", "G60"),
)
LOOPS = (("FOR R{k}=1 TO {k}", "ENDFOR"), ("WHILE R1<{k}", "ENDWHILE"), ("IF R1>={a}", "ENDIF"))
HEAD = ("G90 G17 G710 G94 F100", "R1=1 R2=2 R3=0", "G0 X0 Y0 Z5")


def number(pick: random.Random) -> str:
    return f"{pick.uniform(-30, 30):.{pick.randint(0, 4)}f}".replace(
        "-0.", pick.choice(("-0.", "-."))
    )


def filled(line: str, pick: random.Random) -> str:
    return line.format(
        **{each: number(pick) for each in "abc"},
        r=round(pick.uniform(0, 40), 2),
        f=pick.randint(1, 400),
        n=pick.choice((pick.randint(1, 9999), number(pick).lstrip("-"))),
        k=pick.randint(1, 3),
        m=pick.choice(("0", "1", "01", "1", "2")),
        d=pick.choice((90, 91)),
    )


def siemens(seed: int) -> str:
    """Return a program of a few lines over and over, with other numbers."""
    pick = random.Random(seed)
    few = [*pick.sample(SIEMENS, pick.randint(2, 9)), *SIEMENS[:4]]
    lines = [*HEAD][seed % 4 == 3 :]
    for _ in range(pick.randint(5, 50)):
        if pick.random() < 0.05:
            first, last = pick.choice(LOOPS)
            lasting = [line for line in few if not line.startswith("R")]  # loops that end
            inner = [filled(pick.choice(lasting), pick) for _ in range(pick.randint(1, 4))]
            step = ["R1=R1+1"] if "WHILE" in first else []
            lines += [filled(first, pick), *inner, *step, last]
        rare = pick.random() < 0.04
        turns = [pick.choice(SIEMENS if rare else few), pick.choice(few)]
        count = pick.randint(3, 40) if pick.random() < 0.1 else 1
        kinds = pick.randint(1, 2)
        lines += [filled(turns[k % kinds], pick) for k in range(count)]
    return "\n".join([*lines, "M30", ""])


def found(text: str, name: str, reading: Reading) -> Sequence[object]:
    """Return all that a translation says."""
    dialect = default_registry().dialect(name)
    made: Translated
    made, refused = translated_so_far(
        Source.of_bytes(text.encode("latin-1"), "a"), dialect, reading
    )
    undecided = made.undecided.lost if made.undecided else {}
    said = [str(each) for each in refused.diagnostics] if refused else []
    origin, visits = made.origin.tolist(), made.visits.tolist()
    return (
        made.text.decode("latin-1").splitlines(),
        origin,
        visits,
        undecided,
        said,
        [*made.assumed],
    )


def said_alike(text: str, reading: Reading) -> Sequence[str]:
    """Return the blocks of a program, which are those without anything learnt."""
    blocks, *others = found(text, "siemens", reading)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(translation, "Learned", lambda _: None)
        assert found(text, "siemens", reading) == (blocks, *others), text
    assert isinstance(blocks, list)
    return blocks


@shares(100_000 if LONG else 100, 100)
def test_programs_are_translated_alike(seeds: range) -> None:
    learnt = 0
    for seed in seeds:
        text, reading = siemens(seed), READINGS[seed % len(READINGS)]
        learnt += len(said_alike(text, reading))
    assert learnt > 5 * len(seeds)


@pytest.mark.parametrize(
    ("lines", "block"),
    [
        (("X2 Y2", "X3 Y3", "X4 Y4", "X=IC(1) Y5"), "X5 Y5"),
        (("G700", "X1 Y1", "G700", "X2 Y2", "G700", "X3", "G3 X7 CR=2"), "G3 M9000"),
        (
            (*("X1 Y2", "X2") * 8, "X4 Y7", *(f"X{k}" for k in range(5, 30)), "X30 Y=IC(1)"),
            "X30 Y8",
        ),
        ((*(f"X{k} Y{k}" for k in range(5, 30)), "X=IC(1) Y3"), "X30 Y3"),
        ((*("X2", "X1 Y2") * 8, "X4 Y7", "X9", "X=IC(1) Y3"), "X10 Y3"),
        ((*("X1 Y2", "X2") * 8, "X1 Y2", "X4 Y7", "X9", "X=IC(1) Y3"), "X10 Y3"),
        ((*("G700", "X1 Y1", "G700", "X3") * 9, "G3 X7 CR=2"), "G3 M9000"),
        ((*("G700", "X3", "G700", "X1 Y1") * 9, "G3 X7 Y1 CR=7"), "G3 X7"),
        (("G3 X=3 Y=1 CR=2", "G1 X4", "G3 X=6 Y=1 CR=2", "G1 X=R9", "G3 X=7 Y=1 CR=2"), "G3 M9000"),
    ],
)
def test_where_axes_are_is_known_behind_lines_that_were_learnt(
    lines: tuple[str, ...], block: str
) -> None:
    text = "\n".join(["G90 G17 G1 F9 X1 Y1", *lines, "M30", ""])
    blocks = found(text, "siemens", READINGS[2 if "CR" in text else 0])[0]
    assert isinstance(blocks, list)
    assert blocks[-2].startswith(block)


@pytest.mark.parametrize(
    "line",
    [
        lambda k: f"X{k} S{100 + k // 20}",
        lambda k: f"N{k if k < 20 else '.5'} X{k}",
        lambda k: f"G{90 + k // 20} X{k}",
        lambda k: f"G{k // 20} X{k}",
        lambda k: f"G{k % 2} X{k}",
        lambda k: f"F{k} X1",
        lambda k: f"G{700 + 10 * (k // 20)} X{k}",
        lambda k: f"X={k} Y=R1" if k < 20 else f"X={-k} Y=R2",
        lambda k: f"X-{k} Y=-R1",
        lambda k: f"R1={k}" if k % 3 else f"G1 X=R1 Y{k}",
        lambda k: f"G91 X{k}",
        lambda k: f"X{k} Y+{k} Z=R1+{k}",
    ],
)
def test_lines_of_one_shape_in_a_row(line: Callable[[int], str]) -> None:
    """Codes, digits and states that change in a row of lines that are known."""
    known = [text for _ in range(9) for text in ("G1 X1", "X2", "G90", "X3 Y1")]
    rows = [*known, "X2", "G90", *map(line, range(30)), "X2", "G90", *map(line, range(15, 30))]
    text = "\n".join(["G90 G17 G1 F9 X1 Y1 Z1", "R1=1.5 R2=2", *rows, "M30", ""])
    for reading in READINGS:
        assert said_alike(text, reading)


def test_what_a_user_gives_a_value_is_a_variable_in_lines_that_are_compiled_too() -> None:
    reading = Reading(units="mm", parameters={"<F>": 3.0})
    text = "\n".join(["G90 G17 G1 F9 X1 Y1", "R1=2", *(" F=30 ", "F=R1*10") * 9, "M30", ""])
    assert not [block for block in found(text, "siemens", reading)[0] if "F20" in block]


def test_a_compiled_line_does_its_assignments_in_turn() -> None:
    lines = [line for k in range(9) for line in (f"R1={k} R2=R1", f"X{k}.5", "X=R2")]
    text = "\n".join(["G90 G17 G1 F9 X1 Y1", *lines, "M30", ""])
    assert found(text, "siemens", READINGS[0])[0][2:20:2] == [f"X{k}" for k in range(9)]


@shares(1_000_000 if LONG else 4_000, 1_000_000 if LONG else 4_000)
def test_texts_are_split_as_an_expression_does(
    seeds: range, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(split_numbers, "SHORT", 0)
    pieces = (*"0019.,+-GmX \n\t\xe9", "XY", "=", "R", "10.", "-.5", "1.25", "1,5", "G1X", "0" * 17)
    for seed in seeds:
        pick = random.Random(seed)
        text = "".join(pick.choices(pieces, k=pick.randint(0, 14)))
        for number in split_numbers.CLASSES:
            found = re.compile(f"({number.pattern})").split(text)
            split = split_numbers.split_at_numbers(text, "#", number)
            assert split == ("#".join(found[::2]), found[1::2]), (text, number)


class Hidden(default_registry().dialect("siemens").translator):  # type: ignore[misc]
    """A translator that looks at what is not keyed."""

    def blocks(self, items: Sequence[gx.Item]) -> list[str]:
        """Return blocks with how many lines there were."""
        return [f"{block} P{self.visit}" for block in super().blocks(items)]


def test_nothing_is_learnt_by_what_is_not_keyed() -> None:
    lines = ["G90 G1 F9 X1", "X2", "X3", "X4", ""]
    translator = Hidden(lines, "a", default_registry().dialect("siemens"), Reading())
    assert [*translator.run()][-1][1][-1] == "X4 P4"


@pytest.mark.parametrize("reading", READINGS[1::2], ids=["translated", "stays"])
def test_most_lines_of_a_program_are_learnt(
    monkeypatch: pytest.MonkeyPatch, reading: Reading
) -> None:
    """One value that every line looks at, and that is not keyed, would cost all of it."""
    translator = default_registry().dialect("siemens").translator
    assert translator is not None
    one_by_one: list[int] = []

    def counted(self: Any, items: Sequence[gx.Item]) -> object:
        one_by_one.append(self.line)
        return blocks(self, items)

    blocks = translator.blocks
    monkeypatch.setattr(translator, "blocks", counted)
    lines = [f"G1 X{k} Y{k % 7}.5\nG3 X={k + 5} Y{k % 7}.5 CR=3" for k in range(100)]
    found("\n".join([*HEAD, *lines, "M30", ""]), "siemens", reading)
    assert len({*one_by_one}) < 20
