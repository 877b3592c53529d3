"""`rtcp`: from where the tip shall be to where the axes stand, for controls that do not do it.

A control that follows the tool tip (RTCP, TCP) takes X, Y and Z for the tip on the workpiece; any
other takes them for its axes, and between two blocks it moves all axes in proportion. Then the tip
leaves its line, by as much as the axes turn. Here lines are cut until the bound of that is within
the tolerance, and of each piece the angles are rounded first and X, Y, Z computed from them.

At the same angles the tip is as far from its line as the axes are from theirs, because tip and axes
are apart by a rotation and an arm that the angles alone fix. So one bound serves both directions.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated, Literal

import numpy as np

import gcxform as gx
from gcxform_plugins.passes.rtcp_cutting import Cutting
from gcxform_plugins.passes.rtcp_place import Place
from gcxform_plugins.passes.rtcp_undoing import Undoing

PLAIN = frozenset({gx.ABSOLUTE, gx.LINEAR_ONLY, gx.NOMINAL})


@dataclass(frozen=True)
class Rtcp(gx.Pass):
    """Turn positions of the tool tip into those of the machine's axes, or the reverse.

    The machine file says where the rotary axes are, and the work offset and the tool lengths that
    hold. The work offset is taken on the table with all rotary axes at 0. Axes turn in proportion
    to the way of the tip. Feeds per minute are those of the tip, or in degrees where it rests; they
    become inverse times.
    """

    name = "rtcp"
    requires = PLAIN | {gx.TIP_POSITIONS}
    ensures = frozenset({gx.AXIS_POSITIONS})
    clears = frozenset({gx.TIP_POSITIONS})

    tolerance: Annotated[gx.Length, gx.Option("how far the tip may leave its line", above=0.0)]
    direction: Annotated[
        Literal["to-machine", "to-tip"],
        gx.Option("to-machine: of tips, write axes; to-tip: of axes, write tips"),
    ] = "to-machine"
    rapids: Annotated[
        Literal["refuse", "ends"],
        gx.Option("rapids that turn axes: refuse them, or convert where they end"),
    ] = "refuse"

    def __post_init__(self) -> None:
        """Turn the facts round for the reverse."""
        if self.direction == "to-tip":
            object.__setattr__(self, "requires", PLAIN | self.ensures)
            object.__setattr__(self, "ensures", self.clears)
            object.__setattr__(self, "clears", frozenset({gx.AXIS_POSITIONS}))

    @property
    def promise(self) -> float:
        """The tolerance."""
        return self.tolerance

    @property
    def feed_mode(self) -> gx.FeedMode | None:
        """Inverse time, in which the feed of the tip can be said whatever the axes do."""
        return gx.FeedMode.INVERSE_TIME if self.direction == "to-machine" else None

    def begin(self, context: gx.PassContext) -> None:
        """Refuse a run without a machine that turns."""
        machine = context.machine
        if machine is None or not machine.table + machine.head:
            message = "rtcp needs a machine with rotary axes"
            hint = "[machine] file = ..., with `kinematics`, or `table` and `head`"
            raise gx.UsageError.one("GX742", message, hint=hint)
        gx.chain_of(machine)

    def apply(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        """Return the path of the axes for one of tips; the reverse if asked."""
        if len(path):
            path = Cutting(self, path, context, Place(path, context)).run()
        return path.replace(blocks=self.timed(path.blocks))

    def timed(self, blocks: gx.Blocks) -> gx.Blocks:
        """Return blocks in inverse time, if positions of axes are written.

        What runs after a block that leaves the program finds the feed mode of the source.
        """
        if self.feed_mode is None:
            return blocks
        mode = np.where(blocks.leaves, blocks.feed_mode, np.int8(self.feed_mode))
        return replace(blocks, feed_mode=mode)

    def undo(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        """Return the path of the tip, in pieces, when the control moves all axes in proportion.

        For the reverse it is the path of the axes when the control follows the tip.
        """
        return Undoing(self, path, Place(path, context)).run() if len(path) else path
