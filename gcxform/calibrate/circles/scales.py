"""The scales of the axes from the radii and the scale differences of circular tests.

A test tells the difference of the scales of its axes. Of a calibrated bar, or a ring, it tells with
its radius r their mean as well:

    (radius found - r) / r = (s1 + s2) / 2 - (v T)^2 / (2 r^2) + e / r

T is what the axes lag behind at the feed v, so that two feeds tell it, or a ring that was probed at
rest. e is what the stated radius is off: nothing in a circle tells it from a scale that all axes
have, so that each stated radius has one e, known to be 0 within its calibration, and that is in the
uncertainty of the scales. What several radii, or several planes, say of one axis must agree: a
radius that is not that of its ring is seen there, and nowhere else.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import Final, NamedTuple

import numpy as np

from gcxform.calibrate.circles.causes import PLANES
from gcxform.calibrate.circles.circles import Fitted
from gcxform.calibrate.rotary.axis import REJECTED
from gcxform.calibrate.solution import Solution, solve
from gcxform.errormodel.model import AXES
from gcxform.system.arrays import Floats
from gcxform.values import dataclass

BAR: Final = "bar"
NONE: Final = "none"
RADIUS_NOISE: Final = 1e-3  # mm: what rings and the calibrators of bars are known to
LARGEST: Final = 1e-3
"""mm per mm: a scale beyond is a radius that is wrong, or a control that is set wrong. A ball screw
of class C7 is 52 um off in 300 mm, a sixth of it (pinsimotion.com, accuracy of ball screws)."""


class Told(NamedTuple):
    """A value and its standard deviation; `agree` is how tests of it agree, times their own."""

    value: float
    deviation: float
    agree: float = math.nan


class Equation(NamedTuple):
    """What a test says of the scales: `row` (4,) @ (s_X, s_Y, s_Z, T^2) is `value` +- `deviation`.

    `radius` in mm is that of the bar if it takes part in it, else 0.
    """

    test: int
    row: Floats
    value: float
    deviation: float
    radius: float = 0.0


@dataclass(frozen=True, eq=False)
class Scales:
    """The scales that tests tell if one of them is known; `source` is an axis, `bar` or `none`.

    `radius_noise` in mm is the standard deviation of the radius of a bar, or a ring.
    """

    tests: tuple[Fitted, ...]
    source: str = NONE
    radius_noise: float = RADIUS_NOISE

    @cached_property
    def equations(self) -> list[Equation]:
        """What the tests say."""
        return [*_equations(self.tests, self.source == BAR)]

    @cached_property
    def radii(self) -> list[float]:
        """The stated radii that scales rest on, mm."""
        return sorted({each.radius for each in self.equations if each.radius})

    @cached_property
    def solution(self) -> Solution:
        """The scales (3,), T^2 in s^2, and what each of the radii is off, mm.

        What no circle tells is free.
        """
        size = 4 + len(self.radii)
        rows, values, deviations = [np.zeros(size)], [0.0], [1.0]
        for each in self.equations:
            row = np.append(each.row, np.zeros(len(self.radii)))
            if each.radius:
                row[4 + self.radii.index(each.radius)] = 1.0 / each.radius
            rows.append(row)
            values.append(each.value)
            deviations.append(each.deviation)
        for k in range(len(self.radii)):
            rows.append(np.eye(size)[4 + k])
            deviations.append(self.radius_noise)
        if self.source in AXES:
            rows.append(np.eye(size)[AXES.index(self.source)])
            deviations.append(1e-9)
        values += [0.0] * (len(rows) - len(values))
        return solve(np.array(rows), np.array(values), np.array(deviations))

    @cached_property
    def told(self) -> dict[str, Told]:
        """The scale errors of the axes that are told, mm per mm; none are asked for with `none`."""
        if self.source == NONE:
            return {}
        known = np.asarray(~(np.abs(self.solution.free) > 1e-6).any(axis=1))
        ratio = self._ratio
        return {
            letter: Told(
                float(self.solution.value[k]),
                max(1.0, ratio) * math.sqrt(max(0.0, float(self.solution.covariance[k, k]))),
                ratio,
            )
            for k, letter in enumerate(AXES)
            if known[k] and letter != self.source
        }

    @property
    def _ratio(self) -> float:
        """How tests agree, times their deviations; 0 where nothing is said twice."""
        freedom = self.solution.redundancy - 1  # the first row is empty
        return math.sqrt(self.solution.chi_square / freedom) if freedom > 0 else 0.0

    @cached_property
    def doubt(self) -> tuple[int, str] | None:
        """Return why the radii cannot be right, and the test to look at; None if they may be."""
        if self.source != BAR or not self.told:
            return None
        test, away = self._worst()
        if away > REJECTED * self.radius_noise:
            return test, (
                f"what the tests say of the scales differs by {1e3 * away:.3g} um of a radius, "
                f"and the radii are known to {1e3 * self.radius_noise:.3g} um: one of them is "
                "not that of its bar or ring, or the scale is not the same everywhere"
            )
        letter, largest = max(self.told.items(), key=lambda item: abs(item[1].value))
        if abs(largest.value) > LARGEST:
            return test, (
                f"the scale of {letter} would be off by {100 * largest.value:.3g} %: the radius "
                "is not that of the bar or ring, or the control counts wrong"
            )
        return None

    def _worst(self) -> tuple[int, float]:
        """Return the test that agrees least with the others, and by how much of its radius, mm."""
        found = [(0, 0.0)]
        off = self.solution.value[4:]
        for each, residual in zip(self.equations, self.solution.residual[1:], strict=False):
            radius = self.tests[each.test].setup.radius
            away = abs(float(residual)) * each.deviation * radius
            bar = abs(float(off[self.radii.index(each.radius)])) if each.radius else 0.0
            found.append((each.test, max(away, bar)))
        return max(found, key=lambda item: item[1])


def part(test: Fitted, name: str) -> tuple[float, float] | None:
    """Return a cause as a part of the radius, and its deviation; None if it is not told."""
    k = test.index(name)
    if k is None:
        return None
    r = test.setup.radius
    return float(test.solution.value[k]) / r, math.sqrt(float(test.covariance[k, k])) / r


def mean(values: Floats, deviations: Floats) -> Told:
    """Return the weighted mean, its deviation scaled by how the values agree."""
    found = solve(np.ones((len(values), 1)), values, deviations)
    ratio = found.ratio
    scale = max(1.0, ratio) if math.isfinite(ratio) else 1.0
    return Told(float(found.value[0]), scale * math.sqrt(float(found.covariance[0, 0])), ratio)


def _equations(tests: Sequence[Fitted], calibrated: bool) -> Iterator[Equation]:
    for number, test in enumerate(tests):
        setup = test.setup
        first, second = PLANES[setup.plane]
        one, other = np.eye(4)[[first, second]]
        if found := part(test, "scale mismatch"):
            yield Equation(number, one - other, *found)
        found = part(test, "radius") if calibrated and setup.stated else None
        probed = not test.sense.any()
        if found and (probed or setup.feed is not None):
            feed = 0.0 if probed else setup.feed or 0.0
            lag = np.array([0.0, 0.0, 0.0, -((feed / setup.radius) ** 2) / 2.0])
            yield Equation(number, (one + other) / 2.0 + lag, *found, setup.radius)
