"""Columns over the lines of a window: what is set on a line holds until it is set again."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from gcxform.system.arrays import Flags


def fill(values: NDArray[Any], present: Flags, initial: float) -> NDArray[Any]:
    """Return a column in which every line has the value last set before or on it."""
    rows = np.flatnonzero(present)
    if len(rows) == len(values):
        return values
    given = np.append(np.array(initial, values.dtype), values[rows])
    return np.repeat(given, np.diff(rows, prepend=0, append=len(values)))
