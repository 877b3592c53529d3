"""Skew and scale: an error that is linear in the position."""

from __future__ import annotations

import math
from typing import ClassVar

import numpy as np

from gcxform.errormodel.model import ErrorModel, Outside
from gcxform.system.arrays import Floats
from gcxform.values import dataclass


@dataclass(frozen=True, eq=False)
class Linear(ErrorModel):
    """E = matrix @ (position - origin), without limits: squareness, or scales, of a machine.

    `matrix` (3, 3) is in mm per mm, `origin` (3,) in mm the place without error.
    """

    matrix: Floats
    origin: Floats
    kind: ClassVar[str] = "skew"

    def error(
        self,
        position: Floats,
        outside: Outside = Outside.ERROR,
        tool: Floats | None = None,
        sense: Floats | None = None,
    ) -> Floats:
        """Return E (n, 3) in mm at the positions (n, 3) in mm: see `ErrorModel.error`."""
        total = np.zeros((3, len(position)))
        for to, by in zip(*np.nonzero(self.matrix), strict=True):
            total[to] += self.matrix[to, by] * (position[:, by] - self.origin[by])
        return total.T

    @property
    def nodes(self) -> tuple[Floats, Floats, Floats]:
        """No nodes: the field is straight."""
        return np.empty(0), np.empty(0), np.empty(0)

    def lipschitz(self, reach: float = 0.0) -> float:
        """Return the spectral norm of the matrix."""
        return float(np.linalg.norm(self.matrix, 2)) if np.isfinite(self.matrix).all() else math.inf

    def largest(self, reach: float = 0.0) -> float:
        """Return infinity: without limits there is no largest error."""
        return math.inf if self.matrix.any() else 0.0

    def range_of(self, axis_index: int) -> tuple[float, float]:
        """Return that there are no limits."""
        return -math.inf, math.inf
