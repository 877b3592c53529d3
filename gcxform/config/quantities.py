"""Lengths and angles: what a number with a unit is worth, and which axes have which.

Lengths are mm and angles degrees; files and options may write them as strings with a unit
(`"5 um"`, `"80 urad"`), which `LENGTH` and `ANGLE` read.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from decimal import Decimal

from gcxform.values import dataclass

LINEAR_AXES = tuple("XYZUVW")
ROTARY_AXES = tuple("ABC")
AXIS_LETTERS = LINEAR_AXES + ROTARY_AXES

_NUMBER = r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
_QUANTITY = re.compile(rf"\s*({_NUMBER})\s*(.*?)\s*")
_DEGREES = Decimal("57.29577951308232087679815481410517033240547246656")  # of a radian


@dataclass(frozen=True)
class Quantity:
    """A physical quantity: its name, its unit inside gcxform, and what other units are worth."""

    name: str
    base: str
    worth: Mapping[str, Decimal]
    example: str

    def parse(self, text: str, bare: bool = False) -> float:
        """Return a string with a unit, in the base unit; `bare` allows a number alone.

        Raises ValueError with a sentence that follows the name of what is read.
        """
        found = _QUANTITY.fullmatch(text)
        if found is None:
            raise ValueError(f"{text!r} is not {self.article}, such as {self.example}")
        number, unit = found.groups()
        if not unit and not bare:
            raise ValueError(
                f'{text!r} has no unit: write "{number} {self.base}", or {number} without quotes'
            )
        if unit and unit not in self.worth:
            known = ", ".join(name for name in self.worth if name.isascii())
            raise ValueError(f"{unit!r} is not a unit of {self.article}; units are {known}")
        if not math.isfinite(float(number)):
            raise ValueError(f"{number} is too large")
        # Decimal, so that "7 um" is the double nearest to 0.007
        return float(Decimal(number) * self.worth[unit or self.base])

    def of(self, text: str) -> float | None:
        """Return a string with or without a unit, in the base unit; None where it is none."""
        try:
            return self.parse(text, bare=True)
        except ValueError:
            return None

    def pattern(self, bare: bool = False) -> str:
        """Return the regular expression of what `parse` takes, as a JSON Schema has it."""
        units = "|".join(self.worth)
        return rf"\s*{_NUMBER}\s*({units}){'?' * bare}\s*"

    @property
    def article(self) -> str:
        """The name with its article."""
        return f"a{'n' * (self.name[0] in 'aeio')} {self.name}"


_MICRO = dict.fromkeys(("um", "\N{MICRO SIGN}m", "\N{GREEK SMALL LETTER MU}m"), Decimal("0.001"))
LENGTH = Quantity(
    "length",
    "mm",
    {"mm": Decimal(1), **_MICRO, "m": Decimal(1000), "in": Decimal("25.4")},
    '"5 um", "0.2 mm" or 0.2',
)
ANGLE = Quantity(
    "angle",
    "deg",
    {"deg": Decimal(1), "rad": _DEGREES, "mrad": _DEGREES / 1000, "urad": _DEGREES / 1_000_000},
    '"10 deg", "80 urad" or 10',
)


def quantity_of(axis: str) -> Quantity:
    """Return what the coordinate of an axis is: a length, or an angle for A, B and C."""
    return ANGLE if axis in ROTARY_AXES else LENGTH
