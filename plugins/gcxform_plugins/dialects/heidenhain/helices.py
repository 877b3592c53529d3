"""Helices by their angle: CC and CP have no end, so where they lead to is computed here.

Words are rounded: their end is seldom quite as far from the centre as their start. A circle that
goes through both has its centre a little beside the one that is said, and helix after helix, each
from where the one before has really ended, leads to the places of the words.
"""

from __future__ import annotations

from decimal import Decimal
from math import atan2, cos, degrees, hypot, radians, sin

TURN = 360.0
LEAST = 1e-4  # degrees, the last decimal of CP
FINEST = {False: Decimal("0.0001"), True: Decimal("0.00001")}  # mm, and inches
SHORT = 8  # times as far as words are off
Point = tuple[float, float]
Pole = tuple[Decimal, Decimal]


def centred(start: Point, end: Point, pole: Pole, inch: bool, short: bool) -> Pole:
    """Return the centre beside a pole that is as far from the start as from the end.

    It is the pole itself where the words are exact, or where another one would lead away from
    them: along a chord of half a turn or less the centre may move further than the words are off.
    """
    centre = float(pole[0]), float(pole[1])
    along = end[0] - start[0], end[1] - start[1]
    chord = hypot(*along)
    if not chord:
        return pole
    off = hypot(end[0] - centre[0], end[1] - centre[1])
    off -= hypot(start[0] - centre[0], start[1] - centre[1])
    middle = (start[0] + end[0]) / 2 - centre[0], (start[1] + end[1]) / 2 - centre[1]
    by = (middle[0] * along[0] + middle[1] * along[1]) / chord
    if not float(FINEST[inch]) / 2 <= abs(by) <= abs(off) * (SHORT if short else 1):
        return pole
    x, y = (Decimal(c + by * a / chord) for c, a in zip(centre, along, strict=True))
    return x.quantize(FINEST[inch]), y.quantize(FINEST[inch])


def turned(start: Point, end: Point, pole: Pole, left: bool, turns: int) -> Decimal:
    """Return the angle of a helix with its sign, which is above 0 to the left (degrees)."""
    turn = (_angle(end, pole) - _angle(start, pole)) * (1 if left else -1) % TURN
    turn = turn if LEAST < turn < TURN - LEAST else TURN
    whole = Decimal(f"{turn + TURN * (turns - 1):.4f}")
    return whole if left else -whole


def reached(start: Point, pole: Pole, angle: Decimal) -> Point:
    """Return where a helix by an angle ends."""
    x, y = start[0] - float(pole[0]), start[1] - float(pole[1])
    along, aside = cos(radians(float(angle))), sin(radians(float(angle)))
    return float(pole[0]) + x * along - y * aside, float(pole[1]) + x * aside + y * along


def _angle(point: Point, pole: Pole) -> float:
    return degrees(atan2(point[1] - float(pole[1]), point[0] - float(pole[0])))
