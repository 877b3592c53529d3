"""A text split at its numbers, many lines at once, by operations on all of its bytes.

An expression looks at each number, which takes four times as long. It does it where digits, points
and signs stand together otherwise than in a number, and for short texts.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from itertools import compress

import numpy as np

from gcxform.system.arrays import Bytes, Flags, Ints

NUMBER = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)")
"""A number without an exponent, of any sign."""
NUMBER_OR_COMMA = re.compile(r"[+-]?(?:[0-9]+(?:[.,][0-9]*)?|[.,][0-9]+)")
"""One that may have a comma for its point."""
NUMBER_OF_WORD = re.compile(r"(?<![GMgm0-9.])[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)")
"""One that is not the number of a code, which is part of a name."""
SHORT = 256  # letters; shorter texts are sooner split by the expression
OTHER, DIGIT, POINT, SIGN, CODE = 0, 1, 2, 3, 4
SLOT = 0xFF  # a byte that no text of ASCII has


def _classes(points: str, codes: str) -> bytes:
    table = bytearray(256)
    for kind, letters in ((DIGIT, "0123456789"), (POINT, points), (SIGN, "+-"), (CODE, codes)):
        for letter in letters:
            table[ord(letter)] = kind
    return bytes(table)


CLASSES: Mapping[re.Pattern[str], bytes] = {
    NUMBER: _classes(".", ""),
    NUMBER_OR_COMMA: _classes(".,", ""),
    NUMBER_OF_WORD: _classes(".", "GMgm"),
}
"""What bytes are to those patterns of numbers that need not be looked for one by one."""


def split_at_numbers(text: str, slot: str, number: re.Pattern[str]) -> tuple[str, list[str]]:
    """Return a text with a slot in the place of each number, and the numbers."""
    table = CLASSES.get(number) if len(text) >= SHORT and text.isascii() else None
    found = _split(f" {text} ".encode("ascii"), table) if table is not None else None
    if found is not None:
        return found[0][1:-1].replace(chr(SLOT), slot), found[1]
    pieces = re.compile(f"({number.pattern})", number.flags).split(text)
    return slot.join(pieces[::2]), pieces[1::2]


def _split(text: bytes, table: bytes) -> tuple[str, list[str]] | None:
    """Return a text that begins and ends with a blank, with its numbers as slots, and these.

    None where digits, points and signs stand together otherwise than in a number.
    """
    kind = np.frombuffer(text.translate(table), np.uint8)
    inside = kind - np.uint8(DIGIT) < 3
    edges = np.flatnonzero(inside[1:] != inside[:-1]) + 1
    start, end = edges[0::2], edges[1::2]
    is_number = _numbers(kind, start, end)
    if is_number is None:
        return None
    runs = np.where(inside, np.frombuffer(text, np.uint8), np.uint8(32)).tobytes().decode().split()
    keep = ~inside
    if not is_number.all():
        runs = [*compress(runs, is_number.tolist())]
        at, stop = start[~is_number], end[~is_number]
        while len(at):
            keep[at] = True
            at, stop = at[at + 1 < stop] + 1, stop[at + 1 < stop]
    bare = np.frombuffer(text, np.uint8).copy()
    bare[start[is_number]] = SLOT
    keep[start[is_number]] = True
    return bare[keep].tobytes().decode("latin-1"), runs


def _numbers(kind: Bytes, start: Ints, end: Ints) -> Flags | None:
    """Return which runs are numbers: not those of codes, and those without a digit.

    None where a run has a sign inside or two points, or a code has a sign.
    """
    signed, of_code = kind[start] == SIGN, kind[start - 1] == CODE
    pointed = np.searchsorted(start, np.flatnonzero(kind == POINT), side="right") - 1
    inner = np.count_nonzero(kind == SIGN) > np.count_nonzero(signed)
    if inner or (pointed[1:] == pointed[:-1]).any() or (signed & of_code).any():
        return None
    digits = end - start - signed
    digits[pointed] -= 1
    found: Flags = (digits > 0) & ~of_code
    return found
