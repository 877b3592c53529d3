"""Which lines of a program in a language of its own are written out, with what is executed in them.

Those are the smallest: the call of a subprogram of which a line becomes another each time, or the
loop around it, by lines that are executed in one go. A loop that its last line ends goes whole.
Lines that are called from elsewhere as well stay, and the call in question is written out.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import accumulate

import numpy as np

from gcxform.flow.translated import Translated
from gcxform.system.arrays import Ints
from gcxform.values import dataclass


@dataclass(frozen=True)
class Unit:
    """Lines of a program that are written out: the first and the last, and why.

    `begin` and `end` are their executions, first and last, with those of what they call.
    """

    first: int
    last: int
    begin: int
    end: int
    why: str


class Walk:
    """The lines of a program in the order in which they are executed."""

    def __init__(self, source: Translated) -> None:
        self.source, self.translator = source, source.translator
        self.lines = source.executed_lines()
        own = np.zeros(len(source.lines) + 1, np.bool_)
        own[[k for k in range(len(source.lines)) if self.translator.is_own(k)]] = True
        self.own = np.flatnonzero(own[self.lines] & (self.lines >= 0))
        """The executions of lines of the program itself."""
        self.depth = self._depths()
        """How deep in calls of its own lines they are executed (own,)."""
        self.loops = self.translator.loops()

    def _depths(self) -> Ints:
        changes = [(0, 0), *self.translator.depths()]
        visits, depths = (np.array(each, np.int64) for each in zip(*changes, strict=True))
        return depths[np.searchsorted(visits, self.own, "left") - 1]

    def unit(self, visit: int, why: str) -> Unit:
        """Return what is to be written out where an execution of a line cannot stay."""
        at = int(np.searchsorted(self.own, visit, "right")) - 1
        while True:
            line = int(self.lines[self.own[at]])
            found = self.around(line, line, at, why)
            if not self.depth[at] or self._is_alone(found):
                return found
            at = int(np.flatnonzero(self.depth[:at] < self.depth[at])[-1])

    def _is_alone(self, unit: Unit) -> bool:
        """Whether the lines of a unit are executed nowhere else."""
        lines = self.lines[self.own]
        found = self.own[(lines >= unit.first) & (lines <= unit.last)]
        return bool(unit.begin <= found[0] and found[-1] <= unit.end)

    def _level(self, at: int) -> Ints:
        """Return the executions of lines in the call of one of them, but for calls in it."""
        less = np.flatnonzero(self.depth < self.depth[at])
        k = int(np.searchsorted(less, at))
        begin = int(less[k - 1]) + 1 if k else 0
        stop = int(less[k]) if k < len(less) else len(self.own)
        return begin + np.flatnonzero(self.depth[begin:stop] == self.depth[at])

    def around(self, first: int, last: int, at: int, why: str) -> Unit:
        """Return the smallest unit with some lines of the program, in the call of one of them."""
        level = self._level(at)
        lines = self.lines[self.own[level]]
        while True:
            inside = np.flatnonzero((lines >= first) & (lines <= last))
            among = lines[inside[0] : inside[-1] + 1]
            ends = [(int(among.min()), int(among.max())), *self._crossed(first, last)]
            low = min(first, *(each[0] for each in ends))
            high = max(last, *(each[1] for each in ends))
            if (low, high) == (first, last):
                break
            first, last = low, high
        begin, behind = self.own[level[inside[0]]], inside[-1] + 1
        end = self.own[level[behind]] - 1 if behind < len(level) else len(self.lines) - 1
        return Unit(first, last, int(begin), int(end), why)

    def _crossed(self, first: int, last: int) -> list[tuple[int, int]]:
        """Return the loops that lines stand in, or begin or end."""
        return [each for each in self.loops if each[0] <= last and first <= each[1]]

    def together(self, units: Iterable[Unit]) -> list[Unit]:
        """Return units of which none has lines of another one, in the order of their lines."""
        found: list[Unit] = []
        for unit in sorted(units, key=lambda each: each.first):
            if found and unit.first <= found[-1].last:
                before = found.pop()
                last = max(before.last, unit.last)
                at = int(np.searchsorted(self.own, min(before.begin, unit.begin)))
                unit = self.around(before.first, last, at, before.why)
            found.append(unit)
        found.sort(key=lambda each: (each.begin, -each.end))
        ends = accumulate((each.end for each in found), max, initial=-1)
        return [unit for unit, behind in zip(found, ends, strict=False) if unit.begin > behind]
