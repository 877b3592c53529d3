"""Stretches whose frame only shifts coordinates, in G90: filled for a whole window at once.

Programs are full of short stretches: every tool, work offset and shift begins one. Where one ends
is looked up, because the next begins there; where its moves end is found for all stretches
together, by a table with a row for each.
"""

from __future__ import annotations

import numpy as np

from gcxform.modal.frames.track import Track
from gcxform.system.arrays import Flags, Floats, Ints
from gcxform.toolpath.columns import column_major


class Shifted:
    """The stretches of one window that are filled together.

    `moving` (lines,) are the lines that are one plain move.
    """

    def __init__(self, track: Track, moving: Flags) -> None:
        self.track = track
        self.moving = moving
        words = [(k, track.column(axis)) for k, axis in enumerate(track.axes)]
        line = np.arange(len(moving))
        self.words = [
            (k, word[0], np.maximum.accumulate(np.where(word[1], line, -1)))
            for k, word in words
            if word is not None
        ]
        added = track.worded & (track.modes.incremental | (track.modes.extruded == 1))
        self._added_until = np.append(0, np.cumsum(added)) if added.any() else None
        self._bounds: list[tuple[int, int]] = []
        self._frames: list[int] = []
        self._entries: list[list[float]] = []

    def takes(self, first: int, last: int) -> bool:
        """Whether a stretch is one of these, in the frame that is in force."""
        frame, until = self.track.frame, self._added_until
        if not frame.shifts_only or frame.polar:
            return False
        return until is None or bool(until[first] == until[last])

    def follow(self, first: int, last: int) -> None:
        """Take over where the axes are after a stretch; its moves are made later."""
        track = self.track
        position = track.state.position.copy()
        entry = position.tolist()
        shift = track.frame.added
        for k, value, until in self.words:
            place = until[last - 1]
            if place >= first:
                position[k] = value[place] + shift[k]
        track.state.position = position
        self._bounds.append((first, last))
        self._frames.append(len(track.frames) - 1)
        self._entries.append(entry)

    def rows(self) -> tuple[Ints, Floats, Ints]:
        """Return the lines (n,) of the moves, their ends (n, axes) and their frames (n,)."""
        if not self._bounds:
            nothing = np.empty(0, np.int64)
            return nothing, np.empty((0, len(self.track.axes))), nothing
        bounds = np.array(self._bounds)
        line = np.flatnonzero(self.moving)
        begin, end = np.searchsorted(line, bounds.T)
        count = end - begin
        stretch = np.repeat(np.arange(len(bounds)), count)
        if len(stretch) < len(line):
            before = begin - (np.cumsum(count) - count)
            line = line[np.arange(len(stretch)) + before[stretch]]
        return line, self._ends(line, stretch, bounds[:, 0]), np.array(self._frames)[stretch]

    def _ends(self, line: Ints, stretch: Ints, firsts: Ints) -> Floats:
        """Return where moves end: at the last word of their stretch, or where that began."""
        shifts = np.array([self.track.frames[number].added for number in self._frames])
        entries = np.array(self._entries)
        ends = column_major(len(line), len(self.track.axes))
        first = firsts[stretch]
        for k in range(ends.shape[1]):
            ends[:, k] = entries[stretch, k]
        for k, value, until in self.words:
            place = until[line]
            named = value[place] + shifts[stretch, k]
            ends[:, k] = np.where(place >= first, named, ends[:, k])
        return ends
