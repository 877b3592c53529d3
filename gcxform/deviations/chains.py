"""How far two chains of moves are from one another, in both directions and in the order of travel.

A chain is cut where the other one has its joints: every joint is put beside the point of the other
chain that is nearest to it, none before the joint that went before. What lies between two cuts are
pairs of single moves, and the distance of a pair is bounded along both of them: of two lines by
their ends, of a line beside an arc and of two arcs by `gcxform.deviations.deviation`. Any pairing
in the order of travel gives an upper bound (of the Frechet distance); one that does not find the
nearest points only makes it larger.
"""

from __future__ import annotations

import numpy as np

from gcxform.deviations.deviation import deviation
from gcxform.system.arrays import Flags, Floats, Ints
from gcxform.toolpath.angles import TURN
from gcxform.toolpath.circles import points_on_arcs, radius_and_angle
from gcxform.toolpath.columns import constant
from gcxform.toolpath.path import Kind, Plane, Toolpath
from gcxform.values import dataclass

ROOM = 20_000  # rows compared at once
STEPS = 60  # how far, in rows, a joint is looked for from where lengths say it is
FLAT = 1e-7  # mm; an arc with a smaller sagitta is its chord


@dataclass(frozen=True, slots=True)
class Chain:
    """Rows of a path that follow one another, in groups: `group` (rows,) counts from 0."""

    path: Toolpath
    rows: Ints
    group: Ints

    def of(self, first: int, stop: int) -> Chain:
        """Return the chain of a range of groups."""
        a, b = np.searchsorted(self.group, [first, stop])
        return Chain(self.path, self.rows[a:b], self.group[a:b] - first)


def along_chains(one: Chain, other: Chain) -> Floats:
    """Return how far (mm) each row of `other` and its group of `one` are from one another in X Y Z.

    Both have the same groups; where their places are not known, the distance is inf.
    """
    with np.errstate(invalid="ignore", divide="ignore"):
        a, b = _Side(one), _Side(other)
        here, there, group = _joints(a, b)
        mine, theirs = _Pieces(a, here, group), _Pieces(b, there, group)
        bound = _bounds(mine, theirs)
    worst = np.zeros(len(other.rows))
    np.maximum.at(worst, theirs.row, np.where(np.isnan(bound), np.inf, bound))
    return worst


class _Side:
    """One of the two chains: where its rows start and end, and points on them."""

    def __init__(self, chain: Chain) -> None:
        path = chain.path
        self.group = chain.group
        rows = chain.rows
        count = len(rows)
        # each row stands behind one that leads to its start, so that it is a path of its own
        end = np.empty((2 * count, 3))
        end[0::2], end[1::2] = path.start[rows, :3], path.end[rows, :3]
        self.path = _bare(path.take(np.repeat(rows, 2)), end)
        self.start, self.end = end[0::2], end[1::2]
        self.arc = np.asarray(path.is_arc[rows])
        self.last = np.append(np.diff(self.group) != 0, True)
        self.first = np.append(True, np.diff(self.group) != 0)
        self.sweep = np.asarray(path.sweep[rows])
        arcs = np.flatnonzero(self.arc)
        self.angle, self.radius = np.zeros((2, count))
        first, last, angle = radius_and_angle(self.path, 2 * arcs + 1)
        self.radius[arcs], self.angle[arcs] = np.maximum(first, last), angle
        self.way = self.end - self.start
        self.square = (self.way**2).sum(axis=1)
        self.key = self._keys()
        self.began = np.where(self.first, self.group, np.append(0.0, self.key[:-1]))

    def _keys(self) -> Floats:
        """Return, per row, its group and how much of that has been travelled behind it."""
        normal = np.array([plane.axes[2] for plane in Plane])[self.path.plane[1::2]]
        rise = self.way[np.arange(len(normal)), normal]
        along = np.where(self.arc, np.hypot(self.radius * self.sweep, rise), np.sqrt(self.square))
        total = np.cumsum(along)
        before = (total - along)[self.first][self.group]
        whole = total[self.last][self.group] - before
        return self.group.astype(np.float64) + np.where(whole > 0, (total - before) / whole, 1.0)

    def points(self, row: Ints, part: Floats) -> Floats:
        """Return points (n, 3) at parts of rows."""
        point = self.start[row] + part[:, None] * self.way[row]
        point = np.where((part == 1.0)[:, None], self.end[row], point)
        arcs = np.flatnonzero(self.arc[row] & (part > 0.0) & (part < 1.0))
        if len(arcs):
            point[arcs] = points_on_arcs(self.path, 2 * row[arcs] + 1, part[arcs])
        return np.asarray(point)

    def nearest(self, row: Ints, point: Floats, key: Floats) -> Floats:
        """Return the parts of rows that are nearest to points (n, 3); of arcs, in their plane.

        Of the turns of an arc that is meant where the lengths travelled (`key`) say it should be.
        """
        along = ((point - self.start[row]) * self.way[row]).sum(axis=1)
        part = np.where(self.square[row] > 0, along / self.square[row], 1.0)
        arcs = np.flatnonzero(self.arc[row])
        for plane in Plane:
            here = arcs[self.path.plane[2 * row[arcs] + 1] == plane]
            if len(here):
                part[here] = self._on_arc(row[here], point[here], key[here], plane)
        return np.asarray(np.clip(part, 0.0, 1.0))

    def _on_arc(self, row: Ints, point: Floats, key: Floats, plane: Plane) -> Floats:
        a, b, _ = plane.axes
        u = point - self.path.centre[2 * row + 1]
        turned = (np.arctan2(u[:, b], u[:, a]) - self.angle[row]) * self.path.sense[2 * row + 1]
        sweep, share = self.sweep[row], self.key[row] - self.began[row]
        ahead = np.clip((key - self.began[row]) / np.maximum(share, 1e-12), 0.0, 1.0)
        turned += TURN * np.round((ahead * sweep - turned) / TURN)
        return np.asarray(turned / sweep)

    def distance(self, row: Ints, point: Floats, key: Floats) -> Floats:
        """Return the distances (mm) of points (n, 3) from rows."""
        gap = self.points(row, self.nearest(row, point, key)) - point
        return np.asarray(np.sqrt((gap**2).sum(axis=1)))


def _bare(path: Toolpath, end: Floats) -> Toolpath:
    """Return rows as moves between points (n, 3) and nothing else."""
    count = len(end)
    kind = np.array(path.kind)
    kind[0::2] = Kind.RAPID
    return path.replace(
        axes="XYZ",
        end=end,
        kind=kind,
        lost=constant(0, count, np.int64),
        entry=np.zeros(3),
        slack=0.0,
        events=(),
    )


# --- joints ---


def _joints(one: _Side, other: _Side) -> tuple[Floats, Floats, Ints]:
    """Return where both chains are cut, the ends included: row + part along each, and the group."""
    stops = np.flatnonzero(~other.last)
    place = _places(one, other.end[stops], other.key[stops], other.group[stops])
    inner = np.flatnonzero(~one.last)
    passed = np.searchsorted(place, inner + 1.0, "left") + one.group[inner]
    there = passed + other.nearest(passed, one.end[inner], one.key[inner])
    there = np.maximum.accumulate(there) if len(there) else there
    here = np.concatenate([inner + 1.0, place, np.flatnonzero(one.last) + 1.0])
    beside = np.concatenate([there, stops + 1.0, np.flatnonzero(other.last) + 1.0])
    group = np.concatenate([one.group[inner], other.group[stops], one.group[one.last]])
    order = np.lexsort((beside, here))
    return here[order], beside[order], group[order]


def _places(side: _Side, point: Floats, key: Floats, group: Ints) -> Floats:
    """Return where points (n, 3) are nearest to a chain, ascending, as row + part.

    The search begins where the lengths travelled say that the point should be.
    """
    if not len(point):
        return np.empty(0)
    low = np.searchsorted(side.group, group, "left")
    high = np.searchsorted(side.group, group, "right") - 1
    row = np.clip(np.searchsorted(side.key, key), low, high)
    best = side.distance(row, point, key)
    left = np.arange(len(row))
    for _ in range(STEPS):
        moved = np.zeros(len(left), np.bool_)
        for step in (-1, 1):
            trial = np.clip(row[left] + step, low[left], high[left])
            off = side.distance(trial, point[left], key[left])
            nearer = off < best[left]
            row[left[nearer]], best[left[nearer]] = trial[nearer], off[nearer]
            moved |= nearer
        left = left[moved]
        if not len(left):
            break
    return np.asarray(np.maximum.accumulate(row + side.nearest(row, point, key)))


# --- pairs of single moves ---


class _Pieces:
    """The pieces into which cuts part a chain: `row`, from the part `low` to the part `high`."""

    def __init__(self, side: _Side, cuts: Floats, group: Ints) -> None:
        first = np.flatnonzero(side.first)[group]
        self.row = np.maximum(np.ceil(cuts).astype(np.int64) - 1, first)
        begins = np.append(True, group[1:] != group[:-1])
        before = np.where(begins, first, np.append(0.0, cuts[:-1]))
        self.low = np.clip(before - self.row, 0.0, 1.0)
        self.high = np.clip(cuts - self.row, 0.0, 1.0)
        self.side = side
        self.start = side.points(self.row, self.low)
        self.end = side.points(self.row, self.high)
        self.sweep = side.sweep[self.row] * (self.high - self.low)
        self.sag = side.radius[self.row] * (1 - np.cos(np.minimum(self.sweep, np.pi) / 2))
        self.arc = side.arc[self.row] & (self.sag > FLAT)
        self.plane = side.path.plane[2 * self.row + 1]
        self.sense = side.path.sense[2 * self.row + 1]

    def path(self, pieces: Ints, arc: Flags) -> Toolpath:
        """Return pieces as a path, each behind a row that leads to its start; `arc`: as arcs."""
        rows = np.repeat(2 * self.row[pieces] + 1, 2)
        end = np.empty((2 * len(pieces), 3))
        end[0::2], end[1::2] = self.start[pieces], self.end[pieces]
        path = _bare(self.side.path.take(rows), end)
        kind, sweep = np.array(path.kind), np.zeros(len(rows))
        sweep[1::2] = np.where(arc, self.sweep[pieces], 0.0)
        kind[1::2] = np.where(arc, kind[1::2], np.int8(Kind.LINE))
        return path.replace(kind=kind, sweep=sweep)


def _bounds(one: _Pieces, other: _Pieces) -> Floats:
    """Return an upper bound of the distance (mm) of each pair of pieces."""
    bound = np.maximum(_apart(one.start, other.start), _apart(one.end, other.end))
    bound += np.where(one.arc | other.arc, 0.0, one.sag + other.sag)
    both = one.arc & other.arc
    alike = both & (one.plane == other.plane) & (one.sense == other.sense)
    # of two arcs of which neither follows the other, one counts as its chord and what that is off
    lone = both & ~alike
    extra = np.where(lone, _off_chord(one), 0.0)
    for owner, beside, pieces in (
        (other, one, np.flatnonzero(other.arc)),
        (one, other, np.flatnonzero(one.arc & ~other.arc)),
    ):
        if len(pieces):
            off = _beside_arcs(owner, beside, pieces, alike[pieces])
            bound[pieces] = np.maximum(bound[pieces], off)
    return np.asarray(bound + extra)


def _apart(p: Floats, q: Floats) -> Floats:
    return np.asarray(np.sqrt(((p - q) ** 2).sum(axis=1)))


def _off_chord(pieces: _Pieces) -> Floats:
    """Return how far (mm) arcs are from their chords at most; a helix turns unevenly with it."""
    rise = np.sqrt(((pieces.end - pieces.start) ** 2).sum(axis=1))
    wide = pieces.sweep > np.pi / 2
    return np.where(wide, np.inf, pieces.sag + rise * pieces.sweep**2 / 54)


def _beside_arcs(owner: _Pieces, beside: _Pieces, pieces: Ints, as_arc: Flags) -> Floats:
    """Return how far (mm) pieces are from the arcs beside them; going backwards counts in full."""
    everything = np.ones(len(pieces), np.bool_)
    before, after = owner.path(pieces, everything), beside.path(pieces, as_arc)
    off = deviation(before, after, np.arange(len(before))).distance[1::2]
    a, b = beside.start[pieces], beside.end[pieces]
    back = np.zeros(len(pieces))
    for plane in Plane:
        u, v, _ = plane.axes
        here = np.flatnonzero(~as_arc & (owner.plane[pieces] == plane))
        centre = before.centre[2 * here + 1]
        p, q = a[here] - centre, b[here] - centre
        turned = (p[:, u] * q[:, v] - p[:, v] * q[:, u]) * owner.sense[pieces[here]]
        length = np.hypot(q[:, u] - p[:, u], q[:, v] - p[:, v])
        back[here] = np.where(turned < 0, length, 0.0)
    return np.asarray(off + back)
