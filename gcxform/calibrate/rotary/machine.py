"""Calibration of an axis of a machine file: what it has to agree with, and what is written."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from math import isnan

import numpy as np

from gcxform.calibrate.bundle import report as bundlewords
from gcxform.calibrate.bundle.bundle import Bundled
from gcxform.calibrate.rotary.axis import Centres, Placed, locate
from gcxform.calibrate.rotary.check import axis_of
from gcxform.diagnostics import InputError, Location, UsageError
from gcxform.machine.axis_text import MARK, with_axis
from gcxform.machine.chain import Chain, Rotary, Triple, chain_of
from gcxform.machine.kinds import FAR
from gcxform.machine.machine import Axis, Machine
from gcxform.machine.text import axis_lines
from gcxform.system import inputs


def located(
    centres: Centres,
    letter: str,
    noise: float,
    machine: Machine | None = None,
    tool: int | None = None,
) -> tuple[Placed, Axis | None]:
    """Return an axis as measured, and as the machine file has it if there is one.

    Raises InputError for centres that `locate` refuses, or that contradict the file (GX488).
    """
    if machine is None:
        return locate(centres, noise), None
    if letter not in machine.table + machine.head:
        message = f"{machine.name} has no rotary axis {letter}"
        raise UsageError.one("GX707", message, Location("--axis"))
    tip = _tip(machine, tool) if letter in machine.head or tool is not None else None
    if tip is not None and letter in machine.table:
        centres, tip = replace(centres, points=centres.points + np.array(tip)), None
    found = locate(centres, noise, tip)
    _check(found, letter, machine)
    return found, machine.axes[letter]


def _tip(machine: Machine, tool: int | None) -> Triple:
    """Return the tip of the probe with all axes at 0. Raises UsageError."""
    known = None if tool is None else machine.tools.get(tool)
    if known is None or isnan(float(known.length)):
        message = "an axis of the head is found with a probe whose length is known"
        hint = "give [tool.N] length in the machine file, and --tool N"
        raise UsageError.one("GX707", message, Location("--tool"), hint)
    return chain_of(machine, known).tip


def _check(found: Placed, letter: str, machine: Machine) -> None:
    """Raise InputError (GX488) for another axis than that of the machine file."""
    axis, file = machine.axes[letter], machine.file
    assert axis.direction is not None
    assert axis.sign is not None
    cosine = float(found.direction @ np.array(axis.direction))
    off = math.degrees(math.acos(min(1.0, abs(cosine))))
    if off > FAR:
        message = f"the axis that turned is {off:.1f} degrees off {letter} of {file}"
        raise InputError.one("GX488", message, found.centres.where(0))
    if found.sign * axis.sign * cosine < 0.0:
        message = (
            f"{letter} turned the other way than {file} says: its sign or the angles are wrong"
        )
        raise InputError.one("GX488", message, found.centres.where(0))


def with_found(found: Placed, letter: str, machine: Machine | None, comments: list[str]) -> str:
    """Return the machine file with the axis that was found; without one, one of that axis alone."""
    if machine is not None:
        text = inputs.read(machine.file).decode("utf-8")
        return with_axis(text, letter, axis_of(found), comments, str(machine.file))
    head = ["format = 1", f'table = ["{letter}"]', "", f"[axis.{letter}]"]
    marked = [f"{MARK} {comment}" for comment in comments]
    return "\n".join([*head, *marked, *axis_lines(axis_of(found))]) + "\n"


# --- all axes ---


def probing(machine: Machine, tool: int | None) -> Chain:
    """Return the chain of a machine with its probe. Raises UsageError.

    Without one X, Y and Z are those of the tip: a head can then not be followed.
    """
    chain = turning(machine)
    named = chain.head or tool is not None
    return replace(chain, tip=_tip(machine, tool) if named else (0.0, 0.0, 0.0))


def turning(machine: Machine) -> Chain:
    """Return the chain of a machine that has rotary axes. Raises UsageError."""
    chain = chain_of(machine)
    if not chain.axes:
        message = "this machine has no rotary axis"
        raise UsageError.one("GX452", message, Location(str(machine.file)))
    return chain


def bundled_text(found: Bundled, machine: Machine, data: str) -> str:
    """Return the machine file with all axes that were found."""
    return with_axes(found.chain.axes, machine, partial(bundlewords.comments, found, file=data))


def with_axes(
    axes: Sequence[Rotary], machine: Machine, comments: Callable[[str], list[str]]
) -> str:
    """Return the machine file with some axes; `comments` of a letter stand above its values."""
    text = inputs.read(machine.file).decode("utf-8")
    for axis in axes:
        stated = Axis(direction=axis.direction, point=axis.point, sign=axis.sign)
        text = with_axis(text, axis.letter, stated, comments(axis.letter), str(machine.file))
    return text
