"""Pitch tables: the positioning error of each axis, in both directions of travel.

Where the two differ the axis has backlash. Controls and laser interferometers know no more of a
machine than this (ISO 230-2).
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import ClassVar

import numpy as np

from gcxform.diagnostics import Diagnostic, UsageError
from gcxform.errormodel.functions import AxisFunction, faults
from gcxform.errormodel.tabled import AxisTables
from gcxform.system.arrays import Flags, Floats
from gcxform.values import dataclass


@dataclass(frozen=True, eq=False)
class PitchTable:
    """The error (n,) in mm of one axis along itself, at `position` (n,) in mm.

    `forward` is the error after travel in the positive direction, `reverse` after the negative.
    """

    position: Floats
    forward: Floats
    reverse: Floats

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
class PitchTables(AxisTables[PitchTable]):
    """The positioning errors of X, Y and Z; an axis which is None has no error and no limits."""

    kind: ClassVar[str] = "pitch"

    def add(self, total: Floats, place: Floats, tool: Floats | None, sense: Floats | None) -> None:
        """Add the errors (3, n) at places (n, 3): see `Tabled.add`."""
        for k, table in enumerate(self.axes):
            if table is not None:
                found = np.zeros((2, len(place)))
                table.halves.add_columns(found, place[:, k], (0, 1))
                total[k] += found[0] if sense is None else found[0] + sense[..., k] * found[1]

    @property
    def backlash(self) -> Flags:
        """The axes (3,) whose error depends on the direction of travel."""
        return np.array([table is not None and table.backlash for table in self.axes])

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
