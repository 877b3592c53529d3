"""Rational B-splines (splines of weights and knots) as cubic Bezier curves.

A curve of n control points and order k has the open uniform knots 0 (k times), 1, 2 .. n - k, and
n - k + 1 (k times), so it begins in the first control point and ends in the last. In homogeneous
coordinates (w x, w y, w z, w) it is a polynomial between two knots, found by de Boor's algorithm;
formulas: L. Piegl, W. Tiller, The NURBS Book, chapters 2 to 4.

Each Bezier curve has the ends and the tangents of its part. Of order 4 at most and with weights
that are all the same it is that part; else it is off by the fourth power of its length, and as
many are taken as it needs to be within `NEAR` at the same parameter.
"""

from __future__ import annotations

import numpy as np

from gcxform.system.arrays import Floats, Ints
from gcxform.values import dataclass

NEAR = 1e-5  # mm; curves as near as this are the same
LOOKED_AT = np.array([0.1, 0.3, 0.5, 0.7, 0.9])  # of a part: the error is flat around its middle
DOUBLINGS = 12  # of the parts between two knots


@dataclass(frozen=True)
class Nurbs:
    """A curve: control points (n, d) in mm, their weights (n,) above zero, and its order."""

    points: Floats
    weights: Floats
    order: int

    @property
    def spans(self) -> int:
        """How many parts between knots it has."""
        return len(self.points) - self.order + 1

    def at(self, span: Ints, u: Floats) -> tuple[Floats, Floats]:
        """Return points and derivatives (m, d) by u, in parts between knots (m,)."""
        degree = self.order - 1
        inner = np.arange(1.0, self.spans)
        knots = np.concatenate([np.zeros(self.order), inner, np.full(self.order, self.spans)])
        heavy = np.column_stack([self.points * self.weights[:, None], self.weights])
        wide = knots[self.order : -1] - knots[1 : -self.order]
        steps = degree * np.diff(heavy, axis=0) / wide[:, None]
        whole = _de_boor(heavy, knots, degree, span + degree, u)
        slope = _de_boor(steps, knots[1:-1], degree - 1, span + degree - 1, u)
        place = whole[:, :-1] / whole[:, -1:]
        return place, (slope[:, :-1] - slope[:, -1:] * place) / whole[:, -1:]

    def beziers(self, least: int) -> Floats | None:
        """Return control points (m, 4, d) of Bezier curves in its place, `least` of them or more.

        None where weights differ so much that no number of them is near enough.
        """
        parts = np.full(self.spans, -(-least // self.spans))
        for _ in range(DOUBLINGS):
            span = np.repeat(np.arange(self.spans), parts)
            length = 1.0 / parts[span]
            nth = np.arange(len(span)) - np.repeat(np.cumsum(parts) - parts, parts)
            curves = self._curves(span, span + nth * length, length)
            off = self._off(curves, span, span + nth * length, length)
            far = np.zeros(self.spans, np.bool_)
            far[span[~(off <= NEAR / 2)]] = True
            if not far.any():
                return curves
            parts = np.where(far, parts * 2, parts)
        return None

    def _curves(self, span: Ints, u: Floats, length: Floats) -> Floats:
        """Return the Bezier curves (m, 4, d) with the ends and tangents of parts."""
        (first, out), (last, into) = self.at(span, u), self.at(span, u + length)
        third = length[:, None] / 3
        return np.stack([first, first + out * third, last - into * third, last], axis=1)

    def _off(self, curves: Floats, span: Ints, u: Floats, length: Floats) -> Floats:
        """Return how far (mm) Bezier curves are off the parts (m,) that they stand for."""
        worst = np.zeros(len(span))
        for t in LOOKED_AT.tolist():
            s = 1.0 - t
            weights = np.array([s**3, 3 * s * s * t, 3 * s * t * t, t**3])
            here, _ = self.at(span, u + t * length)
            gap = np.einsum("k,mkx->mx", weights, curves) - here
            worst = np.maximum(worst, np.sqrt((gap**2).sum(axis=1)))
        return worst


def _de_boor(points: Floats, knots: Floats, degree: int, at: Ints, u: Floats) -> Floats:
    """Return a B-spline at u (m,), each between the knots `at` and `at` + 1."""
    d = points[at[:, None] + np.arange(-degree, 1)]
    for level in range(1, degree + 1):
        for j in range(degree, level - 1, -1):
            low, high = knots[at - degree + j], knots[at + 1 + j - level]
            part = ((u - low) / (high - low))[:, None]
            d[:, j] = (1.0 - part) * d[:, j - 1] + part * d[:, j]
    return np.asarray(d[:, degree])
