"""The calls of canned cycles in a window: which blocks are one, and with which words.

The words of a cycle stay in force from block to block, so a block alone does not tell what it does.
Here are the columns from which that is seen: each word on all lines, where it stood last, and what
the modes of a line are to a cycle. They are made once for a window, because a program may have
thousands of patterns of a few holes, and numpy is slow on few numbers. What the calls do is found
by `gcxform/modal/moves/cycle_patterns.py`.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from gcxform.dialect.dialect import INCH, ROTARY
from gcxform.modal.cycles.expansion import UNKNOWN, Calls
from gcxform.modal.findings import Findings
from gcxform.modal.frames.track import Track
from gcxform.modal.state import CYCLE_OFF
from gcxform.system.arrays import Flags, Floats, Ints
from gcxform.toolpath.columns import constant
from gcxform.toolpath.path import Plane
from gcxform.values import dataclass

SPINDLE = np.array([0, 1, -1, UNKNOWN])
"""How the spindle turns, by the number of its mode: stopped, M3, M4, not known."""


@dataclass(frozen=True, slots=True)
class _Common:
    """Columns of a window that the calls of all its stretches are cut from; see `Calls`."""

    code: Ints
    initial: Flags
    spindle: Ints
    turned: Flags
    other_axes: Flags
    inverse: Flags
    line: Ints


class CallColumns:
    """The calls of one window, and columns of their words: nan where a line has none, mm and s.

    `calls` are the lines that call a cycle, `lost` those of them that name an axis of the plane
    whose value only the machine knows. The columns are made when first asked for, because most
    windows have no cycle.
    """

    def __init__(self, track: Track) -> None:
        self.track = track
        self.lines, self.modes = track.lines, track.modes
        self.calls = self._calls()
        self.lost = np.zeros(self.lines.live, np.bool_)
        self._columns: dict[str, Floats] = {}
        self._lasts: dict[str, Ints] = {}
        self._increments: dict[str, Floats | None] = {}

    def _calls(self) -> Flags:
        """Return the lines that call a cycle."""
        active = self.modes.cycle != CYCLE_OFF
        return np.asarray(active & self.lines.flag("drills")) if active.any() else active

    @cached_property
    def repeats(self) -> str:
        """The letter of the word that counts repeats, "" for none."""
        rule = self.lines.dialect.cycle_rule
        return rule.repeats if rule is not None else ""

    def word(self, address: str, here: int | slice | Ints) -> Floats:
        """Return a word on lines, or on one, nan where there is none; lengths in mm."""
        if address not in self._columns:
            self._columns[address] = self._column(address)
        return np.asarray(self._columns[address][here])

    def _column(self, address: str) -> Floats:
        """Return a word on all lines of the window, nan where it is none of a call's."""
        if not address:
            return constant(np.nan, self.lines.live)
        axis, count = address in self.track.axes, address in ("P", "L", self.repeats)
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
        """Return P words as seconds; those that count what is not known are refused."""
        lines = self.lines
        slot = lines.table.slots[lines.shape, ord("P") - 65]
        decimals = lines.window.decimals[np.where(slot >= 0, lines.first + slot, 0)]
        seconds = plain.copy()
        for pointed in (False, True):
            here = (plain != 0) & ~np.isnan(plain) & ((decimals >= 0) == pointed)
            unit = lines.pointless.dwell("P", 0 if pointed else -1) if here.any() else 1.0
            if unit is None:
                self._refuse_dwells(here)
            else:
                seconds[here] *= unit
        return seconds

    def _refuse_dwells(self, here: Flags) -> None:
        """Refuse dwells on lines: the increment system alone does not tell what they count."""
        for line in np.flatnonzero(here)[: Findings.enough].tolist():
            message = "P has no decimal point: its unit depends on the control"
            hint = "give the increment as a length: P counts ms then"
            self.lines.findings.add(line, "GX205", message, "P", hint)

    def lasts(self, address: str) -> Ints:
        """Return the last call with a word, on each line or before it; -1 for none.

        Words of axes count where they place a hole in G90.
        """
        if address not in self._lasts:
            which = self.calls if address in ("P", "R") else self._drilled & ~self.modes.incremental
            which = which & ~np.isnan(self.word(address, slice(None)))
            self._lasts[address] = self._latest(which)
        return self._lasts[address]

    def _latest(self, which: Flags) -> Ints:
        """Return the last of some lines on each line or before it, -1 for none."""
        places = np.where(which, np.arange(self.lines.live), -1)
        return np.asarray(np.maximum.accumulate(places))

    @cached_property
    def _drilled(self) -> Flags:
        """The calls that drill."""
        rule = self.lines.dialect.cycle_rule
        letters = "XYZR" if rule is not None and rule.stores else "XYZ"
        named = [~np.isnan(self.word(letter, slice(None))) for letter in letters]
        named.append(self.common.turned)
        return np.asarray(self.calls & np.any(named, axis=0) & (self.counts > 0))

    @cached_property
    def last_drilled(self) -> Ints:
        """The last call that drills, on each line or before it; -1 for none."""
        return self._latest(self._drilled)

    @cached_property
    def counts(self) -> Floats:
        """How often each line drills."""
        repeats = self.word(self.repeats, slice(None))
        return np.where(np.isnan(repeats), 1.0, repeats)

    def increments_along(self, axis: str) -> Floats | None:
        """Return how far each line goes by increments, all of its repeats; None if none does."""
        if axis not in self._increments:
            stepping = self._drilled & self.modes.incremental
            way = self.word(axis, slice(None)) * self.counts
            along = np.where(stepping & ~np.isnan(way), way, 0.0)
            self._increments[axis] = along if stepping.any() else None
        return self._increments[axis]

    @cached_property
    def added_until(self) -> Ints:
        """How many lines before each line are in G91."""
        return np.append(0, np.cumsum(self.modes.incremental))

    @cached_property
    def changes_until(self) -> Ints:
        """How many lines before each line have another cycle than the line before them."""
        return np.append(0, np.cumsum(np.diff(self.modes.cycle, prepend=CYCLE_OFF) != 0))

    @cached_property
    def common(self) -> _Common:
        """What the modes of all lines are to cycles."""
        modes, lines = self.modes, self.lines
        rule = lines.dialect.cycle_rule
        turns = ROTARY if rule is not None and rule.turns else ""
        turned, other_axes = np.zeros((2, lines.live), np.bool_)
        for axis in self.track.axes:
            word = None if axis in "XYZ" else self.track.column(axis)
            if word is not None:
                which = turned if axis in turns else other_axes
                which |= word[1]
        return _Common(
            modes.cycle.astype(np.int64),
            modes.retract == 1,
            SPINDLE[modes.spindle],
            turned,
            other_axes,
            modes.feed_mode == 93,
            np.arange(lines.live) + lines.window.first_line,
        )

    def calls_on(self, here: slice | Ints, position: Floats, plane: Plane, unit: float) -> Calls:
        """Return the blocks on lines; `position` (3,) is where the tool stands before them."""
        modes = self.modes
        first_axis, second_axis, normal = ("XYZ"[axis] for axis in plane.axes)
        common = self.common
        return Calls(
            common.code[here],
            self.word(first_axis, here),
            self.word(second_axis, here),
            self.word(normal, here),
            self.word("R", here),
            self.word("Q", here),
            self.word("P", here),
            self.word(self.repeats, here),
            self.word("I", here),
            self.word("J", here),
            self.word("" if self.repeats == "K" else "K", here),
            modes.incremental[here],
            common.initial[here],
            common.spindle[here],
            common.turned[here],
            common.other_axes[here],
            common.inverse[here],
            self.lost[here],
            common.line[here],
            position,
            plane,
            unit,
        )
