"""Which lines are copied: those whose bytes say to the control what the path says."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from gcxform.diagnostics import InputError
from gcxform.dialect.dialect import LINEAR
from gcxform.emit.converting import convertible
from gcxform.emit.manner import Believed, Task
from gcxform.emit.pieces import Pieces
from gcxform.emit.positions import Positions, as_written
from gcxform.emit.stated import Stated
from gcxform.emit.tapping import Taps
from gcxform.modal.columns import fill
from gcxform.modal.meaning.meaning import FRAMING
from gcxform.modal.meaning.tables import GROUPS
from gcxform.system.arrays import Flags, Floats, Ints
from gcxform.system.distinct import distinct
from gcxform.toolpath.angles import TURN
from gcxform.toolpath.frames import Frame, by_frame
from gcxform.toolpath.path import Form

EXACT = 1e-9  # mm; closer values are the same number
WHAT = {
    Form.CYCLE: "a canned cycle",
    Form.HOME: "a return to reference",
    Form.MACHINE: "a move in machine coordinates",
    Form.PROBE: "a probing move",
    Form.SYNCHRONISED: "a move tied to the spindle",
    Form.SPLINE: "a spline",
    Form.THREAD: "a thread",
}
HINTS = {
    Form.CYCLE: 'put the pass "cycles" before',
    Form.SPLINE: 'put the pass "segment" before',
    Form.PROBE: "leave the pass out that changes its coordinates: what it finds counts in them",
}


class Copying:
    """Decides, line by line, whether the source text may stand.

    `lines` (live,): the line is copied. `exact` (rows,): after the row the control stands exactly
    where the source program put it, because everything so far was copied.
    """

    def __init__(
        self,
        task: Task,
        pieces: Pieces,
        stated: Stated,
        taps: Taps,
        positions: Positions,
        believed: Believed,
    ) -> None:
        self.task = task
        self.positions = positions
        self.path, self.original = task.path, task.read.path
        live = task.read.live
        old_count = np.bincount(self.original.block, minlength=live)
        self.exact = np.zeros(len(self.path), np.bool_)
        self.believed_exact = believed.exact
        self.believed_said = believed.said
        self.believed_position = believed.position
        self._polar = np.array([frame.polar for frame in self.path.frames], np.bool_)
        self.lines = (old_count == 0) & (pieces.count == 0) & ~pieces.expanded_line
        self.converted = np.zeros(live, np.bool_)
        stands = self._standing(old_count, pieces, stated)
        self._refuse_changed(stands, pieces)
        self._refuse_presets()
        self._refuse_lengths()
        if task.manner.crossing:
            self.lines &= self._nothing_to_say()
        else:
            self.lines &= self._same_modes()
            self.lines |= stands & ~self.converted
        if self.path.folded:
            self.lines[self.task.table.flag("framing", self.task.shape)] = False
        self.lines &= ~self.task.table.flag("switches", self.task.shape)
        self.lines &= ~self._pointed()
        if self.path.blocks.uncompensated:
            self.lines &= ~self.task.table.flag("compensates", self.task.shape)
        self.lines[pieces.line[stated.repaired]] = False
        self.lines &= ~taps.lines
        self._skipped()
        self._refuse_unknown()
        self._refuse_polar()

    def _refuse_changed(self, stands: Flags, pieces: Pieces) -> None:
        """Refuse blocks that move in a way of their own and would have to move otherwise.

        A thread may end elsewhere, but it stays one block in its unit.
        """
        wrong = distinct(pieces.line[pieces.special & ~stands[pieces.line]])
        threads = distinct(self.path.block[self.path.form == Form.THREAD])
        if len(threads):
            other = (pieces.count[threads] != 1) | ~self._same_units()[threads]
            wrong = np.union1d(wrong, threads[other])
        if not len(wrong):
            return
        form = Form(int(self.path.form[np.searchsorted(self.path.block, wrong[0])]))
        hint = HINTS.get(form, "leave it as it is, or take it out of the program")
        message = f"{WHAT[form]} would have to be written otherwise than it stands"
        raise InputError.one("GX506", message, self.task.location(int(wrong[0])), hint)

    def _refuse_unknown(self) -> None:
        """Refuse words that have to be written anew while it is not known what they would be."""
        unknown = self.positions.programmed & np.isnan(self.positions.held)
        unknown[:, [axis in self.path.left_out for axis in self.path.axes]] = False
        anew = ~self.lines[self.path.block] & self.path.is_free
        rows = np.flatnonzero(anew & unknown.any(axis=1))
        if len(rows):
            row = int(rows[0])
            axis = self.path.axes[int(np.argmax(unknown[row]))]
            where = self.task.location(int(self.path.block[row]))
            message = f"the block would be written anew, and where {axis} goes is not known"
            hint = f"program {axis} before, or give a machine file with the offsets"
            raise InputError.one("GX506", message, where, hint)

    def _refuse_polar(self) -> None:
        """Refuse blocks that have to be written anew while words are radius and angle."""
        if not self._polar.any():
            return
        words = self.positions.write[:, :3].any(axis=1) & self._polar[self.path.frame]
        rows = np.flatnonzero(words & ~self.lines[self.path.block])
        if len(rows):
            message = "the block would be written anew, in radius and angle (G16)"
            where = self.task.location(int(self.path.block[rows[0]]))
            raise InputError.one("GX506", message, where, 'put the pass "offsets" before')

    def _refuse_presets(self) -> None:
        """Refuse blocks that set coordinates from where the axes stand if they stand elsewhere."""
        if self.path.folded:
            return
        for line in np.flatnonzero(self.task.table.flag("presets", self.task.shape)).tolist():
            now = np.searchsorted(self.path.block, line) - 1
            was = np.searchsorted(self.original.block, line) - 1
            if self.exact[now] if now >= 0 else self.believed_exact:
                continue
            stands = self.positions.after[now] if now >= 0 else self.believed_position
            gap = np.abs(stands - (self.original.end[was] if was >= 0 else self.original.entry))
            if (gap > EXACT).any():
                message = "this block counts from where the axes stand, and they stand elsewhere"
                hint = 'put the pass "offsets" before'
                raise InputError.one("GX506", message, self.task.location(line), hint)

    def _refuse_lengths(self) -> None:
        """Refuse lengths that codes take for themselves where another unit would be in force."""
        takes = self.task.table.flag("takes_lengths", self.task.shape)
        inch = self.path.blocks.inch != self.original.blocks.inch
        halved = self.path.folded and any(frame.diameter for frame in self.original.frames)
        for line in np.flatnonzero(takes & (inch | halved)).tolist():
            for name, address in self._lengths_kept(line):
                if inch[line] or address == "X":
                    message = f"{address} of {name} would have to be written in another unit"
                    hint = "leave the block out, or let the CAM system write it so"
                    if (name, address) not in self._lengths_left(line):
                        hint = 'put the pass "offsets" before'
                    elif address == "D":
                        hint = 'put the pass "cutter-comp" before'
                    raise InputError.one("GX506", message, self.task.location(line), hint)

    def _lengths_left(self, line: int) -> list[tuple[str, str]]:
        """Return what of those lengths folding would leave."""
        meaning = self.task.table.meanings[int(self.task.shape[line])]
        framing = {act.code for act in meaning.acts if act.name in FRAMING}
        return [(name, address) for name, address, _ in meaning.lengths if name not in framing]

    def _lengths_kept(self, line: int) -> list[tuple[str, str]]:
        """Return code and address of lengths, not 0, that codes of a line take and that stay."""
        window, first = self.task.window, int(self.task.window.first_number[line])
        meaning = self.task.table.meanings[int(self.task.shape[line])]
        folded = {act.code for act in meaning.acts if act.name in FRAMING and self.path.folded}
        if self.path.blocks.uncompensated:
            folded.add(meaning.groups.get("cutter-comp", ""))
        return [
            (name, address)
            for name, address, slot in meaning.lengths
            if name not in folded and window.value[first + slot]
        ]

    def _skipped(self) -> None:
        """Copy the blocks that the control skips; another control might not skip them."""
        skipped = self.task.window.shape[: len(self.task.shape)] != self.task.shape
        if skipped.any() and self.task.manner.crossing:
            where = self.task.location(int(np.argmax(skipped)))
            message = "a block that is skipped cannot be taken into another dialect"
            raise InputError.one("GX501", message, where, "leave the block out of the program")
        self._refuse_switches(skipped)
        self.lines |= skipped

    def _refuse_switches(self, skipped: Flags) -> None:
        """Refuse to copy a code, in a block that is skipped, of what a pass does instead."""
        shape = self.task.window.shape[: len(self.task.shape)]
        wrong = np.flatnonzero(skipped & self.task.table.flag("switches", shape))
        if len(wrong):
            message = "a block that is skipped would let the control follow the tip"
            where = self.task.location(int(wrong[0]))
            raise InputError.one("GX330", message, where, "leave it out of the program")

    def _nothing_to_say(self) -> Flags:
        """Return the lines without any item: the same in every dialect."""
        shapes = self.task.table.shapes.shapes
        empty = np.array([not shape.block.items for shape in shapes], np.bool_)
        return np.asarray(empty[self.task.shape])

    def _pointed(self) -> Flags:
        """Return the lines whose I, J, K are the tool axis: a pass has made angles of them."""
        pointed = np.zeros(len(self.task.shape), np.bool_)
        rows = np.isfinite(self.original.tool[:, 0])
        if rows.any():
            pointed[self.original.block[rows]] = True
            pointed &= self.task.table.flag("has_centre", self.task.shape)
        return pointed

    def _same_units(self) -> Flags:
        return np.asarray(self.path.blocks.inch == self.original.blocks.inch)

    def _same_modes(self) -> Flags:
        now, old = self.path.blocks, self.original.blocks
        return np.asarray(
            self._same_units()
            & (now.incremental == old.incremental)
            & (now.absolute_centre == old.absolute_centre)
        )

    def _standing(self, old_count: Ints, pieces: Pieces, stated: Stated) -> Flags:
        """Return the lines whose rows are those of the source and need no other words."""
        stands = np.zeros(len(old_count), np.bool_)
        special = np.zeros(len(old_count), np.bool_)
        special[self.original.block[~self.original.is_free]] = True
        paired = (old_count == pieces.count) & ((old_count == 1) | special) & (old_count > 0)
        rows = np.flatnonzero(paired[self.path.block])
        others = np.flatnonzero(paired[self.original.block])
        if not len(rows):
            return stands
        lines = self.path.block[rows]
        alike = self._same_modes() | self._without_lengths(special)
        self.converted = ~alike & convertible(self.task, pieces, self.positions)
        good = (alike | self.converted)[lines]
        if not self.task.manner.crossing:
            repaired = np.zeros(len(old_count), np.bool_)
            repaired[pieces.line[stated.repaired]] = True
            good &= special[lines] | ~repaired[lines]
        good &= self.path.form[rows] == self.original.form[others]
        good &= self.path.kind[rows] == self.original.kind[others]
        good &= stated.kind[rows] == as_written(self.original, self.original.kind)[others]
        plain = self.path.is_free[rows]
        good &= ~plain | self._same_ends(rows, others)
        own = np.flatnonzero(~plain)
        if len(own):
            good[own] &= self._same_words(rows[own], others[own])
        turned = plain | (self.path.form[rows] == Form.SPLINE)
        good &= ~turned | self._same_frames(rows, others)
        starts_exact = self._track_exactness(rows, others, good & ~self.converted[lines])
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

    def _without_lengths(self, special: Flags) -> Flags:
        """Return the lines, of those that are special, that only the unit of no length changes."""
        free = np.zeros(len(special), np.bool_)
        now, old = self.path.blocks, self.original.blocks
        mind = special & (now.incremental == old.incremental) & (now.inch != old.inch)
        window, table = self.task.window, self.task.table
        mind &= table.groups[self.task.shape, GROUPS.index("units")] < 0
        for line in np.flatnonzero(mind).tolist():
            slots = table.meanings[int(self.task.shape[line])].slots
            first = int(window.first_number[line])
            free[line] = not any(window.value[first + slots[a]] for a in LINEAR if a in slots)
        return free

    def _same_diameters(self, rows: Ints, others: Ints) -> Flags:
        """Return which rows name no X, or are in frames that agree on what X is."""
        now = np.array([frame.diameter for frame in self.path.frames], np.bool_)
        was = np.array([frame.diameter for frame in self.original.frames], np.bool_)
        same = now[self.path.frame[rows]] == was[self.original.frame[others]]
        return np.asarray(same | ~self.positions.programmed[rows, 0])

    def _same_polar(self, rows: Ints, others: Ints) -> Flags:
        """Return which rows are in frames that agree on whether words are radius and angle."""
        was = np.array([frame.polar for frame in self.original.frames], np.bool_)
        return np.asarray(self._polar[self.path.frame[rows]] == was[self.original.frame[others]])

    def _same_ends(self, rows: Ints, others: Ints) -> Flags:
        """Return which rows end where their source ends and need no word it does not have."""
        good = np.ones(len(rows), np.bool_)
        words, original = self.positions.end, self._old_words(rows, others)
        polar = self._polar[_take(self.path.frame, rows)]
        for k in range(len(self.path.axes)):
            end, old = _take(words[:, k], rows), original[:, k]
            held = _take(self.positions.held[:, k], rows)
            programmed = _take(self.positions.programmed[:, k], rows)
            same = (np.abs(held - old) <= EXACT) | (end == old)
            left = ~_take(self.positions.write[:, k], rows)
            left |= polar & (end == old)  # one word moves two axes: it says both
            good &= np.where(programmed, same, left)
            if not good.any():
                break
        return good

    def _same_words(self, rows: Ints, others: Ints) -> Flags:
        """Return which rows of blocks that move in their own way need no other words.

        They end where those of the source end, or go as far where distances are programmed; an axis
        that stands still may stand elsewhere.
        """
        end, start = self.path.end[rows], self.path.start[rows]
        old = _where_left(self.original.end[others], end)
        way, old_way = end - start, old - _where_left(self.original.start[others], start)
        unknown = np.isnan(end) & np.isnan(old)
        same = (np.abs(end - old) <= EXACT) | unknown
        incremental = self.path.blocks.incremental[self.path.block[rows]][:, None]
        still = np.abs(old_way) <= EXACT
        cycle = np.isin(self.path.form[rows], (Form.CYCLE, Form.SPLINE))[:, None]
        as_far = (np.abs(way - old_way) <= EXACT) & (incremental | (still & ~cycle))
        good = (same | as_far | self._other_axes(rows, others)).all(axis=1)
        if self.path.frames == self.original.frames:
            return np.asarray(good)
        good &= self._same_diameters(rows, others) & self._same_polar(rows, others)
        words, before = self.positions.end[rows], self.original.words[others]
        alike = (np.abs(words - before) <= EXACT) | (np.isnan(words) & np.isnan(before))
        one_move = np.isin(self.path.form[rows], (Form.PROBE, Form.SYNCHRONISED))
        alike |= one_move[:, None] & ~self.positions.programmed[rows]
        framed = (self.path.form[rows] == Form.HOME) & (self.path.nth[rows] == 0)
        framed |= one_move | cycle[:, 0]
        as_far = incremental[:, 0] & self._same_frames(rows, others)
        return np.asarray(good & (alike.all(axis=1) | as_far | ~framed))

    def _other_axes(self, rows: Ints, others: Ints) -> Flags | bool:
        """Return which axes of rows are those of another machine, and neither named nor moved."""
        if not self.path.left_out:
            return False
        left = np.array([axis in self.path.left_out for axis in self.path.axes])
        way = self.path.end[rows] - self.path.start[rows]
        before = self.original.start[others], self.original.end[others]
        new = np.isnan(before[0]) & np.isnan(before[1]) & (np.abs(way) <= EXACT)
        return np.asarray((left & ~self.positions.programmed[rows]) | new)

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
        start = self._in_frames(self.original.start, rows, others)
        same = np.abs(self.positions.before[rows] - start) <= EXACT
        return np.asarray((same | ~self.positions.programmed[rows]).all(axis=1))

    def _old_words(self, rows: Ints, others: Ints) -> Floats:
        """Return the ends of source rows as programmed; distances count in any frame."""
        words = _take(self.original.words, others)
        distance = self.path.blocks.incremental[self.path.block[rows]]
        if self.path.frames == self.original.frames or not distance.any():
            return words
        return np.where(distance[:, None], self._in_frames(self.original.end, rows, others), words)

    def _in_frames(self, positions: Floats, rows: Ints, others: Ints) -> Floats:
        """Return positions of source rows in the frames of the rows that stand for them."""
        frame = _take(self.path.frame, rows)
        return by_frame(Frame.words, self.path.frames, frame, _take(positions, others), -1.0)

    def _track_exactness(self, rows: Ints, others: Ints, good: Flags) -> Flags:
        """Follow how far everything is exactly as in the source; return where rows start so."""
        whole = len(rows) == len(self.path) == len(self.original)
        if not whole or not good[0] or not self.believed_exact:
            return np.zeros(len(rows), np.bool_)
        end, old = self.path.end, self.original.end
        alike = ((end == old) | (np.isnan(end) & np.isnan(old))).all(axis=1) & good
        self.exact = np.logical_and.accumulate(alike)
        return np.append(True, self.exact[:-1])

    def said_exactly(self) -> Flags:
        """Return whether the control stands exactly where the path is (rows, 3), after each row.

        It does in an axis that a block in G90 has named which was copied, perhaps with more
        decimals than are written, until one that is written anew names the axis.
        """
        path, believed = self.path, self.believed_said
        copied = self.lines[path.block]
        if not copied.any() and not believed.any():
            return np.broadcast_to(False, (len(path), 3))
        plain = (path.form == Form.PLAIN) & ~path.blocks.incremental[path.block]
        whole = np.mod(path.sweep + 1e-9, TURN) < 2e-9  # a circle leaves the axes where they are
        shifts = [frame.matrix is None and not frame.polar for frame in path.frames]
        by_axis = np.array(shifts, np.bool_)[path.frame]
        found = np.empty((len(path), 3), np.bool_)
        for axis in range(3):
            named = np.where(
                copied, self.positions.programmed[:, axis], self.positions.write[:, axis]
            )
            named &= ~(path.is_arc & whole) | copied
            exact = copied & plain & by_axis
            found[:, axis] = fill(exact, named, bool(believed[axis]))
        return found | self.exact[:, None]

    def _same_arcs(self, rows: Ints, others: Ints, starts_exact: Flags) -> Flags:
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


def _where_left(old: Floats, now: Floats) -> Floats:
    """Return positions of the source; those that only a pass knows (inf) are as it has them."""
    return np.where(np.isinf(old), now, old)


def _take(column: NDArray[Any], rows: Ints) -> NDArray[Any]:
    """Return a column at rows; all of it if the rows are all."""
    return column if len(rows) == len(column) else column[rows]
