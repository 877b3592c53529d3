"""How far one toolpath is from another, along whole moves and not only at their ends.

Every row of the second path belongs to one row of the first, its owner. For each row this file
gives an upper bound of the distance (mm) of any of its points from the owner's curve, where points
are paired in order of travel. Where the pairing goes backwards, half the way back is added to the
account. The bounds are exact for lines beside lines, and for arcs and chords beside arcs of the
same plane; splines are in `gcxform/deviations/splines.py`.
"""

from __future__ import annotations

import numpy as np

from gcxform.deviations.spirals import Spirals, spirals_apart
from gcxform.deviations.splines import beside_splines
from gcxform.dialect.dialect import LINEAR
from gcxform.system.arrays import Flags, Floats, Ints
from gcxform.toolpath.angles import TURN, swept
from gcxform.toolpath.path import Form, Kind, Plane, Toolpath
from gcxform.values import dataclass

ROUND = 1e-9  # mm; by so much the radius of a circle may change
SAME_SWEEP = 1e-9  # rad
SWEEP_SLIP = 0.05  # rad; rows whose sweeps differ by more do not follow their owner


@dataclass(frozen=True, slots=True)
class Deviation:
    """Per row of the second path: distance (mm), angle (deg), and whether its start was unknown."""

    distance: Floats
    angle: Floats
    unknown_start: Flags


def deviation(before: Toolpath, after: Toolpath, owner: Ints, ahead: float = 0.0) -> Deviation:
    """Return how far the rows of `after` are from the rows of `before` that own them.

    `owner` (len(after),) never decreases. Rows that have nothing in common with their owner, a
    line for an arc of another sense for instance, are infinitely far. A point may be `ahead` (mm)
    on its way or behind: by what rotary axes turn on that length their angles may differ.
    """
    with np.errstate(invalid="ignore"):
        return _Comparison(before, after, owner, ahead).run()


class _Comparison:
    def __init__(self, before: Toolpath, after: Toolpath, owner: Ints, ahead: float) -> None:
        self.before, self.after, self.owner = before, after, owner
        self.ahead = ahead
        self.linear = [i for i, a in enumerate(before.axes) if a in LINEAR]
        self.rotary = [i for i, a in enumerate(before.axes) if a not in LINEAR]
        self.last = np.append(owner[1:] != owner[:-1], True)[: len(owner)]
        self.first = np.append(True, owner[1:] != owner[:-1])[: len(owner)]
        self.distance = np.full(len(owner), np.inf)
        self.angle = np.zeros(len(owner))

    def run(self) -> Deviation:
        before = self.before
        start_of_owner = before.start
        owner_arc = before.is_arc[self.owner]
        unknown_move = np.any(np.isnan(start_of_owner) & ~np.isnan(before.end), axis=1)
        unknown = unknown_move[self.owner]
        rapid = before.kind[self.owner] == Kind.RAPID
        ends_only = unknown | rapid
        bent = before.is_spline[self.owner] | self.after.is_spline
        other = ~self._same(start_of_owner) | unknown | bent
        self.distance[~other] = 0.0
        straight = other & ~owner_arc & ~self.after.is_arc
        self._lines(np.flatnonzero(straight & ~unknown & ~bent), start_of_owner)
        self._ends(np.flatnonzero(straight & ends_only & self.last))
        blind = owner_arc & (before.form[self.owner] == Form.BLIND)
        if blind.any():
            self._blind(np.flatnonzero(other & blind))
        arcs = np.flatnonzero(other & owner_arc & ~unknown & ~blind)
        if len(arcs):
            self._arcs(arcs, start_of_owner)
        if bent.any():
            self._splines(np.flatnonzero(bent & ~unknown))
        return Deviation(self.distance + self.after.slack, self.angle, unknown)

    def _same(self, starts: Floats) -> Flags:
        """Return the rows that are their owner to the last bit, where these are many."""
        before, after, owner = self.before, self.after, self.owner
        same: Flags = self.first & self.last & (after.end[:, 0] == before.end[owner, 0])
        if 2 * np.count_nonzero(same) < len(same):
            return np.zeros(len(same), np.bool_)
        own_starts = after.start
        for mine, theirs in ((own_starts, starts), (after.end, before.end)):
            for axis in range(mine.shape[1]):
                one, other = mine[:, axis], theirs[owner, axis]
                same &= (one == other) | (np.isnan(one) & np.isnan(other))
        same &= after.kind == before.kind[owner]
        if before.has_arcs:
            round_same = (after.centre == before.centre[owner]).all(axis=1)
            round_same &= after.sweep == before.sweep[owner]
            round_same &= after.plane == before.plane[owner]
            same &= round_same | ~after.is_arc
        return same

    def _between(self, ends: Floats, others: Floats) -> tuple[Floats, Floats]:
        """Return distances and angles between positions; inf where only one of them is known."""
        gap = np.abs(ends - others)
        gap[np.isnan(ends) & np.isnan(others)] = 0.0
        gap[np.isnan(gap)] = np.inf
        square = sum((gap[:, k] ** 2 for k in self.linear), np.zeros(len(gap)))
        angle = gap[:, self.rotary].max(axis=1, initial=0.0)
        return np.sqrt(square), angle

    def _ends(self, rows: Ints) -> None:
        """Compare where moves end: rapids, and moves that start at an unknown place.

        Where such a move has become several, the ends of all but the last have to be on the way of
        a rapid; on an unknown way there is none that they could be on.
        """
        distance, angle = self._between(self.after.end[rows], self.before.end[self.owner[rows]])
        self.distance[rows] = distance
        self.angle[rows] = angle

    def _blind(self, rows: Ints) -> None:
        """Compare arcs from where it is not known: by their sweeps, and the axes that are known.

        What such moves go by is compared as events are.
        """
        self._ends(rows)
        owner = self.owner[rows]
        same = self.after.form[rows] == Form.BLIND
        same &= np.abs(self.after.sweep[rows] - self.before.sweep[owner]) <= SAME_SWEEP
        for name in ("kind", "plane"):
            same &= getattr(self.after, name)[rows] == getattr(self.before, name)[owner]
        self.distance[rows[~same]] = np.inf

    def _lines(self, rows: Ints, starts: Floats) -> None:
        """Compare lines with the line that owns them: their ends against its points."""
        if not len(rows):
            return
        owner = self.owner[rows]
        start, goal = starts[owner], self.before.end[owner]
        way = np.nan_to_num(goal - start)
        end = self.after.end[rows]
        straight = self._weighed(way)
        square = np.einsum("ij,ij->i", straight, straight)
        along = np.einsum("ij,ij->i", np.nan_to_num(end - start), straight)
        part = np.divide(along, square, out=np.ones_like(along), where=square > 0)
        part = np.where(self.last[rows], 1.0, np.clip(part, 0.0, 1.0))
        distance, angle = self._between(end, start + part[:, None] * way + (goal - goal))
        back = self._backwards(part, rows, np.sqrt(square))
        self.distance[rows] = distance + back
        length = np.sqrt((way[:, self.linear] ** 2).sum(axis=1))
        turned = np.abs(way[:, self.rotary]).max(axis=1, initial=0.0)
        self.angle[rows] = np.maximum(angle - self.turned_ahead(turned, length), 0.0)

    def _weighed(self, way: Floats) -> Floats:
        """Return ways without their rotary axes where a linear one moves."""
        if not self.rotary:
            return way
        straight = way.copy()
        moves = (way[:, self.linear] != 0).any(axis=1)
        straight[np.ix_(moves, self.rotary)] = 0.0
        return straight

    def turned_ahead(self, turned: Floats, length: Floats) -> Floats:
        """Return by how much (deg) rotary axes turn on the length that a point may be ahead."""
        rate = np.divide(turned, length, out=np.zeros_like(turned), where=length > 0)
        return np.asarray(np.minimum(rate * self.ahead, turned))

    def _backwards(self, part: Floats, rows: Ints, length: Floats) -> Floats:
        """Return half the way that rows go back along their owner."""
        previous = np.append(0.0, part[:-1])
        previous[self.first[rows]] = 0.0
        return np.maximum(previous - part, 0.0) * length / 2

    def _splines(self, rows: Ints) -> None:
        """Compare splines, and lines beside them; other axes stand still along a spline."""
        owner = self.owner[rows]
        distance = beside_splines(self.before, self.after, rows, owner)
        _, self.angle[rows] = self._between(self.after.end[rows], self.before.end[owner])
        known = np.isnan(self.after.end[rows]) == np.isnan(self.before.end[owner])
        distance[~known.all(axis=1)] = np.inf
        others = [k for k in self.linear if k > 2]
        aside = np.nan_to_num(self.after.end[rows] - self.before.end[owner])[:, others]
        self.distance[rows] = np.hypot(distance, np.sqrt((aside**2).sum(axis=1)))

    # --- arcs ---

    def _arcs(self, rows: Ints, starts: Floats) -> None:
        for plane in Plane:
            here = rows[self.before.plane[self.owner[rows]] == plane]
            if len(here):
                beside = _BesideArc(self, plane, here, starts)
                self.distance[here], self.angle[here] = beside.run()


class _BesideArc:
    """Rows that belong to arcs of one plane."""

    def __init__(self, comparison: _Comparison, plane: Plane, rows: Ints, starts: Floats) -> None:
        self.all = comparison
        self.axes = list(plane.axes[:2])
        self.normal = plane.axes[2]
        self.rows = rows
        self.owner = comparison.owner[rows]
        before, after = comparison.before, comparison.after
        self.sense = before.sense[self.owner]
        self.centre = before.centre[self.owner][:, self.axes]
        self.start = starts[self.owner]
        self.goal = before.end[self.owner]
        self.sweep = before.sweep[self.owner]
        self.a = after.start[rows]
        self.b = after.end[rows]
        self.is_arc = after.is_arc[rows]
        self.after_sweep = after.sweep[rows]
        self.after_centre = after.centre[rows][:, self.axes]
        self.same_sense = (after.sense[rows] == self.sense) & (after.plane[rows] == plane)

    def run(self) -> tuple[Floats, Floats]:
        reach, step = self._progress()
        begin = reach - step
        in_plane = self._in_plane(begin, reach)
        outside, angle = self._other_axes(begin, reach, step)
        distance = np.hypot(in_plane, outside)
        total = np.abs(reach - self.sweep)
        wrong = self.all.last[self.rows] & (total > SWEEP_SLIP + self._slip())
        wrong |= self.is_arc & ~self.same_sense
        distance[wrong] = np.inf
        return distance, angle

    def _slip(self) -> Floats:
        """Return how much a sweep may differ because the arc is tiny."""
        radius = np.hypot(*(self.start[:, self.axes] - self.centre).T)
        return np.asarray(np.minimum(0.01 / np.maximum(radius, 1e-9), TURN))

    def _progress(self) -> tuple[Floats, Floats]:
        """Return the angle travelled about the owner's centre at the end of each row, and in it."""
        u, v = self.a[:, self.axes] - self.centre, self.b[:, self.axes] - self.centre
        step = swept(u, v, self.sense)
        chord = ~self.is_arc
        # A chord turns by less than half a turn; what seems nearly a whole turn goes back a little.
        step = np.where(chord & (step > np.pi), step - TURN, step)
        turns = np.round((self.after_sweep - step) / TURN)
        step = np.where(self.is_arc, step + TURN * turns, step)
        travelled = np.cumsum(step)
        first = np.flatnonzero(self.all.first[self.rows])
        offset = (travelled - step)[first]
        counts = np.diff(np.append(first, len(self.rows)))
        return travelled - np.repeat(offset, counts), step

    def _radius(self, angle: Floats) -> Floats:
        """Return the owner's radius at an angle: it changes evenly where its ends differ."""
        first = np.hypot(*(self.start[:, self.axes] - self.centre).T)
        last = np.hypot(*(self.goal[:, self.axes] - self.centre).T)
        return np.asarray(first + (last - first) * np.clip(angle / self.sweep, 0.0, 1.0))

    def _in_plane(self, begin: Floats, reach: Floats) -> Floats:
        """Return the largest radial distance in the plane."""
        r0, r1 = self._radius(begin), self._radius(reach)
        u, v = self.a[:, self.axes] - self.centre, self.b[:, self.axes] - self.centre
        ends = np.maximum(np.abs(np.hypot(*u.T) - r0), np.abs(np.hypot(*v.T) - r1))
        ends = np.where(self.all.last[self.rows], np.maximum(ends, self._end_gap()), ends)
        chord = np.minimum(r0, r1) - _nearest(u, v)
        round_ = self._arc_beside(u, r0, r1)
        spirals = np.flatnonzero(self.is_arc & np.isfinite(round_) & self._uneven_arcs(r0, r1))
        if len(spirals):
            round_[spirals] = self._spirals(spirals, u, (r0, r1), reach - begin)
        inner = np.where(self.is_arc, round_, np.abs(chord))
        return np.asarray(np.maximum(ends, inner))

    def _end_gap(self) -> Floats:
        return np.asarray(np.hypot(*(self.b - self.goal)[:, self.axes].T))

    def _arc_beside(self, u: Floats, r0: Floats, r1: Floats) -> Floats:
        """Return the largest radial distance of a circle about another centre.

        The extremes are at the ends and where the arc's own radius points along the line between
        the two centres. Where a radius changes on the way they are elsewhere: see `spirals.py`.
        """
        shift = self.after_centre - self.centre
        size = np.hypot(*shift.T)
        begin = self.a[:, self.axes] - self.after_centre
        own0 = np.hypot(*begin.T)
        own1 = np.hypot(*(self.b[:, self.axes] - self.after_centre).T)
        worst = np.zeros(len(size))
        for sign in (1.0, -1.0):
            at = swept(begin, sign * shift, self.sense)
            part = np.clip(at / np.maximum(self.after_sweep, 1e-300), 0.0, 1.0)
            reached = (at <= self.after_sweep) & (size > 0)
            own = own0 + (own1 - own0) * part
            there = np.abs(np.abs(own + sign * size) - (r0 + (r1 - r0) * part))
            worst = np.maximum(worst, np.where(reached, there, 0.0))
        spiral = np.abs((own1 - own0) - (r1 - r0)) + np.where(size > 0, 0.0, np.abs(own0 - r0))
        return np.where(np.isnan(worst), np.inf, np.maximum(worst, np.minimum(spiral, size)))

    def _uneven_arcs(self, r0: Floats, r1: Floats) -> Flags:
        """Return which arcs, or parts of their owners from `r0` to `r1`, change their radius."""
        first, last = (
            np.hypot(*(end[:, self.axes] - self.after_centre).T) for end in (self.a, self.b)
        )
        return np.asarray((np.abs(last - first) > ROUND) | (np.abs(r1 - r0) > ROUND))

    def _spirals(self, rows: Ints, u: Floats, radii: tuple[Floats, Floats], step: Floats) -> Floats:
        begin, end = ((point[:, self.axes] - self.after_centre)[rows] for point in (self.a, self.b))
        sense = self.sense[rows]
        angles = (np.arctan2(point[:, 1], point[:, 0]) for point in (begin, u[rows]))
        mine = Spirals(np.hypot(*begin.T), np.hypot(*end.T), next(angles), self.after_sweep[rows])
        its = Spirals(radii[0][rows], radii[1][rows], next(angles), step[rows])
        return spirals_apart(mine, its, (self.after_centre - self.centre)[rows], sense)

    def _other_axes(self, begin: Floats, reach: Floats, step: Floats) -> tuple[Floats, Floats]:
        """Return how far (mm, deg) the axes outside the plane are from turning with the angle.

        A point that is off along the axis of a helix is nearer to another point of the helix than
        to the one at its own angle: it is beside it by the cosine of the helix's slope, and by the
        bend of the helix on the way there. Rotary axes are compared at that nearer point.
        """
        reach = np.where(self.all.last[self.rows], self.sweep, reach)
        uneven = np.where(self.is_arc, 0.0, _uneven(np.abs(step)))
        radius = np.maximum(self._radius(begin), 1e-9)
        rise = np.nan_to_num(self.goal - self.start)[:, self.normal]
        length = np.hypot(radius * self.sweep, rise)
        flat = radius * self.sweep / length
        parts = [np.clip(at / self.sweep, 0.0, 1.0) for at in (begin, reach)]
        off = [
            self._off(self.normal, part, p) for part, p in zip(parts, (self.a, self.b), strict=True)
        ]
        parts = [part + gap * rise / length**2 for part, gap in zip(parts, off, strict=True)]
        own_rise = np.abs(np.nan_to_num(self.b - self.a)[:, self.normal])
        along = np.maximum(np.abs(off[0]), np.abs(off[1])) + uneven * own_rise
        ahead = along * np.abs(rise) / length
        square = np.minimum(along, along * flat + (ahead * flat) ** 2 / radius / 2) ** 2
        angle, turned = np.zeros((2, len(self.rows)))
        for k in range(self.b.shape[1]):
            if k in self.axes or k == self.normal:
                continue
            way = np.abs(np.nan_to_num(self.goal[:, k] - self.start[:, k]))
            gap = np.maximum(
                np.abs(self._off(k, parts[0], self.a)), np.abs(self._off(k, parts[1], self.b))
            )
            gap = gap + uneven * np.nan_to_num(np.abs(self.b[:, k] - self.a[:, k]))
            if k in self.all.linear:
                square += gap**2
            else:
                angle, turned = np.maximum(angle, gap), np.maximum(turned, way)
        allowed = self.all.turned_ahead(turned, length)
        return np.sqrt(square), np.maximum(angle - allowed, 0.0)

    def _off(self, k: int, part: Floats, point: Floats) -> Floats:
        """Return how far one axis of a point is from the owner's at a part of the way; signed."""
        way = np.nan_to_num(self.goal[:, k] - self.start[:, k])
        wanted = self.start[:, k] + way * part
        gap = point[:, k] - wanted
        gap[np.isnan(point[:, k]) & np.isnan(wanted)] = 0.0
        return np.where(np.isnan(gap), np.inf, gap)


def _nearest(u: Floats, v: Floats) -> Floats:
    """Return the distances of the chords from u to v (n, 2) from the origin."""
    way = v - u
    square = (way**2).sum(axis=1)
    part = np.clip(
        np.divide(-(u * way).sum(axis=1), square, out=np.zeros(len(u)), where=square > 0), 0, 1
    )
    return np.asarray(np.hypot(*(u + part[:, None] * way).T))


def _uneven(angle: Floats) -> Floats:
    """Return the largest difference between the parts of chord and angle travelled on a chord.

    On a chord of angle d the angle at the part t is d/2 + atan((2t - 1) tan(d/2)); its difference
    from d t is largest where (2t - 1)**2 tan(d/2)**2 = 2 tan(d/2)/d - 1.
    """
    half = np.clip(angle / 2, 1e-9, np.pi / 2 - 1e-6)
    tangent = np.tan(half)
    x = np.sqrt(np.maximum(tangent / half - 1.0, 0.0)) / tangent
    return np.asarray(np.abs(0.5 + np.arctan(x * tangent) / (2 * half) - (1 + x) / 2))
