"""Arcs through runs of corners: where their centres are, and the proof that they are near enough.

An arc through the first and the last corner of a run has its centre on the bisector of the chord
between them, at a height h above it. A corner at (x, y) from the middle of a chord of the length L
is on the circle if x**2 + y**2 - L**2/4 = 2 h y; h is taken by least squares. What it is worth is
then measured: no part of this file is trusted with the distance but `_certified`.

The proof pairs the points of arc and lines that have the same angle at the centre. The angles grow
along both, so the pairs follow one another, and the largest distance of a pair bounds the distance
in both directions. In the plane it is largest at a corner or where a line is nearest to the centre;
along the axis of a helix, at a corner, and by what a line turns unevenly between two.

A line that points elsewhere than its arc by more than 5 degrees and what the rounding explains is a
corner, and an arc that is within the tolerance of its chord is a line.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gcxform.vocabulary import Flags, Floats, Ints

WIDEST = np.pi / 2  # rad; the largest angle of a line: beyond, its sense could be mistaken
CORNER = np.radians(5.0)  # by which a line may point elsewhere than its arc
NUMERIC = 1e-8  # relative; what arithmetic adds to a tolerance


@dataclass(frozen=True)
class Limits:
    """What an arc may be: mm and rad; `step` is the last decimal of the program."""

    tolerance: float
    least_radius: float
    largest_radius: float
    sweep: float
    step: float

    @property
    def noise(self) -> float:
        """How far (mm) two corners are beside where they should be, and make no corner of it."""
        return 1.5 * max(self.step, self.tolerance / 4)


@dataclass(frozen=True)
class Arcs:
    """Arcs: centre (2, n) and radius in mm, sense +1 or -1, sweep in rad.

    `near` (n,): the run is within the tolerance of the arc, or of its chord; `curved`: of the arc,
    which is one that no line could stand for.
    """

    centre: Floats
    radius: Floats
    sense: Floats
    sweep: Floats
    near: Flags
    curved: Flags


class Fit:
    """Fits arcs to runs of corners (3, n): first, second and normal axis of the plane, mm."""

    def __init__(self, corners: Floats, limits: Limits) -> None:
        self.corners = corners
        self.limits = limits
        self.allowed = limits.tolerance * (1 + NUMERIC)

    def arcs(self, first: Ints, last: Ints) -> Arcs:
        """Return the arcs for the runs of corners from `first` to `last`."""
        if not len(first):
            none, never = np.empty(0), np.empty(0, np.bool_)
            return Arcs(np.empty((2, 0)), none, none, none, never, never)
        with np.errstate(invalid="ignore", divide="ignore"):
            return _Runs(self, first, last).arcs()


class _Runs:
    """Runs of corners, laid one after another: `run` (corners,) is the run of each."""

    def __init__(self, fit: Fit, first: Ints, last: Ints) -> None:
        self.fit, self.limits = fit, fit.limits
        count = last - first + 1
        self.begin = np.cumsum(count) - count
        self.final = self.begin + count - 1
        self.run = np.repeat(np.arange(len(first)), count)
        at = np.arange(len(self.run)) - self.begin[self.run] + first[self.run]
        self.u, self.v, self.w = (axis[at] for axis in fit.corners)
        self.inner = self.run[1:] == self.run[:-1]  # the lines between two corners of one run
        # each run is turned so that its chord lies along x, its middle at the origin
        a, b = (self.u[self.begin], self.v[self.begin]), (self.u[self.final], self.v[self.final])
        du, dv = b[0] - a[0], b[1] - a[1]
        self.chord = np.hypot(du, dv)
        self.along = du / self.chord, dv / self.chord
        self.middle = (a[0] + b[0]) / 2, (a[1] + b[1]) / 2
        u, v = self.u - self.middle[0][self.run], self.v - self.middle[1][self.run]
        cos, sin = self.along[0][self.run], self.along[1][self.run]
        self.x, self.y = u * cos + v * sin, v * cos - u * sin

    def _sum(self, values: Floats) -> Floats:
        return np.asarray(np.add.reduceat(values, self.begin))

    def _most(self, values: Floats) -> Floats:
        return np.asarray(np.maximum.reduceat(values, self.begin))

    def _lines(self, values: Floats, between: float) -> Floats:
        """Return a value per line as one per corner, that of the line that ends there."""
        return np.append(between, np.where(self.inner, values, between))

    def arcs(self) -> Arcs:
        """Return the arcs."""
        x, y = self.x, self.y
        power = x**2 + y**2 - (self.chord**2 / 4)[self.run]
        height = self._sum(power * y) / (2 * self._sum(y * y))
        side = np.where(self._sum(y) < 0, 1.0, -1.0)
        radius = np.hypot(height, self.chord / 2)
        straight = self._straight()
        sweep, off = self._certified(height, radius, side)
        near = off <= self.fit.allowed
        rises = np.where(sweep > np.pi, radius + np.abs(height), radius - np.abs(height))
        curved = near & (rises > self.limits.tolerance + self.limits.step)
        curved &= (radius >= self.limits.least_radius) & (radius <= self.limits.largest_radius)
        curved &= sweep <= self.limits.sweep
        centre = np.stack(
            [
                self.middle[0] - height * self.along[1],
                self.middle[1] + height * self.along[0],
            ]
        )
        return Arcs(centre, radius, side, sweep, straight | curved, curved)

    def _straight(self) -> Flags:
        """Return the runs that a line can stand for: no arc begins with them yet."""
        ahead = -self._most(self._lines(self.x[:-1] - self.x[1:], -1.0)) > 0
        share = (self.x / self.chord[self.run]) + 0.5
        off = np.hypot(self.y, self._off_axis(share))
        return np.asarray(ahead & (self._most(off) <= self.fit.allowed))

    def _off_axis(self, share: Floats) -> Floats:
        """Return how far (mm) corners are off along the axis, given the parts of the way there."""
        start, end = self.w[self.begin], self.w[self.final]
        return np.asarray(np.abs(self.w - start[self.run] - (end - start)[self.run] * share))

    def _certified(self, height: Floats, radius: Floats, side: Floats) -> tuple[Floats, Floats]:
        """Return sweeps (rad), and upper bounds of the distances (mm) of arcs and lines; or inf."""
        x, y, sense = self.x, self.y - height[self.run], side[self.run][1:]
        size, inside = np.hypot(x, y), radius[self.run]
        wx, wy = x[1:] - x[:-1], y[1:] - y[:-1]
        length = np.hypot(wx, wy)
        cross = x[:-1] * y[1:] - y[:-1] * x[1:]
        angle = np.arctan2(cross * sense, x[:-1] * x[1:] + y[:-1] * y[1:])
        good = (angle > 0) & (angle <= WIDEST) & self._points_along(x, y, size, wx, wy, length)
        good |= length == 0
        angle = self._lines(angle, 0.0)
        turned = np.cumsum(angle)
        turned -= turned[self.begin][self.run]
        sweep = turned[self.final]
        foot = (x[:-1] * wx + y[:-1] * wy <= 0) & (x[1:] * wx + y[1:] * wy >= 0)
        nearest = np.where(foot & (length > 0), np.abs(cross) / length, np.inf)
        sagitta = np.maximum(inside - self._lines(nearest, np.inf), 0.0)
        flat = np.maximum(np.abs(size - inside), sagitta)
        rise = self._lines(np.abs(np.diff(self.w)), 0.0)
        axial = self._off_axis(turned / sweep[self.run])
        uneven = rise * angle**2 / 54
        off = np.hypot(_with_previous(flat), _with_previous(axial) + uneven)
        off = np.where(self._lines(np.where(good, 0.0, np.inf), 0.0) > 0, np.inf, off)
        off = self._most(off)
        return sweep, np.where(np.isnan(off), np.inf, off)

    def _points_along(
        self, x: Floats, y: Floats, size: Floats, wx: Floats, wy: Floats, length: Floats
    ) -> Flags:
        """Return the lines that point where the arc does in the middle of their angle.

        Rounding turns short lines; what turns more is a corner, and is kept.
        """
        mx, my = x[1:] / size[1:] + x[:-1] / size[:-1], y[1:] / size[1:] + y[:-1] / size[:-1]
        beside = np.abs(wx * mx + wy * my) / (np.hypot(mx, my) * length)
        return np.asarray(beside <= np.sin(CORNER) + self.limits.noise / length)


def _with_previous(values: Floats) -> Floats:
    """Return the larger of each value and the one before."""
    return np.maximum(values, np.append(values[:1], values[:-1]))
