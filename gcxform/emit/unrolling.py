"""Which lines of a program in a language of its own are written out, with what is executed in them.

Those are the smallest: the call of a subprogram of which a line becomes another each time, or the
loop around it, by lines that are executed in one go. A loop that its last line ends goes whole, and
so does what else begins with one line and ends with another, where one of these goes. A jump out of
them takes along what it passes over, and one between them goes where it leads to. Lines that are
called from elsewhere as well stay, and the call in question is written out.
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


class Executed:
    """Executions `at` some places of the walk, in their order, and the `lines` that they are of."""

    def __init__(self, at: Ints, lines: Ints) -> None:
        self.at, self.lines = at, lines
        self.named, self.first = np.unique(lines, return_index=True)
        self.last = len(lines) - 1 - np.unique(lines[::-1], return_index=True)[1]

    def among(self, first: int, last: int) -> tuple[int, int]:
        """Return the first execution of lines up to another, and the last one, from 0."""
        low, high = np.searchsorted(self.named, (first, last + 1))
        return int(self.first[low:high].min()), int(self.last[low:high].max())


class Walk:
    """The lines of a program in the order in which they are executed."""

    def __init__(self, source: Translated) -> None:
        self.source, self.translator = source, source.translator
        self.lines = source.executed_lines()
        own = np.zeros(len(source.lines) + 1, np.bool_)
        own[[k for k in range(len(source.lines)) if self.translator.in_main(k)]] = True
        self.own = np.flatnonzero(own[self.lines] & (self.lines >= 0))
        """The executions of lines of the main program."""
        self.depth = self._depths()
        """How deep in calls of its own lines they are executed (own,)."""
        self._loops = np.array(self.translator.loops(), np.int64).reshape(-1, 2)
        self._branches = [(each[0], each[-1]) for each in self.translator.branches()]
        parting = [(a, k) for k, each in enumerate(self.translator.branches()) for a in each]
        self._parting = np.array(sorted(parting), np.int64).reshape(-1, 2)
        self._executed = Executed(np.arange(len(self.own)), self.lines[self.own])
        self._less: dict[int, Ints] = {}
        self._levels: dict[int, Executed] = {}

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
            at = self._call(at)[0] - 1

    def _is_alone(self, unit: Unit) -> bool:
        """Whether the lines of a unit are executed nowhere else."""
        first, last = self._executed.among(unit.first, unit.last)
        return bool(unit.begin <= self.own[first] and self.own[last] <= unit.end)

    def _call(self, at: int) -> tuple[int, int]:
        """Return the first execution in the call that one of a line is in, and the one behind."""
        depth = int(self.depth[at])
        if depth not in self._less:
            self._less[depth] = np.flatnonzero(self.depth < depth)
        less = self._less[depth]
        k = int(np.searchsorted(less, at))
        return int(less[k - 1]) + 1 if k else 0, int(less[k]) if k < len(less) else len(self.own)

    def _level(self, at: int) -> Executed:
        """Return the executions of lines in the call of one of them, but for calls in it."""
        begin, stop = self._call(at)
        if begin not in self._levels:
            level = begin + np.flatnonzero(self.depth[begin:stop] == self.depth[at])
            self._levels[begin] = Executed(level, self.lines[self.own[level]])
        return self._levels[begin]

    def around(self, first: int, last: int, at: int, why: str) -> Unit:
        """Return the smallest unit with some lines of the program, in the call of one of them."""
        level = self._level(at)
        while True:
            begin, end = level.among(first, last)
            among = level.lines[begin : end + 1]
            ends = [(int(among.min()), int(among.max())), *self._crossed(first, last)]
            ends += self._jumped(level.lines, begin, end)
            low = min(first, *(each[0] for each in ends))
            high = max(last, *(each[1] for each in ends))
            if (low, high) == (first, last):
                break
            first, last = low, high
        behind = level.at[end + 1 : end + 2]
        stop = self.own[behind[0]] - 1 if len(behind) else len(self.lines) - 1
        return Unit(first, last, int(self.own[level.at[begin]]), int(stop), why)

    def _jumped(self, lines: Ints, begin: int, end: int) -> list[tuple[int, int]]:
        """Return what the jumps pass over that lead into some executions of `lines`, or out of it.

        What leads to the first line, or to the line behind the last one, leads there still.
        """
        among = lines[begin : end + 1]
        first, last = int(among.min()), int(among.max())
        found = []
        if begin and lines[begin] != first:
            found.append((int(lines[begin - 1]), int(lines[begin - 1])))
        if end + 1 < len(lines) and (behind := int(lines[end + 1])) != last + 1:
            found.append((behind, last) if behind < first else (first, behind - 1))
        return found

    def _crossed(self, first: int, last: int) -> list[tuple[int, int]]:
        """Return the loops that lines stand in, or begin or end, and what they divide."""
        low, high = np.searchsorted(self._parting[:, 0], (first, last + 1))
        parted = {self._branches[k] for k in self._parting[low:high, 1].tolist()}
        begins, ends = self._loops.T
        loops = self._loops[(begins <= last) & (first <= ends)]
        return [*sorted(parted), *((begin, end) for begin, end in loops.tolist())]

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
