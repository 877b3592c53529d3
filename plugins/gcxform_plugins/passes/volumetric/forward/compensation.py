"""How `volumetric` works forward: from where the tool shall be to what is commanded.

For the inverse the same is done with the machine's error in place of its correction: a *target* is
then a command, and a *command* where the machine goes with it.

A machine errs everywhere: also at the points that G53 and G28 lead to, and where it stands before
the program. Rapids to points of the machine, and to places where some axis is not known yet, are
written as they stand (the pass spares them). No feed move may begin or end at such a place, or at a
given `start`, unless the error there is within the promise (GX317): it would be cut slanting. What
decides is where the axes have been left, by what the pass has written before or by the start, and
not the name of the block. With `rapids = "skip"` all rapids are spared, and how far off feed moves
begin is measured against the explicit budget.
"""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Floats, Ints
from gcxform_plugins.passes.volumetric.bored import Bored, check_bored
from gcxform_plugins.passes.volumetric.forward.arcs import ArcFitter
from gcxform_plugins.passes.volumetric.forward.lines import cuts_of_lines
from gcxform_plugins.passes.volumetric.forward.window import Window
from gcxform_plugins.passes.volumetric.ranges import beyond_tables, check_inside

PACE = 0.1  # of a way; by so much more or less of it, at most, a turn of the head may be faster
SAME = 1e-9  # mm; an axis that moves by less stays where it is
MOST_TURNS = 100  # of an arc; cutting each takes a tenth of a second


class Compensation(Window):
    """The forward work on one window."""

    def run(self) -> gx.Toolpath:
        """Return the commands."""
        self._refuse_splines()
        self._check_own()
        self._check_known()
        check_inside(self.step, self.path, self.offset, np.flatnonzero(~self.left))
        check_bored(self)
        commands = self._commands(self.entry_command)
        self._check_begins(commands)
        self._check_paces(commands)
        rows, part = self._cuts(commands)
        if len(rows):
            return self._cut(rows, part, commands)
        self._check_size(commands, self.end, np.arange(len(self.path)))
        end = self._with_others(commands - self.offset)
        return self._arcs(self.path.replace(end=end, entry=self._entry()), np.arange(len(end)))

    def _refuse_splines(self) -> None:
        """Refuse splines: what the machine makes of their control points is no spline."""
        rows = np.flatnonzero(self.path.form == gx.Form.SPLINE)
        if len(rows):
            message = "a spline is not compensated"
            raise self.path.refuse("GX506", rows, message, gx.put_before("segment"))

    @cached_property
    def entry_command(self) -> Floats:
        """Where the axes stand before the first row, in the table (3,).

        It is what was written before; where nothing was, the control says where they stand, and the
        machine is off by its error there.
        """
        path, start = self.path, self.start[0]
        if path.held is not None:
            return np.asarray(np.where(np.isnan(start), start, path.held[:3] + self.offset[0]))
        if self.step.rapids == "skip" and path.after_rapid:
            return np.asarray(start)
        return np.asarray(self.commanded(self.start[:1], self.place.first_tool)[0])

    def _commands(self, entry: Floats) -> Floats:
        """Return the commands for the ends of the rows; what G28 and G53 say stays as it is.

        `entry` (3,) is the command before the first row.
        """
        if not self.left.any():
            return self.commanded(self.end, self.place.tool)
        commands = self.end.copy()
        rows = np.flatnonzero(~self.left)
        commands[rows] = self.command(self.end[rows], rows)
        path = self.path
        distances = path.form == gx.Form.HOME
        distances &= np.append(path.nth[1:] > 0, False)[: len(path)]  # the way to G28's own point
        distances |= path.form == gx.Form.BLIND
        distances &= path.blocks.incremental[path.block]
        named = (path.blocks.named[path.block][:, None] >> np.arange(3) & 1).astype(np.bool_)
        for row in np.flatnonzero(self.left).tolist():
            before = self._written(commands, row - 1) if row else entry
            way = self.end[row] - self.start[row]
            stays = (np.abs(way) < SAME) & ~named[row]
            commands[row] = np.where(stays, before, commands[row])
            if distances[row]:
                commands[row] = before + way
        return commands

    def _written(self, commands: Floats, row: int) -> Floats:
        """Return what is written (3,) for the end of a row, in the table."""
        return np.asarray((self.end if self.skipped[row] and not self.left[row] else commands)[row])

    def _entry(self) -> Floats:
        entry = self.path.entry.copy()
        if self.path.held is not None:
            return self.path.held.copy()
        if np.isfinite(self.entry_command).all():
            entry[:3] = self.entry_command - self.offset[0]
        return entry

    def _cuts(self, commands: Floats) -> tuple[Ints, Floats]:
        """Return row and part of all cuts."""
        if self.step.split == "none":
            return np.empty(0, np.int64), np.empty(0)
        row, part = cuts_of_lines(self, self.entry_command, commands)
        if self.path.has_arcs:
            self._check_turns()
            arc_row, arc_part = ArcFitter(self).cuts()
            row, part = np.append(row, arc_row), np.append(part, arc_part)
        return row, part

    # --- refusals ---

    def _check_turns(self) -> None:
        """Refuse arcs of very many turns: to cut each of them where it must be takes a while."""
        rows = np.flatnonzero(self.path.sweep > MOST_TURNS * math.tau)
        if len(rows):
            message = f"an arc of more than {MOST_TURNS} turns is not compensated in one piece"
            hint = 'segment arcs="split" arc-step="360 deg", before this pass'
            raise self.path.refuse("GX761", rows, message, hint)

    def _check_own(self) -> None:
        """Refuse feed moves to points of the machine."""
        feeds = self.path.kind != gx.Kind.RAPID
        own = np.flatnonzero(feeds & (self.path.form == gx.Form.MACHINE))
        if len(own):
            message = "a feed move to a point of the machine (G53) is not compensated"
            hint = "name the place in a work offset; or go there in a rapid, if the way is clear"
            raise self.path.refuse("GX317", own[:1], message, hint)

    def _check_known(self) -> None:
        unknown = np.isnan(self.end) & ~self.left[:, None]
        if unknown.any():
            row = int(np.argmax(unknown.any(axis=1)))
            at = int(np.argmax(unknown[row]))
            axis, lost = "XYZ"[at], (self.path.lost[: row + 1] >> at & 1).any()
            start = f", or say start = {{ {axis} = ... }} in [input]"
            raise self.path.refuse(
                "GX311",
                np.array([row]),
                f"where {axis} stands is not known here, and the error depends on it",
                f"program {axis} before{', behind what loses it' if lost else start}",
            )

    def _check_begins(self, commands: Floats) -> None:
        """Refuse feed moves from where the machine is not.

        Behind what is left to the machine, and at the start, the tool is off by the error there;
        behind another length or offset by what it would be off elsewhere, until it moves. Where
        nothing is promised the proof measures how far.
        """
        path = self.path
        feeds = path.kind != gx.Kind.RAPID
        known = path.held is not None and bool(np.isfinite(self.start[0]).all())
        behind = np.append(known, self.left[:-1] | (np.abs(self._jumps()) > SAME).any(axis=1))
        rows = np.flatnonzero(feeds & behind)
        if not len(rows) or not np.isfinite(self.step.promise):
            return
        off = self._off_at_start(rows, np.vstack([self.entry_command, commands[:-1]]))
        wrong = np.flatnonzero(~(off <= self.step.limit))
        if len(wrong):
            raise self._refuse_begin(int(rows[wrong[0]]), float(off[wrong[0]]))

    def _off_at_start(self, rows: Ints, commands: Floats) -> Floats:
        """Return how far (n,) mm the machine is from where rows begin; nan where nobody knows.

        `commands` (rows, 3) are those before each row of the path. Where a length or an offset is
        another one than in the row before, the machine stands there as it did.
        """
        jumps = np.vstack([np.zeros(3), self._jumps()])
        places = (np.vstack([self.start[:1], self.end[:-1]]) + jumps)[rows]
        commands = (commands + jumps)[rows]
        meant = self.meant(commands, self.place.tool_before(rows))
        gap = np.where(np.isnan(places), 0.0, meant - places)
        off = np.sqrt((gap**2).sum(axis=1))
        near = self.step.max_correction
        return np.where(beyond_tables(self.step, commands, near), np.nan, off)

    def _jumps(self) -> Floats:
        """Return by how much (rows - 1, 3) places in the table change between rows, unmoved."""
        return np.diff(np.broadcast_to(self.offset, self.end.shape), axis=0)

    def _refuse_begin(self, row: int, off: float) -> gx.InputError:
        """Return the error about a feed move that begins where the machine is not."""
        path = self.path
        size = f"{off:.4f} mm off" if np.isfinite(off) else "off by an amount that is not known"
        what = "behind a rapid that is not compensated" if row else "at the start"
        ends = ""
        if row and not self.left[row - 1]:
            what = "behind another length or offset, without a move between"
        elif row - 1 in Bored.of(path).rows:
            what = "behind a hole that is called as it stands"
            ends = "end the modal call of the hole if it is one; "
        inch = 25.4 if path.blocks.inch[path.block[row]] else 1.0
        words = zip("XYZ", path.in_frames(path.start)[row, :3] / inch, strict=True)
        there = " ".join(f"{axis}{word:.6g}" for axis, word in words if np.isfinite(word))
        unknown = [a for a, x in zip("XYZ", path.start[row], strict=False) if np.isnan(x)]
        more = f" and {' and '.join(unknown)}, which has not been programmed yet" if unknown else ""
        steps = "G91 and " if path.blocks.incremental[path.block[row]] else ""
        return path.refuse(
            "GX317",
            np.array([row]),
            f"this feed move begins {what}, where the machine is {size}",
            f"{ends}before it, write a rapid to where it begins, in absolute words: {there}{more}; "
            f"and begin it with {steps}its own motion",
        )

    def _check_paces(self, commands: Floats) -> None:
        """Refuse feeds per minute where the correction is much of what the linear axes go.

        The control would measure the feed along a few micrometres, and turn the head in no time.
        """
        if self.swing is None:
            return
        path = self.path
        before = np.vstack([self.entry_command, commands[:-1]])
        way = np.sqrt(((self.end - self.start) ** 2).sum(axis=1))
        moved = np.sqrt(((commands - self.end - (before - self.start)) ** 2).sum(axis=1))
        wrong = self.swing.turning & (moved > PACE * way) & ~self.left
        wrong &= (path.kind != gx.Kind.RAPID) & (path.feed_mode != gx.FeedMode.INVERSE_TIME)
        if wrong.any():
            message = "the head turns and the linear axes hardly move, but for the correction"
            hint = "write it in inverse time (G93), whose feed does not depend on how far they go"
            raise path.refuse("GX316", np.flatnonzero(wrong)[:1], message, hint)

    def _check_size(self, command: Floats, target: Floats, rows: Ints) -> None:
        size = np.sqrt(((command - target) ** 2).sum(axis=1))
        size[self.left[rows]] = 0.0
        if np.nanmax(size, initial=0.0) > self.step.max_correction:
            worst = int(np.nanargmax(size))
            raise self.path.refuse(
                "GX313",
                rows[worst : worst + 1],
                f"the correction is {size[worst]:.4f} mm, more than {self.step.max_correction:g}",
                "values in the table are in mm; if they are, raise max-correction",
            )

    # --- rows ---

    def _with_others(self, command: Floats) -> Floats:
        """Return the ends of all rows: commands for X, Y, Z, the other axes as they are."""
        path = self.path
        end = gx.column_major(len(path), len(path.axes))
        end[:, :3], end[:, 3:] = command, path.end[:, 3:]
        if self.step.rapids == "skip":
            rapid = path.kind == gx.Kind.RAPID
            end[rapid] = path.end[rapid]
        return end

    def _cut(self, cut_row: Ints, cut_part: Floats, commands: Floats) -> gx.Toolpath:
        """Return the path cut at parts of its rows."""
        path = self.path
        row = np.append(np.arange(len(path)), cut_row)
        part = np.append(np.ones(len(path)), cut_part)
        order = np.lexsort((part, row))
        row, part = row[order], part[order]
        inner = part < 1.0
        target = self.end[row]
        target[inner] = self._between(row[inner], part[inner])
        command = commands[row]
        command[inner] = self.command(target[inner], row[inner], part[inner])
        self._check_size(command, target, row)
        end = self._with_others(commands - self.offset)[row]
        end[:, :3] = np.where(inner[:, None], command - self.offset_of(row), end[:, :3])
        a, b = path.start[row, 3:], path.end[row, 3:]
        end[:, 3:] = np.where(inner[:, None], a + part[:, None] * (b - a), b)
        low = np.where(np.append(True, row[1:] != row[:-1]), 0.0, np.append(0.0, part[:-1]))
        columns = self._timed_and_swept(row, part - low)
        counts = np.bincount(row, minlength=len(path))
        new = path.with_rows(counts, end=np.asfortranarray(end), **columns)
        return self._arcs(new.replace(entry=self._entry()), row, low, part)

    def _between(self, rows: Ints, part: Floats) -> Floats:
        """Return the points of rows at parts of their way, in the table."""
        start, end = self.start[rows], self.end[rows]
        point = start + part[:, None] * (end - start)
        arcs = self.path.is_arc[rows]
        if arcs.any():
            on_arc = gx.points_on_arcs(self.path, rows[arcs], part[arcs])
            point[arcs] = on_arc + self.offset_of(rows[arcs])
        return np.asarray(point)

    def _timed_and_swept(self, row: Ints, share: Floats) -> dict[str, Floats]:
        """Return sweeps of the pieces, and feeds where a feed is the inverse of a time."""
        path = self.path
        columns: dict[str, Floats] = {}
        if path.has_arcs:
            columns["sweep"] = path.sweep[row] * share
        inverse = path.feed_mode[row] == gx.FeedMode.INVERSE_TIME
        if inverse.any():
            columns["feed"] = np.where(inverse, path.feed[row] / share, path.feed[row])
        return columns

    def _arcs(
        self, new: gx.Toolpath, row: Ints, low: Floats | None = None, high: Floats | None = None
    ) -> gx.Toolpath:
        """Return the path with the centres of its arcs moved to suit the commands."""
        if not new.has_arcs:
            return new
        arcs = np.flatnonzero(new.is_arc)
        centre = new.centre.copy()
        if self.step.arc_centres == "nominal":
            nominal = self._between_starts(row[arcs], None if low is None else low[arcs])
            centre[arcs] = new.start[arcs, :3] + (self.path.centre[row[arcs]] - nominal)
            return new.replace(centre=centre, refit_centres=False)
        begin = np.zeros(len(arcs)) if low is None else low[arcs]
        stop = np.ones(len(arcs)) if high is None else high[arcs]
        centre[arcs] = ArcFitter(self).centres(row[arcs], begin, stop)
        new = new.replace(centre=centre)
        return new.replace(sweep=gx.swept_anew(new))

    def _between_starts(self, rows: Ints, low: Floats | None) -> Floats:
        """Return where pieces start in the program's coordinates, before compensation."""
        if low is None:
            return np.asarray(self.path.start[rows, :3])
        return self._between(rows, low) - self.offset_of(rows)
