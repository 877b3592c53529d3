"""How far the tool of a machine with errors is from the programmed path, along all of it.

The machine is that of the pass: `undo` of `volumetric`, by which every run is proved. Which piece
of the machine's path belongs to which piece of the program is found as `compare` finds it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gcxform.api import REACH, STRAIGHT, TOLERANCE, Program
from gcxform.contract import Pass
from gcxform.diagnostics import InputError
from gcxform.machine.errors import FloatArray
from gcxform.pipeline import Pipeline, Result
from gcxform.toolpath.matching import Matching, Pieces, cut, match, measure
from gcxform.toolpath.path import Kind, Toolpath
from gcxform.toolpath.splines import straightened

PIECES = 4000  # the path is divided into about so many, at least


@dataclass(frozen=True, eq=False)
class Heat:
    """Pieces of the programmed path and how far the tool is from each of them.

    start, end  (n, 3) mm, positions of the program
    deviation   (n,) mm, an upper bound over the piece; of a rapid, of its end
    rapid       (n,) whether the piece is of a rapid
    """

    start: FloatArray
    end: FloatArray
    deviation: FloatArray
    rapid: NDArray[np.bool_]

    @property
    def largest(self) -> float:
        """The largest deviation in mm of what is no rapid; 0 if there is nothing else."""
        return float(self.deviation[~self.rapid].max(initial=0.0))


def before_and_after(program: Program, pipeline: Pipeline) -> tuple[Heat, Heat, Result]:
    """Return the deviations of a program as it is and as the pipeline writes it, and that.

    The last step of the pipeline is the one that compensates. Raises InputError.
    """
    result = pipeline.run(program.text)
    written = Program(result.text, pipeline.target, program.reading, program.name)
    step = pipeline.path_passes[-1]
    before = deviations(program.path, step.undo(program.path, pipeline.context))
    after = deviations(program.path, _machine(written, step, pipeline))
    return before, after, result


def _machine(written: Program, step: Pass, pipeline: Pipeline) -> Toolpath:
    return step.undo(written.path, pipeline.context)


def deviations(nominal: Toolpath, actual: Toolpath) -> Heat:
    """Return how far a machine's path is from the programmed one. Raises InputError if not near."""
    axes = nominal.axes
    assert axes == actual.axes
    nominal, actual = straightened(nominal, STRAIGHT), straightened(actual, STRAIGHT)
    found = match(nominal, actual, TOLERANCE, REACH)
    if found.parted is not None:
        line = int(nominal.source[max(found.parted[0], 0)]) + 1
        message = f"the machine is more than {REACH:g} mm from the program after line {line}"
        raise InputError.one("GX313", message)
    length = float(np.nan_to_num(np.abs(nominal.end - nominal.start)[:, :3]).sum())
    fine = divided(found, nominal, max(length, 1e-6) / PIECES)
    distance = measure(nominal, actual, fine).distance
    pieces = cut(nominal, fine.a)
    start, end = pieces.start[:, :3], pieces.end[:, :3]
    known = ~np.isnan(start).any(axis=1) & ~np.isnan(end).any(axis=1) & ~np.isnan(distance)
    rapid = pieces.kind == Kind.RAPID
    return Heat(start[known], end[known], distance[known], rapid[known])


def divided(found: Matching, nominal: Toolpath, spacing: float) -> Matching:
    """Return the same pairs in parts, so that pieces of the nominal path are `spacing` mm long."""
    way = np.nan_to_num(nominal.end - nominal.start)[:, :3]
    length = np.sqrt((way**2).sum(axis=1))
    if nominal.has_arcs:
        arcs = np.flatnonzero(nominal.is_arc)
        around = nominal.end[arcs, :3] - nominal.centre[arcs]
        radius = np.sqrt((np.nan_to_num(around) ** 2).sum(axis=1))
        length[arcs] = np.maximum(length[arcs], radius * nominal.sweep[arcs])
    size = length[found.a.row] * (found.a.high - found.a.low)
    count = np.maximum(np.ceil(size / spacing), 1.0).astype(np.int64)
    owner = np.repeat(np.arange(len(count)), count)
    nth = np.arange(len(owner)) - np.repeat(np.cumsum(count) - count, count)
    low, high = nth / count[owner], (nth + 1) / count[owner]
    return Matching(_parts(found.a, owner, low, high), _parts(found.b, owner, low, high))


def _parts(side: Pieces, owner: NDArray[np.int64], low: FloatArray, high: FloatArray) -> Pieces:
    """Return parts of pieces, from 0 to 1 of each; the last ends where its piece does."""
    first, width = side.low[owner], (side.high - side.low)[owner]
    last = np.where(high == 1.0, side.high[owner], first + high * width)
    return Pieces(side.row[owner], first + low * width, last)
