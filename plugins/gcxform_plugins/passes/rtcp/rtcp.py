"""`rtcp`: from where the tip shall be to where the axes stand, for controls that do not do it.

A control that follows the tool tip (RTCP, TCP) takes X, Y and Z for the tip on the workpiece; any
other takes them for its axes, and between two blocks it moves all axes in proportion. Then the tip
leaves its line, by as much as the axes turn. Here lines are cut until the bound of that is within
the tolerance, and of each piece the angles are rounded first and X, Y, Z computed from them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated, Literal

import numpy as np

import gcxform as gx
from gcxform_plugins.passes.rtcp.conversion import (
    PLAIN,
    AxisTolerance,
    Conversion,
    Rapids,
    check_angles,
)
from gcxform_plugins.passes.rtcp.forward.cutting import Cutting
from gcxform_plugins.passes.rtcp.forward.great_circles import Circling
from gcxform_plugins.passes.rtcp.forward.moving import Moving
from gcxform_plugins.passes.rtcp.forward.vectors import InProportion, Pointing
from gcxform_plugins.passes.rtcp.forward.ways import Between
from gcxform_plugins.passes.rtcp.measured import AXIS_OFF, TIP_OFF, slowed
from gcxform_plugins.passes.rtcp.options import Options
from gcxform_plugins.passes.rtcp.place import Place
from gcxform_plugins.passes.rtcp.proof.driven import Driven, Led, Pointed
from gcxform_plugins.passes.rtcp.proof.proof import Proof
from gcxform_plugins.passes.rtcp.proof.undoing import Undoing
from gcxform_plugins.passes.rtcp.proof.vectors import PointedProof
from gcxform_plugins.passes.rtcp.switches import Switches
from gcxform_plugins.passes.rtcp.tool_vectors import without_left


@dataclass(frozen=True)
class Rtcp(Conversion):
    """Turn positions of the tool's tip into those of the axes, for a control that does not do it.

    The machine file says where the rotary axes are, and the work offset and the tool lengths that
    hold. The work offset is taken on the table with all rotary axes at 0. Axes turn in proportion
    to the way of the tip. Feeds per minute are those of the tip, or in degrees where it rests; they
    become inverse times.
    """

    name = "rtcp"
    requires = PLAIN | {gx.TIP_POSITIONS}
    ensures = frozenset({gx.AXIS_POSITIONS})
    clears = frozenset({gx.TIP_POSITIONS})

    tip_codes: Annotated[
        Literal["refuse", "read", "vectors"],
        gx.Option(
            "programs that let the control follow the tip (G43.4, G234, TRAORI, M128, "
            "FUNCTION TCPM, #RTCP ON, tip-on of the machine file): read them as what it is "
            "without, for a control that does not; vectors: those that say the tool axis by I, J, "
            "K (G43.5)"
        ),
    ] = "refuse"
    rapids: Rapids = "refuse"
    orientation_path: Annotated[
        Literal["angles", "great-circle"],
        gx.Option("between blocks angles change in proportion, or the tool axis does"),
    ] = "angles"
    axis_tolerance: AxisTolerance = 0.1

    def __post_init__(self) -> None:
        """Take any path if it is proved as a whole. Raises ValueError: vectors need rapids."""
        if self._reads_vectors and self.rapids == "refuse":
            raise ValueError('vectors turn axes in rapids: say rapids = "ends" if all is clear')
        if self._turns_anew:
            object.__setattr__(self, "requires", self.requires - {gx.LINEAR_ONLY})

    @property
    def _reads_vectors(self) -> bool:
        """Whether it makes angles of tool vectors."""
        return self.tip_codes == "vectors"

    @property
    def _turns_anew(self) -> bool:
        """Whether other angles are written than the program has, in proportion."""
        return self.orientation_path == "great-circle" or self._reads_vectors

    @property
    def demands(self) -> gx.Demands:
        """Inverse times, in which any feed of a tip can be said; a path of its own if turned anew.

        Otherwise tips are what the undo leads to, so that comparing paths compares them.
        """
        anew = self._turns_anew
        return gx.Demands(
            resolves=anew,
            reads_tip_codes=self.tip_codes == "read",
            reads_vectors=self._reads_vectors,
            promise_angle=self.axis_tolerance if anew else 0.0,
            feed_mode=gx.FeedMode.INVERSE_TIME,
            slows=True,
            deviates={"deviation": TIP_OFF, "angle": AXIS_OFF} if anew else {},
        )

    def options(self, context: gx.PassContext) -> Options:
        """Return what the work and its proof know of the options."""
        return Options(
            self.tolerance,
            self.axis_tolerance,
            to_axes=True,
            rapids_turn=self.rapids == "ends",
            tip_codes=self.tip_codes == "read",
            great_circles=self.orientation_path == "great-circle",
        )

    def begin(self, context: gx.PassContext) -> None:
        """Refuse a control without codes for vectors, and a machine whose angles are not found."""
        super().begin(context)
        if self._reads_vectors and not context.source.tip_rule.vector_codes:
            message = f"{context.source.name} has no code for tool vectors"
            raise gx.UsageError.one("GX746", message, hint='leave tip-codes out, or say "read"')
        if self._turns_anew and context.machine is not None:
            check_angles(context.machine, wraps=not self._reads_vectors)

    def places(self, path: gx.Toolpath, context: gx.PassContext) -> tuple[Place, Place]:
        """Return the place of the machine file; a length that follows the tip does so at once."""
        switched = bool(context.switches) or not context.source.tip_rule.codes
        place = Place(path, context, switched=self.tip_codes == "read" and switched)
        return place, place

    def apply(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        """Return the path of the axes for one of tips."""
        switches = Switches(path, context) if self.tip_codes == "read" else None
        if switches is not None:
            switches.refuse(self._turns_anew)
        if len(path):
            place, _ = self.places(path, context)
            by_length = bool(context.source.tip_rule.codes)
            if switches is not None and (by_length or not switches.codes):
                place.refuse_followed_late(by_length)
            path = self._converted(path, context, place)
        return path.replace(blocks=_timed(path.blocks))

    def _converted(self, path: gx.Toolpath, context: gx.PassContext, place: Place) -> gx.Toolpath:
        options = self.options(context)
        if self._turns_anew:
            return self._moving(options, path, context, place, place).run()[0]
        return Cutting(options, path, context, place, Between(place, to_axes=True)).run()[0]

    @property
    def _moving(self) -> type[Moving]:
        if self._reads_vectors:
            return InProportion if self.orientation_path == "angles" else Pointing
        return Circling

    def prove(self, before: gx.Toolpath, after: gx.Toolpath, context: gx.PassContext) -> None:
        """Check tips, tool axes and feeds where other angles are written."""
        if len(before):
            self.proof(before, after, context).check(self.axis_tolerance, np.inf)

    def proof(self, before: gx.Toolpath, after: gx.Toolpath, context: gx.PassContext) -> Proof:
        """Return the proof, in which the tip is led by the program."""
        source, _ = self.places(before, context)
        _, target = self.places(after, context)
        driven, options = Driven(after, target), self.options(context)
        if self._reads_vectors:
            pointed = Pointed(without_left(before), source)
            return PointedProof(options, context, pointed, driven, np.isinf(before.end))
        return Proof(options, context, Led(before, source), driven)

    def measure(
        self, before: gx.Toolpath, after: gx.Toolpath, context: gx.PassContext
    ) -> dict[str, float]:
        """Return how far tips and tool axes stay off, and how much slower moves are."""
        if not len(after):
            return {}
        found = self.proved(before, after, context) if self._turns_anew else {}
        before = without_left(before)
        return found | slowed(before, after, self.places(before, context)[0])

    def undo(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        """Return the path of the tip, in pieces, when the control moves all axes in proportion."""
        if not len(path) or self._turns_anew:
            return path
        place, _ = self.places(path, context)
        return Undoing(path, place, to_tips=True).run(self.tolerance)


def _timed(blocks: gx.Blocks) -> gx.Blocks:
    """Return blocks in inverse time.

    What runs after a block that leaves the program finds the feed mode of the source.
    """
    mode = np.where(blocks.leaves, blocks.feed_mode, np.int8(gx.FeedMode.INVERSE_TIME))
    return replace(blocks, feed_mode=mode)
