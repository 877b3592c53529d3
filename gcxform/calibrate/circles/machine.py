"""From circular tests in several planes to the machine: squareness and scales, and their model.

Each test tells the angle between its axes and the difference of their scales; both hold for all
tests of a plane, and the differences of three planes must close. The scales themselves are in
`scales.py`.

A model by position holds squareness, scales, and bows of the axes if they are asked for
(`bows.py`), and no more: backlash, servo mismatch and spikes depend on direction and feed, and stay
in the report.
"""

from __future__ import annotations

from functools import cached_property
from typing import Final

import numpy as np

from gcxform.calibrate.circles.bows import NODES, Bow, bows
from gcxform.calibrate.circles.causes import HALF, PLANES
from gcxform.calibrate.circles.circles import Fitted
from gcxform.calibrate.circles.scales import NONE, RADIUS_NOISE, Scales, Told, mean, part
from gcxform.calibrate.rotary.axis import REJECTED
from gcxform.diagnostics import InputError
from gcxform.errormodel.functions import AxisFunction, AxisFunctions
from gcxform.errormodel.linear import Linear
from gcxform.errormodel.model import AXES, ErrorModel, check_contraction
from gcxform.system.arrays import Floats
from gcxform.values import dataclass

ANGLES: Final = {"XY": ("C0Y", 1.0), "YZ": ("A0Z", 1.0), "ZX": ("B0Z", -1.0)}
"""The squareness of a plane by ISO 230-1, and its sign where the angle is more than 90 degrees."""
SLOPES: Final = {"C0Y": (0, 1, -1.0), "A0Z": (1, 2, -1.0), "B0Z": (0, 2, 1.0)}
"""Of each squareness: the error of which axis it is, along which, and its sign."""


@dataclass(frozen=True, eq=False)
class Identified:
    """What circular tests tell of a machine; `scale_from` is an axis, `bar` or `none`.

    `radius_noise` in mm is the standard deviation of the radius of a bar, or a ring; the model has
    bows of the axes if they are `bent`, and their pitches taken to be even.
    """

    tests: tuple[Fitted, ...]
    scale_from: str = NONE
    radius_noise: float = RADIUS_NOISE
    bent: bool = False

    @cached_property
    def squareness(self) -> dict[str, Told]:
        """The squareness by its names (rad), of the planes that tell it."""
        found = {}
        for plane, (name, sign) in ANGLES.items():
            own = [test for test in self.tests if test.setup.plane == plane]
            values = [value for test in own if (value := part(test, "squareness"))]
            if values:
                value, deviation = np.array(values).T
                found[name] = mean(sign * value, deviation)
        return found

    @cached_property
    def mismatches(self) -> dict[str, Told]:
        """The scale of the first axis of a plane less that of the second, by plane."""
        found = {}
        for plane in PLANES:
            own = [test for test in self.tests if test.setup.plane == plane]
            values = [value for test in own if (value := part(test, "scale mismatch"))]
            if values:
                found[plane] = mean(*np.array(values).T)
        return found

    @cached_property
    def network(self) -> Scales:
        """The scales of the axes, and what they rest on."""
        return Scales(self.tests, self.scale_from, self.radius_noise)

    @property
    def scales(self) -> dict[str, Told]:
        """The scale errors of the axes that are told, mm per mm; none are asked for with `none`."""
        return self.network.told

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

    @cached_property
    def bows(self) -> list[Bow]:
        """The bows that the model has. Raises InputError (GX476) where one is not told."""
        return bows(self.tests) if self.bent else []

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
        """Return the model with squareness, scales and bows: what was not measured is 0 in it.

        It ends where the circles did, unless it is not `limited`; bows have no other end. Raises
        InputError: no squareness is told, or a scale or bow that is asked for is not (GX476),
        centres are not known (GX478), radii cannot be right (GX475).
        """
        self._check()
        matrix, middle = self.slopes(), np.zeros(3)
        for axis, span in self.volume.items():
            middle[axis] = sum(span) / 2.0
        if not limited and not self.bows:
            model: ErrorModel = Linear(matrix, middle)
        else:
            x, y, z = (self._function(k, matrix, middle) for k in range(3))
            model = AxisFunctions((x, y, z))
        check_contraction(model)
        return model

    def _function(self, axis: int, matrix: Floats, middle: Floats) -> AxisFunction | None:
        if axis not in self.volume:
            return None
        own = [bow for bow in self.bows if bow.along == axis]
        position = np.linspace(*self.volume[axis], NODES if own else 2)
        values = np.outer(position - middle[axis], matrix[:, axis]) + 0.0
        for bow in own:
            values[:, bow.into] += bow.across(position)
        return AxisFunction(position, values)

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
                "a calibrated bar tells it at two feeds, a ring that was probed at once, if its "
                "radius is said (--radius); or leave the scales out (--scale-from none)",
            )
        if self.network.doubt is not None:
            number, message = self.network.doubt
            raise InputError.one(
                "GX475",
                message,
                self.tests[number].where,
                "look at the radii (--radius); if they are right, say how well they are known "
                "(--radius-noise), or leave the scales out (--scale-from none)",
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
