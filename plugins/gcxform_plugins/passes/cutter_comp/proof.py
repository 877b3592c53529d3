"""Whether the centre of a tool is beside a contour: the proof of `cutter-comp`.

It shares no code with the search for the centre path. All is in the plane of the arcs, in mm, row k
of n being a move under compensation that moves in its plane:

    p, q, c    (n, 2)  start, end and centre of circle of the contour as programmed
    a, b, d    (n, 2)  the same of the centre path
    side s     (n,)    +1: the tool is left, -1: right      radius r  (n,)  of the tool
    sense o    (n,)    +1 counter-clockwise, -1 clockwise, 0 line
    first, last (n, 2) unit tangents of the contour at p and q
    turn       (n,)    rad; s times the angle from `last` of the move before to `first`: inside > 0

How far a point x is beside the contour: h(x) = s first x (x - p) for a line (cross product), and
h(x) = s o (|p - c| - |x - c|) for an arc. Claimed, with CLOSE for the arithmetic:

    |h(x) - r| <= e + u   for every x of the centre path of move k but the first of a stretch,

u = ||p - c| - |q - c||, by which a programmed arc misses its own circle, and e = r (1 - cos turn),
on the inside of an arc R / (R - r) of that, where a turn of at most `straight` is taken for none,
else 0. Derived here: h is linear along a line; an arc with d = c keeps |x - c|, or goes from one to
the other; so it is enough that both ends hold it. Where two curves meet in a corner, that fixes the
joint but for the second crossing of a circle, which turns outwards (`_check_meetings`). Where they
are tangents, and at the end of a stretch, it does not: there (b - q) . last = 0 is asked for
(`_check_slides`). An arc that begins a stretch has a circle of its own: of it is asked that it goes
from p to b, and at b as the contour does at q, d being on the line through q and c. Around an
outside corner the centre keeps r from p: an arc about p, or lines that nowhere come nearer. All of
this is of the path as computed, before it is rounded.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Flags, Floats, Ints
from gcxform_plugins.passes.cutter_comp.unchanged import (
    CLOSE,
    check_events,
    check_same,
    fail_if,
    paired_rows,
)

ANGLE = 1e-6  # rad
GAINED = 0.026  # rad; what an arc may gain where a turn below `straight` begins it


def prove_beside(
    before: gx.Toolpath, after: gx.Toolpath, straight: float, linear: bool, beside_next: bool
) -> None:
    """Check a centre path. Raises VerificationError.

    `straight` (rad): turns up to this may be taken for none. `linear`: moves may meet outside.
    `beside_next`: the move that begins compensation ends beside the next one.
    """
    main, corner = paired_rows(before, after)
    check_same(before, after, main, corner)
    check_events(before, after, np.where(corner >= 0, corner, main))
    on = np.flatnonzero(before.side != 0)
    on = on[before.radius[on] > 0]
    if len(on):
        moving = _moving(before, after, main, on)
        _Proof.of(before, after, main, corner, moving, straight, linear, beside_next).check()


def _plane_axes(path: gx.Toolpath, rows: Ints) -> Ints:
    """Return the two axes of the plane of each row, and the third (n, 3)."""
    axes: Ints = np.array([gx.Plane(p).axes for p in range(3)]).T[:, path.plane[rows]]
    return axes.T  # each of them in one piece


def _in_plane(points: Floats, rows: Ints, axes: Ints) -> Floats:
    """Return points of rows in the coordinates of their planes (n, 2)."""
    return np.asarray(points[rows, axes[:, :2].T].T)


def _moving(before: gx.Toolpath, after: gx.Toolpath, main: Ints, on: Ints) -> Ints:
    """Check the axes that are not in the plane; return the rows that move in it.

    Of the others the centre has to stand still.
    """
    axes = _plane_axes(before, on)
    same = (after.end[main[on]] == before.end[on]) | np.isnan(before.end[on])
    np.put_along_axis(same, axes[:, :2], True, axis=1)
    fail_if(before, on[~same.all(axis=1)], "an axis that is not in the plane moves")
    made = main[on]
    p, q = (_in_plane(points, on, axes) for points in (before.start, before.end))
    a, b = (_in_plane(points, made, axes) for points in (after.start, after.end))
    moves = before.is_arc[on] | (_apart(p, q) > 1e-9)
    fail_if(before, on[~moves & (_apart(a, b) > CLOSE)], "it moves aside")
    return np.asarray(on[moves])


@dataclass(frozen=True)
class _Proof:
    """The moves of one path under compensation, in their planes; symbols as in the module's head.

    row (n,): of `before`; axes (n, 3): of its plane, and the third; entry (n,): whether it is the
    first of a stretch.
    """

    before: gx.Toolpath
    after: gx.Toolpath
    main: Ints
    corner: Ints
    straight: float
    linear: bool
    beside_next: bool
    row: Ints
    axes: Ints
    p: Floats
    q: Floats
    c: Floats
    a: Floats
    b: Floats
    d: Floats
    side: Floats
    radius: Floats
    sense: Floats
    entry: Flags

    @classmethod
    def of(
        cls,
        before: gx.Toolpath,
        after: gx.Toolpath,
        main: Ints,
        corner: Ints,
        row: Ints,
        straight: float,
        linear: bool,
        beside_next: bool,
    ) -> _Proof:
        """Look at rows in their planes."""
        axes, made = _plane_axes(before, row), main[row]
        programmed = (before.start, before.end, before.centre)
        p, q, c = (_in_plane(points, row, axes) for points in programmed)
        a, b, d = (
            _in_plane(points, made, axes) for points in (after.start, after.end, after.centre)
        )
        side, radius, sense = before.side[row].astype(float), before.radius[row], before.sense[row]
        entry = np.append(True, before.side[:-1] == 0)[: len(before)][row]
        given = before, after, main, corner, straight, linear, beside_next
        return cls(*given, row, axes, p, q, c, a, b, d, side, radius, sense, entry)

    @cached_property
    def arc(self) -> Flags:
        """Whether a move (n,) is an arc."""
        return np.asarray(self.sense != 0)

    @cached_property
    def first(self) -> Floats:
        """Unit tangents (n, 2) where moves begin."""
        return self._tangents(self.p)

    @cached_property
    def last(self) -> Floats:
        """Unit tangents (n, 2) where moves end."""
        return self._tangents(self.q)

    @cached_property
    def turn(self) -> Floats:
        """By how much (n,) the contour turns before a move, rad."""
        before_it = np.roll(self.last, 1, axis=0)
        angle = np.arctan2(_cross(before_it, self.first), _dot(before_it, self.first))
        return np.asarray(self.side * angle)

    @cached_property
    def none(self) -> Flags:
        """Whether the turn before a move (n,) is taken for none."""
        return np.asarray((np.abs(self.turn) <= self.straight) & ~self.entry)

    @cached_property
    def valley(self) -> Flags:
        """Whether the tool comes to rest on both sides of the corner before a move (n,)."""
        leaves = self.arc & (self.side * self.sense < 0)
        return np.asarray(leaves & (np.abs(self.turn) > np.pi - ANGLE))

    def check(self) -> None:
        """Check all moves."""
        self._check_ends()
        self._check_slides()
        self._check_order()
        self._check_corners()
        self._check_meetings()

    def _tangents(self, at: Floats) -> Floats:
        """Return the unit tangents (n, 2) of the contour at points of it."""
        way = self.q - self.p
        out = at - self.c
        turned = self.sense[:, None] * np.stack([-out[:, 1], out[:, 0]], axis=1)
        way = np.where(self.arc[:, None], turned, way)
        return np.asarray(way / _size(way)[:, None])

    def _offset(self, x: Floats, size: Floats) -> Floats:
        """Return h (n,) of points; `size`: the radius of arcs there."""
        line = self.side * _cross(self.first, x - self.p)
        arc = self.side * self.sense * (size - _size(x - self.c))
        return np.asarray(np.where(self.arc, arc, line))

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

    def _check_slides(self) -> None:
        """Check that moves end at right angles beside the contour where no corner fixes their end.

        That is the end of the move; with `beside_next`, of an entry, the beginning of the next.
        """
        ends = np.append(self.entry[1:], True)
        along, free = self.last, ends | np.append(self.none[1:], False)
        if self.beside_next:
            enters = self.entry & ~ends
            free |= enters
            along = np.where(enters[:, None], np.roll(self.first, -1, axis=0), along)
        slid = np.abs(_dot(self.b - self.q, along)) > CLOSE
        self._fail(free & slid, "the centre ends before or behind, along the contour")

    def _check_order(self) -> None:
        """Check that the centre moves as the contour does."""
        back = ~self.arc & (_dot(self.first, self.b - self.a) < -CLOSE)
        self._fail(back, "the centre moves backwards")
        sweep, enters = self.after.sweep[self.main[self.row]], self.arc & self.entry
        most = np.where(enters, 2 * np.pi, self.before.sweep[self.row] + GAINED)
        self._fail(self.arc & ((sweep < 0) | (sweep > most)), "the arc is too long")
        moved = self.arc & ~enters & (_size(self.c - self.d) > CLOSE)
        self._fail(moved, "the centre of the arc has changed")
        middle = np.where(enters[:, None], self.d, self.c)
        u, v = self.a - middle, self.b - middle
        uneven = np.abs(_size(u) - _size(v)) > 2 * CLOSE
        out = self.q - self.c  # at its end an arc that begins compensation keeps its direction
        turned = np.abs(_cross(v, out)) > CLOSE * _size(out) + ANGLE * _size(v) * _size(out)
        wrong = enters & (uneven | turned | (_dot(v, out) <= 0))
        self._fail(wrong, "the arc that begins compensation does not end in its direction")
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
        begin = _in_plane(self.after.start, rows, self.axes[k])
        u, v = begin - self.p[k], self.a[k] - self.p[k]
        fail_if(self.before, self.row[k][kind == self._wrong_way(k)], "a corner goes the wrong way")
        rapid = (kind == gx.Kind.RAPID) != (self.before.kind[self.row[k]] == gx.Kind.RAPID)
        fail_if(self.before, self.row[k][rapid], "a corner is a rapid, or its move is")
        round_it = kind >= gx.Kind.ARC_CW
        middle = _in_plane(self.after.centre, rows, self.axes[k])
        far = np.maximum(np.abs(_size(u) - self.radius[k]), np.abs(_size(v) - self.radius[k]))
        far = np.maximum(far, np.nan_to_num(_size(middle - self.p[k]), nan=np.inf))
        angle = np.abs(np.arctan2(_cross(u, v), _dot(u, v)))
        slack = ANGLE + CLOSE / self.radius[k]
        wrong = (far > CLOSE) | (np.abs(angle - self.after.sweep[rows]) > slack)
        fail_if(self.before, self.row[k][round_it & wrong], "a corner is not round")
        near = _distance_to_line(self.p[k], begin, self.a[k]) < self.radius[k] - CLOSE
        near &= kind == gx.Kind.LINE
        near |= (kind == gx.Kind.LINE) & (not self.linear)
        fail_if(self.before, self.row[k][near], "a corner is cut")
        normal = self.axes[k, 2]
        rises = np.abs(self.after.end[rows, normal] - self.after.start[rows, normal]) > 0
        fail_if(self.before, self.row[k][rises], "an axis moves at a corner")

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
        fail_if(self.before, self.row[k][back], "an inside corner is not where the moves meet")

    def _heading(self, k: Ints, at: Floats) -> Floats:
        """Return the direction (n, 2) of centre moves at points of them."""
        out = at - self.c[k]
        turned = self.sense[k][:, None] * np.stack([-out[:, 1], out[:, 0]], axis=1)
        way = np.where(self.arc[k][:, None], turned, self.first[k])
        return np.asarray(way / _size(way)[:, None])

    def _fail(self, wrong: Flags, message: str) -> None:
        fail_if(self.before, self.row[wrong], message)


def _cross(u: Floats, v: Floats) -> Floats:
    return np.asarray(u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0])


def _dot(u: Floats, v: Floats) -> Floats:
    return np.asarray(u[..., 0] * v[..., 0] + u[..., 1] * v[..., 1])


def _apart(u: Floats, v: Floats) -> Floats:
    """Return how far points (n, 2) are apart, along one axis and the other."""
    way = np.abs(u - v)
    return np.asarray(way[:, 0] + way[:, 1])


def _size(u: Floats) -> Floats:
    return np.asarray(np.sqrt(u[..., 0] ** 2 + u[..., 1] ** 2))


def _distance_to_line(points: Floats, p: Floats, q: Floats) -> Floats:
    """Return the distances of points from lines between p and q."""
    way = q - p
    part = _dot(points - p, way) / np.maximum(_dot(way, way), 1e-300)
    return _size(points - p - np.clip(part, 0.0, 1.0)[..., None] * way)
