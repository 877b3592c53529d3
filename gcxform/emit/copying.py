"""Which lines are copied: those whose bytes say to the control what the path says."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from gcxform.diagnostics import InputError
from gcxform.emit.manner import Believed, Task
from gcxform.emit.pieces import Pieces
from gcxform.emit.positions import Positions

Ints = NDArray[np.int64]
Flags = NDArray[np.bool_]

EXACT = 1e-9  # mm; closer values are the same number


class Copying:
    """Decides, line by line, whether the source text may stand.

    `lines` (live,): the line is copied. `exact` (rows,): after the row the control stands exactly
    where the source program put it, because everything so far was copied.
    """

    def __init__(
        self, task: Task, pieces: Pieces, positions: Positions, believed: Believed
    ) -> None:
        self.task = task
        self.positions = positions
        self.path, self.original = task.path, task.read.path
        live = task.read.live
        old_count = np.bincount(self.original.block, minlength=live)
        self.exact = np.zeros(len(self.path), np.bool_)
        self.believed_exact = believed.exact
        self.lines = (old_count == 0) & (pieces.count == 0)
        if task.manner.crossing:
            self.lines &= self._nothing_to_say()
            self.lines[pieces.line[pieces.repaired]] = False
        else:
            may = self._same_modes()
            may[pieces.line[pieces.repaired]] = False
            self.lines &= may
            self._rows(old_count, pieces, may)
        if self.path.blocks.uncompensated:
            self.lines &= ~self.task.table.flag("compensates", self.task.shape)
        self._skipped()

    def _skipped(self) -> None:
        """Copy the blocks that the control skips; another control might not skip them."""
        skipped = self.task.window.shape[: len(self.task.shape)] != self.task.shape
        if skipped.any() and self.task.manner.crossing:
            where = self.task.location(int(np.argmax(skipped)))
            message = "a block that is skipped cannot be taken into another dialect"
            raise InputError.one("GX501", message, where, "leave the block out of the program")
        self.lines |= skipped

    def _nothing_to_say(self) -> Flags:
        """Return the lines without any item: the same in every dialect."""
        shapes = self.task.table.shapes.shapes
        empty = np.array([not shape.block.items for shape in shapes], np.bool_)
        return np.asarray(empty[self.task.shape])

    def _same_modes(self) -> Flags:
        now, old = self.path.blocks, self.original.blocks
        return np.asarray(
            (now.inch == old.inch)
            & (now.incremental == old.incremental)
            & (now.absolute_centre == old.absolute_centre)
        )

    def _rows(self, old_count: Ints, pieces: Pieces, may: Flags) -> None:
        """Add the lines that have one row, as in the source, which means the same."""
        single = (old_count == 1) & (pieces.count == 1)
        rows = np.flatnonzero(single[self.path.block])
        others = np.flatnonzero(single[self.original.block])
        if not len(rows):
            return
        good = may[self.path.block[rows]]
        good &= self.path.kind[rows] == self.original.kind[others]
        good &= pieces.kind[rows] == self.original.kind[others]
        good &= self._same_ends(rows, others)
        starts_exact = self._track_exactness(rows, others, good)
        incremental = self.path.blocks.incremental[self.path.block[rows]]
        good &= ~incremental | starts_exact | self._starts_alike(rows, others)
        if self.path.has_arcs:
            good &= ~self.path.is_arc[rows] | self._same_arcs(rows, others, starts_exact)
        self.lines[self.path.block[rows[good]]] = True

    def _same_ends(self, rows: Ints, others: Ints) -> Flags:
        """Return which rows end where their source ends and need no word it does not have."""
        good = np.ones(len(rows), np.bool_)
        for k in range(len(self.path.axes)):
            end, old = _take(self.path.end[:, k], rows), _take(self.original.end[:, k], others)
            held = _take(self.positions.held[:, k], rows)
            programmed = _take(self.positions.programmed[:, k], rows)
            same = (np.abs(held - old) <= EXACT) | (end == old)
            good &= np.where(programmed, same, ~_take(self.positions.write[:, k], rows))
            if not good.any():
                break
        return good

    def _starts_alike(self, rows: Ints, others: Ints) -> Flags:
        """Return which rows begin where their source begins, in the axes that the block names."""
        start = self.original.start[others]
        same = np.abs(self.positions.before[rows] - start) <= EXACT
        return np.asarray((same | ~self.positions.programmed[rows]).all(axis=1))

    def _track_exactness(self, rows: Ints, others: Ints, good: Flags) -> Flags:
        """Follow how far everything is exactly as in the source; return where rows start so."""
        whole = len(rows) == len(self.path) == len(self.original)
        if not whole or not good[0] or not self.believed_exact:
            return np.zeros(len(rows), np.bool_)
        end, old = self.path.end, self.original.end
        alike = ((end == old) | (np.isnan(end) & np.isnan(old))).all(axis=1) & good
        self.exact = np.logical_and.accumulate(alike)
        return np.append(True, self.exact[:-1])

    def _same_arcs(self, rows: Ints, others: Ints, starts_exact: Flags) -> Flags:
        """Return which arcs have centre and sweep of their source, seen from where they start."""
        start = self.original.start[others]
        on_grid = (np.abs(self.positions.before[rows] - start) <= EXACT) | np.isnan(start)
        centre, old = self.path.centre[rows], self.original.centre[others]
        same_centre = ((centre == old) | np.isnan(old)).all(axis=1)
        same_sweep = self.path.sweep[rows] == self.original.sweep[others]
        return np.asarray((starts_exact | on_grid.all(axis=1)) & same_centre & same_sweep)


def _take(column: NDArray[Any], rows: Ints) -> NDArray[Any]:
    """Return a column at rows; all of it if the rows are all."""
    return column if len(rows) == len(column) else column[rows]
