"""Drilling cycles of a SINUMERIK as plain moves, and calls that move nothing."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal

import gcxform as gx

CALLED = re.compile(r"([A-Z_]\w*)[ \t]*\((.*)\)", re.IGNORECASE | re.DOTALL)
PARTS = re.compile(r'"[^"]*"|[^,"]+|,')
NUMBER = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)")
SECONDS = "10"
"""The last argument of drilling cycles where dwells are in seconds, and depths as ever."""
QUALITY = re.compile(r"_?(?:ORI_)?(?:OFF|FINISH|SEMIFIN|ROUGH)")
NO_RETRACT, PLAIN_MODE = "0", re.compile(r"[0-9]*")


def arguments(call: gx.Item) -> tuple[str, list[str]]:
    """Return the name of what is called, and its arguments without blanks."""
    found = CALLED.fullmatch(call.name)
    assert found is not None
    parts = [""]
    for part in PARTS.findall(found[2]):
        if part == ",":
            parts.append("")
        else:
            parts[-1] += part.strip()
    return found[1], parts


@dataclass(frozen=True, slots=True)
class Drilling:
    """A hole along the axis across the plane: levels and a dwell (s), as blocks have them."""

    axis: str
    start: str
    bottom: str
    back: str
    dwell: str = ""

    def steps(self) -> list[tuple[str, str]]:
        """Return codes and levels at a place: rapid to the start, feed to the bottom, rapid back.

        Code 4 is a dwell, of seconds.
        """
        wait = [("4", self.dwell)] if self.dwell else []
        return [("0", self.start), ("1", self.bottom), *wait, ("0", self.back)]


class CycleError(Exception):
    """Arguments that are not understood."""


def drilling(name: str, given: Sequence[str], axis: str) -> Drilling:
    """Return the hole of CYCLE81 or CYCLE82. Raises CycleError."""
    values = [*given, *[""] * 5]
    rest = list(given[5:])
    dwell = rest.pop(0) if name == "CYCLE82" and rest else ""
    if any(other not in ("", "0") for other in rest[:-1]) or (rest and rest[-1] not in ALIKE):
        raise CycleError("an argument behind the depth is not read")
    back, plane, gap = (_number(values[k], what) for k, what in enumerate(("RTP", "RFP", "SDIS")))
    if values[3] and values[4] and Decimal(_number(values[4], "DPR")):
        raise CycleError("both DP and DPR are given")
    level = Decimal(_number(plane, "RFP"))
    bottom = _number(values[3], "DP") if values[3] else ""
    if not bottom:
        bottom = format(level - abs(Decimal(_number(values[4], "DPR"))), "f")
    start = format(level + abs(Decimal(gap)), "f")
    if not Decimal(bottom) < level <= Decimal(start) <= Decimal(back):
        raise CycleError("its levels are not in order: depth, reference, start, return")
    return Drilling(axis, start, bottom, back, _seconds(dwell))


def circle(given: Sequence[str]) -> list[tuple[Decimal, Decimal]]:
    """Return the places of HOLES2 in the plane, in their order. Raises CycleError.

    The first is at STA1, each further one by INDA, or by as much as goes round (Operating p. 286).
    """
    if len(given) != 6:
        raise CycleError("it takes six arguments")
    names = ("CPA", "CPO", "RAD", "STA1", "INDA")
    a, b, radius, first, step = (
        Decimal(_number(text or "0", name)) for text, name in zip(given, names, strict=False)
    )
    if not given[5].isdigit() or not 0 < int(given[5]) <= MOST or radius <= 0:
        raise CycleError("NUM counts no holes, or RAD is not above 0")
    count = int(given[5])
    angles = [math.radians(float(first + k * (step or Decimal(360) / count))) for k in range(count)]
    turns = [(Decimal(repr(math.cos(t))), Decimal(repr(math.sin(t)))) for t in angles]
    return [(a + radius * x, b + radius * y) for x, y in turns]


MOST = 9999  # holes of a pattern
ALIKE = ("", "0", SECONDS)


def _number(text: str, what: str) -> str:
    """Return an argument that is a number. Raises CycleError."""
    if not NUMBER.fullmatch(text):
        raise CycleError(f"{what} is not a plain number")
    return text


def _seconds(text: str) -> str:
    """Return a dwell; nothing for none. Raises CycleError."""
    value = Decimal(_number(text, "DTB")) if text else Decimal(0)
    if value < 0:
        raise CycleError("the dwell is in turns of the spindle")
    return text if value else ""


def keeps_path(given: Sequence[str]) -> bool:
    """Whether CYCLE832 changes nothing but tolerances: by name, and not by its older digits."""
    if given == [""]:
        return True
    named = len(given) in (2, 3, 4) and QUALITY.fullmatch(given[1].upper()) is not None
    return named and all(NUMBER.fullmatch(x) for x in (given[0], *given[2:]))


def swivels_nowhere(given: Sequence[str]) -> bool:
    """Whether CYCLE800 has neither angles nor shifts, and does not draw back."""
    if len(given) not in (14, 15, 16) or given[0] != NO_RETRACT:
        return False
    numbers = given[4:13]
    return all(not x or (NUMBER.fullmatch(x) and not Decimal(x)) for x in numbers)
