"""The lattice: errors at the points of a rectilinear grid, trilinear between them.

The rigid-body model is trilinear in each cell if every node of its functions is a node of the grid,
so functions become a lattice without loss. For tools other than that of the measurement the turns
of the tool are a second lattice: E(q, t) = E(q, t0) + R(q) x (t - t0).
"""

from __future__ import annotations

import itertools
import math
from functools import cached_property
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from gcxform.errormodel.tabled import Positions, Tabled
from gcxform.system.arrays import Floats
from gcxform.values import dataclass

Cell = npt.NDArray[np.intp]
Field = tuple[list[Floats], Floats]
CORNERS = tuple(itertools.product((0, 1), repeat=3))


@dataclass(frozen=True, eq=False)
class Lattice(Tabled):
    """Errors on a grid.

    `grid` holds the positions (mm) on X, Y and Z, ascending; on an axis with one position the error
    is the same everywhere. `values` (nx, ny, nz, 3) are the errors in mm, `turns` (nx, ny, nz, 3)
    the angular errors in rad if they are known, and `measured` the tool (mm) of the measurement.
    """

    grid: tuple[Floats, Floats, Floats]
    values: Floats
    turns: Floats | None = None
    measured: tuple[float, float, float] | None = None
    kind: ClassVar[str] = "lattice"

    @property
    def tool(self) -> Floats | None:
        """The way (3,) in mm from the gauge point to the measured point."""
        return None if self.measured is None else np.array(self.measured)

    @property
    def needs_tool(self) -> bool:
        """Whether the angular errors are known."""
        return self.turns is not None

    @property
    def positions(self) -> Positions:
        """The positions of the grid in mm; None for an axis with one."""
        x, y, z = (n if len(n) > 1 else None for n in self.grid)
        return x, y, z

    def add(self, total: Floats, place: Floats, tool: Floats | None, sense: Floats | None) -> None:
        """Add the errors (3, n) at places (n, 3): see `Tabled.add`."""
        cells = [self._cell(axis, place[:, axis]) for axis in range(3)]
        flat = self._flat
        turning = tool is not None and self.turns is not None
        found = np.zeros((len(flat) if turning else 3, len(place)))
        _, ny, nz = self.values.shape[:3]
        for corner in CORNERS:
            if any(c and not len(part) for c, (_, part) in zip(corner, cells, strict=True)):
                continue
            weight = np.ones(len(place))
            at = []
            for c, (cell, part) in zip(corner, cells, strict=True):
                at.append(cell + c)
                if len(part):
                    weight = weight * (part if c else 1.0 - part)
            index = (at[0] * ny + at[1]) * nz + at[2]
            for k, row in enumerate(found):
                row += weight * np.take(flat[k], index, mode="clip")
        total += found[:3]
        if turning and tool is not None:
            origin = np.zeros(3) if self.tool is None else self.tool
            total += np.cross(found[3:].T, tool - origin).T

    def _cell(self, axis: int, coordinate: Floats) -> tuple[Cell, Floats]:
        """Return the cell (n,) and the part of it (n,); no parts where an axis has one node."""
        nodes = self.grid[axis]
        if len(nodes) == 1:
            return np.zeros(len(coordinate), np.intp), np.empty(0)
        cell = np.searchsorted(nodes[1:-1], coordinate, side="right")
        return cell, (coordinate - nodes[cell]) / (nodes[cell + 1] - nodes[cell])

    @cached_property
    def _flat(self) -> Floats:
        """The values, and the turns below them, as rows (3 or 6, points)."""
        rows = [self.values] if self.turns is None else [self.values, self.turns]
        return np.ascontiguousarray(np.vstack([r.reshape(-1, 3).T for r in rows]))

    # --- bounds ---

    def lipschitz(self, reach: float = 0.0) -> float:
        """Return a bound of the spectral norm of dE/dc: see `ErrorModel.lipschitz`.

        A derivative along one axis is bilinear in the two others, so it is largest on an edge of a
        cell; the norm of a matrix is at most that of its columns.
        """
        return self._steepness[0] + reach * self._steepness[1]

    def curvature(self, reach: float = 0.0) -> Floats:
        """Return bounds (3, 3) of |d2E/dci dcj| (mm/mm2), from the faces of all cells."""
        return self._twists[0] + reach * self._twists[1]

    def turning(self, cells: float = 1.0) -> tuple[float, float]:
        """Return bounds of the turns, which are largest at nodes: see `ErrorModel.turning`."""
        if self.turns is None:
            return 0.0, 0.0
        grid, turns = self._wider(self.turns, cells)
        return float(np.sqrt((turns**2).sum(axis=-1)).max()), _steepest(grid, turns)

    @cached_property
    def _steepness(self) -> tuple[float, float]:
        values, turns = self._fields()
        return _steepest(*values), _steepest(*turns)

    @cached_property
    def _twists(self) -> tuple[Floats, Floats]:
        values, turns = self._fields()
        return _twist(*values), _twist(*turns)

    def _fields(self) -> tuple[Field, Field]:
        """Return grid and values, and grid and turns, with one extrapolated cell on every side."""
        turns = np.zeros_like(self.values) if self.turns is None else self.turns
        with np.errstate(over="ignore", invalid="ignore"):
            return self._wider(self.values), self._wider(turns)

    def largest(self, reach: float = 0.0) -> float:
        """Return a bound of |E| in mm inside the grid: it is largest at a node."""
        found = float(np.sqrt((self.values**2).sum(axis=-1)).max())
        if self.turns is not None and reach:
            found += reach * float(np.sqrt((self.turns**2).sum(axis=-1)).max())
        return found

    def _wider(self, values: Floats, cells: float = 1.0) -> Field:
        """Return the grid and values with a number of extrapolated cells on every side."""
        grid = list(self.grid)
        for axis in range(3):
            nodes = grid[axis]
            if len(nodes) > 1 and cells:
                v = np.moveaxis(values, axis, 0)
                grid[axis], v = _beyond(nodes, cells), _beyond(v, cells)
                values = np.moveaxis(v, 0, axis)
        return grid, values


def _beyond(rows: Floats, cells: float) -> Floats:
    """Return rows with one more at both ends, as far beyond them as a number of steps."""
    before = rows[:1] + cells * (rows[:1] - rows[1:2])
    return np.concatenate([before, rows, rows[-1:] + cells * (rows[-1:] - rows[-2:-1])])


def _steepest(grid: list[Floats], values: Floats) -> float:
    """Return the largest norm of the columns of the derivative over all cells."""
    square = np.zeros([max(len(n) - 1, 1) for n in grid])
    with np.errstate(over="ignore", invalid="ignore"):
        for axis in range(3):
            if len(grid[axis]) > 1:
                slope = _along(grid, values, axis)
                size = (slope**2).sum(axis=-1)
                for other in range(3):
                    if other != axis and len(grid[other]) > 1:
                        size = _larger_neighbour(size, other)
                square = square + size
        largest = float(np.sqrt(square.max()))
    return largest if math.isfinite(largest) else math.inf


def _twist(grid: list[Floats], values: Floats) -> Floats:
    """Return the largest mixed derivatives (3, 3) of all cells."""
    found = np.zeros((3, 3))
    for i, j in ((0, 1), (0, 2), (1, 2)):
        if len(grid[i]) > 1 and len(grid[j]) > 1:
            mixed = _along(grid, _along(grid, values, i), j)
            found[i, j] = found[j, i] = float(np.sqrt((mixed**2).sum(axis=-1)).max())
    return found


def _along(grid: list[Floats], values: Floats, axis: int) -> Floats:
    """Return the slopes of values along an axis, one fewer there."""
    width = np.diff(grid[axis]).reshape([-1 if k == axis else 1 for k in range(4)])
    with np.errstate(over="ignore", invalid="ignore"):
        return np.asarray(np.diff(values, axis=axis) / width)


def _larger_neighbour(size: Floats, axis: int) -> Floats:
    """Return the larger of each two neighbours along an axis."""
    s = np.moveaxis(size, axis, 0)
    return np.moveaxis(np.maximum(s[:-1], s[1:]), 0, axis)
