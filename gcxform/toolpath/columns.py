"""The columns of a toolpath: their names, their types, and arrays that take little memory."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gcxform.system.arrays import Flags, Floats, Ints

COLUMNS = (
    "kind",
    "end",
    "centre",
    "sweep",
    "plane",
    "feed",
    "feed_mode",
    "frame",
    "source",
    "nth",
    "form",
    "side",
    "radius",
    "lost",
    "control",
    "tool",
)


TYPES: Mapping[str, np.dtype[Any]] = {
    **dict.fromkeys((*COLUMNS, "entry"), np.dtype(np.float64)),
    **dict.fromkeys(("frame", "source", "nth", "lost"), np.dtype(np.int64)),
    **dict.fromkeys(("kind", "plane", "feed_mode", "form", "side"), np.dtype(np.int8)),
}
"""What each column holds: a position that is kept in whole numbers would be cut off."""


def typed(name: str, column: object, kind: np.dtype[Any]) -> NDArray[Any]:
    """Return a column in its type; whole numbers become any other, nothing becomes whole."""
    found = np.asarray(column)
    whole = found.dtype.kind in "biu"
    if not whole and not (kind.kind == "f" and found.dtype.kind == "f"):
        raise TypeError(f"{name} of a toolpath holds {kind}, which {found.dtype} does not become")
    column = found.astype(kind)
    if (column != found).any() and whole:
        raise TypeError(f"{name} of a toolpath has numbers that {kind} does not hold")
    return column


def picked(column: NDArray[Any], rows: Ints | Flags) -> NDArray[Any]:
    """Return a column at rows; a column that holds one value keeps taking no memory."""
    if any(column.strides) or not len(column):
        return column[rows]
    count = int(np.count_nonzero(rows)) if rows.dtype == np.bool_ else len(rows)
    return np.broadcast_to(column[0], (count, *column.shape[1:]))


def column_major(rows: int, columns: int) -> Floats:
    """Return an empty (rows, columns) array whose columns are contiguous."""
    return np.empty((columns, rows)).T


def constant(value: float, rows: int, dtype: type = np.float64) -> NDArray[Any]:
    """Return a read-only column that holds one value and takes no memory."""
    one: NDArray[Any] = np.array(value, dtype)
    column: NDArray[Any] = np.ndarray((rows,), one.dtype, one, 0, (0,))  # broadcast_to is slow
    column.flags.writeable = False
    return column
