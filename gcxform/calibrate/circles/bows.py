"""The straightness of axes by circular tests: a bow in each direction of a plane.

A bow of the first axis, the second being off by S (x / r)^2, moves the radius by S cos^2 t sin t. A
screw of which the pitch grows along the second axis, off along itself by P (y / r)^2, moves it by
P sin^3 t, and besides what the pivot takes up that is the same reading:

    4 cos^2 t sin t = sin t + sin 3t        4 sin^3 t = 3 sin t - sin 3t

So no circle tells one from the other. Bows are put into a model only if it is said that pitches are
even; then both signs and sizes are known.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from gcxform.calibrate.circles.causes import PLANES
from gcxform.calibrate.circles.circles import Fitted
from gcxform.calibrate.circles.scales import Told, mean
from gcxform.diagnostics import InputError
from gcxform.errormodel.model import AXES
from gcxform.system.arrays import Floats
from gcxform.values import dataclass

NODES: Final = 33
"""Of a bow: lines between them leave a thousandth of it ((1 / 16)^2 / 8 is half of that)."""
SAME: Final = 1e-3  # of the radius: circles whose spans differ by more stand at different places


class Span(NamedTuple):
    """Where an axis goes in a circle, mm."""

    middle: float
    half: float


@dataclass(frozen=True)
class Bow:
    """What an axis is off across: `told` over the half span, mm, 0 in its middle."""

    into: int
    along: int
    told: Told
    span: Span

    @property
    def name(self) -> str:
        """EYX is the error of Y along X."""
        return f"E{AXES[self.into]}{AXES[self.along]}"

    def across(self, position: Floats) -> Floats:
        """Return the error (n,) at positions (n,), mm."""
        return np.asarray(self.told.value * ((position - self.span.middle) / self.span.half) ** 2)


def span_of(test: Fitted, place: int) -> Span:
    """Return where the first or second axis of a test goes."""
    return Span(test.setup.offset(place), test.setup.radius)


def bows(tests: Sequence[Fitted]) -> list[Bow]:
    """Return the bows of all axes that tests have, two for each plane.

    Raises InputError (GX476) where one is not told, or the circles that tell it, or others in which
    the axis goes, stand at different places: what a bow is beyond its circle is not known.
    """
    found = []
    for plane, axes in PLANES.items():
        own = [test for test in tests if test.setup.plane == plane]
        for place in (0, 1) if own else ():
            into, along = axes[1 - place], axes[place]
            span = _span(tests, along)
            found.append(
                Bow(into, along, mean(*np.array([_told(test, place) for test in own]).T), span)
            )
    return found


def _span(tests: Sequence[Fitted], axis: int) -> Span:
    """Return where an axis goes in all tests."""
    found: list[Span] = []
    for test in tests:
        axes = PLANES[test.setup.plane]
        if axis not in axes:
            continue
        span = span_of(test, axes.index(axis))
        first = found[0] if found else span
        if max(abs(a - b) for a, b in zip(span, first, strict=True)) > SAME * first.half:
            raise InputError.one(
                "GX476",
                f"the circles in which {AXES[axis]} goes stand at different places: its "
                "straightness is not put together from them",
                test.where,
                "give the circles of one place and radius, or leave straightness out "
                "(--straightness report)",
            )
        found.append(span)
    return found[0]


def _told(test: Fitted, place: int) -> tuple[float, float]:
    """Return a bow of a test and its deviation, mm."""
    letter = test.setup.letters[place]
    k = test.index(f"straightness {letter}")
    if k is None:
        raise InputError.one(
            "GX476",
            f"the test in {test.setup.plane} does not tell the straightness of {letter}",
            test.where,
            "measure the whole circle, or leave straightness out (--straightness report)",
        )
    return float(test.solution.value[k]), math.sqrt(float(test.covariance[k, k]))
