"""Functions of one axis, and the model of nine of them.

`AxisFunctions` is the first-order rigid-body model without angular errors: three linear axes, each
with a positioning and two straightness errors, squareness folded in. Angular
errors are in `gcxform/errormodel/rigid.py`.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import field
from functools import cached_property
from typing import ClassVar, NamedTuple

import numpy as np
import numpy.typing as npt

from gcxform.diagnostics import Diagnostic, UsageError
from gcxform.errormodel.model import AXES
from gcxform.errormodel.tabled import AxisTables
from gcxform.system.arrays import Floats
from gcxform.values import dataclass

COMBINATIONS_AT_MOST = 250_000  # cells (50 ms) for which the Lipschitz constant is computed exactly
COLUMNS = ("X", "Y", "Z", "A", "B", "C")
"""What an axis function has: displacements in X, Y, Z (mm), and turns about them (rad)."""


class Fault(NamedTuple):
    """What is wrong with a table of functions: the column it is in and, if known, the row."""

    code: str
    message: str
    column: str
    row: int | None = None


def faults(position: npt.ArrayLike, columns: Mapping[str, npt.ArrayLike]) -> Iterator[Fault]:
    """Yield every defect of functions (named columns, mm) over node positions (mm)."""
    nodes = np.asarray(position, dtype=np.float64)
    if len(nodes) < 2:
        yield Fault("GX411", f"the table has {_count(len(nodes), 'node')}, needed are 2", _POSITION)
    for name, column in {_POSITION: nodes, **columns}.items():
        values = np.asarray(column, dtype=np.float64)
        if len(values) != len(nodes):
            counts = f"{_count(len(values), 'value')} for {_count(len(nodes), 'position')}"
            yield Fault("GX410", f"{name} has {counts}", name)
        for row in np.flatnonzero(~np.isfinite(values)):
            yield Fault("GX412", f"{name} holds {values[row]}", name, int(row))
    yield from ascending(nodes)


def ascending(position: npt.ArrayLike) -> Iterator[Fault]:
    """Yield the places where positions (mm) do not rise."""
    nodes = np.asarray(position, dtype=np.float64)
    for row in np.flatnonzero(~(np.diff(nodes) > 0.0)) + 1:
        here, before = float(nodes[row]), float(nodes[row - 1])
        if here == before:
            yield Fault("GX409", f"position {here} stands twice", _POSITION, int(row))
        else:
            yield Fault("GX408", f"position {here} comes after {before}", _POSITION, int(row))


_POSITION = "position"


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}{'' if number == 1 else 's'}"


@dataclass(frozen=True, eq=False)
class AxisFunction:
    """The error of one moving axis: `values` (n, 3) in mm at `position` (n,) in mm.

    With angular errors there are six columns, and the last three are rad. Linear between the nodes,
    and continued beyond them by the first and the last cell.
    """

    position: Floats
    values: Floats
    slope: Floats = field(init=False, repr=False)  # (n - 1, columns), per mm
    _start: Floats = field(init=False, repr=False)  # (columns, n - 1): value at the cell's left
    _rise: Floats = field(init=False, repr=False)  # (columns, n - 1): value right minus left
    _per_mm: Floats = field(init=False, repr=False)  # (n - 1,): cells per mm
    _uniform: bool = field(init=False, repr=False)

    def __post_init__(self) -> None:
        position = np.array(self.position, dtype=np.float64)
        values = np.array(self.values, dtype=np.float64)
        columns = dict(zip(COLUMNS, values.T, strict=False))
        if found := tuple(faults(position, columns)):
            raise UsageError(tuple(Diagnostic(f.code, f.message) for f in found))
        # Nodes a hair apart overflow here; the slope then is inf and `check_contraction` refuses.
        with np.errstate(all="ignore"):
            rise = np.diff(values, axis=0)
            width = np.diff(position)
            arrays = {
                "position": position,
                "values": values,
                "slope": rise / width[:, None],
                "_start": np.ascontiguousarray(values[:-1].T),
                "_rise": np.ascontiguousarray(rise.T),
                "_per_mm": 1.0 / width,
            }
        for name, array in arrays.items():
            array.flags.writeable = False
            object.__setattr__(self, name, array)
        object.__setattr__(self, "_uniform", _is_uniform(position))

    @property
    def trivial(self) -> bool:
        """Whether the function is zero everywhere."""
        return not self.values.any()

    def add_columns(self, total: Floats, coordinate: Floats, which: Iterable[int]) -> None:
        """Add some columns at the coordinates (n,) in mm to as many rows of `total`, in place."""
        cell, part = self._uniform_cell(coordinate) if self._uniform else self._cell(coordinate)
        term = np.empty_like(part)
        for row, k in zip(total, which, strict=True):
            # "clip" spares numpy a buffer; only the cell of a nan is out of range.
            np.take(self._rise[k], cell, out=term, mode="clip")
            term *= part
            row += term
            np.take(self._start[k], cell, out=term, mode="clip")
            row += term

    def _uniform_cell(self, coordinate: Floats) -> tuple[npt.NDArray[np.intp], Floats]:
        """Return the cell (n,) and the part of it (n,) left of the coordinate, by arithmetic.

        Rounding may choose the neighbour of the right cell at a node. The field is continuous
        there, so the error is then off by rounding only and the cell needs no correction.
        """
        count = len(self.position) - 1
        part = coordinate - self.position[0]
        part *= count / (self.position[-1] - self.position[0])
        cell = np.clip(part, 0.0, count - 1.0)
        np.floor(cell, out=cell)
        part -= cell
        return cell.astype(np.intp), part

    def _cell(self, coordinate: Floats) -> tuple[npt.NDArray[np.intp], Floats]:
        """Return the same by search: the border cells take what is beyond them, and nan."""
        cell = np.searchsorted(self.position[1:-1], coordinate, side="right")
        part = coordinate - self.position[cell]
        part *= self._per_mm[cell]
        return cell, part


def _is_uniform(position: Floats) -> bool:
    """Whether the nodes are equally spaced up to the rounding of decimals such as 0.1."""
    with np.errstate(over="ignore", invalid="ignore"):
        even = np.linspace(position[0], position[-1], len(position))
        return bool(np.all(np.abs(even - position) <= 8.0 * np.spacing(np.abs(position).max())))


@dataclass(frozen=True, eq=False)
class AxisFunctions(AxisTables[AxisFunction]):
    """The model of nine functions, E = Dx(x) + Dy(y) + Dz(z).

    It is the first-order rigid-body model without angular errors, hence independent of the tool
    offset. `axes` holds the functions of X, Y and Z; an axis which is None has no error and no
    limits. `order` names the axes from the workpiece to the tool.
    """

    order: str = AXES
    kind: ClassVar[str] = "axis-functions"

    def add(self, total: Floats, place: Floats, tool: Floats | None, sense: Floats | None) -> None:
        """Add the errors (3, n) at places (n, 3): see `Tabled.add`."""
        for k, function in enumerate(self.axes):
            if function is not None and not function.trivial:
                function.add_columns(total, place[:, k], range(3))

    def lipschitz(self, reach: float = 0.0) -> float:
        """Return the largest spectral norm of dE/dc (mm/mm): see `ErrorModel.lipschitz`.

        The columns of dE/dc are the slopes of the three axes, each of its own cell. Exact over all
        combinations of cells up to `COMBINATIONS_AT_MOST`, above that the bound of `_norm_bound`.
        """
        return self._lipschitz

    @cached_property
    def _lipschitz(self) -> float:
        slopes = [np.zeros((1, 3)) if f is None else f.slope for f in self.axes]
        if not all(np.isfinite(s).all() for s in slopes):
            return math.inf
        with np.errstate(over="ignore", invalid="ignore"):
            exact = math.prod(len(s) for s in slopes) <= COMBINATIONS_AT_MOST
            return _largest_norm(slopes) if exact else _norm_bound(slopes)

    def largest(self, reach: float = 0.0) -> float:
        """Return the largest |E| in mm inside the table.

        |E| is convex in every cell, so its maximum is at nodes: exact over all combinations of
        nodes up to `COMBINATIONS_AT_MOST`, above that the corner of the box of all sums.
        """
        return self._largest

    @cached_property
    def _largest(self) -> float:
        x, y, z = (np.zeros((1, 3)) if f is None else f.values for f in self.axes)
        if len(x) * len(y) * len(z) <= COMBINATIONS_AT_MOST:
            total = (x[:, None] + y[None, :]).reshape(-1, 1, 3) + z[None, :]
            return float(np.linalg.norm(total, axis=-1).max())
        low, high = (x.min(0) + y.min(0) + z.min(0)), (x.max(0) + y.max(0) + z.max(0))
        return float(np.linalg.norm(np.maximum(np.abs(low), np.abs(high))))


def _largest_norm(slopes: list[Floats]) -> float:
    """Return the largest spectral norm of [a b c] over all rows a, b, c of three (n, 3) arrays.

    The square of the norm is the largest eigenvalue of the Gram matrix, by the trigonometric
    solution of its cubic (O. K. Smith, Comm. ACM 4 (1961) 168).
    """
    a, b, c = slopes
    scale = max(float(np.abs(s).max()) for s in slopes)
    if scale == 0.0:
        return 0.0
    a, b, c = a / scale, b / scale, c / scale  # the cubes of slopes of 1e-5 lose no digits
    aa, bb, cc = (np.einsum("ij,ij->i", s, s) for s in (a, b, c))
    aa, bb = aa[:, None, None], bb[None, :, None]
    ab, ac, bc = (a @ b.T)[:, :, None], (a @ c.T)[:, None, :], (b @ c.T)[None, :, :]
    mean = (aa + bb + cc) / 3.0
    aa, bb, cc = aa - mean, bb - mean, cc - mean
    spread = np.sqrt((aa**2 + bb**2 + cc**2 + 2.0 * (ab**2 + ac**2 + bc**2)) / 6.0)
    half = (aa * bb * cc + 2.0 * ab * bc * ac - aa * bc**2 - bb * ac**2 - cc * ab**2) / 2.0
    cosine = np.clip(half / np.maximum(spread, 1e-100) ** 3, -1.0, 1.0)
    return scale * math.sqrt(float((mean + 2.0 * spread * np.cos(np.arccos(cosine) / 3.0)).max()))


def _norm_bound(slopes: list[Floats]) -> float:
    """Return a bound of the same norm from pairs of cells only.

    The largest eigenvalue of a matrix grows with the moduli of its entries (Perron, Frobenius), so
    the matrix of the largest modulus of each entry of the Gram matrix bounds all of them.
    """
    gram = np.empty((3, 3))
    for i, one in enumerate(slopes):
        gram[i, i] = float((one * one).sum(axis=1).max())
        for j in range(i):
            pieces = np.array_split(one, 1 + len(one) * len(slopes[j]) // COMBINATIONS_AT_MOST)
            gram[i, j] = gram[j, i] = max(float(np.abs(p @ slopes[j].T).max()) for p in pieces)
    return math.sqrt(float(np.linalg.eigvalsh(gram)[-1])) if np.isfinite(gram).all() else math.inf
