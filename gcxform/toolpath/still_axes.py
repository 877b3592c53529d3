"""Which axes a move leaves where they are."""

from __future__ import annotations

import numpy as np

from gcxform.dialect.dialect import LINEAR
from gcxform.system.arrays import Flags
from gcxform.toolpath.path import Toolpath

SAME_PLACE = 1e-7  # mm, deg; an axis that moves by less stands still


def turns_only(path: Toolpath) -> Flags:
    """Return the moves (n,) in which no linear axis moves and a rotary one does."""
    rotary = [k for k, axis in enumerate(path.axes) if axis not in LINEAR]
    if not rotary or not len(path):
        return np.zeros(len(path), np.bool_)
    return np.asarray(~moves_linear(path) & ~_still(path)[:, rotary].all(axis=1))


def moves_linear(path: Toolpath) -> Flags:
    """Return the moves (n,) in which a linear axis moves."""
    linear = [k for k, axis in enumerate(path.axes) if axis in LINEAR]
    return np.asarray(~_still(path)[:, linear].all(axis=1))


def _still(path: Toolpath) -> Flags:
    """Return which axes (n, axes) stay where they are."""
    start, ends = path.start, path.end
    still = (start == ends) | (np.isnan(start) & np.isnan(ends))
    with np.errstate(invalid="ignore"):  # an axis that was left where it is (inf) stays there
        still |= np.abs(start - ends) < SAME_PLACE
    return np.asarray(still)
