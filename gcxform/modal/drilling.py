"""Canned cycles in a program: which blocks call one, with which words, and the rows they become.

The words of a cycle stay in force from block to block, so a block alone does not tell what it does:
what is a call, and what its words mean, is settled here, on columns. The moves themselves are made
by `gcxform/modal/cycles.py`, in the coordinates of the program.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from gcxform.dialect import INCH
from gcxform.modal.cycles import UNKNOWN, Calls, Cycles
from gcxform.modal.cyclestretch import Mode, Stretch
from gcxform.modal.rows import Rows
from gcxform.modal.state import CYCLE_OFF
from gcxform.modal.track import Break, Track
from gcxform.toolpath.frames import Frame, by_frame
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
    """A stretch: its lines, plane, unit; words (axes,), frame and dwell (s) in force before it.

    `stretch` are its columns; None where they are found later, with those of others.
    """

    first: int
    last: int
    plane: Plane
    unit: float
    words: Floats
    frame: int
    dwell: float
    stretch: Stretch | None


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
        self._lasts: dict[str, Ints] = {}
        self._steps: dict[str, Floats | None] = {}
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

    def moved(self) -> None:
        """Note that a block has moved in a way of its own, perhaps while a cycle is in force."""
        if self.cycles is not None:
            self.cycles.zero = None

    # --- stretches, as they come ---

    def follows(self, first: int, last: int) -> bool:
        """Whether a stretch is one of calls; if it is, take over where the tool is after it.

        What cycles keep is forgotten where other lines end cycle mode, or begin another.
        """
        cycles = self.cycles
        if cycles is None or first == last:
            return False
        if self.calls[first]:
            self._follow(first, last)
            return True
        if cycles.mode.code and (self.modes.cycle[first:last] == CYCLE_OFF).any():
            cycles.leave()
        return False

    def _follow(self, first: int, last: int) -> None:
        """Read a stretch of calls."""
        assert self.cycles is not None
        track, plane = self.track, Plane(int(self.modes.plane[first]))
        unit = INCH if self.modes.inch[first] else 1.0
        words = track.frame.words(track.state.position[None, :])[0]
        after = words.copy()
        stretch, dwell = None, self.cycles.mode.dwell
        self._refuse_other_zero(first, last, plane.axes[2])
        if not track.frame.polar and self._is_plain(first, last):
            after[list(plane.axes)] = self._plain_end(first, last, words, plane)
        else:
            calls = self._calls_on(slice(first, last), words[list(plane.axes)], plane, unit)
            calls = self._in_coordinates(calls, slice(first, last))
            stretch = self.cycles.follow(calls)
            after[list(plane.axes)] = stretch.after[-1]
        frame = len(track.frames) - 1
        self._followed.append(_Followed(first, last, plane, unit, words, frame, dwell, stretch))
        track.state.position = track.frame.positions(after[None, :])[0].copy()
        if self._any_manual and self._manual[first:last].any():
            track.breaks.append(Break(last, 1 << plane.axes[2]))

    def _refuse_other_zero(self, first: int, last: int, normal: int) -> None:
        """Refuse G98 where coordinates have changed, or G28 has moved, while a cycle is in force.

        Not where words do not outlive their cycle: that control goes back to the same number.
        """
        assert self.cycles is not None
        frame = self.track.frame
        zero = frame.shift[normal], frame.origin[normal], frame.matrix
        other = self.cycles.mode.code and zero != self.cycles.zero
        self.cycles.zero = zero
        if not (other and self.cycles.rule.keeps_words):
            return
        for line in np.flatnonzero(self._common.initial[first:last])[:1].tolist():
            message = "another work offset or G28 within a cycle: the level of G98 is not certain"
            hint = "write G80 before, and all words again"
            self.track.findings.add(first + line, "GX215", message, hint=hint)

    def _in_coordinates(self, calls: Calls, here: slice) -> Calls:
        """Return calls with coordinates where their words are radius and angle (G16)."""
        if not self.track.frame.polar:
            return calls
        placed = self.track.polar(here).values()
        first, second = (np.where(given, value, np.nan) for value, given in placed)
        return replace(calls, first=first, second=second)

    def _is_plain(self, first: int, last: int) -> bool:
        """Whether a stretch begins without a cycle in force, ends with G80, and has one cycle."""
        assert self.cycles is not None
        if self.cycles.mode.code or last == self.lines.live:
            return False
        changes = self._changes_until[last] - self._changes_until[first + 1]
        return bool(self.modes.cycle[last] == CYCLE_OFF and not changes)

    @cached_property
    def _changes_until(self) -> Ints:
        """How many lines before each line have another cycle than the line before them."""
        return np.append(0, np.cumsum(np.diff(self.modes.cycle, prepend=CYCLE_OFF) != 0))

    def _plain_end(self, first: int, last: int, words: Floats, plane: Plane) -> list[float]:
        """Return where the tool is after a plain stretch; take over the dwell that it leaves."""
        assert self.cycles is not None
        before = [float(words[axis]) for axis in plane.axes]
        place = self._last("P", last - 1)
        if place >= first:
            self.cycles.mode = Mode(dwell=float(self._word("P", place)))
        end = [
            self._arrived("XYZ"[axis], first, last, standing)
            for axis, standing in zip(plane.axes[:2], before, strict=False)
        ]
        called, initial = int(self._last_drilled[last - 1]), before[2]
        if called < first:
            return [*end, initial]
        place = self._last("R", called)
        clearance = float(self._word("R", place)) if place >= first else np.nan
        if self.modes.incremental[called]:
            clearance += initial
        high = bool(self._common.initial[called])
        return [*end, float(np.maximum(initial, clearance)) if high else clearance]

    def _arrived(self, axis: str, first: int, last: int, before: float) -> float:
        """Return where an axis of the plane is after a plain stretch."""
        place, steps = self._last(axis, last - 1), self._steps_along(axis)
        placed = place >= first
        word = float(self._word(axis, place)) if placed else before
        if steps is None or self._added_until[first] == self._added_until[last]:
            return word
        moved = np.cumsum(steps[first:last])
        return float((word - moved[place - first] if placed else before) + moved[-1])

    def _steps_along(self, axis: str) -> Floats | None:
        """Return how far each line goes by increments, all of its repeats; None if none does."""
        if axis not in self._steps:
            stepping = self._drilled & self.modes.incremental
            way = self._word(axis, slice(None)) * self._counts
            along = np.where(stepping & ~np.isnan(way), way, 0.0)
            self._steps[axis] = along if stepping.any() else None
        return self._steps[axis]

    @cached_property
    def _added_until(self) -> Ints:
        """How many lines before each line are in G91."""
        return np.append(0, np.cumsum(self.modes.incremental))

    @cached_property
    def _counts(self) -> Floats:
        """How often each line drills."""
        repeats = self._word(self._repeats, slice(None))
        return np.where(np.isnan(repeats), 1.0, repeats)

    @cached_property
    def _drilled(self) -> Flags:
        """The calls that drill."""
        assert self.cycles is not None
        letters = "XYZR" if self.cycles.rule.stores else "XYZ"
        named = [~np.isnan(self._word(letter, slice(None))) for letter in letters]
        return np.asarray(self.calls & np.any(named, axis=0) & (self._counts > 0))

    def _latest(self, which: Flags) -> Ints:
        """Return the last of some lines on each line or before it, -1 for none."""
        places = np.where(which, np.arange(self.lines.live), -1)
        return np.asarray(np.maximum.accumulate(places))

    @cached_property
    def _last_drilled(self) -> Ints:
        return self._latest(self._drilled)

    def _last(self, address: str, line: int) -> int:
        """Return the last call with a word, on a line or before it; -1 for none.

        Words of axes count where they place a hole in G90.
        """
        if address not in self._lasts:
            which = self.calls if address in ("P", "R") else self._drilled & ~self.modes.incremental
            which = which & ~np.isnan(self._word(address, slice(None)))
            self._lasts[address] = self._latest(which)
        return int(self._lasts[address][line])

    def _word(self, address: str, here: int | slice | Ints) -> Floats:
        """Return a word on lines, or on one, nan where there is none; lengths in mm."""
        if address not in self._words:
            self._words[address] = self._column(address)
        return np.asarray(self._words[address][here])

    def _column(self, address: str) -> Floats:
        """Return a word on all lines of the window, nan where it is none of a call's."""
        if not address:
            return constant(np.nan, self.lines.live)
        axis, count = address in self.track.axes, address in ("P", "L", self._repeats)
        if axis:
            word = self.track.column(address)
        else:
            word = self.lines.word(address, self.calls, distance=not count)
        if word is None:
            return constant(np.nan, self.lines.live)
        value = np.where(word[1], word[0], np.nan)
        if address == "P":
            return self._seconds(value)
        inches = not (axis or count) and self.modes.inch.any()
        return value * np.where(self.modes.inch, INCH, 1.0) if inches else value

    def _seconds(self, plain: Floats) -> Floats:
        """Return P words as seconds."""
        dialect, lines = self.lines.dialect, self.lines
        if not dialect.dwell_point_is_seconds:
            return plain * dialect.dwell["P"]
        slot = lines.table.slots[lines.shape, ord("P") - 65]
        number = np.where(slot >= 0, lines.first + slot, 0)
        pointed = (slot >= 0) & (lines.window.decimals[number] >= 0)
        return np.where(pointed, plain, plain * dialect.dwell["P"])

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
    def _any_manual(self) -> bool:
        return bool(self._manual.any())

    @cached_property
    def _manual(self) -> Flags:
        """The lines in a cycle out of which the operator moves the tool."""
        return np.asarray(self.modes.cycle == MANUAL)

    @cached_property
    def _repeats(self) -> str:
        rule = self.lines.dialect.cycle_rule
        return rule.repeats if rule is not None else ""

    def _calls_on(self, here: slice | Ints, position: Floats, plane: Plane, unit: float) -> Calls:
        """Return the blocks on lines; `position` (3,) is where the tool stands before them."""
        modes = self.modes
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
            position,
            plane,
            unit,
        )

    # --- all stretches of the window ---

    def rows(self) -> list[Rows]:
        """Return the moves of the stretches."""
        self._refuse_other_count()
        self._refuse_without_place()
        kinds: dict[tuple[Plane, float, bool], list[_Followed]] = {}
        for one in self._followed:
            kinds.setdefault((one.plane, one.unit, one.stretch is None), []).append(one)
        return [self._rows_of(followed) for followed in kinds.values()]

    def _refuse_other_count(self) -> None:
        """Refuse L where K counts the holes: it would be left out."""
        if self._repeats != "K" or not self._followed:
            return
        counted = self.calls & ~np.isnan(self._word("L", slice(None)))
        for line in np.flatnonzero(counted).tolist():
            message, hint = "L counts nothing here: this control repeats cycles by K", "write K"
            self.track.findings.add(line, "GX215", message, "L", hint)

    def _refuse_without_place(self) -> None:
        """Refuse calls that name no place in the plane, where a setting decides if they drill."""
        rule, control = self.lines.dialect.cycle_rule, self.lines.reading.control
        if rule is None or not rule.alone or control.get(rule.alone) == "drills":
            return
        drills = self.calls & (self._word(self._repeats, slice(None)) != 0)
        has = {letter: ~np.isnan(self._word(letter, slice(None))) for letter in "XYZR"}
        for plane in Plane:
            first, second, normal = ("XYZ"[axis] for axis in plane.axes)
            here = drills & (self.modes.plane == plane) & (has[normal] | has["R"])
            for line in np.flatnonzero(here & ~has[first] & ~has[second]).tolist():
                message = f"a cycle without {first} and {second}: a setting decides if it drills"
                hint = f'give {first} or {second}, or say [control] {rule.alone} = "drills"'
                self.track.findings.add(line, "GX215", message, hint=hint)

    def _stretches(self, followed: list[_Followed], line: Ints, bounds: Ints) -> list[Stretch]:
        """Return the columns of stretches, those of plain ones as one."""
        stretches = [one.stretch for one in followed if one.stretch is not None]
        if stretches:
            return stretches
        assert self.cycles is not None
        axes = list(followed[0].plane.axes)
        positions = np.array([one.words[axes] for one in followed])
        calls = self._calls_on(line, positions[0], followed[0].plane, followed[0].unit)
        dwells = np.array([one.dwell for one in followed])
        return [self.cycles.follow_fresh(calls, bounds[:-1], positions, dwells)]

    def _rows_of(self, followed: list[_Followed]) -> Rows:
        """Return the moves of stretches of one plane and unit."""
        assert self.cycles is not None
        line = np.concatenate([np.arange(one.first, one.last) for one in followed])
        bounds = np.cumsum([0, *(one.last - one.first for one in followed)])
        steps = self.cycles.steps(self._stretches(followed, line, bounds))
        for refusal in steps.refusals:
            place = int(line[refusal.call])
            self.track.findings.add(place, "GX215", refusal.message, hint=refusal.hint)
        rows = steps.rows
        bounds = np.searchsorted(rows.call, bounds)
        self._place_events(rows.events, bounds, [one.first for one in followed])
        which = np.repeat(np.arange(len(followed)), np.diff(bounds))
        words = np.array([one.words for one in followed]).T[:, which].T
        words[:, list(followed[0].plane.axes)] = rows.end
        frame = np.array([one.frame for one in followed])[which]
        return Rows(
            line[rows.call],
            rows.kind,
            by_frame(Frame.positions, self.track.frames, frame, words, 1.0),
            np.arange(len(rows.call)) - np.searchsorted(rows.call, rows.call),
            np.where(rows.synchronised, Form.SYNCHRONISED, Form.CYCLE).astype(np.int8),
            frame,
        )

    def _place_events(self, events: tuple[Event, ...], bounds: Ints, firsts: list[int]) -> None:
        """Keep events by stretch, their rows counted from the first of it."""
        if not events:
            return
        lines = [event.line - self.lines.window.first_line for event in events]
        whose = np.searchsorted(firsts, lines, "right") - 1
        behind = np.array([event.row for event in events]) - bounds[whose]
        stretch = np.array(firsts)[whose]
        self.events += zip(stretch.tolist(), behind.tolist(), events, strict=True)
