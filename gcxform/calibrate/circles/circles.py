"""Circular tests in the planes of the linear axes: what makes them not round, and how sure that is.

All runs of one test (a plane, a place, a radius, a feed) are fitted together by the causes of
`causes.py`: least squares, so that a backlash is not taken for servo mismatch, nor that for
squareness. The covariance is that of Fisher's information, for the noise that the residuals show.
What is left of a real circle is not white: where neighbouring residuals are correlated (r, first
lag), there are as many fewer readings as sqrt((1 + r) / (1 - r)) says.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Final, NamedTuple

import numpy as np

from gcxform.calibrate.circles.causes import (
    BEHIND,
    HALF,
    WHOLE,
    Cause,
    SetUp,
    beyond,
    causes,
    ends,
    near_spikes,
)
from gcxform.calibrate.circles.deviations import figures
from gcxform.calibrate.circles.periods import Looked, periods
from gcxform.calibrate.rotary.axis import arc
from gcxform.calibrate.solution import Scatter, Solution, solve
from gcxform.diagnostics import InputError, Location
from gcxform.system.arrays import Flags, Floats, Ints
from gcxform.system.stages import stage
from gcxform.values import dataclass

SENSES: Final[Mapping[str, int]] = {"ccw": 1, "cw": -1, "probed": 0}
SEEN: Final = 3.0
"""Spikes are told from noise above this many times it."""
NEGLIGIBLE: Final = 1e-6
"""Parts of a direction that no reading depends on."""
ROUNDS: Final = 3  # of the second order
FEW: Final = 8  # readings of a run, at least


@dataclass(frozen=True, eq=False)
class Run:
    """Readings (n,) of one run in mm, actual less nominal radius, at angles (n,) in degrees.

    `sense` is +1 from the first axis of the plane towards the second (CCW), -1 the other way, 0 for
    points at which a probe stood still. `where` is the place of a reading in its file.
    """

    sense: int
    degrees: Floats
    readings: Floats
    where: Callable[[int], Location | None] = lambda row: None

    @property
    def name(self) -> str:
        """The name of the sense: CCW, CW or probed."""
        word = next(word for word, sense in SENSES.items() if sense == self.sense)
        return word.upper() if self.sense else word


class Size(NamedTuple):
    """How large a cause is and its standard deviation, in its unit; nan if it is not told.

    `effect` is the range of what it does to the radius, mm.
    """

    name: str
    unit: str
    value: float
    deviation: float
    effect: float


class Spike(NamedTuple):
    """A reversal spike in mm, outwards positive; `seen` if it is more than noise."""

    end: str
    sense: int
    height: float
    seen: bool


@dataclass(frozen=True)
class Asked:
    """How tests are to be read: the noise of a reading in mm, and which causes there are.

    `pitch` in mm is that of cyclic errors, `search` looks for one. All causes are asked for,
    whatever the arc, if `every`; spikes are looked for so many degrees `behind` a reversal.
    """

    noise: float = 1e-3
    pitch: float | None = None
    search: bool = False
    every: bool = False
    behind: float = BEHIND


@dataclass(frozen=True, eq=False)
class Fitted:
    """A circular test, its causes, and their sizes in mm.

    `second` (n,) is what a pivot that is off does to the second order, mm; `looked` is what a
    search for pitches has found.
    """

    setup: SetUp
    runs: tuple[Run, ...]
    asked: Asked
    causes: tuple[Cause, ...]
    used: Flags
    solution: Solution
    second: Floats
    looked: Looked | None = None

    @cached_property
    def degrees(self) -> Floats:
        """The angles of all readings (n,), degrees."""
        return np.concatenate([run.degrees for run in self.runs])

    @cached_property
    def readings(self) -> Floats:
        """All readings (n,), mm."""
        return np.concatenate([run.readings for run in self.runs])

    @cached_property
    def sense(self) -> Ints:
        """The senses of all readings (n,)."""
        return senses(self.runs)

    @property
    def where(self) -> Location | None:
        """The place of the first reading."""
        return self.runs[0].where(0)

    @property
    def one_sense(self) -> bool:
        """Whether all readings that were travelled to have one sense."""
        return len(set(self.sense[self.sense != 0].tolist())) == 1

    def place(self, row: int) -> Location | None:
        """Return the place of a reading, counted through all runs."""
        for run in self.runs:
            if row < len(run.readings):
                return run.where(row)
            row -= len(run.readings)
        return None

    @cached_property
    def arc(self) -> float:
        """The arc in degrees that the readings cover."""
        return covered(self.degrees)

    @cached_property
    def matrix(self) -> Floats:
        """The columns (n, m) of all causes."""
        return np.column_stack([cause.column for cause in self.causes])

    @cached_property
    def condition(self) -> float:
        """The condition number of the columns that were fitted, each of unit length.

        It is infinite where some of the causes are not told.
        """
        if not self.told.all():
            return math.inf
        columns = self.matrix[self.used]
        return float(np.linalg.cond(columns / np.linalg.norm(columns, axis=0)))

    @cached_property
    def residuals(self) -> Floats:
        """What the readings (n,) are off the fit, mm; also those that were left out of it."""
        return np.asarray(self.readings - self.second - self.matrix @ self.solution.value)

    @cached_property
    def scatter(self) -> Scatter:
        """What the residuals say of the stated noise."""
        return Scatter(self.asked.noise, self.solution.chi_square, self.solution.redundancy)

    @cached_property
    def correlation(self) -> float:
        """How neighbouring residuals are correlated: 0 where it may be chance."""
        left, count, square = 0.0, 0, 0.0
        for run in self.by_run(np.where(self.used, self.residuals, 0.0)):
            left, count = left + float(run[1:] @ run[:-1]), count + len(run)
            square += float(run @ run)
        found = left / square if square > 0.0 else 0.0
        return min(found, 0.999) if found > SEEN / math.sqrt(count) else 0.0

    @property
    def factor(self) -> float:
        """By what deviations for the stated, white noise are multiplied, 1 and more."""
        smooth = math.sqrt((1.0 + self.correlation) / (1.0 - self.correlation))
        return max(1.0, self.scatter.ratio * smooth) if self.solution.redundancy > 0 else 1.0

    @cached_property
    def covariance(self) -> Floats:
        """The covariance (m, m) of all causes, mm^2."""
        return np.asarray(self.solution.covariance * self.factor**2)

    @cached_property
    def told(self) -> Flags:
        """Which causes (m,) the readings determine."""
        free = np.abs(self.solution.free)
        return np.asarray(~(free > NEGLIGIBLE).any(axis=1))

    def by_run(self, values: Floats) -> list[Floats]:
        """Return values of all readings (n,), run by run."""
        return np.split(values, np.cumsum([len(run.readings) for run in self.runs])[:-1])

    def index(self, name: str) -> int | None:
        """Return the place of a cause by its name; None if it was not asked for, or is not told."""
        names = [cause.name for cause in self.causes]
        k = names.index(name) if name in names else None
        return k if k is not None and self.told[k] else None

    @cached_property
    def sizes(self) -> list[Size]:
        """Every cause in its unit, in the order of the causes."""
        return [self._size(k, cause) for k, cause in enumerate(self.causes)]

    def _size(self, k: int, cause: Cause) -> Size:
        if not self.told[k]:
            return Size(cause.name, cause.unit, math.nan, math.nan, math.nan)
        value, deviation = self.solution.value[k], math.sqrt(self.covariance[k, k])
        effect = float(np.ptp(cause.column * value))
        return Size(cause.name, cause.unit, cause.per * value, cause.per * deviation, effect)

    def size(self, name: str) -> Size:
        """Return a cause by its name. Raises KeyError if it was not asked for."""
        return {size.name: size for size in self.sizes}[name]

    @cached_property
    def effects(self) -> dict[str, float]:
        """The range in mm of what each group of causes does to the radius, the largest first.

        What the pivot is off the middle is no part of G, and not among them.
        """
        found = {}
        for group in dict.fromkeys(cause.group for cause in self.causes):
            own = [k for k, cause in enumerate(self.causes) if cause.group == group]
            if self.told[own].all():
                found[group] = float(np.ptp(self.matrix[:, own] @ self.solution.value[own]))
        heights = [abs(spike.height) for spike in self.spikes if spike.seen]
        found["reversal spikes"] = max(heights, default=0.0)
        found.pop("radius", None)  # few readings and a fine pitch may not tell it
        found.pop("centre", None)
        return dict(sorted(found.items(), key=lambda item: -item[1]))

    @cached_property
    def spikes(self) -> list[Spike]:
        """The reversal spikes, of each end and sense that readings show."""
        found = []
        for end in ends(self.setup):
            for sense in (1, -1):
                way = beyond(self.degrees, self.sense, end)
                here = (self.sense == sense) & (way >= 0.0) & (way < self.asked.behind)
                if here.any():
                    values = self.residuals[here]
                    height = float(values[np.abs(values).argmax()])
                    seen = abs(height) > SEEN * self.scatter.effective
                    found.append(Spike(end.name, sense, height, seen))
        return found

    @cached_property
    def paths(self) -> dict[str, Floats]:
        """The paths (n, 2) of all runs of a sense about the pivot, mm, as a person plots them."""
        found: dict[str, list[Floats]] = {}
        for run in sorted(self.runs, key=lambda run: run.sense):
            turns, size = np.radians(run.degrees), self.setup.radius + run.readings
            points = size[:, None] * np.column_stack([np.cos(turns), np.sin(turns)])
            found.setdefault(run.name, []).append(points)
        return {name: np.vstack(parts) for name, parts in found.items()}

    @cached_property
    def figures(self) -> dict[str, float]:
        """The figures of ISO 230-4, mm."""
        return figures(self.paths, self.setup.radius)

    @property
    def deviation(self) -> float:
        """The circular deviation of both senses, or of the one there is, mm."""
        return self.figures.get("G(b)", next(iter(self.figures.values())))


def senses(runs: Sequence[Run]) -> Ints:
    """Return the senses of all readings (n,) of some runs."""
    return np.concatenate([np.full(len(run.readings), run.sense) for run in runs])


def fit(setup: SetUp, runs: Sequence[Run], asked: Asked) -> Fitted:
    """Return a test fitted by its causes.

    Raises InputError (GX477) for too few readings, or ones that are not around a centre.
    """
    degrees, sense = np.concatenate([run.degrees for run in runs]), senses(runs)
    for run in runs:
        if len(run.readings) < FEW:
            message = f"a run of {len(run.readings)} readings is no circle: {FEW} are the least"
            raise InputError.one("GX477", message, run.where(0))
    if len(np.unique(np.round(degrees))) < FEW:
        message = "the readings stand at one place of a circle, or nearly so"
        raise InputError.one("GX477", message, runs[0].where(0))
    over = 360.0 if asked.every else covered(degrees)
    pitches = dict.fromkeys(setup.letters, asked.pitch) if asked.pitch else {}
    found = _fitted(setup, runs, asked, causes(setup, degrees, sense, over, pitches))
    if asked.search and over >= WHOLE:
        looked = _looked(found)
        found = _fitted(setup, runs, asked, causes(setup, degrees, sense, over, looked.pitches))
        found = replace(found, looked=looked)
    return _round(found)


def _fitted(setup: SetUp, runs: Sequence[Run], asked: Asked, among: Sequence[Cause]) -> Fitted:
    """Return a test fitted by some causes."""
    degrees, sense = np.concatenate([run.degrees for run in runs]), senses(runs)
    used = ~near_spikes(degrees, sense, setup, asked.behind)
    found = [cause for cause in among if cause.column[used].any()]
    matrix = np.column_stack([cause.column for cause in found])[used]
    readings = np.concatenate([run.readings for run in runs])[used]
    second = np.zeros(len(degrees))
    for done in range(ROUNDS):
        stage("fitting circles", done / ROUNDS)
        solution = solve(matrix, readings - second[used], np.full(len(readings), asked.noise))
        second = _of_pivot(setup, degrees, found, solution)
    return Fitted(setup, tuple(runs), asked, tuple(found), used, solution, second)


def _looked(found: Fitted) -> Looked:
    """Return what a search for the pitches of cyclic errors finds in a test."""
    first = np.zeros(len(found.degrees), dtype=bool)
    first[np.cumsum([0, *(len(run.readings) for run in found.runs[:-1])])] = True
    first |= ~np.append(True, found.used[:-1])
    used = found.used
    readings = (found.readings - found.second)[used]
    return periods(found.setup, found.degrees[used], readings, found.matrix[used], first[used])


def _of_pivot(setup: SetUp, degrees: Floats, found: Sequence[Cause], solution: Solution) -> Floats:
    """Return what the pivot that was found does to the second order (n,), mm.

    It is (c x u)^2 / (2 r), with the angles of u those of the command: 0.3 mm of a radius of 100 mm
    would be 4.5 urad of squareness.
    """
    names = [cause.name for cause in found]
    along, across = (float(solution.value[names.index(f"centre {k}")]) for k in (1, 2))
    turns = np.radians(degrees)
    aside = along * np.sin(turns) - across * np.cos(turns)
    return np.asarray(aside**2 / (2.0 * setup.radius))


def _round(found: Fitted) -> Fitted:
    """Return a test whose figures exist."""
    try:
        _ = found.figures
    except ValueError as error:
        raise InputError.one("GX477", str(error), found.where) from None
    return found


def covered(degrees: Floats) -> float:
    """Return the arc in degrees that readings (n,) of all runs cover, to a degree."""
    return arc(np.unique(np.round(degrees) % 360.0))


def left_out(found: Fitted) -> str:
    """Return in words which causes were not asked for because the arc is short; empty if none."""
    if found.asked.every or found.arc >= WHOLE:
        return ""
    shorter = f"an arc of {found.arc:.4g} degrees"
    if found.arc >= HALF:
        return f"{shorter}: straightness and cyclic errors are taken to be none (--causes all)"
    return f"{shorter}: squareness, scale and servo mismatch cannot be told apart on it"
