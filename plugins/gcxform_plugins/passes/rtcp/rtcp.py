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
from gcxform_plugins.passes.rtcp.options import Options, Retraction
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
        _check_options(self)
        if self.direction in ("repost", "retarget"):
            object.__setattr__(self, "requires", PLAIN | self.ensures)
            object.__setattr__(self, "clears", frozenset())
        if self.turns_anew:
            object.__setattr__(self, "requires", self.requires - {gx.LINEAR_ONLY})
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
    def promise(self) -> float:
        """The tolerance: of the tip, also where it is proved before anything is written."""
        return self.tolerance

    @property
    def demands(self) -> gx.Demands:
        """A path of its own where it turns anew; inverse time, in which any feed can be said."""
        lean = self._leans()[0]
        lean = lean if self.turns_anew and np.isfinite(lean) else 0.0
        tip = {} if self.to_axes and not self.turns_anew else {"deviation": TIP_OFF}
        return gx.Demands(
            resolves=self.turns_anew,
            whole_cuts=self.direction == "retarget",
            reads_tip_codes=self.tip_codes == "read",
            reads_vectors=self.reads_vectors,
            letters=self._letters,
            written_for=self.target,
            promise_angle=lean,
            feed_mode=gx.FeedMode.INVERSE_TIME if self.to_axes else None,
            slows=self.to_axes,
            deviates=tip | ({"angle": AXIS_OFF} if lean else {}),
        )

    @property
    def to_axes(self) -> bool:
        """Whether tips are read, and axes written."""
        return self.direction == "to-machine"

    @property
    def reads_vectors(self) -> bool:
        """Whether it makes angles of tool vectors."""
        return self.tip_codes == "vectors"

    @property
    def _letters(self) -> str:
        """The rotary axes of the target."""
        return "" if self.target is None else "".join(gx.chain_of(self.target.machine).letters)

    def begin(self, context: gx.PassContext) -> None:
        """Refuse a run without a machine that turns."""
        machine = context.machine
        if machine is None or not machine.table + machine.head:
            message = "rtcp needs a machine with rotary axes"
            hint = 'file = "machine.toml" in [machine], with `kinematics`, or `table` and `head`'
            raise gx.UsageError.one("GX742", message, hint=hint)
        self._options(context)
        _check_machines(self, context)

    def apply(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        """Return the path of the axes for one of tips; if asked the reverse, or one corrected."""
        switches = Switches(path, context) if (self.tip_codes == "read") else None
        if switches is not None:
            switches.refuse(self.turns_anew)
        if not len(path) or self._nothing_to_correct(context):
            return path.replace(blocks=self.timed(path.blocks))
        if switches is not None and (context.source.tip_rule.codes or not switches.codes):
            self._place(path, context).refuse_followed_late(bool(context.source.tip_rule.codes))
        if self.turns_anew:
            source, target = self._machines(path, context)
            path, _ = self._moving(self._options(context), path, context, source, target).run()
        else:
            place = self._place(path, context)
            way = self._corrected(path, context) or Between(place, self.direction == "to-machine")
            cutting = Cutting(self._options(context), path, context, place, way)
            before, (path, row) = path, cutting.run()
            if self.direction != "to-machine":
                self._tips(before, path, context, row).check_tips()
        return path.replace(blocks=self.timed(path.blocks))

    def _tips(
        self, before: gx.Toolpath, after: gx.Toolpath, context: gx.PassContext, owner: Ints
    ) -> TipProof:
        """Return the proof that no tip is farther off than the tolerance."""
        source, _ = self._machines(before, context)
        _, target = self._machines(after, context)
        led = self.direction == "to-tip"
        written = Straight(after, target) if led else Driven(after, target)
        options = self._options(context)
        return TipProof(options, context, Driven(before, source), written, owner)

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
        switched = bool(context.switches) or not context.source.tip_rule.codes
        return Place(path, context, switched=(self.tip_codes == "read") and switched)

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
        source = Place(path, context, others=self._letters)
        return source, Place(path, there, others="".join(source.chain.letters))

    def _options(self, context: gx.PassContext) -> Options:
        """Return what the work and its proof know of the options."""
        return Options(
            tolerance=self.tolerance,
            axis_tolerance=self.axis_tolerance,
            to_axes=self.direction == "to-machine",
            rapids_turn=self.rapids == "ends",
            tip_codes=(self.tip_codes == "read"),
            great_circles=self.orientation_path == "great-circle",
            corrects=self.direction == "repost",
            largest_turn=self.largest_turn,
            keeps_at_pole=self.orientation == "correct-if-tilt",
            target=None if self.target is None else self.target.machine,
            retraction=self._retraction(context),
        )

    def _retraction(self, context: gx.PassContext) -> Retraction | None:
        if self.retract is None or self.retract_feed is None or self.target is None:
            return None
        inert = context.machine.inert_m if context.machine else frozenset()
        inert = inert & self.target.machine.inert_m
        lines = UserLines.of(self.retract_lines, self.return_lines, context.target, inert)
        return Retraction(self.retract, self.retract_feed, lines)

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
        driven, options = Driven(after, target), self._options(context)
        if self.reads_vectors:
            pointed = Pointed(without_left(before), source)
            return PointedProof(options, context, pointed, driven, np.isinf(before.end))
        led = self.direction == "to-machine"
        return Proof(
            options, context, Led(before, source) if led else Driven(before, source), driven
        )

    def added(
        self, before: gx.Toolpath, after: gx.Toolpath, context: gx.PassContext
    ) -> dict[str, int]:
        """Return how often the tool is drawn back, and in how many moves, as the proof has it."""
        if self.retract is None or not len(after):
            return {}
        _, target = self._machines(after, context)
        drawn = Retracted(self._options(context), Driven(after, target))
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
        if self.to_axes:
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
        if not self.to_axes:
            return blocks
        mode = np.where(blocks.leaves, blocks.feed_mode, np.int8(gx.FeedMode.INVERSE_TIME))
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
            return Undoing(path, way.axes, True, way.nominal).run(self.tolerance)
        inwards = self.direction == "to-machine"
        return Undoing(path, self._place(path, context), inwards).run(self.tolerance)


def _check_options(step: Rtcp) -> None:
    """Refuse options that do not go together. Raises ValueError."""
    if (step.direction == "repost") != (step.calibrated is not None):
        raise ValueError("repost takes calibrated, the file of the measured machine")
    if (step.direction == "retarget") != (step.target is not None):
        raise ValueError("retarget takes target, the file of the machine to write for")
    if step.direction != "repost" and step.orientation != "keep":
        raise ValueError("orientation is an option of repost")
    if step.direction != "to-machine" and step.tip_codes != "refuse":
        raise ValueError("tip-codes is an option of to-machine: the others would do it twice")
    if step.reads_vectors and step.rapids == "refuse":
        raise ValueError('vectors turn axes in rapids: say rapids = "ends" if all is clear')
    if step.direction != "to-machine" and step.orientation_path != "angles":
        raise ValueError("orientation-path is an option of to-machine")
    _check_retract(step)
    if step.direction == "retarget" and step.rapids == "refuse":
        raise ValueError('retarget turns axes in rapids: say rapids = "ends" if all is clear')


def _check_retract(step: Rtcp) -> None:
    if (step.retract is None) != (step.retract_feed is None):
        raise ValueError("retract and retract-feed go together")
    if step.retract is None and (step.retract_lines or step.return_lines):
        raise ValueError("retract-lines and return-lines go with retract")
    if step.direction != "retarget" and step.retract is not None:
        raise ValueError("retract is an option of retarget")


def _check_machines(step: Rtcp, context: gx.PassContext) -> None:
    """Raise UsageError for machines of options, or a control, with which a step cannot work."""
    assert context.machine is not None
    if step.reads_vectors and not context.source.tip_rule.vector_codes:
        message = f"{context.source.name} has no code for tool vectors"
        raise gx.UsageError.one("GX746", message, hint='leave tip-codes out, or say "read"')
    _check_calibrated(step, gx.chain_of(context.machine))
    _check_target(step, context)


def _check_calibrated(step: Rtcp, posted: gx.Chain) -> None:
    """Refuse a calibrated machine that is another one."""
    if step.calibrated is None:
        return
    measured = gx.chain_of(step.calibrated.machine)
    one, other = ((chain.letters, chain.tip, len(chain.table)) for chain in (posted, measured))
    if one != other:
        message = "the calibrated machine has other rotary axes, or another gauge point"
        hint = "take the machine file that `gcxform calibrate` has made of the one of [machine]"
        raise gx.UsageError.one("GX743", message, hint=hint)


def _check_target(step: Rtcp, context: gx.PassContext) -> None:
    """Refuse a target whose angles are not found, and one with other tools."""
    machine = context.machine
    assert machine is not None
    files = [file.machine for file in (step.calibrated, step.target) if file is not None]
    for other in (files or [machine]) if step.turns_anew else ():
        chain = gx.chain_of(other)
        gx.attitudes(chain, np.array([[0.0, 0.0, 1.0]]))
        wrapped = [axis.letter for axis in chain.axes if axis.wrap is not None]
        wrapped = wrapped if files or step.reads_vectors else []
        if len(chain.axes) != 2 or wrapped:
            _refuse_target(wrapped)
    for number, tool in step.target.machine.tools.items() if step.target else ():
        if machine.tools.get(number, tool) != tool:
            message = f"tool {number} is another one in the file of the target"
            hint = "give both machine files the tools that the program is for"
            raise gx.UsageError.one("GX744", message, hint=hint)


def _refuse_target(wrapped: list[str]) -> None:
    message = "angles are found for machines with two rotary axes"
    hint = ""
    if wrapped:
        message = f"which way {wrapped[0]} turns is not known: the machine file gives it a wrap"
        hint = "leave wrap out, and give limits, if the control counts full turns"
    raise gx.UsageError.one("GX744", message, hint=hint)
