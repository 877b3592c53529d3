"""What 1 means in a number without a decimal point: increment systems, calculator input, lengths.

| system | mm | inch | deg | s |
|---|---|---|---|---|
| IS-A | 0.01 | 0.001 | 0.01 | |
| IS-B | 0.001 | 0.0001 | 0.001 | 0.001 |
| IS-C | 0.0001 | 0.00001 | 0.0001 | |
| IS-D | 0.00001 | 0.000001 | 0.00001 | |
| IS-E | 0.000001 | 0.0000001 | 0.000001 | |

B to E are printed so in the manual of Mitsubishi's M700 (least command increments), A is common
knowledge of Fanuc's. What a dwell without a point counts in other systems than IS-B hangs on one
more parameter of a Fanuc (1015#7), so it is not known. In calculator input 1 is 1 mm, inch, degree
or second. What is computed is rounded to the increment all the same.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import field
from typing import Final

from gcxform.config.quantities import ANGLE, LENGTH, ROTARY_AXES
from gcxform.values import dataclass

INCH: Final = float(LENGTH.worth["in"])  # mm
SYSTEMS: Final = ("IS-A", "IS-B", "IS-C", "IS-D", "IS-E")
CALCULATOR: Final = "calculator"
NEAR_WHOLE: Final = 1e-9  # of a count of increments: what a quotient of doubles may be off
INVERSE_TIME: Final = 1000.0
"""Steps of 1/min in an F of G93, in IS-B and IS-C alike (Fanuc 16/18 manual B-62764EN, 5.3)."""


@dataclass(frozen=True, slots=True)
class PointRule:
    """What numbers are worth, with a decimal point and without.

    required         a distance without a point counts in increments of the control, or in units:
                     a setting
    feed_required    an F without a point counts in a unit of the control, which must be configured;
                     one that is computed counts as one with a point
    feed_steps       steps in mm/min and inch/min of such an F, by the system in which it counts
    calculator_words words to which the control can be set to add a point where they have none
    dwell            seconds for one unit of each word that G4 takes
    dwell_in_seconds a dwell that is written with a point is in seconds
    """

    required: bool = False
    feed_required: bool = False
    feed_steps: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    calculator_words: str = "XYZUVWABCIJKRQF"
    dwell: Mapping[str, float] = field(default_factory=lambda: {"P": 1.0})
    dwell_in_seconds: bool = False

    def seconds(self, address: str, pointed: bool) -> float:
        """Return how long (s) a dwell of 1 is, with a point or without; 1 s for other words."""
        return 1.0 if pointed and self.dwell_in_seconds else self.dwell.get(address, 1.0)

    def waits_as(self, other: PointRule) -> bool:
        """Whether a dwell is as long under another rule, however it is written."""
        units = self.dwell == other.dwell and self.dwell_in_seconds == other.dwell_in_seconds
        return units and self.required == other.required


@dataclass(frozen=True, slots=True)
class Increments:
    """How many increments are 1 mm, 1 inch, 1 degree, 1 second; None: that is not known.

    `said` is how it was given; in calculator input a number without a point counts units, and
    increments are what computed numbers are rounded to.
    """

    said: str
    mm: float | None = None
    inch: float | None = None
    degree: float | None = None
    second: float | None = None
    calculator: bool = False

    @classmethod
    def of(cls, said: float | str) -> Increments:
        """Return what was given: a system, `calculator`, both, or a length, perhaps with an angle.

        A length is one of the machine: it is the same whatever unit is in force, and says nothing
        of angles. Raises ValueError with a sentence that follows the name of the option.
        """
        if not isinstance(said, str):
            return cls._of_sizes(f"{said:.12g} mm", float(said), None)
        words = said.split()
        systems = [word for word in words if word != CALCULATOR]
        if len(systems) == 1 and systems[0] in SYSTEMS and len(words) <= 2:
            return cls._of_system(" ".join(sorted(words, reverse=True)), systems[0])
        if words == [CALCULATOR]:
            return cls(CALCULATOR, calculator=True)
        length, _, angle = said.partition(",")
        try:
            sizes = LENGTH.parse(length, bare=True), ANGLE.parse(angle) if angle else None
        except ValueError as error:
            also = f"; also known are {', '.join(SYSTEMS)}, {CALCULATOR} and {CALCULATOR} IS-B"
            raise ValueError(f"{error}{also}") from None
        return cls._of_sizes(said, *sizes)

    @classmethod
    def _of_sizes(cls, said: str, length: float, angle: float | None) -> Increments:
        if not all(0 < size < math.inf for size in (length, angle or 1.0)):
            raise ValueError(f"{said!r} is no increment: that is more than 0")
        degree = None if angle is None else _whole(1 / angle)
        return cls(said, _whole(1 / length), _whole(INCH / length), degree)

    @classmethod
    def _of_system(cls, said: str, name: str) -> Increments:
        steps = 10.0 ** (2 + SYSTEMS.index(name))
        second = steps if name == "IS-B" else None
        return cls(said, steps, 10 * steps, steps, second, CALCULATOR in said)

    def per_unit(self, address: str, inch: bool) -> float | None:
        """Return how many increments of a distance word are 1 of its unit, None if not known."""
        if address in ROTARY_AXES:
            return self.degree
        return self.inch if inch else self.mm


COARSEST: Final = {False: 100.0, True: 1000.0}
"""Increments of 1 mm or degree, and of 1 inch, in IS-A, of which those of all others are parts."""


def coarse(value: float, address: str, inch: bool) -> float:
    """Return a distance that is the same in every system of a control; nan for another."""
    steps = COARSEST[inch and address not in ROTARY_AXES]
    count = value * steps
    near = math.isfinite(count) and abs(count - round(count)) < NEAR_WHOLE * max(abs(count), 1.0)
    return round(count) / steps if near else math.nan


def _whole(count: float) -> float:
    nearest = float(round(count))
    return nearest if abs(count - nearest) <= NEAR_WHOLE * count else count


def unit_of(address: str, inch: bool) -> tuple[str, str]:
    """Return what a distance word is, and its unit."""
    if address in ROTARY_AXES:
        return "an angle", "deg"
    return "a distance", "inch" if inch else "mm"


def readings(address: str, inch: bool) -> tuple[str, str]:
    """Return what a word of 1000 without a point is in IS-B, and in calculator input."""
    unit = unit_of(address, inch)[1]
    return f"{0.1 if unit == 'inch' else 1:g} {unit}", f"1000 {unit}"
