"""Blocks to a place of the machine, G28, G30 and G53, whose words are written in another unit."""

from __future__ import annotations

import numpy as np

from gcxform.dialect.dialect import LINEAR
from gcxform.emit.manner import Task
from gcxform.emit.pieces import Pieces
from gcxform.emit.positions import Positions
from gcxform.system.arrays import Flags


def convertible(task: Task, pieces: Pieces, positions: Positions) -> Flags:
    """Return the lines (live,) whose words may be converted where they stand.

    Where these lead has to be known, or nothing could tell whether they are right; and numbers that
    count increments stay.
    """
    found = np.zeros(len(pieces.count), np.bool_)
    found[pieces.line[pieces.converted]] = True
    linear = [k for k, axis in enumerate(task.path.axes) if axis in LINEAR]
    rows = np.flatnonzero(found[task.path.block] & (task.path.nth == 0))
    named = positions.programmed[rows][:, linear]
    lost = (named & ~np.isfinite(task.path.end[rows][:, linear])).any(axis=1)
    found[task.path.block[rows[lost]]] = False
    for line in np.flatnonzero(found).tolist():
        found[line] = not (task.manner.source.point_rule.required and _counts(task, line))
    now, old = task.path.blocks, task.read.path.blocks
    return np.asarray(found & (now.incremental == old.incremental))


def _counts(task: Task, line: int) -> bool:
    """Whether a line has a length without a point."""
    slots = task.table.meanings[int(task.shape[line])].slots
    numbers = [int(task.window.first_number[line]) + slots[a] for a in LINEAR if a in slots]
    return bool((task.window.decimals[numbers] < 0).any())
