"""Canned cycles in a program: where each pattern leaves the tool, and the rows that it becomes.

What follows a pattern begins where it ends, so that end is found at once, from the columns of
`gcxform/modal/moves/cycle_calls.py`. The moves themselves are made by
`gcxform/modal/cycles/expansion.py`, in the coordinates of the program, for all patterns of a window
together: that is what makes many short patterns cheap.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from gcxform.dialect.dialect import INCH, ROTARY
from gcxform.modal.cycles.expansion import Calls, Cycles
from gcxform.modal.cycles.stretch import Mode, Stretch
from gcxform.modal.frames.track import PLANES, Break, Track
from gcxform.modal.moves.cycle_calls import CallColumns
from gcxform.modal.moves.pattern_ends import PatternEnd, pattern_ends
from gcxform.modal.moves.rows import Rows
from gcxform.modal.numbers_without_point import hint_of_rounding
from gcxform.modal.state import CYCLE_OFF
from gcxform.system.arrays import Flags, Floats, Ints
from gcxform.system.distinct import union
from gcxform.toolpath.frames import Frame, by_frame
from gcxform.toolpath.path import Event, Form, Plane
from gcxform.values import dataclass

MANUAL = 88  # the cycle out of which the operator moves the tool
TURNING = "words of rotary axes in a cycle turn them on the way to the hole, and drill it"


@dataclass(frozen=True, slots=True)
class _Followed:
    """A stretch: its lines, plane, unit; words (axes,), frame and dwell (s) in force before it.

    `stretch` are its columns; None where they are found later, with those of others. `turns` are
    the rotary axes that it turns, as it is one call then: which, to where, and by how much a hole.
    """

    first: int
    last: int
    plane: Plane
    unit: float
    words: list[float]
    frame: int
    dwell: float
    stretch: Stretch | None
    turns: tuple[tuple[int, float, float], ...] = ()


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
        self.columns = CallColumns(track)
        self.calls = self.columns.calls
        self.columns.lost[[*self._lost]] = True
        self._followed: list[_Followed] = []
        self.ends: dict[int, PatternEnd] = {}

    def take(self, borders: Sequence[tuple[int, int]]) -> None:
        """Take the stretches of the window, before the first of them is followed."""
        if self.cycles is not None and self.calls.any():
            self.ends = pattern_ends(self.columns, borders)

    def borders(self) -> Ints:
        """Return the lines at which a stretch of calls begins or ends."""
        modes, calls = self.modes, self.calls
        if not calls.any():
            return np.empty(0, np.int64)
        way = np.where(calls, 1 + modes.plane + 256 * modes.inch, 0)
        borders = np.flatnonzero(np.diff(way, prepend=0))
        turned = np.flatnonzero(calls & self.columns.common.turned)
        alone = union(np.flatnonzero(self._placeless), [*self._lost, *turned])
        if not len(alone):
            return borders
        alone = alone.astype(np.int64)
        return np.concatenate([borders, alone, alone + 1])

    def moved(self) -> None:
        """Note that a block has moved in a way of its own, perhaps while a cycle is in force."""
        if self.cycles is not None:
            self.cycles.zero = None

    def refuse_unknown(self) -> None:
        """Refuse levels and steps of canned cycles that only the machine knows.

        They would stay in force. Where in the plane a call drills is lost like the end of a move.
        """
        for each in self.lines.unknown:
            line, address = each.line, each.text[0]
            if self.modes.cycle[line] == CYCLE_OFF or address not in self.track.axes:
                continue
            if "XYZ".find(address) in self._lost.get(line, ()):
                continue
            if each.rounded:
                inch = bool(self.modes.inch[line])
                message = f"{address} of a cycle is computed: how it is rounded is not known"
                hint = hint_of_rounding(address, inch)
                self.lines.findings.add(line, "GX205", message, address, hint)
            else:
                message = "a canned cycle goes where only the machine knows"
                self.lines.findings.add(line, "GX220", message, address)

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
        track, plane = self.track, PLANES[self.modes.plane[first]]
        unit = INCH if self.modes.inch[first] else 1.0
        words = list(track.frame.words_of(track.state.position.tolist()))
        for axis in self._lost.get(first, ()):
            words[axis] = np.nan  # a word without a value looks absent
        after = words.copy()
        stretch, dwell = None, self.cycles.mode.dwell
        self._refuse_other_zero(first, last, plane.axes[2])
        plain = None if self.cycles.mode.code or track.frame.polar else self.ends.get(first)
        if plain is not None:
            end = self._plain_end(first, plain, words, plane)
        else:
            before = np.array([words[axis] for axis in plane.axes])
            calls = self.columns.calls_on(slice(first, last), before, plane, unit)
            calls = self._in_coordinates(calls, slice(first, last))
            stretch = self.cycles.follow(calls)
            end = stretch.after[-1].tolist()
        for axis, place in zip(plane.axes, end, strict=True):
            after[axis] = place
        turns = self._turns(first, words) if self.columns.common.turned[first] else ()
        for k, place, _ in turns:
            after[k] = place
        at = len(track.frames) - 1, dwell, stretch, turns
        self._followed.append(_Followed(first, last, plane, unit, words, *at))
        track.state.position = np.array(track.frame.point(after))
        if self._placeless[first]:
            self._leave_open(first, words, after)
        if self._has_manual and (self.modes.cycle[first:last] == MANUAL).any():
            track.breaks.append(Break(last, 1 << plane.axes[2]))

    def _turns(self, line: int, words: list[float]) -> tuple[tuple[int, float, float], ...]:
        """Return the rotary axes that a call turns: which, to where, and by how much a hole.

        `words` (axes,) are those in force before it. A call that drills nothing turns nothing.
        """
        track, found = self.track, []
        if track.state.frames.following or track.state.frames.plane is not None:
            message = "a canned cycle turns axes in a tilted plane, or while the tip is followed"
            track.findings.add(line, "GX215", message, hint="move them before it")
        for axis, word in track.words_on(line).items():
            k, step, before = track.axes.index(axis), 0.0, words[track.axes.index(axis)]
            if axis not in ROTARY or not self.columns.counts[line] > 0:
                continue
            if self.modes.incremental[line]:
                track.refuse_steps(np.array([np.isnan(before)]), axis, line, None)
                step, word = word, before + word * self.columns.counts[line]
            found.append((k, float(word), float(step)))
            track.state.assumed[TURNING] = None
        return tuple(found)

    @cached_property
    def _has_manual(self) -> bool:
        """Whether the window has a cycle out of which the operator moves the tool."""
        return bool((self.modes.cycle == MANUAL).any())

    def _refuse_other_zero(self, first: int, last: int, normal: int) -> None:
        """Refuse G98 where coordinates have changed, or G28 has moved, while a cycle is in force.

        Not where words do not outlive their cycle: that control goes back to the same number.
        """
        assert self.cycles is not None
        frame = self.track.frame
        zero = frame.shift[normal], frame.origin[normal], frame.matrix
        other = self.cycles.mode.code and zero != self.cycles.zero
        self.cycles.zero = zero
        if not (other and self.cycles.rule.stays.words):
            return
        for line in np.flatnonzero(self.columns.common.initial[first:last])[:1].tolist():
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

    def _plain_end(
        self, first: int, plain: PatternEnd, words: list[float], plane: Plane
    ) -> list[float]:
        """Return where the tool is after a plain stretch; take over the dwell that it leaves."""
        assert self.cycles is not None
        if plain.dwell == plain.dwell:
            self.cycles.mode = Mode(dwell=plain.dwell)
        end = [self._arrived(axis, first, plain, words[axis]) for axis in plane.axes[:2]]
        initial = words[plane.axes[2]]
        if not plain.drills:
            return [*end, initial]
        clearance = plain.clearance + initial if plain.relative else plain.clearance
        return [*end, float(np.maximum(initial, clearance)) if plain.high else clearance]

    def _arrived(self, axis: int, first: int, plain: PatternEnd, before: float) -> float:
        """Return where an axis of the plane is after a plain stretch."""
        word = plain.words[axis]
        placed = word == word
        steps = self.columns.increments_along("XYZ"[axis]) if plain.stepped else None
        if steps is None:
            return word if placed else before
        place = int(self.columns.lasts("XYZ"[axis])[plain.last - 1])
        moved = np.cumsum(steps[first : plain.last])
        return float((word - moved[place - first] if placed else before) + moved[-1])

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
        if self.columns.repeats != "K" or not self._followed:
            return
        counted = self.calls & ~np.isnan(self.columns.word("L", slice(None)))
        for line in np.flatnonzero(counted).tolist():
            message = "L counts nothing here: this control repeats cycles by K"
            hint = 'write K, or say cycle-repeats = "L" in [control] of the machine file'
            self.track.findings.add(line, "GX215", message, "L", hint)

    def _refuse_without_place(self) -> None:
        """Refuse calls of which a setting decides if they drill, where that matters."""
        rule = self.lines.dialect.cycle_rule
        if self._stays or rule is None:
            return
        for line in np.flatnonzero(self._placeless).tolist():
            first, second, _ = ("XYZ"[k] for k in Plane(int(self.modes.plane[line])).axes)
            message = f"a cycle without {first} and {second}: a setting decides if it drills"
            hint = rule.hint_without_place(first, second)
            self.track.findings.add(line, "GX215", message, hint=hint)

    @property
    def _stays(self) -> bool:
        """Whether cycles are not written anew, so that what a setting decides may stay open."""
        return self.cycles is not None and self.cycles.open_pecks

    @cached_property
    def _placeless(self) -> Flags:
        """The calls that name no place in the plane, where a setting decides if they drill."""
        found = np.zeros(self.lines.live, np.bool_)
        rule, control = self.lines.dialect.cycle_rule, self.lines.reading.control
        if rule is None or not rule.place_is_open(control):
            return found
        drills = self.calls & (self.columns.word(self.columns.repeats, slice(None)) != 0)
        has = {letter: ~np.isnan(self.columns.word(letter, slice(None))) for letter in "XYZR"}
        for plane in Plane:
            first, second, normal = ("XYZ"[axis] for axis in plane.axes)
            named = has[normal] | has["R"] | self.columns.common.turned
            here = drills & (self.modes.plane == plane) & named
            found |= here & ~has[first] & ~has[second]
        return found

    @cached_property
    def _lost(self) -> dict[int, list[int]]:
        """The axes of the plane of which only the machine knows where a call drills, by line."""
        found: dict[int, list[int]] = {}
        for each in self.lines.unknown:
            axis = "XYZ".find(each.text[0])
            plane = Plane(int(self.modes.plane[each.line])).axes[:2]
            if self.calls[each.line] and axis in plane and not self.modes.incremental[each.line]:
                found.setdefault(each.line, []).append(axis)
        return found

    def _leave_open(self, line: int, words: list[float], after: list[float]) -> None:
        """Let go of the level behind a call, if it depends on whether the call drills."""
        normal = Plane(int(self.modes.plane[line])).axes[2]
        if after[normal] != words[normal]:
            self.track.lose(line + 1, "XYZ"[normal] if self.track.frame.matrix is None else "XYZ")

    def _stretches(
        self, followed: list[_Followed], words: Floats, line: Ints, bounds: Ints
    ) -> list[Stretch]:
        """Return the columns of stretches, those of plain ones as one."""
        stretches = [one.stretch for one in followed if one.stretch is not None]
        if stretches:
            return stretches
        assert self.cycles is not None
        positions = words[:, list(followed[0].plane.axes)]
        calls = self.columns.calls_on(line, positions[0], followed[0].plane, followed[0].unit)
        dwells = np.array([one.dwell for one in followed])
        return [self.cycles.follow_fresh(calls, bounds[:-1], positions, dwells)]

    def _rows_of(self, followed: list[_Followed]) -> Rows:
        """Return the moves of stretches of one plane and unit."""
        assert self.cycles is not None
        first, last = np.array([(one.first, one.last) for one in followed]).T
        bounds = np.append(0, np.cumsum(last - first))
        line = np.arange(bounds[-1]) + np.repeat(first - bounds[:-1], last - first)
        before = np.array([one.words for one in followed])
        steps = self.cycles.steps(self._stretches(followed, before, line, bounds))
        asked = {at for at, _ in self.lines.findings.found}  # a word that has no value looks absent
        for refusal in steps.refusals:
            place = int(line[refusal.call])
            if place in asked and "without" in refusal.message:
                continue
            self.track.findings.add(place, "GX215", refusal.message, hint=refusal.hint)
        rows = steps.rows
        bounds = np.searchsorted(rows.call, bounds)
        self._place_events(rows.events, bounds, first)
        which = np.repeat(np.arange(len(followed)), np.diff(bounds))
        words = before.T[:, which].T
        words[:, list(followed[0].plane.axes)] = rows.end
        for n in [n for n, one in enumerate(followed) if one.turns]:
            turned = slice(*bounds[n : n + 2])
            turn_axes(words[turned], rows.hole[turned], followed[n].turns)
        frame = np.array([one.frame for one in followed])[which]
        return Rows(
            line[rows.call],
            rows.kind,
            by_frame(Frame.positions, self.track.frames, frame, words, 1.0),
            np.arange(len(rows.call)) - np.searchsorted(rows.call, rows.call),
            np.where(rows.synchronised, Form.SYNCHRONISED, Form.CYCLE).astype(np.int8),
            frame,
        )

    def _place_events(self, events: tuple[Event, ...], bounds: Ints, firsts: Ints) -> None:
        """Keep events by stretch, their rows counted from the first of it."""
        if not events:
            return
        lines = [event.line - self.lines.window.first_line for event in events]
        whose = np.searchsorted(firsts, lines, "right") - 1
        behind = np.array([event.row for event in events]) - bounds[whose]
        self.events += zip(firsts[whose].tolist(), behind.tolist(), events, strict=True)


def turn_axes(words: Floats, hole: Ints, turns: tuple[tuple[int, float, float], ...]) -> None:
    """Turn axes on the way to holes, in the words (n, axes) of the moves of one call.

    `hole` (n,) counts the holes from 1, and is 0 where the tool rises before it goes to the first.
    """
    going = hole > 0
    for k, place, step in turns:
        words[going, k] = place - step * (hole[-1:] - hole)[going]
