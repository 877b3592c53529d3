"""Which options and machines `rtcp` does not take."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

import gcxform as gx

if TYPE_CHECKING:
    from gcxform_plugins.passes.rtcp.rtcp import Rtcp


def check_options(step: Rtcp) -> None:
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


def check_machines(step: Rtcp, context: gx.PassContext) -> None:
    """Raise UsageError for machines of options, or a control, with which a step cannot work."""
    assert context.machine is not None
    if step.reads_vectors and not context.source.vector_codes:
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
