"""Moves that the control of the output makes by other words, without being asked.

Canned cycles that it has not become their moves, and ways home to another kind of point become
moves in the machine, where it is known where home is. A compensation finds the moves of all cycles:
the errors of a machine on the way down a hole are others than where it begins.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from gcxform.contract.passes import resolved
from gcxform.modal.interpreter import Interpreted
from gcxform.pipeline.chain import compensates
from gcxform.pipeline.placing import placing
from gcxform.pipeline.plan import Plan
from gcxform.syntax.scan import Window
from gcxform.toolpath.cycles_as_moves import cycles_as_moves
from gcxform.toolpath.path import Form, Toolpath


def said_in_moves(
    plan: Plan, done: int, read: Interpreted, path: Toolpath, window: Window, file: str
) -> Toolpath:
    """Return the path of a window, in which such blocks are plain moves. Raises InputError.

    They become so behind the last of the steps that prove their paths by what they were given;
    `done` is how many have been run.
    """
    if done != resolved(plan.path_passes):
        return path
    path, foreign = _homed(plan, read, path), plan.manner.foreign_cycles
    whole = compensates(plan.path_passes)
    if not (foreign or whole) or not (path.form == Form.CYCLE).any():
        return path
    with placing(window, file):
        here = np.isin(read.modes.cycle[path.block], list(foreign))
        return cycles_as_moves(path, None if whole else here)


def _homed(plan: Plan, read: Interpreted, path: Toolpath) -> Toolpath:
    """Return a path in which ways home are moves in the machine, by absolute words."""
    saying = plan.saying
    frames = {n: to.frame for n, to in read.homed.items() if saying.moves_home(*to.asked)}
    if not frames:
        return path
    lines = np.array(list(frames))
    home = np.isin(path.block, lines) & (path.form == Form.HOME)
    last = np.append(path.block[1:] != path.block[:-1], True)
    number = np.zeros(len(path.blocks.inch), np.int64)
    number[lines] = len(path.frames) + np.arange(len(lines))
    incremental = path.blocks.incremental.copy()
    incremental[lines] = False
    path = path.replace(
        form=np.where(home, Form.PLAIN, path.form).astype(np.int8),
        frame=np.where(home, number[path.block], path.frame),
        frames=(*path.frames, *frames.values()),
        blocks=replace(path.blocks, incremental=incremental),
    )
    return path.with_rows((~home | last).astype(np.int64))
