"""A window of text as columns: line ends, number columns and the shape of every line.

lark reads some ten thousand lines a second, a finishing program has a million. So every line is
reduced to its **shape**: its text with each number replaced by `#`, except the numbers that are
codes (G, M, O). lark parses one line of each shape, once; all lines of that shape have its tree,
with the numbers taken from the columns. This file finds numbers and shapes with whole-array
operations and decides nothing about the language. A line that is not made of letters, numbers and
blanks alone has an outline instead (`outlines.py`), or goes to lark by itself.

    N10 G1 X1.5 Y-2.      shape  N# G1 X# Y#      numbers  10  1.5  -2.

Numbers are read as integer mantissas with decimals, and every number that is taken is exact; those
with more digits, as computed ones have, are read one by one.
"""

from __future__ import annotations

import numpy as np

from gcxform.syntax.numerals import LONGEST, TEN_TO, WIDEST, Digits, put_long
from gcxform.syntax.outlines import outline
from gcxform.syntax.shapes import OWN, NumberColumns, ShapeTable
from gcxform.system.arrays import Bytes, Flags, Floats, Ints
from gcxform.values import dataclass

LETTER, DIGIT, POINT, SIGN, BLANK, END, CODE, OTHER = 0, 1, 2, 3, 4, 5, 6, 7
TEN_TO_INT = 10 ** np.arange(LONGEST + 1)
EXACT = 2**53  # the mantissa of a number read here is exact as a double


def _classes() -> bytes:
    table = bytearray([OTHER]) * 256
    for low in range(ord("a"), ord("z") + 1):
        table[low] = table[low - 32] = LETTER
    for code in b"GMOgmo":
        table[code] = CODE
    for kind, members in (
        (DIGIT, b"0123456789"),
        (POINT, b"."),
        (SIGN, b"+-"),
        (BLANK, b" \t"),
        (END, b"\r\n"),
    ):
        for member in members:
            table[member] = kind
    return bytes(table)


CLASS = _classes()


@dataclass(frozen=True, slots=True)
class Window:
    """Some whole lines of a program; `first_line` counts lines of the program from 0.

    Per line: `start`, `end` (without the line end) and `next` are offsets into `text`; `shape` is
    an index into the shape table; `first_number` is the index of the line's first number. Per
    number: `value`, `decimals` (-1: no point), `number_start` and `number_end` (offsets).
    """

    text: bytes
    first_line: int
    start: Ints
    end: Ints
    next: Ints
    shape: Ints
    first_number: Ints
    value: Floats
    decimals: Ints
    number_start: Ints
    number_end: Ints

    def __len__(self) -> int:
        return len(self.start)

    @property
    def lines(self) -> range:
        """Its lines in the program, from 0."""
        return range(self.first_line, self.first_line + len(self))

    def line(self, index: int) -> bytes:
        """Return the text of a line of this window without its line end."""
        return self.text[int(self.start[index]) : int(self.end[index])]


def scan(text: bytes, first_line: int, table: ShapeTable) -> Window:
    """Return the columns of whole lines; new shapes are parsed and enter the table."""
    raw = np.frombuffer(text, np.uint8)
    kinds = text.translate(CLASS)
    kind = np.frombuffer(kinds, np.uint8)
    start, end, following = _lines(raw, text)
    odd = np.zeros(len(start), np.bool_)
    if OTHER in kinds:
        odd = np.logical_or.reduceat(kind == OTHER, start)
        # nothing of these lines is looked for here
        kind = np.where(np.repeat(odd, following - start), np.uint8(END), kind)
    runs = _runs(text, raw, kind)
    own = _lines_by_themselves(odd, runs, following)
    shape, numbers = _shapes(raw, kind, runs, own, (start, end), text, table)
    return Window(text, first_line, start, end, following, shape, *numbers)


def _lines(raw: Bytes, text: bytes) -> tuple[Ints, Ints, Ints]:
    """Return start, end and start of the next line, for LF, CRLF and CR line ends."""
    stops = np.flatnonzero(raw == 10)
    width = 1
    if b"\r" in text:
        is_cr = raw == 13
        lone = is_cr & ~np.append(raw[1:] == 10, False)
        stops = np.flatnonzero((raw == 10) | lone)
        before = np.append(False, is_cr[:-1])[stops] & (raw[stops] == 10)
        width = 1 + before.astype(np.int64)
    following = stops + 1
    if not len(stops) or following[-1] != len(raw):
        return (
            np.append(0, following),
            np.append(following - width, len(raw)),
            np.append(following, len(raw)),
        )
    return np.append(0, following[:-1]), following - width, following


@dataclass(slots=True)
class _Runs:
    """Runs of number characters: first and past-the-last offset, and what they hold."""

    start: Ints
    end: Ints
    mantissa: Ints
    decimals: Ints
    negative: Flags
    is_code: Flags
    is_plain: Flags
    is_long: Flags


def _runs(text: bytes, raw: Bytes, kind: Bytes) -> _Runs:
    """Find the runs of digits, points and signs and read them as integers with decimals."""
    numeric = (kind - np.uint8(DIGIT)) < 3
    edges = np.flatnonzero(numeric[1:] != numeric[:-1]) + 1
    if len(raw) and numeric[0]:
        edges = np.append(0, edges)
    if len(edges) % 2:
        edges = np.append(edges, len(raw))
    start, end = edges[0::2].copy(), edges[1::2].copy()
    before = kind[start - 1]
    before[start == 0] = OTHER
    first = start + (kind[start] == SIGN)
    point, plain = _points(kind, numeric, start)
    split = np.where(point >= 0, point, end)
    decimals = np.where(point >= 0, end - point - 1, -1)
    fraction = np.maximum(decimals, 0)
    whole = split - first
    plain &= (whole + fraction > 0) & ((before == LETTER) | (before == CODE))
    digits = Digits(text)
    mantissa = digits.before(split, whole) * TEN_TO_INT[np.minimum(fraction, LONGEST)]
    mantissa += digits.before(end, fraction)
    long = (whole > LONGEST) | (fraction > LONGEST) | (mantissa >= EXACT)
    plain &= ~long | ((before == LETTER) & (end - start <= WIDEST))
    return _Runs(start, end, mantissa, decimals, raw[start] == 45, before == CODE, plain, long)


def _points(kind: Bytes, numeric: Flags, start: Ints) -> tuple[Ints, Flags]:
    """Return the offset of each run's point (-1: none), and whether points and signs are right."""
    points = np.flatnonzero(kind == POINT)
    owner = np.searchsorted(start, points, side="right") - 1
    point = np.full(len(start), -1)
    point[owner] = points
    good = np.ones(len(start), np.bool_)
    good[owner[1:][owner[1:] == owner[:-1]]] = False
    signs = np.flatnonzero(kind == SIGN)
    inner = signs[(signs > 0) & numeric[signs - 1]]
    good[np.searchsorted(start, inner, side="right") - 1] = False
    return point, good


def _lines_by_themselves(odd: Flags, runs: _Runs, following: Ints) -> Ints:
    """Return the lines that are no words and plain numbers, ascending: the odd ones among them."""
    wrong = np.searchsorted(following, runs.start[~runs.is_plain], side="right")
    odd = odd.copy()
    odd[wrong] = True
    return np.flatnonzero(odd)


def _shapes(
    raw: Bytes,
    kind: Bytes,
    runs: _Runs,
    own: Ints,
    lines: tuple[Ints, Ints],
    text: bytes,
    table: ShapeTable,
) -> tuple[Ints, NumberColumns]:
    """Return the shape of each line and the number columns."""
    start, end = lines
    keys = _reduced(raw, kind, runs, end).split(b"\n")[: len(start)]
    odd, found, outlined = own, None, np.empty(0, np.int64)
    if table.comments is not None and len(own):
        found = outline(text, own, start, end, table.comments)
        outlined = table.outlined(found, text, start, end)
        alone = np.zeros(len(start), np.bool_)
        alone[own] = True
        alone[found.lines[outlined >= 0]] = False
        own = np.flatnonzero(alone)
    for line in own.tolist():
        keys[line] = OWN + text[int(start[line]) : int(end[line])]
    shape = table.look_up(keys, text, start, end)
    if found is not None:
        shape[found.lines] = np.where(outlined >= 0, outlined, shape[found.lines])
    slots = ~runs.is_code
    first = _first_numbers(table, shape, odd, runs.start[slots], start)
    value = runs.mantissa[slots] / TEN_TO[np.clip(runs.decimals[slots], 0, LONGEST)]
    np.negative(value, out=value, where=runs.negative[slots])
    _read_long(value, runs, text)
    columns = (first, value, runs.decimals[slots], runs.start[slots], runs.end[slots])
    columns = table.append_own(shape, own, columns, start)
    if found is not None:
        columns = table.append_outlined(outlined, found, columns, start)
    return shape, columns


def _read_long(value: Floats, runs: _Runs, text: bytes) -> None:
    """Put numbers of many digits among the values of those that are no codes."""
    found = np.flatnonzero(runs.is_long & runs.is_plain)
    if len(found):
        places = np.cumsum(~runs.is_code)[found] - 1
        put_long(value, places, text, runs.start[found], runs.end[found])


def _first_numbers(
    table: ShapeTable, shape: Ints, own: Ints, number_start: Ints, start: Ints
) -> Ints:
    """Return the index of the first number on or after the start of each line."""
    if len(own):
        return np.searchsorted(number_start, start)
    counts = table.slot_counts()[shape]
    return np.cumsum(counts) - counts


def _reduced(raw: Bytes, kind: Bytes, runs: _Runs, end: Ints) -> bytes:
    """Return the text with one `#` for every number that is not a code, and LF line ends."""
    copy = raw.copy()
    keep = (kind - np.uint8(DIGIT)) >= 3
    slots = ~runs.is_code
    copy[runs.start[slots]] = 35
    keep[runs.start[slots]] = True
    at, stop = runs.start[runs.is_code], runs.end[runs.is_code]
    while len(at):
        keep[at] = True
        at, stop = at[at + 1 < stop] + 1, stop[at + 1 < stop]
    keep[kind == END] = False
    stops = end[end < len(raw)]
    copy[stops] = 10
    keep[stops] = True
    return copy[keep].tobytes()
