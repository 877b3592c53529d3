"""Which rows say the same as those of the source that they stand for: ends, words, frames, arcs."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from gcxform.emit.positions import Positions
from gcxform.system.arrays import Flags, Floats, Ints
from gcxform.system.distinct import one_of
from gcxform.toolpath.frames import Frame, by_frame
from gcxform.toolpath.path import Form, Toolpath

OWN_PLACES = (Form.CYCLE, Form.SPLINE, Form.NURBS, Form.PASSES, Form.TILTED)
EXACT = 1e-9  # mm; closer values are the same number


class SameRows:
    """Compares rows of a path with rows of the path as read.

    `rows` (n,) are of the first and `others` (n,) of the second; `polar` says of each frame whether
    words are radius and angle.
    """

    def __init__(self, path: Toolpath, original: Toolpath, positions: Positions) -> None:
        self.path = path
        self.original = original
        self.positions = positions
        self.polar = np.array([frame.polar for frame in path.frames], np.bool_)

    def units(self) -> Flags:
        """Return which lines of the window are written in the unit of their source."""
        return np.asarray(self.path.blocks.inch == self.original.blocks.inch)

    def modes(self) -> Flags:
        """Return which lines are written in the modes of their source that words depend on."""
        now, old = self.path.blocks, self.original.blocks
        return np.asarray(
            self.units()
            & (now.incremental == old.incremental)
            & (now.extruded == old.extruded)
            & (now.absolute_centre == old.absolute_centre)
        )

    def ends(self, rows: Ints, others: Ints) -> Flags:
        """Return which rows end where their source ends and need no word it does not have."""
        good = np.ones(len(rows), np.bool_)
        words, original = self.positions.end, self._old_words(rows, others)
        polar = self.polar[_take(self.path.frame, rows)]
        unshifted = self._unshifted(rows, others)
        for k in range(len(self.path.axes)):
            end, old = _take(words[:, k], rows), original[:, k]
            held = _take(self.positions.held[:, k], rows)
            programmed = _take(self.positions.programmed[:, k], rows)
            same = (np.abs(held - old) <= EXACT) | (end == old)
            same |= np.isnan(end) & np.isnan(old) & unshifted[:, k]  # the machine knows the word
            left = ~_take(self.positions.write[:, k], rows)
            left |= polar & (end == old)  # one word moves two axes: it says both
            good &= np.where(programmed, same, left)
            if not good.any():
                break
        return good

    def words(self, rows: Ints, others: Ints) -> Flags:
        """Return which rows of blocks that move in their own way need no other words.

        They end where those of the source end, or go as far where distances are programmed; an axis
        that stands still may stand elsewhere.
        """
        end, start = self.path.end[rows], self.path.start[rows]
        old = _where_left(self.original.end[others], end)
        way, old_way = end - start, old - _where_left(self.original.start[others], start)
        unknown = np.isnan(end) & np.isnan(old)
        same = (np.abs(end - old) <= EXACT) | unknown
        incremental = self.path.steps[rows]
        still = np.abs(old_way) <= EXACT
        cycle = one_of(self.path.form[rows], OWN_PLACES)[:, None]
        as_far = (np.abs(way - old_way) <= EXACT) & (incremental | (still & ~cycle))
        good = (same | as_far | self._other_axes(rows, others)).all(axis=1)
        if self.path.frames == self.original.frames:
            return np.asarray(good)
        good &= self._diameters(rows, others) & self._polar_alike(rows, others)
        words, before = self.positions.end[rows], self.original.words[others]
        alike = (np.abs(words - before) <= EXACT) | (np.isnan(words) & np.isnan(before))
        one_move = one_of(self.path.form[rows], (Form.PROBE, Form.SYNCHRONISED))
        alike |= one_move[:, None] & ~self.positions.programmed[rows]
        framed = (self.path.form[rows] == Form.HOME) & (self.path.nth[rows] == 0)
        framed |= one_move | cycle[:, 0]
        nowhere = still.all(axis=1)  # which is the same in all frames: G91 G28 Z0
        as_far = incremental[:, 0] & (self.frames(rows, others) | nowhere)
        blind = self.path.form[rows] == Form.BLIND
        return np.asarray(good & ((alike.all(axis=1) & ~blind) | as_far | ~(framed | blind)))

    def frames(self, rows: Ints, others: Ints) -> Flags | bool:
        """Return which rows are in frames that turn words as those of the source did."""
        if self.path.frames == self.original.frames:
            return np.asarray(self.path.frame[rows] == self.original.frame[others])
        turns: dict[object, int] = {}
        now, before = (
            np.array([turns.setdefault((f.matrix, f.diameter, f.polar), len(turns)) for f in some])
            for some in (self.path.frames, self.original.frames)
        )
        return np.asarray(now[self.path.frame[rows]] == before[self.original.frame[others]])

    def starts(self, rows: Ints, others: Ints) -> Flags:
        """Return which rows begin where their source begins, in the axes that count for them."""
        start = self._in_frames(self.original.start, rows, others)
        same = np.abs(self.positions.before[rows] - start) <= EXACT
        plain = (self.path.form[rows] == Form.PLAIN)[:, None]
        unnamed = ~self.positions.programmed[rows] | (plain & ~self.path.steps[rows])
        thread = (self.path.form[rows] == Form.PASSES)[:, None]  # its start has no words
        same |= thread & np.isnan(start) & np.isnan(self.positions.before[rows])
        inner = (self.path.form[rows] == Form.TILTED) & (self.path.nth[rows] > 0)  # of one block
        return np.asarray((same | (unnamed & ~thread)).all(axis=1) | inner)

    def arcs(self, rows: Ints, others: Ints, starts_exact: Flags) -> Flags:
        """Return which arcs have centre and sweep of their source, seen from where they start."""
        alike = starts_exact.copy()
        off = np.flatnonzero(~starts_exact)
        if len(off):
            start = self._in_frames(self.original.start, rows[off], others[off])
            on_grid = np.abs(self.positions.before[rows[off]] - start) <= EXACT
            alike[off] = (on_grid | np.isnan(start)).all(axis=1)
        centre, old = self.path.centre[rows], self.original.centre[others]
        if self.path.blocks.absolute_centre.any():
            centre = self.path.local(self.path.centre)[rows]
            old = self.original.local(self.original.centre)[others]
        same_centre = ((centre == old) | np.isnan(old)).all(axis=1)
        same_sweep = self.path.sweep[rows] == self.original.sweep[others]
        return np.asarray(alike & same_centre & same_sweep)

    def _unshifted(self, rows: Ints, others: Ints) -> Flags:
        """Return in which axes (n, axes) words count from where they did, or are distances."""
        frames = self.path.frames, self.original.frames
        if frames[0] == frames[1]:
            return np.broadcast_to(True, (len(rows), len(self.path.axes)))
        now, was = (np.array([frame.shift for frame in some]) for some in frames)
        gap = now[_take(self.path.frame, rows)] - was[_take(self.original.frame, others)]
        return np.asarray((np.abs(gap) <= EXACT) | self.path.steps[rows])

    def _diameters(self, rows: Ints, others: Ints) -> Flags:
        """Return which rows name no X, or are in frames that agree on what X is."""
        now = np.array([frame.diameter for frame in self.path.frames], np.bool_)
        was = np.array([frame.diameter for frame in self.original.frames], np.bool_)
        same = now[self.path.frame[rows]] == was[self.original.frame[others]]
        return np.asarray(same | ~self.positions.programmed[rows, 0])

    def _polar_alike(self, rows: Ints, others: Ints) -> Flags:
        """Return which rows are in frames that agree on whether words are radius and angle."""
        was = np.array([frame.polar for frame in self.original.frames], np.bool_)
        return np.asarray(self.polar[self.path.frame[rows]] == was[self.original.frame[others]])

    def _other_axes(self, rows: Ints, others: Ints) -> Flags | bool:
        """Return which axes of rows are those of another machine, and neither named nor moved."""
        if not self.path.left_out:
            return False
        left = np.array([axis in self.path.left_out for axis in self.path.axes])
        way = self.path.end[rows] - self.path.start[rows]
        before = self.original.start[others], self.original.end[others]
        new = np.isnan(before[0]) & np.isnan(before[1]) & (np.abs(way) <= EXACT)
        return np.asarray((left & ~self.positions.programmed[rows]) | new)

    def _old_words(self, rows: Ints, others: Ints) -> Floats:
        """Return the ends of source rows as programmed; distances count in any frame."""
        words = _take(self.original.words, others)
        distance = self.path.steps[rows]
        if self.path.frames == self.original.frames or not distance.any():
            return words
        return np.where(distance, self._in_frames(self.original.end, rows, others), words)

    def _in_frames(self, positions: Floats, rows: Ints, others: Ints) -> Floats:
        """Return positions of source rows in the frames of the rows that stand for them."""
        frame = _take(self.path.frame, rows)
        return by_frame(Frame.words, self.path.frames, frame, _take(positions, others), -1.0)


def _where_left(old: Floats, now: Floats) -> Floats:
    """Return positions of the source; those that only a pass knows (inf) are as it has them."""
    return np.where(np.isinf(old), now, old)


def _take(column: NDArray[Any], rows: Ints) -> NDArray[Any]:
    """Return a column at rows; all of it if the rows are all."""
    return column if len(rows) == len(column) else column[rows]
