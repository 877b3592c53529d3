"""Sequential step diagonal (vector method): readings along four diagonals to nine functions.

All readings go into one weighted least squares problem (`equations`). Its solution is brought into
the end-point frame (`reframe`), with its covariance. A turn of the whole machine changes nothing
there, so it does not matter that it cannot be observed; anything else that cannot be observed does,
and is refused. With free beams that is the scales: of the nine end slopes the diagonals then tell
the three squarenesses and X^2 sX + Y^2 sY + Z^2 sZ, where s are the scale errors and X, Y, Z the
sides of the volume. Linear tests of two axes tell the rest (Chapman, Precis. Eng. 27 (2003) 401).

The method takes the machine to have no angular errors. Residuals are a weak sign of them: 20 urad
of roll, pitch and yaw make the nine functions wrong by 9 um, and the residuals 1 um (see `angles`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import Final

import numpy as np

from gcxform.calibrate.diagonal.equations import (
    Equations,
    Increments,
    Layout,
    equations,
    increments,
)
from gcxform.calibrate.diagonal.readings import Diagonals, LinearTest, beam, sideways
from gcxform.calibrate.diagonal.reframe import slopes_of, turn_of
from gcxform.calibrate.diagonal.slopes import SLOPES_AT, together
from gcxform.calibrate.solution import Scatter, Solution, plausible, reduced_rows, solve
from gcxform.diagnostics import InputError
from gcxform.errormodel.functions import AxisFunction, AxisFunctions
from gcxform.errormodel.model import AXES, check_contraction
from gcxform.system.arrays import Flags, Floats
from gcxform.values import dataclass

NOISE: Final = 0.001  # mm, of one step
REJECTED: Final = 3.0  # times the stated noise
_NOTHING: Final = 1e-7  # of a unit vector: below it an output does not depend on what is free


@dataclass(frozen=True)
class Assumed:
    """What is taken for granted: noise in mm of a step and of a linear reading, free beams."""

    noise: float = NOISE
    linear_noise: float | None = None
    free_beams: bool = True

    @property
    def of_linear(self) -> float:
        """The noise of a linear reading, mm: that of a step unless it is given."""
        return self.noise if self.linear_noise is None else self.linear_noise


@dataclass(frozen=True, eq=False)
class Identified:
    """What the readings tell, in the end-point frame.

    Its arrays have the axis, the direction of the error, the node behind the first: (3, 3, steps).
    """

    diagonals: Diagonals
    linear: tuple[LinearTest, ...]
    assumed: Assumed
    layout: Layout
    solution: Solution
    increments: Increments

    @property
    def scatter(self) -> Scatter:
        """What the residuals of all readings say of the stated noise."""
        found = self.solution
        return Scatter(self.assumed.noise, found.chi_square, found.redundancy)

    @cached_property
    def _framing(self) -> Floats:
        """The matrix (outputs, unknowns) from the unknowns to functions and misalignments."""
        return _framed(np.eye(self.layout.size), self.layout, self.diagonals).T

    @cached_property
    def _output(self) -> Floats:
        return np.asarray(self._framing @ self.solution.value)

    @cached_property
    def _hidden(self) -> Floats:
        """How the outputs (n, d) change along the directions that no reading sees."""
        return np.asarray(self._framing @ self.solution.free)

    @cached_property
    def _known(self) -> Flags:
        return np.asarray(np.abs(self._hidden).max(axis=1, initial=0.0) < _NOTHING)

    @property
    def functions(self) -> Floats:
        """The errors (3, 3, steps) in mm."""
        return np.asarray(self._output[: self.layout.errors].reshape(3, 3, -1))

    @property
    def determined(self) -> Flags:
        """Which functions (3, 3) are determined."""
        known = self._known[: self.layout.errors].reshape(3, 3, -1)
        return np.asarray(known.all(axis=2))

    @cached_property
    def covariance(self) -> Floats:
        """The covariance (9 steps, 9 steps) of `functions` in mm^2, for the effective noise."""
        return self._covariance(self._framing[: self.layout.errors])

    def _covariance(self, part: Floats) -> Floats:
        """Return the covariance of outputs of the effective noise, by their rows (k, unknowns)."""
        return np.asarray(self.scatter.factor**2 * (part @ self.solution.covariance @ part.T))

    @property
    def deviations(self) -> Floats:
        """The standard deviations (3, 3, steps) in mm."""
        variance = np.diag(self.covariance).clip(0.0)
        return np.asarray(np.sqrt(variance).reshape(3, 3, -1))

    @property
    def shapes(self) -> Floats:
        """The functions without the line through their ends (3, 3, steps), mm: always known."""
        parts = np.arange(1, self.layout.steps + 1) / self.layout.steps
        return self.functions - self.functions[..., -1:] * parts

    @cached_property
    def _slope_rows(self) -> Floats:
        """The six slopes of `SLOPES` from the outputs (6, outputs)."""
        rows = np.zeros((6, len(self._framing)))
        for k, (axis, direction) in enumerate(SLOPES_AT):
            last = (3 * axis + direction + 1) * self.layout.steps - 1
            rows[k, last] = 1.0 / self.diagonals.volume.travel[axis]
        return rows

    @property
    def slopes(self) -> tuple[Floats, Floats]:
        """Scales and slopes as in `SLOPES` (6,), mm per mm, and their covariance (6, 6)."""
        through = self._slope_rows[:, : self.layout.errors]
        return self._slope_rows @ self._output, through @ self.covariance @ through.T

    @property
    def mean_scale(self) -> tuple[float, float]:
        """(X^2 sX + Y^2 sY + Z^2 sZ) / R^2 and its standard deviation: it is always known."""
        square = self.diagonals.volume.travel**2
        weights = np.concatenate((square / square.sum(), np.zeros(3)))
        value, covariance = self.slopes
        return float(weights @ value), math.sqrt(max(float(weights @ covariance @ weights), 0.0))

    @property
    def hidden_slopes(self) -> Floats:
        """A basis (d, 6), in echelon form, of the slopes that change no reading."""
        seen = (self._slope_rows @ self._hidden).T * self.diagonals.volume.diagonal
        seen[np.abs(seen) < _NOTHING] = 0.0
        return reduced_rows(seen)

    @property
    def observable_slopes(self) -> Floats:
        """A basis (6 - d, 6), in echelon form, of the combinations that the readings tell."""
        hidden = self.hidden_slopes
        right = np.linalg.svd(np.pad(hidden, ((0, 6 - len(hidden)), (0, 0))))[2]
        return reduced_rows(right[len(hidden) :])

    @property
    def misalignments(self) -> tuple[Floats, Floats] | None:
        """Angles of the beams (set-ups, 2) and standard deviations, rad; None if not known."""
        first = self.layout.errors
        if not self.layout.beams or not self._known[first:].all():
            return None
        spread = np.sqrt(np.diag(self._covariance(self._framing[first:])).clip(0.0))
        scale = self.diagonals.volume.diagonal
        return self._output[first:].reshape(-1, 2) / scale, spread.reshape(-1, 2) / scale

    @property
    def redundancy(self) -> Floats:
        """The residuals of each axis and cell (3, steps) in mm, as a step would have them.

        With four diagonals of equal weight it is half of the modulus of the closure, such as
        m_ppp + m_npp - m_pnp - m_ppn of X.
        """
        rows = 3 * self.layout.steps * len(self.diagonals.lines)
        parts = self.solution.residual[:rows].reshape(-1, 3, self.layout.steps)
        return np.asarray(self.assumed.noise * np.sqrt((parts**2).sum(axis=0)))

    @property
    def redundancy_rms(self) -> float:
        """The noise of one step in mm that the residuals show; nan without redundancy."""
        return self.scatter.observed

    def model(self) -> AxisFunctions:
        """Return the nine functions.

        Raises InputError (GX476) if they are not determined, and UsageError (GX415) if no machine
        is like that: readings in a column of deviations have no redundancy against them.
        """
        if not self.determined.all():
            self._refuse()
        volume = self.diagonals.volume
        x, y, z = (
            AxisFunction(volume.nodes(k), np.pad(self.functions[k].T, ((1, 0), (0, 0))))
            for k in range(3)
        )
        model = AxisFunctions((x, y, z))
        check_contraction(model)
        return model

    def _refuse(self) -> None:
        names = [f"E{AXES[d]}{AXES[a]}" for a, d in np.argwhere(~self.determined)]
        free = "; ".join(together(row) for row in self.hidden_slopes)
        raise InputError.one(
            "GX476",
            f"the readings do not determine {', '.join(names)}: with beams free to be misaligned, "
            f"these errors change no reading: {free}",
            hint="give direct linear tests (--linear) of two axes; or --misalignment none, if the "
            f"beams were aligned to {self._harmless():.2g} urad or better",
        )

    def _harmless(self) -> float:
        """Return the misalignment in urad that shifts the end of a scale by the noise."""
        spread = self.diagonals.volume.diagonal / 2.0
        return 1e6 * self.assumed.noise / spread


def identify(
    diagonals: Diagonals, linear: Sequence[LinearTest] = (), assumed: Assumed | None = None
) -> Identified:
    """Return what the readings tell. Raises InputError (GX475) if they contradict each other.

    They do if the residuals of the diagonals, or what linear tests add to them, show more than
    `REJECTED` times the stated noise; or if beams are assumed to be aligned and misalignments
    explain the residuals far better (chi square, 0.1 %); or if other signs or scales of the linear
    tests do.
    """
    assumed = assumed or Assumed()
    alone = found = solved(diagonals, (), assumed)
    _reject(alone)
    if linear:
        found = solved(diagonals, linear, assumed)
        _reject_linear(found, alone)
    if not assumed.free_beams:
        _reject_aligned(found)
    if linear:
        _reject_signs(found)
        _reject_scales(found)
    return found


def solved(
    diagonals: Diagonals, linear: Sequence[LinearTest] = (), assumed: Assumed | None = None
) -> Identified:
    """Return the same without asking whether the readings agree."""
    assumed = assumed or Assumed()
    every: Equations = equations(
        diagonals, linear, assumed.noise, assumed.of_linear, assumed.free_beams
    )
    solution = solve(every.matrix, every.observed, every.deviation)
    return Identified(
        diagonals, tuple(linear), assumed, every.layout, solution, increments(diagonals)
    )


def _framed(unknowns: Floats, layout: Layout, diagonals: Diagonals) -> Floats:
    """Return functions and misalignments (..., outputs), mm, in the end-point frame.

    A turn theta of the machine in its beams is the turn -theta of the beams about the machine.
    """
    volume = diagonals.volume
    grown = unknowns[..., : layout.errors].reshape(*unknowns.shape[:-1], 3, 3, layout.steps)
    total = np.cumsum(grown, axis=-1)
    turn = turn_of(total[..., -1] / volume.travel[:, None])
    total += slopes_of(turn)[..., None] * volume.along()[:, None, :]
    outputs = [total.reshape(*unknowns.shape[:-1], layout.errors)]
    if layout.beams:
        aside = np.array([sideways(signs, volume.travel) for signs in diagonals.lines])
        along = np.array([beam(signs, volume.travel) for signs in diagonals.lines])
        turned = np.einsum("...lk,lik->...li", np.cross(along, turn[..., None, :]), aside)
        angles = unknowns[..., layout.angles]
        outputs.append(angles - volume.diagonal * turned.reshape(angles.shape))
    return np.concatenate(outputs, axis=-1)


def _reject(found: Identified) -> None:
    limit = REJECTED * found.assumed.noise
    if not found.redundancy_rms > limit:
        return
    axis, cell = np.unravel_index(int(found.redundancy.argmax()), found.redundancy.shape)
    start, end = found.diagonals.volume.nodes(int(axis))[[cell, cell + 1]]
    raise InputError.one(
        "GX475",
        f"the readings contradict each other by {_um(found.redundancy_rms)} um rms a step, more "
        f"than {REJECTED:g} times the noise of {_um(found.assumed.noise)} um; most in the step of "
        f"{AXES[axis]} from {start:.6g} to {end:.6g} mm, {_um(found.redundancy.max())} um",
        hint="look for a lost beam, a diagonal that was measured at another temperature, or "
        "misaligned beams (--misalignment free); or state the noise that there is",
    )


def _reject_linear(found: Identified, alone: Identified) -> None:
    added = found.solution.redundancy - alone.solution.redundancy
    gain = found.solution.chi_square - alone.solution.chi_square
    if added > 0 and gain > REJECTED**2 * added:
        times = math.sqrt(gain / added)
        raise InputError.one(
            "GX475",
            f"the linear tests contradict the diagonals, or each other: {times:.1f} times the "
            f"noise of {_um(found.assumed.of_linear)} um a reading",
            hint="look at units and signs (actual minus nominal), and at the temperatures; or "
            "state the noise that there is (--linear-noise)",
        )


def _reject_aligned(found: Identified) -> None:
    gain, limit = misalignment_gain(found)
    if gain > limit:
        raise InputError.one(
            "GX475",
            f"the beams were not along their diagonals: misalignments take {gain:.1f} off the "
            f"chi square of the residuals, where {limit:.1f} is plausible with a noise of "
            f"{_um(found.assumed.noise)} um",
            hint="the scales would be wrong; use --misalignment free with linear tests of two axes",
        )


def _reject_signs(found: Identified) -> None:
    """Refuse linear tests that fit far better if their deviations are taken with the other sign."""
    for axis in sorted({test.axis for test in found.linear}):
        turned = [
            replace(test, deviation=-test.deviation) if test.axis == axis else test
            for test in found.linear
        ]
        other = solved(found.diagonals, turned, found.assumed).solution
        gain = found.solution.chi_square - other.chi_square
        if gain > plausible(1) * max(1.0, other.ratio**2):
            raise InputError.one(
                "GX475",
                f"the linear test of {AXES[axis]} fits the diagonals far better with the opposite "
                f"sign: chi square is {gain:.1f} less then",
                hint="a deviation is the actual minus the nominal position",
            )


def _reject_scales(found: Identified) -> None:
    """Refuse linear tests whose scales are not those that the diagonals tell."""
    gain, limit = scale_gain(found)
    if limit < gain:
        raise InputError.one(
            "GX475",
            f"the scales of the linear tests contradict those of the diagonals: free scales take "
            f"{gain:.1f} off the chi square of the residuals, where {limit:.1f} is plausible",
            hint="look at the temperatures and at the compensation of the laser for them; or state "
            "the noise that there is (--noise, --linear-noise)",
        )


def scale_gain(found: Identified) -> tuple[float, float]:
    """Return by how much free scales of the linear tests lower chi square; what is plausible.

    There is nothing to gain where the tests and the diagonals tell no scale twice.
    """
    assumed, diagonals = found.assumed, found.diagonals
    every = equations(diagonals, found.linear, assumed.noise, assumed.of_linear, assumed.free_beams)
    slopes = np.zeros((len(every.observed), 3))
    first = 3 * found.layout.steps * len(diagonals.lines)
    for test in found.linear:
        rows = slice(first, first + len(test.position))
        slopes[rows, test.axis] = test.position - diagonals.volume.low[test.axis]
        first = rows.stop
    freed = solve(np.hstack([every.matrix, slopes]), every.observed, every.deviation)
    gained = found.solution.redundancy - freed.redundancy
    scatter = max(1.0, freed.ratio**2) if freed.redundancy > 0 else 1.0
    gain = found.solution.chi_square - freed.chi_square if gained > 0 else 0.0
    return gain, plausible(max(gained, 1)) * scatter


def misalignment_gain(found: Identified) -> tuple[float, float]:
    """Return by how much free beams lower chi square, and what is plausible (0.1 %)."""
    freed = solved(found.diagonals, found.linear, replace(found.assumed, free_beams=True))
    gained = found.solution.redundancy - freed.solution.redundancy
    return found.solution.chi_square - freed.solution.chi_square, plausible(max(gained, 1))


def _um(value: float) -> str:
    return f"{value * 1e3:.3g}"
