"""Canned cycles in a program: which blocks call one, with which words, and the rows they become.

The words of a cycle stay in force from block to block, so a block alone does not tell what it does:
what is a call, and what its words mean, is settled here, on columns. The moves themselves are made
by `gcxform/modal/cycles.py`, in the coordinates of the program.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from gcxform.dialect import INCH
from gcxform.modal.cycles import UNKNOWN, Calls, Cycles
from gcxform.modal.cyclestretch import Stretch
from gcxform.modal.rows import Rows
from gcxform.modal.state import CYCLE_OFF
from gcxform.modal.track import Break, Track
from gcxform.toolpath.path import Event, Form, Plane, constant

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Flags = NDArray[np.bool_]

SPINDLE = np.array([0, 1, -1, UNKNOWN])
"""How the spindle turns, by the number of its mode: stopped, M3, M4, not known."""


MANUAL = 88


@dataclass(frozen=True, slots=True)
class _Common:
    """Columns of a window that the calls of all its stretches are cut from; see `Calls`."""

    code: Ints
    initial: Flags
    spindle: Ints
    other_axes: Flags
    inverse: Flags
    line: Ints


@dataclass(frozen=True, slots=True)
class _Followed:
    """A stretch: its first line, its columns, the words (axes,) before it, and its frame."""

    first: int
    stretch: Stretch
    words: Floats
    frame: int


class Drilling:
    """Reads the cycles of one window; `state.cycles` goes on from window to window.

    Stretches are followed one by one, because each begins where what is before it ends; their moves
    are made at once, at the end. `events` are what is done within cycles: the first line of a
    stretch, how many rows behind its first, and what.
    """

    def __init__(self, track: Track) -> None:
        self.track = track
        self.lines, self.modes = track.lines, track.modes
        self.cycles: Cycles | None = self.lines.state.cycles
        self.events: list[tuple[int, int, Event]] = []
        self.calls = self._calls()
        self._words: dict[str, Floats] = {}
        self._followed: list[_Followed] = []

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

    # --- stretches, as they come ---

    def follow(self, first: int, last: int) -> None:
        """Read a stretch of calls, and take over where the tool is after it."""
        assert self.cycles is not None
        here, track = slice(first, last), self.track
        words = track.frame.words(track.state.position[None, :])[0]
        calls = self._calls_on(here, words)
        stretch = self.cycles.follow(calls)
        self._followed.append(_Followed(first, stretch, words, len(track.frames) - 1))
        after = words.copy()
        after[list(calls.plane.axes)] = stretch.after[-1]
        track.state.position = track.frame.positions(after[None, :])[0].copy()
        if self._manual and (calls.code == MANUAL).any():
            track.breaks.append(Break(last, 1 << calls.plane.axes[2]))

    def _word(self, address: str, here: slice) -> Floats:
        """Return a word on lines, nan where there is none; lengths in mm."""
        if address not in self._words:
            self._words[address] = self._column(address)
        return self._words[address][here]

    def _column(self, address: str) -> Floats:
        """Return a word on all lines of the window, nan where it is none of a call's."""
        if not address:
            return constant(np.nan, self.lines.live)
        axis, count = address in self.track.axes, address in ("P", self._repeats)
        if axis:
            word = self.track.column(address)
        else:
            word = self.lines.word(address, self.calls, distance=not count)
        if word is None:
            return constant(np.nan, self.lines.live)
        value = np.where(word[1], word[0], np.nan)
        if address == "P":
            return value * self.lines.dialect.dwell["P"]
        inches = not (axis or count) and self.modes.inch.any()
        return value * np.where(self.modes.inch, INCH, 1.0) if inches else value

    @cached_property
    def _common(self) -> _Common:
        """What the modes of all lines are to cycles."""
        modes, lines = self.modes, self.lines
        other_axes = np.zeros(lines.live, np.bool_)
        for axis in self.track.axes:
            word = None if axis in "XYZ" else self.track.column(axis)
            if word is not None:
                other_axes |= word[1]
        return _Common(
            modes.cycle.astype(np.int64),
            modes.retract == 1,
            SPINDLE[modes.spindle],
            other_axes,
            modes.feed_mode == 93,
            np.arange(lines.live) + lines.window.first_line,
        )

    @cached_property
    def _manual(self) -> bool:
        """Whether there are cycles out of which the operator moves the tool."""
        return bool((self.modes.cycle == MANUAL).any())

    @cached_property
    def _repeats(self) -> str:
        rule = self.lines.dialect.cycle_rule
        return rule.repeats if rule is not None else ""

    def _calls_on(self, here: slice, words: Floats) -> Calls:
        """Return the blocks of a stretch; `words` (axes,) are where the axes stand before it."""
        modes, first = self.modes, here.start
        plane = Plane(int(modes.plane[first]))
        first_axis, second_axis, normal = ("XYZ"[axis] for axis in plane.axes)
        common = self._common
        return Calls(
            common.code[here],
            self._word(first_axis, here),
            self._word(second_axis, here),
            self._word(normal, here),
            self._word("R", here),
            self._word("Q", here),
            self._word("P", here),
            self._word(self._repeats, here),
            self._word("I", here),
            self._word("J", here),
            self._word("" if self._repeats == "K" else "K", here),
            modes.incremental[here],
            common.initial[here],
            common.spindle[here],
            common.other_axes[here],
            common.inverse[here],
            common.line[here],
            words[list(plane.axes)],
            plane,
            INCH if modes.inch[first] else 1.0,
        )

    # --- all stretches of the window ---

    def rows(self) -> list[Rows]:
        """Return the moves of the stretches, in their order."""
        found: dict[int, Rows] = {}
        kinds = [(f.stretch.calls.plane, f.stretch.calls.unit) for f in self._followed]
        for kind in dict.fromkeys(kinds):
            numbers = [number for number, other in enumerate(kinds) if other == kind]
            found.update(zip(numbers, self._rows_of(numbers), strict=True))
        return [found[number] for number in range(len(kinds))]

    def _rows_of(self, numbers: list[int]) -> Iterator[Rows]:
        """Yield the moves of stretches of one plane and unit."""
        assert self.cycles is not None
        followed = [self._followed[number] for number in numbers]
        steps = self.cycles.steps([one.stretch for one in followed])
        line = np.concatenate([one.stretch.calls.line for one in followed])
        line -= self.lines.window.first_line
        for refusal in steps.refusals:
            place = int(line[refusal.call])
            self.track.findings.add(place, "GX215", refusal.message, hint=refusal.hint)
        rows = steps.rows
        bounds = np.cumsum([0, *(len(one.stretch.calls) for one in followed)])
        bounds = np.searchsorted(rows.call, bounds)
        self._place_events(rows.events, bounds, [one.first for one in followed])
        nth = np.arange(len(rows.call)) - np.searchsorted(rows.call, rows.call)
        form = np.where(rows.synchronised, Form.SYNCHRONISED, Form.CYCLE).astype(np.int8)
        for one, (begin, end) in zip(followed, pairwise(bounds.tolist()), strict=True):
            here = slice(begin, end)
            words = np.empty((len(one.words), end - begin)).T
            words[:] = one.words
            words[:, list(one.stretch.calls.plane.axes)] = rows.end[here]
            ends = self.track.frames[one.frame].positions(words)
            frame = constant(one.frame, end - begin, np.int64)
            yield Rows(line[rows.call[here]], rows.kind[here], ends, nth[here], form[here], frame)

    def _place_events(self, events: tuple[Event, ...], bounds: Ints, firsts: list[int]) -> None:
        """Keep events by stretch, their rows counted from the first of it."""
        if not events:
            return
        lines = [event.line - self.lines.window.first_line for event in events]
        whose = np.searchsorted(firsts, lines, "right") - 1
        for number, event in zip(whose.tolist(), events, strict=True):
            self.events.append((firsts[number], event.row - int(bounds[number]), event))
