"""The text of a program in blocks of lines: templates, and the numbers that stand in them.

A template is a line with a mark for each of its numbers, so that the lines of a finishing program
have a few templates, and their numbers are columns by the letter before them, which pack as well as
the path does. A number is its digits as a whole number and how it is written: decimals, leading
zeros, signs. What is no plain number stays in the template; a block whose bytes have the mark in
them is packed as it is. Each block is unpacked by itself, when its lines are looked at.

    number   whole number in units of the finest decimals of its column
    manner   decimals + 1, or 0 without a point; 32 (digits before the point + 1), or 0 where they
             are as many as needed; 1024 for a plus; 2048 for a minus before zero
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from itertools import repeat
from typing import Any, Final

import numpy as np

from gcxform.syntax.numerals import Digits
from gcxform.system.arrays import Bytes, Flags, Ints
from gcxform.system.distinct import distinct
from gcxform.values import dataclass
from gcxform.view.packing import Section, Store, folded

LINES: Final = 4096  # of a block
MARK: Final = 0
MOST_DIGITS: Final = 8  # on either side of the point
WIDTH, PLUS, ZERO = 32, 1024, 2048
TEN_TO: Final = 10 ** np.arange(2 * MOST_DIGITS + 1)
PLAIN: Final = 9  # digits in all of a number that is taken; more stay text
DECIMALS: Final = 6

_NUMERIC = np.isin(np.arange(256), np.frombuffer(b"0123456789.+-", np.uint8))
_LETTER = np.isin(np.arange(256) | 32, np.arange(ord("a"), ord("z") + 1))
_CODE = np.isin(np.arange(256), np.frombuffer(b"GMgm", np.uint8))


def packed(text: bytes, store: Store) -> tuple[int, list[Section]]:
    """Add the lines of a text to a store; return how many they are, and where the blocks are."""
    text = text.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    text = text[:-1] if text.endswith(b"\n") else text
    ends = np.append(np.flatnonzero(np.frombuffer(text, np.uint8) == 10), len(text))
    found = []
    for first in range(0, len(ends), LINES):
        start = int(ends[first - 1]) + 1 if first else 0
        found.append(store.raw(_block(text[start : int(ends[min(first + LINES, len(ends)) - 1])])))
    return len(ends), found


def _block(text: bytes) -> bytes:
    """Return a block: the size of its head, the head, templates, and columns."""
    if bytes([MARK]) in text or not text:
        return _joined({}, [text])
    numbers = _numbers(text)
    keys = _reduced(text, numbers).split(b"\n")
    index = {key: k for k, key in enumerate(dict.fromkeys(keys))}
    which = np.fromiter(map(index.get, keys, repeat(0)), np.int64, len(keys))
    templates = b"\n".join(index)
    planes, head = folded(which)
    columns: list[dict[str, Any]] = []
    parts = [templates, planes]
    for column, pieces in _columns(numbers):
        columns.append(column)
        parts += pieces
    return _joined({"templates": len(templates), "which": head, "columns": columns}, parts)


def _joined(head: dict[str, Any], parts: list[bytes]) -> bytes:
    said = json.dumps(head, separators=(",", ":")).encode()
    return b"".join([len(said).to_bytes(4, "little"), said, *parts])


@dataclass(frozen=True)
class _Numbers:
    """Plain numbers of a text: their offsets, the letter before, digits as a whole number, etc."""

    start: Ints
    end: Ints
    letter: Bytes
    mantissa: Ints
    decimals: Ints
    manner: Ints


def _numbers(text: bytes) -> _Numbers:
    """Return the numbers that are taken out of a text."""
    raw = np.frombuffer(text, np.uint8)
    edges = np.flatnonzero(np.diff(_NUMERIC[raw].astype(np.int8), prepend=0, append=0))
    start, end = edges[0::2], edges[1::2]
    inside = start > 0
    before = np.where(inside, raw[start - 1], 0).astype(np.uint8)
    signed = (raw[start] == 43) | (raw[start] == 45)
    first = start + signed
    point, good = _points(raw, first, end)
    whole = np.where(point >= 0, point, end) - first
    decimals = np.where(point >= 0, end - point - 1, -1)
    fraction = np.maximum(decimals, 0)
    good &= _LETTER[before] & ~_CODE[before] & (whole + fraction > 0)
    good &= (whole + fraction <= PLAIN) & (fraction <= DECIMALS) & (whole <= MOST_DIGITS)
    start, end, first, before = start[good], end[good], first[good], before[good]
    whole, fraction, decimals = whole[good], fraction[good], decimals[good]
    digits = Digits(text)
    mantissa = digits.before(first + whole, whole) * TEN_TO[fraction]
    mantissa += digits.before(end, fraction)
    negative = raw[start] == 45
    least = 1 + (mantissa[:, None] >= TEN_TO[fraction[:, None] + np.arange(1, 9)]).sum(axis=1)
    manner = decimals + 1 + np.where(whole == least, 0, WIDTH * (whole + 1))
    manner += PLUS * (raw[start] == 43) + ZERO * (negative & (mantissa == 0))
    return _Numbers(start, end, before, np.where(negative, -mantissa, mantissa), fraction, manner)


def _points(raw: Bytes, first: Ints, end: Ints) -> tuple[Ints, Flags]:
    """Return the offset of each run's point (-1: none), and whether it is written as numbers."""
    points = np.flatnonzero(raw == 46)
    signs = np.flatnonzero((raw == 43) | (raw == 45))
    low, high = np.searchsorted(points, first), np.searchsorted(points, end)
    good = (high - low <= 1) & (np.searchsorted(signs, first) == np.searchsorted(signs, end))
    return np.where(high > low, np.append(points, -1)[np.minimum(low, len(points))], -1), good


def _reduced(text: bytes, numbers: _Numbers) -> bytes:
    """Return a text with a mark for each of some numbers."""
    copy = np.frombuffer(text, np.uint8).copy()
    inside = np.zeros(len(copy) + 1, np.int8)
    inside[numbers.start + 1] += 1
    inside[numbers.end] -= 1
    copy[numbers.start] = MARK
    taken: bytes = copy[np.cumsum(inside[:-1]) == 0].tobytes()
    return taken


def _columns(numbers: _Numbers) -> Iterator[tuple[dict[str, Any], list[bytes]]]:
    """Yield a column for each letter: what it is called and packed by, and its bytes."""
    for letter in distinct(numbers.letter).tolist():
        mine = numbers.letter == letter
        finest = int(numbers.decimals[mine].max())
        value = numbers.mantissa[mine] * TEN_TO[finest - numbers.decimals[mine]]
        planes, head = folded(value)
        manners, manner = folded(numbers.manner[mine])
        said = {"letter": chr(letter), "decimals": finest, "number": head, "manner": manner}
        yield said, [planes, manners]
