"""What the drilling cycles of a TNC are told, and where the holes of its patterns are.

| cycle | moves | said |
|---|---|---|
| 200, 240 | to Q200 over Q203, down at Q206, dwell Q211, out in rapid | [K] |
| 200 in strokes | between: up, Q210, down to `peck-clearance` over the ground, in rapid | [K] |
| 205 | the same strokes, Q212 shorter each, Q205 at least; down to Q258 over the ground | 640 |
| 201 | the same, but to Q200 over Q203 at Q208, at Q206 where that is 0 | a simulator of TNC 426 |
| 207 | to Q200 over Q203, in step with the spindle to Q201 and back there, as G33.1 | 320 p. 238 |
| 203 | as 201, where Q202 is as deep as the hole: then it is one stroke | TNC 430, p. 244 |
| 220 | Q241 holes from Q245 on, by Q247; where that is 0 up to Q246, or around | 640, p. 162 |
| 221 | Q242 holes from Q225, Q226 on, by Q237 along Q224 | 410 ISO, p. 257 |

How far over the ground cycle 200 begins to feed again is not certain: it is a setting. Whether
chips are broken in rapid is not either, nor which way the second row of 221 goes, nor where a
pattern ends that stays at the set-up clearance.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from decimal import Decimal

from gcxform_plugins.dialects.heidenhain.polar import around
from gcxform_plugins.dialects.heidenhain.words import written

TURN = 360
MOST_STROKES = 10_000
Told = Mapping[int, Decimal]


@dataclass(frozen=True, slots=True)
class Hole:
    """Parameters that a cycle needs, those that have to be 0 with why, and those without effect."""

    needs: tuple[int, ...]
    zero: Mapping[int, str] = field(default_factory=dict)
    idle: tuple[int, ...] = ()


TIP = {395: "a depth of the tip or of the full diameter"}
HOLES: Mapping[int, Hole] = {
    200: Hole((200, 201, 206, 202, 203, 204, 211), TIP, (210,)),
    201: Hole((200, 201, 206, 211, 208, 203, 204)),
    203: Hole(
        (200, 201, 206, 202, 203, 204, 211, 208),
        {**TIP, 210: "a dwell above"},
        (212, 213, 205, 256),
    ),
    205: Hole(
        (200, 201, 206, 202, 203, 204, 211, 212, 205, 258, 259, 257),
        {**TIP, 257: "chips that are broken", 379: "a start below the surface", 208: "a way out"},
        (256, 253),
    ),
    240: Hole((200, 343, 201, 206, 211, 203, 204), {343: "a depth by the diameter"}, (344,)),
}
TAP = 207
TAPPED = Hole((200, 201, 239, 203, 204))
OTHERS: Mapping[int, str] = {
    **dict.fromkeys((202, 204), "a boring bar that an oriented spindle takes off the wall"),
    **dict.fromkeys((206, 207, 209, 2, 17, 18), "a thread whose feed is tied to the spindle"),
    208: "a helix, whose way in and round the ground no manual tells",
    241: "a deep hole with speeds and coolant of its own",
    **dict.fromkeys(
        (262, 263, 264, 265, 267), "a milled thread, whose ways in and out no manual tells"
    ),
    **dict.fromkeys((251, 252, 253, 254, 3, 4, 5), "a pocket or a slot, in ways of the control"),
    **dict.fromkeys((256, 257, 258), "a stud, in ways of the control"),
    **dict.fromkeys(
        (6, 14, 15, 16, *range(20, 26), *range(270, 280)), "a contour, in ways of the control"
    ),
    **dict.fromkeys((27, 28, 29, 39), "a contour on a cylinder"),
    **dict.fromkeys(range(230, 234), "a face, in ways of the control"),
    19: "a plane that is tilted as the machine's builder has set",
    26: "a scale for each axis",
    13: "an angle at which the spindle stops",
    12: "a program that becomes a cycle",
}
"""Cycles that are not read, by what they are."""
COMMON = 200, 203, 204, 301
PATTERNS: Mapping[int, tuple[int, ...]] = {
    220: (216, 217, 244, 245, 246, 247, 241, *COMMON),
    221: (225, 226, 237, 238, 242, 243, 224, *COMMON),
}


def strokes_of(cycle: int, told: Told) -> list[Decimal]:
    """Return how deep each stroke of a hole ends below the surface, in order; none if too many.

    The first is Q202 deep; in cycle 205 each is Q212 shorter than the one before, Q205 at least.
    """
    total, step, depth = -told[201], told.get(202, -told[201]), Decimal(0)
    less, least = (told[212], told[205]) if cycle == 205 else (Decimal(0), Decimal(0))
    found: list[Decimal] = []
    while depth < total:
        if step <= 0 or len(found) == MOST_STROKES:
            return []
        depth = min(depth + step, total)
        found.append(depth)
        step = max(step - less, min(least, step))
    return found


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
