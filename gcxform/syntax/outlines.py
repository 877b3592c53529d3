"""Outlines: what lines with comments, parameters and expressions look like without their numbers.

A line that is more than words and plain numbers cannot be reduced as `scan.py` does it: in
`G1 X[#1+2.5] (wall 3)` the 1 names a parameter, the 2.5 is a number, and the 3 is text. Here the
numbers and the comments of such lines are found by whole-array operations. What is left, with a
mark for each, is the outline; lines of one outline share one tree (`layout.py`), so lark reads one
of them.

    #1=[2.5*#2] (wall 3)      outline  #1=[.*#2] .      marks  2.5  (wall 3)

Nothing is decided about the language. Digits behind G, M, O and `#` stay, for they are names. A
line that is not clear here (brackets in comments, numbers with blanks inside, more than eight
digits on a side of the point) has no outline and goes to lark by itself, and so does a comment that
the control executes.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gcxform.syntax.numerals import LONGEST, TEN_TO, Digits
from gcxform.system.arrays import Flags, Floats, Ints

BEGIN = b"\1"  # first byte of an outline: no plain line has it
NUMBER, COMMENT, TAIL = 2, 3, 4
"""The bytes that stand for numbers, for comments, and for those that go to the end of the line."""
NAMES = np.zeros(256, np.bool_)
NAMES[list(b"#GMOgmo")] = True
"""Behind these a number is a name: of a parameter, or of a code."""


@dataclass(frozen=True)
class Comments:
    """How comments begin ("(" and ";" or one of them), and which of them a control executes."""

    begin: str
    active: tuple[str, ...] = ()

    @cached_property
    def executed(self) -> re.Pattern[bytes] | None:
        """What a comment looks like that the control executes."""
        names = b"|".join(re.escape(name.encode("latin-1")) for name in self.active)
        return re.compile(rb"[(;][(; \t]*(?:" + names + rb")", re.IGNORECASE) if names else None


@dataclass(frozen=True, slots=True)
class Outlines:
    """The lines that have an outline.

    lines (n,) are indices into a window, `keys` their outlines. Marks of all lines follow one
    another: `first` (n,) is the first of each line and `count` (n,) how many it has. Per mark:
    `start` and `end` (offsets into the text of the window), `value` and `decimals` (-1: no point)
    of numbers, and `comment`, which marks are comments.
    """

    lines: Ints
    keys: list[bytes]
    first: Ints
    count: Ints
    start: Ints
    end: Ints
    value: Floats
    decimals: Ints
    comment: Flags


def outline(text: bytes, lines: Ints, start: Ints, end: Ints, comments: Comments) -> Outlines:
    """Return the outlines of some lines of a window; `start`, `end` are offsets of its lines."""
    begin, stop = start[lines], end[lines]
    joined = b"".join(
        [text[a:b] + b"\n" for a, b in zip(begin.tolist(), stop.tolist(), strict=True)]
    )
    scanned = _Scan(joined, stop - begin + 1, comments)
    return scanned.outlines(lines, begin)


class _Scan:
    """Lines, each with a line end, and what their bytes are; `length` (n,) counts it."""

    def __init__(self, text: bytes, length: Ints, comments: Comments) -> None:
        self.text = text
        self.comments = comments
        self.raw = np.frombuffer(text, np.uint8)
        self.length = length
        self.begin = np.cumsum(length) - length
        self.line = np.repeat(np.arange(len(length)), length)
        self.unclear = np.zeros(len(length), np.bool_)
        self._refuse((self.raw <= TAIL) | (self.raw == 13))
        self.opened = np.flatnonzero(self.raw == 40)
        self.inside = self._comments()
        self.named = self._angles()
        self._executed()

    def _refuse(self, wrong: Flags) -> None:
        """Note the lines of some bytes as unclear."""
        self.unclear[self.line[wrong]] = True

    def _depth(self, opening: int, closing: int) -> Ints:
        """Return how deep in brackets each byte stands, those of both brackets included."""
        opens, closes = self.raw == opening, self.raw == closing
        depth = np.cumsum(opens, dtype=np.int32) - np.cumsum(closes, dtype=np.int32)
        last = self.begin + self.length - 1
        before = np.append(0, depth[last[:-1]])
        self.unclear |= depth[last] != before
        return np.asarray(depth + closes - before[self.line])

    def _comments(self) -> Flags:
        """Return which bytes are comments, their signs included."""
        inside = np.zeros(len(self.raw), np.bool_)
        if b"(" in self.text or b")" in self.text:
            depth = self._depth(40, 41)
            self._refuse((depth < 0) | (depth > 1))
            inside = depth > 0
        if b";" in self.text and ";" in self.comments.begin:
            signs = np.flatnonzero((self.raw == 59) & ~inside)
            line, first = np.unique(self.line[signs], return_index=True)
            behind = np.zeros(len(self.raw) + 1, np.int8)
            behind[signs[first]] = 1
            behind[self.begin[line] + self.length[line] - 1] = -1
            tail = np.cumsum(behind[:-1]).astype(np.bool_)
            self._refuse(tail & ((self.raw == 40) | (self.raw == 41)))
            inside = inside | tail
            self.opened = np.union1d(self.opened, signs[first])
        return inside

    def _angles(self) -> Flags:
        """Return which bytes belong to names of parameters, whose digits are letters."""
        if b"<" not in self.text and b">" not in self.text:
            return np.zeros(len(self.raw), np.bool_)
        depth = self._depth(60, 62)
        self._refuse(((depth < 0) | (depth > 1)) | ((depth > 0) & self.inside))
        return np.asarray(depth > 0)

    def _executed(self) -> None:
        """Leave lines with comments that the control executes to lark."""
        pattern = self.comments.executed
        for found in pattern.finditer(self.text) if pattern else ():
            self.unclear[self.line[found.start()]] = True

    def _numbers(self) -> tuple[Ints, Ints, Floats, Ints]:
        """Return first byte, end, value and decimals of the numbers that are no names."""
        point = self.raw == 46
        digit = ((self.raw - np.uint8(48)) < 10) & ~self.inside & ~self.named
        numeric = digit | (point & ~self.inside & ~self.named)
        edges = np.flatnonzero(np.diff(numeric, prepend=False))
        start, end = edges[0::2], edges[1::2]
        before = self._before(start)
        self.unclear[self.line[start[numeric[before] & (start > 0)]]] = True
        is_name = NAMES[self.raw[before]] & (start > 0) & (self.line[before] == self.line[start])
        self.unclear[self.line[start[is_name & (before != start - 1)]]] = True
        start, end = start[~is_name], end[~is_name]
        points = np.append(0, np.cumsum(point, dtype=np.int32))
        count = points[end] - points[start]
        places = np.append(np.flatnonzero(point), len(self.raw))
        split = np.where(count > 0, places[points[start]], end)
        fraction = np.where(count > 0, end - split - 1, -1)
        digits = Digits(self.text)
        whole, part = split - start, np.maximum(fraction, 0)
        wrong = (count > 1) | (whole > LONGEST) | (part > LONGEST) | (whole + part == 0)
        wrong |= whole + part > 15  # all of them are exact in a double
        self.unclear[self.line[start[wrong]]] = True
        scale = TEN_TO[np.minimum(part, LONGEST)]
        value = (digits.before(split, whole) * scale + digits.before(end, part)) / scale
        return start, end, value, fraction

    def _before(self, at: Ints) -> Ints:
        """Return the last byte that is no blank before some offsets."""
        blank = (self.raw == 32) | (self.raw == 9)
        if not blank.any():
            return np.maximum(at - 1, 0)
        last = np.maximum.accumulate(np.where(blank, 0, np.arange(len(self.raw))))
        return np.asarray(last[np.maximum(at - 1, 0)])

    def outlines(self, lines: Ints, offset: Ints) -> Outlines:
        """Return the outlines; `offset` (n,) is where the lines begin in the window."""
        start, end, value, decimals = self._numbers()
        opened = self.opened
        closed = self._closed(opened)
        both = np.concatenate([start, opened])
        order = np.argsort(both, kind="stable")
        order = order[~self.unclear[self.line[both[order]]]]
        begin, stop = both[order], np.concatenate([end, closed])[order]
        comment = order >= len(start)
        value = np.concatenate([value, np.full(len(opened), np.nan)])[order]
        decimals = np.concatenate([decimals, np.full(len(opened), -2)])[order]
        keys = self._keys(begin, stop, comment)
        count = np.bincount(self.line[begin], minlength=len(lines))
        first = np.cumsum(count) - count
        clear = np.flatnonzero(~self.unclear)
        shift = (offset - self.begin)[self.line[begin]]
        return Outlines(
            lines[clear],
            [keys[line] for line in clear.tolist()],
            first[clear],
            count[clear],
            begin + shift,
            stop + shift,
            value,
            decimals,
            comment,
        )

    def _closed(self, opened: Ints) -> Ints:
        """Return where the comments end that begin at some offsets."""
        if not len(opened):
            return opened
        last = self.begin + self.length - 1
        closing = np.append(np.flatnonzero(self.raw == 41), len(self.raw))
        bracket = closing[np.searchsorted(closing, opened)] + 1
        return np.where(self.raw[opened] == 40, bracket, last[self.line[opened]])

    def _keys(self, start: Ints, end: Ints, comment: Flags) -> list[bytes]:
        """Return the lines with one byte for every mark."""
        edge = np.zeros(len(self.raw) + 1, np.int32)
        edge[start + 1] += 1
        edge[end] -= 1
        keep = np.cumsum(edge[:-1]) == 0
        copy = self.raw.copy()
        copy[start] = np.where(comment, np.where(self.raw[start] == 40, COMMENT, TAIL), NUMBER)
        lines = copy[keep].tobytes().split(b"\n")[:-1]
        return [BEGIN + line for line in lines]
