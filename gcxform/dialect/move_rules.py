"""How a control moves: when it takes an arc for one, and what a feed is about."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class ArcRule:
    """Which arcs the control cuts.

    It accepts one whose start and end radius differ by `delta` (mm) if delta <= `absolute`, or if
    delta <= `relative` * radius and delta <= `largest`.

    smallest  mm; the least radius
    r_short   mm; how much an R may fall short of the half chord
    in_inch   how many times as large `absolute` and `largest` are in blocks in inches
    planes    in which it can cut arcs
    turns     the word that counts the turns of an arc (n - 1 full turns beyond the arc itself)
    circle_needs_axis_word   whether a full circle has to name an axis of its plane
    """

    absolute: float = 0.01
    relative: float = 0.0
    largest: float = float("inf")
    smallest: float = 0.0
    r_short: float = 0.0
    in_inch: float = 1.0
    planes: frozenset[str] = frozenset({"XY", "ZX", "YZ"})
    turns: str = ""
    circle_needs_axis_word: bool = False


@dataclass(frozen=True, slots=True)
class FeedRule:
    """What a feed is about, and when it is lost.

    mode_clears        another feed mode clears the feed
    change_clears      after another unit the feed is not known until it is programmed; after
                       another feed mode it never is
    before_units       F is read in the unit that was in force before a G20 or G21 of its own block
    of_linear_axes     a feed per minute counts the way of X, Y and Z where they move, and no
                       degrees beside it
    along_lines        in moves of several kinds of axes it counts along X Y Z, or along all rotary
                       axes where they move alone; otherwise the length of such moves is not known
    arcs_in_time       whether arcs take the time that G93 gives them
    least_inverse_rate units of the program per minute: in G93 the control moves no slower
    """

    mode_clears: bool = False
    change_clears: bool = False
    before_units: bool = False
    of_linear_axes: bool = False
    along_lines: bool = False
    arcs_in_time: bool = True
    least_inverse_rate: float = 0.0
