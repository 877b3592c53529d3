"""Five-axis machines by quaternions, one pose at a time: an oracle without numpy or the package.

    python tests/quaternions.py > tests/poses.csv

writes poses of machines with their tips, tool axes and all attitudes. The attitudes are found by
search: the angle of the second axis where the tool is as far from the first as was asked, by
bisection, and then the angle of the first.
"""

from __future__ import annotations

import csv
import math
import random
import sys
from dataclasses import dataclass

STEPS = 2000  # in which the angle of the second axis is searched
SEED = 5


@dataclass
class Line:
    """A rotary axis: letter, T (table) or H (head), direction, point, sign."""

    letter: str
    side: str
    direction: tuple
    point: tuple
    sign: int


@dataclass
class Device:
    """A machine: its rotary axes from the base outwards, table first, and its tip."""

    name: str
    tip: tuple
    lines: list


def product(p, q):
    a, b, c, d = p
    e, f, g, h = q
    return (
        a * e - b * f - c * g - d * h,
        a * f + b * e + c * h - d * g,
        a * g - b * h + c * e + d * f,
        a * h + b * g - c * f + d * e,
    )


def rotated(vector, direction, degrees):
    half = math.radians(degrees) / 2
    length = math.sqrt(sum(v * v for v in direction))
    q = (math.cos(half), *(math.sin(half) * v / length for v in direction))
    back = (q[0], -q[1], -q[2], -q[3])
    return product(product(q, (0.0, *vector)), back)[1:]


def carried(point, line, degrees):
    arm = tuple(a - b for a, b in zip(point, line.point, strict=True))
    turned = rotated(arm, line.direction, line.sign * degrees)
    return tuple(a + b for a, b in zip(turned, line.point, strict=True))


def forward(device, linear, angles):
    """Return tip and tool axis in the frame of the workpiece."""
    point, ahead = device.tip, (0.0, 0.0, 1.0)
    pairs = list(zip(device.lines, angles, strict=True))
    for line, angle in reversed([pair for pair in pairs if pair[0].side == "H"]):
        point = carried(point, line, angle)
        ahead = rotated(ahead, line.direction, line.sign * angle)
    point = tuple(a + b for a, b in zip(point, linear, strict=True))
    for line, angle in [pair for pair in pairs if pair[0].side == "T"]:
        point = carried(point, line, -angle)
        ahead = rotated(ahead, line.direction, -line.sign * angle)
    return point, ahead


def linear_for(device, tip, angles):
    """Return X, Y, Z: what is missing to the tip where the workpiece has carried it."""
    tables = [p for p in zip(device.lines, angles, strict=True) if p[0].side == "T"]
    for line, angle in reversed(tables):
        tip = carried(tip, line, angle)
    bare = Device("", device.tip, [line for line in device.lines if line.side == "H"])
    arm, _ = forward(bare, (0.0, 0.0, 0.0), angles[len(tables) :])
    return tuple(a - b for a, b in zip(tip, arm, strict=True))


def attitudes(device, ahead):
    """Return all pairs of angles that give a tool axis, by search."""
    first, second = loop = sorted(
        range(2), key=lambda k: (device.lines[k].side == "H", -k if tables(device) == 2 else k)
    )
    ways = [device.lines[k].sign * (-1 if device.lines[k].side == "T" else 1) for k in loop]
    one, two = device.lines[first].direction, device.lines[second].direction
    wanted = dot(one, ahead)

    def off(angle):
        return dot(one, rotated((0.0, 0.0, 1.0), two, angle)) - wanted

    found = []
    for k in range(STEPS):
        low, high = -180 + 360 * k / STEPS, -180 + 360 * (k + 1) / STEPS
        if (off(low) < 0) != (off(high) < 0):
            angle = bisected(off, low, high)
            tool = rotated((0.0, 0.0, 1.0), two, angle)
            angles = [0.0, 0.0]
            angles[second] = ways[1] * angle
            angles[first] = ways[0] * between(one, tool, ahead)
            found.append(angles)
    return found


def tables(device):
    return sum(line.side == "T" for line in device.lines)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b, strict=True))


def bisected(off, low, high):
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (middle, high) if (off(low) < 0) == (off(middle) < 0) else (low, middle)
    return (low + high) / 2


def between(axis, start, end):
    """Return the angle about an axis from one vector to another, degrees."""
    length = math.sqrt(dot(axis, axis))
    crossed = product((0.0, *start), (0.0, *end))[1:]
    along = dot(axis, crossed) / length
    across = dot(start, end) - dot(axis, start) * dot(axis, end) / length**2
    return math.degrees(math.atan2(along, across))


# --- the file ---

TIP = (0.0, 0.0, -120.0)
X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


def nutating(degrees):
    return (0.0, math.sin(math.radians(degrees)), math.cos(math.radians(degrees)))


DEVICES = [
    Device(
        "ac-trunnion",
        TIP,
        [Line("A", "T", X, (4.0, -11.0, 63.0), -1), Line("C", "T", Z, (4.5, 2.0, 71.0), -1)],
    ),
    Device(
        "bc-trunnion",
        TIP,
        [Line("B", "T", Y, (9.0, 3.0, -33.0), -1), Line("C", "T", Z, (-7.0, 5.0, 0.0), -1)],
    ),
    Device(
        "ba-trunnion",
        TIP,
        [Line("B", "T", Y, (2.0, 8.0, -41.0), -1), Line("A", "T", X, (1.0, 6.0, -52.0), +1)],
    ),
    Device(
        "c-table-b-head",
        TIP,
        [Line("C", "T", Z, (90.0, 40.0, 0.0), -1), Line("B", "H", Y, (0.0, 3.0, 170.0), +1)],
    ),
    Device(
        "ca-fork",
        TIP,
        [Line("C", "H", Z, (1.0, -2.0, 0.0), +1), Line("A", "H", X, (0.0, 3.5, 190.0), +1)],
    ),
    Device(
        "cb-fork",
        (0.0, 0.0, 0.0),
        [Line("C", "H", Z, (0.0, 0.0, 0.0), +1), Line("B", "H", Y, (0.0, 0.0, 230.0), -1)],
    ),
    Device(
        "nutating-head",
        TIP,
        [
            Line("C", "H", Z, (0.0, 0.0, 0.0), +1),
            Line("B", "H", nutating(45), (0.0, 12.0, 210.0), +1),
        ],
    ),
    Device(
        "nutating-table of 50 degrees",
        TIP,
        [
            Line("B", "T", nutating(50), (0.0, -25.0, -66.0), -1),
            Line("C", "T", Z, (3.0, 1.0, 0), -1),
        ],
    ),
    Device(
        "square to nothing, table",
        (1.0, -2.0, -88.0),
        [
            Line("A", "T", (0.9, 0.2, -0.1), (4.0, -11.0, 63.0), -1),
            Line("C", "T", (0.1, -0.2, 1.1), (4.5, 2.0, 71.0), -1),
        ],
    ),
    Device(
        "square to nothing, mixed",
        (1.0, -2.0, -88.0),
        [
            Line("A", "T", (0.8, 0.3, 0.2), (7.0, -1.0, 13.0), +1),
            Line("B", "H", (0.1, 0.7, 0.4), (2.5, 2.0, 91.0), -1),
        ],
    ),
]


def rows():
    """Yield the rows of the file, its header first."""
    yield ["machine", "tip", "axes", "linear", "angles", "point", "axis", "attitudes"]
    draw = random.Random(SEED)
    for device in DEVICES:
        axes = " | ".join(
            " ".join([a.letter, a.side, written(a.direction), written(a.point), str(a.sign)])
            for a in device.lines
        )
        for _ in range(6):
            linear = tuple(round(draw.uniform(-250, 250), 3) for _ in range(3))
            angles = tuple(round(draw.uniform(-120, 120), 3) for _ in range(2))
            point, ahead = forward(device, linear, angles)
            found = [
                f"{written(pair)} {written(linear_for(device, point, pair))}"
                for pair in attitudes(device, ahead)
            ]
            texts = [written(part) for part in (linear, angles, point, ahead)]
            yield [device.name, written(device.tip), axes, *texts, " | ".join(found)]


def written(numbers):
    return " ".join(repr(float(number)) for number in numbers)


if __name__ == "__main__":
    csv.writer(sys.stdout, lineterminator="\n").writerows(rows())
