"""Programmable frames of a SINUMERIK: TRANS, ROT, SCALE, MIRROR, and those that add to them.

A frame says where a point of the program is in the coordinates outside of it:
p_outer = shift + matrix @ p. What is added acts in the frame that is in force, so it stands on the
right: A : B is p -> A(B(p)) (NC programming 12/2019 p. 631; Frames K2 2-67). ROT turns about Z,
then the new Y, then the new X (RPY, p. 309); RPL about the axis across the plane (808D p. 56).
Numbers are decimals, so a shift rounds nothing; quarter turns are exact.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal

from gcxform_plugins.dialects.siemens.place import LINEAR, PlaceError

Row = tuple[Decimal, Decimal, Decimal]
ZERO, ONE = Decimal(0), Decimal(1)
NEAR = Decimal("1e-12")
FINE = Decimal("1e-7")
"""mm or inches: as fine are words written in a frame that turns."""
UNITS: tuple[Row, Row, Row] = ((ONE, ZERO, ZERO), (ZERO, ONE, ZERO), (ZERO, ZERO, ONE))
ACROSS = {"XY": "Z", "ZX": "Y", "YZ": "X"}
PLAIN = "let the CAM write positions without it"


@dataclass(frozen=True)
class Frame:
    """A frame: a matrix, and where its zero is outside."""

    matrix: tuple[Row, Row, Row] = UNITS
    shift: Row = (ZERO, ZERO, ZERO)

    def __matmul__(self, other: Frame) -> Frame:
        """Return the frame in which another one acts: A : B."""
        columns = [self.turned([row[k] for row in other.matrix]) for k in range(3)]
        matrix = tuple(tuple(column[k] for column in columns) for k in range(3))
        return Frame(matrix, self.point(other.shift))  # type: ignore[arg-type]

    def turned(self, vector: Sequence[Decimal]) -> Row:
        """Return a distance, as it is outside."""
        x, y, z = (sum((a * b for a, b in zip(r, vector, strict=True)), ZERO) for r in self.matrix)
        return x, y, z

    def point(self, point: Sequence[Decimal]) -> Row:
        """Return a point, as it is outside."""
        x, y, z = (a + b for a, b in zip(self.turned(point), self.shift, strict=True))
        return x, y, z

    def inside(self, point: Sequence[Decimal]) -> Row:
        """Return a point that is given outside."""
        moved = [p - s for p, s in zip(point, self.shift, strict=True)]
        rows = _inverse(self.matrix)
        x, y, z = (sum((m * v for m, v in zip(row, moved, strict=True)), ZERO) for row in rows)
        return x, y, z

    @property
    def rigid(self) -> bool:
        """Whether all lengths grow alike."""
        columns = [*zip(*self.matrix, strict=True)]
        squares = [sum((v * v for v in column), ZERO) for column in columns]
        return max(squares) - min(squares) <= NEAR * max(squares)

    def in_plane(self, plane: str) -> Decimal | None:
        """Return by what radii in a plane grow, below 0 where arcs turn the other way round.

        None where circles of it are none outside, or are in no plane of the axes.
        """
        a, b = (LINEAR.index(axis) for axis in plane)
        c, m = 3 - a - b, self.matrix
        if any(abs(v) > NEAR for v in (m[a][c], m[b][c], m[c][a], m[c][b])):
            return None
        one, two = m[a][a] ** 2 + m[b][a] ** 2, m[a][b] ** 2 + m[b][b] ** 2
        if abs(one - two) > NEAR * one or abs(m[a][a] * m[a][b] + m[b][a] * m[b][b]) > NEAR * one:
            return None
        return one.sqrt().copy_sign(m[a][a] * m[b][b] - m[a][b] * m[b][a])


def _inverse(m: tuple[Row, Row, Row]) -> list[list[Decimal]]:
    """Return the inverse of a matrix, by its cofactors."""
    cofactors = [
        [
            m[(i + 1) % 3][(j + 1) % 3] * m[(i + 2) % 3][(j + 2) % 3]
            - m[(i + 1) % 3][(j + 2) % 3] * m[(i + 2) % 3][(j + 1) % 3]
            for i in range(3)
        ]
        for j in range(3)
    ]
    whole = sum((m[0][k] * cofactors[k][0] for k in range(3)), ZERO)
    return [[value / whole for value in row] for row in cofactors]


def words_inside(
    frame: Frame,
    named: Mapping[str, Decimal],
    before: Mapping[str, Decimal],
    steps: bool,
    bends: bool,
) -> dict[str, Decimal] | None:
    """Return words, as they are outside, as they count in a frame; None where that is not known.

    `before` is where axes stand outside. Where a frame turns, one word becomes several.
    """
    if frame.matrix == UNITS:
        zero = dict(zip(LINEAR, frame.shift, strict=True))
        return {axis: v if steps else v - zero[axis] for axis, v in named.items()}
    point = [named.get(axis, ZERO if steps else before.get(axis)) for axis in LINEAR]
    known = [value for value in point if value is not None]
    if bends or len(known) < len(point):
        return None
    found = (Frame(frame.matrix) if steps else frame).inside(known)
    rows = _inverse(frame.matrix)
    moved = [any(rows[k][LINEAR.index(axis)] for axis in named) for k in range(3)]
    return {axis: v.quantize(FINE) for axis, v, m in zip(LINEAR, found, moved, strict=True) if m}


def about(axis: str, degrees: Decimal) -> Frame:
    """Return a turn about an axis, counter-clockwise as it is looked at from its end."""
    quarter = degrees % 360
    exact = {0: (1, 0), 90: (0, 1), 180: (-1, 0), 270: (0, -1)}
    angle = math.radians(float(degrees))
    quarter += 360 if quarter < 0 else 0
    c, s = (
        map(Decimal, exact[int(quarter)])
        if quarter in exact
        else (Decimal(repr(math.cos(angle))), Decimal(repr(math.sin(angle))))
    )
    k = LINEAR.index(axis)
    rows = [[ZERO] * 3 for _ in range(3)]
    a, b = (k + 1) % 3, (k + 2) % 3
    rows[k][k], rows[a][a], rows[b][b], rows[a][b], rows[b][a] = ONE, c, c, -s, s
    return Frame(tuple(tuple(row) for row in rows))  # type: ignore[arg-type]


def by_solid_angles(words: Mapping[str, Decimal]) -> Frame:
    """Return the turn of ROTS X Y: how far its plane falls along X and Y. Raises PlaceError.

    The new X is in the plane of the old X and Z, turned by Y about Y; the plane has the line that
    is turned by X about X out of Y as well (Frames K2 p. 775).
    """
    if words.keys() != {"X", "Y"} or max(map(abs, words.values())) >= 90:
        raise PlaceError("GX210", "ROTS but with X and Y, below 90 degrees", PLAIN)
    first = about("Y", words["Y"]).turned((ONE, ZERO, ZERO))
    along = about("X", words["X"]).turned((ZERO, ONE, ZERO))
    across = _crossed(first, along)
    size = sum((v * v for v in across), ZERO).sqrt()
    third: Row = (across[0] / size, across[1] / size, across[2] / size)
    x, y, z = zip(first, _crossed(third, first), third, strict=True)
    return Frame((x, y, z))


def _crossed(a: Row, b: Row) -> Row:
    """Return the vector across two others."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def frame_of(name: str, words: Mapping[str, Decimal], angle: Decimal | None, plane: str) -> Frame:
    """Return the frame that an instruction makes, by its words and RPL. Raises PlaceError."""
    if angle is not None and (name != "ROT" or words):
        raise PlaceError("GX210", f"{name}: RPL= stands beside what it does not belong to", PLAIN)
    x, y, z = (words.get(axis, ZERO) for axis in LINEAR)
    if name == "TRANS":
        return Frame(shift=(x, y, z))
    if name == "ROT":
        if angle is not None:
            return about(ACROSS[plane], angle)
        if len(words) > 1 and abs(y) >= 90:
            raise PlaceError("GX210", "ROT with an angle of 90 or more about Y", PLAIN)
        return about("Z", z) @ about("Y", y) @ about("X", x)
    if name == "ROTS":
        return by_solid_angles(words)
    if name == "SCALE":
        factors = [words.get(axis, ONE) for axis in LINEAR]
        if any(factor <= 0 for factor in factors):
            raise PlaceError("GX213", "SCALE takes factors above 0", "write MIRROR beside it")
    elif name == "MIRROR":
        factors = [-ONE if axis in words else ONE for axis in LINEAR]
    else:
        raise PlaceError("GX210", f"{name} is a frame that is not read", PLAIN)
    rows = [[f if i == k else ZERO for k in range(3)] for i, f in enumerate(factors)]
    return Frame(tuple(tuple(row) for row in rows))  # type: ignore[arg-type]
