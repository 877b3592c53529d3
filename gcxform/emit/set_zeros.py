"""Blocks that set a zero by a number (G10): the target has to take them for what the source means.

They are written as they stand, for which zero is meant, and from where it counts, has no other
spelling. Where coordinates are folded into the words they are not written at all.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from gcxform.catalogue.remedies import put_before
from gcxform.diagnostics import InputError
from gcxform.emit.manner import Task
from gcxform.modal.meaning.meaning import Act

SETS = "set-work"


def refuse_other_zeros(task: Task) -> None:
    """Raise InputError for the first block that sets another zero in the target."""
    if not task.manner.crossing or task.path.folded:
        return
    for line in np.flatnonzero(task.table.flag("presets", task.shape)).tolist():
        meaning = task.table.meanings[int(task.shape[line])]
        for what in (
            w for act in meaning.acts if act.name == SETS for w in _others(task, line, act)
        ):
            message = f"{what} sets other offsets on {task.manner.target.name}"
            raise InputError.one("GX213", message, task.location(line), put_before("offsets"))


def _others(task: Task, line: int, act: Act) -> Iterator[str]:
    """Yield what the target takes otherwise of a block that sets a zero."""
    one, other = task.manner.source.offset_rule, task.manner.target.offset_rule
    first, slots = int(task.window.first_number[line]), dict(act.slots)
    kind, number = (
        float(task.read.value[first + slots[address]]) if address in slots else 0.0
        for address in "LP"
    )
    if kind == 20 and one.g10_l20 != other.g10_l20:
        yield f"{act.code} L20"
    if kind == 2 and not number > 0 and one.g10_p0 != other.g10_p0:
        yield f"{act.code} L2 with P0"
    takes = "R" in getattr(task.manner.target.codes.get(act.code), "takes", "")
    if kind == 2 and takes and "R" in slots and one.g10_rotates != other.g10_rotates:
        yield f"{act.code} L2 with R"
