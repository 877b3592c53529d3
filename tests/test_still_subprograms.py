"""Which subprograms by themselves move nothing, so that a compensation may leave them."""

from __future__ import annotations

import pytest

from gcxform.flow.subprogram_file import moves_nothing
from gcxform.plugin.registry import default_registry
from gcxform.syntax.source import Source

STILL = ("M6", "G54", "G43 H1", "M3 S#2", "G4 P1", "#1=#5220", "#1=[#2+1]")
GOES = {
    "linuxcnc": (
        "X1",
        "G2 I5",
        "G28",
        "G28.1",
        "G53 G0 Z#1",
        "G92 X0",
        "G10 L20 P1 Z0",
        "#1=#5422",
        "#1=#<_x>",
        "#1=#[5400+20]",
        "#1=##2",
        "#1=#5061",
        "(DEBUG, #5420)",
        "G#1",
        "M208",
        "M98 P100",
        "o<other> call",
        "o[#1] call",
        "o<l> if [#5420 GT 1]\no<l> endif",
    ),
    "fanuc": ("M98 P1", "G65 P9001 A1.", "G28 Z0.", "G28", "#1=#5041", "M98 P#1", "N1 M97 P1"),
}
NAMED = [(dialect, line) for dialect, lines in GOES.items() for line in lines]
FRAME = {"linuxcnc": "o<a> sub\n{}\no<a> endsub\nM2\n", "fanuc": "O7\n{}\nM99\n"}


def still(dialect: str, line: str, codes: tuple[str, ...] = ()) -> bool:
    text = FRAME[dialect].format(line).encode()
    return moves_nothing(Source.of_bytes(text), default_registry().dialect(dialect), codes)


@pytest.mark.parametrize("line", STILL)
def test_nothing_moves(line: str) -> None:
    assert still("linuxcnc", line)
    assert still("fanuc", line)


@pytest.mark.parametrize(("dialect", "line"), NAMED)
def test_something_moves_or_may(dialect: str, line: str) -> None:
    assert not still(dialect, line)


def test_codes_that_call_on_this_machine() -> None:
    """What the machine file says that a code calls is another program."""
    assert still("fanuc", "M50")
    assert not still("fanuc", "M50", ("M50",))


def test_calls_within_the_file() -> None:
    """All lines of the file are looked at, so it may call what it defines."""
    assert still("linuxcnc", "o1 call\no<a> endsub\no1 sub\nM5\no1 endsub\no<b> sub")
