"""Which move of the output belongs to which move of the input, by the source map.

    source  (lines of the output,) line s of the program that each came from, from 0
    nth     (lines of the output,) which of the moves of s its first move is
    count   (lines of the window,) rows of the program in each line; `row_of_line` the first, or -1

Defined: the owner of a written row i in output line j is row_of_line[s_j] + nth_j + (nth of i in
its line), where line s_j has so many rows, else -1, and then the proof fails. Nothing claimed hangs
on the map being right: with a wrong owner the paths are apart.
"""

from __future__ import annotations

import numpy as np

from gcxform.deviations.runs import Runs, runs_of
from gcxform.system.arrays import Flags, Ints
from gcxform.toolpath.path import Toolpath
from gcxform.toolpath.travel import ways


class Trace:
    """Which move of the output belongs to which move of the input.

    `lines` are those of the window, from 0; `written` are the moves as read from the output,
    `after` what the machine does with them.
    """

    def __init__(
        self,
        before: Toolpath,
        lines: range,
        written: Toolpath,
        after: Toolpath,
        source: Ints,
        nth: Ints,
        first: int,
    ) -> None:
        self.before = before
        self.written = written
        self.after = after
        self.source = source
        self.first = first
        self._nth = nth
        line = before.source - lines.start
        self._count = np.bincount(line, minlength=len(lines))
        self._row_of_line = np.where(self._count > 0, np.cumsum(self._count) - self._count, -1)
        self._first_line = lines.start
        self.owner = self.owners(after)
        self.written_owner = self.owner if after is written else self.owners(written)
        self.through = self.written_owner

    def find_runs(self) -> Runs:
        """Find which moves of the input each move stands for."""
        runs = runs_of(self.before, self.owner)
        same = self.written_owner is self.owner
        self.through = (runs if same else runs_of(self.before, self.written_owner)).through
        return runs

    def owners(self, path: Toolpath) -> Ints:
        """Return the row of the input that each move belongs to, -1 if there is none."""
        written = path.source - self.first
        lines = self.source[written] - self._first_line
        first = self._row_of_line[lines]
        nth = path.nth + self._nth[written]
        return np.where((first >= 0) & (nth < self._count[lines]), first + nth, -1)

    def line_of(self, output_line: int) -> int:
        """Return the input line of an output line, both from 0."""
        index = output_line - self.first
        return int(self.source[index]) if 0 <= index < len(self.source) else 0

    def lines_of(self, output_lines: Ints) -> Ints:
        """Return the input lines of output lines, (n,), both from 0."""
        index = output_lines - self.first
        inside = (index >= 0) & (index < len(self.source))
        return np.where(inside, self.source[np.where(inside, index, 0)], 0)

    def stand_before(self, written_rows: Ints, rows: Ints, short: float) -> Flags:
        """Whether what stands before written moves stands before those rows of the input.

        Rows no longer than `short` (mm) together may have been left out on either side of it.
        All are of shape (n,).
        """
        if not len(self.written_owner):
            return np.ones(len(rows), np.bool_)
        last = len(self.written_owner) - 1
        later = self.written_owner[np.minimum(written_rows, last)] >= rows
        later |= written_rows > last
        earlier = self.through[np.maximum(written_rows - 1, 0)] < rows
        earlier |= written_rows == 0
        for at in np.flatnonzero(later & ~earlier):
            earlier[at] = self._ends_before(int(written_rows[at]) - 1, int(rows[at]), short)
        return earlier & later

    def _ends_before(self, written_row: int, row: int, short: float) -> bool:
        """Whether a written move stands for too little from a row on to matter."""
        through = int(self.through[written_row])
        rest = slice(row, through + 1)
        if int(self.written_owner[written_row]) >= row or self.before.is_arc[rest].any():
            return False
        rows = np.arange(row, through + 1)
        return float(ways(self.before, rows).sum()) <= short
