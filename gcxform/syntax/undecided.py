"""What of a program only the machine decides: branches that stand in text of which all else is run.

The text is read from its first line to its last, whatever its jumps do. That is right where blocks
between a jump and where it leads change nothing, or what they change is taken for lost there.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import field

import numpy as np

from gcxform.system.arrays import Flags, Ints
from gcxform.values import dataclass


@dataclass(frozen=True)
class Undecided:
    """Lines of a text, from 0.

    lines    those with flow words that stay as they are
    labels   those that jumps lead to: their sequence numbers stay
    lost     before which lines axes are lost, by their letters; F is the feed
    forgets  before which lines parameters are no longer known, by number or name
    perhaps  those that may not be executed, and move something
    alarm    the one that stops the control for good: nothing behind it is executed
    """

    lines: frozenset[int] = frozenset()
    labels: frozenset[int] = frozenset()
    lost: Mapping[int, str] = field(default_factory=dict)
    forgets: Mapping[int, frozenset[int | str]] = field(default_factory=dict)
    perhaps: frozenset[int] = frozenset()
    alarm: int | None = None

    def __bool__(self) -> bool:
        return bool(self.lines or self.labels or self.lost or self.forgets or self.perhaps)

    def within(self, first: int, count: int) -> Undecided:
        """Return what of it is in so many lines from the first on."""
        if not self and self.alarm is None:
            return self
        here = range(first, first + count)
        lines, labels, perhaps = (
            frozenset(n for n in group if n in here)
            for group in (self.lines, self.labels, self.perhaps)
        )
        lost = {n: axes for n, axes in self.lost.items() if n in here}
        forgets = {n: keys for n, keys in self.forgets.items() if n in here}
        alarm = self.alarm if self.alarm in here else None
        return Undecided(lines, labels, lost, forgets, perhaps, alarm)

    def settle_ends(self, ends: Flags, first: int) -> None:
        """Set which of the lines from the first on end the program, of those that may by words."""
        ends[[line - first for line in self.lines]] = False
        if self.alarm is not None:
            ends[self.alarm - first] = True

    def at_jumps(self, first: int, count: int) -> Flags:
        """Return which of so many lines from the first on jumps leave, meet, or may leave out."""
        return _flags(self.lines | self.labels | self.perhaps, first, count)

    def skipped(self, first: int, count: int) -> Flags:
        """Return which of so many lines from the first on may not be executed."""
        return _flags(self.perhaps, first, count)

    def through(self, source: Ints, first: int, window: range) -> Undecided:
        """Return the same of a text whose line `first + k` was written for the line source[k].

        `window` are the lines behind the last one for which something was written before. What is
        no longer known before a line for which nothing is written is not known before the next one.
        """
        if not self and self.alarm is None:
            return self
        there, nth = np.unique(source, return_index=True)
        alarms = () if self.alarm is None else (self.alarm,)
        named = {*self.lines, *self.labels, *self.perhaps, *alarms}
        at: dict[int, list[int]] = {}
        for k in np.flatnonzero(np.isin(source, [*named])).tolist() if named else ():
            at.setdefault(int(source[k]), []).append(first + k)

        def written(lines: frozenset[int]) -> frozenset[int]:
            return frozenset(at[line][0] for line in lines if line in at)

        def before(lines: Iterable[int]) -> Iterator[tuple[int, int]]:
            """Yield lines, and which of the text they are before."""
            for line in lines:
                if line in window and (k := bisect_left(there, line)) < len(there):
                    yield line, first + int(nth[k])

        lost: dict[int, str] = {}
        forgets: dict[int, frozenset[int | str]] = {}
        for line, place in before(self.lost):
            lost[place] = lost.get(place, "") + self.lost[line]
        for line, place in before(self.forgets):
            forgets[place] = forgets.get(place, frozenset()) | self.forgets[line]
        perhaps = frozenset(n for line in self.perhaps for n in at.get(line, ()))
        alarm = at[self.alarm][-1] if self.alarm in at else None
        return Undecided(written(self.lines), written(self.labels), lost, forgets, perhaps, alarm)


def _flags(lines: frozenset[int], first: int, count: int) -> Flags:
    found = np.zeros(count, np.bool_)
    found[[line - first for line in lines if first <= line < first + count]] = True
    return found


DECIDED = Undecided()
