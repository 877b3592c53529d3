"""Sums of error models: geometry, and what temperature and weight add to it."""

from __future__ import annotations

from functools import reduce
from typing import Annotated, ClassVar, Literal

import msgspec
import numpy as np

from gcxform.config.keys import says
from gcxform.config.toml_text import TomlText
from gcxform.diagnostics import UsageError
from gcxform.errormodel.model import ErrorModel, Outside, State
from gcxform.system.arrays import Flags, Floats
from gcxform.values import dataclass


@dataclass(frozen=True, eq=False)
class Sum(ErrorModel):
    """The sum of models, each at the same commanded position.

    The sum is inside where all of them are. Models that depend on the tool were measured with the
    same one: see `modelfile`.
    """

    models: tuple[ErrorModel, ...]
    kind: ClassVar[str] = "sum"
    composed: ClassVar[bool] = True

    def error(
        self,
        position: Floats,
        outside: Outside = Outside.ERROR,
        tool: Floats | None = None,
        sense: Floats | None = None,
    ) -> Floats:
        """Return E (n, 3) in mm at the positions (n, 3) in mm: see `ErrorModel.error`."""
        total = np.zeros((3, len(position))).T
        for model in self.models:
            total += model.error(position, outside, tool, sense)
        if outside is Outside.ZERO:
            total[self.outside(position).any(axis=1)] = 0.0
        return total

    @property
    def tool(self) -> Floats | None:
        """The tool (3,) in mm of those that need it."""
        known = [model.tool for model in self.models if model.needs_tool]
        return known[0] if known else None

    @property
    def needs_tool(self) -> bool:
        """Whether one of the models depends on the tool."""
        return any(model.needs_tool for model in self.models)

    @property
    def backlash(self) -> Flags:
        """The axes (3,) with an error that depends on the direction of travel in a model."""
        return np.asarray(np.any([model.backlash for model in self.models], axis=0))

    @property
    def states(self) -> tuple[State, ...]:
        """The states of all models."""
        return tuple(state for model in self.models for state in model.states)

    def at_time(self, time: str) -> Sum:
        """Return the sum of the models at a time."""
        return Sum(tuple(model.at_time(time) for model in self.models))

    @property
    def nodes(self) -> tuple[Floats, Floats, Floats]:
        """The nodes of all models."""
        x, y, z = (
            reduce(np.union1d, (model.nodes[axis] for model in self.models)) for axis in range(3)
        )
        return x, y, z

    def lipschitz(self, reach: float = 0.0) -> float:
        """Return the sum of the bounds."""
        return sum(model.lipschitz(reach) for model in self.models)

    def curvature(self, reach: float = 0.0) -> Floats:
        """Return the sum of the bounds."""
        return np.asarray(np.sum([model.curvature(reach) for model in self.models], axis=0))

    def turning(self, cells: float = 1.0) -> tuple[float, float]:
        """Return the sums of the bounds."""
        angle, slope = np.sum([model.turning(cells) for model in self.models], axis=0).tolist()
        return angle, slope

    def largest(self, reach: float = 0.0) -> float:
        """Return the sum of the bounds."""
        return sum(model.largest(reach) for model in self.models)

    def range_of(self, axis_index: int) -> tuple[float, float]:
        """Return what all models have in common."""
        ranges = [model.range_of(axis_index) for model in self.models]
        return max(low for low, _ in ranges), min(high for _, high in ranges)

    def extended(self, axis_index: int, cells: float) -> tuple[float, float]:
        """Return what all models have in common, each wider by cells of its own."""
        ranges = [model.extended(axis_index, cells) for model in self.models]
        return max(low for low, _ in ranges), min(high for _, high in ranges)


class SumFile(msgspec.Struct, forbid_unknown_fields=True, kw_only=True):
    """An error model of the kind `sum`: the files of models that are added."""

    format: Annotated[int, says("the form of this file; now 1")]
    kind: Annotated[Literal["sum"], says("the kind of the model")]
    models: Annotated[list[str], says("the model files that are added")]


def checked_sum(document: TomlText, models: list[ErrorModel]) -> Sum:
    """Return the sum of the models of a file. Raises UsageError if they do not go together."""
    if not models:
        raise UsageError.one("GX422", "the sum has no models", document.where("models"))
    found = Sum(tuple(models))
    for k, model in enumerate(models):
        if model.needs_tool and np.any(model.tool != found.tool):
            message = "the models were measured at different points of the tool"
            hint = "tool = [x, y, z] has to be the same in all files with angular errors"
            raise UsageError.one("GX424", message, document.where("models", k), hint)
    for axis, name in enumerate("XYZ"):
        low, high = found.range_of(axis)
        if not low < high:
            message = f"the tables of {name} have no travel in common"
            raise UsageError.one("GX424", message, document.where("models"))
    return found
