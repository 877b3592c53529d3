"""The options of `volumetric`, and what follows from them alone: promise, error, and its nodes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

import gcxform as gx
from gcxform.vocabulary import Floats

ARC_TOLERANCE = 0.001  # mm, where no tolerance is given: an arc cannot be exact


@dataclass(frozen=True)
class VolumetricOptions:
    """What a user says of the errors and of the path; forward and undo know no more of the pass."""

    model: Annotated[gx.ModelFile, gx.Option("error model: TOML, or a format of a plugin")]
    outside: Annotated[gx.Outside, gx.Option("what the error is beyond the table")] = (
        gx.Outside.ERROR
    )
    tolerance: Annotated[
        gx.Length | None,
        gx.Option(
            "residual allowed between cuts; absent: lines are exact, arcs within 1 um", above=0.0
        ),
    ] = None
    lean: Annotated[
        gx.Length,
        gx.Option("how far the ground of a hole may be off that is called as it stands", above=0.0),
    ] = 0.01
    max_correction: Annotated[
        gx.Length, gx.Option("a larger correction is an error", above=0.0)
    ] = 0.2
    split: Annotated[Literal["adaptive", "nodes", "none"], gx.Option("where moves are cut")] = (
        "adaptive"
    )
    rapids: Annotated[
        Literal["ends", "skip"], gx.Option("rapids: compensate their ends, or leave them")
    ] = "ends"
    iterations: Annotated[
        int, gx.Option("steps of the inverse; 0: until it has converged", at_least=0, at_most=20)
    ] = 0
    arc_centres: Annotated[
        Literal["refit", "nominal"], gx.Option("nominal: I, J stay as they were")
    ] = "refit"
    table_origin: Annotated[gx.Vector, gx.Option("origin of the measurement")] = (0.0, 0.0, 0.0)
    part_origin: Annotated[gx.Vector | None, gx.Option("origin of the program")] = None
    max_extrapolation: Annotated[
        float, gx.Option("cells by which the table may be extrapolated", above=0.0)
    ] = 1.0
    min_length: Annotated[
        gx.Length,
        gx.Option(
            "shorter pieces are not cut; refused where the tolerance (1 um if absent) needs them",
            at_least=0.0,
        ),
    ] = 0.0
    time: Annotated[
        str | None, gx.Option("time (ISO 8601) whose temperatures hold; absent: as the model says")
    ] = None
    backlash: Annotated[
        Literal["refuse", "mean"],
        gx.Option("of a model with backlash: refuse it, or take the mean of both directions"),
    ] = "refuse"
    tips: Annotated[
        Literal["standing", "turning"],
        gx.Option(
            "behind G43.4, which follows the tip, axes stand still; or they may turn: then no move "
            "to a place of the machine is taken while they are turned"
        ),
    ] = "standing"
    inverse: Annotated[
        bool, gx.Option("the program holds commands: write where the machine goes with them")
    ] = False

    @property
    def promise(self) -> float:
        """The tolerance; nothing where moves are not cut, or rapids not compensated."""
        if self.split == "none" or self.rapids == "skip" or self.arc_centres == "nominal":
            return float("inf")
        return self.limit

    @property
    def limit(self) -> float:
        """The residual (mm) that arcs are held to."""
        return ARC_TOLERANCE if self.tolerance is None else self.tolerance

    @property
    def cells(self) -> float:
        """By how many cells beyond the tables bounds of the error have to hold.

        One is for commands, which may be a little beyond where their targets are not.
        """
        return 1.0 + self.max_extrapolation * (self.outside is gx.Outside.EXTRAPOLATE)

    def nodes(self) -> tuple[Floats, Floats, Floats]:
        """Return the planes on which the error bends, under the policy for outside."""
        bends = self.outside in (gx.Outside.CLAMP, gx.Outside.ZERO)
        x, y, z = (n if bends else n[1:-1] for n in self.model.model.nodes)
        return x, y, z

    def error(self, position: Floats, tool: Floats | None = None) -> Floats:
        """Return the error (n, 3) at positions in the table (n, 3), mm, for tools."""
        return self.model.model.error(position, self.outside, tool)
