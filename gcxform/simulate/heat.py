"""How far the tool of a machine with errors is from the programmed path, along all of it.

The machine is that of the pass: `undo` of `volumetric`, by which every run is proved. Which move of
the compensated program belongs to which move of the program says its source map.
"""

from __future__ import annotations

import os
from dataclasses import replace

import numpy as np

from gcxform.api import Program
from gcxform.deviations.deviation import deviation
from gcxform.deviations.matching import Pieces, cut, moving_rows
from gcxform.diagnostics import InputError, UsageError
from gcxform.pipeline.pipeline import Pipeline, Result
from gcxform.simulate.positions import parts_of
from gcxform.system.arrays import Flags, Floats, Ints
from gcxform.toolpath.path import Kind, Toolpath
from gcxform.toolpath.splines import points_on_splines
from gcxform.values import dataclass

PIECES = 4000  # the path is divided into about so many, at least
MANY = 1000  # splines
SPLINE = 500  # points of a spline to which others are compared
NEAR = 0.1  # mm; ends that are so much farther off than the nearest may be the same end


@dataclass(frozen=True, eq=False)
class Heat:
    """Pieces of the programmed path and how far the tool is from each of them.

    start, end  (n, 3) mm, positions of the program
    deviation   (n,) mm, an upper bound over the piece; of a rapid, of its end
    rapid       (n,) whether the piece is of a rapid
    line        (n,) the executed line, from 1, of the program's move that it belongs to
    worst_at    the place of the worst in words: line 12, line 3 of sub.nc
    """

    start: Floats
    end: Floats
    deviation: Floats
    rapid: Flags
    line: Ints
    worst_at: str = ""

    @property
    def worst(self) -> int | None:
        """The piece that is farthest off, of what is no rapid; None if there is nothing else."""
        feeds = np.flatnonzero(~self.rapid)
        return int(feeds[np.argmax(self.deviation[feeds])]) if len(feeds) else None

    def placed(self, program: Program) -> Heat:
        """Return the same with the place of the worst in the files of a program."""
        if self.worst is None:
            return self
        file, line = program.place_of(int(self.line[self.worst]))
        beside = "" if file == program.name else f" of {os.path.basename(file)}"
        return replace(self, worst_at=f"line {line}{beside}")

    @property
    def largest(self) -> float:
        """The largest deviation in mm of what is no rapid; 0 if there is nothing else."""
        return float(self.deviation[~self.rapid].max(initial=0.0))


def before_and_after(program: Program, pipeline: Pipeline) -> tuple[Heat, Heat, Result]:
    """Return the deviations of a program as it is and as the pipeline writes it, and that.

    The last step of the pipeline is the one that compensates. Raises GcxformError.
    """
    if any(step.demands.joins for step in pipeline.path_passes):
        message = "moves that were joined cannot be compared one by one"
        raise UsageError.one("GX713", message, hint="leave out the pass that joins moves")
    nominal, context = program.path, pipeline.context
    try:
        result = pipeline.run(program.executed, name=program.name)
        bare = _bare(nominal, pipeline)
    except InputError as error:
        raise program.located(error) from None
    written = Program(result.text, pipeline.target, program.reading, program.name).path
    line = np.array(result.source_map, dtype=np.int64)
    for step in reversed(pipeline.path_passes):
        written = step.undo(written, context)
    before = deviations(nominal, bare, _same_moves(nominal, bare))
    after = deviations(nominal, written, owners(nominal, written, line))
    return before.placed(program), after.placed(program), result


def _bare(path: Toolpath, pipeline: Pipeline) -> Toolpath:
    """Return what the machine does with a path that its last step does not compensate."""
    for step in pipeline.path_passes[:-1]:
        path = step.apply(path, pipeline.context)
    return pipeline.path_passes[-1].undo(path, pipeline.context)


def deviations(nominal: Toolpath, actual: Toolpath, owner: Ints) -> Heat:
    """Return how far a machine's path is from the programmed one.

    `owner` (len(actual),) is the row of the programmed path that each move belongs to, or -1.
    """
    rows = np.flatnonzero(owner >= 0)
    nominal, actual, owner = _linear(nominal), _linear(actual), owner[rows]
    spacing = max(_length(nominal) / PIECES, 1e-6)
    row, high = parts_of(actual, spacing)
    low = np.where(np.append(True, row[1:] != row[:-1]), 0.0, np.append(0.0, high[:-1]))
    which = np.searchsorted(rows, row)
    fine = cut(actual, Pieces(row, low, high))
    found = deviation(nominal, fine, owner[which]).distance
    _see_splines(nominal, fine, owner[which], found)
    start, end = fine.start, fine.end
    known = np.isfinite(start).all(axis=1) & np.isfinite(end).all(axis=1) & np.isfinite(found)
    rapid = nominal.kind[owner[which]] == Kind.RAPID
    line = nominal.source[owner[which]] + 1
    return Heat(start[known], end[known], found[known], rapid[known], line[known])


def _see_splines(nominal: Toolpath, fine: Toolpath, owner: Ints, found: Floats) -> None:
    """Lower the deviations of moves along splines, in place, to those of their own ends.

    What is proved of a spline is one figure for all of it; a picture shows where on it. Of very
    many splines each is short, and the one figure is good enough.
    """
    splines = np.unique(owner[nominal.is_spline[owner]])
    for row in splines.tolist() if len(splines) <= MANY else ():
        rows = np.flatnonzero(owner == row)
        part = np.linspace(0.0, 1.0, SPLINE)
        curve = points_on_splines(nominal, np.full(SPLINE, row), part)
        for some in np.array_split(rows, 1 + len(rows) // SPLINE):
            away = [_distance(points[some], curve) for points in (fine.start, fine.end)]
            found[some] = np.minimum(found[some], np.maximum(*away))


def _distance(points: Floats, curve: Floats) -> Floats:
    """Return how far points (n, 3) are from a curve of short lines (k, 3), mm."""
    start, way = curve[:-1], np.diff(curve, axis=0)
    from_start = points[:, None] - start
    square = np.maximum((way**2).sum(axis=1), 1e-30)
    part = np.clip((from_start * way).sum(axis=2) / square, 0.0, 1.0)
    away = from_start - part[:, :, None] * way
    return np.asarray(np.sqrt((away**2).sum(axis=2).min(axis=1)))


def _linear(path: Toolpath) -> Toolpath:
    """Return a path in X, Y and Z alone."""
    end = np.asfortranarray(path.end[:, :3])
    return path.replace(axes="XYZ", end=end, entry=path.entry[:3].copy())


def _length(path: Toolpath) -> float:
    return float(np.nan_to_num(np.abs(path.end - path.start)).sum())


def _same_moves(nominal: Toolpath, cut_up: Toolpath) -> Ints:
    """Return the row of a path that each row belongs to of the same path cut up by passes."""
    first = np.searchsorted(nominal.source, cut_up.source, side="left")
    return np.asarray(first + cut_up.nth)


def owners(nominal: Toolpath, written: Toolpath, line_of: Ints) -> Ints:
    """Return the row of the nominal path (n,) that each row of a written path belongs to, or -1.

    `line_of` holds the line of the program for each line that was written. Mostly a line is one
    move. Where it is several, a canned cycle for instance, their ends are looked for in order.
    """
    line = line_of[written.source]
    first = np.searchsorted(nominal.source, line, side="left")
    count = np.searchsorted(nominal.source, line, side="right") - first
    owner = np.where(count > 0, first, -1)
    moving = moving_rows(nominal)
    for several in np.unique(line[count > 1]).tolist():
        theirs = np.flatnonzero(line == several)
        ours = moving[nominal.source[moving] == several]
        if len(ours):
            owner[theirs] = ours[in_order(nominal.end[ours, :3], written.end[theirs, :3])]
    return owner


def in_order(ends: Floats, others: Floats) -> Ints:
    """Return to which of the ends (m, 3) each of the others (n, 3) belongs or leads, in order."""
    found = np.full(len(others), len(ends) - 1)
    begin = 0
    for k, end in enumerate(ends):
        stop = max(begin + 1, len(others) - (len(ends) - 1 - k))
        far = np.nan_to_num(np.abs(others[begin:stop] - end)).max(axis=1)
        if not len(far):
            break
        after = begin + int(np.argmax(far <= far.min() + NEAR)) + 1
        found[begin:after] = k
        begin = after
    return found
