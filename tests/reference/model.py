"""What the reference interpreter knows about the four controls, and what it returns."""

import math
from dataclasses import dataclass, field, replace

LINEAR = "XYZ"
FANUCS = ("fanuc", "haas")  # the controls of that family
PLANES = {170: ("XY", "XYZ", "IJK"), 180: ("ZX", "ZXY", "KIJ"), 190: ("YZ", "YZX", "JKI")}
GROUPS = {  # code times ten: modal group
    **dict.fromkeys((0, 10, 20, 30, 800), "motion"),
    **dict.fromkeys((170, 180, 190), "plane"),
    **dict.fromkeys((900, 910), "distance"),
    **dict.fromkeys((901, 911), "arc"),
    **dict.fromkeys((930, 940, 950), "feed"),
    **dict.fromkeys((200, 210), "units"),
    **dict.fromkeys((540, 550, 560, 570, 580, 590), "frame"),
    40: "dwell",
    400: "radius",
    490: "length",
}
STOPS, SPINDLE, COOLANT = (0, 1, 2, 30, 60), (3, 4, 5), (7, 8, 9)
M_GROUPS = {
    **dict.fromkeys(STOPS, "stop"),
    **dict.fromkeys(SPINDLE, "spindle"),
    **dict.fromkeys(COOLANT, "coolant"),
    6: "change",
}


@dataclass(frozen=True)
class Dialect:
    """What distinguishes the controls here."""

    name: str
    axes: str
    missing: frozenset[int]  # G codes (times ten) of `GROUPS` that this control does not have
    missing_m: frozenset[int] = frozenset()
    motion: int = 800
    frame: int | None = None
    many_m: int = 4
    late: frozenset[int] = frozenset(STOPS)  # M codes which act after the motion


DIALECTS = {
    "linuxcnc": Dialect("linuxcnc", "XYZABC", frozenset()),
    "fanuc": Dialect(
        "fanuc", "XYZABC", frozenset((901, 911)), many_m=3, late=frozenset((*STOPS, 5, 9))
    ),
    "haas": Dialect(
        "haas", "XYZABC", frozenset((901, 911)), many_m=3, late=frozenset((*STOPS, 5, 9))
    ),
    "grbl": Dialect(
        "grbl", "XYZ", frozenset((901, 950)), frozenset((6, 7, 60)), motion=0, frame=540
    ),
}


@dataclass(frozen=True)
class Move:
    """One motion. Lengths in mm, rotary positions in degrees, `sweep` in radians (positive).

    `turns` counts the full turns beyond the first one: `sweep` is in (2 pi turns,
    2 pi (turns + 1)]. `feed` is mm/min or mm/rev (degrees if only rotary axes move) or 1/min.
    """

    kind: str
    start: dict[str, float]
    end: dict[str, float]
    line: int
    feed: float | None = None
    feed_mode: str = "G94"
    plane: str = "XY"
    centre: tuple[float, float, float] | None = None
    turns: int = 0
    sweep: float = 0.0


@dataclass
class Program:
    """Moves, and events as (index of the move before which it happens, text)."""

    moves: list[Move] = field(default_factory=list)
    events: list[tuple[int, str]] = field(default_factory=list)


def with_feed(move: Move, feed: tuple[float, float]) -> Move:
    """Give a cutting move its feed (linear, rotary): the rotary one if only rotary axes move."""
    known = [axis for axis in LINEAR if axis in move.end]
    linear = any(abs(move.end[a] - move.start.get(a, math.inf)) > 1e-7 for a in known)
    turning = any(move.end[a] != move.start.get(a) for a in move.end if a not in LINEAR)
    rotary = turning and not linear and move.centre is None and move.feed_mode != "G93"
    return replace(move, feed=feed[1] if rotary else feed[0])


def rank(m: int) -> int:
    """Order of execution of M codes: tool change, spindle, coolant, stops."""
    return ["change", "spindle", "coolant", "stop"].index(M_GROUPS[m])
