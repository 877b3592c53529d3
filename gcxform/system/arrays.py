"""The array types of every column: what an annotation says where numpy's own name is longer."""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]  # positions, lengths, feeds, angles
Ints = NDArray[np.int64]  # rows, lines, shapes, counts
Small = NDArray[np.int8]  # kinds, planes, modes: one of a few
Flags = NDArray[np.bool_]  # which rows
Bytes = NDArray[np.uint8]  # text
Kept = TypeVar("Kept", bound=NDArray[Any])


def read_only(values: Kept) -> Kept:
    """Return an array that is kept and given to many, so that none of them can write into it."""
    values.flags.writeable = False
    return values
