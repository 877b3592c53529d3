"""Taps in step with the spindle: SPOS=0, G331, G332 and M3, four lines that belong together.

They are read where they stand so, and nowhere else: down from where the tool stands and back there,
with one pitch and one speed, which is the one in force; the sign of K is the sense of the spindle
(M3, M4), which turns again behind them. That is one tap, as G33.1 is in blocks.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from decimal import Decimal
from typing import NamedTuple

from gcxform_plugins.dialects.siemens.place import text_of

SPOS = "SPOS"
VALUE = r"([-+]?[0-9]*\.?[0-9]+)"
LINES = tuple(
    re.compile(text, re.IGNORECASE)
    for text in (
        r"\s*(?:(N[0-9]+)\s+)?SPOS\s*=\s*0\s*(?:;.*)?",
        rf"\s*G331\s+Z{VALUE}\s+K{VALUE}\s+S{VALUE}\s*",
        rf"\s*G332\s+Z{VALUE}\s+K{VALUE}\s*",
        rf"\s*(M[34])\s+S{VALUE}\s*",
    )
)
CODE = "33.1"
"""The code of the motion in blocks."""
QUIET = frozenset(("M1", "M7", "M8", "M9"))
"""M functions that leave the spindle as it is."""


class Tap(NamedTuple):
    """A tap: levels and way per turn, how the spindle turns, how fast; the number of its block."""

    top: str
    bottom: str
    pitch: str
    sense: str
    speed: str
    number: tuple[str, ...] = ()


def tap_at(lines: Sequence[str], at: int) -> Tap | None:
    """Return the tap whose four lines begin here; None where none does."""
    texts = lines[at : at + len(LINES)]
    found = [pattern.fullmatch(text) for pattern, text in zip(LINES, texts, strict=False)]
    if len(found) < len(LINES) or not all(found):
        return None
    (number,), (bottom, pitch, speed), (top, other), (sense, again) = (
        match.groups() for match in found if match
    )
    same = Decimal(pitch) == Decimal(other) and Decimal(speed) == Decimal(again)
    down = Decimal(bottom) < Decimal(top) and Decimal(speed) > 0
    right = Decimal(pitch) > 0 if sense.upper() == "M3" else Decimal(pitch) < 0
    if not (same and down and right):
        return None
    by = text_of(abs(Decimal(pitch)))
    return Tap(top, bottom, by, sense.upper(), speed, (number,) if number else ())


def lines_of(tap: Tap) -> Iterator[str]:
    """Yield the lines of a tap."""
    pitch = tap.pitch if tap.sense == "M3" else f"-{tap.pitch}"
    yield f"{SPOS}=0"
    yield f"G331 Z{tap.bottom} K{pitch} S{tap.speed}"
    yield f"G332 Z{tap.top} K{pitch}"
    yield f"{tap.sense} S{tap.speed}"


def turned(codes: Sequence[str], spindle: str) -> str:
    """Return how the spindle turns behind M codes: M3, M4, or nothing."""
    for code in codes:
        if code not in QUIET:
            spindle = code if code in ("M3", "M4") else ""
    return spindle
