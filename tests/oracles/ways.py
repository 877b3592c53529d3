"""Where the machine went in two runs of LinuxCNC: the same way, in the same order, with the same
things done at the same places.

Nothing here knows of lines, of a source map or of passes. A run is cut where something else than a
motion happens; between two such places both ways are polylines in machine coordinates, and their
Frechet distance (Alt and Godau, 1995) is held against what the certificate allows: a way there and
back, a corner cut off or an order changed cannot hide as it can from distances of points alone.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise

from oracles.canon import AXES, CanonMove, CanonProgram

Point = tuple[float, ...]
Where = Callable[[Point], Point]
Interval = tuple[float, float]

FINE = 0.001  # mm, of a chord from its arc
BENT = 48  # parts of a move on a machine with errors: between them it is taken for straight
CURVE = 200  # parts of a spline
ANGLES = 2.0  # so much more room (deg per mm) have rotary axes
STILL = 1e-9
PLANES = {"XY": (0, 1, 2), "ZX": (2, 0, 1), "YZ": (1, 2, 0)}
RATE = 0.02  # relative: times of feed moves, whose feeds are rounded, and lengths changed
SHORT = 0.02  # minutes or turns
PRINTED = 0.005  # mm; by so much an axis that stands may seem to move, by the digits printed


@dataclass(frozen=True)
class Way:
    """A polyline: points (X Y Z in mm, A B C scaled), and what each piece is.

    `room` is by how much more (mm) a point may be elsewhere. `spent` are minutes or turns of the
    spindle on feed moves, by the unit.
    """

    points: list[Point]
    kinds: list[str]
    room: list[float]
    spent: Mapping[str, float]


def difference(
    old: CanonProgram,
    new: CanonProgram,
    near: float,
    where: Where = lambda point: point,
    curves: Mapping[int, tuple[Point, ...]] | None = None,
    loose: Mapping[int, float] | None = None,
) -> str:
    """Return what the machine does otherwise in the new run; nothing if it does the same.

    `near` is in mm; `where` says where the machine is with a command of the new run; `curves` are
    the control points of splines of the old run by line, which LinuxCNC does not print. `loose`
    says for lines of the new run by how much more (mm) their rapids may end elsewhere.
    """
    said, now = ([text for _, text in program.told] for program in (old, new))
    if said != now:
        pairs = enumerate(zip(said, now, strict=False))
        at = next((k for k, (a, b) in pairs if a != b), min(len(said), len(now)))
        return f"{said[at : at + 2]} became {now[at : at + 2]}"
    before = ways(old, lambda point: point, 1, curves or {}, {})
    after = ways(new, where, BENT, {}, loose or {})
    for number, (one, other) in enumerate(zip(before, after, strict=True)):
        if problem := ways_differ(one, other, near):
            text = said[number] if number < len(said) else "the end"
            return f"before {text} ({number}): {problem}"
    return ""


def ways(
    program: CanonProgram,
    where: Where,
    parts: int,
    curves: Mapping[int, tuple[Point, ...]],
    loose: Mapping[int, float],
) -> Iterator[Way]:
    """Yield the ways between the things told.

    Where a run begins is a place of the machine, which no command has brought about.
    """
    ends = [at for at, _ in program.told] + [len(program.moves)]
    here: Point = (0.0,) * 6
    first, place, left = 0, placed(here), 0.0
    for end in ends:
        points, room, kinds = [place], [left], list[str]()
        spent: dict[str, float] = {}
        for move in program.moves[first:end]:
            for point in sampled(move, here, parts, curves):
                points.append(placed(where(point)))
                room.append(loose.get(move.line, 0.0) if move.kind == "RAPID" else 0.0)
                kinds.append(move.kind if move.kind in ("RAPID", "PROBE", "TAP") else "CUT")
                last = point
            took(move, here, last, curves, spent)
            here = last if move.kind != "TAP" else here
            if move.kind == "TAP":
                points.append(placed(where(here)))
                room.append(0.0)
                kinds.append("TAP")
        first, place, left = end, points[-1], room[-1]
        yield Way(points, kinds, room, spent)


def placed(point: Point) -> Point:
    return (*point[:3], *(value / ANGLES for value in point[3:]))


def sampled(
    move: CanonMove, here: Point, parts: int, curves: Mapping[int, tuple[Point, ...]]
) -> Iterator[Point]:
    """Yield points of a move, not its first, in machine coordinates."""
    if move.kind == "SPLINE" and move.line in curves:
        control = curves[move.line]
        for k in range(1, CURVE + 1):
            yield bezier(control, k / CURVE)
        return
    end = tuple(move.machine[1][a] for a in AXES)
    if move.centre is None:
        count = parts if move.kind != "RAPID" else 1
        for k in range(1, count + 1):
            yield tuple(a + k / count * (b - a) for a, b in zip(here, end, strict=True))
        return
    yield from arc(move, here, end, tuple(move.machine[2][a] for a in AXES))


def arc(move: CanonMove, here: Point, end: Point, centre: Point) -> Iterator[Point]:
    u, v, _ = PLANES[move.plane]
    r0 = math.hypot(here[u] - centre[u], here[v] - centre[v])
    r1 = math.hypot(end[u] - centre[u], end[v] - centre[v])
    first = math.atan2(here[v] - centre[v], here[u] - centre[u])
    last = math.atan2(end[v] - centre[v], end[u] - centre[u])
    sign = -1 if move.kind == "ARC_CW" else 1
    sweep = (last - first) * sign % math.tau
    if sweep < 1e-6:  # printed with few digits: the end is the start
        sweep = math.tau
    sweep += math.tau * move.turns
    count = max(4, math.ceil(sweep / math.sqrt(8 * FINE / max(r0, r1, FINE))))
    for k in range(1, count + 1):
        t = k / count
        point = [a + t * (b - a) for a, b in zip(here, end, strict=True)]
        radius, angle = r0 + t * (r1 - r0), first + sign * t * sweep
        point[u] = centre[u] + radius * math.cos(angle)
        point[v] = centre[v] + radius * math.sin(angle)
        yield tuple(point) if k < count else end


def bezier(control: tuple[Point, ...], t: float) -> Point:
    """Return a point by de Casteljau."""
    points = control
    while len(points) > 1:
        points = tuple(
            tuple(a + t * (b - a) for a, b in zip(p, q, strict=True)) for p, q in pairwise(points)
        )
    return points[0]


def took(
    move: CanonMove, start: Point, end: Point, curves: object, spent: dict[str, float]
) -> None:
    """Add what a feed move takes; the way of a spline is not printed, nor its time known."""
    if move.kind == "SPLINE":
        spent["minutes"] = math.nan
    if move.feed is None or move.kind not in ("LINE", "ARC_CW", "ARC_CCW"):
        return
    length, rate = math.dist(start[:3], end[:3]), move.feed[0]
    if move.centre is not None:
        here, points = start, [*arc(move, start, end, tuple(move.machine[2][a] for a in AXES))]
        length = 0.0
        for point in points:
            length, here = length + math.dist(here[:3], point[:3]), point
    elif length < PRINTED and math.dist(start[3:], end[3:]) > PRINTED:
        length, rate = math.dist(start[3:], end[3:]), move.feed[1]
    unit = "turns" if move.feed_mode == "G95" else "minutes"
    if rate > 0:
        spent[unit] = spent.get(unit, 0.0) + length / rate


# --- the distance of two polylines ---


def ways_differ(one: Way, other: Way, near: float) -> str:
    """Return how two ways differ: further apart than `near`, or a rapid is none."""
    if not alike(one, other, near):
        wide = near
        while wide < 1e4 and not alike(one, other, wide):
            wide *= 2
        return f"the ways are more than {near:.4f} mm apart, less than {wide:.4f}"
    for unit in one.spent.keys() | other.spent.keys():
        a, b = one.spent.get(unit, 0.0), other.spent.get(unit, 0.0)
        if abs(a - b) > RATE * max(a, b) + SHORT:  # not where one is nan
            return f"{a:.4f} {unit} of feed became {b:.4f}"
    return ""


def alike(one: Way, other: Way, near: float) -> bool:
    """Decide whether a walk along both ways, never back, keeps within `near`."""
    space = Space(without_stops(one), without_stops(other), near)
    return space.crossed()


class Space:
    """The diagram of two ways: a cell for each pair of pieces, of which parts are near enough.

    What is reached of the borders of cells is carried row by row; only cells that are reached are
    looked at. A cell of a rapid and a cut is open only if one of both is a stump.
    """

    def __init__(self, one: Way, other: Way, near: float) -> None:
        self.p, self.q, self.near = one.points, other.points, near
        self.kp, self.kq = one.kinds, other.kinds
        self.room_p, self.room_q = one.room, other.room

    def bottom(self, i: int, j: int) -> Interval | None:
        """Return the part of piece i of the first way that is near point j of the other."""
        p, q = self.p, self.q
        return border(q[j], p[i], p[i + 1], self.near + self.room_q[j])

    def side(self, i: int, j: int) -> Interval | None:
        """Return the part of piece j of the other way that is near point i of the first."""
        room = max(self.room_q[j], self.room_q[j + 1])
        return border(self.p[i], self.q[j], self.q[j + 1], self.near + room)

    def open(self, i: int, j: int) -> bool:
        """Tell whether two pieces may be gone together."""
        if self.kp[i] == self.kq[j]:
            return True
        short = min(math.dist(w[k], w[k + 1]) for w, k in ((self.p, i), (self.q, j)))
        return short <= self.near

    def crossed(self) -> bool:
        """Tell whether the far corner is reached from the near one."""
        p, q, near = self.p, self.q, self.near
        if math.dist(p[0], q[0]) > near + self.room_q[0]:
            return False
        if math.dist(p[-1], q[-1]) > near + self.room_q[-1]:
            return False
        if not self.kp or not self.kq:
            room = max(self.room_q)
            return all(math.dist(a, b) <= near + room for a in p for b in q)
        below, left = self.along_bottom(), self.side(0, 0)
        for j in range(len(self.kq)):
            left = left if left and left[0] <= 0.0 else None
            below, last = self.row(j, below, left)
            if j + 1 < len(self.kq):
                goes_on = left and left[1] >= 1.0 and self.open(0, j + 1)
                left = self.side(0, j + 1) if goes_on else None
        top = below.get(len(self.kp) - 1)
        return bool(top and top[1] >= 1.0) or bool(last and last[1] >= 1.0)

    def along_bottom(self) -> dict[int, Interval]:
        """Return what is reached of the first way while the other stands still."""
        found: dict[int, Interval] = {}
        for i in range(len(self.kp)):
            part = self.bottom(i, 0)
            if part is None or part[0] > 0.0 or (i and not self.open(i, 0)):
                break
            found[i] = part
            if part[1] < 1.0:
                break
        return found

    def row(
        self, j: int, below: dict[int, Interval], side: Interval | None
    ) -> tuple[dict[int, Interval], Interval | None]:
        """Return what is reached of the upper borders of a row, and of its last side."""
        top: dict[int, Interval] = {}
        i = 0
        todo = sorted(below, reverse=True)
        while i < len(self.kp):
            under = below.get(i)
            if side is None and under is None:
                while todo and todo[-1] <= i:
                    todo.pop()
                if not todo:
                    return top, None
                i = todo[-1]
                continue
            up, side = self.through(i, j, under, side)
            if up:
                top[i] = up
            i += 1
        return top, side

    def through(
        self, i: int, j: int, under: Interval | None, side: Interval | None
    ) -> tuple[Interval | None, Interval | None]:
        """Return what is reached of the upper border of a cell and of the side behind it."""
        if self.open(i, j):
            up = reached(self.bottom(i, j + 1), side is not None, under)
            return up, reached(self.side(i + 1, j), under is not None, side)
        ends = (0.0, 0.0)  # a border may be gone along, up to its corner
        return (
            ends if side and side[1] >= 1.0 else None,
            ends if under and under[1] >= 1.0 else None,
        )


def reached(free: Interval | None, whole: bool, before: Interval | None) -> Interval | None:
    """Return the part of a free border that is reached: from the side all, or what is ahead."""
    if free is None:
        return None
    if whole:
        return free
    if before is None or before[0] > free[1]:
        return None
    return max(free[0], before[0]), free[1]


def without_stops(way: Way) -> Way:
    """Return a way without the pieces that lead nowhere."""
    points, kinds, room = [way.points[0]], list[str](), [way.room[0]]
    for point, kind, more in zip(way.points[1:], way.kinds, way.room[1:], strict=True):
        if math.dist(point, points[-1]) > STILL:
            points.append(point)
            kinds.append(kind)
            room.append(more)
    return Way(points, kinds, room, way.spent)


def border(centre: Point, a: Point, b: Point, near: float) -> Interval | None:
    """Return which part of a line is within `near` of a point, 0 to 1."""
    square = half = rest = 0.0
    for x, y, c in zip(a, b, centre, strict=True):  # it is called ten thousand times for a program
        along, away = y - x, x - c
        square += along * along
        half += along * away
        rest += away * away
    rest -= near * near
    root = half * half - square * rest
    if root < 0.0:
        return None
    root = math.sqrt(root)
    low, high = (-half - root) / square, (-half + root) / square
    if high < 0.0 or low > 1.0:
        return None
    return (max(low, 0.0), 1.0 if high >= 1.0 else high)
