"""The plane that PLANE says, and the attitude in which a TNC comes to stand on it.

    SPATIAL   R = Rz(SPC) Ry(SPB) Rx(SPA), about axes that stand still
    EULER     R = Rz(EULPR) Rx(EULNU) Rz(EULROT), about axes that go along
    VECTOR    Z along N, X along B, which have to be square
    POINTS    X from P1 to P2, P3 on the side of +Y; the datum stays

(TNC 620 10/2017 pp. 540-549, iTNC 530 340 49x pp. 475-496, TNC 640 ISO 1/2015 p. 424.) SEQ is the
sign of the axis that is the first one from the tool, or the last one from the table; where that
attitude cannot be reached there is an error, and no other is taken. SYM is about the middle of that
axis (TNC7 basic 81762x-19), which is 0 where both attitudes lie alike about it. Without either it
is the one that can be reached, then the shorter way, or that of the fewest moves (TNC7), from where
the axes stand: what both say is taken. The example of the manual (iTNC 530 ISO, p. 404) turns A
from 0 to +45 where both are as far.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from gcxform import vocabulary as v

ALIKE = 1e-6  # degrees
SQUARE = 1e-4  # between two directions of length 1
TURN = 360.0
QUARTERS = {0.0: (1.0, 0.0), 90.0: (0.0, 1.0), 180.0: (-1.0, 0.0), 270.0: (0.0, -1.0)}
SPATIAL = {"SPA": "X", "SPB": "Y", "SPC": "Z"}
EULER = ("EULPR", "EULNU", "EULROT")
VECTOR = ("BX", "BY", "BZ", "NX", "NY", "NZ")
POINTS = tuple(f"P{n}{axis}" for n in "123" for axis in "XYZ")
WORDS = {"SPATIAL": tuple(SPATIAL), "EULER": EULER, "VECTOR": VECTOR, "POINTS": POINTS}
"""The words of each way to say a plane: all of them stand."""
EQUALLY_NEAR = (
    "of two attitudes that are equally near PLANE takes that in which {} is above 0, as the "
    "example of its manual does"
)
LIMITS = "say limits in [axis.{}] of the machine file, or SEQ+ or SEQ- in this line"


class TiltError(Exception):
    """Why a plane is not followed, and a way out."""

    def __init__(self, message: str, *hints: str) -> None:
        super().__init__(message)
        self.message, self.hints = message, hints


def matrix_of(kind: str, said: Mapping[str, float]) -> v.Floats:
    """Return the axes of a plane (3, 3), in columns. Raises TiltError."""
    if kind == "SPATIAL":
        a, b, c = (about(axis, said[word]) for word, axis in SPATIAL.items())
        return np.asarray(c @ b @ a)
    if kind == "EULER":
        first, second, third = (said[word] for word in EULER)
        return np.asarray(about("Z", first) @ about("X", second) @ about("Z", third))
    numbers = np.array([said[word] for word in WORDS[kind]]).reshape(-1, 3)
    if kind == "VECTOR":
        return _by_vectors(numbers[0], numbers[1])
    ahead, aside = numbers[1] - numbers[0], numbers[2] - numbers[0]
    return _by_vectors(ahead, np.cross(ahead, aside))


def _by_vectors(x: v.Floats, z: v.Floats) -> v.Floats:
    lengths = np.linalg.norm(x), np.linalg.norm(z)
    if min(lengths) < ALIKE:
        raise TiltError("PLANE by vectors or points that give no plane")
    x, z = x / lengths[0], z / lengths[1]
    if abs(float(x @ z)) > SQUARE:
        raise TiltError("PLANE VECTOR whose B is not square to N: what becomes of it is not known")
    x = x - z * float(x @ z)
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z])


def about(axis: str, angle: float) -> v.Floats:
    """Return the matrix (3, 3) of a right-handed turn about an axis, exact for quarters."""
    radians = math.radians(angle)
    cosine, sine = QUARTERS.get(angle % TURN, (math.cos(radians), math.sin(radians)))
    first, second = {"X": (1, 2), "Y": (2, 0), "Z": (0, 1)}[axis]
    matrix = np.eye(3)
    matrix[first, first] = matrix[second, second] = cosine
    matrix[first, second], matrix[second, first] = -sine, sine
    return matrix


def euler(matrix: v.Floats) -> tuple[float, float, float]:
    """Return the angles about Z, X and Z that go along, degrees, the second from 0 to 180."""
    (_, _, xz), (_, _, yz), (zx, zy, zz) = matrix.tolist()
    tilt = math.atan2(math.hypot(xz, yz), zz)
    if xz == yz == 0.0:
        first, last = 0.0, math.atan2(matrix[1, 0], matrix[0, 0])
    else:
        first, last = math.atan2(xz, -yz), math.atan2(zx, zy)
    return math.degrees(first), math.degrees(tilt), math.degrees(last)


class Attitude:
    """Chooses the attitude for a plane, by what the line says and where the axes stand.

    sign      "+", "-" or nothing;  middle: SYM says it, and not SEQ
    table     TABLE ROT: an axis that is free takes the turn of the plane; else the words do
    standing  where the axes stand, deg, those of which it is known
    by_example  whether two were equally near
    """

    def __init__(
        self, chain: v.Chain, sign: str, middle: bool, rot: str, standing: Mapping[str, float]
    ) -> None:
        self.chain, self.sign, self.middle, self.rot = chain, sign, middle, rot
        self.standing = standing
        self.master = chain.axes[0].letter
        self.by_example = False

    def angles(self, matrix: v.Floats) -> dict[str, float]:
        """Return the angles of the axes, degrees. Raises TiltError."""
        poses = v.poses(self.chain, matrix)
        if not poses.found:
            raise TiltError("in no attitude the tool stands on the plane")
        if poses.near:
            raise TiltError("the plane is so near to one with a free axis that no angle is certain")
        found = [self._freed(matrix, poses)] if poses.free else [p.angles for p in poses.found]
        reached = [each for pose in found if (each := self._reached(pose))]
        if not reached:
            raise TiltError("no attitude is within the limits of the axes")
        return self._signed(found, reached) if self.sign else self._nearest(reached)

    def _freed(self, matrix: v.Floats, poses: v.Poses) -> Mapping[str, float]:
        """Return the pose in which an axis is free: it stays, or takes the turn along."""
        free, stays = poses.free, self.standing.get(poses.free)
        level = poses.level.angles if poses.level else None
        angle = None if level is None else level[free]
        same = None not in (angle, stays) and abs(math.remainder(angle - stays, TURN)) <= ALIKE  # type: ignore[operator]
        if level is not None and (self.rot == "TABLE" or same):
            return level
        if self.rot == "TABLE" or stays is None:
            message = f"{free} is free in this plane, and where it then stands is not known"
            raise TiltError(message, f"say TABLE ROT, or turn {free} in a line before")
        if not self.rot:
            message = f"{free} is free in this plane: whether it turns no word says"
            raise TiltError(message, "say TABLE ROT or COORD ROT in this line")
        return {**poses.found[0].angles, free: stays}

    def _reached(self, pose: Mapping[str, float]) -> dict[str, list[float]]:
        """Return all turns of the axes of a pose within their limits; nothing if there are none."""
        turns = {axis: v.turns_of(self.chain, axis, angle) for axis, angle in pose.items()}
        return turns if all(turns.values()) else {}

    def _signed(
        self, found: Sequence[Mapping[str, float]], reached: Sequence[dict[str, list[float]]]
    ) -> dict[str, float]:
        """Return the attitude whose first axis has the sign."""
        if self.middle and abs(sum(pose[self.master] for pose in found)) > ALIKE:
            raise TiltError(f"SYM about another angle of {self.master} than 0")
        factor, fit = (1.0 if self.sign == "+" else -1.0), []
        for turns in reached:
            signed = [value for value in turns[self.master] if factor * value >= -ALIKE]
            fit += [{**turns, self.master: signed}] if signed else []
        if not fit:
            raise TiltError(f"no attitude with this sign of {self.master} is within its limits")
        if len(fit) > 1:
            raise TiltError(f"several attitudes have this sign of {self.master}")
        return self._settled(fit[0])

    def _nearest(self, reached: Sequence[dict[str, list[float]]]) -> dict[str, float]:
        """Return the attitude to which all axes have the shorter way."""
        for axis in self.chain.axes:
            if axis.limits is None and axis.wrap is None:
                letter = axis.letter
                message = f"which attitude PLANE takes depends on how far {letter} turns"
                raise TiltError(message, LIMITS.format(letter))
        if len(reached) == 1:
            return self._settled(reached[0])
        if lacks := [axis for axis in self.chain.letters if axis not in self.standing]:
            message = f"which attitude PLANE takes depends on where {lacks[0]} stands"
            raise TiltError(message, f"turn {lacks[0]} in a line before, or say SEQ+ or SEQ-")
        one, other = ([self._way(turns, a) for a in self.chain.letters] for turns in reached)
        ways = [(a - b) for a, b in zip(one, other, strict=True)]
        if all(abs(way) <= ALIKE for way in ways):
            self.by_example = True
            above = max(reached, key=lambda turns: max(turns[self.master]))
            return self._settled(above)
        if not (all(way <= ALIKE for way in ways) or all(way >= -ALIKE for way in ways)):
            message = "which of two attitudes is nearer depends on how the control counts ways"
            raise TiltError(message, "say SEQ+ or SEQ- in this line")
        return self._settled(reached[0 if sum(ways) < 0 else 1])

    def _way(self, turns: Mapping[str, Sequence[float]], axis: str) -> float:
        """Return how far an axis turns at least."""
        stands = self.standing[axis]
        if self.chain.axes[self.chain.letters.index(axis)].limits is None:
            return abs(math.remainder(turns[axis][0] - stands, TURN))
        return min(abs(value - stands) for value in turns[axis])

    def _settled(self, turns: Mapping[str, Sequence[float]]) -> dict[str, float]:
        """Return of each axis the turn nearest to where it stands, or to 0: all are one place."""
        found = {}
        for axis, values in turns.items():
            stands = self.standing.get(axis, 0.0)
            if self.chain.axes[self.chain.letters.index(axis)].limits is None and len(values) == 1:
                values = [values[0] + TURN * round((stands - values[0]) / TURN)]
            found[axis] = min(values, key=lambda value: abs(value - stands))
        return found
