"""Moves of contours under cutter compensation, in columns, each in the coordinates of its plane.

Points and directions are (2, n), mm, so that an x and a y are columns too.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gcxform.vocabulary import Flags, Floats, Ints


@dataclass(frozen=True)
class Moves:
    """The moves of contours, one contour behind the other.

    start, end, centre  (2, n) mm; the centre of lines is nan
    sense, sweep        (n,) +1 counter-clockwise, -1 clockwise, 0 line; rad
    side, radius        (n,) +1 or -1; mm, of the tool
    begins              (n,) whether the move begins compensation
    """

    start: Floats
    end: Floats
    centre: Floats
    sense: Floats
    sweep: Floats
    side: Floats
    radius: Floats
    begins: Flags

    @cached_property
    def arc(self) -> Flags:
        """Whether a move (n,) is an arc."""
        return np.asarray(self.sense != 0)

    @cached_property
    def ends(self) -> Flags:
        """Whether a move (n,) is the last of its contour."""
        return np.append(self.begins[1:], True)

    @cached_property
    def off(self) -> Floats:
        """How far (n,) to the left the centre of the tool is."""
        return self.side * self.radius

    @cached_property
    def reach(self) -> Floats:
        """The radii (n,) of the centre paths of arcs; what is not known of lines."""
        x, y = self.start - self.centre
        return np.asarray(np.hypot(x, y) - self.sense * self.off)

    @cached_property
    def first(self) -> Floats:
        """Unit tangents (2, n) where moves begin."""
        lines = unit(self.end - self.start)
        return np.where(self.arc, self._around(self.start), lines)

    @cached_property
    def last(self) -> Floats:
        """Unit tangents (2, n) where moves end."""
        return np.where(self.arc, self._around(self.end), self.first)

    @cached_property
    def turn(self) -> Floats:
        """By how much (n,) the contour turns before a move, rad; inwards is positive."""
        return self.side * angle(np.roll(self.last, 1, axis=1), self.first)

    def heading(self, k: Ints, at: Floats) -> Floats:
        """Return the unit tangents (2, m) of moves, or of their offset curves, at points."""
        out = unit(at - self.centre[:, k])
        return np.where(self.arc[k], left_of(out) * self.sense[k], self.first[:, k])

    def _around(self, at: Floats) -> Floats:
        return left_of(unit(at - self.centre)) * self.sense


def left_of(along: Floats) -> Floats:
    """Return directions (2, n), turned to the left by a right angle."""
    return np.stack([-along[1], along[0]])


def unit(way: Floats) -> Floats:
    """Return directions (2, n) of the length 1."""
    return np.asarray(way / np.hypot(*way))


def cross(u: Floats, v: Floats) -> Floats:
    """Return the cross products (n,)."""
    return np.asarray(u[0] * v[1] - u[1] * v[0])


def dot(u: Floats, v: Floats) -> Floats:
    """Return the dot products (n,)."""
    return np.asarray(u[0] * v[0] + u[1] * v[1])


def angle(u: Floats, v: Floats) -> Floats:
    """Return the angles (n,), rad, -pi to pi, from directions to others."""
    return np.asarray(np.arctan2(cross(u, v), dot(u, v)))
