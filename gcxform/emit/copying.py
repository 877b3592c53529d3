"""Which lines are copied: those whose bytes say to the control what the path says."""

from __future__ import annotations

import numpy as np

from gcxform.catalogue.remedies import leave_out_block, put_before
from gcxform.diagnostics import InputError
from gcxform.dialect.dialect import EXTRUDER, LINEAR
from gcxform.emit.converting import convertible
from gcxform.emit.corners import counted_from_corners
from gcxform.emit.depending import Depending
from gcxform.emit.manner import Believed, Task
from gcxform.emit.needed_modes import Stated
from gcxform.emit.pieces import PLACES, Pieces
from gcxform.emit.positions import Positions, as_written
from gcxform.emit.same_rows import SameRows
from gcxform.emit.tapping import Taps
from gcxform.modal.columns import fill
from gcxform.modal.meaning.tables import GROUPS
from gcxform.modal.numbers_without_point import hint_of_rounding
from gcxform.system.arrays import Flags, Ints, Small
from gcxform.system.distinct import distinct, one_of, union
from gcxform.toolpath.angles import TURN
from gcxform.toolpath.path import Form

WHAT = {
    Form.CYCLE: "a canned cycle",
    Form.HOME: "a return to reference",
    Form.MACHINE: "a move in machine coordinates",
    Form.PROBE: "a probing move",
    Form.SYNCHRONISED: "a move tied to the spindle",
    Form.SPLINE: "a spline",
    Form.THREAD: "a thread",
    Form.BLIND: "a move by distances from where it is not known",
    Form.NURBS: "a spline of NURBS",
    Form.PASSES: "a thread in passes",
    Form.TILTED: "an arc in a plane that is turned out of the axes",
}
IN_PLACE = (Form.NURBS, Form.PASSES, Form.TILTED)
"""Forms that begin where the tool stands, and have no word for it."""
Z = 2
"""The column of the axis that a tool length moves by itself on some controls."""
HINTS = {
    Form.CYCLE: put_before("cycles"),
    Form.SPLINE: put_before("segment", options="chord-error=2um"),
    Form.BLIND: "program its axes in G90 before, so that it is known where they stand",
    Form.PROBE: "leave the pass out that changes its coordinates: what it finds counts in them",
}


def _motion_before(pieces: Pieces, stated: Stated, entry: int, live: int) -> Small:
    """Return the numbers of the codes of motion in force before each line (live,)."""
    known = np.append(np.int8(entry), stated.motion.after)
    return np.asarray(known[np.searchsorted(pieces.line, np.arange(live))])


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
        self.believed_exact = believed.exact
        self.believed_said = believed.said
        self.same = SameRows(self.path, self.original, positions)
        self.lines = (old_count == 0) & (pieces.count == 0) & ~pieces.expanded_line
        stands, converted, self.exact = self._standing(old_count, pieces, stated)
        self._refuse_extrusion()
        self._refuse_changed(stands, pieces, stated)
        motion = _motion_before(pieces, stated, believed.motion, live)
        depending = Depending(task, positions, believed, self.same, self.exact, motion)
        depending.check()
        if task.manner.crossing:
            self.lines &= self._nothing_to_say()
        else:
            self.lines &= self.same.modes()
            self.lines |= stands & ~converted
        if self.path.folded:
            self.lines[self.task.table.flag("framing", self.task.shape)] = False
        self.lines &= ~self.task.table.flag("switches", self.task.shape)
        self.lines &= ~self._pointed() & ~self._said_otherwise()
        if self.path.blocks.uncompensated:
            self.lines &= ~self.task.table.flag("compensates", self.task.shape)
        self.lines[pieces.line[stated.repaired]] = False
        self.lines &= ~taps.lines
        self._skipped()
        depending.refuse_shared(self.lines)
        self._refuse_unknown()
        self._refuse_polar()
        self._refuse_moved_before(pieces)
        self._refuse_perhaps(stated, pieces)

    def _refuse_extrusion(self) -> None:
        """Refuse another distance mode where it decides what words of an extruder count."""
        rule, blocks = self.task.manner.target.motion_rule.extruder, self.path.blocks
        if rule in ("", "own") or EXTRUDER not in self.path.axes:
            return
        now, before = blocks.incremental, self.task.read.modes.incremental
        for line in np.flatnonzero(now != before)[:1].tolist():
            hint = "leave out the pass that would change it, or let the CAM write it so"
            message = "G90 and G91 say what E counts here, so that neither can become the other"
            raise InputError.one("GX506", message, self.task.location(line), hint)

    def _refuse_changed(self, stands: Flags, pieces: Pieces, stated: Stated) -> None:
        """Refuse blocks that move in a way of their own and would have to move otherwise.

        A thread may end elsewhere, but it stays one block in its unit.
        """
        wrong = distinct(pieces.line[pieces.special & ~stands[pieces.line]])
        threads = distinct(self.path.block[self.path.form == Form.THREAD])
        if len(threads):
            other = (pieces.count[threads] != 1) | ~self.same.units()[threads]
            wrong = union(wrong, threads[other])
        points = distinct(self.path.block[one_of(self.path.form, IN_PLACE)])
        other = np.isin(points, pieces.line[stated.repaired]) | ~self.same.units()[points]
        wrong = union(wrong, points[other])
        if not len(wrong):
            return
        forms = self.path.form[self.path.block == wrong[0]]
        form = Form(int(forms[0])) if len(forms) else Form.CYCLE  # it stores where one drills
        hint = HINTS.get(
            form, "leave out the pass that would change it, or let the CAM write it so"
        )
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
            hint = f"program {axis} before, or give a machine file with X = ... in [work-offset.*]"
            if self._was_turned(row):
                hint = "name X, Y and Z in this block, where coordinates are turned"
            texts = [u for u in self.task.read.unknown if u.line == self.path.block[row]]
            if texts:
                hint = f"write {axis} as a number, or leave out the pass that changes this block"
            if texts and all(each.rounded for each in texts):
                hint = hint_of_rounding(axis, bool(self.path.blocks.inch[self.path.block[row]]))
            raise InputError.one("GX506", message, where, hint)

    def _was_turned(self, row: int) -> bool:
        """Return whether words of X, Y and Z each go along more than one axis in the source."""
        rows = np.flatnonzero(self.original.block == self.path.block[row])
        return any(
            self.original.frames[frame].matrix is not None
            for frame in self.original.frame[rows].tolist()
        )

    def _refuse_perhaps(self, stated: Stated, pieces: Pieces) -> None:
        """Refuse to change more than words in a block that may not be executed.

        Another axis, or a mode, would then be elsewhere, or another one, for all that is behind it.
        """
        if self.task.read.perhaps is None:
            return
        extra = (self.positions.write & ~self.positions.programmed).any(axis=1)
        lines = np.zeros(len(self.lines), np.bool_)
        lines[self.path.block[extra]] = True
        lines[pieces.line[stated.repaired]] = True
        wrong = np.flatnonzero(lines & self.task.read.perhaps & ~self.lines)
        if len(wrong):
            message = "only the machine knows whether this is executed, and it would do more"
            hint = "leave out the pass that changes it"
            raise InputError.one("GX506", message, self.task.location(int(wrong[0])), hint)

    def _refuse_polar(self) -> None:
        """Refuse blocks that have to be written anew while words are radius and angle."""
        if not self.same.polar.any():
            return
        words = self.positions.write[:, :3].any(axis=1) & self.same.polar[self.path.frame]
        rows = np.flatnonzero(words & ~self.lines[self.path.block])
        if len(rows):
            message = "the block would be written anew, in radius and angle (G16)"
            where = self.task.location(int(self.path.block[rows[0]]))
            raise InputError.one("GX506", message, where, put_before("offsets"))

    def _refuse_moved_before(self, pieces: Pieces) -> None:
        """Refuse to move Z beside others where a tool length has moved it before, by itself.

        Its block does not name Z there, or is a cycle that begins at the level where Z stands. A
        way home from where nothing is known may begin anywhere.
        """
        path = self.path
        first = pieces.expanded_line[path.block] & (path.nth == 0)
        named = self.positions.programmed[:, Z] & ~first
        stands = np.isnan(path.start[:, Z]) & np.isfinite(path.end[:, Z])
        nowhere = np.isnan(path.start).all(axis=1) & ~self.positions.programmed.any(axis=1)
        rows = np.flatnonzero(
            self.positions.write[:, Z] & ~named & stands & ~nowhere & path.is_free
        )
        manner = self.task.manner
        there, here = (each.tool_rule.length_may_move for each in (manner.target, manner.source))
        if here and not there and len(rows):
            message = "Z is where another tool length has moved it, and would only go there now"
            hint = "program Z alone behind the code of the length"
            where = self.task.location(int(self.path.block[rows[0]]))
            raise InputError.one("GX509", message, where, hint)

    def _skipped(self) -> None:
        """Copy the blocks that the control skips; another control, which might not, gets none."""
        skipped = self.task.skipped
        if self.task.manner.crossing:
            self.lines &= ~skipped
            return
        self._refuse_switches(skipped)
        self.lines |= skipped

    def _refuse_switches(self, skipped: Flags) -> None:
        """Refuse to copy a code, in a block that is skipped, of what a pass does instead."""
        shape = self.task.window.shape[: len(self.task.shape)]
        wrong = np.flatnonzero(skipped & self.task.table.flag("switches", shape))
        if len(wrong):
            message = "a block that is skipped would let the control follow the tip"
            where = self.task.location(int(wrong[0]))
            raise InputError.one("GX330", message, where, leave_out_block())

    def _nothing_to_say(self) -> Flags:
        """Return the lines without any item: the same in every dialect."""
        shapes = self.task.table.shapes.shapes
        empty = np.array([not shape.block.items for shape in shapes], np.bool_)
        return np.asarray(empty[self.task.shape])

    def _said_otherwise(self) -> Flags:
        """Return the lines with codes of which the user has said what takes their place."""
        saying, meanings = self.task.manner.saying, self.task.table.meanings
        if saying.crosses or not (saying.m_codes or saying.drop):
            return np.zeros(len(self.task.shape), np.bool_)
        other = [any(saying.instead(e.what) != e.what for e in each.events) for each in meanings]
        return np.asarray(np.array(other, np.bool_)[self.task.shape])

    def _pointed(self) -> Flags:
        """Return the lines whose I, J, K are the tool axis: a pass has made angles of them."""
        pointed = np.zeros(len(self.task.shape), np.bool_)
        rows = np.isfinite(self.original.tool[:, 0])
        if rows.any():
            pointed[self.original.block[rows]] = True
            pointed &= self.task.table.flag("has_centre", self.task.shape)
        return pointed

    def _standing(
        self, old_count: Ints, pieces: Pieces, stated: Stated
    ) -> tuple[Flags, Flags, Flags]:
        """Return the lines whose rows are those of the source and need no other words.

        And those of them whose words are converted to another unit, and `exact`.
        """
        stands = np.zeros(len(old_count), np.bool_)
        special = pieces.corner.copy()
        special[self.original.block[~self.original.is_free]] = True
        paired = (old_count == pieces.count) & ((old_count == 1) | special) & (old_count > 0)
        rows = np.flatnonzero(paired[self.path.block])
        others = np.flatnonzero(paired[self.original.block])
        if not len(rows):
            return stands, stands, np.zeros(len(self.path), np.bool_)
        lines = self.path.block[rows]
        alike = self.same.modes() | self._without_lengths(special)
        converted = ~alike & convertible(self.task, pieces, self.positions)
        good = (alike | converted)[lines]
        if not self.task.manner.crossing:
            repaired = np.zeros(len(old_count), np.bool_)
            repaired[pieces.line[stated.repaired]] = True
            good &= special[lines] | ~repaired[lines]
        good &= self.path.form[rows] == self.original.form[others]
        good &= self.path.kind[rows] == self.original.kind[others]
        good &= stated.kind[rows] == as_written(self.original, self.original.kind)[others]
        plain = self.path.is_free[rows]
        good &= ~plain | self.same.ends(rows, others)
        own = np.flatnonzero(~plain)
        if len(own):
            good[own] &= self.same.words(rows[own], others[own])
        turned = plain | one_of(self.path.form[rows], (Form.SPLINE, *IN_PLACE))
        good &= ~turned | self.same.frames(rows, others)
        corner = pieces.corner[lines]
        good = corner | (good & ~counted_from_corners(self.task)[lines])
        starts_exact, exact = self._exactness(rows, others, good & ~converted[lines])
        points = np.flatnonzero(one_of(self.path.form[rows], IN_PLACE))
        if len(points):
            placed = self.same.starts(rows[points], others[points])
            good[points] &= starts_exact[points] | placed
        incremental = self.path.steps[rows].any(axis=1)
        doubtful = np.flatnonzero(good & plain & incremental & ~starts_exact)
        if len(doubtful):
            good[doubtful] &= self.same.starts(rows[doubtful], others[doubtful])
        arcs = np.flatnonzero(good & self.path.is_arc[rows])
        if len(arcs):
            good[arcs] &= self.same.arcs(rows[arcs], others[arcs], starts_exact[arcs])
        stands[self.path.block[rows]] = True
        good |= corner
        stands[self.path.block[rows[~good]]] = False
        return stands, converted, exact

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

    def _exactness(self, rows: Ints, others: Ints, good: Flags) -> tuple[Flags, Flags]:
        """Return before which rows, and behind which, everything is exactly as in the source."""
        whole = len(rows) == len(self.path) == len(self.original)
        if not whole or not good[0] or not self.believed_exact:
            return np.zeros(len(rows), np.bool_), np.zeros(len(self.path), np.bool_)
        end, old = self.path.end, self.original.end
        alike = ((end == old) | (np.isnan(end) & np.isnan(old))).all(axis=1) & good
        exact = np.logical_and.accumulate(alike)
        return np.append(True, exact[:-1]), exact

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
        plain |= one_of(path.form, PLACES) & self.positions.last
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
