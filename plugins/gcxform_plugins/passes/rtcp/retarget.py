"""`retarget`: a program in axes of one machine becomes one in axes of another kind of machine."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

import gcxform as gx
from gcxform_plugins.passes.rtcp.conversion import (
    PLAIN,
    AxisTolerance,
    Conversion,
    Rapids,
    check_angles,
)
from gcxform_plugins.passes.rtcp.forward.moving import Moving
from gcxform_plugins.passes.rtcp.measured import AXIS_OFF, TIP_OFF
from gcxform_plugins.passes.rtcp.options import Options, Retraction
from gcxform_plugins.passes.rtcp.place import Place
from gcxform_plugins.passes.rtcp.proof.driven import Driven
from gcxform_plugins.passes.rtcp.proof.retracted import Retracted
from gcxform_plugins.passes.rtcp.user_lines import UserLines


@dataclass(frozen=True)
class Retarget(Conversion):
    """Turn positions of axes into those of another machine, with the same tips and tool axes.

    [machine] is the machine that the program was posted for. Attitudes and turns of the target are
    chosen for each cut as a whole, within its limits. Both work offsets are taken on the table with
    all rotary axes at 0.
    """

    name = "retarget"
    requires = (PLAIN | {gx.AXIS_POSITIONS}) - {gx.LINEAR_ONLY}
    clears = frozenset({gx.AXIS_POSITIONS})  # its axes are those of another machine than [machine]

    target: Annotated[
        gx.KinematicsFile,
        gx.Option("the machine to write for; [machine] is the one posted for"),
    ]
    rapids: Rapids = "refuse"
    retract: Annotated[
        gx.Length | None,
        gx.Option(
            "where axes have to flip or unwind in a cut, draw the tool back along its axis by so "
            "much and turn them there; absent: an error",
            above=0.1,
        ),
    ] = None
    retract_feed: Annotated[
        float | None,
        gx.Option("feed of that: mm/min of the tip, degrees/min while axes turn", above=0.0),
    ] = None
    retract_lines: Annotated[
        gx.Lines | None,
        gx.Option(
            'retract: written once the tool is drawn back, before axes turn: ["M9", "G53 G0 Z0."]'
        ),
    ] = None
    return_lines: Annotated[
        gx.Lines | None,
        gx.Option("retract: written once axes have turned, before the tool comes back"),
    ] = None
    axis_tolerance: AxisTolerance = 0.1

    def __post_init__(self) -> None:
        """Refuse options that do not go together. Raises ValueError."""
        if (self.retract is None) != (self.retract_feed is None):
            raise ValueError("retract and retract-feed go together")
        if self.retract is None and (self.retract_lines or self.return_lines):
            raise ValueError("retract-lines and return-lines go with retract")
        if self.rapids == "refuse":
            raise ValueError('axes turn in rapids: say rapids = "ends" if all is clear')

    @property
    def demands(self) -> gx.Demands:
        """A path of its own, in whole cuts, for the axes of the target."""
        return gx.Demands(
            resolves=True,
            whole_cuts=True,
            letters="".join(gx.chain_of(self.target.machine).letters),
            written_for=self.target,
            promise_angle=self.axis_tolerance,
            deviates={"deviation": TIP_OFF, "angle": AXIS_OFF},
        )

    def options(self, context: gx.PassContext) -> Options:
        """Return what the work and its proof know of the options."""
        return Options(
            self.tolerance,
            self.axis_tolerance,
            rapids_turn=True,
            target=self.target.machine,
            retraction=self._retraction(context),
        )

    def _retraction(self, context: gx.PassContext) -> Retraction | None:
        if self.retract is None or self.retract_feed is None or context.machine is None:
            return None
        inert = context.machine.inert_m & self.target.machine.inert_m
        lines = UserLines.of(self.retract_lines, self.return_lines, context.target, inert)
        return Retraction(self.retract, self.retract_feed, lines)

    def places(self, path: gx.Toolpath, context: gx.PassContext) -> tuple[Place, Place]:
        """Return the places of both machines, each with the work offset of its own file."""
        there = replace(context, machine=self.target.machine)
        source = Place(path, context, others=self.demands.letters)
        return source, Place(path, there, others="".join(source.chain.letters))

    def begin(self, context: gx.PassContext) -> None:
        """Refuse a target whose angles are not found, and one with other tools."""
        super().begin(context)
        check_angles(self.target.machine, wraps=False)
        tools = context.machine.tools if context.machine is not None else {}
        for number, tool in self.target.machine.tools.items():
            if tools.get(number, tool) != tool:
                message = f"tool {number} is another one in the file of the target"
                hint = "give both machine files the tools that the program is for"
                raise gx.UsageError.one("GX744", message, hint=hint)

    def apply(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        """Return the path of the axes of the target."""
        if not len(path):
            return path
        return Moving(self.options(context), path, context, *self.places(path, context)).run()[0]

    def prove(self, before: gx.Toolpath, after: gx.Toolpath, context: gx.PassContext) -> None:
        """Check tips, tool axes and feeds."""
        if len(before):
            self.proof(before, after, context).check(self.axis_tolerance, np.inf)

    def measure(
        self, before: gx.Toolpath, after: gx.Toolpath, context: gx.PassContext
    ) -> dict[str, float]:
        """Return how far tips and tool axes stay off."""
        return self.proved(before, after, context) if len(after) else {}

    def added(
        self, before: gx.Toolpath, after: gx.Toolpath, context: gx.PassContext
    ) -> dict[str, int]:
        """Return how often the tool is drawn back, and in how many moves, as the proof has it."""
        if self.retract is None or not len(after):
            return {}
        _, target = self.places(after, context)
        drawn = Retracted(self.options(context), Driven(after, target))
        found = {"retracts": len(drawn.found), "moves of retracts": drawn.moves}
        return found | ({"lines of retracts": len(drawn.given)} if drawn.given else {})
