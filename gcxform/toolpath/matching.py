"""Which parts of two toolpaths are the same travel, where nobody wrote down which row came from which.

Two programs may cut one path at different places: a line against its pieces, an arc against chords,
pieces against other pieces. Both paths are walked together, and whichever row ends first cuts the
other, until both are rows that belong together one by one:

    A  |-----------|-----|        A  |----|------|-----|
    B  |----|------------|   ->   B  |----|------|-----|

Any such pairing gives an upper bound of the distance of the paths, so that a choice that is not the
best can only make it larger. What does not fit anywhere within `reach` is where the paths part.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from gcxform.dialect import LINEAR
from gcxform.toolpath.circles import points_on_arcs
from gcxform.toolpath.deviation import deviation
from gcxform.toolpath.path import Kind, Toolpath

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Flags = NDArray[np.bool_]
Point = tuple[float, ...]

TURN = 2 * math.pi
LEAST = 1e-9  # part of a row; a cut nearer to its ends is at the end
PREFERRED = 3.0  # a pair of ends this many times farther than a cut is still a pair
RUN = 1 << 12  # rows that are looked at together where two paths are cut alike
HALF_TURN = math.pi + 0.1  # rad; a chord does not stand for more of an arc


@dataclass(frozen=True)
class Pieces:
    """Parts of rows of one path: piece k goes from part `low` to part `high` of row `row`."""

    row: Ints
    low: Floats
    high: Floats

    def __len__(self) -> int:
        return len(self.row)


@dataclass(frozen=True)
class Matching:
    """Pieces of two paths, one by one; `parted` are the rows at which no more fit, if any."""

    a: Pieces
    b: Pieces
    parted: tuple[int, int] | None = None


@dataclass(frozen=True)
class Distance:
    """Per pair of pieces: distance (mm), angle (degrees), and whether only ends were compared."""

    distance: Floats
    angle: Floats
    ends_only: Flags


def match(a: Toolpath, b: Toolpath, tolerance: float, reach: float) -> Matching:
    """Return the pieces of two paths over the same axes that belong together.

    Ends within `tolerance` (mm, degrees) are one point; beyond `reach` nothing fits.
    """
    walk = _Walk(_Side(a), _Side(b), tolerance, reach)
    parted = walk.run()
    return Matching(walk.a.pieces(), walk.b.pieces(), parted)


def measure(a: Toolpath, b: Toolpath, matching: Matching) -> Distance:
    """Return how far the matched pieces are apart, along each of them and not only at its end."""
    one, other = cut(a, matching.a), cut(b, matching.b)
    owner = np.arange(len(one))
    there, back = deviation(one, other, owner), deviation(other, one, owner)
    nearer = there.distance <= back.distance
    return Distance(
        np.minimum(there.distance, back.distance),
        np.where(nearer, there.angle, back.angle),
        there.unknown_start | back.unknown_start | (one.kind == Kind.RAPID),
    )


def cut(path: Toolpath, pieces: Pieces) -> Toolpath:
    """Return the path that consists of pieces of the rows of a path."""
    new = path.take(pieces.row)
    start, end = path.start[pieces.row], path.end[pieces.row]
    inner = np.flatnonzero(pieces.high < 1.0)
    if len(inner):
        end = end.copy()
        way = end[inner] - start[inner]
        end[inner] = start[inner] + pieces.high[inner, None] * way
        arcs = inner[new.is_arc[inner]]
        end[arcs, :3] = points_on_arcs(path, pieces.row[arcs], pieces.high[arcs])
    return new.replace(end=end, sweep=new.sweep * (pieces.high - pieces.low), events=())


def moving_rows(path: Toolpath) -> Ints:
    """Return the rows that go anywhere: arcs, and what does not end exactly where it starts."""
    start, end = path.start, path.end
    still = (start == end) | (np.isnan(start) & np.isnan(end))
    return np.flatnonzero(~still.all(axis=1) | path.is_arc)


# --- one of the two paths ---------------------------------------------------------------------------


@dataclass
class _Side:
    """A path while it is walked: row `rows[at]` is done up to `part`."""

    path: Toolpath
    at: int = 0
    part: float = 0.0
    _row: list[int] = field(default_factory=list)
    _low: list[float] = field(default_factory=list)
    _high: list[float] = field(default_factory=list)

    def __post_init__(self) -> None:
        path = self.path
        self.rows = moving_rows(path)
        self.end = path.end[self.rows]
        self.start = path.start[self.rows]
        self.rapid = path.kind[self.rows] == Kind.RAPID
        self.arc = path.is_arc[self.rows]
        self.linear = [k for k, axis in enumerate(path.axes) if axis in LINEAR]

    def __len__(self) -> int:
        return len(self.rows)

    @property
    def over(self) -> bool:
        """Whether there is no more."""
        return self.at >= len(self.rows)

    def take(self, high: float) -> None:
        """Take the present row up to a part of it."""
        self._row.append(int(self.rows[self.at]))
        self._low.append(self.part)
        self._high.append(high)
        self.part = high
        if high >= 1.0:
            self.at, self.part = self.at + 1, 0.0

    def stay(self) -> None:
        """Take a piece without length where the path stands."""
        at = max(self.at - 1, 0)
        self._row.append(int(self.rows[at]))
        self._low.append(1.0)
        self._high.append(1.0)

    def take_whole(self, count: int) -> None:
        """Take whole rows."""
        self._row += self.rows[self.at : self.at + count].tolist()
        self._low += [0.0] * count
        self._high += [1.0] * count
        self.at += count

    def pieces(self) -> Pieces:
        """Return what was taken."""
        return Pieces(
            np.array(self._row, np.int64), np.array(self._low, float), np.array(self._high, float)
        )

    def here(self) -> Point:
        """Return where the present row ends."""
        return tuple(self.end[self.at].tolist())

    def sweep_left(self) -> float:
        """Return how far (rad) the present row still turns."""
        return float(self.path.sweep[self.rows[self.at]]) * (1.0 - self.part)

    def nearest(self, point: Point) -> tuple[float, float]:
        """Return the part of what is left of the present row that is nearest, and how far it is."""
        start, end = self.start[self.at].tolist(), self.end[self.at].tolist()
        if any(math.isnan(p) != math.isnan(q) for p, q in zip(start, end, strict=True)):
            return 1.0, math.inf
        part = self._along_arc(point) if self.arc[self.at] else _along(start, end, point)
        part = min(max(part, self.part, LEAST), 1.0)
        return part, _apart(self._point(part, start, end), point)

    def _point(self, part: float, start: list[float], end: list[float]) -> Point:
        at = [p + part * (q - p) for p, q in zip(start, end, strict=True)]
        if self.arc[self.at]:
            row = self.rows[self.at : self.at + 1]
            at[:3] = points_on_one(self.path, int(row[0]), part, start, end)
        return tuple(at)

    def _along_arc(self, point: Point) -> float:
        """Return the part of the present arc at which a point stands, nearest to where it is."""
        row = int(self.rows[self.at])
        u, v, normal = _plane(self.path, row)
        centre = self.path.centre[row]
        start = self.start[self.at]
        sense = 1.0 if self.path.kind[row] == Kind.ARC_CCW else -1.0
        first = math.atan2(start[v] - centre[v], start[u] - centre[u])
        angle = math.atan2(point[v] - centre[v], point[u] - centre[u])
        sweep = float(self.path.sweep[row])
        turned = math.fmod(sense * (angle - first), TURN)
        whole = self._whole_turns(point, row, normal, sweep, turned)
        return (turned + TURN * whole) / sweep

    def _whole_turns(
        self, point: Point, row: int, normal: int, sweep: float, turned: float
    ) -> int:
        """Return how many turns to add: to what is next, or to the height on a helix."""
        wanted = self.part
        rise = float(self.path.end[row, normal] - self.start[self.at, normal])
        if abs(rise) > 0 and math.isfinite(rise):
            wanted = max(wanted, (point[normal] - float(self.start[self.at, normal])) / rise)
            return round((min(wanted, 1.0) * sweep - turned) / TURN)
        return math.ceil((wanted * sweep - turned) / TURN - 1e-9)
