"""From circular tests in several planes to the machine: squareness and scales, and their model.

Each test tells the angle between its axes and the difference of their scales; both hold for all
tests of a plane, and the differences of three planes must close. The scale itself is in the radius,
if the bar is calibrated, together with what the axes lag behind: r (s1 + s2) / 2 - (v T)^2 / (2 r).
So it is told by circles at two feeds, or by a ring that was probed at rest; else one axis must be
taken to be right.

A model by position holds squareness and scales and no more: backlash, servo mismatch and spikes
depend on direction and feed, and stay in the report.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from gcxform.calibrate.circles.causes import HALF, PLANES
from gcxform.calibrate.circles.circles import Fitted
from gcxform.calibrate.rotary.axis import REJECTED
from gcxform.calibrate.solution import Solution, solve
from gcxform.diagnostics import InputError
from gcxform.errormodel.functions import AxisFunction, AxisFunctions
from gcxform.errormodel.linear import Linear
from gcxform.errormodel.model import AXES, ErrorModel, check_contraction
from gcxform.system.arrays import Floats

ANGLES: Final = {"XY": ("C0Y", 1.0), "YZ": ("A0Z", 1.0), "ZX": ("B0Z", -1.0)}
"""The squareness of a plane by ISO 230-1, and its sign where the angle is more than 90 degrees."""
SLOPES: Final = {"C0Y": (0, 1, -1.0), "A0Z": (1, 2, -1.0), "B0Z": (0, 2, 1.0)}
"""Of each squareness: the error of which axis it is, along which, and its sign."""
BAR: Final = "bar"
NONE: Final = "none"


@dataclass(frozen=True)
class Told:
    """A value and its standard deviation; `agree` is how tests of it agree, times their own."""

    value: float
    deviation: float
    agree: float = math.nan


@dataclass(frozen=True, eq=False)
class Identified:
    """What circular tests tell of a machine; `scale_from` is an axis, `bar` or `none`."""

    tests: tuple[Fitted, ...]
    scale_from: str = NONE

    @cached_property
    def squareness(self) -> dict[str, Told]:
        """The squareness by its names (rad), of the planes that tell it."""
        found = {}
        for plane, (name, sign) in ANGLES.items():
            own = [test for test in self.tests if test.setup.plane == plane]
            values = [value for test in own if (value := _part(test, "squareness"))]
            if values:
                value, deviation = np.array(values).T
                found[name] = _mean(sign * value, deviation)
        return found

    @cached_property
    def mismatches(self) -> dict[str, Told]:
        """The scale of the first axis of a plane less that of the second, by plane."""
        found = {}
        for plane in PLANES:
            own = [test for test in self.tests if test.setup.plane == plane]
            values = [value for test in own if (value := _part(test, "scale mismatch"))]
            if values:
                found[plane] = _mean(*np.array(values).T)
        return found

    @cached_property
    def network(self) -> Solution:
        """The scales (3,) of the axes, and T^2 in s^2 of what they lag behind.

        What no circle tells is free, and what is asked of it is refused by `scales`.
        """
        rows, values, deviations = _scale_rows(self.tests, self.scale_from == BAR)
        if self.scale_from in AXES:
            rows.append(np.append(np.eye(3)[AXES.index(self.scale_from)], 0.0))
            values.append(0.0)
            deviations.append(1e-9)
        if not rows:
            rows, values, deviations = [np.zeros(4)], [0.0], [1.0]
        return solve(np.array(rows), np.array(values), np.array(deviations))

    @cached_property
    def scales(self) -> dict[str, Told]:
        """The scale errors of the axes that are told, mm per mm; none are asked for with `none`."""
        if self.scale_from == NONE:
            return {}
        told = np.asarray(~(np.abs(self.network.free) > 1e-6).any(axis=1))
        ratio = self.network.ratio
        scale = max(1.0, ratio) if math.isfinite(ratio) else 1.0
        return {
            letter: Told(
                float(self.network.value[k]),
                scale * math.sqrt(max(0.0, float(self.network.covariance[k, k]))),
                ratio,
            )
            for k, letter in enumerate(AXES)
            if told[k] and letter != self.scale_from
        }

    @property
    def axes(self) -> tuple[int, ...]:
        """The axes that go in any of the tests."""
        return tuple(sorted({axis for test in self.tests for axis in PLANES[test.setup.plane]}))

    @cached_property
    def volume(self) -> dict[int, tuple[float, float]]:
        """Where the circles were, of each axis the lowest and highest position, mm."""
        found: dict[int, tuple[float, float]] = {}
        for test in self.tests:
            for place, axis in enumerate(PLANES[test.setup.plane]):
                middle = test.setup.offset(place)
                low, high = middle - test.setup.radius, middle + test.setup.radius
                before = found.get(axis, (low, high))
                found[axis] = min(low, before[0]), max(high, before[1])
        return found

    def slopes(self) -> Floats:
        """Return the matrix (3, 3) of the errors: E = matrix @ position, mm per mm."""
        matrix = np.zeros((3, 3))
        for name, told in self.squareness.items():
            into, along, sign = SLOPES[name]
            matrix[into, along] = sign * told.value
        for letter, told in self.scales.items():
            k = AXES.index(letter)
            matrix[k, k] = told.value
        return matrix

    def model(self, limited: bool = True) -> ErrorModel:
        """Return the model with squareness and scales: what was not measured is 0 in it.

        It ends where the circles did, unless it is not `limited`. Raises InputError: no squareness
        is told, or a scale that is asked for is not (GX476), centres are not known (GX478).
        """
        self._check()
        matrix, middle = self.slopes(), np.zeros(3)
        for axis, span in self.volume.items():
            middle[axis] = sum(span) / 2.0
        if not limited:
            model: ErrorModel = Linear(matrix, middle)
        else:
            x, y, z = (self._function(k, matrix, middle) for k in range(3))
            model = AxisFunctions((x, y, z))
        check_contraction(model)
        return model

    def _function(self, axis: int, matrix: Floats, middle: Floats) -> AxisFunction | None:
        if axis not in self.volume:
            return None
        position = np.array(self.volume[axis])
        return AxisFunction(position, np.outer(position - middle[axis], matrix[:, axis]) + 0.0)

    def _check(self) -> None:
        """Raise InputError unless what is asked for can be written."""
        for test in self.tests:
            _check_told(test)
            if test.setup.centre is None:
                raise InputError.one(
                    "GX478",
                    f"where the circle in {test.setup.plane} was is not known",
                    test.where,
                    "say it: --centre X,Y,Z in machine coordinates, or columns centre X [mm] ...",
                )
        asked = set(self.axes) if self.scale_from != NONE else set()
        lacking = [AXES[k] for k in sorted(asked) if AXES[k] not in (*self.scales, self.scale_from)]
        if lacking:
            raise InputError.one(
                "GX476",
                f"the circles do not tell the scale of {', '.join(lacking)} from {self.scale_from}",
                self.tests[0].where,
                "a calibrated bar tells it at two feeds, a ring that was probed at once; or leave "
                "the scales out (--scale-from none)",
            )


def _check_told(test: Fitted) -> None:
    """Raise InputError for a test that does not tell its squareness, or is off its fit."""
    if test.index("squareness") is None:
        hint = "measure along a longer arc: 180 degrees at least, in both senses"
        if test.arc >= HALF:
            hint = "measure the circle in the other sense as well, and give both"
            hint = hint if test.one_sense else "take more readings, all around the circle"
        message = (
            f"the test in {test.setup.plane} does not tell squareness from servo mismatch"
            if test.arc >= HALF
            else f"an arc of {test.arc:.4g} degrees does not tell squareness"
        )
        raise InputError.one("GX476", message, test.where, hint)
    if test.scatter.ratio > REJECTED:
        worst = int(np.where(test.used, np.abs(test.residuals), 0.0).argmax())
        raise InputError.one(
            "GX475",
            f"the test in {test.setup.plane} is off its causes by {1e3 * test.scatter.observed:.3g}"
            f" um rms, more than {REJECTED:g} times the noise of {1e3 * test.asked.noise:.3g} um",
            test.place(worst),
            "the worst is marked; look at units, angles and senses, or state the noise there is "
            "(--noise)",
        )


def _part(test: Fitted, name: str) -> tuple[float, float] | None:
    """Return a cause as a part of the radius, and its deviation; None if it is not told."""
    k = test.index(name)
    if k is None:
        return None
    r = test.setup.radius
    return float(test.solution.value[k]) / r, math.sqrt(float(test.covariance[k, k])) / r


def _mean(values: Floats, deviations: Floats) -> Told:
    """Return the weighted mean, its deviation scaled by how the values agree."""
    found = solve(np.ones((len(values), 1)), values, deviations)
    ratio = found.ratio
    scale = max(1.0, ratio) if math.isfinite(ratio) else 1.0
    return Told(float(found.value[0]), scale * math.sqrt(float(found.covariance[0, 0])), ratio)


def _scale_rows(
    tests: Sequence[Fitted], calibrated: bool
) -> tuple[list[Floats], list[float], list[float]]:
    """Return the equations of the scales: differences and, of a calibrated bar, radii."""
    rows, values, deviations = [], [], []
    for row, value, deviation in _equations(tests, calibrated):
        rows.append(row)
        values.append(value)
        deviations.append(deviation)
    return rows, values, deviations


def _equations(tests: Sequence[Fitted], calibrated: bool) -> Iterator[tuple[Floats, float, float]]:
    for test in tests:
        first, second = PLANES[test.setup.plane]
        one, other = np.eye(4)[[first, second]]
        if part := _part(test, "scale mismatch"):
            yield one - other, *part
        part = _part(test, "radius") if calibrated else None
        probed = not test.sense.any()
        if part and (probed or test.setup.feed is not None):
            feed = 0.0 if probed else test.setup.feed or 0.0
            lag = np.array([0.0, 0.0, 0.0, -((feed / test.setup.radius) ** 2) / 2.0])
            yield (one + other) / 2.0 + lag, *part
