"""The mean of both directions of travel: what a program can compensate of a model with backlash.

Backlash itself is refused: which way an axis moves is decided by the commands, whose small
corrections turn axes round that stand still in the program, and so the machine is not a function of
the position any more.
"""

from __future__ import annotations

from typing import ClassVar

from gcxform.errormodel.model import ErrorModel, Outside, State
from gcxform.system.arrays import Floats
from gcxform.values import dataclass


@dataclass(frozen=True, eq=False)
class Mean(ErrorModel):
    """A model without its backlash: the error between those of the two directions."""

    model: ErrorModel
    kind: ClassVar[str] = "mean"

    def error(
        self,
        position: Floats,
        outside: Outside = Outside.ERROR,
        tool: Floats | None = None,
        sense: Floats | None = None,
    ) -> Floats:
        """Return E (n, 3) in mm at the positions (n, 3) in mm: see `ErrorModel.error`."""
        return self.model.error(position, outside, tool)

    @property
    def states(self) -> tuple[State, ...]:
        """The thermal states of the model."""
        return self.model.states

    @property
    def tool(self) -> Floats | None:
        """The way (3,) in mm from the gauge point to where the errors were measured."""
        return self.model.tool

    @property
    def needs_tool(self) -> bool:
        """Whether the error at the tip depends on the tool."""
        return self.model.needs_tool

    @property
    def nodes(self) -> tuple[Floats, Floats, Floats]:
        """The nodes of the model."""
        return self.model.nodes

    def lipschitz(self, reach: float = 0.0) -> float:
        """Return the bound of the model, which holds in both directions and so between them."""
        return self.model.lipschitz(reach)

    def curvature(self, reach: float = 0.0) -> Floats:
        """Return the bounds of the model."""
        return self.model.curvature(reach)

    def turning(self, cells: float = 1.0) -> tuple[float, float]:
        """Return the bounds of the model."""
        return self.model.turning(cells)

    def largest(self, reach: float = 0.0) -> float:
        """Return the bound of the model."""
        return self.model.largest(reach)

    def range_of(self, axis_index: int) -> tuple[float, float]:
        """Return the range of the model."""
        return self.model.range_of(axis_index)

    def extended(self, axis_index: int, cells: float) -> tuple[float, float]:
        """Return the range of the model, wider by a number of cells."""
        return self.model.extended(axis_index, cells)
