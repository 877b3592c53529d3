"""Circular tests: ISO 230-4:2022, from the paths of both contouring senses.

Terms are those of its clause 3. Circular deviation G is the least radial separation of two
concentric circles around the path, for which the standard admits the largest range of radii about
the least-squares centre, as instruments print it and as it is taken here. G(b) is that range of
both paths about their one centre. Radial deviation F is counted from the nominal circle, positive
outwards, about the centre at which the instrument was set up, or (full circles) about the
least-squares centre; the mean bidirectional radial deviation D is the radius of the least-squares
circle of both paths less the nominal one.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gcxform.calibrate.rotary.circle import circles_in_plane
from gcxform.system.arrays import Floats


def least_squares_circle(points: Floats) -> tuple[Floats, float]:
    """Return the centre (2,) and radius in mm of the circle nearest to points (n, 2) in mm.

    The sum of squares of the radial distances is least. Raises ValueError if the points are not
    around a centre.
    """
    mean = points.mean(axis=0)
    with np.errstate(all="ignore"):
        centre, radius, converged = circles_in_plane(points - mean)
    if not converged:
        raise ValueError("the points do not lie around a centre")
    return mean + centre, float(radius)


@dataclass(frozen=True, eq=False)
class Circles:
    """Both paths (n, 2) of a circular test in mm, about the centre of the instrument.

    Columns are the axes of the plane in its order: Z before X in the plane ZX. `radius` is the
    nominal one, mm.
    """

    radius: float
    cw: Floats
    ccw: Floats

    @cached_property
    def both(self) -> Floats:
        """The points of both paths."""
        return np.vstack([self.cw, self.ccw])

    @cached_property
    def centre(self) -> Floats:
        """The least-squares centre (2,) of both paths, mm."""
        return least_squares_circle(self.both)[0]

    def radial(self, path: Floats) -> Floats:
        """Return the radial deviations F (n,) in mm of a path."""
        return np.hypot(path[:, 0], path[:, 1]) - self.radius

    @cached_property
    def figures(self) -> Mapping[str, float]:
        """The figures of the standard, mm."""
        cw, ccw = self.radial(self.cw), self.radial(self.ccw)
        found = {
            "G(CW)": circular_deviation(self.cw),
            "G(CCW)": circular_deviation(self.ccw),
            "G(b)": circular_deviation(self.both),
            "Fmax(CW)": float(cw.max()),
            "Fmin(CW)": float(cw.min()),
            "Fmax(CCW)": float(ccw.max()),
            "Fmin(CCW)": float(ccw.min()),
        }
        found["D"] = least_squares_circle(self.both)[1] - self.radius
        return found


def circular_deviation(points: Floats) -> float:
    """Return the range of radii in mm of points (n, 2) about their least-squares centre: G."""
    centre, _ = least_squares_circle(points)
    radii = np.hypot(*(points - centre).T)
    return float(radii.max() - radii.min())
