"""Whether the centre of a tool is beside a contour: the proof of `cutter-comp`.

It shares no code with the search for the centre path. Each move of the contour has one move of the
centre, and an outside corner has one before it. At both ends the centre has to be at the tool's
radius from its own contour, on its side; lines are then right all along, and arcs by their centre.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Flags, Floats, Ints

CLOSE = 1e-6  # mm
ANGLE = 1e-6  # rad
GAINED = 0.026  # rad; what an arc may gain where a turn below `straight` begins it
SAME = ("kind", "plane", "feed_mode", "frame", "source", "form", "lost")


def prove_beside(
    before: gx.Toolpath, after: gx.Toolpath, straight: float, linear: bool, beside_next: bool
) -> None:
    """Check a centre path. Raises VerificationError.

    `straight` (rad): turns up to this may be taken for none. `linear`: moves may meet outside.
    `beside_next`: the move that begins compensation ends beside the next one.
    """
    main, corner = _paired(before, after)
    _check_same(before, after, main, corner)
    _check_events(before, after, np.where(corner >= 0, corner, main))
    on = np.flatnonzero(before.side != 0)
    on = on[before.radius[on] > 0]
    if len(on):
        _Proof(before, after, main, corner, straight, linear, beside_next).check(on)


def _paired(before: gx.Toolpath, after: gx.Toolpath) -> tuple[Ints, Ints]:
    """Return, for each row, its row of the centre path and the row of its corner, or -1."""
    counts = np.ones(len(before), np.int64)
    lines, first, old = np.unique(before.source, return_index=True, return_counts=True)
    new = np.bincount(np.searchsorted(lines, after.source), minlength=len(lines))
    more = new - old
    if len(new) != len(lines) or ((more != 0) & ((more != 1) | (old != 1))).any():
        _fail(before, 0, "moves are missing or too many")
    counts[first[more == 1]] = 2
    main = np.cumsum(counts) - 1
    return main, np.where(counts == 2, main - 1, -1)


def _check_same(before: gx.Toolpath, after: gx.Toolpath, main: Ints, corner: Ints) -> None:
    """Check all that compensation does not change."""
    for name in SAME:
        wrong = getattr(after, name)[main] != getattr(before, name)
        _fail_if(before, wrong, f"{name} has changed")
    free = (before.side == 0) | ~(before.radius > 0)
    kept = (after.end[main] == before.end) | np.isnan(before.end)
    _fail_if(before, free & (~kept.all(axis=1) | (corner >= 0)), "a free move has changed")
    arcs = np.zeros(len(before), np.bool_)
    for name in ("centre", "sweep"):
        old, new = getattr(before, name), getattr(after, name)[main]
        same = (old == new) | (np.isnan(old) & np.isnan(new))
        arcs |= ~(same if same.ndim == 1 else same.all(axis=1))
    _fail_if(before, free & arcs, "a free arc has changed")
    mode = before.feed_mode != gx.FeedMode.INVERSE_TIME
    feed = (after.feed[main] == before.feed) | np.isnan(before.feed)
    _fail_if(before, mode & ~feed, "the feed has changed")


def _check_events(before: gx.Toolpath, after: gx.Toolpath, first: Ints) -> None:
    """Check that all events but those of compensation stand before the moves they stood before."""
    first = np.append(first, len(after))
    kept = [e for e in before.events if not e.what.startswith(("G41", "G42"))]
    wanted = [(e.what, e.values, e.line, int(first[e.row])) for e in kept]
    if wanted != [(e.what, e.values, e.line, e.row) for e in after.events]:
        _fail(before, 0, "an event is missing, or stands elsewhere")


@dataclass
class _Proof:
    """The rows of one path under compensation, seen in their planes."""

    before: gx.Toolpath
    after: gx.Toolpath
    main: Ints
    corner: Ints
    straight: float
    linear: bool
    beside_next: bool

    def check(self, on: Ints) -> None:
        """Check the rows that are under compensation."""
        self._look(on)
        self._check_axes()
        self._check_ends()
        self._check_order()
        self._check_corners()
        self._check_meetings()

    def _look(self, on: Ints) -> None:
        """Keep the rows that move in the plane, in the coordinates of the plane."""
        before, after = self.before, self.after
        plane = before.plane[on]
        axes = np.array([gx.Plane(p).axes for p in range(3)])[plane]
        self.all, self.all_axes = on, axes

        def seen(points: Floats, rows: Ints) -> Floats:
            return np.asarray(np.take_along_axis(points[rows][:, :3], axes[:, :2], axis=1))

        p, q = seen(before.start, on), seen(before.end, on)
        a, b = seen(after.start, self.main[on]), seen(after.end, self.main[on])
        moves = before.is_arc[on] | (np.abs(p - q).sum(axis=1) > 1e-9)
        _fail_if(before, on[~moves & (np.abs(a - b).sum(axis=1) > CLOSE)], "it moves aside")
        c = seen(before.centre, on)
        d = seen(after.centre, self.main[on])
        self.row, self.axes = on[moves], axes[moves]
        self.p, self.q, self.a, self.b = p[moves], q[moves], a[moves], b[moves]
        self.c, self.d = c[moves], d[moves]
        self.side = before.side[self.row].astype(np.float64)
        self.radius, self.sense = before.radius[self.row], before.sense[self.row]
        self.arc = self.sense != 0
        off = np.append(True, before.side[:-1] == 0)[: len(before)]
        self.entry = off[self.row]
        self.first, self.last = self._tangents(self.p), self._tangents(self.q)
        before_it = np.roll(self.last, 1, axis=0)
        self.turn = self.side * np.arctan2(
            _cross(before_it, self.first), _dot(before_it, self.first)
        )
        leaves = self.arc & (self.side * self.sense < 0)
        self.valley = leaves & (np.abs(self.turn) > np.pi - ANGLE)
        self.none = (np.abs(self.turn) <= self.straight) & ~self.entry

    def _tangents(self, at: Floats) -> Floats:
        """Return the unit tangents (n, 2) of the contour at points of it."""
        way = self.q - self.p
        out = at - self.c
        turned = self.sense[:, None] * np.stack([-out[:, 1], out[:, 0]], axis=1)
        way = np.where(self.arc[:, None], turned, way)
        return np.asarray(way / np.sqrt((way**2).sum(axis=1))[:, None])

    def _offset(self, at: Floats, size: Floats) -> Floats:
        """Return how far (n,) points are from their contours, to its side; `size` of arcs."""
        line = self.side * _cross(self.first, at - self.p)
        out = at - self.c
        arc = self.side * self.sense * (size - np.sqrt((out**2).sum(axis=1)))
        return np.asarray(np.where(self.arc, arc, line))

    def _check_axes(self) -> None:
        """Check the axes that are not in the plane."""
        rows = self.all
        end, old = self.after.end[self.main[rows]], self.before.end[rows]
        same = (end == old) | np.isnan(old)
        np.put_along_axis(same, self.all_axes[:, :2], True, axis=1)
        _fail_if(self.before, rows[~same.all(axis=1)], "an axis that is not in the plane moves")

    def _check_ends(self) -> None:
        """Check that the centre is beside the contour where each move begins and ends."""
        at_start, at_end = _size(self.p - self.c), _size(self.q - self.c)
        uneven = np.where(self.arc, np.abs(at_start - at_end), 0.0) + CLOSE
        less = self.radius * (1 - np.cos(np.where(self.none, self.turn, 0.0)))
        inner = self.arc & (self.side * self.sense > 0)
        less[inner] *= (at_start / np.maximum(at_start - self.radius, CLOSE))[inner]
        begins = self._offset(self.a, at_start) - self.radius
        wrong = (begins > less + uneven) | (begins < -less - uneven)
        self._fail(wrong & ~self.entry, "the centre is not at the tool's radius where it begins")
        ends = self._offset(self.b, at_end) - self.radius
        wrong = np.abs(ends) > uneven
        if self.beside_next:  # where the next move begins is checked above
            wrong &= ~(self.entry & np.append(~self.entry[1:], False))
        self._fail(wrong, "the centre is not at the tool's radius where it ends")
        self._fail(self.entry & (_size(self.a - self.p) > CLOSE), "it begins elsewhere")

    def _check_order(self) -> None:
        """Check that the centre moves as the contour does."""
        back = ~self.arc & (_dot(self.first, self.b - self.a) < -CLOSE)
        self._fail(back, "the centre moves backwards")
        sweep = self.after.sweep[self.main[self.row]]
        programmed = self.before.sweep[self.row]
        self._fail(self.arc & ((sweep < 0) | (sweep > programmed + GAINED)), "the arc is too long")
        self._fail(self.arc & (_size(self.c - self.d) > CLOSE), "the centre of the arc has changed")
        u, v = self.a - self.c, self.b - self.c
        measured = np.arctan2(self.sense * _cross(u, v), _dot(u, v))
        off = np.abs(np.mod(sweep - measured + np.pi, 2 * np.pi) - np.pi)
        slack = CLOSE / np.maximum(np.minimum(_size(u), _size(v)), CLOSE) + ANGLE
        self._fail(self.arc & (off > slack), "the sweep of the arc is another")

    def _check_corners(self) -> None:
        """Check the moves around outside corners, and that there are some."""
        has = self.corner[self.row] >= 0
        outside = (self.turn < -self.straight) | (self.turn > np.pi - ANGLE)
        outside &= ~self.valley
        self._fail(has & (~outside | self.entry), "a corner where there is none")
        missing = outside & ~has & ~self.entry & (not self.linear)
        if self.beside_next:
            missing &= ~np.append(False, self.entry[:-1])
        self._fail(missing, "a corner is missing")
        self._check_round(np.flatnonzero(has))

    def _check_round(self, k: Ints) -> None:
        """Check the moves that lead around corners, before moves by index."""
        rows = self.corner[self.row[k]]
        kind = self.after.kind[rows]
        begin = np.take_along_axis(self.after.start[rows][:, :3], self.axes[k, :2], axis=1)
        u, v = begin - self.p[k], self.a[k] - self.p[k]
        _fail_if(
            self.before, self.row[k][kind == self._wrong_way(k)], "a corner goes the wrong way"
        )
        round_it = kind >= gx.Kind.ARC_CW
        middle = np.take_along_axis(self.after.centre[rows], self.axes[k, :2], axis=1)
        far = np.maximum(np.abs(_size(u) - self.radius[k]), np.abs(_size(v) - self.radius[k]))
        far = np.maximum(far, np.nan_to_num(_size(middle - self.p[k]), nan=np.inf))
        angle = np.abs(np.arctan2(_cross(u, v), _dot(u, v)))
        slack = ANGLE + CLOSE / self.radius[k]
        wrong = (far > CLOSE) | (np.abs(angle - self.after.sweep[rows]) > slack)
        _fail_if(self.before, self.row[k][round_it & wrong], "a corner is not round")
        near = _distance_to_line(self.p[k], begin, self.a[k]) < self.radius[k] - CLOSE
        near &= kind == gx.Kind.LINE
        near |= (kind == gx.Kind.LINE) & (not self.linear)
        _fail_if(self.before, self.row[k][near], "a corner is cut")
        normal = self.axes[k, 2]
        rises = np.abs(self.after.end[rows, normal] - self.after.start[rows, normal]) > 0
        _fail_if(self.before, self.row[k][rises], "an axis moves at a corner")

    def _wrong_way(self, k: Ints) -> Ints:
        """Return the kind that the arc about a corner must not have."""
        return np.where(self.side[k] > 0, int(gx.Kind.ARC_CCW), int(gx.Kind.ARC_CW))

    def _check_meetings(self) -> None:
        """Check that at inside corners the centre turns as the contour does.

        Two offset curves of which one is a circle cross twice: at the other crossing, the tool
        would have cut into the contour before.
        """
        inside = (self.turn > self.straight) & (self.turn < np.pi - ANGLE)
        k = np.flatnonzero((inside | self.valley) & ~self.entry)
        k = k[~self.entry[k - 1] | (not self.beside_next)]
        u, v = self._heading(k - 1, self.b[k - 1]), self._heading(k, self.a[k])
        back = self.side[k] * _cross(u, v) < -ANGLE
        _fail_if(self.before, self.row[k][back], "an inside corner is not where the moves meet")

    def _heading(self, k: Ints, at: Floats) -> Floats:
        """Return the direction (n, 2) of centre moves at points of them."""
        out = at - self.c[k]
        turned = self.sense[k][:, None] * np.stack([-out[:, 1], out[:, 0]], axis=1)
        way = np.where(self.arc[k][:, None], turned, self.first[k])
        return np.asarray(way / _size(way)[:, None])

    def _fail(self, wrong: Flags, message: str) -> None:
        _fail_if(self.before, self.row[wrong], message)


def _fail_if(path: gx.Toolpath, wrong: Flags | Ints, message: str) -> None:
    rows = np.flatnonzero(wrong) if wrong.dtype == np.bool_ else wrong
    if len(rows):
        _fail(path, int(rows[0]), message)


def _fail(path: gx.Toolpath, row: int, message: str) -> None:
    line = int(path.source[row]) + 1 if len(path) else 0
    raise gx.VerificationError.one(
        "GX604",
        f"the centre path is not beside the contour: {message}",
        gx.Location("", line),
        "nothing was written; this is a bug of gcxform or of a plugin",
    )


def _cross(u: Floats, v: Floats) -> Floats:
    return np.asarray(u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0])


def _dot(u: Floats, v: Floats) -> Floats:
    return np.asarray(u[..., 0] * v[..., 0] + u[..., 1] * v[..., 1])


def _size(u: Floats) -> Floats:
    return np.asarray(np.sqrt((u**2).sum(axis=-1)))


def _distance_to_line(points: Floats, p: Floats, q: Floats) -> Floats:
    """Return the distances of points from lines between p and q."""
    way = q - p
    part = _dot(points - p, way) / np.maximum(_dot(way, way), 1e-300)
    return _size(points - p - np.clip(part, 0.0, 1.0)[..., None] * way)
