"""Canned cycles in a program: which blocks call one, with which words, and the rows they become.

The words of a cycle stay in force from block to block, so a block alone does not tell what it does:
what is a call, and what its words mean, is settled here, on columns. The moves themselves are made
by `gcxform/modal/cycles.py`, in the coordinates of the program.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gcxform.dialect import INCH
from gcxform.modal.cycles import UNKNOWN, Calls, Cycles, Steps
from gcxform.modal.rows import Rows
from gcxform.modal.state import CYCLE_OFF
from gcxform.modal.track import Break, Track
from gcxform.toolpath.path import Event, Form, Plane, constant

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Flags = NDArray[np.bool_]

SPINDLE = np.array([0, 1, -1, UNKNOWN])
"""How the spindle turns, by the number of its mode: stopped, M3, M4, not known."""


class Drilling:
    """Reads the cycles of one window; `state.cycles` goes on from window to window.

    `events` are what is done within cycles: the first line of a stretch, and its events, whose rows
    count from the first of the stretch.
    """

    def __init__(self, track: Track) -> None:
        self.track = track
        self.lines, self.modes = track.lines, track.modes
        self.cycles: Cycles | None = self.lines.state.cycles
        self.events: list[tuple[int, tuple[Event, ...]]] = []
        self.calls = self._calls()

    def _calls(self) -> Flags:
        """Return the lines that call a cycle."""
        active = self.modes.cycle != CYCLE_OFF
        return np.asarray(active & self.lines.flag("drills")) if active.any() else active

    def borders(self) -> Ints:
        """Return the lines at which a stretch of calls begins or ends."""
        modes, calls = self.modes, self.calls
        if not calls.any():
            return np.empty(0, np.int64)
        way = np.where(calls, 1 + modes.plane + 256 * modes.inch, 0)
        return np.flatnonzero(np.diff(way, prepend=0))

    def leave(self, first: int, last: int) -> None:
        """Forget what cycles keep where lines end cycle mode, or begin another."""
        if self.cycles is not None and (self.modes.cycle[first:last] == CYCLE_OFF).any():
            self.cycles.leave()

    def rows(self, first: int, last: int) -> Rows:
        """Return the moves of a stretch of calls."""
        assert self.cycles is not None
        here = np.arange(first, last)
        calls = self._columns(here)
        self._refuse_other_count(here)
        steps = self.cycles.expand(calls)
        for refusal in steps.refusals:
            line = int(here[refusal.call])
            self.track.findings.add(line, "GX215", refusal.message, hint=refusal.hint)
        if steps.refusals:
            nothing = np.empty((0, len(self.track.axes)))
            return Rows.plain(here[:0], self.modes.motion[:0], nothing, 0)
        return self._placed(here, calls, steps)

    def _word(self, address: str, here: Ints) -> Floats:
        """Return a word on lines, nan where there is none; lengths in mm."""
        axis, count = address in self.track.axes, address in ("P", "L", self._repeats)
        if axis:
            word = self.track.column(address)
        else:
            word = self.lines.word(address, self.calls, distance=not count)
        if word is None:
            return np.full(len(here), np.nan)
        value = np.where(word[1][here], word[0][here], np.nan)
        return value if axis or count else value * self._unit(here)

    def _unit(self, here: Ints) -> Floats:
        return np.where(self.modes.inch[here], INCH, 1.0)

    @property
    def _repeats(self) -> str:
        rule = self.lines.dialect.cycle_rule
        return rule.repeats if rule is not None else ""

    def _columns(self, here: Ints) -> Calls:
        modes = self.modes
        plane = Plane(int(modes.plane[here[0]]))
        first, second, normal = ("XYZ"[axis] for axis in plane.axes)
        words = self.track.frame.words(self.lines.state.position[None, :])[0]
        others = [a for a in self.track.axes if a not in "XYZ"]
        absent = np.full(len(here), np.nan)
        return Calls(
            modes.cycle[here].astype(np.int64),
            self._word(first, here),
            self._word(second, here),
            self._word(normal, here),
            self._word("R", here),
            self._word("Q", here),
            self._dwell(here),
            self._word(self._repeats, here),
            self._word("I", here),
            self._word("J", here),
            absent if self._repeats == "K" else self._word("K", here),
            modes.incremental[here],
            modes.retract[here] == 1,
            SPINDLE[modes.spindle[here]],
            np.any([~np.isnan(self._word(a, here)) for a in others], axis=0)
            if others
            else np.zeros(len(here), np.bool_),
            modes.feed_mode[here] == 93,
            here + self.lines.window.first_line,
            words[list(plane.axes)],
            plane,
            INCH if modes.inch[here[0]] else 1.0,
        )

    def _refuse_other_count(self, here: Ints) -> None:
        """Refuse L where K counts the holes: it would be left out."""
        if self._repeats != "K":
            return
        for line in here[~np.isnan(self._word("L", here))].tolist():
            message, hint = "L counts nothing here: this control repeats cycles by K", "write K"
            self.track.findings.add(line, "GX215", message, "L", hint)

    def _dwell(self, here: Ints) -> Floats:
        """Return the P words as seconds."""
        dialect, plain = self.lines.dialect, self._word("P", here)
        if not dialect.dwell_point_is_seconds:
            return plain * dialect.dwell["P"]
        slot = self.lines.table.slots[self.lines.shape[here], ord("P") - 65]
        number = self.lines.first[here] + np.maximum(slot, 0)
        pointed = (slot >= 0) & (self.lines.window.decimals[number] >= 0)
        return np.where(pointed, plain, plain * dialect.dwell["P"])

    def _placed(self, here: Ints, calls: Calls, steps: Steps) -> Rows:
        """Return the moves as rows, and take over where the tool is after them."""
        track, rows, first_line = self.track, steps.rows, int(here[0])
        count, axes = len(rows.call), list(calls.plane.axes)
        words = np.tile(track.frame.words(track.state.position[None, :]), (count + 1, 1))
        words[:count, axes] = rows.end
        words[count, axes] = steps.after[-1]
        ends = track.frame.positions(words)
        track.state.position = ends[-1].copy()
        if (calls.code == 88).any():
            track.breaks.append(Break(int(here[-1]) + 1, 1 << axes[2]))
            track.state.position[axes[2]] = np.nan  # the operator has moved it
        starts = np.searchsorted(rows.call, rows.call)
        self.events.append((first_line, rows.events))
        form = np.where(rows.synchronised, Form.SYNCHRONISED, Form.CYCLE).astype(np.int8)
        return Rows(
            here[rows.call],
            rows.kind,
            np.asfortranarray(ends[:-1]),
            np.arange(count) - starts,
            form,
            constant(len(track.frames) - 1, count, np.int64),
        )
