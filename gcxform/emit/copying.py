"""Which lines are copied: those whose bytes say to the control what the path says."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from gcxform.diagnostics import InputError
from gcxform.emit.manner import Believed, Task
from gcxform.emit.pieces import Pieces
from gcxform.emit.positions import Positions, as_written
from gcxform.toolpath.path import Form

Ints = NDArray[np.int64]
Flags = NDArray[np.bool_]

EXACT = 1e-9  # mm; closer values are the same number
WHAT = {
    Form.CYCLE: "a canned cycle",
    Form.HOME: "a return to reference",
    Form.MACHINE: "a move in machine coordinates",
    Form.PROBE: "a probing move",
    Form.SYNCHRONISED: "a move tied to the spindle",
}
HINTS = {Form.CYCLE: 'put the pass "cycles" before'}


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
        stands = self._standing(old_count, pieces)
        self._refuse_changed(stands, pieces)
        self._refuse_presets()
        if task.manner.crossing:
            self.lines &= self._nothing_to_say()
        else:
            self.lines &= self._same_modes()
            self.lines |= stands
        if self.path.folded:
            self.lines[self.task.table.flag("framing", self.task.shape)] = False
        self.lines[pieces.line[pieces.repaired]] = False
        self._skipped()

    def _refuse_changed(self, stands: Flags, pieces: Pieces) -> None:
        """Refuse blocks that move in a way of their own and would have to move otherwise."""
        wrong = np.unique(pieces.line[pieces.special & ~stands[pieces.line]])
        if not len(wrong):
            return
        form = Form(int(self.path.form[np.searchsorted(self.path.block, wrong[0])]))
        hint = HINTS.get(form, "leave it as it is, or take it out of the program")
        message = f"{WHAT[form]} would have to be written otherwise than it stands"
        raise InputError.one("GX506", message, self.task.location(int(wrong[0])), hint)

    def _refuse_presets(self) -> None:
        """Refuse blocks that set coordinates from where the axes stand if they stand elsewhere."""
        if self.path.folded:
            return
        for line in np.flatnonzero(self.task.table.flag("presets", self.task.shape)).tolist():
            now = np.searchsorted(self.path.block, line) - 1
            was = np.searchsorted(self.original.block, line) - 1
            if now < 0 or was < 0 or self.exact[now]:
                continue
            gap = np.abs(self.positions.after[now] - self.original.end[was])
            if (gap > EXACT).any():
                message = "this block counts from where the axes stand, and they stand elsewhere"
                hint = 'put the pass "offsets" before'
                raise InputError.one("GX506", message, self.task.location(line), hint)

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

    def _standing(self, old_count: Ints, pieces: Pieces) -> Flags:
        """Return the lines whose rows are those of the source and need no other words."""
        stands = np.zeros(len(old_count), np.bool_)
        special = np.zeros(len(old_count), np.bool_)
        special[self.original.block[self.original.form != Form.PLAIN]] = True
        paired = (old_count == pieces.count) & ((old_count == 1) | special) & (old_count > 0)
        rows = np.flatnonzero(paired[self.path.block])
        others = np.flatnonzero(paired[self.original.block])
        if not len(rows):
            return stands
        lines = self.path.block[rows]
        good = self._same_modes()[lines]
        if not self.task.manner.crossing:
            good &= special[lines] | ~pieces.repaired_in(lines)
        good &= self.path.form[rows] == self.original.form[others]
        good &= self.path.kind[rows] == self.original.kind[others]
        good &= pieces.kind[rows] == as_written(self.original, self.original.kind)[others]
        plain = self.path.form[rows] == Form.PLAIN
        good &= ~plain | self._same_ends(rows, others)
        own = np.flatnonzero(~plain)
        if len(own):
            good[own] &= self._same_words(rows[own], others[own])
        good &= ~plain | self._same_frames(rows, others)
        starts_exact = self._track_exactness(rows, others, good)
        incremental = self.path.blocks.incremental[self.path.block[rows]]
        doubtful = np.flatnonzero(good & plain & incremental & ~starts_exact)
        if len(doubtful):
            good[doubtful] &= self._starts_alike(rows[doubtful], others[doubtful])
        arcs = np.flatnonzero(good & self.path.is_arc[rows])
        if len(arcs):
            good[arcs] &= self._same_arcs(rows[arcs], others[arcs], starts_exact[arcs])
        stands[self.path.block[rows]] = True
        stands[self.path.block[rows[~good]]] = False
        return stands

    def _same_ends(self, rows: Ints, others: Ints) -> Flags:
        """Return which rows end where their source ends and need no word it does not have."""
        good = np.ones(len(rows), np.bool_)
        words, original = self.positions.end, self.original.words
        for k in range(len(self.path.axes)):
            end, old = _take(words[:, k], rows), _take(original[:, k], others)
            held = _take(self.positions.held[:, k], rows)
            programmed = _take(self.positions.programmed[:, k], rows)
            same = (np.abs(held - old) <= EXACT) | (end == old)
            good &= np.where(programmed, same, ~_take(self.positions.write[:, k], rows))
            if not good.any():
                break
        return good

    def _same_words(self, rows: Ints, others: Ints) -> Flags:
        """Return which rows of blocks that move in their own way need no other words.

        They end where those of the source end, or go as far where distances are programmed; an axis
        that stands still may stand elsewhere.
        """
        end, old = self.path.end[rows], self.original.end[others]
        way, old_way = end - self.path.start[rows], old - self.original.start[others]
        unknown = np.isnan(end) & np.isnan(old)
        same = (np.abs(end - old) <= EXACT) | unknown
        incremental = self.path.blocks.incremental[self.path.block[rows]][:, None]
        still = np.abs(old_way) <= EXACT
        cycle = (self.path.form[rows] == Form.CYCLE)[:, None]
        as_far = (np.abs(way - old_way) <= EXACT) & (incremental | (still & ~cycle))
        good = (same | as_far).all(axis=1)
        if self.path.frames == self.original.frames:
            return np.asarray(good)
        words, before = self.positions.end[rows], self.original.words[others]
        alike = (np.abs(words - before) <= EXACT) | (np.isnan(words) & np.isnan(before))
        framed = (self.path.form[rows] == Form.HOME) & (self.path.nth[rows] == 0)
        return np.asarray(good & (alike.all(axis=1) | incremental[:, 0] | ~(framed | cycle[:, 0])))

    def _same_frames(self, rows: Ints, others: Ints) -> Flags | bool:
        """Return which rows are in frames that turn words as those of the source did."""
        if self.path.frames == self.original.frames:
            return np.asarray(self.path.frame[rows] == self.original.frame[others])
        turns: dict[object, int] = {}
        now, before = (
            np.array([turns.setdefault((f.matrix, f.diameter, f.polar), len(turns)) for f in some])
            for some in (self.path.frames, self.original.frames)
        )
        return np.asarray(now[self.path.frame[rows]] == before[self.original.frame[others]])

    def _starts_alike(self, rows: Ints, others: Ints) -> Flags:
        """Return which rows begin where their source begins, in the axes that the block names."""
        start = self.original.in_frames(self.original.start)[others]
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
        alike = starts_exact.copy()
        off = np.flatnonzero(~starts_exact)
        if len(off):
            start = self.original.in_frames(self.original.start)[others[off]]
            on_grid = np.abs(self.positions.before[rows[off]] - start) <= EXACT
            alike[off] = (on_grid | np.isnan(start)).all(axis=1)
        centre, old = self.path.centre[rows], self.original.centre[others]
        if self.path.blocks.absolute_centre.any():
            centre = self.path.local(self.path.centre)[rows]
            old = self.original.local(self.original.centre)[others]
        same_centre = ((centre == old) | np.isnan(old)).all(axis=1)
        same_sweep = self.path.sweep[rows] == self.original.sweep[others]
        return np.asarray(alike & same_centre & same_sweep)


def _take(column: NDArray[Any], rows: Ints) -> NDArray[Any]:
    """Return a column at rows; all of it if the rows are all."""
    return column if len(rows) == len(column) else column[rows]
