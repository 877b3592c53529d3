"""The centre path of a cutter beside a contour: offset moves, inside and outside corners.

Everything is in the coordinates of one plane, mm, scalar. `side` is +1 where the tool is left of
the contour and -1 where it is right. What is computed is what LinuxCNC's interpreter executes:

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
from itertools import pairwise
from math import atan2, ceil, hypot, pi, sqrt, tau

import numpy as np

from gcxform.vocabulary import Floats

Point = tuple[float, float]

SHARP = 0.05  # rad; controls differ on corners that are sharper
WHOLE = 0.5  # rad; an arc that begins compensation has to be so much less than a turn
LONGER = 0.025  # rad; so much may an arc gain where it begins off its own normal
STILL = 1e-6  # mm; what is as near is at one place
BACK = 1e-6  # rad; a line that goes back the way it came


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


@dataclass(slots=True)
class Edge:
    """A move of the contour, and what becomes of it.

    start, end      of the contour; `centre` of an arc, `sense` +1 counter-clockwise, `sweep` in rad
    first, last     unit tangents at start and end
    begin, finish   where the centre path begins and ends it
    corner          what comes before it: "", "arc" or "line"
    middle          centre of the centre path of an arc that begins compensation
    """

    start: Point
    end: Point
    centre: Point | None = None
    sense: int = 0
    sweep: float = 0.0
    first: Point = (0.0, 0.0)
    last: Point = (0.0, 0.0)
    begin: Point = (0.0, 0.0)
    finish: Point = (0.0, 0.0)
    corner: str = ""
    middle: Point | None = None

    def __post_init__(self) -> None:
        self.first = self.direction(self.start)
        self.last = self.first if self.centre is None else self.direction(self.end)

    def direction(self, at: Point) -> Point:
        """Return the unit tangent of the move, or of its offset curve, at a point."""
        if self.centre is None:
            return _unit(self.end[0] - self.start[0], self.end[1] - self.start[1])
        x, y = _unit(at[0] - self.centre[0], at[1] - self.centre[1])
        return (-y * self.sense, x * self.sense)

    @property
    def length(self) -> float:
        """The length of a line."""
        return hypot(self.end[0] - self.start[0], self.end[1] - self.start[1])

    @property
    def radius(self) -> float:
        """The radius of an arc at its start."""
        assert self.centre is not None
        return hypot(self.start[0] - self.centre[0], self.start[1] - self.centre[1])

    def reach(self, side: int, radius: float) -> float:
        """Return the radius of an arc's centre path."""
        return self.radius - side * self.sense * radius


def offset(edges: list[Edge], side: int, radius: float, manner: Manner) -> None:
    """Compensate the moves of a contour, in place; the first begins compensation.

    Raises CannotOffsetError.
    """
    _begin(edges, side, radius, manner)
    turns = [_turn(one, other, side) for one, other in pairwise(edges)]
    for index in range(1, len(edges)):
        edge = edges[index]
        if edge.centre is not None and edge.reach(side, radius) < 1e-9:
            message = "the radius of the arc is not larger than the tool's"
            raise CannotOffsetError(index, message, alarm=True)
        edge.begin = _beside(edge.start, edge.first, side, radius)
        edge.finish = _beside(edge.end, edge.last, side, radius)
        if index > 1 or manner.entry is Entry.OWN:
            _join(edges, index, turns[index - 1], side, radius, manner)
        else:
            edges[0].finish = edge.begin
    for index in range(len(edges)):
        _check_direction(edges, index, _ends_inside(index, turns, manner))


def swept(edge: Edge) -> float:
    """Return the sweep (rad) of the centre path of an arc: the contour's, trimmed at its ends."""
    assert edge.centre is not None
    if edge.middle is not None:
        return edge.sense * _angle(edge.begin, edge.finish, edge.middle) % tau
    at_start = _angle(edge.start, edge.begin, edge.centre)
    at_end = _angle(edge.end, edge.finish, edge.centre)
    return edge.sweep + edge.sense * (at_end - at_start)


def _begin(edges: list[Edge], side: int, radius: float, manner: Manner) -> None:
    """Place the move that begins compensation."""
    edge = edges[0]
    if edge.centre is not None:
        _begin_with_arc(edge, side, radius, manner)
        return
    if edge.length <= radius:
        raise CannotOffsetError(
            0,
            f"the move that begins compensation is {edge.length:.4f} mm long, which is not more "
            f"than the tool's radius of {radius:.4f} mm",
            alarm=True,
        )
    edge.begin = edge.start
    edge.finish = _beside(edge.end, edge.last, side, radius)


def _begin_with_arc(edge: Edge, side: int, radius: float, manner: Manner) -> None:
    """Place an arc that begins compensation: from its start, and in its direction at its end.

    Its centre is on the line from the point beside its end, f, to the programmed one, along the
    unit vector u, at t from f: |p - f - t u| = |t| with p its start, so t = |p - f|^2 / 2 (p - f).u
    """
    assert edge.centre is not None
    if not manner.enters_by_arc:
        raise CannotOffsetError(0, "compensation begins with an arc")
    if edge.radius <= radius:
        message = "the radius of the arc that begins compensation is not larger than the tool's"
        raise CannotOffsetError(0, message, alarm=True)
    edge.begin, edge.finish = edge.start, _beside(edge.end, edge.last, side, radius)
    u = _unit(edge.centre[0] - edge.end[0], edge.centre[1] - edge.end[1])
    w = edge.start[0] - edge.finish[0], edge.start[1] - edge.finish[1]
    along = w[0] * u[0] + w[1] * u[1]
    if along <= STILL or edge.sweep > tau - WHOLE:
        raise CannotOffsetError(0, "the arc that begins compensation is nearly a whole circle")
    reach = (w[0] ** 2 + w[1] ** 2) / (2 * along)
    edge.middle = edge.finish[0] + reach * u[0], edge.finish[1] + reach * u[1]


def _join(
    edges: list[Edge], index: int, turn: float, side: int, radius: float, manner: Manner
) -> None:
    """Join a move with the one before it at their corner, at which the contour makes a turn."""
    one, other = edges[index - 1], edges[index]
    if abs(turn) <= manner.straight:
        other.begin = one.finish
    elif one.middle is not None and not turn < 0:
        raise CannotOffsetError(index, "an inside corner behind an arc that begins compensation")
    elif _closes(other, turn, side):
        one.finish = other.begin = _meeting(one, other, index, side, radius)
    elif _turns_back(one, other, turn):
        raise CannotOffsetError(index, "the contour turns back on itself")
    elif turn < 0 or turn > pi - BACK:
        _outside(one, other, index, radius, manner)
    else:
        one.finish = other.begin = _meeting(one, other, index, side, radius)


def _outside(one: Edge, other: Edge, index: int, radius: float, manner: Manner) -> None:
    """Lead around an outside corner."""
    if manner.corners is Corners.ARC:
        other.corner = "arc"
        return
    if one.centre is not None or other.centre is not None:
        raise CannotOffsetError(index, "an outside corner beside an arc has no linear joint")
    u, v = one.last, other.first
    along = u[0] * v[0] + u[1] * v[1]
    reach = radius
    if along >= -1e-12:  # the offset lines meet within a radius
        reach = radius * sqrt(max(0.0, 1 - along) / (1 + along))
    else:
        other.corner = "line"
    one.finish = (one.finish[0] + reach * u[0], one.finish[1] + reach * u[1])
    other.begin = (other.begin[0] - reach * v[0], other.begin[1] - reach * v[1])


def _meeting(one: Edge, other: Edge, index: int, side: int, radius: float) -> Point:
    """Return where the offset curves of two neighbours meet inside their corner."""
    if one.centre is None and other.centre is None:
        u, v = one.last, other.first
        along = u[0] * v[0] + u[1] * v[1]
        reach = side * radius / (1 + along)
        x, y = other.start
        return (x - reach * (u[1] + v[1]), y + reach * (u[0] + v[0]))
    for point in _crossings(one, other, side, radius):
        u, v = one.direction(point), other.direction(point)
        if side * (u[0] * v[1] - u[1] * v[0]) >= 0:  # at the other crossing it turns outwards
            return point
    raise CannotOffsetError(index, "the tool does not fit into the inside corner", alarm=True)


def _crossings(one: Edge, other: Edge, side: int, radius: float) -> list[Point]:
    """Return the points where two offset curves, at least one of them a circle, cross."""
    if one.centre is None:
        return _line_and_circle(one, other, side, radius)
    if other.centre is None:
        return _line_and_circle(other, one, side, radius)
    a, b = one.reach(side, radius), other.reach(side, radius)
    dx, dy = other.centre[0] - one.centre[0], other.centre[1] - one.centre[1]
    apart = hypot(dx, dy)
    if apart < 1e-9:
        return []
    along = (apart * apart + a * a - b * b) / (2 * apart)
    return _either_side(one.centre, (dx / apart, dy / apart), along, a)


def _line_and_circle(line: Edge, arc: Edge, side: int, radius: float) -> list[Point]:
    assert arc.centre is not None
    ux, uy = line.last
    foot = side * radius
    px, py = line.end[0] - foot * uy, line.end[1] + foot * ux
    across = (px - arc.centre[0]) * -uy + (py - arc.centre[1]) * ux
    return _either_side(arc.centre, (-uy, ux), across, arc.reach(side, radius))


def _either_side(centre: Point, axis: Point, along: float, size: float) -> list[Point]:
    """Return the points of a circle that are `along` away from its centre in an axis' direction."""
    rest = size * size - along * along
    if rest < 0:
        return []
    x, y = centre[0] + along * axis[0], centre[1] + along * axis[1]
    across = sqrt(rest)
    return [
        (x - across * axis[1], y + across * axis[0]),
        (x + across * axis[1], y - across * axis[0]),
    ]


def _closes(other: Edge, turn: float, side: int) -> bool:
    """Whether a corner that turns back is the inside of a valley, because the arc after it leaves.

    The tool then comes to rest on both sides of it.
    """
    if other.centre is None or side * other.sense > 0:
        return False
    return turn > pi - SHARP or turn < BACK - pi


def _turns_back(one: Edge, other: Edge, turn: float) -> bool:
    """Whether a corner is so sharp that it has neither an inside nor an outside.

    Two lines may turn by 180 degrees, or on the outside by nearly as much.
    """
    if one.centre is not None or other.centre is not None:
        return abs(turn) > pi - SHARP
    return pi - SHARP < turn < pi - BACK


def _ends_inside(index: int, turns: list[float], manner: Manner) -> bool:
    """Whether a move ends at an inside corner or is the last: there LinuxCNC looks back at it."""
    if index in (0, len(turns)):
        return index > 0
    return turns[index] > manner.straight


def _turn(one: Edge, other: Edge, side: int) -> float:
    """Return the angle (rad) by which a contour turns from move to move; inwards is positive."""
    u, v = one.last, other.first
    return side * atan2(u[0] * v[1] - u[1] * v[0], u[0] * v[0] + u[1] * v[1])


def _check_direction(edges: list[Edge], index: int, alarm: bool) -> None:
    """Refuse a move that its inside corners leave nothing of."""
    edge = edges[index]
    if edge.middle is not None:
        return
    if edge.centre is not None:
        sweep = swept(edge)
        if not 0 <= sweep <= edge.sweep + LONGER:
            message = "the tool cannot reach the arc between inside corners"
            raise CannotOffsetError(index, message, alarm)
        if ceil(sweep / tau - 1e-9) > ceil(edge.sweep / tau - 1e-9):
            raise CannotOffsetError(index, "the circle would be cut by more than a turn")
        return
    way = (edge.finish[0] - edge.begin[0]) * edge.first[0]
    way += (edge.finish[1] - edge.begin[1]) * edge.first[1]
    if way < -1e-9:
        message = "the tool cannot reach the move between inside corners"
        raise CannotOffsetError(index, message, alarm)


def _beside(at: Point, along: Point, side: int, radius: float) -> Point:
    """Return the point beside another, at right angles to a direction."""
    return (at[0] - side * radius * along[1], at[1] + side * radius * along[0])


def _unit(x: float, y: float) -> Point:
    size = hypot(x, y)
    return (x / size, y / size)


def _angle(one: Point, other: Point, centre: Point) -> float:
    """Return the angle (rad, -pi to pi) from one point to another as seen from a centre."""
    ux, uy = one[0] - centre[0], one[1] - centre[1]
    vx, vy = other[0] - centre[0], other[1] - centre[1]
    return atan2(ux * vy - uy * vx, ux * vx + uy * vy)


def turns_about(ends: Floats, corners: Floats, begins: Floats) -> Floats:
    """Return the angles (n,), rad, about corners from where moves end to where the next begin.

    All points are (n, 2), mm.
    """
    (ux, uy), (vx, vy) = (ends - corners).T, (begins - corners).T
    return np.asarray(np.abs(np.arctan2(ux * vy - uy * vx, ux * vx + uy * vy)))
