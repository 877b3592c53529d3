"""How far rows are from the splines that own them.

A spline beside a spline is off by at most the largest distance of their control points, for a
difference of Bezier curves is one, and stays in the hull of its control points. Lines beside a
spline are taken for a part of it each: where a line ends, the point of the spline is sought that is
nearest. Wherever that leads, the difference of the part and the line is a Bezier curve again, and
its hull, after some halvings, is a bound. The search begins at the same share of the length, and
once more at the same share of the parameter; at a cusp it may lead astray, so where it began is
tried as well. The smallest bound counts. Nothing here knows how splines are cut.
"""

from __future__ import annotations

import numpy as np

from gcxform.system.arrays import Floats, Ints
from gcxform.toolpath.path import Toolpath

SAMPLES = 64  # of a spline, for the first guess of where a line ends
STEPS = 12  # of the search for the nearest point
HALVINGS = 4  # of a part: its hull is then larger than itself by 1/200 of its sag at most
THIRDS = np.arange(4)[:, None] / 3.0


def beside_splines(before: Toolpath, after: Toolpath, rows: Ints, owner: Ints) -> Floats:
    """Return how far (mm) rows of `after` are from their owners in `before`, in X, Y, Z.

    `owner` (rows,) never decreases; all rows of an owner are there. inf where only one of the two
    is a spline and the other no line, or where a spline has other rows beside it.
    """
    spline, own = after.is_spline[rows], before.is_spline[owner]
    first = np.append(True, owner[1:] != owner[:-1])
    last = np.append(first[1:], True)
    distance = np.full(len(rows), np.inf)
    whole = np.flatnonzero(spline & own & first & last)
    gap = _hull(_of(after, rows[whole]) - _of(before, owner[whole]), before, owner[whole])
    distance[whole] = gap
    group = np.cumsum(first) - 1
    plain = ~spline & own & ~after.is_arc[rows]
    fit = np.ones(len(first[first]), np.bool_)
    np.logical_and.at(fit, group, plain)
    lines = np.flatnonzero(fit[group])
    if len(lines):
        distance[lines] = _Lines(before, after, rows[lines], owner[lines]).run()
    return distance


def _of(path: Toolpath, rows: Ints) -> Floats:
    """Return the control points (n, 4, 3) of splines."""
    outer = path.start[rows, None, :3], path.end[rows, None, :3]
    return np.concatenate([outer[0], path.control[rows], outer[1]], axis=1)


def _hull(difference: Floats, before: Toolpath, owner: Ints) -> Floats:
    """Return the largest distances (n,) of control points (n, k, 3) from zero.

    An axis whose place is not known counts nothing if nothing is known of it on either side; that
    is looked at where all axes are compared.
    """
    unknown = np.isnan(before.end[owner, :3])[:, None, :]
    difference = np.where(unknown, 0.0, difference)
    return np.asarray(np.sqrt((difference**2).sum(axis=2)).max(axis=1, initial=0.0))


class _Lines:
    """Lines (n,) beside the splines that own them."""

    def __init__(self, before: Toolpath, after: Toolpath, rows: Ints, owner: Ints) -> None:
        self.before, self.owner = before, owner
        self.first = np.append(True, owner[1:] != owner[:-1])
        self.last = np.append(self.first[1:], True)
        self.group = np.cumsum(self.first) - 1
        self.points = _of(before, owner[self.first])
        self.start, self.end = after.start[rows, :3], after.end[rows, :3]

    def run(self) -> Floats:
        """Return the distances (n,)."""
        guesses = self._by_length(), self._by_number()
        tried = [*guesses, *(self._nearest(guess) for guess in guesses)]
        return np.asarray(np.min([self._bound_of(part) for part in tried], axis=0))

    def _bound_of(self, part: Floats) -> Floats:
        """Return bounds (n,), one for all lines of a spline, if they end at parts (n,) of it."""
        part = self._growing(np.where(self.last, 1.0, part))
        begin = np.where(self.first, 0.0, np.append(0.0, part[:-1]))
        piece = _cut(self.points[self.group], begin, part)
        line = self.start[:, None] + THIRDS * (self.end - self.start)[:, None]
        bound = self._hull_of(piece - line)
        worst = np.zeros(len(self.points))
        np.maximum.at(worst, self.group, bound)
        return np.asarray(worst[self.group])

    def _growing(self, part: Floats) -> Floats:
        """Return parts that never go back along a spline."""
        return np.asarray(np.maximum.accumulate(part + 2.0 * self.group) - 2.0 * self.group)

    def _by_number(self) -> Floats:
        """Return the parts at which the lines end if all are as long in the parameter."""
        count = np.bincount(self.group)
        nth = np.arange(len(self.group)) - (np.cumsum(count) - count)[self.group] + 1
        return np.asarray(nth / count[self.group])

    def _by_length(self) -> Floats:
        """Return the parts at which splines are as long as the lines are up to their ends."""
        t = np.linspace(0.0, 1.0, SAMPLES + 1)
        curve = _at(np.nan_to_num(self.points)[:, None], t[None, :])
        along = _sums(np.sqrt((np.diff(curve, axis=1) ** 2).sum(axis=2)))
        way = np.nan_to_num(self.end - self.start)
        length = np.cumsum(np.sqrt((way**2).sum(axis=1)))
        base = np.append(0.0, length[:-1])[self.first][self.group]
        whole = (length[self.last] - base[self.last])[self.group]
        share = np.divide(length - base, whole, out=np.zeros(len(length)), where=whole > 0)
        total = along[:, -1]
        scaled = np.divide(
            along, total[:, None], out=np.zeros_like(along), where=total[:, None] > 0
        )
        spread = (scaled + 2.0 * np.arange(len(scaled))[:, None]).ravel()
        steps = (t[None, :] + 2.0 * np.arange(len(scaled))[:, None]).ravel()
        return np.asarray(np.interp(share + 2.0 * self.group, spread, steps) - 2.0 * self.group)

    def _nearest(self, part: Floats) -> Floats:
        """Return the parts near the guess at which splines are nearest to the ends of the lines.

        Steps of Gauss and Newton, of which only those are taken that lead nearer.
        """
        points = np.nan_to_num(self.points[self.group])
        goal = np.where(np.isnan(self.points[self.group, 3]), 0.0, self.end)
        gap, far = self._gap(points, part, goal)
        for _ in range(STEPS):
            speed = _derivative(points, part)
            square = (speed**2).sum(axis=1)
            step = np.divide(
                (gap * speed).sum(axis=1), square, out=np.zeros_like(part), where=square > 0
            )
            for size in (1.0, 0.25):
                tried = np.clip(part - size * step, 0.0, 1.0)
                new_gap, new_far = self._gap(points, tried, goal)
                nearer = new_far < far
                part = np.where(nearer, tried, part)
                gap = np.where(nearer[:, None], new_gap, gap)
                far = np.where(nearer, new_far, far)
        return part

    @staticmethod
    def _gap(points: Floats, part: Floats, goal: Floats) -> tuple[Floats, Floats]:
        gap = _at(points, part) - goal
        return gap, np.asarray((gap**2).sum(axis=1))

    def _hull_of(self, difference: Floats) -> Floats:
        """Return upper bounds (n,) of how far Bezier curves (n, 4, 3) go from zero."""
        step = 1.0 / 2**HALVINGS
        worst = np.zeros(len(difference))
        for k in range(2**HALVINGS):
            low = np.full(len(difference), k * step)
            hull = _hull(_cut(difference, low, low + step), self.before, self.owner)
            worst = np.maximum(worst, hull)
        return worst


def _sums(steps: Floats) -> Floats:
    """Return the running sums (n, k + 1) of steps (n, k), from 0."""
    return np.concatenate([np.zeros((len(steps), 1)), np.cumsum(steps, axis=1)], axis=1)


def _at(points: Floats, t: Floats) -> Floats:
    """Return points of Bezier curves (..., 4, 3) at t (...), by de Casteljau's steps."""
    u = t[..., None, None]
    while points.shape[-2] > 1:
        points = points[..., :-1, :] + u * (points[..., 1:, :] - points[..., :-1, :])
    return points[..., 0, :]


def _derivative(points: Floats, t: Floats) -> Floats:
    """Return the derivatives of Bezier curves (n, 4, 3) at t (n,)."""
    return 3.0 * _at(np.diff(points, axis=1), t)


def _cut(points: Floats, low: Floats, high: Floats) -> Floats:
    """Return the control points of the parts low ... high of Bezier curves (n, 4, 3).

    Control point k is the blossom at `high` k times and at `low` 3 - k times.
    """
    return np.stack([_blossom(points, (low,) * (3 - k) + (high,) * k) for k in range(4)], axis=1)


def _blossom(points: Floats, at: tuple[Floats, ...]) -> Floats:
    for t in at:
        points = points[:, :-1] + t[:, None, None] * (points[:, 1:] - points[:, :-1])
    return points[:, 0]
