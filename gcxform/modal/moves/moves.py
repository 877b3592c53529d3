"""Moves of a window: which lines move, from where to where, and at what feed.

Lines become rows in stretches of one frame (`gcxform/modal/frames/track.py`). A plain line is one
row; G28 and G53 move in a way of their own (`gcxform/modal/moves/home.py`), and so do canned cycles
(`gcxform/modal/moves/cycle_patterns.py`), threads, taps and probes
(`gcxform/modal/moves/spindle_and_probe.py`).
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from gcxform.modal.events import events_of
from gcxform.modal.findings import Findings
from gcxform.modal.frames.shifted import Shifted
from gcxform.modal.frames.track import Track
from gcxform.modal.lines import Lines
from gcxform.modal.meaning.tables import MANY_WORK, NUMBER, of_splines
from gcxform.modal.moves.arcs import resolve_arcs, words_of_arcs
from gcxform.modal.moves.blind_moves import blind_rows, may_be_blind
from gcxform.modal.moves.corners import with_corners
from gcxform.modal.moves.cutter_comp import compensation, refuse_ends
from gcxform.modal.moves.cycle_patterns import Drilling
from gcxform.modal.moves.home import TOOL_BACK, own_moves
from gcxform.modal.moves.in_planes import InPlanes
from gcxform.modal.moves.kept_calls import axes_led
from gcxform.modal.moves.nurbs import Nurbs
from gcxform.modal.moves.open_centres import refuse_open_centres
from gcxform.modal.moves.passages import Passages
from gcxform.modal.moves.printers import SAY_MOTION, UNMOVED, refuse_unheard
from gcxform.modal.moves.rows import Own, Rows, Stretches
from gcxform.modal.moves.spindle_and_probe import Tied
from gcxform.modal.moves.splines import read_splines, with_splines
from gcxform.modal.moves.tool_vectors import Pointing
from gcxform.modal.state import CYCLE_OFF, Modes
from gcxform.system.arrays import Flags, Floats, Ints
from gcxform.system.distinct import distinct
from gcxform.toolpath.columns import constant, picked
from gcxform.toolpath.path import Blocks, Kind, Toolpath
from gcxform.toolpath.still_axes import turns_only


class Moves:
    """Turns the lines of a window into rows; the state's position is left where the window ends."""

    def __init__(self, lines: Lines, modes: Modes, axes: str) -> None:
        self.lines = lines
        self.modes = modes
        self.axes = axes
        self.dialect = lines.dialect
        self.state = lines.state
        self.findings = lines.findings
        self.track = Track(lines, modes, axes)
        self.drilling = Drilling(self.track)
        self.tied = Tied(self.track)
        self.shifted: Shifted | None = None
        self.passages: Passages | None = None
        self.in_planes: InPlanes | None = None
        self.side, self.radius = compensation(lines, modes)
        vectors = self.dialect.tip_rule.takes_vectors
        self.pointing = Pointing(lines, modes, axes) if vectors else None
        self.splines = of_splines(modes.motion)
        self.bends = bool(self.splines.any())
        self.nurbs = Nurbs(lines, modes)
        self._new_units: list[int] = []  # lines that change it, where that spoils tool lengths
        if self.dialect.tool_rule.units_spoil_length:
            before = np.append(self.state.groups["units"] == 1, modes.inch)
            self._new_units = np.flatnonzero(np.diff(before)).tolist()

    def path(self) -> Toolpath:
        """Return the moves as a toolpath."""
        self.nurbs.check()
        moving = self._moving()
        refuse_unheard(self.track, moving)
        refuse_open_centres(self.lines, self.modes)
        self.track.may_step = may_be_blind(self.lines, self.modes, moving, self.pointing is None)
        lost = self.lines.loses_position()
        of = self._stretches(moving, lost)
        self.drilling.take(of.borders)
        planes = InPlanes(self.track, of, self.lines.flag("own_moves"), lost)
        self.in_planes = planes if planes.any else None
        together = not (lost.any() or of.lost or self.lines.kept_calls or planes.any)
        if len(of.borders) > 1 and together:
            self.shifted = Shifted(self.track, moving)
            if not self._new_units:
                self.passages = Passages(self.drilling, of, moving)
        losing = lost if lost.any() else None
        alone = of.borders if self.passages is None else self.passages.over()
        found = [self._stretch(first, last, of, moving, losing) for first, last in alone]
        if self.lines.live in of.leaving:
            self.track.lose_all(self.lines.live)
        rows = [part for part in found if isinstance(part, Rows) and len(part.line)]
        if own := [part for part in found if isinstance(part, Own) and part.moves]:
            rows.append(Rows.of_lines(own))
        if self.shifted is not None:
            rows.append(self._plain(*self.shifted.rows()))
        if self.passages is not None:
            rows += [self._plain(*each) for each in self.passages.plain] + self.passages.own
        rows += self.drilling.rows()
        return self._path(Rows.joined(rows or [self._nothing()], len(self.axes)))

    def _nothing(self) -> Rows:
        """Return no rows at all."""
        line = np.empty(0, np.int64)
        return self._plain(line, np.empty((0, len(self.axes))), line)

    def _leaves(self, lost: Flags) -> set[int]:
        """Return the lines before which positions are lost to an M code beside a move.

        Where an M code may act after the move of its block, what it loses is lost behind it as
        well. A canned cycle beside one is refused.
        """
        if self.dialect.block_rule.m_first or not lost.any():
            return set()
        for line in np.flatnonzero(lost & self.drilling.calls).tolist():
            message = "a canned cycle beside an M code that may move axes"
            self.findings.add(line, "GX213", message, hint="write the M code in a block of its own")
        beside = lost & (self.track.worded | self.lines.flag("own_moves"))
        return set((np.flatnonzero(beside) + 1).tolist())

    # --- which lines move ---

    def _moving(self) -> Flags:
        """Return the lines that are one plain move, after looking at what they may not be."""
        own = self.lines.flag("own_moves")
        moves = self.lines.flag("moves") & ~own
        drilling = self.modes.cycle != CYCLE_OFF
        moves &= ~drilling
        centre = self.lines.flag("has_centre") & ~drilling
        if self.pointing is not None:
            self.pointing.check()
            moves |= self.pointing.named & ~own & ~drilling
            centre &= ~self.pointing.named
        stray = self.lines.flag("drill_words") & ~drilling
        stray &= ~(self.splines | self.nurbs.lines | self.tied.cycle)
        for line in np.flatnonzero(stray)[: Findings.enough].tolist():
            words = self.lines.table.meanings[int(self.lines.shape[line])].drill_words
            message = f"{words[0]} belongs to no code of this block"
            self.findings.add(line, "GX203", message, words[0])
        arc = (self.modes.motion == 2) | (self.modes.motion == 3)
        arc |= self.splines
        for line in np.flatnonzero(moves & (self.modes.motion == NUMBER["G80"])).tolist():
            self.findings.add(line, "GX209", UNMOVED, hint=SAY_MOTION)
        behind = self.lines.behind_cycle(self.modes.cycle) & (self.modes.motion != Kind.RAPID)
        for line in np.flatnonzero(behind & moves).tolist():
            message = (
                "after a cycle controls differ in whether G0 or the code before it is in force"
            )
            self.findings.add(line, "GX209", message, hint=SAY_MOTION)
        for line in np.flatnonzero(centre & ~((arc | self.tied.driven) & ~own)).tolist():
            self.findings.add(line, "GX203", "I, J, K and R belong to arcs, and this is none")
        moves &= self.modes.motion != NUMBER["G80"]
        moves |= centre & arc & ~own
        self._refuse_lent(moves | self.drilling.calls, arc)
        self.drilling.refuse_unknown()
        self.tied.check(moves, own)
        in_machine = self.lines.flag("in_machine") & (self.modes.motion == Kind.LINE)
        feeding = (moves & ~self.tied.driven) | in_machine | self._lone_codes(moves, drilling)
        calls = self.drilling.calls | self.lines.flag("probes")
        self._check_feed(feeding, calls)
        return moves

    def _lone_codes(self, moves: Flags, drilling: Flags) -> Flags:
        """Return the lines that state a code of feed moves and move nothing, where that counts.

        A control that executes them asks for a feed, and an arc for its words.
        """
        if not self.dialect.motion_rule.lone_codes_count:
            return np.zeros(len(moves), np.bool_)
        lone = self.lines.stated("motion") & ~moves & ~drilling
        arc = (self.modes.motion == Kind.ARC_CW) | (self.modes.motion == Kind.ARC_CCW)
        for line in np.flatnonzero(lone & arc)[: Findings.enough].tolist():
            message = f"{self.dialect.name} refuses an arc without any word"
            self.findings.add(line, "GX302", message, hint="write the code where the arc is")
        return np.asarray(lone & (self.modes.motion == Kind.LINE))

    def _refuse_lent(self, moves: Flags, arc: Flags) -> None:
        """Refuse words of other codes that the move of their block would take as well."""
        takes = moves | self.lines.flag("compensates")
        for line in np.flatnonzero(takes & self.lines.flag("lends")).tolist():
            meaning = self.lines.table.meanings[int(self.lines.shape[line])]
            wanted = "D" if meaning.compensates else ""
            if arc[line]:
                wanted += "IJKR" + ("PQ" if self.splines[line] else self.dialect.arc_rule.turns)
            rule = self.dialect.cycle_rule
            if rule is not None and self.modes.cycle[line] != CYCLE_OFF:
                cycle = rule.cycles.get(int(self.modes.cycle[line]))
                wanted += "R" + rule.repeats + (cycle.takes if cycle is not None else "")
            for address in sorted(meaning.lent.keys() & {*wanted})[:1]:
                message = f"{address} belongs to {meaning.lent[address]}, and the move takes it too"
                self.findings.add(line, "GX203", message, hint="write two blocks")

    def _check_feed(self, moves: Flags, calls: Flags) -> None:
        """Refuse feed moves without a feed, and blocks in inverse time without a feed word."""
        feeding = (moves & (self.modes.motion != Kind.RAPID)) | calls
        none = ~(self.modes.feed > 0) & ~self.lines.feed_lost
        inverse = self.modes.feed_mode == NUMBER["G93"]
        if inverse.any():
            word = self.lines.word("F")
            none |= inverse if word is None else inverse & ~word[1]
        missing = np.flatnonzero(feeding & none)
        for line in missing[: Findings.enough].tolist():
            self.findings.add(
                line,
                "GX204",
                "a feed move, but no feed is in force",
                hint="write an F word; in G93 every feed block needs one",
            )

    # --- stretches ---

    def _acting(self, reset: Flags) -> Ints:
        """Return the lines that act on the frame or move in a way of their own."""
        acts = self.lines.flag("acts")
        if not acts.any():
            return np.flatnonzero(reset)
        work = np.append(np.int8(self.state.groups["frame"]), self.modes.work)
        again = self.lines.flag("work_only") & (work[1:] == work[:-1])
        again &= (self.modes.work != MANY_WORK) & ~reset
        if self.state.frames.unsettled or self.lines.flag("sets_tables").any():
            again[:] = False
        if not self.state.frames.known and again.any():
            again[int(np.argmax(again))] = False
        return np.flatnonzero((acts & ~again) | reset)

    def _after_end(self) -> Flags:
        """Return the lines before which a control that goes on has reset the work offset."""
        resets = "frame" in self.dialect.program_rule.resets_at_end
        return np.append(False, self.lines.flag("ends")[:-1] & resets)[: self.lines.live]

    def _stretches(self, moving: Flags, lost: Flags) -> Stretches:
        """Return the stretches: a line that does more than move along begins one."""
        busy = np.append(0, np.cumsum(moving | lost | self.track.worded)).tolist()
        leaving, reset = self._leaves(lost), self._after_end()
        acting = self._acting(reset)
        own = (self.lines.flag("own_moves") | self.lines.flag("calls"))[acting]
        drills = self.drilling.borders()
        singles = np.flatnonzero(moving & self.tied.single if self.tied.any else moving[:0])
        alone = np.concatenate([acting[own], singles])
        jumped = self.lines.lost_before(self.axes)
        ends = np.array([0, self.lines.live, *leaving, *jumped], np.int64)
        borders = distinct(np.concatenate([acting, alone, alone + 1, drills, ends])).tolist()
        acts, resets, taps = (set(x.tolist()) for x in (acting, np.flatnonzero(reset), singles))
        pairs = list(pairwise(borders)) or [(0, 0)]
        return Stretches(pairs, acts, resets, taps, leaving, jumped, busy)

    def _stretch(
        self, first: int, last: int, of: Stretches, moving: Flags, lost: Flags | None
    ) -> Rows | Own | None:
        """Return the rows of a stretch; None where it has none, or they are made at the end."""
        self._refuse_other_units(first, first + 1)
        if first in of.resets:
            self.track.reset_work(first)
        self._lose_before(first, of)
        if first in of.acts:
            self.track.act(first)
        if self.in_planes is not None:
            self.in_planes.check(first, last, first in of.acts)
        if first in of.acts:
            own = own_moves(self.track, first)
            if own is not None:
                self.drilling.moved()
                return own
        self._refuse_other_units(first + 1, last)
        if self.drilling.follows(first, last):
            return None
        if first in of.singles:
            return self.tied.row(first)
        if of.busy[last] == of.busy[first]:
            return None
        if self.shifted is not None and self.shifted.takes(first, last):
            self.shifted.follow(first, last)
            return None
        rows = np.flatnonzero(moving[first:last]) + first
        ends = self.track.along(first, last, rows, lost)
        return self._plain(rows, ends, constant(len(self.track.frames) - 1, len(rows), np.int64))

    def _lose_before(self, first: int, of: Stretches) -> None:
        """Let go of what the first line of a stretch does not know any more."""
        if first in of.leaving or (first + 1 in of.leaving and first in of.acts):
            self.track.lose_all(first)
        if first in of.lost:
            self.track.lose(first, of.lost[first])

    def _plain(self, line: Ints, ends: Floats, frame: Ints) -> Rows:
        """Return rows that are one plain move a line, threads and splines among them."""
        plain = self.tied.plain(line, ends, frame)
        plain = self.nurbs.marked(plain)
        return with_splines(plain) if self.bends else plain

    def _refuse_other_units(self, first: int, last: int) -> None:
        """Refuse a change of units under a tool length that would become another one by it."""
        if not self._new_units or not any(self.state.frames.tool):
            return
        for line in (line for line in self._new_units if first <= line < last):
            message = "another unit under a tool length, whose number this control then keeps"
            self.findings.add(line, "GX213", message, hint=TOOL_BACK)

    # --- the path ---

    def _path(self, rows: Rows) -> Toolpath:
        """Return the rows as a toolpath; arcs get their centres."""
        line, rows = rows.line, blind_rows(self.track, rows)
        at_side = self.state.at_side
        path = self._fed(self._unfinished(rows), rows).replace(leaving=self.state.leaving)
        if len(line):
            self.state.rapid = bool(path.kind[-1] == Kind.RAPID)
            self.state.row_frame = self.track.frames[int(path.frame[-1])]
        refuse_ends(self.lines, self.modes, path, line)
        if self.side.any():
            self._refuse_mirrored(path)
        self.nurbs.refuse_unknown_start(path)
        if len(line) and (self.state.pull or self.bends):
            path = read_splines(path, self.lines, self.modes)
        if path.has_arcs:
            words = words_of_arcs(self.track, line[path.is_arc])
            path = resolve_arcs(path, words, self.lines)
        return with_corners(self.nurbs.as_beziers(path), self.lines, at_side)

    def _unfinished(self, rows: Rows) -> Toolpath:
        """Return the rows as a toolpath with feeds as numbers in force, and without centres."""
        count, line = len(rows.line), rows.line
        return Toolpath(
            self.axes,
            rows.kind,
            rows.end,
            np.broadcast_to(np.nan, (count, 3)),
            constant(0.0, count),
            self.modes.plane[line],
            self.modes.feed[line],
            self.modes.feed_mode[line],
            rows.frame,
            line + self.lines.window.first_line,
            rows.nth,
            rows.form,
            picked(self.side, line),
            picked(self.radius, line),
            self._lost_before(line, rows.nth),
            np.broadcast_to(np.nan, (count, 2, 3)),
            self._tools(line),
            self.track.entry,
            tuple(self.track.frames),
            Blocks(
                self.lines.window.first_line,
                self.modes.inch,
                self.modes.incremental,
                self.modes.extruded == 1,
                self.modes.absolute_centre,
                self.modes.feed_mode,
                self.lines.flag("ends") | self.lines.flag("loses_position"),
                self.lines.apart,
                self.track.named(self.lines.flag("own_moves")) | axes_led(self.lines, self.axes),
            ),
            events_of(self.lines, line, self.drilling.calls, self.drilling.events),
            first=self.state.frames.first,
            after_rapid=self.state.rapid,
        )

    def _tools(self, line: Ints) -> Floats:
        """Return the tool axis at the ends of rows, nan where the program does not say it."""
        if self.pointing is None:
            return np.broadcast_to(np.nan, (len(line), 3))
        return self.pointing.vectors()[line]

    def _refuse_mirrored(self, path: Toolpath) -> None:
        """Refuse cutter compensation in a mirror: controls differ in the side it is then on."""
        wrong = (path.side != 0) & path.mirrored
        for row in np.flatnonzero(wrong)[: Findings.enough].tolist():
            message = "cutter compensation in a mirror: which side is meant is not certain"
            self.findings.add(int(path.block[row]), "GX230", message)

    def _lost_before(self, line: Ints, nth: Ints) -> Ints:
        """Return of which axes the position was lost between each row and the row before."""
        if not self.track.breaks and not self.state.lost:
            return constant(0, len(line), np.int64)
        lost = np.zeros(len(line) + 1, np.int64)
        lost[0] = self.state.lost
        at = np.searchsorted(line, [found.line for found in self.track.breaks])
        for place, found in zip(at.tolist(), self.track.breaks, strict=True):
            lost[place] |= found.axes
        self.state.lost = int(lost[-1])
        return lost[:-1]

    def _fed(self, path: Toolpath, rows: Rows) -> Toolpath:
        """Return the path with feeds in mm/min, 1/min, mm/turn, or deg/min for rotary axes alone.

        The path has the numbers that are in force.
        """
        unit = self.modes.feed_unit[rows.line]
        feed, mode = path.feed, path.feed_mode
        if not (unit == 1.0).all():
            plain = mode == NUMBER["G93"]
            plain |= turns_only(path) & (path.kind < Kind.ARC_CW)
            feed = np.where(plain, feed, feed * unit)
        feed, mode = self.tied.paced_rows(rows, feed, mode)
        return path.replace(feed=feed, feed_mode=mode)
