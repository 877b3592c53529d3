"""`to-tip`: from where the axes stand to where the tip is, for controls that follow the tip."""

from __future__ import annotations

from dataclasses import dataclass

import gcxform as gx
from gcxform_plugins.passes.rtcp.conversion import PLAIN, Conversion, Rapids
from gcxform_plugins.passes.rtcp.forward.cutting import Cutting
from gcxform_plugins.passes.rtcp.forward.ways import Between
from gcxform_plugins.passes.rtcp.measured import TIP_OFF
from gcxform_plugins.passes.rtcp.options import Options
from gcxform_plugins.passes.rtcp.place import Place
from gcxform_plugins.passes.rtcp.proof.driven import Straight
from gcxform_plugins.passes.rtcp.proof.undoing import Undoing


@dataclass(frozen=True)
class ToTip(Conversion):
    """Turn positions of the axes into those of the tool's tip, for a control that follows it.

    The machine file says where the rotary axes are, and the work offset and the tool lengths that
    hold. The work offset is taken on the table with all rotary axes at 0.
    """

    name = "to-tip"
    requires = PLAIN | {gx.AXIS_POSITIONS}
    ensures = frozenset({gx.TIP_POSITIONS})
    clears = frozenset({gx.AXIS_POSITIONS})
    demands = gx.Demands(deviates={"deviation": TIP_OFF})

    rapids: Rapids = "refuse"

    def options(self, context: gx.PassContext) -> Options:
        """Return what the work and its proof know of the options."""
        return Options(self.tolerance, rapids_turn=self.rapids == "ends")

    def written(self, path: gx.Toolpath, place: Place) -> Straight:
        """Return a path of tips, which go straight."""
        return Straight(path, place)

    def apply(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        """Return the path of the tips for one of axes."""
        return self.followed(path, context) if len(path) else path

    def cutting(self, path: gx.Toolpath, context: gx.PassContext) -> Cutting:
        """Return the work on a path, which makes tips of axes."""
        place = Place(path, context)
        return Cutting(self.options(context), path, context, place, Between(place, to_axes=False))

    def measure(
        self, before: gx.Toolpath, after: gx.Toolpath, context: gx.PassContext
    ) -> dict[str, float]:
        """Return how far the tip is off."""
        return self.tip_off(before, after, context) if len(after) else {}

    def undo(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        """Return the path of the axes, in pieces, when the control follows the tip."""
        if not len(path):
            return path
        return Undoing(path, Place(path, context), to_tips=False).run(self.tolerance)
