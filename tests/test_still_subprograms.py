"""Which subprograms by themselves move nothing, so that a compensation may leave them."""

from __future__ import annotations

from pathlib import Path

import pytest

from gcxform.flow.lookup import Folders
from gcxform.flow.subprogram_file import Still
from gcxform.plugin.registry import default_registry
from gcxform.syntax.source import Source

STILL = ("M6", "G54", "G43 H1", "M3 S#2", "G4 P1", "#1=#5220", "#1=[#2+1]")
LEFT = {
    "M208": "M208, which the machine has of its own",
    "M75 P1 Q#2": "M75, which the machine has of its own",
    "o<other> call [#1]": "o<other>, which is not at hand",
    "o12 call": "O12, which is not at hand",
}
RAPIDS = ("G53 G0 Z#1", "G0 G53 X1 Y2", "G28", "G30", "G91 G28 Z0", "G28 G91 X0 Y0")
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
        "M208 X1",
        "M97 P1",
        "M#1",
        "M[200+8]",
        "M208 M209",
        "G208",
        "G53 G1 Z0 F100",
        "G53 Z0",
        "G28 Z0",
        "G91 G28 Z1",
        "G91 G28 Z#1",
        "G91 G28 Z0 G49",
        "G53 G0 Z#5422",
        "M98 P100",
        "o[#1] call",
        "o<l> if [#5420 GT 1]\no<l> endif",
    ),
    "fanuc": ("M98 P1", "G65 P9001 A1.", "G28 Z0.", "G28", "#1=#5041", "M98 P#1", "N1 M97 P1"),
}
NAMED = [(dialect, line) for dialect, lines in GOES.items() for line in lines]
FRAME = {"linuxcnc": "o<a> sub\n{}\no<a> endsub\nM2\n", "fanuc": "O7\n{}\nM99\n"}


def but_for(
    dialect: str,
    line: str,
    codes: tuple[str, ...] = (),
    folder: Path | None = None,
    rapids: bool = False,
) -> list[str] | None:
    kind = default_registry().dialect(dialect)
    folders = Folders([folder] if folder else [], kind.flow_rule.lookup)
    text = FRAME[dialect].format(line).encode()
    return Still(kind, codes, folders, rapids).but_for(Source.of_bytes(text))


def still(dialect: str, line: str, codes: tuple[str, ...] = ()) -> bool:
    return but_for(dialect, line, codes) == []


@pytest.mark.parametrize("line", STILL)
def test_nothing_moves(line: str) -> None:
    assert still("linuxcnc", line)
    assert still("fanuc", line)


@pytest.mark.parametrize(("dialect", "line"), NAMED)
def test_something_moves_or_may(dialect: str, line: str) -> None:
    assert but_for(dialect, line) is None
    assert line in RAPIDS or but_for(dialect, line, rapids=True) is None


@pytest.mark.parametrize(("line", "what"), LEFT.items())
def test_what_is_not_of_the_file(line: str, what: str) -> None:
    assert but_for("linuxcnc", line) == [what]


@pytest.mark.parametrize("line", RAPIDS)
def test_rapids_to_points_of_the_machine(line: str) -> None:
    """They stay where all that is done leaves them to the machine, and there alone."""
    assert but_for("linuxcnc", line, rapids=True) == ["rapids to points of the machine"]
    assert but_for("linuxcnc", line) is None


def test_a_file_that_is_called_and_at_hand(tmp_path: Path) -> None:
    """It is looked at as well, and what it calls, which may be what calls it."""
    other = tmp_path / "other.ngc"
    other.write_text("o<other> sub\no<b> call\no<other> call\no<third> call\no<other> endsub\n")
    third = tmp_path / "third.ngc"
    third.write_text("o<third> sub\nM5\no<third> endsub\n")
    assert but_for("linuxcnc", "o<other> call", folder=tmp_path) == ["o<b>, which is not at hand"]
    third.write_text("o<third> sub\nG0 Z1\no<third> endsub\n")
    assert but_for("linuxcnc", "o<other> call", folder=tmp_path) is None


def test_codes_that_call_on_this_machine() -> None:
    """What the machine file says that a code calls is another program."""
    assert still("fanuc", "M50")
    assert but_for("fanuc", "M50", ("M50",)) is None
    assert but_for("linuxcnc", "M208", ("M208",)) is None


def test_calls_within_the_file() -> None:
    """All lines of the file are looked at, so it may call what it defines."""
    assert still("linuxcnc", "o1 call\no<a> endsub\no1 sub\nM5\no1 endsub\no<b> sub")
