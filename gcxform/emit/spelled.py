"""What the steps of an execution became in what was written, and what they spell by themselves.

A program is executed, and its blocks are written one after the other; here each piece of what was
written is found again for the step it stands for.
"""

from __future__ import annotations

import re
from bisect import bisect_left
from collections.abc import Callable, Iterable, Iterator
from functools import cached_property
from itertools import pairwise

import numpy as np

from gcxform.flow.walk import Walk
from gcxform.flow.words_first import behind, of_call
from gcxform.syntax.tree import Statement
from gcxform.system.arrays import Ints
from gcxform.values import dataclass

LINE_END = re.compile(rb"\r\n|\n|\r")


@dataclass(frozen=True, slots=True)
class Text:
    """Whole lines, and the line of the program, from 0, that each of them is for."""

    text: bytes = b""
    lines: tuple[int, ...] = ()

    def __add__(self, other: Text) -> Text:
        return Text(self.text + other.text, self.lines + other.lines)


@dataclass(frozen=True)
class Spelled:
    """The blocks of an execution, `executed`, and the lines `written` for them.

    `origin` (blocks,) are the lines of the program, `source` (lines,) the block of each line that
    was written, ascending.
    """

    walk: Walk
    executed: bytes
    origin: Ints
    written: bytes
    source: Ints

    @cached_property
    def _old(self) -> Ints:
        return _starts(self.executed)

    @cached_property
    def _new(self) -> Ints:
        """The first byte that was written for each block."""
        blocks = np.arange(len(self.origin) + 1)
        return _starts(self.written)[np.searchsorted(self.source, blocks)]

    def old(self, first: int, stop: int) -> bytes:
        """Return the text of blocks as they were executed."""
        return self.executed[int(self._old[first]) : int(self._old[stop])]

    def new(self, first: int, stop: int) -> bytes:
        """Return the text that was written for blocks."""
        return self.written[int(self._new[first]) : int(self._new[stop])]

    def text(self, first: int, stop: int) -> Text:
        """Return what was written for blocks, with the lines of the program."""
        low, high = np.searchsorted(self.source, (first, stop))
        return Text(self.new(first, stop), tuple(self.origin[self.source[low:high]].tolist()))

    def of(self, begin: int, end: int, stays: Callable[[int], bool]) -> Text:
        """Return what steps became, up to one; a call that stays stands as it is in the program."""
        walk, found, step = self.walk, Text(), begin
        while step < end:
            at = walk.steps[step]
            if walk.calls(step) and stays(step):
                found += Text(self.raw(at.first), (at.first,))
                step = walk.returned(step)
                continue
            found += self.text(at.block, walk.block_end(step))
            step += 1
        return found

    def raw(self, line: int) -> bytes:
        """Return a line of the program with its end."""
        listing = self.walk.listing
        return listing.window.line(line) + listing.line_end(line)

    def variants(self) -> dict[int, dict[bytes, int]]:
        """Return all texts of the lines that did not always stay as they were executed.

        With each text comes the first step in which the line became that.
        """
        found: dict[int, dict[bytes, int]] = {}
        changed = self._changed()
        if not changed:
            return found
        steps = self.walk.steps
        for step in changed:
            for line, old, new in self._pieces(step, range(*steps[step][:2])):
                if old != new:
                    found.setdefault(line, {}).setdefault(new, step)
        rest = sorted(found)
        for step in range(len(steps) if rest else 0):
            first, stop = steps[step][:2]
            here = rest[bisect_left(rest, first) : bisect_left(rest, stop)]
            for line, _, new in self._pieces(step, here):
                found[line].setdefault(new, step)
        return found

    def _changed(self) -> list[int]:
        """Return the steps of which a block became another text."""
        old, new = self._old.tolist(), self._new.tolist()
        changed = [
            self.executed[a:b] != self.written[c:d]
            for (a, b), (c, d) in zip(pairwise(old), pairwise(new), strict=False)
        ]
        before = np.concatenate([[0], np.cumsum(changed)])
        first = self.walk.table[:, 2]
        behind = np.append(first[1:], self.walk.blocks)
        return np.flatnonzero(before[behind] > before[first]).tolist()

    def _pieces(self, step: int, lines: Iterable[int]) -> Iterator[tuple[int, bytes, bytes]]:
        """Yield lines of a step with what was executed, and what was written."""
        for line in lines:
            blocks = self.blocks(step, line)
            yield line, self.old(*blocks), self.new(*blocks)

    def blocks(self, step: int, line: int) -> tuple[int, int]:
        """Return the first block of a line in a step, and the one behind its last."""
        at = self.walk.steps[step]
        if at.stop - at.first == 1:
            return at.block, self.walk.block_end(step)
        block = at.block + line - at.first
        return block, block + 1

    def became(self, step: int, line: int) -> Text:
        """Return what a line became in a step, with what calls or returns behind its words."""
        text = self.text(*self.blocks(step, line))
        if not self.moves_and_calls(line):
            return text
        listing = self.walk.listing
        written = text.text or listing.line_end(line)
        return Text(behind(written, listing.block(line)), text.lines or (line,))

    def moves_and_calls(self, line: int) -> bool:
        """Whether a line calls or returns, and its words were executed before that."""
        return line in self.walk.deciding and bool(of_call(self.walk.listing.block(line)))

    def sets(self, line: int) -> bool:
        """Whether a line has an assignment, or decides something, beside what it moves."""
        items = self.walk.listing.block(line).items
        decides = line in self.walk.deciding and not self.moves_and_calls(line)
        return decides or any(isinstance(i, Statement) for i in items)


def _starts(text: bytes) -> Ints:
    """Return where lines begin, and behind the last one where the text ends."""
    ends = [found.end() for found in LINE_END.finditer(text)]
    if text and not text.endswith((b"\n", b"\r")):
        ends.append(len(text))
    return np.array([0, *ends], np.int64)
