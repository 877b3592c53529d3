"""What a pipeline did with a program, move by move: how far off, which error, which step."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from gcxform.contract.passes import resolved
from gcxform.pipeline.plan import Plan
from gcxform.system.arrays import Floats, Ints
from gcxform.system.limits import in_force, limits
from gcxform.toolpath.facts import COMPENSATED
from gcxform.toolpath.path import Toolpath
from gcxform.values import dataclass
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
    with in_force(replace(plan.limits or limits(), rows=MANY)):  # a program is one window here
        belongs = _belongs(plan, source, output, owner)
        step = changed_by(source, plan.path_passes, plan.context)
        return Outcome(belongs, step, _error(plan, source))


def _belongs(plan: Plan, source: Toolpath, output: Toolpath, owner: Ints | None) -> Linked:
    """Return which moves belong together; a pass that resolves makes the path that is compared."""
    count = resolved(plan.path_passes)
    meant = source
    for step in plan.path_passes[:count]:
        meant = step.apply(meant.replace(held=meant.entry), plan.context)
    actual, row = undone(output, plan.path_passes[count:], plan.context)
    found = linked(meant, actual, owner[row] if owner is not None and not count else None)
    ours = np.searchsorted(source.source, meant.source) if count else np.arange(len(source))
    ours = np.minimum(ours, max(len(source) - 1, 0))
    before, after = np.full(len(source), np.nan), np.full(len(output), np.nan)
    np.fmax.at(before, ours, found.distance[0])
    np.fmax.at(after, row, found.distance[1])
    which = np.full(len(output), -1)
    known = found.row >= 0
    which[row[known][::-1]] = ours[found.row[known]][::-1]
    return Linked((before, after), which, found.parted)


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
