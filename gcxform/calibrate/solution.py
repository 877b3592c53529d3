"""Weighted linear least squares that knows what it cannot tell.

The solution of least norm by the singular values, with the covariance of what is determined and a
basis of the directions along which nothing changes any observation.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from gcxform.system.arrays import Flags, Floats
from gcxform.values import dataclass

FEW: Final = 8  # one in so many may be an outlier
CAUCHY: Final = 2.385  # half of the weight is lost here; 95 % efficient on one normal variable
TIGHT: Final = {"ftol": 1e-12, "xtol": 1e-12, "gtol": 1e-12}
SELDOM: Final = 1e-3  # how often noise alone is more than what is plausible
RANK: Final = 1e-9  # of the largest singular value: below it a direction is not determined


@dataclass(frozen=True, eq=False)
class Solution:
    """Least squares: values (n,), their covariance (n, n), directions without effect (n, d).

    `residual` (m,) is divided by the standard deviation of each observation; `basis` (m, rank) are
    the directions of such observations that the values can take, each of length 1.
    """

    value: Floats
    covariance: Floats
    free: Floats
    residual: Floats
    basis: Floats

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


@dataclass(frozen=True)
class Scatter:
    """What residuals say of the stated noise (mm): their chi square, and degrees of freedom.

    Deviations hold for the noise that there is. Where the residuals show more than was stated,
    they are scaled by how many times more, as weighted least squares does it (Birge's ratio, Phys.
    Rev. 40 (1932) 207); where they show less, the stated noise is believed.
    """

    noise: float
    chi_square: float
    redundancy: int

    @property
    def ratio(self) -> float:
        """The scatter that the residuals show, over the stated one; nan without redundancy."""
        return math.sqrt(self.chi_square / self.redundancy) if self.redundancy > 0 else math.nan

    @property
    def factor(self) -> float:
        """By what deviations for the stated noise are multiplied, 1 and more."""
        return max(1.0, self.ratio) if self.redundancy > 0 else 1.0

    @property
    def observed(self) -> float:
        """The noise that the residuals show, mm; nan without redundancy."""
        return self.noise * self.ratio

    @property
    def effective(self) -> float:
        """The noise that deviations are for, mm."""
        return self.noise * self.factor

    @property
    def plausible(self) -> bool:
        """Whether the stated noise explains the residuals; it does once in a thousand times not."""
        return self.redundancy <= 0 or self.chi_square <= plausible(self.redundancy)

    @property
    def warnings(self) -> list[str]:
        """What whoever believes the deviations has to know."""
        if self.plausible:
            return []
        return [
            f"the residuals show {1e3 * self.observed:.3g} um of noise where {1e3 * self.noise:.3g}"
            f" um is stated: chi square {self.chi_square:.4g} with {self.redundancy} degrees of "
            f"freedom, {plausible(self.redundancy):.4g} is plausible. Deviations are those of what "
            f"the residuals show, {self.factor:.3g} times those of the stated noise; state the "
            "noise that there is (--noise), or look for what else is in the readings"
        ]

    def report(self) -> dict[str, float | int | bool | None]:
        """Return the figures as plain values, mm."""
        return {
            "stated": self.noise,
            "observed": self.observed if self.redundancy > 0 else None,
            "chi-square": self.chi_square,
            "degrees-of-freedom": self.redundancy,
            "plausible": self.plausible,
            "deviations-scaled-by": self.factor,
        }


def solve(matrix: Floats, observed: Floats, deviation: Floats) -> Solution:
    """Return the solution x of matrix (m, n) @ x = observed (m,), standard deviations (m,)."""
    scaled = matrix / deviation[:, None]
    target = observed / deviation
    missing = max(0, scaled.shape[1] - len(scaled))
    # Rows of zeros, so that the decomposition has all directions.
    padded = np.pad(scaled, ((0, missing), (0, 0)))
    left, size, right = np.linalg.svd(padded, full_matrices=False)
    known = size > RANK * size[0]
    back, basis = right[known].T / size[known], left[: len(scaled), known]
    value = back @ (basis.T @ target)
    return Solution(value, back @ back.T, right[~known].T, target - scaled @ value, basis)


def belonging(standardised: Floats, outlying: float) -> Flags:
    """Return which readings (n,) belong to the rest, by their residuals over their deviations.

    `standardised` (n, k) are for the stated noise, `outlying` is from where on one is an outlier.
    Where more than a few are, they are not outliers but the noise is larger than was stated: that
    which most of them show is the measure then. (The median of what is normal is 0.6745 of its
    standard deviation.)
    """
    size = standardised.max(axis=1)
    if np.count_nonzero(size > outlying) * FEW <= len(size):
        return np.asarray(size <= outlying)
    shown = max(1.0, float(np.median(standardised)) / 0.6745)
    return np.asarray(size <= outlying * shown)


def cauchy(squares: Floats) -> Floats:
    """Return Cauchy's loss (3, 3 n) of readings of three residuals each, as scipy takes a loss.

    `squares` (3 n,) are of residuals over their noise. A loss of its own for each coordinate would
    depend on the directions of the axes.
    """
    part = np.repeat(squares.reshape(-1, 3).sum(axis=1) / CAUCHY**2, 3)
    # Without the second derivative scipy's steps are those of reweighting.
    return np.stack([CAUCHY**2 * np.log1p(part) / 3.0, 1.0 / (1.0 + part), np.zeros_like(part)])


def plausible(degrees: int) -> float:
    """Return what chi square with some degrees of freedom exceeds once in a thousand times."""
    from scipy.special import chdtri

    return float(chdtri(degrees, SELDOM))


def reduced_rows(rows: Floats) -> Floats:
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
