"""`repost`: a program in axes is corrected for where the axes of the machine really are.

Where they are not quite where the kinematics of the post-processor have them, the tip goes where it
would have gone, at the angles of the program or at those that give the same tool axis.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np

import gcxform as gx
from gcxform_plugins.passes.rtcp.conversion import PLAIN, AxisTolerance, Conversion, check_angles
from gcxform_plugins.passes.rtcp.forward.cutting import Cutting
from gcxform_plugins.passes.rtcp.forward.moving import Correcting
from gcxform_plugins.passes.rtcp.forward.ways import Corrected
from gcxform_plugins.passes.rtcp.measured import AXIS_OFF, TIP_OFF, leaning
from gcxform_plugins.passes.rtcp.options import Options
from gcxform_plugins.passes.rtcp.place import Place
from gcxform_plugins.passes.rtcp.proof.undoing import Undoing


@dataclass(frozen=True)
class Repost(Conversion):
    """Correct positions of axes for a calibrated machine, so that the tip goes where it should.

    [machine] is the machine that the program was posted for; it says which work offset and tool
    lengths hold. The work offset is taken on the table with all rotary axes at 0, where both
    machines agree.
    """

    name = "repost"
    requires = PLAIN | {gx.AXIS_POSITIONS}
    ensures = frozenset({gx.AXIS_POSITIONS})

    calibrated: Annotated[
        gx.KinematicsFile,
        gx.Option("the machine as it was measured; [machine] is the one posted for"),
    ]
    orientation: Annotated[
        Literal["keep", "correct", "correct-if-tilt"],
        gx.Option("keep the angles, or correct them too; if-tilt: not near the pole"),
    ] = "keep"
    largest_turn: Annotated[
        gx.Angle, gx.Option("by how much an angle may be corrected", above=0.0)
    ] = 0.5
    axis_tolerance: AxisTolerance = 0.1

    def __post_init__(self) -> None:
        """Take any path where angles are corrected, as it is proved as a whole."""
        if self._turns_anew:
            object.__setattr__(self, "requires", self.requires - {gx.LINEAR_ONLY})

    @property
    def _turns_anew(self) -> bool:
        """Whether other angles are written than the program has."""
        return self.orientation != "keep"

    @property
    def demands(self) -> gx.Demands:
        """A path of its own where angles are corrected."""
        lean = self.axis_tolerance if self.orientation == "correct" else 0.0
        angle = {"angle": AXIS_OFF} if lean else {}
        return gx.Demands(
            resolves=self._turns_anew,
            promise_angle=lean,
            deviates={"deviation": TIP_OFF, **angle},
        )

    def options(self, context: gx.PassContext) -> Options:
        """Return what the work and its proof know of the options."""
        return Options(
            self.tolerance,
            self.axis_tolerance,
            corrects=True,
            largest_turn=self.largest_turn,
            keeps_at_pole=self.orientation == "correct-if-tilt",
        )

    def places(self, path: gx.Toolpath, context: gx.PassContext) -> tuple[Place, Place]:
        """Return both places; the work offset is the same: it is what the operator has set."""
        return Place(path, context), Place(path, context, gx.chain_of(self.calibrated.machine))

    def begin(self, context: gx.PassContext) -> None:
        """Refuse a calibrated machine that is another one, or whose angles are not found."""
        super().begin(context)
        assert context.machine is not None
        chains = gx.chain_of(context.machine), gx.chain_of(self.calibrated.machine)
        one, other = ((chain.letters, chain.tip, len(chain.table)) for chain in chains)
        if one != other:
            message = "the calibrated machine has other rotary axes, or another gauge point"
            hint = "take the machine file that `gcxform calibrate` has made of the one of [machine]"
            raise gx.UsageError.one("GX743", message, hint=hint)
        if self._turns_anew:
            check_angles(self.calibrated.machine, wraps=False)

    def apply(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        """Return the path of the axes of the calibrated machine."""
        if not len(path) or self._nothing_to_correct(context):
            return path
        if self._turns_anew:
            places = self.places(path, context)
            return Correcting(self.options(context), path, context, *places).run()[0]
        return self.followed(path, context)

    def cutting(self, path: gx.Toolpath, context: gx.PassContext) -> Cutting:
        """Return the work on a path whose angles are kept."""
        nominal, axes = self.places(path, context)
        return Cutting(self.options(context), path, context, nominal, Corrected(nominal, axes))

    def _nothing_to_correct(self, context: gx.PassContext) -> bool:
        """Whether the calibrated machine is where the one posted for is."""
        assert context.machine is not None
        posted, measured = gx.chain_of(context.machine), gx.chain_of(self.calibrated.machine)
        pairs = zip(posted.axes, measured.axes, strict=True)
        return all(
            (one.direction, one.point, one.sign) == (other.direction, other.point, other.sign)
            for one, other in pairs
        )

    def prove(self, before: gx.Toolpath, after: gx.Toolpath, context: gx.PassContext) -> None:
        """Check tips, tool axes and feeds, and that no angle was corrected by too much."""
        if len(before) and not self._nothing_to_correct(context):
            lean = self.axis_tolerance if self.orientation == "correct" else np.inf
            self.proof(before, after, context).check(lean, self.largest_turn)

    def measure(
        self, before: gx.Toolpath, after: gx.Toolpath, context: gx.PassContext
    ) -> dict[str, float]:
        """Return how far tips and tool axes stay off."""
        if not len(after):
            return {}
        if self._turns_anew:
            return self.proved(before, after, context)
        found = leaning(Corrected(*self.places(after, context)), after)
        if not self._nothing_to_correct(context):
            found |= self.tip_off(before, after, context)
        return found

    def undo(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        """Return the path, in pieces, that brings the tip there on the machine posted for."""
        if not len(path) or self._turns_anew or self._nothing_to_correct(context):
            return path
        nominal, axes = self.places(path, context)
        return Undoing(path, axes, to_tips=True, posted=nominal).run(self.tolerance)
