"""Which machines `rtcp` takes: those whose angles are found, with the tools of the program."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

import gcxform as gx

if TYPE_CHECKING:
    from gcxform_plugins.passes.rtcp import Rtcp


def check_machines(step: Rtcp, context: gx.PassContext) -> None:
    """Raise UsageError for machines of options, or a control, with which a step cannot work."""
    assert context.machine is not None
    if step.reads_vectors and not context.source.vector_codes:
        message = f"{context.source.name} has no code for tool vectors"
        raise gx.UsageError.one("GX745", message, hint='leave tip-codes out, or say "read"')
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
