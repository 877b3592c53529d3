"""Digits of a text as numbers, a whole column at once."""

from __future__ import annotations

import numpy as np

from gcxform.system.arrays import Floats, Ints

LONGEST = 8  # digits on either side of the point: together exact in 64 bits
WIDEST = 40  # bytes of a number that has more, and is read by itself
TEN_TO = 10.0 ** np.arange(LONGEST + 1)
KEEP_LAST = np.array([0, 0xFF000000, 0xFFFF0000, 0xFFFFFF00, 0xFFFFFFFF], np.uint32)
"""Masks for the last 0 ... 4 of four bytes."""


class Digits:
    """Reads the digits that stand before given offsets, a whole column at once.

    Four or eight bytes are loaded as one integer and their digits summed in pairs, then in fours.
    """

    def __init__(self, text: bytes) -> None:
        self.padded = b"0" * LONGEST + text

    def before(self, end: Ints, count: Ints) -> Ints:
        """Return the values of the `count` (at most 8) digits before the offsets `end`."""
        if int(count.max(initial=0)) <= 4:
            return self._four(end, count)
        octets = np.ndarray((len(self.padded) - 7,), "<u8", self.padded, strides=(1,))
        word = octets[end] ^ np.uint64(0x3030303030303030)
        shift = ((8 - np.clip(count, 0, 8)) * 8).astype(np.uint64)
        word = np.where(shift < 64, (word >> (shift & 63)) << (shift & 63), np.uint64(0))
        word = (word & np.uint64(0x0F0F0F0F0F0F0F0F)) * np.uint64(2561) >> np.uint64(8)
        word = (word & np.uint64(0x00FF00FF00FF00FF)) * np.uint64(6553601) >> np.uint64(16)
        word = (word & np.uint64(0x0000FFFF0000FFFF)) * np.uint64(42949672960001)
        return (word >> np.uint64(32)).astype(np.int64)

    def _four(self, end: Ints, count: Ints) -> Ints:
        quads = np.ndarray((len(self.padded) - 3,), "<u4", self.padded, strides=(1,))
        word = quads[end + 4] & KEEP_LAST[count]
        word = (word & np.uint32(0x0F0F0F0F)) * np.uint32(2561) >> np.uint32(8)
        word = (word & np.uint32(0x00FF00FF)) * np.uint32(6553601) >> np.uint32(16)
        return word.astype(np.int64)


def put_long(value: Floats, places: Ints, text: bytes, start: Ints, end: Ints) -> None:
    """Put numbers that are read one by one at their places among values."""
    spans = zip(start.tolist(), end.tolist(), strict=True)
    value[places] = [float(text[first:last]) for first, last in spans]
