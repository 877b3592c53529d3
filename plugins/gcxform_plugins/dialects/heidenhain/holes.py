"""What the drilling cycles of a TNC are told, and where the holes of its patterns are.

| cycle | moves | said |
|---|---|---|
| 200, 240 | to Q200 over Q203, down at Q206, dwell Q211, out in rapid | [K] |
| 201 | the same, but to Q200 over Q203 at Q208, at Q206 where that is 0 | a simulator of TNC 426 |
| 203 | as 201, where Q202 is as deep as the hole: then it is one stroke | TNC 430, p. 244 |
| 220 | Q241 holes from Q245 on, by Q247; where that is 0 up to Q246, or around | 640, p. 162 |
| 221 | Q242 holes from Q225, Q226 on, by Q237 along Q224 | 410 ISO, p. 257 |

Which way the second row of 221 goes, and where a pattern ends that stays at the set-up clearance,
is not certain.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from decimal import Decimal

from gcxform_plugins.dialects.heidenhain.moves import around
from gcxform_plugins.dialects.heidenhain.words import written

TURN = 360
Told = Mapping[int, Decimal]


@dataclass(frozen=True, slots=True)
class Hole:
    """Parameters that a cycle needs, those that have to be 0 with why, and those without effect."""

    needs: tuple[int, ...]
    zero: Mapping[int, str] = field(default_factory=dict)
    idle: tuple[int, ...] = ()


TIP = {395: "a depth of the tip or of the full diameter"}
HOLES: Mapping[int, Hole] = {
    200: Hole((200, 201, 206, 202, 203, 204, 211), {**TIP, 210: "a dwell above"}),
    201: Hole((200, 201, 206, 211, 208, 203, 204)),
    203: Hole(
        (200, 201, 206, 202, 203, 204, 211, 208),
        {**TIP, 210: "a dwell above"},
        (212, 213, 205, 256),
    ),
    240: Hole((200, 343, 201, 206, 211, 203, 204), {343: "a depth by the diameter"}, (344,)),
}
COMMON = 200, 203, 204, 301
PATTERNS: Mapping[int, tuple[int, ...]] = {
    220: (216, 217, 244, 245, 246, 247, 241, *COMMON),
    221: (225, 226, 237, 238, 242, 243, 224, *COMMON),
}


def round_places(told: Told) -> list[tuple[str, str]]:
    """Return the places of cycle 220, in order; none where they are not certain."""
    count, begin, end, step = (told[n] for n in (241, 245, 246, 247))
    if count < 1 or count != int(count) or told[244] <= 0:
        return []
    if not step and count > 1:
        whole = abs(end - begin) == TURN
        if end == begin:
            return []
        step = (end - begin) / (count if whole else count - 1)
    return [_away(told[216], told[217], told[244] / 2, begin + step * k) for k in range(int(count))]


def row_places(told: Told) -> list[tuple[str, str]]:
    """Return the places of cycle 221, in order; none where they are not certain."""
    count, step = told[242], told[237]
    if count < 1 or count != int(count) or told[243] != 1 or not step:
        return []
    return [_away(told[225], told[226], step * k, told[224]) for k in range(int(count))]


def _away(x: Decimal, y: Decimal, radius: Decimal, angle: Decimal) -> tuple[str, str]:
    """Return the place that is a radius away from another one, in a direction (degrees)."""
    along, aside = around(float(angle))
    return written(float(x) + float(radius) * along), written(float(y) + float(radius) * aside)
