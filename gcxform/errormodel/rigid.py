"""The rigid-body model: three linear axes, each with three displacements and three turns.

With 18 functions and three squarenesses folded into them this is the model of 21 parameters of
ISO 230-1. To first order, with the axes in their order from the workpiece to the tool,

    E(q) = sum over axes i of  d_i(q_i) + e_i(q_i) x lever_i
    lever_i = (tool - tool of the measurement) + sum over axes j after i of (q_j - at_i[j]) u_j

where d_i, e_i are the displacements and turns of the tool relative to the workpiece, measured along
the line on which the axes after i stand at `at_i`. What moves the workpiece and what moves the tool
makes no difference to functions that are relative (J. A. Soons et al., Precision Engineering 14
(1992) 5).
"""

from __future__ import annotations

import itertools
import math
from dataclasses import field
from functools import cached_property
from typing import ClassVar

import numpy as np

from gcxform.errormodel.functions import AxisFunction
from gcxform.errormodel.model import AXES
from gcxform.errormodel.tabled import AxisTables
from gcxform.system.arrays import Floats
from gcxform.values import dataclass

Triple = tuple[float, float, float]
NOWHERE: Triple = (0.0, 0.0, 0.0)


@dataclass(frozen=True, eq=False)
class RigidBody(AxisTables[AxisFunction]):
    """The rigid-body model of linear axes with angular errors.

    `axes` holds the functions of X, Y and Z, of six columns each; None is an axis without error
    and limits. `order` names the axes from the workpiece to the tool. `at` says for each axis where
    the others stood (mm) when it was measured, `measured` where the measured point was, from the
    gauge point. An axis after one with angular errors has functions, because its travel is a lever.
    """

    order: str = AXES
    at: tuple[Triple, Triple, Triple] = (NOWHERE, NOWHERE, NOWHERE)
    measured: Triple = NOWHERE
    kind: ClassVar[str] = "axis-functions"
    _turning: tuple[bool, bool, bool] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        turning = tuple(f is not None and bool(f.values[:, 3:].any()) for f in self.axes)
        object.__setattr__(self, "_turning", turning)

    @property
    def tool(self) -> Floats:
        """The way (3,) in mm from the gauge point to the measured point."""
        return np.array(self.measured)

    @property
    def needs_tool(self) -> bool:
        """Whether there are angular errors."""
        return any(self._turning)

    def after(self, axis: int) -> list[int]:
        """Return the axes which are nearer to the tool than an axis."""
        return [AXES.index(letter) for letter in self.order[self.order.index(AXES[axis]) + 1 :]]

    def add(self, total: Floats, place: Floats, tool: Floats | None, sense: Floats | None) -> None:
        """Add the errors (3, n) at places (n, 3): see `Tabled.add`."""
        away = None if tool is None else np.broadcast_to(tool - self.tool, place.shape)
        for k, function in enumerate(self.axes):
            if function is None or function.trivial:
                continue
            levers = self._levers(k, place, away) if self._turning[k] else {}
            needed = [3 + d for d in range(3) if set(levers) - {d}]
            found = np.zeros((3 + len(needed), len(place)))
            function.add_columns(found, place[:, k], [0, 1, 2, *needed])
            total += found[:3]
            turn = dict(zip(needed, found[3:], strict=True))
            for d, lever in levers.items():
                # e x lever: the component d of the lever meets the two other turns
                after, before = (d + 1) % 3, (d + 2) % 3
                total[after] += turn[3 + before] * lever
                total[before] -= turn[3 + after] * lever

    def _levers(self, axis: int, place: Floats, away: Floats | None) -> dict[int, Floats]:
        """Return the components (n,) in mm of the lever of an axis which are not zero."""
        levers = {j: place[:, j] - self.at[axis][j] for j in self.after(axis)}
        if away is not None:
            for d in range(3):
                if away[:, d].any():
                    levers[d] = levers[d] + away[:, d] if d in levers else away[:, d]
        return levers

    # --- bounds ---

    def lipschitz(self, reach: float = 0.0) -> float:
        """Return a bound of the spectral norm of dE/dc: see `ErrorModel.lipschitz`.

        The column of an axis is its own slope with the longest lever, and what the turns of the
        axes before it make of its travel; the norm of a matrix is at most that of its columns.
        """
        with np.errstate(over="ignore", invalid="ignore"):
            columns = self._slopes + reach * self._turns
        return float(np.sqrt((columns**2).sum())) if np.isfinite(columns).all() else math.inf

    def largest(self, reach: float = 0.0) -> float:
        """Return a bound of |E| in mm inside the table: the sum of the largest of each axis."""
        found = 0.0
        for k, function in enumerate(self.axes):
            if function is not None:
                angle = np.sqrt((function.values[:, 3:] ** 2).sum(axis=1)).max()
                found += self._longest(k, function.values, 0.0) + reach * float(angle)
        return found

    def curvature(self, reach: float = 0.0) -> Floats:
        """Return bounds (3, 3) of |d2E/dci dcj| (mm/mm2): e_i' x u_j, j after i, and no other."""
        found = np.zeros((3, 3))
        for k, function in enumerate(self.axes):
            for j in self.after(k) if function is not None and self._turning[k] else []:
                assert function is not None
                others = [3 + d for d in range(3) if d != j]
                slope = function.slope[:, others]
                found[k, j] = found[j, k] = float(np.sqrt((slope**2).sum(axis=1)).max())
        return found

    def turning(self, cells: float = 1.0) -> tuple[float, float]:
        """Return bounds of the turns of all axes together: see `ErrorModel.turning`."""
        angle = 0.0
        for function in self.axes:
            if function is not None:
                turn = _extended(function, cells)[:, 3:]
                angle += float(np.sqrt((turn**2).sum(axis=1)).max())
        return angle, float(np.sqrt((self._turns**2).sum()))

    @cached_property
    def _slopes(self) -> Floats:
        """Bounds (3,) of the columns of dE/dc with the tool of the measurement."""
        found = np.zeros(3)
        for k, function in enumerate(self.axes):
            if function is None:
                continue
            with np.errstate(over="ignore", invalid="ignore"):
                found[k] += self._longest(k, function.slope, 1.0)
                for j in self.after(k) if self._turning[k] else []:
                    others = [3 + d for d in range(3) if d != j]
                    turn = _extended(function)[:, others]
                    found[j] += float(np.sqrt((turn**2).sum(axis=1)).max())
        return found

    @cached_property
    def _turns(self) -> Floats:
        """The largest slopes (3,) in rad/mm of the turns of each axis."""
        with np.errstate(over="ignore"):
            return np.array(
                [
                    0.0 if f is None else float(np.sqrt((f.slope[:, 3:] ** 2).sum(axis=1)).max())
                    for f in self.axes
                ]
            )

    def _longest(self, axis: int, rows: Floats, cells: float) -> float:
        """Return the largest |d + e x lever| of rows (n, 6), over all levers of an axis.

        It is convex in the lever, so the corners of the box of levers are enough. The box reaches a
        number of cells beyond the tables.
        """
        sides = [
            _reached(self.axes[j], cells) - self.at[axis][j] if j in self.after(axis) else [0.0]
            for j in range(3)
        ]
        if not rows[:, 3:].any():
            sides = [[0.0]] * 3
        found = 0.0
        for corner in itertools.product(*sides):
            moved = rows[:, :3] + np.cross(rows[:, 3:], corner)
            size = float(np.sqrt((moved**2).sum(axis=1)).max())
            found = max(found, math.inf if math.isnan(size) else size)
        return found


def _reached(function: AxisFunction | None, cells: float) -> Floats:
    """Return the lowest and highest position of an axis, a number of cells beyond its table."""
    if function is None:
        return np.array([-math.inf, math.inf])
    nodes = function.position
    first, last = nodes[1] - nodes[0], nodes[-1] - nodes[-2]
    return np.array([nodes[0] - cells * first, nodes[-1] + cells * last])


def _extended(function: AxisFunction, cells: float = 1.0) -> Floats:
    """Return the values at the nodes and a number of cells beyond them."""
    values = function.values
    before = values[0] + cells * (values[0] - values[1])
    return np.vstack([before, values, values[-1] + cells * (values[-1] - values[-2])])
