"""Moves that something else than the program ends or paces: the spindle (G33, G33.1, G76), a probe.

A thread (G33) is one straight move, in step with the spindle. A tap (G33.1) goes to its end and
back to where it began. A probe goes towards its target and stops where it touches something, so
that afterwards the axes it names stand at an unknown place. What the control refuses is refused.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from gcxform.catalogue.remedies import leave_out_block
from gcxform.dialect.dialect import INCH
from gcxform.modal.findings import Findings
from gcxform.modal.frames.track import SPATIAL, Break, Track
from gcxform.modal.meaning.tables import NUMBER, PROBES, TAP, THREAD, THREAD_CYCLE
from gcxform.modal.moves.blind_moves import note_way
from gcxform.modal.moves.rows import Own, Rows
from gcxform.modal.moves.thread_cycles import thread_cycle
from gcxform.modal.state import CYCLE_OFF, UNKNOWN_SPINDLE
from gcxform.system.arrays import Flags, Floats, Ints, Small
from gcxform.system.distinct import one_of
from gcxform.toolpath.path import FeedMode, Form, Kind

Objection = tuple[Flags, str, str]


class Tied:
    """The lines of a window whose motion is a thread, a tap or a probe."""

    def __init__(self, track: Track) -> None:
        self.track = track
        self.lines, self.modes = track.lines, track.modes
        motion = self.modes.motion
        self.cycle = np.asarray((motion == THREAD_CYCLE) & (self.modes.cycle == CYCLE_OFF))
        self.any = bool(((motion >= THREAD) & (motion <= PROBES[-1]) | self.cycle).any())
        self.thread = np.asarray(motion == THREAD)
        self.tap = np.asarray(motion == TAP)
        self.probe = one_of(motion, PROBES)
        self.paced = self.thread | self.tap
        self.driven = self.paced | self.cycle

    @property
    def single(self) -> Flags:
        """(lines,) whether the line is more than a plain row: a tap, a probe, or G76."""
        return np.asarray(self.tap | self.probe | self.cycle)

    def check(self, moves: Flags, own: Flags) -> None:
        """Refuse the lines that the control refuses; `moves` are those that move."""
        if not self.any:
            return
        taken = np.zeros(len(moves), np.bool_)
        for which, message, hint in self._objections(moves, own):
            for line in np.flatnonzero(which & ~own & ~taken)[: Findings.enough].tolist():
                code = self._code(line)
                self.track.findings.add(line, "GX216", message.format(code=code), hint=hint)
            taken |= which

    def _code(self, line: int) -> str:
        number = int(self.modes.motion[line])
        return next(code for code, n in NUMBER.items() if n == number and code[:2] in ("G3", "G7"))

    def _objections(self, moves: Flags, own: Flags) -> Iterator[Objection]:
        stated = self.lines.stated("motion") | self.lines.flag("has_centre")
        bare = (self.driven | self.probe) & stated & ~moves
        yield bare, "{code} without an axis word", "write the motion code in the block that moves"
        yield from self._about_words(moves)
        spindle = self.modes.spindle
        still = self.driven & moves & ((spindle == 0) | (spindle == UNKNOWN_SPINDLE))
        yield still, "{code}, but the spindle does not turn", "write M3 or M4 before it"
        beside = (self.driven | self.probe) & moves & (self.modes.comp > 0)
        yield beside, "{code} beside cutter compensation", "write G40 before it"
        other = self.probe & moves & (self.modes.feed_mode != FeedMode.PER_MINUTE)
        yield other, "{code} cannot be fed in inverse time or per turn", "write G94"

    def _about_words(self, moves: Flags) -> Iterator[Objection]:
        paced = self.paced & moves
        for letter, known in (("J", paced), ("R", paced), ("I", paced & self.thread)):
            yield known & self._has(letter), f"{{code}} takes no {letter}", ""
        yield paced & ~self._has("K"), "{code} without K, its way per turn", "give it in this block"
        yield paced & self._has("F"), "{code} takes no F: K is its way per turn", "leave it out"
        rotary = np.zeros(len(moves), np.bool_)
        for axis in self.track.axes[3:]:
            rotary |= self._has(axis)
        yield paced & self.tap & rotary, "{code} taps along X, Y and Z alone", ""

    def _has(self, letter: str) -> Flags:
        word = self.lines.word(letter, distance=False)
        return np.zeros(self.lines.live, np.bool_) if word is None else word[1]

    # --- rows ---

    def plain(self, rows: Ints, ends: Floats, frame: Ints) -> Rows:
        """Return rows that are one move a line; threads are lines of a form of their own."""
        motion = self.modes.motion[rows]
        found = Rows.plain(rows, motion, ends, frame)
        thread = self.thread[rows]
        if not thread.any():
            return found
        kind = np.where(thread, np.int8(Kind.LINE), motion)
        form = np.where(thread, Form.THREAD, Form.PLAIN).astype(np.int8)
        return Rows(found.line, kind, found.end, found.nth, form, found.frame)

    def row(self, line: int) -> Own:
        """Return the rows of a line that is a tap, a probe or a thread in passes."""
        if self.cycle[line]:
            return thread_cycle(self.track, line)
        return tap(self.track, line) if self.tap[line] else probe(self.track, line)

    def paced_rows(self, rows: Rows, feed: Floats, mode: Small) -> tuple[Floats, Small]:
        """Return feeds and feed modes of rows, those of threads and taps from their K words."""
        free = (rows.form != Form.MACHINE) & (rows.form != Form.HOME)
        unit = np.where(self.modes.inch[rows.line], INCH, 1.0)
        for letter, lines in (("K", self.paced), ("P", self.cycle)):
            paced = lines[rows.line] & free
            word = self.lines.word(letter, lines) if paced.any() else None
            if word is not None:
                feed = np.where(paced, word[0][rows.line] * unit, feed)
                mode = np.where(paced, np.int8(FeedMode.PER_TURN), mode)
        return feed, mode


def tap(track: Track, line: int) -> Own:
    """Return the moves of a tap: to its end, and back to where it began."""
    start = track.state.position.copy()
    end = track.along(line, line + 1, np.array([line]), None)[0]
    track.state.position = start.copy()
    moves: list[tuple[int, Floats]] = [(Kind.LINE, end), (Kind.LINE, start)]
    return Own(line, Form.SYNCHRONISED, moves, len(track.frames) - 1)


def probe(track: Track, line: int) -> Own:
    """Return the move of a probe; where the axes it names stand afterwards is not known."""
    start = track.state.position.copy()
    end = track.along(line, line + 1, np.array([line]), None)[0]
    named = track.words_on(line)
    if not named or np.array_equal(start, end):
        message = "a probing move that goes nowhere"
        track.findings.add(line, "GX216", message, hint=leave_out_block())
    if track.may_step[line] and any(np.isnan(end[track.axes.index(axis)]) for axis in named):
        note_way(track, line)
    lost = sum(1 << track.axes.index(axis) for axis in named)
    if lost & SPATIAL and track.frame.matrix is not None:
        lost |= SPATIAL
    for k in range(len(track.axes)):
        if lost >> k & 1:
            track.state.position[k] = np.nan
    track.note_lost(lost)
    track.breaks.append(Break(line + 1, lost))
    return Own(line, Form.PROBE, [(Kind.LINE, end)], len(track.frames) - 1)
