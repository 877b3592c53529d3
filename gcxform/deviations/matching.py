"""Which parts of two toolpaths are the same travel, where nothing says which row came from which.

Two programs may cut one path at different places: a line against its pieces, an arc against chords,
pieces against other pieces. Both paths are walked together, and whichever row ends first cuts the
other, until both are rows that belong together one by one:

    A  |-----------|-----|        A  |----|------|-----|
    B  |----|------------|   ->   B  |----|------|-----|

Any such pairing gives an upper bound of the distance of the paths, so that a choice that is not the
best can only make it larger. What does not fit anywhere within `reach` is where the paths part.

Where nothing fits, the path that stays nearer goes on alone while it is within reach. Where one
program alone says where an axis is, the rest is compared, and they are not the same.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from gcxform.system.arrays import Floats, Ints
from gcxform.system.stages import stage
from gcxform.toolpath.circles import points_on_arcs
from gcxform.toolpath.path import Kind, Plane, Toolpath
from gcxform.values import dataclass

Point = Sequence[float]
Apart = Callable[[Point, Point], float]

LEAST = 1e-9  # part of a row; cuts are no nearer to each other
PREFERRED = 3.0  # two ends are a pair also this many times farther apart than a late cut would be
CLEAR = 4.0  # two ends are surely a pair if the rows about them are this many times longer
STREAK = 8  # pairs in a row after which many are looked at together
RUN = 1 << 12  # rows looked at together
TURN = 2 * math.pi
SAID = 1000  # turns of the walk after which it says how far it is
CHORD = math.pi + 0.1  # rad; a chord stands for no more of an arc


@dataclass(frozen=True)
class Pieces:
    """Parts of rows of a path: piece k goes from part `low` to part `high` of row `row`.

    A piece with low == high is a point at which the path stands while the other one moves a little.
    """

    row: Ints
    low: Floats
    high: Floats

    def __len__(self) -> int:
        return len(self.row)


@dataclass(frozen=True)
class Matching:
    """Pieces of two paths, one by one; `parted` are the rows from which nothing fits, if any."""

    a: Pieces
    b: Pieces
    parted: tuple[int, int] | None = None


def match(
    a: Toolpath, b: Toolpath, tolerance: float, reach: float, partly: bool = False
) -> Matching:
    """Return the pieces of two paths over the same axes that belong together.

    Ends within `tolerance` (mm, degrees) are one point; beyond `reach` nothing fits. An axis whose
    place is known in one path only fits nothing, or `partly` anything: see `matched`.
    """
    walk = _Walk(_Side(a), _Side(b), tolerance, reach, partly)
    parted = walk.run()
    return Matching(walk.a.pieces(), walk.b.pieces(), parted)


def cut(path: Toolpath, pieces: Pieces) -> Toolpath:
    """Return the path that consists of pieces of the rows of a path, without events."""
    new = path.take(pieces.row)
    end, kind, sweep = new.end.copy(), new.kind.copy(), new.sweep * (pieces.high - pieces.low)
    inner = np.flatnonzero(pieces.high < 1.0)
    start = path.start[pieces.row[inner]]
    at = pieces.high[inner, None]
    end[inner] = np.where(at > 0, start + at * (end[inner] - start), start)
    arcs = inner[new.is_arc[inner]]
    if len(arcs):
        end[arcs, :3] = points_on_arcs(path, pieces.row[arcs], pieces.high[arcs])
    points = pieces.low == pieces.high
    kind[points], sweep[points] = Kind.LINE, 0.0
    return new.replace(end=end, kind=kind, sweep=sweep, events=())


def moving_rows(path: Toolpath) -> Ints:
    """Return the rows that go anywhere: arcs, and what does not end exactly where it starts."""
    start, end = path.start, path.end
    still = (start == end) | (np.isnan(start) & np.isnan(end))
    return np.flatnonzero(~still.all(axis=1) | path.is_arc)


# --- the walk ---


class _Walk:
    """Two paths, each done up to some place."""

    def __init__(self, a: _Side, b: _Side, tolerance: float, reach: float, partly: bool) -> None:
        self.a, self.b = a, b
        self.apart = _partly_apart if partly else _apart
        self.tolerance, self.reach = tolerance, reach
        self.streak = 0

    def run(self) -> tuple[int, int] | None:
        """Walk to the end; return the rows at which the paths part, None if they do not."""
        a, b, turns = self.a, self.b, 0
        while not (a.over and b.over):
            turns += 1
            if turns % SAID == 0:
                stage("comparing", a.at / max(len(a.rows), 1))
            if self.streak >= STREAK:
                self._many()
            elif not (self._step() or self._waits()):
                return a.row, b.row
        return None

    def _many(self) -> None:
        """Take the rows from here on that end at the same points, many at once."""
        a, b = self.a, self.b
        self.streak = 0
        count = min(RUN, len(a.rows) - a.at, len(b.rows) - b.at)
        if a.part or b.part or not count:
            return
        one, other = slice(a.at, a.at + count), slice(b.at, b.at + count)
        gap = a.end[one] - b.end[other]
        gap[np.isnan(a.end[one]) & np.isnan(b.end[other])] = 0.0
        apart = np.sqrt(np.einsum("ij,ij->i", gap, gap))
        same = apart <= np.minimum(self.tolerance, np.minimum(a.clear[one], b.clear[other]))
        same &= (a.kind[one] == b.kind[other]) & (np.abs(a.sweep[one] - b.sweep[other]) < 1.0)
        count = count if same.all() else int(np.argmin(same))
        a.take_rows(count)
        b.take_rows(count)
        self.streak = STREAK if count == RUN else 0

    def _step(self) -> bool:
        """Pair the present rows, one of them cut if need be; return whether they fit."""
        a, b = self.a, self.b
        if a.over or b.over or a.rapid != b.rapid:
            return False
        otherwise = _turns_otherwise(a.sweep_left, b.sweep_left)
        pair = math.inf if otherwise else self.apart(a.goal, b.goal)
        if pair <= min(self.tolerance, a.clear[a.at], b.clear[b.at]):
            return self._take(1.0, 1.0)
        on_a, to_a = a.nearest(b, self.apart)
        on_b, to_b = b.nearest(a, self.apart)
        least = min(to_a, to_b, pair)
        if not least <= self.reach:
            return False
        late = on_a >= (1.0 + a.part) / 2 if to_a <= to_b else on_b >= (1.0 + b.part) / 2
        if pair <= least or (late and pair <= PREFERRED * least):
            return self._take(1.0, 1.0)
        return self._take(on_a, 1.0) if to_a <= to_b else self._take(1.0, on_b)

    def _take(self, high_a: float, high_b: float) -> bool:
        self.streak = self.streak + 1 if high_a == high_b else 0
        self.a.take(high_a)
        self.b.take(high_b)
        return True

    def _waits(self) -> bool:
        """Let one path go a little way, which the other does not have; return whether one can.

        It is the one that stays nearer to where the other stands. Where a path is moved as a whole
        along its way, such is what is left of a move before a rapid.
        """
        a, b = self.a, self.b
        one, other = a.away_from(b), b.away_from(a)
        if not min(one, other) <= self.reach:
            return False
        moving, waiting = (a, b) if one <= other else (b, a)
        moving.take(1.0)
        waiting.stay()
        self.streak = 0
        return True


def _turns_otherwise(one: float, other: float) -> bool:
    """Return whether sweeps (rad) cannot be one travel, though the ends of the moves may agree."""
    return abs(one - other) > (math.pi if one and other else CHORD)


class _Side:
    """A path while it is walked: the present row is `rows[at]`, done up to `part`."""

    def __init__(self, path: Toolpath) -> None:
        self.path = path
        self.rows = moving_rows(path)
        self.start, self.end = path.start[self.rows], path.end[self.rows]
        self.kind, self.sweep = path.kind[self.rows], path.sweep[self.rows]
        self.clear = self._clear()
        self.at, self.part = 0, 0.0
        self.taken: list[tuple[int, float, float]] = []

    def _clear(self) -> Floats:
        """Return how near to the end of each row nothing else of the path ends."""
        way = np.nan_to_num(self.end - self.start, nan=np.inf)
        length = np.sqrt(np.einsum("ij,ij->i", way, way))
        length[np.isinf(way).any(axis=1) | (self.sweep > 0)] = np.inf
        following = np.append(length[1:], np.inf)[: len(length)]
        return np.asarray(np.minimum(length, following) / CLEAR)

    @property
    def over(self) -> bool:
        """Whether there are no more rows."""
        return self.at >= len(self.rows)

    @property
    def row(self) -> int:
        """The row of the path that comes next, the last one at the end, -1 if there is none."""
        return int(self.rows[min(self.at, len(self.rows) - 1)]) if len(self.rows) else -1

    @property
    def rapid(self) -> bool:
        """Whether the present row is a rapid."""
        return bool(self.kind[self.at] == Kind.RAPID)

    @property
    def goal(self) -> Point:
        """Where the present row ends."""
        return _listed(self.end[self.at])

    @property
    def sweep_left(self) -> float:
        """How far (rad) the present row still turns."""
        return float(self.sweep[self.at]) * (1.0 - self.part)

    @property
    def turn_left(self) -> float:
        """How far (mm) the present row still goes about its centre."""
        if not self.sweep[self.at]:
            return 0.0
        u, v, centre = self._circle()
        start = self.start[self.at]
        return self.sweep_left * math.hypot(start[u] - centre[u], start[v] - centre[v])

    def take(self, high: float) -> None:
        """Take the present row up to a part of it."""
        self.taken.append((int(self.rows[self.at]), self.part, high))
        self.part = high
        if high >= 1.0:
            self.at, self.part = self.at + 1, 0.0

    def take_rows(self, count: int) -> None:
        """Take whole rows."""
        self.taken += [(row, 0.0, 1.0) for row in self.rows[self.at : self.at + count].tolist()]
        self.at += count

    def stay(self) -> None:
        """Take the point at which the path stands."""
        if self.part or not self.at:
            self.taken.append((int(self.rows[self.at]), self.part, self.part))
        else:
            self.taken.append((int(self.rows[self.at - 1]), 1.0, 1.0))

    def pieces(self) -> Pieces:
        """Return what was taken."""
        row, low, high = zip(*self.taken, strict=True) if self.taken else ((), (), ())
        return Pieces(np.array(row, np.int64), np.array(low, float), np.array(high, float))

    def here(self) -> Point:
        """Return where the path stands."""
        if self.part:
            return self._point(self.part)
        return _listed(self.end[self.at - 1] if self.at else self.start[0])

    def away_from(self, other: _Side) -> float:
        """Return how far the rest of the present row goes at most from where another path stands.

        It is inf if there is no row, or the other path has no place.
        """
        if self.over or not len(other.rows):
            return math.inf
        return max(_apart(self.goal, other.here()), self.turn_left)

    def nearest(self, other: _Side, apart: Apart) -> tuple[float, float]:
        """Return the part of this row nearest to where the other one's row ends, and how far it is.

        Only what is inside the rest of the row counts: otherwise the distance is inf.
        """
        goal = other.goal
        part = self._on_arc(goal, other) if self.sweep[self.at] else self._on_line(goal)
        part = max(part, self.part + LEAST)
        turned = float(self.sweep[self.at]) * (part - self.part)
        if part > 1.0 - LEAST or _turns_otherwise(turned, other.sweep_left):
            return 1.0, math.inf
        return part, apart(self._point(part), goal)

    def _on_line(self, point: Point) -> float:
        """Return the part of the present line at which a point stands; 1 if it is not known."""
        along, square = 0.0, 0.0
        for p, q, x in zip(_listed(self.start[self.at]), self.goal, point, strict=True):
            if math.isnan(p) != math.isnan(q):
                return 1.0
            if not (math.isnan(p) or math.isnan(x)):
                along += (x - p) * (q - p)
                square += (q - p) ** 2
        return along / square if square else 1.0

    def _on_arc(self, point: Point, other: _Side) -> float:
        """Return the part of the present arc at which a point stands, where `other` ends.

        Of all turns the one is taken that the other's own turning leads to.
        """
        u, v, centre = self._circle()
        start, sweep = self.start[self.at], float(self.sweep[self.at])
        first = math.atan2(start[v] - centre[v], start[u] - centre[u])
        last = math.atan2(point[v] - centre[v], point[u] - centre[u])
        turned = self._sense * (last - first)
        if not math.isfinite(turned):
            return 1.0
        wanted = self.part * sweep + (other.sweep_left or math.pi / 2)
        return (turned + TURN * round((wanted - turned) / TURN)) / sweep

    @property
    def _sense(self) -> float:
        return 1.0 if self.kind[self.at] == Kind.ARC_CCW else -1.0

    def _circle(self) -> tuple[int, int, Point]:
        """Return the two axes of the present arc's plane, and its centre."""
        row = int(self.rows[self.at])
        u, v, _ = Plane(int(self.path.plane[row])).axes
        return u, v, _listed(self.path.centre[row])

    def _point(self, part: float) -> Point:
        """Return the point at a part of the present row."""
        start, goal = _listed(self.start[self.at]), self.goal
        point = [p + part * (q - p) for p, q in zip(start, goal, strict=True)]
        if self.sweep[self.at]:
            u, v, centre = self._circle()
            first = math.hypot(start[u] - centre[u], start[v] - centre[v])
            last = math.hypot(goal[u] - centre[u], goal[v] - centre[v])
            radius = first + part * (last - first)
            angle = math.atan2(start[v] - centre[v], start[u] - centre[u])
            angle += self._sense * float(self.sweep[self.at]) * part
            point[u] = centre[u] + radius * math.cos(angle)
            point[v] = centre[v] + radius * math.sin(angle)
        return point


def _listed(position: Floats) -> Point:
    """Return a position as plain numbers, which are faster one by one."""
    numbers: list[float] = position.tolist()
    return numbers


def _apart(p: Point, q: Point) -> float:
    """Return the distance of two positions, a degree counted as a mm; inf if one knows less."""
    square = 0.0
    for x, y in zip(p, q, strict=True):
        if not (math.isnan(x) and math.isnan(y)):
            square += (x - y) ** 2
    return math.inf if math.isnan(square) else math.sqrt(square)


def _partly_apart(p: Point, q: Point) -> float:
    """Return the distance of two positions by the axes that both know."""
    gaps = (x - y for x, y in zip(p, q, strict=True))
    return math.sqrt(sum(gap**2 for gap in gaps if not math.isnan(gap)))
