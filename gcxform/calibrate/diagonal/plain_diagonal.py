"""Plain diagonal test: the lengths of the four body diagonals to the squareness (ISO 230-6).

With d the measured minus the nominal length of the diagonal with signs s,

    d = c + s_x s_y p + s_x s_z q + s_y s_z r

and p, q, r give the squareness as slopes: p R / (X Y) of Y to X, q R / (X Z) of Z to X, r R / (Y Z)
of Z to Y; c R = X^2 sX + Y^2 sY + Z^2 sZ, where X, Y, Z are the sides, R the diagonal and s the
scale errors. Four lengths are just enough: only repeated runs leave something over to test them by.
The lengths hardly depend on the alignment of the beams (by the cosine).
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from gcxform.calibrate.diagonal.readings import Diagonals
from gcxform.calibrate.solution import Scatter, Solution, solve
from gcxform.errormodel.functions import AxisFunction, AxisFunctions
from gcxform.errormodel.model import check_contraction
from gcxform.system.arrays import Floats
from gcxform.values import dataclass

BLIND: Final = (
    "a plain diagonal test is blind to scale errors with X^2 sX + Y^2 sY + Z^2 sZ = 0 (X, Y, Z: "
    "the sides of the volume): on a cube +50, -50 and 0 ppm change none of the four lengths; it is "
    "blind to straightness as well"
)
ANGLES: Final = (
    "angular errors are taken to be none: four lengths cannot tell them from squareness and scales"
)


@dataclass(frozen=True, eq=False)
class Squareness:
    """What four lengths tell; `noise` is that of one length, in mm."""

    diagonals: Diagonals
    noise: float
    lengths: Floats
    solution: Solution

    @property
    def scatter(self) -> Scatter:
        """What repeated runs say of the stated noise."""
        return Scatter(self.noise, self.solution.chi_square, self.solution.redundancy)

    @property
    def _factors(self) -> Floats:
        """From c, p, q, r (mm) to the mean scale and the slopes of EXY, EXZ, EYZ (mm per mm)."""
        x, y, z = self.diagonals.volume.travel
        size = self.diagonals.volume.diagonal
        return np.array((1.0 / size, size / (x * y), size / (x * z), size / (y * z)))

    @property
    def slopes(self) -> Floats:
        """The end slopes (3,) of EXY, EXZ and EYZ, mm per mm: -C0Y, +B0Z, -A0Z in rad."""
        return np.asarray((self._factors * self.solution.value)[1:])

    @property
    def mean_scale(self) -> float:
        """(X^2 sX + Y^2 sY + Z^2 sZ) / R^2."""
        return float(self._factors[0] * self.solution.value[0])

    @property
    def covariance(self) -> Floats:
        """The covariance (4, 4) of mean scale and three slopes, for the effective noise."""
        factors = self.scatter.factor * self._factors
        return np.asarray(np.outer(factors, factors) * self.solution.covariance)

    def model(self) -> AxisFunctions:
        """Return the model with this squareness alone: other errors were not measured and are 0.

        Raises UsageError (GX415) if no machine is like that.
        """
        volume = self.diagonals.volume
        ends = np.zeros((3, 2, 3))
        xy, xz, yz = self.slopes
        ends[1, 1, 0] = xy * volume.travel[1]
        ends[2, 1, :2] = np.array((xz, yz)) * volume.travel[2]
        x, y, z = (AxisFunction(volume.nodes(k)[[0, -1]], ends[k]) for k in range(3))
        model = AxisFunctions((x, y, z))
        check_contraction(model)
        return model


def squareness(diagonals: Diagonals, noise: float) -> Squareness:
    """Return what the lengths of the diagonals tell, with the noise of one length in mm."""
    rows, lengths = [], []
    for leg in diagonals.legs:
        x, y, z = leg.signs
        rows.append((1.0, x * y, x * z, y * z))
        deviation = leg.ahead[1]
        lengths.append(deviation[-1] - deviation[0])
    measured = np.array(lengths)
    found = solve(np.array(rows, np.float64), measured, np.full(len(rows), noise))
    return Squareness(diagonals, noise, measured, found)


def spread(found: Squareness) -> Floats:
    """Return the standard deviations (4,) of the mean scale and the three slopes."""
    return np.array([math.sqrt(v) for v in np.diag(found.covariance)])
