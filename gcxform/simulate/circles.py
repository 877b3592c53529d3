"""Circular tests: the paths of both contouring senses, and their figures by ISO 230-4.

The figures are those of `gcxform/calibrate/circles/deviations.py`.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

import numpy as np

from gcxform.calibrate.circles.deviations import figures, least_squares_circle
from gcxform.system.arrays import Floats
from gcxform.values import dataclass


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
        return figures({"CW": self.cw, "CCW": self.ccw}, self.radius)
