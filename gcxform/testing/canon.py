"""What ISO word-address controls agree on, as tables the conformance kit holds a dialect to.

It is said here a second time, on purpose: the tables of `gcxform.modal` are what is checked. Codes
on which controls differ have every meaning that is known. A dialect that differs all the same says
so, and from where that is known, in `differs`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import pairwise

from gcxform.dialect.codes import Code, Effect
from gcxform.dialect.cycle_rule import Level, Step

Steps = tuple[Step, ...]

WORK = tuple(f"G{n}" for n in range(54, 60))
MORE_WORK = ("G59.1", "G59.2", "G59.3")
CYCLES = tuple(f"G{n}" for n in (73, 74, 76, *range(81, 90)))
CYCLE = ("modal motion", "modal cycle")

MEANINGS: Mapping[str, tuple[str, ...]] = {
    **dict.fromkeys(("G0", "G1", "G2", "G3"), ("modal motion",)),
    "G4": ("dwell",),
    **dict.fromkeys(("G5", "G5.1"), ("modal motion", "inert")),
    "G7": ("act diameter",),
    "G8": ("act diameter", "inert"),
    "G10": ("act set-work",),
    "G15": ("act no-polar",),
    "G16": ("act polar",),
    **dict.fromkeys(("G17", "G18", "G19"), ("modal plane",)),
    **dict.fromkeys(("G20", "G21"), ("modal units",)),
    **dict.fromkeys(("G28", "G30"), ("act home",)),
    **dict.fromkeys(("G28.1", "G30.1"), ("act store-home",)),
    "G31": ("act probe",),
    **dict.fromkeys(("G33", "G33.1", *(f"G38.{n}" for n in range(2, 6))), ("modal motion",)),
    **dict.fromkeys(("G40", "G41", "G42", "G41.1", "G42.1"), ("modal cutter-comp",)),
    "G43": ("act length",),
    "G43.1": ("act length-vector",),
    "G43.2": ("act length-add",),
    "G44": ("act length-negative",),
    "G49": ("act no-length",),
    "G50": ("act no-scale",),
    "G51": ("act scale",),
    "G50.1": ("act no-mirror",),
    "G51.1": ("act mirror",),
    "G52": ("act local",),
    "G53": ("act machine",),
    **dict.fromkeys((*WORK, *MORE_WORK, "G54.1"), ("act work",)),
    **dict.fromkeys(("G9", "G61", "G61.1", "G64", "G96", "G97", "G98", "G99"), ("inert",)),
    "G68": ("act rotate",),
    "G69": ("act no-rotate",),
    **dict.fromkeys(CYCLES, CYCLE),
    "G80": ("modal motion", "inert"),
    **dict.fromkeys(("G90", "G91"), ("modal distance",)),
    **dict.fromkeys(("G90.1", "G91.1"), ("modal arc-distance",)),
    "G92": ("act preset",),
    "G92.1": ("act preset-clear",),
    "G92.2": ("act preset-suspend",),
    "G92.3": ("act preset-restore",),
    **dict.fromkeys(("G93", "G94", "G95"), ("modal feed-mode",)),
}
"""What each code may be; besides, every code may be a barrier, or missing."""


def said_of(code: Code) -> str:
    """Return what a table says of a code, as `MEANINGS` writes it."""
    rest = {Effect.MODAL: f" {code.group}", Effect.FRAME: f" {code.act}"}.get(code.effect, "")
    kind = {Effect.FRAME: "act"}.get(code.effect, code.effect.name.lower())
    return kind + rest


GROUP_OF_ACT: Mapping[str, str] = {
    "work": "frame",
    **dict.fromkeys(
        ("length", "length-negative", "length-vector", "length-add", "no-length"), "tool-length"
    ),
    **dict.fromkeys(("set-work", "local", "preset", "preset-clear"), "non-modal"),
    **dict.fromkeys(("preset-suspend", "preset-restore", "store-home"), "non-modal"),
    **dict.fromkeys(("home", "machine", "probe"), "non-modal"),
}
"""The groups of acts by which the core finds them, and the controls sort them."""

NEEDED: Mapping[str, str] = {
    "length": "H",
    "length-negative": "H",
    "length-add": "H",
    "set-work": "LPXYZ",
    "local": "XYZ",
    "preset": "XYZ",
    "rotate": "XYR",
    "scale": "XYZP",
    "mirror": "XYZ",
}
"""The words without which an act cannot be told what to do."""

MOVING = frozenset({"home", "machine", "probe", "store-home"})
"""Acts whose axis words are those of a move, which no code may take away."""

ENDED: Mapping[str, str] = {
    **dict.fromkeys(("length", "length-negative", "length-vector", "length-add"), "no-length"),
    "polar": "no-polar",
    "rotate": "no-rotate",
    "scale": "no-scale",
    "mirror": "no-mirror",
}
"""What ends an act; it is of the same modal group, and begins and ends without the other's help."""

FAMILIES: tuple[tuple[str, ...], ...] = (
    ("G0", "G1"),
    ("G2", "G3"),
    ("G17", "G18", "G19"),
    ("G20", "G21"),
    ("G90", "G91"),
    ("G40", "G41", "G42"),
    ("G98", "G99"),
    ("G61", "G64"),
    ("G93", "G94"),
    *pairwise(WORK),
)
"""Codes that controls have together; `G40` and what a control may do without are apart."""
LOOSE = frozenset({"G40", "G61"})
"""Codes that a control may have without the others of their family."""

GROUP_OF_M: Mapping[int, str] = {
    **dict.fromkeys((0, 1, 2, 30, 60, 98, 99), "stop"),
    **dict.fromkeys((3, 4, 5, 19), "spindle"),
    **dict.fromkeys((6, 61), "tool"),
    **dict.fromkeys((7, 8, 9), "coolant"),
    **dict.fromkeys((48, 49), "override"),
}
AFTER_M: Mapping[int, bool] = {
    **dict.fromkeys((0, 1, 2, 30), True),
    **dict.fromkeys((3, 4, 6, 7, 8), False),
}
"""Whether an M code acts after the motion of its block; of M5 and M9 controls differ."""
ENDS = frozenset({2, 30})
RETURNS = frozenset({99})
"""What ends a program that stands in no call, on controls whose programs call each other."""
CALLS = frozenset({98, 99})
STOPPED_BY: Mapping[int, int] = {3: 5, 4: 5, 7: 9, 8: 9, 48: 49, 49: 48}
ACTS_OF_M: Mapping[str, tuple[str, str]] = {
    "change-tool": ("tool", ""),
    "set-tool": ("tool", "Q"),
    "user-code": ("user", "PQ"),
    "tip-on": ("tip", ""),
    "tip-off": ("tip", ""),
    "tip-kept-on": ("tip", ""),
    "tip-kept-off": ("tip", ""),
}
"""The group of M codes with an act, and the words they need."""

AT_START: Mapping[str, tuple[str, ...]] = {
    "motion": ("G80", "G0", "G1"),
    "plane": ("G17",),
    "distance": ("G90",),
    "arc-distance": ("G91.1",),
    "feed-mode": ("G94",),
    "units": ("G21",),
    "frame": ("G54",),
    "cutter-comp": ("G40",),
}
"""What mills start in. (Their motion code is no code, rapid or, of some, feed.)"""
AT_END: Mapping[str, str] = {
    "motion": "G1",
    "plane": "G17",
    "distance": "G90",
    "feed-mode": "G94",
    "frame": "G54",
}
"""What M2 and M30 leave behind on a control that reads on: NIST RS274/NGC version 3, 3.6.1."""

PECKS: Mapping[int, str] = {73: "break", 83: "clear"}
CYCLE_NEEDS: Mapping[int, str] = {73: "Q", 82: "P", 83: "Q", 89: "P"}
TURNING: Mapping[int, tuple[int, ...]] = {74: (-1,), 84: (1,)}


def _rapid_out(*then: str) -> Callable[[Steps], bool]:
    """Return whether a cycle feeds to the bottom, does something there, and leaves in rapid."""
    return lambda steps: (
        steps[0] == Step(True, Level.BOTTOM, then) and len(steps) == 2 and not steps[1].feeds
    )


def _feed_out(*then: str) -> Callable[[Steps], bool]:
    return lambda steps: steps[0] == Step(True, Level.BOTTOM, then) and steps[1].feeds


def _tap(out: str, back: str) -> Callable[[Steps], bool]:
    return lambda steps: (
        steps[1].feeds and out in steps[0].then and back in steps[1].then and "M5" in steps[0].then
    )


STEPS: Mapping[int, Callable[[Steps], bool]] = {
    73: _rapid_out(),
    74: _tap("M3", "M4"),
    81: _rapid_out(),
    82: _rapid_out("DWELL"),
    83: _rapid_out(),
    84: _tap("M4", "M3"),
    85: _feed_out(),
    86: lambda steps: "M5" in steps[0].then and not steps[-1].feeds,
    89: _feed_out("DWELL"),
}
"""Whether steps are those of each cycle; pecking is said apart."""
