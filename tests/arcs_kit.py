"""What the tests of `arcs` share: points along two paths in order, and programs to draw."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
from hypothesis import strategies as st
from properties.test_laws import at, point_of
from reference.interpreter import Move

from gcxform.system.arrays import Floats

SPACING = 0.02  # mm between the points that are compared
PLANES = {"G17": "XYZ", "G18": "ZXY", "G19": "YZX"}
CENTRES = {"X": "I", "Y": "J", "Z": "K"}


# --- the oracle ---


def points(moves: Iterable[Move]) -> Floats:
    """Return points along moves, no farther apart than SPACING."""
    found: list[Floats] = []
    for move in moves:
        if not set("XYZ") <= set(move.start):
            continue
        length = math.dist(point_of(move.start), point_of(move.end))
        if move.centre is not None:
            radius = math.dist(point_of(move.start), move.centre)
            length = math.hypot(radius * move.sweep, length)
        parts = np.linspace(0.0, 1.0, math.ceil(length / SPACING) + 1)
        found.append(np.array([at(move, float(part)) for part in parts]))
    return np.vstack(found)


def follows(one: Floats, other: Floats, limit: float) -> bool:
    """Whether one row of points can be followed along the other within a distance."""
    column = np.arange(len(other))
    reached = column < 0
    for row, point in enumerate(one):
        near = ((other - point) ** 2).sum(axis=1) <= limit**2
        entered = reached | np.append(row == 0, reached[:-1])
        entered = near & (entered if row else column == 0)
        last_in = np.maximum.accumulate(np.where(entered, column, -1))
        last_out = np.maximum.accumulate(np.where(near, -2, column))
        reached = near & (last_in > last_out)
    return bool(reached[-1])


# --- programs ---


def ended(lines: Iterable[str]) -> bytes:
    return "\n".join([*lines, "M2", ""]).encode()


@st.composite
def arcs(draw: st.DrawFn) -> tuple[bytes, int]:
    """Draw a program of arcs and helices, far enough from straight; and how many there are."""
    plane = draw(st.sampled_from(sorted(PLANES)))
    u, v, w = PLANES[plane]
    place = dict.fromkeys("XYZ", 0.0)
    lines = [f"G21 G90 G94 {plane}", "G0 X0 Y0 Z0", "F100"]
    count = draw(st.integers(1, 3))
    for _ in range(count):
        radius, angle = draw(st.integers(10, 60)) / 10, math.radians(draw(st.integers(0, 359)))
        turn = math.radians(draw(st.integers(60, 320))) * draw(st.sampled_from((1, -1)))
        rise = draw(st.sampled_from((0.0, 0.0, 1.0, -3.0)))
        start, centre = dict(place), {}
        centre[u] = round(start[u] - radius * math.cos(angle), 4)
        centre[v] = round(start[v] - radius * math.sin(angle), 4)
        place[u] = round(centre[u] + radius * math.cos(angle + turn), 4)
        place[v] = round(centre[v] + radius * math.sin(angle + turn), 4)
        place[w] = round(start[w] + rise, 4)
        words = [f"{a}{place[a]:.4f}" for a in (u, v, w)]
        words += [f"{CENTRES[a]}{centre[a] - start[a]:.4f}" for a in (u, v)]
        lines.append(("G3 " if turn > 0 else "G2 ") + " ".join(words))
        place[w] = round(place[w] + 2, 4)
        lines.append(f"G1 {w}{place[w]:.4f}")
    return ended(lines), count


@st.composite
def polylines(draw: st.DrawFn) -> bytes:
    """Draw short lines that turn now smoothly, now not, with this and that between them."""
    place, heading = np.zeros(3), 0.0
    lines = ["G21 G90 G94 G17", "G0 X0 Y0 Z0", "G1 F100"]
    for _ in range(draw(st.integers(1, 6))):
        bend, climb = draw(st.integers(-40, 40)) / 100, draw(st.sampled_from((0.0, 0.0, 0.05)))
        length = draw(st.sampled_from((0.05, 0.3, 0.8)))
        wobble = draw(st.sampled_from((0.0, 0.0, 0.01, 0.04)))
        for _ in range(draw(st.integers(1, 14))):
            heading += bend
            aside = wobble * draw(st.integers(-4, 4)) / 4
            way = np.array([math.cos(heading), math.sin(heading), climb]) * length
            place = place + way + np.array([-math.sin(heading), math.cos(heading), 0.0]) * aside
            lines.append("X{:.3f} Y{:.3f} Z{:.3f}".format(*place))
        heading += draw(st.sampled_from((0.0, 0.0, 0.5, 3.1)))
        lines += draw(st.sampled_from(([], ["M8"], ["F200"], ["G91", "G90"], ["G4 P0.1"])))
    return ended(lines)
