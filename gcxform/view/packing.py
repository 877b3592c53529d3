"""Whole numbers in few bytes, as the page unpacks them again.

A column is differenced up to twice, its signs folded into the last bit (zigzag), its bytes sorted
by their weight, and all of it deflated. Columns of toolpaths are smooth, so that most of these
bytes are 0. Sections follow one another in one store; the directory says where each is.
"""

from __future__ import annotations

import base64
import zlib
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from gcxform.system.arrays import Ints

LEVEL: Final = 6  # of deflate: 9 takes twice as long for a hundredth less
SAMPLE: Final = 1 << 15  # numbers, from the middle, by which the order of differences is chosen
ORDERS: Final = (0, 1, 2)
WIDTHS: Final = (1, 2, 4, 8)
MOST: Final = 1 << 50  # a number that is larger would not be exact in the page

Section = dict[str, Any]


def deflated(raw: bytes, level: int = LEVEL) -> bytes:
    """Return bytes deflated, without head and checksum."""
    maker = zlib.compressobj(level, zlib.DEFLATED, -15)
    return maker.compress(raw) + maker.flush()


class Store:
    """Sections one behind the other."""

    def __init__(self) -> None:
        self.parts: list[bytes] = []
        self.size = 0

    def raw(self, raw: bytes) -> Section:
        """Add bytes; return where they are."""
        packed = deflated(raw)
        found = {"at": self.size, "size": len(packed)}
        self.parts.append(packed)
        self.size += len(packed)
        return found

    def ints(self, values: NDArray[Any], scale: float = 1.0) -> Section:
        """Add whole numbers; each stands for `scale` of what the column holds."""
        planes, head = folded(np.asarray(values, np.int64))
        return {**self.raw(planes), **head, "scale": scale}

    def lengths(self, values: NDArray[Any], scale: float) -> Section:
        """Add numbers rounded to multiples of a scale; those that are not known become 0."""
        return self.ints(rounded(values, scale), scale)

    def text(self) -> str:
        """Return all sections in base64."""
        return base64.b64encode(b"".join(self.parts)).decode("ascii")


def rounded(values: NDArray[Any], scale: float) -> Ints:
    """Return numbers in units of a scale, 0 where they are not known or beyond all machines."""
    whole = np.round(np.nan_to_num(values, posinf=0.0, neginf=0.0) / scale)
    return np.where(np.abs(whole) < MOST, whole, 0).astype(np.int64)


def folded(values: Ints) -> tuple[bytes, dict[str, int]]:
    """Return the bytes of whole numbers, sorted by weight, and what undoes it."""
    order = _best_order(values)
    parts = _differenced(values, order)
    folds = ((parts << 1) ^ (parts >> 63)).view(np.uint64)
    width = next(w for w in WIDTHS if int(folds.max(initial=0)) < 1 << (8 * w))
    octets = folds.astype("<u8").view(np.uint8).reshape(-1, 8)
    planes = np.ascontiguousarray(octets[:, :width].T).tobytes()
    return planes, {"n": len(values), "width": width, "order": order}


def _best_order(values: Ints) -> int:
    """Return how often numbers are best differenced."""
    middle = max(0, (len(values) - SAMPLE) // 2)
    some = values[middle : middle + SAMPLE]
    return min(ORDERS, key=lambda order: _cost(_differenced(some, order)[order:]))


def _cost(values: Ints) -> float:
    """Return about how many bits numbers take."""
    return float(np.log2(1.0 + np.abs(values)).sum())


def _differenced(values: Ints, order: int) -> Ints:
    for _ in range(order):
        values = np.diff(values, prepend=np.int64(0))
    return values
