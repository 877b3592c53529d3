"""What a pipeline did with a program, move by move: how far off, which error, which step."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from gcxform.pipeline.plan import Plan
from gcxform.system.arrays import Floats, Ints
from gcxform.system.limits import in_force, limits
from gcxform.toolpath.facts import COMPENSATED
from gcxform.toolpath.path import Toolpath
from gcxform.view.linking import Linked, changed_by, linked, undone

MANY: Final = 1 << 28  # rows; what a run writes has been limited window by window


@dataclass(frozen=True)
class Outcome:
    """A source and its output, compared as the machine goes.

    belongs  which moves belong together, and how far the machine is from the programmed path
    step     (blocks of the source,) the step, from 1, that changed it last; 0: none did
    error    (blocks of the source,) mm, how far the machine would be off without the pipeline; None
             where no step compensates
    """

    belongs: Linked
    step: Ints
    error: Floats | None


def outcome(plan: Plan, source: Toolpath, output: Toolpath, owner: Ints | None) -> Outcome:
    """Return what a pipeline did. Raises InputError where a step refuses the whole program.

    `owner` (len(output),) is the row of the source that each of the output came from, if known.
    """
    actual, row = undone(output, plan.path_passes, plan.context)
    found = linked(source, actual, None if owner is None else owner[row])
    distance, owner = np.full(len(output), np.nan), np.full(len(output), -1)
    np.fmax.at(distance, row, found.distance[1])
    owner[row[::-1]] = found.row[::-1]
    belongs = Linked((found.distance[0], distance), owner, found.parted)
    with in_force(replace(plan.limits or limits(), rows=MANY)):  # a program is one window here
        step = changed_by(source, plan.path_passes, plan.context)
        return Outcome(belongs, step, _error(plan, source))


def _error(plan: Plan, source: Toolpath) -> Floats | None:
    """Return how far (mm) a machine would be off with what is not compensated, for each block."""
    path = source
    for step in plan.path_passes:
        if COMPENSATED in step.ensures:
            actual, row = undone(path, [step], plan.context)
            found = np.full(len(source.blocks.inch), np.nan)
            np.fmax.at(found, path.source, linked(path, actual, row).distance[0])
            return found
        path = step.apply(path.replace(held=path.entry), plan.context)
    return None
