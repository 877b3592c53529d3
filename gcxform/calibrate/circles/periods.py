"""The pitch of cyclic errors, looked for in what a circle leaves of its causes.

For each axis and each period the two columns of a cyclic error are fitted together with all other
causes; how much they take of the sum of squares is the periodogram (Lomb, Astrophys. Space Sci. 39
(1976) 447, generalised by whatever else is fitted: Zechmeister and Kuerster, A&A 496 (2009) 577).
The largest of it is a pitch only if noise alone would hardly have one as large *anywhere* that was
looked. A bound of that is W sqrt(z) times what holds at one place, with z the logarithm of the one
in that, and W the width of the frequencies times sqrt(4 pi var p) (Baluev, MNRAS 385 (2008) 1279);
p = r cos t, with the weight cos^2 t that the columns have, has the variance 3 r^2 / 4. What is left
when the period is taken out says how many of the readings count, for neighbours may be alike.

Periods are looked for of which six stand in a diameter, because a few look like bows, down to those
that readings follow: two and a half of them in a period, where the axis is fastest.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Final, NamedTuple

import numpy as np

from gcxform.calibrate.circles.causes import SetUp, turning
from gcxform.calibrate.solution import SELDOM
from gcxform.system.arrays import Flags, Floats

FEWEST: Final = 6.0  # periods in a diameter
FOLLOWED: Final = 2.5  # readings in a period
OVER: Final = 8  # frequencies looked at for each that is told from its neighbours
FINER: Final = 40  # and of each of those, about the best


class Period(NamedTuple):
    """A cyclic error that was found: its axis, its pitch in mm, and how often noise has such."""

    letter: str
    pitch: float
    chance: float


class Looked(NamedTuple):
    """What was found, and between which pitches (mm) it was looked for."""

    found: tuple[Period, ...]
    shortest: float
    longest: float

    @property
    def pitches(self) -> Mapping[str, float]:
        """The pitches by axis, mm."""
        return {period.letter: period.pitch for period in self.found}


def periods(setup: SetUp, degrees: Floats, readings: Floats, base: Floats, starts: Flags) -> Looked:
    """Return the cyclic errors of readings (n,) in mm at angles (n,) in degrees, one for each axis.

    `base` (n, k) are the columns of all other causes; `starts` (n,) is where a reading has no
    neighbour before it.
    """
    step = float(np.median(np.diff(np.unique(np.round(degrees, 6)))))
    shortest = FOLLOWED * setup.radius * math.radians(step)
    longest = 2.0 * setup.radius / FEWEST
    found: list[Period] = []
    letters = list(setup.letters)
    while letters and shortest < longest:
        span = np.array([1.0 / longest, 1.0 / shortest])
        best = max(
            (_best(setup, degrees, readings, base, letter, span) for letter in letters),
            key=lambda item: item[2],
        )
        letter, pitch, _ = best
        columns = np.column_stack(turning(setup, degrees, letter, pitch))
        whole = np.column_stack([base, columns])
        width = len(letters) * math.sqrt(3.0 * math.pi) * setup.radius * float(np.ptp(span))
        chance = _chance(readings, base, whole, starts, width)
        if chance > SELDOM:
            break
        found.append(Period(letter, pitch, chance))
        letters.remove(letter)
        base = whole
    return Looked(tuple(found), shortest, longest)


def _best(
    setup: SetUp, degrees: Floats, readings: Floats, base: Floats, letter: str, span: Floats
) -> tuple[str, float, float]:
    """Return an axis, the pitch that takes most of its readings (mm), and how much that is."""
    orthogonal = np.linalg.qr(base)[0]
    left = readings - orthogonal @ (orthogonal.T @ readings)
    width = 1.0 / (2.0 * OVER * setup.radius)
    low, high = span.tolist()
    for fine in (1.0, FINER):
        at = np.arange(low, high, width / fine)
        power = np.array([_power(setup, degrees, left, orthogonal, letter, f) for f in at.tolist()])
        best = float(at[power.argmax()])
        low, high = max(span[0], best - width), min(span[1], best + width)
    return letter, 1.0 / best, float(power.max())


def _power(
    setup: SetUp, degrees: Floats, left: Floats, orthogonal: Floats, letter: str, frequency: float
) -> float:
    """Return what a period takes of the sum of squares of what is left, mm^2."""
    columns = np.column_stack(turning(setup, degrees, letter, 1.0 / frequency))
    columns -= orthogonal @ (orthogonal.T @ columns)
    (aa, ab), (_, bb) = columns.T @ columns
    a, b = columns.T @ left
    size = aa * bb - ab * ab
    return float((bb * a * a - 2.0 * ab * a * b + aa * b * b) / size) if size > 1e-9 else 0.0


def _chance(readings: Floats, base: Floats, whole: Floats, starts: Flags, width: float) -> float:
    """Return how often noise takes as much, at most: F of 2 and n at one place, and in a width."""
    before, after = _left(base, readings), _left(whole, readings)
    square = float(after @ after)
    if square == 0.0:
        return 0.0
    pairs = float((after[1:] * after[:-1])[~starts[1:]].sum())
    alike = min(max(pairs / square, 0.0), 0.999)
    freedom = (len(readings) - whole.shape[1]) * (1.0 - alike) / (1.0 + alike)
    taken = (float(before @ before) - square) / square
    z = 0.5 * max(freedom, 0.0) * math.log1p(taken)
    return min(1.0, (1.0 + width * math.sqrt(z)) * math.exp(-z))


def _left(matrix: Floats, readings: Floats) -> Floats:
    orthogonal = np.linalg.qr(matrix)[0]
    return np.asarray(readings - orthogonal @ (orthogonal.T @ readings))
