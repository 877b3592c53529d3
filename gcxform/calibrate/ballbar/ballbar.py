"""Where the rotary axes of a table are, from circular tests with a ballbar while RTCP is on.

A ball stands on the table, another in the spindle, and a bar between them measures their distance.
The control follows the tip with the axes as it believes them to be, so that the bar would keep its
length; what is wrong with an axis shows as a first harmonic of its angle, an eccentricity. Where an
axis v is off by the shift d and its direction by t, with the table ball at l from it, the spindle
ball off its spindle by e, and the bar in the direction u at 0 (R turns as the axis does):

    reading = const + u . R' (e - d - l_v t)        a bar square to the axis
    reading = const + t . R l                       a bar along it

to the first order. Both are a cosine and a sine, linear in d and t: a bar square to the axis tells
the shift, one along it the direction, by the lever l. So each trace is fitted by const + a cos + b
sin, on any arc, and the eccentricities of all tests by the errors of all axes, with covariance.
What is left of second order, some hundredths of a micrometre, is computed with the axes found and
taken off, until nothing changes.
(Tsutsumi and Saito, Int. J. Mach. Tools Manuf. 43 (2003) 771, for the names; the equations agree
with those of the reference, section 5, for the trunnion with the axes A and C.)
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Final

import numpy as np

from gcxform.calibrate.bundle.bundle import across, moved
from gcxform.calibrate.rotary.axis import HOPELESS, REJECTED, arc, condition, distinct
from gcxform.calibrate.solution import Scatter, Solution, solve
from gcxform.diagnostics import InputError, Location
from gcxform.machine.chain import Chain, Rotary, Triple
from gcxform.system.arrays import Floats
from gcxform.values import dataclass

LEVER: Final = 100.0
"""Unknown tilts are scaled by this length in mm, to be as large as shifts."""
BAR: Final = 100.0  # mm
QUARTERS: Final = np.array([0.0, 90.0, 180.0, 270.0])
COEFFICIENTS: Final = 3  # of a trace: cosine, sine, constant
ROUNDS: Final = 3
"""The second order is a thousandth of the first: three times leave nothing."""
UNKNOWNS: Final = ("shift 1", "shift 2", "tilt 1", "tilt 2")


@dataclass(frozen=True)
class SetUp:
    """A circular test: the axis that turns, the bar, and where the ball stands on the table.

    `bar` is the unit vector from the table ball to the spindle ball, `ball` the place of the table
    ball in mm, both in machine coordinates with all rotary axes at 0; `length` is that of the bar.
    """

    letter: str
    bar: Triple
    ball: Triple
    length: float = BAR


@dataclass(frozen=True, eq=False)
class Trace:
    """Readings (n,) in mm, longer is positive, at angles (n,) in degrees; the place of a row."""

    setup: SetUp
    degrees: Floats
    readings: Floats
    where: Callable[[int], Location | None] = lambda row: None


@dataclass(frozen=True, eq=False)
class Eccentricity:
    """The first harmonic (2,), cosine and sine of the commanded angle, with its covariance, mm.

    `trace` is what it was fitted to; of eccentricities that are given there is none.
    """

    setup: SetUp
    value: Floats
    covariance: Floats
    trace: Trace | None = None
    where: Location | None = None

    @cached_property
    def fitted(self) -> Floats:
        """The three coefficients (3,) of cosine, sine and 1, mm."""
        assert self.trace is not None
        return _harmonic(self.trace.degrees, self.trace.readings)

    @property
    def angles(self) -> Floats:
        """Where the readings were taken, degrees; those of eccentricities that are given."""
        return QUARTERS if self.trace is None else self.trace.degrees

    @cached_property
    def residuals(self) -> Floats:
        """What the readings (n,) are off the fit, mm."""
        assert self.trace is not None
        return np.asarray(self.trace.readings - _rows(self.trace.degrees) @ self.fitted)

    @property
    def rms(self) -> float:
        """The noise that the residuals show, mm; nan without redundancy."""
        more = len(self.residuals) - COEFFICIENTS
        return math.sqrt(float(self.residuals @ self.residuals) / more) if more > 0 else math.nan


@dataclass(frozen=True, eq=False)
class Identified:
    """The rotary axes as the tests tell them: the machine as believed, what was measured, how.

    `solution` has shifts (mm) and tilts (times `LEVER`, mm) of each axis along `across`.
    """

    believed: Chain
    tests: tuple[Eccentricity, ...]
    spindle: tuple[float, float]
    noise: float
    solution: Solution

    @cached_property
    def unknowns(self) -> Floats:
        """Of each axis two shifts, mm, and two tilts, rad (4 m,)."""
        return np.asarray(self.solution.value * self._scale)

    @cached_property
    def scatter(self) -> Scatter:
        """What the residuals of all traces, and of their eccentricities, say of the noise."""
        traces = [test.residuals / self.noise for test in self.tests if test.trace is not None]
        within = sum(float(each @ each) for each in traces)
        freedom = sum(len(each) - COEFFICIENTS for each in traces)
        between = self.solution
        chi_square = within + between.chi_square
        return Scatter(self.noise, chi_square, freedom + between.redundancy)

    @cached_property
    def covariance(self) -> Floats:
        """Their covariance (4 m, 4 m), for the effective noise."""
        scale = self.scatter.factor * self._scale
        return np.asarray(self.solution.covariance * np.outer(scale, scale))

    @property
    def _scale(self) -> Floats:
        return np.tile([1.0, 1.0, 1.0 / LEVER, 1.0 / LEVER], len(self.believed.table))

    @property
    def letters(self) -> tuple[str, ...]:
        """The letters of the axes of the table."""
        return tuple(axis.letter for axis in self.believed.table)

    @property
    def predicted(self) -> Floats:
        """The eccentricities (2 n,) of the tests with the axes that were found, mm."""
        found = []
        for test in self.tests:
            read = readings(self.believed, self.chain, test.setup, test.angles, self.spindle)
            found.append(_harmonic(test.angles, read)[:2])
        return np.concatenate(found)

    @property
    def chain(self) -> Chain:
        """The machine with the axes that were found."""
        axes = enumerate(self.believed.table)
        return replace(
            self.believed,
            table=tuple(moved(axis, self.unknowns[4 * k : 4 * k + 4]) for k, axis in axes),
        )


def eccentricity(trace: Trace, noise: float) -> Eccentricity:
    """Return the first harmonic of a trace on any arc; `noise` of a reading in mm.

    Raises InputError: arcs too short (GX487), readings that are no such wave (GX475).
    """
    degrees = trace.degrees
    poor = condition(degrees) if distinct(degrees) >= 3 else math.inf
    if poor > HOPELESS:
        raise InputError.one(
            "GX487",
            f"an arc of {arc(degrees):.3g} degrees does not determine an eccentricity: condition "
            f"{poor:.0f}, at most {HOPELESS:.0f} is accepted",
            trace.where(0),
            "measure along a longer arc; 180 degrees and more are good",
        )
    rows = _rows(degrees)
    covariance = np.asarray(noise**2 * np.linalg.inv(rows.T @ rows)[:2, :2])
    value = _harmonic(degrees, trace.readings)[:2]
    found = Eccentricity(trace.setup, value, covariance, trace, trace.where(0))
    if found.rms > REJECTED * noise:
        raise InputError.one(
            "GX475",
            f"the trace is off a circle by {found.rms * 1e3:.3g} um rms, more than {REJECTED:g} "
            f"times the noise of {noise * 1e3:.3g} um",
            trace.where(int(np.abs(found.residuals).argmax())),
            "the worst is marked; look at angles, signs and units, or state the noise there is "
            "(--noise)",
        )
    return found


def identify(
    chain: Chain,
    tests: Sequence[Eccentricity],
    spindle: tuple[float, float],
    noise: float,
) -> Identified:
    """Return the axes of the table that explain the eccentricities.

    `spindle` is how far the spindle ball is off the spindle in X and Y, mm. Raises InputError:
    an axis that turns no table (GX490), tests that do not determine all axes (GX489), tests that
    contradict each other (GX475).
    """
    for test in tests:
        if test.setup.letter not in [axis.letter for axis in chain.table]:
            message = f"the axis {test.setup.letter} turns no table of this machine"
            raise InputError.one("GX490", message, test.where)
    matrix = np.vstack([_design(chain, test.setup) for test in tests])
    white = _whitening(tests)
    measured = np.concatenate([test.value for test in tests])
    other = np.concatenate([_of_spindle(chain, test.setup, spindle) for test in tests])
    for _ in range(ROUNDS):
        solution = solve(white @ matrix, white @ (measured - other), np.ones(len(other)))
        found = Identified(chain, tuple(tests), spindle, noise, solution)
        other = found.predicted - matrix @ solution.value
    _check(chain, tests, solution)
    return found


def readings(
    control: Chain,
    true: Chain,
    setup: SetUp,
    degrees: Floats,
    spindle: tuple[float, float] = (0.0, 0.0),
) -> Floats:
    """Return what the bar reads (n,) in mm at angles (n,) of a test, in any order of the errors.

    Nominally the spindle ball is at the end of the bar in the frame of the table, and the control
    moves there by the machine that it knows; the table ball is where the true axes carry it.
    """
    angles = np.zeros((len(degrees), len(control.axes)))
    angles[:, control.letters.index(setup.letter)] = degrees
    ball = np.tile(np.array(setup.ball), (len(degrees), 1))
    held = ball + setup.length * np.array(setup.bar)
    apart = control.onto_machine(held, angles) - true.onto_machine(ball, angles)
    apart += np.array([*spindle, 0.0])
    return np.asarray(np.linalg.norm(apart, axis=1) - setup.length)


def _whitening(tests: Sequence[Eccentricity]) -> Floats:
    """Return the matrix (2 n, 2 n) that makes the noise of all eccentricities 1."""
    from scipy.linalg import block_diag

    roots = (np.linalg.cholesky(test.covariance) for test in tests)
    return np.asarray(block_diag(*(np.linalg.inv(root) for root in roots)))


def _check(chain: Chain, tests: Sequence[Eccentricity], solution: Solution) -> None:
    """Raise InputError for unknowns that are not determined, and for contradictions."""
    names = [f"{axis.letter} {name}" for axis in chain.table for name in UNKNOWNS]
    for row in solution.free.T:
        raise InputError.one(
            "GX489",
            f"the tests determine {solution.rank} of {len(names)} unknowns, and not "
            f"{_seen(names, row)}",
            tests[0].where,
            "each axis of the table needs a bar square to it, and one along it with the ball far "
            "from the axis",
        )
    if solution.ratio > REJECTED:
        worst = int(np.abs(solution.residual).argmax()) // 2
        raise InputError.one(
            "GX475",
            f"the tests contradict each other by {solution.ratio:.1f} times the stated noise",
            tests[worst].where,
            "the worst is marked; look at the places of the balls, at the bars and signs",
        )


def _seen(names: Sequence[str], row: Floats) -> str:
    """Return the unknowns in a direction, in words."""
    large = np.abs(row) > 1e-3 * np.abs(row).max()
    return ", ".join(name for name, said in zip(names, large.tolist(), strict=True) if said)


def _design(chain: Chain, setup: SetUp) -> Floats:
    """Return what shifts and scaled tilts of all axes do to cosine and sine (2, 4 m)."""
    k = [axis.letter for axis in chain.table].index(setup.letter)
    axis = chain.table[k]
    along, basis = np.array(axis.direction), across(axis)
    lever = np.subtract(setup.ball, axis.point)
    part = float(np.dot(setup.bar, along))
    square = _square(axis, setup)
    arms = np.array([lever - (lever @ along) * along, axis.sign * np.cross(along, lever)])
    tilts = part * arms - (lever @ along) * square
    rows = np.zeros((2, 4 * len(chain.table)))
    rows[:, 4 * k : 4 * k + 2] = -square @ basis.T
    rows[:, 4 * k + 2 : 4 * k + 4] = tilts @ basis.T / LEVER
    return rows


def _of_spindle(chain: Chain, setup: SetUp, spindle: tuple[float, float]) -> Floats:
    """Return what a ball that is off the spindle does to cosine and sine (2,), mm."""
    axis = next(axis for axis in chain.table if axis.letter == setup.letter)
    return np.asarray(_square(axis, setup) @ np.array([*spindle, 0.0]))


def _square(axis: Rotary, setup: SetUp) -> Floats:
    """Return how the part of the bar across an axis turns: vectors (2, 3) of cosine and sine."""
    along = np.array(axis.direction)
    square = np.array(setup.bar) - np.dot(setup.bar, along) * along
    return np.array([square, axis.sign * np.cross(along, square)])


def _rows(degrees: Floats) -> Floats:
    radians = np.radians(degrees)
    return np.column_stack([np.cos(radians), np.sin(radians), np.ones(len(degrees))])


def _harmonic(degrees: Floats, readings: Floats) -> Floats:
    return np.asarray(np.linalg.lstsq(_rows(degrees), readings, rcond=None)[0])
