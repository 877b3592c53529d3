"""What the kernel of canned cycles refuses, and that it says so with the right words."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from cycle_kit import HOLE, START, Block, calls, cycles, expanded, refusals, rule, told, turned

import gcxform as gx
from gcxform.modal.cycles.expansion import UNKNOWN, Calls, Cycles

REFUSED: dict[str, tuple[str, Block, str]] = {
    "thread": ("linuxcnc", {"cycle": 76}, "G76 is not expanded"),
    "fine boring": ("fanuc", {"cycle": 76}, "G76 is not expanded"),
    "back boring": ("fanuc", {"cycle": 87}, "G87 is not expanded"),
    "manual boring": ("fanuc", {"cycle": 88}, "G88 is not expanded"),
    "no cycle": ("fanuc", {"cycle": 77}, "G77 is not a cycle"),
    "rotary": ("linuxcnc", {"A": 0}, "G81 takes words of X, Y, Z alone"),
    "fraction": ("linuxcnc", {"L": 1.5}, "G81 with a fraction in L"),
    "negative": ("fanuc", {"L": -1}, "G81 with a negative K"),
    "stray P": ("linuxcnc", {"P": 1}, "G81 takes no P"),
    "stray L": ("linuxcnc", {"cycle": 74, "L": 2, "spindle": -1}, "G74 takes no L"),
    "stray I": ("fanuc", {"I": 1}, "G81 takes no I"),
    "no P": ("linuxcnc", {"cycle": 82}, "G82 without P"),
    "no dwell": ("fanuc", {"cycle": 82}, "G82 without P"),
    "no Q": ("linuxcnc", {"cycle": 73}, "G73 without Q"),
    "no K": ("linuxcnc", {"cycle": 87, "I": 1, "J": 1}, "G87 without K"),
    "Q 0": ("linuxcnc", {"cycle": 83, "Q": 0}, "G83 with a Q that is not above zero"),
    "P -1": ("linuxcnc", {"cycle": 82, "P": -1}, "G82 with a negative P"),
    "tap in pecks": ("fanuc", {"cycle": 84, "Q": 1}, "G84 with Q in force"),
    "Z above R": ("linuxcnc", {"Z": 3}, "G81 with Z above R"),
    "Z above R, fanuc": ("fanuc", {"Z": 3}, "G81 with Z above R"),
    "no spindle": ("linuxcnc", {"cycle": 84, "spindle": 0}, "G84 with the spindle stopped"),
    "wrong way": ("linuxcnc", {"cycle": 84, "spindle": -1}, "G84 with the spindle turning the"),
    "left": ("linuxcnc", {"cycle": 74, "spindle": 1}, "G74 with the spindle turning the wrong way"),
    "unknown": ("linuxcnc", {"cycle": 86, "P": 1, "spindle": UNKNOWN}, "G86 starts the spindle"),
    "many pecks": ("linuxcnc", {"cycle": 83, "Q": 1e-9}, "G83 would become more than 100000"),
    "many repeats": ("linuxcnc", {"L": 1e6}, "G81 would become more than 100000 moves"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_refused(name: str) -> None:
    dialect, block, message = REFUSED[name]
    steps = expanded(dialect, {"cycle": 81, **HOLE, **block})
    assert len(steps.refusals) == 1
    assert steps.refusals[0].message.startswith(message)
    assert len(steps.rows.kind) == 0
    assert not steps.rows.events


def test_what_a_hole_needs() -> None:
    for dialect in ("linuxcnc", "fanuc"):
        for word, name in (("R", "R"), ("Z", "Z")):
            block = {"cycle": 81, **HOLE}
            del block[word]
            assert refusals(expanded(dialect, block)) == [f"0: G81 without {name}"]
    side = turned("G18", {"cycle": 81, "X": 1, "R": 2})
    assert refusals(expanded("linuxcnc", side)) == ["0: G81 without Y"]


def test_pull_back_must_be_known() -> None:
    block = HOLE | {"cycle": 83, "Q": 2}
    stretch = calls([block], START)
    plain = rule("fanuc")
    assert refusals(Cycles(plain).expand(stretch))[0].startswith("0: G83: how far it goes back")
    assert refusals(Cycles(plain, peck_return=0.1).expand(stretch))
    assert not refusals(Cycles(plain, peck_clearance=0.1).expand(stretch))
    broken = calls([block | {"cycle": 73}], START)
    assert refusals(Cycles(plain, peck_clearance=0.1).expand(broken))
    assert not refusals(Cycles(plain, peck_return=0.1).expand(broken))
    assert not refusals(Cycles(plain).expand(calls([block | {"Q": 6}], START)))  # one peck
    known = replace(plain, peck_return=0.2)
    assert "=0 >0.2 =-2" in told(Cycles(known).expand(broken))


def test_unit_and_plane_within_a_cycle() -> None:
    for dialect in ("linuxcnc", "fanuc"):
        kernel = cycles(dialect)
        kernel.expand(calls([HOLE | {"cycle": 81}], START))
        inch = calls([{"cycle": 81, "X": 1, "unit": 20}], START)
        assert refusals(kernel.expand(inch))[0].startswith("0: the unit has changed within G81")
    kernel = cycles("fanuc")
    kernel.expand(calls([HOLE | {"cycle": 81}], START))
    side = calls([turned("G18", HOLE) | {"cycle": 81}], START)
    assert refusals(kernel.expand(side)) == ["0: the plane has changed within G81"]


def test_unknown_positions() -> None:
    nan = float("nan")
    hole = HOLE | {"cycle": 81}
    for dialect in ("linuxcnc", "fanuc"):
        lost = expanded(dialect, hole, start=(0, 0, nan))
        assert refusals(lost) == ["0: G81, but where Z stands is not known"]
        moved = expanded(dialect, hole | {"distance": 91, "Z": -6, "R": -8}, start=(nan, 0, 10))
        assert refusals(moved) == ["0: X is incremental, but it stands nowhere known"]
        assert refusals(expanded(dialect, hole, start=(nan, nan, 10))) == []


def test_one_refusal_does_not_hide_the_next() -> None:
    steps = expanded("linuxcnc", HOLE | {"cycle": 81, "P": 1}, {"X": 2}, {"X": 3, "Q": 1})
    assert refusals(steps) == ["0: G81 takes no P", "2: G81 takes no Q"]
    assert set(steps.rows.call.tolist()) == {1}


def test_inverse_time() -> None:
    stretch: Calls = calls([HOLE | {"cycle": 81}], START, inverse=np.array([True]))
    assert refusals(cycles("linuxcnc").expand(stretch)) == ["0: G81 cannot be fed in inverse time"]


def test_nothing() -> None:
    stretch = calls([HOLE | {"cycle": 81}], START)
    none = {
        name: getattr(stretch, name)[:0]
        for name in Calls.__dataclass_fields__
        if name not in ("position", "plane", "unit")
    }
    steps = cycles("linuxcnc").expand(replace(stretch, **none))
    assert len(steps.rows.kind) == 0
    assert steps.after.shape == (0, 3)


def test_a_tap_that_dwells_for_the_p_of_a_cycle_that_goes() -> None:
    """LinuxCNC keeps the last P: without G82 the tap would not dwell."""
    text = b"G21 G90 G94 G17\nG0 X0 Y0 Z50\nS500 M3\nG98 G82 X1 R2 Z-5 P0.3 F100\nG80\nG0 X2\n"
    text += b"G84 X3 R2 Z-5 F500\nG80\nM2\n"
    with pytest.raises(gx.InputError, match="this tap dwells"):
        gx.Pipeline.parse("cycles", "linuxcnc").run(text)
