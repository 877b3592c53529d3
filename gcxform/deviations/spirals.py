"""How far arcs are apart whose radius changes evenly on the way, as that of most real ones does.

A spiral about a centre c, seen from another centre, is a e(p) (1 + z) with |z| = |c| / a: it has a
radius and an angle there. Its points are paired with those of the other spiral at the same angle.
That distance is taken at even parts of the way; between two of them, a part h apart, it is at most
what it is at the ends and h^2 / 8 times a bound of its second derivative more. For |z| <= 1/4 each
term of that derivative is bounded with |1 + z| >= 3/4, and the angle only grows. Where the centres
are farther apart, points at the same part of both are paired.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from gcxform.system.arrays import Flags, Floats, Ints
from gcxform.values import dataclass

FEW, PARTS = 16, 128  # at which spirals are compared
NEAR = 2e-5  # mm; what may be between a few parts


@dataclass(frozen=True, slots=True)
class Spirals:
    """Arcs (n,) about a centre: first and last radius (mm), angle of the start and sweep (rad)."""

    first: Floats
    last: Floats
    angle: Floats
    sweep: Floats

    def of(self, rows: Ints) -> Spirals:
        """Return some of them."""
        return Spirals(self.first[rows], self.last[rows], self.angle[rows], self.sweep[rows])

    @property
    def grows(self) -> Floats:
        """How much the radius changes (n,)."""
        return self.last - self.first

    def radius(self, part: float) -> Floats:
        """Return the radius (n,) at a part of the way."""
        return self.first + self.grows * part

    @property
    def bend(self) -> Floats:
        """A bound (n,) of the second derivative by the part: of r e(s t) with r' constant."""
        most = np.maximum(self.first, self.last)
        return np.asarray(2 * np.abs(self.grows) * self.sweep + most * self.sweep**2)


def spirals_apart(mine: Spirals, its: Spirals, shift: Floats, sense: Floats) -> Floats:
    """Return upper bounds (n,) of how far spirals are apart, mm.

    `shift` (n, 2) is from the centres of the others to those of the first, `sense` (n,) is 1 where
    both go counterclockwise and -1 where they go clockwise.
    """
    away = np.hypot(*shift.T)
    rate, z = (size / np.minimum(mine.first, mine.last) for size in (np.abs(mine.grows), away))
    bend = away * (2.4 * z * rate**2 + 6.0 * z * rate * mine.sweep + 2.0 * mine.sweep**2)
    bend += np.abs(its.grows) / its.sweep * 3.2 * z * (mine.sweep + rate) ** 2
    near = (z <= 0.25) & (rate <= mine.sweep) & (its.sweep > 0)
    found = np.empty(len(away))
    for parts, some in _by_parts(bend, near):
        seen = _at_angles(mine.of(some), its.of(some), shift[some], sense[some], parts)
        found[some] = seen + bend[some] / parts**2 / 8.0
    far = np.flatnonzero(~near)
    if len(far):
        found[far] = _at_parts(mine.of(far), its.of(far), shift[far], sense[far])
    return found


def _by_parts(bend: Floats, near: Flags) -> Iterator[tuple[int, Ints]]:
    """Yield how finely to look at arcs that bend so much, and which these are."""
    few = bend <= 8.0 * FEW**2 * NEAR
    for parts, some in ((FEW, near & few), (PARTS, near & ~few)):
        if some.any():
            yield parts, np.flatnonzero(some)


def _at_angles(mine: Spirals, its: Spirals, shift: Floats, sense: Floats, parts: int) -> Floats:
    """Return the largest distance (n,) of points at the same angle, at even parts."""
    away, aside = np.hypot(*shift.T), np.arctan2(shift[:, 1], shift[:, 0])
    worst, first = np.zeros(len(away)), np.zeros(len(away))
    for part in np.linspace(0.0, 1.0, parts + 1):
        angle = mine.angle + sense * mine.sweep * part
        seen = 1 + away / mine.radius(part) * np.exp(1j * (aside - angle))
        if part == 0.0:
            first = np.angle(seen)
        reached = (mine.sweep * part + sense * (np.angle(seen) - first)) / its.sweep
        radius = its.first + its.grows * np.clip(reached, 0.0, 1.0)
        worst = np.maximum(worst, np.abs(mine.radius(part) * np.abs(seen) - radius))
    return worst


def _at_parts(mine: Spirals, its: Spirals, shift: Floats, sense: Floats) -> Floats:
    """Return a bound (n,) of the distance of points at the same part of both."""
    worst = np.zeros(len(shift))
    for part in np.linspace(0.0, 1.0, PARTS + 1):
        gap = shift.copy()
        for sign, one in ((1.0, mine), (-1.0, its)):
            angle = one.angle + sense * one.sweep * part
            round_ = np.stack([np.cos(angle), np.sin(angle)], axis=1)
            gap += sign * one.radius(part)[:, None] * round_
        worst = np.maximum(worst, np.hypot(*gap.T))
    return np.asarray(worst + (mine.bend + its.bend) / PARTS**2 / 8.0)
