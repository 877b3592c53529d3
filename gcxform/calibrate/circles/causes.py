"""What makes a circle not a circle, to the first order: a column of deviations for each cause.

A circle of the radius r goes in the plane of a first and a second axis; t is the angle from the
first towards the second, d is +1 where it is travelled so (CCW) and -1 the other way. A reading is
actual less nominal radius, ex cos t + ey sin t, with the errors e of both axes:

    centre             - cx cos t - cy sin t                  the pivot is off by (cx, cy)
    scale mismatch     r (s1 - s2) cos 2t / 2                 s1 + s2 is in the radius alone
    squareness         - r Q sin 2t / 2                       Q > 0: more than 90 degrees
    servo mismatch     d v (T1 - T2) sin 2t / 2               the first axis lags by v T1
    backlash           d B sgn(sin t) cos t / 2               of the first axis
                       - d B sgn(cos t) sin t / 2             of the second
    lateral play       d L |sin t| / 2, - d L |cos t| / 2     the other axis jumps at a reversal
    straightness       S cos^2 t sin t, S sin^2 t cos t       bow over the diameter
    cyclic error       (a cos u + b sin u) cos t              u = 2 pi position / pitch

Backlash where its axis turns back at both ends of the arc has a value for each end, and varies
evenly between. Every cause has its size in mm as its unknown, so that columns are alike; `per`
makes of it what the trade quotes. Servo mismatch and squareness have the same column where there is
one sense alone, and in readings of a probe that stood still (d = 0) causes with d have none.

A spike is the axis that sticks for a moment behind its reversal. It is no column: readings within
some degrees behind a reversal are left out of the fit, and what they are off it is the spike.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import Final, NamedTuple

import numpy as np

from gcxform.errormodel.model import AXES
from gcxform.machine.chain import Triple
from gcxform.system.arrays import Flags, Floats, Ints
from gcxform.values import dataclass

PLANES: Final[Mapping[str, tuple[int, int]]] = {"XY": (0, 1), "YZ": (1, 2), "ZX": (2, 0)}
"""The axes of a plane, first and second: angles are from the first towards the second."""
WHOLE: Final = 300.0  # degrees of arc from which on all causes are told apart
HALF: Final = 180.0  # degrees of arc below which squareness, scale and servo mismatch are not
BESIDE: Final = 5.0  # degrees: readings on both sides of a reversal are so near, or do not show it
BEHIND: Final = 3.0  # degrees behind a reversal in which a spike is looked for


@dataclass(frozen=True)
class SetUp:
    """A circular test: its plane, the radius in mm, and what is known besides.

    `feed` is in mm/s, `centre` in mm in the machine, and `name` tells tests of one set-up apart.
    The radius is `stated`, or else that of the readings themselves.
    """

    plane: str
    radius: float
    feed: float | None = None
    centre: Triple | None = None
    name: str = ""
    stated: bool = True

    @property
    def letters(self) -> tuple[str, str]:
        """The letters of its axes."""
        first, second = PLANES[self.plane]
        return AXES[first], AXES[second]

    def offset(self, axis: int) -> float:
        """Return where the middle of the circle is on an axis, 0 if that is not known."""
        return self.centre[PLANES[self.plane][axis]] if self.centre else 0.0


class Cause(NamedTuple):
    """A column (n,) of radial deviation in mm for each mm of `size`; `group` it belongs to."""

    name: str
    group: str
    unit: str
    per: float
    column: Floats


class End(NamedTuple):
    """Where an axis (0 or 1 of the plane) turns back, in degrees; `name` is +X, -X and so on."""

    name: str
    axis: int
    degrees: float


def ends(setup: SetUp) -> tuple[End, ...]:
    """Return the four places of a circle where one of its axes turns back."""
    first, second = setup.letters
    return (
        End(f"+{first}", 0, 0.0),
        End(f"+{second}", 1, 90.0),
        End(f"-{first}", 0, 180.0),
        End(f"-{second}", 1, 270.0),
    )


def beyond(degrees: Floats, sense: Floats | Ints, end: End) -> Floats:
    """Return how far behind an end readings (n,) are in the direction of travel, -180 to 180."""
    return np.asarray((sense * (degrees - end.degrees) + 180.0) % 360.0 - 180.0)


def near_spikes(degrees: Floats, sense: Ints, setup: SetUp, behind: float) -> Flags:
    """Return which readings (n,) may be on a spike."""
    found = np.zeros(len(degrees), dtype=bool)
    for end in ends(setup):
        way = beyond(degrees, sense, end)
        found |= (sense != 0) & (way >= 0.0) & (way < behind)
    return found


def turned_within(degrees: Floats, sense: Ints, end: End) -> bool:
    """Return whether readings on both sides show what an axis does where it turns back."""
    way = beyond(degrees, np.ones(len(degrees)), end)[sense != 0]
    before, after = (way < 0.0) & (way > -BESIDE), (way > 0.0) & (way < BESIDE)
    return bool(before.any() and after.any())


def causes(
    setup: SetUp,
    degrees: Floats,
    sense: Ints,
    arc: float,
    pitches: Mapping[str, float] = MappingProxyType({}),
) -> list[Cause]:
    """Return the causes that readings (n,) over an arc (degrees) may tell, with their columns.

    `pitches` in mm are those of cyclic errors, by axis; none is looked for without.
    """
    found = list(_circle(degrees))
    if arc >= HALF:
        found += _shape(setup, degrees, sense)
    found += _backlash(setup, degrees, sense)
    if arc >= HALF:
        found += _play(setup, degrees, sense)
    if arc >= WHOLE:
        found += _straightness(setup, degrees)
        found += _cyclic(setup, degrees, pitches)
    return [cause for cause in found if cause.column.any()]


def _circle(degrees: Floats) -> Iterator[Cause]:
    t = np.radians(degrees)
    yield Cause("radius", "radius", "um", 1e3, np.ones(len(t)))
    yield Cause("centre 1", "centre", "um", 1e3, -np.cos(t))
    yield Cause("centre 2", "centre", "um", 1e3, -np.sin(t))


def _shape(setup: SetUp, degrees: Floats, sense: Ints) -> Iterator[Cause]:
    twice = 2.0 * np.radians(degrees)
    part = 1.0 / setup.radius
    yield Cause("scale mismatch", "scale mismatch", "ppm", 1e6 * part, 0.5 * np.cos(twice))
    yield Cause("squareness", "squareness", "urad", 1e6 * part, -0.5 * np.sin(twice))
    per, unit = (1e3 / setup.feed, "ms") if setup.feed else (1e3, "um")
    yield Cause("servo mismatch", "servo mismatch", unit, per, 0.5 * np.sin(twice) * sense)


def _backlash(setup: SetUp, degrees: Floats, sense: Ints) -> Iterator[Cause]:
    t = np.radians(degrees)
    cosine, sine = np.cos(t), np.sin(t)
    columns = sense * np.sign(sine) * cosine / 2.0, -sense * np.sign(cosine) * sine / 2.0
    for axis, (letter, along) in enumerate(zip(setup.letters, (cosine, sine), strict=True)):
        group = f"backlash {letter}"
        own = [end for end in ends(setup) if end.axis == axis]
        if all(turned_within(degrees, sense, end) for end in own):
            for end, side in zip(own, (1.0, -1.0), strict=True):
                weight = np.asarray((1.0 + side * along) / 2.0, np.float64)
                name = f"{group} at {end.name}"
                yield Cause(name, group, "um", 1e3, weight * columns[axis])
        else:
            yield Cause(group, group, "um", 1e3, columns[axis])


def _play(setup: SetUp, degrees: Floats, sense: Ints) -> Iterator[Cause]:
    t = np.radians(degrees)
    columns = sense * np.abs(np.sin(t)) / 2.0, -sense * np.abs(np.cos(t)) / 2.0
    for letter, column in zip(setup.letters, columns, strict=True):
        name = f"lateral play {letter}"
        yield Cause(name, name, "um", 1e3, column)


def _straightness(setup: SetUp, degrees: Floats) -> Iterator[Cause]:
    t = np.radians(degrees)
    columns = np.cos(t) ** 2 * np.sin(t), np.sin(t) ** 2 * np.cos(t)
    for letter, column in zip(setup.letters, columns, strict=True):
        name = f"straightness {letter}"
        yield Cause(name, name, "um", 1e3, column)


def _cyclic(setup: SetUp, degrees: Floats, pitches: Mapping[str, float]) -> Iterator[Cause]:
    for letter in (letter for letter in setup.letters if letter in pitches):
        group = f"cyclic error {letter}"
        columns = turning(setup, degrees, letter, pitches[letter])
        for name, column in zip(("cosine", "sine"), columns, strict=True):
            yield Cause(f"{group} {name}", group, "um", 1e3, column)


def turning(setup: SetUp, degrees: Floats, letter: str, pitch: float) -> tuple[Floats, Floats]:
    """Return the two columns (n,) of a cyclic error of an axis with a pitch in mm."""
    t = np.radians(degrees)
    axis = setup.letters.index(letter)
    along = np.cos(t) if axis == 0 else np.sin(t)
    u = 2.0 * np.pi * (setup.radius * along + setup.offset(axis)) / pitch
    return np.asarray(np.cos(u) * along), np.asarray(np.sin(u) * along)
