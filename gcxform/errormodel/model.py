"""Error models: the volumetric error of a machine as a function of the commanded position.

An error is *actual minus nominal position of the tool relative to the workpiece* (ISO 230-1), in
mm, as a function of the machine coordinates in mm. Here is what all models have in common, and the
inverse; the models are in the files beside this one.

The command c for a target p solves c + E(c) = p, by fixed-point steps until they move by less than
1e-9 mm. Models that change by 0.1 mm per mm and more are refused: they have wrong units.
"""

from __future__ import annotations

import enum
import math
from abc import ABC, abstractmethod
from typing import ClassVar, NamedTuple

import numpy as np

from gcxform.diagnostics import InputError, Location, UsageError
from gcxform.system.arrays import Flags, Floats
from gcxform.values import dataclass

AXES = "XYZ"
BORDER = 1e-9  # mm: so little outside the table still counts as inside
CONVERGED = 1e-9  # mm: the inverse stops when no coordinate moves by more
STEPS_AT_MOST = 20
BLOCK = 8192  # points: larger scratch arrays are given back to the system, which halves the speed
CONTRACTION_LIMIT = 0.1  # mm/mm: a machine tool has about 1e-4, wrong units have 1 and more


class Outside(enum.StrEnum):
    """What the error is where the table does not reach."""

    ERROR = "error"
    CLAMP = "clamp"
    EXTRAPOLATE = "extrapolate"
    ZERO = "zero"


@dataclass(frozen=True)
class State:
    """The temperatures of an axis at a time, and what they do to it.

    axis          letter
    time          ISO 8601, when the sensors were read
    sensors       names, along the axis
    temperatures  degC
    travel        mm
    largest       mm, largest error along the travel
    drift         mm per K: how much the error between the ends grows if all gets warmer by 1 K
    """

    axis: str
    time: str
    sensors: tuple[str, ...]
    temperatures: tuple[float, ...]
    travel: tuple[float, float]
    largest: float
    drift: float


class ErrorModel(ABC):
    """A volumetric error field E(c) over machine coordinates c, both in mm."""

    kind: ClassVar[str]
    composed: ClassVar[bool] = False
    """Whether the model comes from more files than the one that is named."""

    @abstractmethod
    def error(
        self,
        position: Floats,
        outside: Outside = Outside.ERROR,
        tool: Floats | None = None,
        sense: Floats | None = None,
    ) -> Floats:
        """Return E (n, 3) in mm, a new column-major array, at the positions (n, 3) in mm.

        `tool` (3,) or (n, 3) mm is the way from the gauge point to the tool's tip; None is that of
        the measurement. `sense` (n, 3) is in which direction each axis moved last, -1 or +1, or 0
        for the mean of both; None stands for 0. Models without angular errors ignore the tool, and
        all but those with backlash ignore the sense.

        `Outside.ERROR` extrapolates as `EXTRAPOLATE` does and raises nothing, because a check of
        every point would cost as much as the evaluation: callers ask `outside` first.
        `Outside.ZERO` makes the whole error zero where any one coordinate is outside.
        A coordinate which is nan makes the error nan if the field depends on it.
        """

    def _repr_html_(self) -> str:
        """Return what a notebook shows: ranges, and the volume with its error, magnified."""
        from gcxform.errormodel.drawn import cell

        return cell(self)

    @property
    @abstractmethod
    def nodes(self) -> tuple[Floats, Floats, Floats]:
        """The positions on X, Y and Z in mm where the field bends; empty for an axis without."""

    @abstractmethod
    def lipschitz(self, reach: float = 0.0) -> float:
        """Return a bound of the spectral norm of dE/dc (mm/mm), one extrapolated cell included.

        `reach` (mm) is how far the tip may be from where it was at the measurement. The bound holds
        for every policy but `ZERO`, which makes the field jump at the border.
        """

    def curvature(self, reach: float = 0.0) -> Floats:
        """Return bounds (3, 3) of |d2E/dci dcj| (mm/mm2) between nodes; zero: linear there.

        On a straight way w (mm) between two nodes the field is off its chord by at most
        |w| B |w| / 8, where B is what this returns and |w| the moduli of the components.
        """
        return np.zeros((3, 3))

    @abstractmethod
    def largest(self, reach: float = 0.0) -> float:
        """Return an upper bound of |E| in mm inside the table."""

    def turning(self, cells: float = 1.0) -> tuple[float, float]:
        """Return bounds of the angular error |R| (rad) and of its slope |dR/dc| (rad/mm).

        R x t is what a way t (mm) from the gauge point to the tip adds to the error. The bounds
        hold for a number of `cells` beyond the table; they are 0 where no tool is needed.
        """
        if self.needs_tool:
            raise NotImplementedError(f"{type(self).__name__} has no bounds of its turns")
        return 0.0, 0.0

    @property
    def tool(self) -> Floats | None:
        """The way (3,) in mm from the gauge point to where the errors were measured.

        None where the model does not depend on the tool, or does not know.
        """
        return None

    @property
    def needs_tool(self) -> bool:
        """Whether the error at the tip depends on the tool."""
        return False

    @property
    def backlash(self) -> Flags:
        """The axes (3,) whose error depends on the direction of travel."""
        return np.zeros(3, np.bool_)

    @property
    def states(self) -> tuple[State, ...]:
        """The states of the machine that the model holds for; none if it always holds."""
        return ()

    def at_time(self, time: str) -> ErrorModel:
        """Return the model in its state at a time (ISO 8601). Raises UsageError."""
        return self

    @abstractmethod
    def range_of(self, axis_index: int) -> tuple[float, float]:
        """Return the lowest and highest position in mm of axis 0, 1 or 2; infinite if unbounded."""

    def extended(self, axis_index: int, cells: float) -> tuple[float, float]:
        """Return the range of an axis in mm, wider by a number of its first and last cells."""
        low, high = self.range_of(axis_index)
        nodes = self.nodes[axis_index]
        if len(nodes) < 2 or not cells:
            return low, high
        return low - cells * float(nodes[1] - nodes[0]), high + cells * float(nodes[-1] - nodes[-2])

    def outside(self, position: Floats) -> Flags:
        """Return (n, 3): which coordinates (mm) lie beyond the table by more than `BORDER`.

        An unknown coordinate (nan) is not outside.
        """
        beyond = np.empty((3, len(position)), dtype=np.bool_)
        for k in range(3):
            low, high = self.range_of(k)
            column = position[:, k]
            np.less(column, low - BORDER, out=beyond[k])
            beyond[k] |= column > high + BORDER
        return beyond.T


@dataclass(frozen=True, eq=False)
class Command:
    """The `position` (n, 3) in mm to command, column-major, and the `steps` it took to find it."""

    position: Floats
    steps: int


def compensate(
    model: ErrorModel,
    target: Floats,
    outside: Outside = Outside.ERROR,
    iterations: int = 0,
    tool: Floats | None = None,
    sense: Floats | None = None,
) -> Command:
    """Return the command c (n, 3) in mm which puts the tool on the target p: c + E(c) = p.

    Fixed point c_0 = p, c_(k+1) = p - E(c_k); with L < 1 the Lipschitz constant, step k is within
    L^k |E| / (1 - L) of the solution (Banach). `iterations` steps are done; 0 stands for as many
    as needed until the command is within `CONVERGED` of the solution: by Banach's bound it is no
    farther than L / (1 - L) times the last step. Unknown targets (nan) stay unknown.
    """
    contraction = model.lipschitz(reach_of(model, tool)) if outside is not Outside.ZERO else 1.0
    command = np.empty((3, len(target))).T
    steps = 0
    for first in range(0, len(target), BLOCK):
        piece = slice(first, first + BLOCK)
        here = _Pieces(model, outside, part_of(tool, piece), part_of(sense, piece))
        command[piece], taken = _solve(here, target[piece], contraction, iterations)
        steps = max(steps, taken)
    return Command(command, steps)


def reach_of(model: ErrorModel, tool: Floats | None) -> float:
    """Return how far (mm) tips (3,) or (n, 3) are at most from where they were measured."""
    if tool is None or not model.needs_tool:
        return 0.0
    away = np.atleast_2d(tool - (np.zeros(3) if model.tool is None else model.tool))
    return float(np.sqrt((away**2).sum(axis=1)).max(initial=0.0))


def part_of(column: Floats | None, piece: slice) -> Floats | None:
    """Return some rows of tools or senses; one for all, or none, stays as it is."""
    return column if column is None or column.ndim == 1 else column[piece]


class _Pieces(NamedTuple):
    """The error at some of the targets."""

    model: ErrorModel
    outside: Outside
    tool: Floats | None
    sense: Floats | None

    def error(self, position: Floats) -> Floats:
        return self.model.error(position, self.outside, self.tool, self.sense)


def _solve(
    here: _Pieces, target: Floats, contraction: float, iterations: int
) -> tuple[Floats, int]:
    """Return the command (n, 3) of one block of targets, and its number of steps."""
    command = target
    known = contraction < 0.5
    shrinks = math.sqrt(3.0) * contraction / (1.0 - contraction) if known else 1.0
    for step in range(1, (iterations or STEPS_AT_MOST) + 1):
        previous, command = command, here.error(command)
        np.subtract(target, command, out=command)
        if not iterations and _farthest(command, previous) * shrinks < CONVERGED:
            return command, step
    if iterations:
        return command, iterations
    moved = np.nan_to_num(np.abs(command - previous)).max(axis=1)
    x, y, z = target[int(moved.argmax())]
    raise InputError.one(
        "GX309",
        f"the compensated position for ({x:.6g}, {y:.6g}, {z:.6g}) still moves by "
        f"{moved.max():.3g} mm after {STEPS_AT_MOST} steps",
        hint="the error jumps there, as one that is zero outside does at the border of its table",
    )


def _farthest(one: Floats, other: Floats) -> float:
    """Return the largest difference of two arrays, unknown values left out."""
    moved = one - other
    np.abs(moved, out=moved)
    return float(np.fmax.reduce(moved, axis=None, initial=0.0))


def check_contraction(model: ErrorModel, where: Location | None = None) -> None:
    """Raise UsageError if the error changes so fast that the inverse is in doubt."""
    if not model.lipschitz() < CONTRACTION_LIMIT:
        raise UsageError.one(
            "GX415",
            f"the error changes by up to {model.lipschitz():.3g} mm per mm of travel, "
            f"plausible is less than {CONTRACTION_LIMIT}",
            where,
            "values and positions are in mm, squareness in rad: look for values in um",
        )
