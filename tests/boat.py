"""A small boat as a model for slicers, for no Benchy may be had here: hull, cabin, roof, funnel.

Each part is a closed prism of rings of points that overlaps its neighbours; a slicer joins them. It
has what a Benchy is sliced for: a flared hull, posts, a roof over air, a round funnel with a hole.
"""

from __future__ import annotations

import math
from itertools import pairwise

Point = tuple[float, float, float]
Ring = list[Point]
LENGTH, BREADTH, HEIGHT = 30.0, 14.0, 7.0  # mm
STATIONS = 13


def boat() -> str:
    """Return the boat as STL."""
    posts = [(x, y) for x in (-7.0, 1.0) for y in (-3.5, 2.0)]
    parts = [
        hull(),
        *(box((x, y, HEIGHT - 1.0), (1.5, 1.5, 6.0)) for x, y in posts),
        box((-8.0, -4.5, 11.5), (11.5, 9.0, 1.2)),
        cylinder((-9.5, 0.0, HEIGHT - 1.0), 1.8, 7.0),
    ]
    facets = (facet for part in parts for facet in closed(part))
    return f"solid boat\n{''.join(map(facet_text, facets))}endsolid boat\n"


def hull() -> list[Ring]:
    """Return sections from stern to stem: a flat bottom, and sides that lean outwards."""
    rings = []
    for k in range(STATIONS):
        t = 2.0 * k / (STATIONS - 1) - 1.0
        half = BREADTH / 2 * (1.0 - 0.95 * max(t, 0.0) ** 2.2 - 0.25 * max(-t, 0.0) ** 3)
        deck, x = HEIGHT + 1.5 * max(t, 0.0) ** 2, t * LENGTH / 2
        low = 0.55 * half
        rings.append([(x, -half, deck), (x, -low, 0.0), (x, low, 0.0), (x, half, deck)])
    return rings


def box(corner: Point, size: Point) -> list[Ring]:
    """Return an upright box."""
    (x, y, z), (a, b, c) = corner, size
    return [[(x, y, h), (x + a, y, h), (x + a, y + b, h), (x, y + b, h)] for h in (z, z + c)]


def cylinder(foot: Point, radius: float, height: float, sides: int = 24) -> list[Ring]:
    """Return an upright prism of many sides."""
    turns = [2.0 * math.pi * k / sides for k in range(sides)]
    round_ = [(foot[0] + radius * math.cos(a), foot[1] + radius * math.sin(a)) for a in turns]
    return [[(x, y, h) for x, y in round_] for h in (foot[2], foot[2] + height)]


def closed(rings: list[Ring]) -> list[Ring]:
    """Return the facets of a solid through rings of as many points, with its two ends."""
    found = []
    for low, high in pairwise(rings):
        for k, (a, b) in enumerate(pairwise([*low, low[0]])):
            c, d = high[(k + 1) % len(high)], high[k]
            found += [[a, b, c], [a, c, d]]
    for k in range(1, len(rings[0]) - 1):
        first, last = rings[0], rings[-1]
        found += [[first[0], first[k + 1], first[k]], [last[0], last[k], last[k + 1]]]
    return found


def facet_text(facet: Ring) -> str:
    """Return a facet of STL."""
    points = "".join(f"vertex {x:.4f} {y:.4f} {z:.4f}\n" for x, y, z in facet)
    return f"facet normal 0 0 0\nouter loop\n{points}endloop\nendfacet\n"
