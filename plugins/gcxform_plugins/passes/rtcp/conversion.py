"""What the passes between tips and axes have in common: the machine, the proof of tips, measures.

At the same angles the tip is as far from its line as the axes are from theirs, because tip and axes
are apart by a rotation and an arm that the angles alone fix. So one bound serves both directions.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Flags, Ints
from gcxform_plugins.passes.rtcp.forward.cutting import Cutting
from gcxform_plugins.passes.rtcp.measured import AXIS_OFF, TIP_OFF
from gcxform_plugins.passes.rtcp.options import Options
from gcxform_plugins.passes.rtcp.place import Place
from gcxform_plugins.passes.rtcp.proof.driven import Driven, Straight
from gcxform_plugins.passes.rtcp.proof.proof import Proof
from gcxform_plugins.passes.rtcp.proof.tips import TipProof

PLAIN = frozenset({gx.ABSOLUTE, gx.LINEAR_ONLY, gx.NOMINAL})
Rapids = Annotated[
    Literal["refuse", "ends"],
    gx.Option("rapids that turn axes: refuse them, or convert where they end"),
]
AxisTolerance = Annotated[
    gx.Angle,
    gx.Option("how far the tool axis may lean from its way, where angles change", above=0.0),
]


@dataclass(frozen=True)
class Conversion(gx.Pass):
    """The base of the passes between positions of the tool's tip and those of axes."""

    tolerance: Annotated[gx.Length, gx.Option("how far the tip may leave its line", above=0.0)]

    @property
    def promise(self) -> float:
        """The tolerance: of the tip, also where it is proved before anything is written."""
        return self.tolerance

    def begin(self, context: gx.PassContext) -> None:
        """Refuse a run without a machine that turns, and options that do not suit it."""
        machine = context.machine
        if machine is None or not machine.table + machine.head:
            message = f"{self.name} needs a machine with rotary axes"
            hint = 'file = "machine.toml" in [machine], with `kinematics`, or `table` and `head`'
            raise gx.UsageError.one("GX742", message, hint=hint)
        self.options(context)

    def options(self, context: gx.PassContext) -> Options:
        """Return what the work and its proof know of the options."""
        raise NotImplementedError

    def places(self, path: gx.Toolpath, context: gx.PassContext) -> tuple[Place, Place]:
        """Return the places of the machine posted for, and of the one that is written for."""
        place = Place(path, context)
        return place, place

    # --- tips of programs in axes, which no comparison of axes shows ---

    def cutting(self, path: gx.Toolpath, context: gx.PassContext) -> Cutting:
        """Return the work on a path whose tips are compared."""
        raise NotImplementedError

    def followed(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        """Return the path that is cut, its tips compared. Raises VerificationError."""
        cutting = self.cutting(path, context)
        path, row = cutting.run()
        self._tips(cutting.path, path, cutting.context, row).check_tips()
        return path

    def written(self, path: gx.Toolpath, place: Place) -> Driven | Straight:
        """Return where tools are along what is written."""
        return Driven(path, place)

    def _tips(
        self, before: gx.Toolpath, after: gx.Toolpath, context: gx.PassContext, owner: Ints
    ) -> TipProof:
        """Return the proof that no tip is farther off than the tolerance."""
        source, _ = self.places(before, context)
        _, target = self.places(after, context)
        led, options = Driven(before, source), self.options(context)
        return TipProof(options, context, led, self.written(after, target), owner)

    def tip_off(
        self, before: gx.Toolpath, after: gx.Toolpath, context: gx.PassContext
    ) -> dict[str, float]:
        """Return how far the tip is off where axes are compared; pieces stand behind their rows.

        Rows that a step before has cut of one have its place: which piece is whose is cut anew.
        """
        owner = np.append(0, np.cumsum(_other(after)))
        if not _other(before).all():
            owner = self.cutting(before, context).run()[1]
        proof = self._tips(before, after, context, owner)
        proof.run()
        return {TIP_OFF: proof.tip}

    # --- other angles than the program has ---

    def proof(self, before: gx.Toolpath, after: gx.Toolpath, context: gx.PassContext) -> Proof:
        """Return the proof of tips, tool axes and feeds where other angles are written."""
        source, _ = self.places(before, context)
        _, target = self.places(after, context)
        return Proof(self.options(context), context, Driven(before, source), Driven(after, target))

    def proved(
        self, before: gx.Toolpath, after: gx.Toolpath, context: gx.PassContext
    ) -> dict[str, float]:
        """Return what that proof measures."""
        proof = self.proof(before, after, context)
        proof.run()
        found = {TIP_OFF: proof.tip, AXIS_OFF: proof.lean} | proof.measured()
        corrected = {"angles corrected by, degrees": proof.turn}
        return found | corrected if proof.options.corrects else found


def _other(path: gx.Toolpath) -> Flags:
    """Return which rows (n - 1,) are another move of the program than the one before."""
    return np.asarray((np.diff(path.source) != 0) | (np.diff(path.nth) != 0))


def check_angles(machine: gx.Machine, wraps: bool) -> None:
    """Refuse a machine whose angles are not found; `wraps`: an axis may take the shorter way.

    Raises UsageError.
    """
    chain = gx.chain_of(machine)
    gx.attitudes(chain, np.array([[0.0, 0.0, 1.0]]))
    wrapped = [] if wraps else [axis.letter for axis in chain.axes if axis.wrap is not None]
    if len(chain.axes) == 2 and not wrapped:
        return
    message, hint = "angles are found for machines with two rotary axes", ""
    if wrapped:
        message = f"which way {wrapped[0]} turns is not known: the machine file gives it a wrap"
        hint = "leave wrap out, and give limits, if the control counts full turns"
    raise gx.UsageError.one("GX744", message, hint=hint)
