"""Weighted linear least squares that knows what it cannot tell.

The solution of least norm by the singular values, with the covariance of what is determined and a
basis of the directions along which nothing changes any observation.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from gcxform.machine.errors import FloatArray

RANK: Final = 1e-9  # of the largest singular value: below it a direction is not determined


@dataclass(frozen=True, eq=False)
class Solution:
    """Least squares: values (n,), their covariance (n, n), directions without effect (n, d).

    `residual` (m,) is divided by the standard deviation of each observation.
    """

    value: FloatArray
    covariance: FloatArray
    free: FloatArray
    residual: FloatArray

    @property
    def rank(self) -> int:
        """How many directions are determined."""
        return len(self.value) - int(self.free.shape[1])

    @property
    def redundancy(self) -> int:
        """How many observations there are beyond what is needed."""
        return len(self.residual) - self.rank

    @property
    def chi_square(self) -> float:
        """The sum of squares of the residuals."""
        return float(self.residual @ self.residual)

    @property
    def ratio(self) -> float:
        """The scatter that the residuals show, over the stated one; nan without redundancy."""
        return math.sqrt(self.chi_square / self.redundancy) if self.redundancy > 0 else math.nan


def solve(matrix: FloatArray, observed: FloatArray, deviation: FloatArray) -> Solution:
    """Return the solution x of matrix (m, n) @ x = observed (m,), standard deviations (m,)."""
    scaled = matrix / deviation[:, None]
    target = observed / deviation
    missing = max(0, scaled.shape[1] - len(scaled))
    # Rows of zeros, so that the decomposition has all directions.
    padded = np.pad(scaled, ((0, missing), (0, 0)))
    left, size, right = np.linalg.svd(padded, full_matrices=False)
    known = size > RANK * size[0]
    back = right[known].T / size[known]
    value = back @ (left[: len(scaled), known].T @ target)
    return Solution(value, back @ back.T, right[~known].T, target - scaled @ value)


def plausible(degrees: int) -> float:
    """Return what chi square with some degrees of freedom exceeds once in a thousand times.

    By Wilson and Hilferty (Proc. Nat. Acad. Sci. 17 (1931) 684); within 3 % of the tables.
    """
    part = 2.0 / (9.0 * degrees)
    return degrees * (1.0 - part + 3.0902 * math.sqrt(part)) ** 3


def reduced_rows(rows: FloatArray) -> FloatArray:
    """Return a basis (r, n) of the space of rows (m, n) in reduced echelon form.

    It is the form in which a person reads a space: a one in each row where the others have zero.
    """
    work = np.array(rows, np.float64)
    scale = np.abs(work).max(initial=0.0)
    done = 0
    for column in range(work.shape[1]):
        if done == len(work) or scale == 0.0:
            break
        best = done + int(np.argmax(np.abs(work[done:, column])))
        if abs(work[best, column]) <= 1e-6 * scale:
            continue
        work[[done, best]] = work[[best, done]]
        work[done] /= work[done, column]
        others = np.arange(len(work)) != done
        work[others] -= work[others, column][:, None] * work[done]
        done += 1
    return np.asarray(work[:done])
