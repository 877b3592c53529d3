"""Which lines of a program in a language of its own are written out, with what is executed in them.

Those are the smallest: the call of a subprogram of which a line becomes another each time, or the
loop around it, by lines that are executed in one go. A loop that its last line ends goes whole.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from gcxform.flow.translated import Translated
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
        self.loops = self.translator.loops()

    def unit(self, visit: int, why: str) -> Unit:
        """Return what is to be written out where an execution of a line cannot stay."""
        line = int(self.lines[self.own[np.searchsorted(self.own, visit, "right") - 1]])
        return self.around(line, line, why)

    def around(self, first: int, last: int, why: str) -> Unit:
        """Return the smallest unit with some lines of the program."""
        lines = self.lines[self.own]
        while True:
            inside = np.flatnonzero((lines >= first) & (lines <= last))
            among = lines[inside[0] : inside[-1] + 1]
            ends = [(int(among.min()), int(among.max())), *self._crossed(first, last)]
            low = min(first, *(each[0] for each in ends))
            high = max(last, *(each[1] for each in ends))
            if (low, high) == (first, last):
                break
            first, last = low, high
        begin, behind = self.own[inside[0]], inside[-1] + 1
        end = self.own[behind] - 1 if behind < len(self.own) else len(self.lines) - 1
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
                unit = self.around(before.first, last, before.why)
            found.append(unit)
        return found
