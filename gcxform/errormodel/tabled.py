"""Models that are tables: where they bend, where they end, and what holds beyond.

A table per axis or a grid: `Tabled` asks a model for the positions of its nodes and for the error
at places, and does the rest once for all of them.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import Generic, Protocol, TypeVar

import numpy as np

from gcxform.errormodel.model import BLOCK, ErrorModel, Outside, part_of
from gcxform.system.arrays import Floats
from gcxform.values import dataclass

Positions = tuple[Floats | None, Floats | None, Floats | None]


class Tabled(ErrorModel):
    """A model over the positions of a table on each axis, or on some of them."""

    @property
    @abstractmethod
    def positions(self) -> Positions:
        """The ascending positions (mm) of X, Y and Z; None for an axis without limits and nodes."""

    @abstractmethod
    def add(self, total: Floats, place: Floats, tool: Floats | None, sense: Floats | None) -> None:
        """Add the errors (3, n) in mm at places (n, 3) in mm to `total`, in place.

        Beyond the table they are extrapolated; tool and sense are as for `ErrorModel.error`.
        """

    def error(
        self,
        position: Floats,
        outside: Outside = Outside.ERROR,
        tool: Floats | None = None,
        sense: Floats | None = None,
    ) -> Floats:
        """Return E (n, 3) in mm at the positions (n, 3) in mm: see `ErrorModel.error`."""
        total = np.zeros((3, len(position)))
        place = self._clamped(position) if outside is Outside.CLAMP else position
        # Unknown coordinates are nan, and a cast of nan to a cell warns.
        with np.errstate(invalid="ignore"):
            for first in range(0, len(position), BLOCK):
                piece = slice(first, first + BLOCK)
                self.add(total[:, piece], place[piece], part_of(tool, piece), part_of(sense, piece))
        if outside is Outside.ZERO:
            total[:, self.outside(position).any(axis=1)] = 0.0
        return total.T

    def _clamped(self, position: Floats) -> Floats:
        """Return positions, those beyond the table at its border."""
        columns = [np.clip(position[:, k], *self.range_of(k)) for k in range(3)]
        return np.array(columns).T

    @property
    def nodes(self) -> tuple[Floats, Floats, Floats]:
        """The node positions of X, Y and Z in mm; empty for an axis without a table."""
        x, y, z = (np.empty(0) if nodes is None else nodes for nodes in self.positions)
        return x, y, z

    def range_of(self, axis_index: int) -> tuple[float, float]:
        """Return the first and last node of an axis in mm; infinite for one without a table."""
        nodes = self.positions[axis_index]
        return (-math.inf, math.inf) if nodes is None else (float(nodes[0]), float(nodes[-1]))


class OneAxis(Protocol):
    """A table of one axis."""

    @property
    def position(self) -> Floats:
        """The ascending positions (n,) of the nodes in mm."""


Table = TypeVar("Table", bound=OneAxis)


@dataclass(frozen=True, eq=False)
class AxisTables(Tabled, Generic[Table]):
    """A table each for X, Y and Z; an axis which is None has no error and no limits."""

    axes: tuple[Table | None, Table | None, Table | None]

    @property
    def positions(self) -> Positions:
        """The positions of X, Y and Z in mm."""
        x, y, z = (None if table is None else table.position for table in self.axes)
        return x, y, z
