"""The values of an array: what `np.unique` and `np.isin` do, without the time that they take."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gcxform.system.arrays import Flags


def distinct(values: NDArray[Any]) -> NDArray[Any]:
    """Return the values (n,) of an array, ascending and each once.

    `np.unique` loads `numpy.ma` when it is called first, which takes 6 ms of every run.
    """
    ordered = np.sort(values, axis=None)
    new = np.ones(len(ordered), np.bool_)
    np.not_equal(ordered[1:], ordered[:-1], out=new[1:])
    return ordered[new]


def union(one: NDArray[Any], other: ArrayLike) -> NDArray[Any]:
    """Return the values that are in an array or another of its type, ascending and each once."""
    return distinct(np.append(one, np.asarray(other, one.dtype)))


def one_of(values: NDArray[Any], some: Iterable[int]) -> Flags:
    """Return which values are one of a few: `np.isin` takes ten times as long for a short array."""
    found = np.zeros(values.shape, np.bool_)
    for each in some:
        found |= values == int(each)
    return found
