"""`rtcp`: from where the tip shall be to where the axes stand, for controls that do not do it.

A control that follows the tool tip (RTCP, TCP) takes X, Y and Z for the tip on the workpiece; any
other takes them for its axes, and between two blocks it moves all axes in proportion. Then the tip
leaves its line, by as much as the axes turn. Here lines are cut until the bound of that is within
the tolerance, and of each piece the angles are rounded first and X, Y, Z computed from them.

Where the axes are not quite where the kinematics of the post-processor have them, `repost` corrects
a program in axes: the tip goes where it would have gone, at the angles of the program.

At the same angles the tip is as far from its line as the axes are from theirs, because tip and axes
are apart by a rotation and an arm that the angles alone fix. So one bound serves both directions.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Annotated, Literal

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Ints
from gcxform_plugins.passes.rtcp.forward.cutting import Cutting
from gcxform_plugins.passes.rtcp.forward.great_circles import Circling
from gcxform_plugins.passes.rtcp.forward.moving import Correcting, Moving
from gcxform_plugins.passes.rtcp.forward.vectors import InProportion, Pointing
from gcxform_plugins.passes.rtcp.forward.ways import Between, Corrected
from gcxform_plugins.passes.rtcp.measured import AXIS_OFF, TIP_OFF, leaning, slowed
from gcxform_plugins.passes.rtcp.options import check_machines, check_options
from gcxform_plugins.passes.rtcp.place import Place
from gcxform_plugins.passes.rtcp.proof.driven import Driven, Led, Pointed, Straight
from gcxform_plugins.passes.rtcp.proof.proof import Proof
from gcxform_plugins.passes.rtcp.proof.retracted import Retracted
from gcxform_plugins.passes.rtcp.proof.tips import TipProof
from gcxform_plugins.passes.rtcp.proof.undoing import Undoing
from gcxform_plugins.passes.rtcp.proof.vectors import PointedProof
from gcxform_plugins.passes.rtcp.switches import Switches
from gcxform_plugins.passes.rtcp.tool_vectors import without_left
from gcxform_plugins.passes.rtcp.user_lines import UserLines

PLAIN = frozenset({gx.ABSOLUTE, gx.LINEAR_ONLY, gx.NOMINAL})


@dataclass(frozen=True)
class Rtcp(gx.Pass):
    """Turn positions of the tool's tip into those of the axes, or the reverse, or correct the axes.

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
        Literal["to-machine", "to-tip", "repost", "retarget"],
        gx.Option(
            "to-machine: of tips, write axes; to-tip: of axes, write tips; repost: of axes, write "
            "those that take the tip there on the calibrated machine; retarget: on another machine"
        ),
    ] = "to-machine"
    tip_codes: Annotated[
        Literal["refuse", "read", "vectors"],
        gx.Option(
            "to-machine: programs that let the control follow the tip (G43.4, G234, TRAORI, M128, "
            "FUNCTION TCPM, #RTCP ON, tip-on of the machine file): read them as what it is "
            "without, for a control that does not; vectors: those that say the tool axis by I, J, "
            "K (G43.5)"
        ),
    ] = "refuse"
    rapids: Annotated[
        Literal["refuse", "ends"],
        gx.Option("rapids that turn axes: refuse them, or convert where they end"),
    ] = "refuse"
    calibrated: Annotated[
        gx.KinematicsFile | None,
        gx.Option("repost: the machine as it was measured; [machine] is the one posted for"),
    ] = None
    orientation: Annotated[
        Literal["keep", "correct", "correct-if-tilt"],
        gx.Option("repost: keep the angles, or correct them too; if-tilt: not near the pole"),
    ] = "keep"
    largest_turn: Annotated[
        gx.Angle, gx.Option("repost: by how much an angle may be corrected", above=0.0)
    ] = 0.5
    target: Annotated[
        gx.KinematicsFile | None,
        gx.Option("retarget: the machine to write for; [machine] is the one posted for"),
    ] = None
    retract: Annotated[
        gx.Length | None,
        gx.Option(
            "retarget: where axes have to flip or unwind in a cut, draw the tool back along its "
            "axis by so much and turn them there; absent: an error",
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
    orientation_path: Annotated[
        Literal["angles", "great-circle"],
        gx.Option("to-machine: between blocks angles change in proportion, or the tool axis does"),
    ] = "angles"
    axis_tolerance: Annotated[
        gx.Angle,
        gx.Option("how far the tool axis may lean from its way, where angles change", above=0.0),
    ] = 0.1

    def __post_init__(self) -> None:
        """Turn the facts round for the reverse. Raises ValueError for options that do not fit."""
        check_options(self)
        if self.direction in ("repost", "retarget"):
            object.__setattr__(self, "requires", PLAIN | self.ensures)
            object.__setattr__(self, "clears", frozenset())
        if self.turns_anew:
            object.__setattr__(self, "requires", self.requires - {gx.LINEAR_ONLY})
            object.__setattr__(self, "resolves", True)
            object.__setattr__(self, "whole_cuts", self.direction == "retarget")
        if self.direction == "retarget":  # its axes are those of another machine than [machine]
            object.__setattr__(self, "ensures", frozenset())
            object.__setattr__(self, "clears", frozenset({gx.AXIS_POSITIONS}))
        if self.direction == "to-tip":
            object.__setattr__(self, "requires", PLAIN | self.ensures)
            object.__setattr__(self, "ensures", self.clears)
            object.__setattr__(self, "clears", frozenset({gx.AXIS_POSITIONS}))

    @property
    def turns_anew(self) -> bool:
        """Whether other angles are written than the program has, in proportion."""
        return (
            self.direction == "retarget"
            or self.orientation != "keep"
            or self.orientation_path == "great-circle"
            or self.reads_vectors
        )

    @property
    def reads_tip_codes(self) -> bool:  # type: ignore[override]
        """Whether it does what the control was asked for."""
        return self.tip_codes == "read"

    @property
    def written_for(self) -> gx.KinematicsFile | None:
        """The machine of the target."""
        return self.target

    @property
    def reads_vectors(self) -> bool:  # type: ignore[override]
        """Whether it makes angles of tool vectors."""
        return self.tip_codes == "vectors"

    @property
    def letters(self) -> str:
        """The rotary axes of the target."""
        return "" if self.target is None else "".join(gx.chain_of(self.target.machine).letters)

    @property
    def promise(self) -> float:
        """The tolerance: of the tip, also where it is proved before anything is written."""
        return self.tolerance

    @property
    def promise_angle(self) -> float:
        """How far (deg) the tool axis may lean, where other angles are written."""
        lean = self._leans()[0]
        return lean if self.turns_anew and np.isfinite(lean) else 0.0

    @property
    def deviates(self) -> Mapping[str, str]:  # type: ignore[override]
        """What the tip is off, and the tool axis, where that is bounded."""
        tip = {} if self.follows_undo else {"deviation": TIP_OFF}
        return tip | ({"angle": AXIS_OFF} if self.promise_angle else {})

    @property
    def follows_undo(self) -> bool:
        """Whether tips are what the undo leads to, so that comparing paths compares them."""
        return self.direction == "to-machine" and not self.turns_anew

    @property
    def feed_mode(self) -> gx.FeedMode | None:
        """Inverse time, in which the feed of the tip can be said whatever the axes do."""
        return gx.FeedMode.INVERSE_TIME if self.direction == "to-machine" else None

    @property
    def slows(self) -> bool:
        """Whether moves may be slower, where axes would be too fast."""
        return self.direction == "to-machine"

    def begin(self, context: gx.PassContext) -> None:
        """Refuse a run without a machine that turns."""
        machine = context.machine
        if machine is None or not machine.table + machine.head:
            message = "rtcp needs a machine with rotary axes"
            hint = 'file = "machine.toml" in [machine], with `kinematics`, or `table` and `head`'
            raise gx.UsageError.one("GX742", message, hint=hint)
        UserLines.of(self, context)
        check_machines(self, context)

    def apply(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        """Return the path of the axes for one of tips; if asked the reverse, or one corrected."""
        switches = Switches(path, context) if self.reads_tip_codes else None
        if switches is not None:
            switches.refuse(self.turns_anew)
        if not len(path) or self._nothing_to_correct(context):
            return path.replace(blocks=self.timed(path.blocks))
        if switches is not None and (context.source.tip_codes or not switches.codes):
            self._place(path, context).refuse_followed_late(bool(context.source.tip_codes))
        if self.turns_anew:
            source, target = self._machines(path, context)
            path = self._moving(self, path, context, source, target).run()
        else:
            place = self._place(path, context)
            way = self._corrected(path, context) or Between(place, self.direction == "to-machine")
            cutting = Cutting(self, path, context, place, way)
            before, path = path, cutting.run()
            if self.direction != "to-machine":
                self._tips(before, path, context, cutting.row).check_tips()
        return path.replace(blocks=self.timed(path.blocks))

    def _tips(
        self, before: gx.Toolpath, after: gx.Toolpath, context: gx.PassContext, owner: Ints
    ) -> TipProof:
        """Return the proof that no tip is farther off than the tolerance."""
        source, _ = self._machines(before, context)
        _, target = self._machines(after, context)
        led = self.direction == "to-tip"
        written = Straight(after, target) if led else Driven(self, after, target)
        return TipProof(self, context, Driven(self, before, source), written, owner)

    def _nothing_to_correct(self, context: gx.PassContext) -> bool:
        """Whether the calibrated machine is where the one posted for is."""
        if self.calibrated is None or context.machine is None:
            return False
        posted, measured = gx.chain_of(context.machine), gx.chain_of(self.calibrated.machine)
        pairs = zip(posted.axes, measured.axes, strict=True)
        return all(
            (one.direction, one.point, one.sign) == (other.direction, other.point, other.sign)
            for one, other in pairs
        )

    def _corrected(self, path: gx.Toolpath, context: gx.PassContext) -> Corrected | None:
        return None if self.calibrated is None else Corrected(*self._machines(path, context))

    def _place(self, path: gx.Toolpath, context: gx.PassContext) -> Place:
        """Return the place of the machine file; a length that follows the tip does so at once."""
        switched = bool(context.switches) or not context.source.tip_codes
        return Place(path, context, switched=self.reads_tip_codes and switched)

    def _machines(self, path: gx.Toolpath, context: gx.PassContext) -> tuple[Place, Place]:
        """Return the places of the machine posted for, and of the one that is written for.

        A calibrated machine has the work offset of the other: it is what the operator has set.
        """
        if self.target is None:
            place = self._place(path, context)
            if self.calibrated is None:
                return place, place
            return place, Place(path, context, gx.chain_of(self.calibrated.machine))
        assert context.machine is not None
        there = replace(context, machine=self.target.machine)
        source = Place(path, context, others=self.letters)
        return source, Place(path, there, others="".join(source.chain.letters))

    def speeds(self, context: gx.PassContext) -> list[tuple[str, float]]:
        """Return the axes whose top speed the machine file has, where it counts."""
        if not self.slows or context.machine is None:
            return []
        axes = context.machine.axes.items()
        return [(a, axis.max_speed) for a, axis in axes if axis.max_speed is not None]

    @property
    def _moving(self) -> type[Moving]:
        if self.target is not None:
            return Moving
        if self.reads_vectors:
            return InProportion if self.orientation_path == "angles" else Pointing
        return Circling if self.calibrated is None else Correcting

    def prove(self, before: gx.Toolpath, after: gx.Toolpath, context: gx.PassContext) -> None:
        """Check tips, tool axes and feeds of a program for another machine."""
        if len(before) and not self._nothing_to_correct(context):
            lean, turn = self._leans()
            self._proof(before, after, context).check(lean, turn)

    def _proof(self, before: gx.Toolpath, after: gx.Toolpath, context: gx.PassContext) -> Proof:
        source, _ = self._machines(before, context)
        _, target = self._machines(after, context)
        driven = Driven(self, after, target)
        if self.reads_vectors:
            pointed = Pointed(without_left(before), source)
            return PointedProof(self, context, pointed, driven, np.isinf(before.end))
        if self.direction == "to-machine":
            return Proof(self, context, Led(before, source), driven)
        return Proof(self, context, Driven(self, before, source), driven)

    def added(
        self, before: gx.Toolpath, after: gx.Toolpath, context: gx.PassContext
    ) -> dict[str, int]:
        """Return how often the tool is drawn back, and in how many moves, as the proof has it."""
        if self.retract is None or not len(after):
            return {}
        _, target = self._machines(after, context)
        lines = UserLines.of(self, context)
        drawn = Retracted(self, Driven(self, after, target), lines)
        found = {"retracts": len(drawn.found), "moves of retracts": drawn.moves}
        return found | ({"lines of retracts": len(drawn.given)} if drawn.given else {})

    def _leans(self) -> tuple[float, float]:
        """Return by how much (degrees) the tool axis may lean, and angles may differ."""
        if self.calibrated is None:
            return self.axis_tolerance, np.inf
        kept = self.orientation == "correct-if-tilt"
        return np.inf if kept else self.axis_tolerance, self.largest_turn

    def measure(
        self, before: gx.Toolpath, after: gx.Toolpath, context: gx.PassContext
    ) -> dict[str, float]:
        """Return how far tips and tool axes stay off, and how much slower moves are."""
        if not len(after):
            return {}
        found = self._turned(before, after, context)
        if self.slows:
            before = without_left(before)
            found |= slowed(before, after, self._place(before, context))
        elif not self.turns_anew and not self._nothing_to_correct(context):
            found |= self._tip_off(before, after, context)
        return found

    def _tip_off(
        self, before: gx.Toolpath, after: gx.Toolpath, context: gx.PassContext
    ) -> dict[str, float]:
        """Return how far the tip is off where axes are compared; pieces stand behind their rows."""
        begins = (np.diff(after.source) != 0) | (np.diff(after.nth) != 0)
        proof = self._tips(before, after, context, np.append(0, np.cumsum(begins)))
        proof.run()
        return {TIP_OFF: proof.tip}

    def _turned(
        self, before: gx.Toolpath, after: gx.Toolpath, context: gx.PassContext
    ) -> dict[str, float]:
        if self.turns_anew:
            return self._measured(before, after, context)
        way = self._corrected(after, context)
        return {} if way is None else leaning(way, after)

    def _measured(
        self, before: gx.Toolpath, after: gx.Toolpath, context: gx.PassContext
    ) -> dict[str, float]:
        """Return what the proof has found."""
        proof = self._proof(before, after, context)
        proof.run()
        found = {TIP_OFF: proof.tip, AXIS_OFF: proof.lean}
        found |= proof.measured()
        corrected = {"angles corrected by, degrees": proof.turn}
        return found if self.calibrated is None else found | corrected

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

        For the reverse it is the path of the axes when the control follows the tip; for a corrected
        program that of the axes which would have brought the tip there on the machine posted for.
        """
        if not len(path) or self.turns_anew or self._nothing_to_correct(context):
            return path
        way = self._corrected(path, context)
        if way is not None:
            return Undoing(self, path, way.axes, True, way.nominal).run()
        inwards = self.direction == "to-machine"
        return Undoing(self, path, self._place(path, context), inwards).run()
