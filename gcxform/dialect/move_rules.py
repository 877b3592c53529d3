"""How a control moves: which arcs it cuts, what a feed is about, what codes do beyond words."""

from __future__ import annotations

from collections.abc import Mapping

from gcxform.dialect.codes import MCode
from gcxform.values import dataclass


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
    circle    what a full circle names of the axes of its plane: "some", "none", or "" for either
    third     what is done with a centre word along the normal of the plane: beside one in the plane
              it is "dropped"; where it is 0 it is taken ("zero"); "": it is refused
    turns_axes rotary axes may turn beside an arc; otherwise how they do so is not certain: refused
    centres_open  how I, J and K count is a setting of the control, until G90.1 or G91.1 says it
    """

    absolute: float = 0.01
    relative: float = 0.0
    largest: float = float("inf")
    smallest: float = 0.0
    r_short: float = 0.0
    in_inch: float = 1.0
    planes: frozenset[str] = frozenset({"XY", "ZX", "YZ"})
    turns: str = ""
    circle: str = ""
    third: str = ""
    turns_axes: bool = True
    centres_open: bool = False


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
    turns_need_speed   a feed per turn is refused before an S word, and where S is 0
    """

    mode_clears: bool = False
    change_clears: bool = False
    before_units: bool = False
    of_linear_axes: bool = False
    along_lines: bool = False
    arcs_in_time: bool = True
    least_inverse_rate: float = 0.0
    turns_need_speed: bool = False


@dataclass(frozen=True, slots=True)
class MotionRule:
    """What motion codes and path modes do where words alone do not say it.

    lone_codes_count  G1, G2 and G3 are executed without axis words too: G1 asks for a feed, arcs
                      for words
    g28_without_axes  G28 without an axis word sends all axes home
    g28_ends_length   after G28 a tool length may not be in force any more: it is not known
    g53_in_g91        what G53 does under G91: "absolute", or "refused" by the control or by us
    g53_is_rapid      G53 moves in rapid whatever motion code is in force
    rounds_corners    corners are rounded where no path mode is stated, as they are in G64
    corners           letters that stand behind a comma at a straight move and put a piece into the
                      corner at its end: C a chamfer, which begins and ends as far from the corner
                      as its number says, R an arc of that radius
    cycles_stop       the moves of a cycle end exactly, also where G64 rounds corners: G61 is in
                      force in its block, and behind it G64 as it was stated
    m_over_hole       M codes that act behind the motion of their block act in that of a cycle when
                      the tool has come over the first hole; otherwise behind the last one
    extruder          which codes say whether E is a distance: "own", M82 and M83 alone; "last", the
                      last of them and of G90 and G91; "either", M83 or G91; "" where firmware
                      differs, and what they disagree on is refused
    """

    lone_codes_count: bool = False
    g28_without_axes: bool = False
    g28_ends_length: bool = False
    g53_in_g91: str = "refused"
    g53_is_rapid: bool = False
    rounds_corners: bool = False
    corners: str = ""
    cycles_stop: bool = False
    m_over_hole: bool = False
    extruder: str = ""

    def over_hole(self, m_codes: Mapping[int, MCode]) -> frozenset[str]:
        """Return which M codes act over the hole that their block drills."""
        late = {n: code for n, code in m_codes.items() if code.after and not code.ends}
        return frozenset(f"M{n}" for n in late if self.m_over_hole and not late[n].barrier)
