"""The values of an array, each once: what `np.unique` does, without the modules that it loads."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray


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
