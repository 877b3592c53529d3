"""Columns over the lines of a window: what is set on a line holds until it is set again."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from gcxform.system.arrays import Flags, Floats, Small


def fill(values: NDArray[Any], present: Flags, initial: float) -> NDArray[Any]:
    """Return a column in which every line has the value last set before or on it."""
    rows = np.flatnonzero(present)
    if len(rows) == len(values):
        return values
    given = np.full(len(rows) + 1, initial, values.dtype)
    if not len(rows):
        return np.repeat(given, len(values))
    given[1:] = values[rows]
    ends = np.append(rows, len(values))
    ends[1:] -= rows
    return np.repeat(given, ends)


def with_increments(value: Floats, placed: Flags, incremental: Flags, before: float) -> Floats:
    """Return positions where some lines place the axis and others add to where it stands.

    From a line that adds what is not known (nan) to one that places it, the axis is nowhere known.
    """
    unknown = incremental & np.isnan(value)
    steps = np.cumsum(np.where(incremental & ~unknown, value, 0.0))
    base = fill(np.where(placed, value - steps, 0.0), placed, before)
    if unknown.any():
        base = np.where(fill(unknown, placed | unknown, False), np.nan, base)
    return np.asarray(base + steps)


def extruded(
    rule: str, own: Small, said: Flags, distance: Small, stated: Flags, memory: dict[str, int]
) -> Small:
    """Return whether words of an extruder are distances: 1, 0, or -1 where that is not known.

    `own` is M83, as `said` by it or M82, and `distance` G91, as `stated` by it or G90; the last of
    both goes on in `memory`. `rule` is `MotionRule.extruder`.
    """
    last = fill(np.where(said, own, distance), said | stated, memory["extruded"])
    if len(last):
        memory["extruded"] = int(last[-1])
    by = {"own": own, "last": last, "either": np.maximum(own, distance)}
    return by[rule] if rule else np.where((last == own) & (own >= distance), own, np.int8(-1))
