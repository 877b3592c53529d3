"""Outlines: what lines with comments, parameters and expressions look like without their numbers.

A line that is more than words and plain numbers cannot be reduced as `scan.py` does it: in
`G1 X[#1+2.5] (wall 3)` the 1 names a parameter, the 2.5 is a number, and the 3 is text. Here the
numbers and the comments of such lines are found by whole-array operations. What is left, with a
mark for each, is the outline; lines of one outline share one tree (`layout.py`), so lark reads one
of them.

    #1=[2.5*#2] (wall 3)      outline  #1=[.*#2] .      marks  2.5  (wall 3)

Nothing is decided about the language. Digits behind G, M, O and `#` stay, for they are names. A
line that is not clear here (brackets in comments, numbers with blanks inside or of more than forty
digits) has no outline and goes to lark by itself, and so does a comment that the control executes.
"""

from __future__ import annotations

import re
from functools import cached_property

import numpy as np

from gcxform.syntax.numerals import LONGEST, TEN_TO, WIDEST, Digits, put_long
from gcxform.syntax.tree import COMPUTED
from gcxform.system.arrays import Bytes, Flags, Floats, Ints
from gcxform.values import dataclass

BEGIN = b"\1"  # first byte of an outline: no plain line has it
NUMBER, COMMENT, TAIL = 2, 3, 4
"""The bytes that stand for numbers, for comments, and for those that go to the end of the line."""
ODD = (b"\0", b"\1", b"\2", b"\3", b"\4", b"\r")
EXACT = 15  # digits: so many are exact in a double
NUMERIC = bytes(each in b".0123456789" for each in range(256))
BLANK = np.zeros(256, np.bool_)
BLANK[list(b" \t")] = True
NAMES = np.zeros(256, np.bool_)
NAMES[list(b"#GMOgmo")] = True
"""Behind these a number is a name: of a parameter, or of a code."""


@dataclass(frozen=True)
class Comments:
    """How comments begin ("(" and ";" or one of them), and which of them a control executes.

    `cut`: a semicolon ends a comment in parentheses, and the block with it.
    """

    begin: str
    active: tuple[str, ...] = ()
    cut: bool = False

    @cached_property
    def looks(self) -> re.Pattern[bytes]:
        """What a comment looks like that the control executes, or that ends before its bracket."""
        names = b"|".join(re.escape(name.encode("latin-1")) for name in self.active)
        looks = [rb"[(;][(; \t]*(?:" + names + rb")"] if names else []
        looks += [rb"\([^()\n]*;"] if self.cut else []
        return re.compile(b"|".join(looks) or rb"(?!)", re.IGNORECASE)

    @cached_property
    def leads(self) -> Flags:
        """Which bytes (256,) may stand behind the sign of such a comment."""
        letters = "".join(name[0] for name in self.active)
        leads = np.full(256, self.cut, np.bool_)
        leads[list((letters.upper() + letters.lower() + "(; \t").encode("latin-1"))] = True
        return leads

    def executed(self, text: bytes, raw: Bytes) -> list[int]:
        """Return where such comments begin; most are none by their first letter."""
        signs = np.flatnonzero((raw[:-1] == 40) | (raw[:-1] == 59))
        signs = signs[self.leads[raw[signs + 1]]]
        return [at for at in signs.tolist() if self.looks.match(text, at)]


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
    begin, length = start[lines], end[lines] - start[lines] + 1
    scanned = _Scan(_joined(text, begin, length), length, comments)
    return scanned.outlines(lines, begin)


def _joined(text: bytes, begin: Ints, length: Ints) -> bytes:
    """Return some lines of a text, each with a line end, which `length` (n,) counts."""
    raw = np.frombuffer(text + b"\n", np.uint8)  # the last line may have none
    last = np.cumsum(length)
    at = np.arange(int(last[-1])) + np.repeat(begin - (last - length), length)
    joined = raw[at]
    joined[last - 1] = 10
    return bytes(joined)


class _Scan:
    """Lines, each with a line end, and where their pieces are; `length` (n,) counts it."""

    def __init__(self, text: bytes, length: Ints, comments: Comments) -> None:
        self.text = text
        self.comments = comments
        self.raw = np.frombuffer(text, np.uint8)
        self.line = np.repeat(np.arange(len(length), dtype=np.int32), length)
        self.begin = np.cumsum(length) - length
        self.last = self.begin + length - 1
        self.unclear = np.zeros(len(length), np.bool_)
        if any(odd in text for odd in ODD):
            self._refuse(np.flatnonzero((self.raw <= TAIL) | (self.raw == 13)))
        self._refuse(np.array(comments.executed(text, self.raw), np.int64))

    def _line(self, at: Ints) -> Ints:
        """Return the lines of some offsets."""
        return self.line[at].astype(np.int64)

    def _refuse(self, at: Ints) -> None:
        """Note the lines of some offsets as unclear."""
        self.unclear[self._line(at)] = True

    def _pairs(self, opening: int, closing: int) -> tuple[Ints, Ints]:
        """Return where pairs of brackets begin and end; what is no pair in a line is unclear."""
        opens, closes = np.flatnonzero(self.raw == opening), np.flatnonzero(self.raw == closing)
        both = np.concatenate([opens, closes])
        order = np.argsort(both, kind="stable")
        at, opened = both[order], order < len(opens)
        line = self._line(at)
        first = np.append(True, line[1:] != line[:-1])[: len(line)]
        before = np.append(False, opened[:-1])[: len(line)] & ~first
        last = np.append(first[1:], True)[: len(line)]
        wrong = (opened == before) | (last & opened)
        self.unclear[line[wrong]] = True
        good = ~self.unclear[line]
        return at[good & opened], at[good & ~opened] + 1

    def _comments(self) -> tuple[Ints, Ints]:
        """Return where comments begin and end, their signs included."""
        start, end = self._pairs(40, 41)
        if b";" not in self.text or ";" not in self.comments.begin:
            return start, end
        signs = np.flatnonzero(self.raw == 59)
        signs = signs[~_inside(signs, start, end) & ~self.unclear[self._line(signs)]]
        line, nth = np.unique(self._line(signs), return_index=True)
        tail, stop = signs[nth], self.last[line]
        self._refuse(start[_inside(start, tail, stop)])
        opened = np.concatenate([start, tail])
        order = np.argsort(opened, kind="stable")
        order = order[~self.unclear[self._line(opened[order])]]
        return opened[order], np.concatenate([end, stop])[order]

    def _numbers(self, opened: Ints, closed: Ints) -> tuple[Ints, Ints, Floats, Ints]:
        """Return first byte, end, value and decimals of numbers that are no names, and no text."""
        numeric = np.frombuffer(self.text.translate(NUMERIC), np.bool_)
        edges = np.flatnonzero(np.append(numeric[1:] != numeric[:-1], True)) + 1
        edges = np.append(0, edges) if len(numeric) and numeric[0] else edges
        start, end = edges[0::2][: len(edges) // 2], edges[1::2]
        kept = ~_inside(start, opened, closed)
        start, end = start[kept], end[kept]
        is_name = self._names(start)
        start, end = start[~is_name], end[~is_name]
        return start, end, *self._values(start, end)

    def _names(self, start: Ints) -> Flags:
        """Return which numbers are names, or belong to one; blanks inside are unclear."""
        before = np.maximum(start - 1, 0)
        while (blank := BLANK[self.raw[before]] & (before > 0)).any():
            before = before - blank
        alone = start == self.begin[self._line(start)]
        is_name = NAMES[self.raw[before]] & ~alone
        numeric = (self.raw[before] == 46) | ((self.raw[before] - np.uint8(48)) < 10)
        self._refuse(start[(is_name | numeric) & (before != start - 1) & ~alone])
        if b"<" in self.text or b">" in self.text:
            is_name = is_name | _inside(start, *self._pairs(60, 62))
        return np.asarray(is_name)

    def _values(self, start: Ints, end: Ints) -> tuple[Floats, Ints]:
        """Return values and decimals of numbers; those that are none are unclear."""
        places = np.append(np.flatnonzero(self.raw == 46), len(self.raw))
        first = np.searchsorted(places, start)
        has_point = places[first] < end
        twice = has_point & (places[np.minimum(first + 1, len(places) - 1)] < end)
        split = np.where(has_point, places[first], end)
        fraction = np.where(has_point, end - split - 1, -1)
        whole, part = split - start, np.maximum(fraction, 0)
        wrong = twice | (whole + part == 0) | (whole + part > WIDEST)
        self._refuse(start[wrong])
        digits, scale = Digits(self.text), TEN_TO[np.minimum(part, LONGEST)]
        value = (digits.before(split, whole) * scale + digits.before(end, part)) / scale
        long = (whole > LONGEST) | (part > LONGEST) | (whole + part > EXACT)
        found = np.flatnonzero(long & ~wrong)
        put_long(value, found, self.text, start[found], end[found])
        return value, fraction

    def outlines(self, lines: Ints, offset: Ints) -> Outlines:
        """Return the outlines; `offset` (n,) is where the lines begin in the window."""
        opened, closed = self._comments()
        start, end, value, decimals = self._numbers(opened, closed)
        both = np.concatenate([start, opened])
        line = self._line(both)
        order = np.argsort(both, kind="stable")
        order = order[~self.unclear[line[order]]]
        begin, stop = both[order], np.concatenate([end, closed])[order]
        comment = order >= len(start)
        keys = self._keys(begin, stop, comment)
        count = np.bincount(line[order], minlength=len(lines))
        first = np.cumsum(count) - count
        clear = np.flatnonzero(~self.unclear)
        shift = (offset - self.begin)[line[order]]
        return Outlines(
            lines[clear],
            keys if len(clear) == len(keys) else [keys[line] for line in clear.tolist()],
            first[clear],
            count[clear],
            begin + shift,
            stop + shift,
            np.concatenate([value, np.full(len(opened), np.nan)])[order],
            np.concatenate([decimals, np.full(len(opened), COMPUTED)])[order],
            comment,
        )

    def _keys(self, start: Ints, end: Ints, comment: Flags) -> list[bytes]:
        """Return the lines with one byte for every mark."""
        edge = np.zeros(len(self.raw) + 1, np.int8)
        edge[start + 1] += 1
        edge[end] -= 1
        keep = np.cumsum(edge[:-1], dtype=np.int8) == 0
        copy = self.raw.copy()
        copy[start] = np.where(comment, np.where(self.raw[start] == 40, COMMENT, TAIL), NUMBER)
        lines = BEGIN + bytes(copy[keep]).replace(b"\n", b"\n" + BEGIN)
        return lines.split(b"\n")[:-1]


def _inside(at: Ints, start: Ints, end: Ints) -> Flags:
    """Return which offsets lie in pieces, which are ascending and apart."""
    if not len(start):
        return np.zeros(len(at), np.bool_)
    nth = np.searchsorted(start, at, side="right") - 1
    return np.asarray((nth >= 0) & (at < end[np.maximum(nth, 0)]))
