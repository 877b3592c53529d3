"""What a code does, as data: its modal group, its effect, the words that belong to it.

A dialect is a table of these. Nothing here is true of every control; `ISO` holds the codes on which
all the first-party dialects agree, and each dialect adds to it or takes away.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum

from gcxform.values import dataclass


class Effect(Enum):
    """What the interpreter does with a code."""

    MODAL = "sets its modal group"
    DWELL = "waits"
    INERT = "is kept as it is: it changes no position"
    FRAME = "changes how words become positions, or moves in a way of its own"
    BARRIER = "is refused wherever a pass needs positions"
    CALL = "calls a program with the values of its block, and is kept where that is not found"


@dataclass(frozen=True, slots=True)
class Code:
    """One G code. `takes` are the address letters of the words that are parameters to it.

    `act` names what a code with Effect.FRAME does (`gcxform/modal/frames/acts.py`), what one with
    Effect.INERT does that other controls spell otherwise (`gcxform/dialect/code_translation.py`),
    and of one with Effect.CALL where it ends, as a machine file would say it. `lengths` are those
    of the words it takes that are in the unit of the program; of a code with an act, all axis
    words.
    `after`: it acts at the end of its block, which is that of the last piece where the block is
    cut.
    """

    group: str
    effect: Effect = Effect.MODAL
    takes: str = ""
    reason: str = ""
    act: str = ""
    lengths: str = ""
    after: bool = False


@dataclass(frozen=True, slots=True)
class MCode:
    """One M code. `after`: it acts after the motion of its block; `ends`: the program ends."""

    group: str
    after: bool = False
    ends: bool = False
    barrier: str = ""
    loses_position: bool = False
    takes: str = ""
    act: str = ""


@dataclass(frozen=True, slots=True)
class CutterComp:
    """How a control reads cutter compensation.

    stored     D is the number of a stored offset that stays in force; otherwise it belongs to its
               block, and without it G41 takes the tool in the spindle
    planes     in which it may be on
    changes    whether a side may be programmed while compensation is on
    arc_entry  whether the move that begins it may be an arc
    corners    what joins moves outside: "arc", "linear", or "" where a parameter decides
    entry      where the move that begins it ends: beside its "own" end, the "next" move, or ""
    straight   rad; turns below are taken for none; 0 where that is not known
    before     modal groups of codes that are refused while it is on before their block
    after      those that are refused while it is on after the codes of their block
    """

    stored: bool = False
    planes: frozenset[str] = frozenset({"XY", "ZX", "YZ"})
    changes: bool = True
    arc_entry: bool = False
    corners: str = ""
    entry: str = ""
    straight: float = 0.0
    before: frozenset[str] = frozenset()
    after: frozenset[str] = frozenset()


def inert(group: str, takes: str = "", lengths: str = "", act: str = "") -> Code:
    """Return a code that changes no position; `act` is what other controls may spell otherwise."""
    return Code(group, Effect.INERT, takes, act=act, lengths=lengths)


def at_end(group: str) -> Code:
    """Return a code that changes no position and acts at the end of its block."""
    return Code(group, Effect.INERT, after=True)


def frame(group: str, act: str, takes: str = "") -> Code:
    """Return a code that changes how words become positions, or moves in a way of its own."""
    return Code(group, Effect.FRAME, takes, "", act)


def barrier(group: str, reason: str, takes: str = "") -> Code:
    """Return a code that is refused by name wherever a pass needs positions."""
    return Code(group, Effect.BARRIER, takes, reason)


def call(group: str, takes: str) -> Code:
    """Return a code that calls a program with values, by its number in P."""
    return Code(group, Effect.CALL, takes)


def measures(takes: str) -> Code:
    """Return a code that moves by itself and writes an offset: it is kept, and both are lost."""
    return Code("non-modal", Effect.CALL, takes, act="unknown")


def bores(axes: str) -> Code:
    """Return a code that moves along the tool by itself, to and fro: it is kept.

    Behind it the axes that its block names are where that says; K says how far below is its ground.
    """
    return Code("non-modal", Effect.CALL, f"{axes}K", act=f"at {axes}", lengths="K")


def cuts(takes: str, group: str = "non-modal", ends: str = "unknown") -> Code:
    """Return a code that cuts in a way of its own within its block: it is kept, places are lost.

    Where positions are compensated it is refused, for its own would not be. In group "motion" it
    leaves a motion code in force of which nothing is known. `ends`: "at XYZ", where its block says
    of these axes where they are behind it.
    """
    return Code(group, Effect.CALL, takes, "it cuts in a way of its own", act=ends)


ISO: Mapping[str, Code] = {
    **{code: Code("motion") for code in ("G0", "G1", "G2", "G3")},
    "G4": Code("non-modal", Effect.DWELL),
    **{code: Code("plane") for code in ("G17", "G18", "G19")},
    **{code: Code("distance") for code in ("G90", "G91")},
    **{code: Code("feed-mode") for code in ("G93", "G94")},
    **{code: Code("units") for code in ("G20", "G21")},
    "G40": Code("cutter-comp"),
    "G49": frame("tool-length", "no-length"),
    **{code: frame("frame", "work") for code in ("G54", "G55", "G56", "G57", "G58", "G59")},
    "G80": Code("motion"),
}

ISO_M: Mapping[int, MCode] = {
    0: MCode("stop", after=True),
    1: MCode("stop", after=True),
    2: MCode("stop", after=True, ends=True),
    30: MCode("stop", after=True, ends=True),
    3: MCode("spindle"),
    4: MCode("spindle"),
    5: MCode("spindle"),
    6: MCode("tool"),
    7: MCode("coolant"),
    8: MCode("coolant"),
    9: MCode("coolant"),
}

CYCLE = "a canned cycle moves axes in a way of its own; this version does not expand cycles"
AXES = "XYZABCUVW"
"""The axis words, where a code takes them as its own."""

HOME = "it moves axes to a point that only the control knows"
SHIFT = "it shifts the coordinates by values that only the control knows"
LENGTH = "it shifts the tool by a length that only the control knows"
FOLLOWING = "the control follows the tip of the tool itself, as rtcp would"
COMP = "it moves the path beside the programmed contour in space"
TRANSFORM = "it turns, scales or mirrors the coordinates"
CALL = "it runs a program that is not in this file"
SYNCHRONISED = "its motion is tied to the spindle"
PROBE = "its end is where the probe touches"
"""Reasons for barriers, as they are shown to a user."""
