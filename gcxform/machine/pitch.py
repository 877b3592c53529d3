"""Pitch tables: the positioning error of each axis, in both directions of travel.

Where the two differ the axis has backlash. Controls and laser interferometers know no more of a
machine than this (ISO 230-2).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from gcxform.diagnostics import Diagnostic, UsageError
from gcxform.machine.errors import BoolArray, ErrorModel, FloatArray, Outside
from gcxform.machine.functions import AxisFunction, faults


@dataclass(frozen=True, eq=False)
class PitchTable:
    """The error (n,) in mm of one axis along itself, at `position` (n,) in mm.

    `forward` is the error after travel in the positive direction, `reverse` after the negative.
    """

    position: FloatArray
    forward: FloatArray
    reverse: FloatArray

    def __post_init__(self) -> None:
        columns = {"forward": self.forward, "reverse": self.reverse}
        if found := tuple(faults(self.position, columns)):
            raise UsageError(tuple(Diagnostic(f.code, f.message) for f in found))

    @cached_property
    def halves(self) -> AxisFunction:
        """The mean of both directions, and half of what forward is more than reverse (mm)."""
        columns = [(self.forward + self.reverse) / 2.0, (self.forward - self.reverse) / 2.0]
        return AxisFunction(self.position, np.stack(columns, axis=1))

    @property
    def backlash(self) -> bool:
        """Whether the directions differ."""
        return bool((self.forward != self.reverse).any())


@dataclass(frozen=True, eq=False)
class PitchTables(ErrorModel):
    """The positioning errors of X, Y and Z; an axis which is None has no error and no limits."""

    axes: tuple[PitchTable | None, PitchTable | None, PitchTable | None]
    kind: ClassVar[str] = "pitch"

    def error(
        self,
        position: FloatArray,
        outside: Outside = Outside.ERROR,
        tool: FloatArray | None = None,
        sense: FloatArray | None = None,
    ) -> FloatArray:
        """Return E (n, 3) in mm at the positions (n, 3) in mm: see `ErrorModel.error`."""
        total = np.zeros((3, len(position)))
        # Unknown coordinates are nan, and a cast of nan to a cell warns.
        with np.errstate(invalid="ignore"):
            for k, table in enumerate(self.axes):
                if table is None:
                    continue
                column = position[:, k]
                if outside is Outside.CLAMP:
                    column = np.clip(column, *self.range_of(k))
                found = np.zeros((2, len(column)))
                table.halves.add_columns(found, column, (0, 1))
                total[k] = found[0] if sense is None else found[0] + sense[:, k] * found[1]
        if outside is Outside.ZERO:
            total[:, self.outside(position).any(axis=1)] = 0.0
        return total.T

    @property
    def backlash(self) -> BoolArray:
        """The axes (3,) whose error depends on the direction of travel."""
        return np.array([table is not None and table.backlash for table in self.axes])

    @property
    def nodes(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """The positions of X, Y and Z in mm; empty for an axis without a table."""
        x, y, z = (np.empty(0) if t is None else t.position for t in self.axes)
        return x, y, z

    def range_of(self, axis_index: int) -> tuple[float, float]:
        """Return the first and last position of an axis in mm; infinite for an absent axis."""
        table = self.axes[axis_index]
        if table is None:
            return -math.inf, math.inf
        return float(table.position[0]), float(table.position[-1])

    def lipschitz(self, reach: float = 0.0) -> float:
        """Return the steepest cell of either direction: each axis acts on itself alone."""
        with np.errstate(all="ignore"):
            slopes = [
                float(np.abs(np.diff(values) / np.diff(table.position)).max())
                for table in self.axes
                if table is not None
                for values in (table.forward, table.reverse)
            ]
        return max(slopes, default=0.0) if all(map(math.isfinite, slopes)) else math.inf

    def largest(self, reach: float = 0.0) -> float:
        """Return the largest |E| in mm: each axis at its worst position and direction."""
        worst = [
            float(np.abs([table.forward, table.reverse]).max())
            for table in self.axes
            if table is not None
        ]
        return math.hypot(*worst)
