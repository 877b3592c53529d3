"""The centre path of a cutter beside contours: offset moves, inside and outside corners.

All contours of a window are worked at once, in columns: each move in the coordinates of its plane,
mm, points as (2, n). `side` is +1 where the tool is left of the contour and -1 where it is right.
Where a move begins and ends depends on it and its neighbours alone, so no corner waits for another.
What is computed is what LinuxCNC's interpreter executes:

- the move that begins compensation goes straight to the point beside its own end; an arc goes there
  as an arc that ends in the same direction;
- at an outside corner a circle of the tool's radius about the corner is inserted;
- at an inside corner both moves end where their offset curves meet;
- turns of less than 0.05 rad are taken for none: the next move begins where the one before ended.

`Corners.LINEAR` lets offset lines meet on the outside too, as other controls do.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from gcxform.vocabulary import Flags, Floats, Ints
from gcxform_plugins.passes.cutter_comp.moves import Moves, angle, cross, dot, left_of, unit

SHARP = 0.05  # rad; controls differ on corners that are sharper
WHOLE = 0.5  # rad; an arc that begins compensation has to be so much less than a turn
LONGER = 0.025  # rad; so much may an arc gain where it begins off its own normal
STILL = 1e-6  # mm; what is as near is at one place
BACK = 1e-6  # rad; a line that goes back the way it came
TURN = 2 * np.pi
BEGIN, JOIN, DIRECTION = range(3)  # the steps, in the order in which a contour is refused


class Corners(StrEnum):
    """What joins two moves at an outside corner."""

    ARC = "arc"
    LINEAR = "linear"


class Entry(StrEnum):
    """Where the move that begins compensation ends: beside its own end, or beside the next move."""

    OWN = "own"
    NEXT = "next"


@dataclass(frozen=True, slots=True)
class Manner:
    """How a control compensates; `straight` (rad): turns below are taken for none.

    `enters_by_arc`: it is known how an arc begins compensation.
    """

    corners: Corners
    entry: Entry
    straight: float
    enters_by_arc: bool = False


class CannotOffsetError(Exception):
    """A move that cannot be compensated: its index, and why.

    `alarm`: LinuxCNC stops there as well, with a message. What it does of the rest, such as a cut
    into the contour, depends on the last digit, or nobody would want it.
    """

    def __init__(self, index: int, message: str, alarm: bool = False) -> None:
        super().__init__(message)
        self.index = index
        self.message = message
        self.alarm = alarm


@dataclass(frozen=True)
class Offset:
    """What becomes of moves; the steps fill it in place.

    begin, finish   (2, n) where the centre path begins and ends them
    middle          (2, n) its centre of an arc that begins compensation; nan elsewhere
    sweep           (n,) rad, of arcs
    around, across  (n,) whether an arc, or a line, comes before the move, at an outside corner
    """

    begin: Floats
    finish: Floats
    middle: Floats
    sweep: Floats
    around: Flags
    across: Flags

    @classmethod
    def beside(cls, moves: Moves) -> Offset:
        """Return moves that begin and end at right angles beside their own ends."""
        count = len(moves.sense)
        begin, finish = (
            at + moves.off * left_of(along)
            for at, along in ((moves.start, moves.first), (moves.end, moves.last))
        )
        around, across = np.zeros((2, count), np.bool_)
        return cls(begin, finish, np.full((2, count), np.nan), np.zeros(count), around, across)


class _Refusals:
    """What cannot be compensated: the first is told, contour by contour and step by step."""

    def __init__(self, begins: Flags) -> None:
        self.contour = np.cumsum(begins)
        self.found: list[tuple[tuple[int, int, int], str, bool]] = []

    def add(self, step: int, wrong: Flags, message: str, alarm: Flags | bool = False) -> None:
        """Take note of the first of the moves (n,) that are wrong in a step."""
        k = int(wrong.argmax())
        if wrong[k]:
            alarms = bool(np.broadcast_to(alarm, wrong.shape)[k])
            self.found.append(((int(self.contour[k]), step, k), message, alarms))

    def check(self) -> None:
        """Raise CannotOffsetError about the first of all."""
        if self.found:
            (_, _, k), message, alarm = min(self.found, key=lambda each: each[0])
            raise CannotOffsetError(k, message, alarm)


def offset(moves: Moves, manner: Manner) -> Offset:
    """Compensate the moves of contours. Raises CannotOffsetError."""
    if not len(moves.begins):
        return Offset.beside(moves)
    refusals = _Refusals(moves.begins)
    with np.errstate(invalid="ignore", divide="ignore"):
        made = Offset.beside(moves)
        _begin(moves, made, manner, refusals)
        _join(moves, made, manner, refusals)
        made.sweep[:] = _swept(moves, made)
        _check_directions(moves, made, manner, refusals)
    refusals.check()
    return made


def _begin(moves: Moves, made: Offset, manner: Manner, refusals: _Refusals) -> None:
    """Place the moves that begin compensation."""
    lines, arcs = moves.begins & ~moves.arc, moves.begins & moves.arc
    length = np.hypot(*(moves.end - moves.start))
    short = lines & ~(length > moves.radius)
    k = int(short.argmax())
    message = f"the move that begins compensation is {length[k]:.4f} mm long, which is not more "
    message += f"than the tool's radius of {moves.radius[k]:.4f} mm"
    refusals.add(BEGIN, short, message, alarm=True)
    made.begin[:, moves.begins] = moves.start[:, moves.begins]
    if arcs.any():
        if not manner.enters_by_arc:
            refusals.add(BEGIN, arcs, "compensation begins with an arc")
        _begin_with_arcs(moves, np.flatnonzero(arcs), made, refusals)


def _begin_with_arcs(moves: Moves, k: Ints, made: Offset, refusals: _Refusals) -> None:
    """Place arcs that begin compensation: from their start, and in their direction at their end.

    The centre is on the line from the point beside the end, f, to the programmed one, along the
    unit vector u, at t from f: |p - f - t u| = |t| with p the start, so t = |p - f|^2 / 2 (p - f).u
    """
    small = np.hypot(*(moves.start - moves.centre)) <= moves.radius
    message = "the radius of the arc that begins compensation is not larger than the tool's"
    refusals.add(BEGIN, _only(small, k), message, alarm=True)
    f = made.finish[:, k]
    u, w = unit(moves.centre[:, k] - moves.end[:, k]), moves.start[:, k] - f
    along = dot(w, u)
    whole = np.zeros(len(small), np.bool_)
    whole[k] = (along <= STILL) | (moves.sweep[k] > TURN - WHOLE)
    message = "the arc that begins compensation is nearly a whole circle"
    refusals.add(BEGIN, whole, message)
    made.middle[:, k] = f + dot(w, w) / (2 * along) * u


def _join(moves: Moves, made: Offset, manner: Manner, refusals: _Refusals) -> None:
    """Join moves with those before them at their corners."""
    small = moves.arc & ~moves.begins & ~(moves.reach >= 1e-9)
    refusals.add(JOIN, small, "the radius of the arc is not larger than the tool's", alarm=True)
    joined = ~moves.begins
    if manner.entry is Entry.NEXT:
        enters = np.flatnonzero(moves.begins & ~moves.ends)
        made.finish[:, enters] = made.begin[:, enters + 1]
        joined[enters + 1] = False
    turn = moves.turn
    straight = joined & (np.abs(turn) <= manner.straight)
    k = np.flatnonzero(straight)
    made.begin[:, k] = made.finish[:, k - 1]
    corner = joined & ~straight
    closes = corner & _closes(moves)
    outside = corner & ~closes & ((turn < 0) | (turn > np.pi - BACK))
    blocked = corner & _behind(moves.begins & moves.arc) & ~(turn < 0)
    message = "an inside corner behind an arc that begins compensation"
    refusals.add(JOIN, blocked, message)
    back = corner & ~closes & _turns_back(moves)
    refusals.add(JOIN, back, "the contour turns back on itself")
    if manner.corners is Corners.ARC:
        made.around[:] = outside
    else:
        _lengthen(moves, outside, made, refusals)
    _meet(moves, np.flatnonzero(corner & ~outside), made, refusals)


def _lengthen(moves: Moves, outside: Flags, made: Offset, refusals: _Refusals) -> None:
    """Lead around outside corners by lines that meet, or by a line between them."""
    round_it = outside & (moves.arc | _behind(moves.arc))
    refusals.add(JOIN, round_it, "an outside corner beside an arc has no linear joint")
    k = np.flatnonzero(outside & ~round_it)
    u, v, reach = moves.last[:, k - 1], moves.first[:, k], moves.radius[k]
    along = dot(u, v)
    meet = along >= -1e-12  # the offset lines meet within a radius
    reach = np.where(meet, reach * np.sqrt(np.maximum(0.0, 1 - along) / (1 + along)), reach)
    made.across[k] = ~meet
    made.finish[:, k - 1] += reach * u
    made.begin[:, k] -= reach * v


def _meet(moves: Moves, k: Ints, made: Offset, refusals: _Refusals) -> None:
    """Let moves meet those before them inside their corners."""
    u, v = moves.last[:, k - 1], moves.first[:, k]
    reach = moves.off[k] / (1 + dot(u, v))
    at = moves.start[:, k] + reach * (left_of(u) + left_of(v))
    bent = np.flatnonzero(moves.arc[k] | moves.arc[k - 1])
    if len(bent):
        at[:, bent] = _crossing(moves, k[bent])
        none = np.zeros(len(moves.sense), np.bool_)
        none[k[bent]] = np.isnan(at[0, bent])
        refusals.add(JOIN, none, "the tool does not fit into the inside corner", alarm=True)
    made.begin[:, k] = made.finish[:, k - 1] = at


def _crossing(moves: Moves, k: Ints) -> Floats:
    """Return where offset curves (2, m), of which one is a circle, cross those before; or nan."""
    centre, axis, along, size = _circles(moves, k)
    across = np.sqrt(size * size - along * along)
    found = np.full((2, len(k)), np.nan)
    for sign in (1, -1):  # at the other crossing it turns outwards
        point = centre + along * axis + sign * across * left_of(axis)
        turns = cross(moves.heading(k - 1, point), moves.heading(k, point))
        found = np.where(np.isnan(found) & (moves.side[k] * turns >= 0), point, found)
    return found


def _circles(moves: Moves, k: Ints) -> tuple[Floats, Floats, Floats, Floats]:
    """Return circles and lines across them, on which they cross the other curves of corners.

    That is centres (2, m), directions (2, m) at right angles to the lines, how far (m,) the lines
    are away in them, and radii (m,).
    """
    one_bent, other_bent = moves.arc[k - 1], moves.arc[k]
    arc, line = np.where(one_bent, k - 1, k), np.where(one_bent, k, k - 1)
    centre, size = moves.centre[:, arc], moves.reach[arc]
    normal = left_of(moves.last[:, line])
    foot = moves.end[:, line] + moves.off[line] * normal
    along = dot(foot - centre, normal)
    both = one_bent & other_bent
    if both.any():
        way = moves.centre[:, k] - centre
        apart = np.hypot(*way)
        other = moves.reach[k]
        axis = np.where(apart < 1e-9, np.nan, way / apart)
        away = (apart * apart + size * size - other * other) / (2 * apart)
        normal, along = np.where(both, axis, normal), np.where(both, away, along)
    return centre, normal, along, size


def _closes(moves: Moves) -> Flags:
    """Whether the corner before a move (n,) that turns back is the inside of a valley.

    That is where it is an arc that leaves: the tool then comes to rest on both sides of the corner.
    """
    leaves = moves.arc & ~(moves.side * moves.sense > 0)
    return np.asarray(leaves & ((moves.turn > np.pi - SHARP) | (moves.turn < BACK - np.pi)))


def _turns_back(moves: Moves) -> Flags:
    """Whether the corner before a move (n,) is so sharp that it has neither inside nor outside.

    Two lines may turn by 180 degrees, or on the outside by nearly as much.
    """
    bent = moves.arc | _behind(moves.arc)
    sharp = np.where(bent, np.abs(moves.turn), moves.turn) > np.pi - SHARP
    return np.asarray(sharp & (bent | (moves.turn < np.pi - BACK)))


def _swept(moves: Moves, made: Offset) -> Floats:
    """Return the sweeps (n,), rad, of arcs: those of the contour, trimmed at their ends."""
    at_start = angle(moves.start - moves.centre, made.begin - moves.centre)
    at_end = angle(moves.end - moves.centre, made.finish - moves.centre)
    trimmed = moves.sweep + moves.sense * (at_end - at_start)
    whole = angle(made.begin - made.middle, made.finish - made.middle)
    return np.where(np.isnan(made.middle[0]), trimmed, moves.sense * whole % TURN)


def _check_directions(moves: Moves, made: Offset, manner: Manner, refusals: _Refusals) -> None:
    """Refuse moves that their inside corners leave nothing of.

    LinuxCNC looks back at those which end at an inside corner, or are the last.
    """
    inside = np.append(moves.turn[1:] > manner.straight, True)
    alarm = ~moves.begins & (moves.ends | inside)
    arcs = moves.arc & ~moves.begins
    lost = arcs & ~((made.sweep >= 0) & (made.sweep <= moves.sweep + LONGER))
    refusals.add(DIRECTION, lost, "the tool cannot reach the arc between inside corners", alarm)
    more = _turns(made.sweep) > _turns(moves.sweep)
    refusals.add(DIRECTION, arcs & more, "the circle would be cut by more than a turn")
    back = ~moves.arc & ~(dot(made.finish - made.begin, moves.first) >= -1e-9)
    refusals.add(DIRECTION, back, "the tool cannot reach the move between inside corners", alarm)


def _turns(sweep: Floats) -> Floats:
    """Return of how many turns (n,) something is a part."""
    return np.asarray(np.ceil(sweep / TURN - 1e-9))


def _behind(flags: Flags) -> Flags:
    """Return the flags (n,) of the moves before."""
    return np.append(False, flags[:-1])


def _only(flags: Flags, k: Ints) -> Flags:
    """Return the flags (n,) of some moves, and False of all others."""
    only = np.zeros_like(flags)
    only[k] = flags[k]
    return only


def turns_about(ends: Floats, corners: Floats, begins: Floats) -> Floats:
    """Return the angles (n,), rad, about corners from where moves end to where the next begin.

    All points are (2, n), mm.
    """
    return np.abs(angle(ends - corners, begins - corners))
