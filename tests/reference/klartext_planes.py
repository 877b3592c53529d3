"""PLANE by the manuals, in floats and lists: it shares no code with the package, nor numpy.

A table is a list of axes from the base outwards: letter, direction, point. It carries the
workpiece, so that a positive command turns that left-handed (sign -1, as ISO 841 has it).
"""

from __future__ import annotations

import math

Matrix = list[list[float]]
Axis = tuple[str, tuple[float, ...], tuple[float, ...]]


def turn(direction: tuple[float, ...], degrees: float) -> Matrix:
    """Return the matrix of a right-handed turn about a direction of any length."""
    size = math.sqrt(sum(d * d for d in direction))
    x, y, z = (d / size for d in direction)
    s, c = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
    t = 1.0 - c
    return [
        [c + t * x * x, t * x * y - s * z, t * x * z + s * y],
        [t * x * y + s * z, c + t * y * y, t * y * z - s * x],
        [t * x * z - s * y, t * y * z + s * x, c + t * z * z],
    ]


def times(one: Matrix, other: Matrix) -> Matrix:
    """Return a product of matrices."""
    columns = [*zip(*other, strict=True)]
    return [[sum(a * b for a, b in zip(row, col, strict=True)) for col in columns] for row in one]


def led(matrix: Matrix, vector: list[float]) -> list[float]:
    """Return a matrix times a vector."""
    return [sum(a * b for a, b in zip(row, vector, strict=True)) for row in matrix]


def spatial(a: float, b: float, c: float) -> Matrix:
    """PLANE SPATIAL: about the fixed axes A, then B, then C (TNC 620 10/2017, p. 540)."""
    turns = turn((0, 0, 1), c), turn((0, 1, 0), b), turn((1, 0, 0), a)
    return times(times(turns[0], turns[1]), turns[2])


def euler(precession: float, nutation: float, rotation: float) -> Matrix:
    """PLANE EULER: about Z, the new X and the new Z (TNC 620 34056x-04 ISO, p. 322)."""
    first, last = turn((0, 0, 1), precession), turn((0, 0, 1), rotation)
    return times(times(first, turn((1, 0, 0), nutation)), last)


def carried(table: list[Axis], angles: list[float], point: list[float]) -> list[float]:
    """Return where the table takes a point that is told with all axes at 0."""
    for (_, direction, place), angle in reversed([*zip(table, angles, strict=True)]):
        away = [p - o for p, o in zip(point, place, strict=True)]
        point = [o + v for o, v in zip(place, led(turn(direction, -angle), away), strict=True)]
    return point


def off(table: list[Axis], angles: list[float], normal: list[float]) -> float:
    """Return how far the normal of a plane is from the tool, once the table has turned."""
    for (_, direction, _), angle in reversed([*zip(table, angles, strict=True)]):
        normal = led(turn(direction, -angle), normal)
    return math.hypot(normal[0], normal[1], normal[2] - 1.0)


def searched(table: list[Axis], plane: Matrix, sign: int) -> list[float]:
    """Return the angles for a plane whose first has a sign, by trying: ever finer about the best.

    The first axis is that next to the base, which SEQ is about.
    """
    normal = [row[2] for row in plane]
    tried = [[sign * a, float(c)] for a in range(0, 181, 6) for c in range(-180, 180, 6)]
    best = min(tried, key=lambda angles: off(table, angles, normal))
    step = 3.0
    while step > 1e-9:
        near = [(best[0] + i * step, best[1] + j * step) for i in (-1, 0, 1) for j in (-1, 0, 1)]
        found = min(near, key=lambda angles: off(table, [*angles], normal))
        step = step / 2 if found == tuple(best) else step
        best = [*found]
    return best
