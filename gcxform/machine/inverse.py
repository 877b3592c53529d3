"""Inverse kinematics: the positions of the axes that give a tip and a tool axis, all of them.

Two axes w1 (next to the workpiece on the way to the tool) and w2 turn the spindle a0 into the tool
axis k. Tool axis and a0 make a spherical triangle with them: its sides are a from a0 to w2, b from
w1 to w2, and the tilt t from k to w1; the angle psi between a and b is that of the second axis,
measured from where a0 is nearest to w1. By the half-angle formulas

    sin(psi/2)^2 ~ sin((t + a - b)/2) sin((t - a + b)/2)
    cos(psi/2)^2 ~ sin((a + b + t)/2) sin((a + b - t)/2)

so psi is precise everywhere, where a cosine loses half of the digits near the pole. Of the closed
forms of particular machines each is this one with its a and b: a = b = 90 degrees gives psi = t for
trunnions and forks, a = b = nu gives sin(psi/2) = sin(t/2)/sin(nu) for nutating axes; and
calibrated axes, square to nothing, need no other. Outside of the triangle the products are
negative; psi is then 0 or 180 degrees, which is the attitude nearest to what was asked.

A result is reached, at the pole (one angle is free), at the border (both attitudes are one), or
unreachable (then `miss` is how far the nearest attitude is). `inverse` adds the turns within
limits, and X, Y and Z with theirs.
"""

from __future__ import annotations

import enum
import itertools
import math

import numpy as np

from gcxform.diagnostics import UsageError
from gcxform.machine.chain import EVERYWHERE, SPINDLE, Chain, Rotary, Triple, turned
from gcxform.system.arrays import Bytes, Flags, Floats
from gcxform.values import dataclass

TOLERANCE = 1e-9  # degrees; a tip of a tool of 100 mm is then off by 2e-9 mm
SLACK = 1e-9  # degrees and mm that rounding may take a position beyond a limit
PARALLEL = 1e-6  # sine between axes below which they are one axis
TURN = 360.0


class State(enum.IntEnum):
    """Whether a tool axis can be reached."""

    REACHED = 0
    """By two attitudes; by one if there are less than two rotary axes."""
    POLE = 1
    """It lies along the first rotary axis, whose angle is free."""
    BORDER = 2
    """It is at the end of what can be reached, where both attitudes are one."""
    UNREACHABLE = 3
    """No attitude gives it; the angles are those of the nearest tool axis."""


@dataclass(frozen=True)
class Attitudes:
    """The angles for n tool axes, in b branches, as commanded and above -180, up to 180 degrees.

    `angle` is (n, b, m) in the order of `Chain.letters`; the first branch has the greater angle of
    the second axis. `state` (n,) are numbers of `State`. `miss` (n,) are the degrees to the nearest
    tool axis that can be reached, and `tilt` (n,) those between tool axis and first rotary axis.
    `free` is the column of the axis whose angle is free at the pole; there it is 0, or the limit
    nearest to 0.
    """

    angle: Floats
    state: Bytes
    miss: Floats
    tilt: Floats
    free: int | None


@dataclass(frozen=True)
class Poses:
    """All positions for n tips and tool axes: c candidates each, of which some are within limits.

    `linear` (n, c, 3) in mm, `angle` (n, c, m) in degrees, `allowed` (n, c).
    """

    linear: Floats
    angle: Floats
    allowed: Flags
    attitudes: Attitudes


def inverse(chain: Chain, tip: Floats, axis: Floats, tolerance: float = TOLERANCE) -> Poses:
    """Return all positions that bring the tip to points (n, 3) with tool axes (n, 3).

    Points and vectors are in the frame of the workpiece. Candidates are the branches, each with all
    turns that the limits allow. What is farther from any attitude than `tolerance` (degrees) is
    unreachable, and none of its candidates is allowed. Raises UsageError as `attitudes` does.
    """
    found = attitudes(chain, axis, tolerance)
    angle, allowed = turns(chain, found.angle)
    linear = chain.linear(tip[:, None, :], angle)
    low, high = np.array(chain.travel).T
    allowed &= ((linear >= low - SLACK) & (linear <= high + SLACK)).all(axis=-1)
    allowed &= (found.state != State.UNREACHABLE)[:, None]
    return Poses(linear, angle, allowed, found)


def turns(chain: Chain, angle: Floats) -> tuple[Floats, Flags]:
    """Return angles (n, b, m) with full turns added, (n, c, m), and which are within limits (n, c).

    An axis without limits may be a full turn away from what is returned, to either side.
    """
    count = [_full_turns(axis) for axis in chain.axes]
    steps = TURN * np.array([*itertools.product(*map(range, count))], np.float64)
    spans = [axis.limits or EVERYWHERE for axis in chain.axes]
    low, high = np.array(spans).reshape(len(spans), 2).T
    lowest = np.where(np.isfinite(low), low - SLACK, angle)
    first = angle + TURN * np.ceil((lowest - angle) / TURN)
    found = (first[:, :, None, :] + steps).reshape(len(angle), -1 if count else 1, len(count))
    allowed = np.asarray((found <= high + SLACK).all(axis=-1))
    return np.where(allowed[..., None], np.clip(found, low, high), found), allowed


def _full_turns(axis: Rotary) -> int:
    """Return how many angles that are full turns apart may be within the limits of an axis."""
    low, high = axis.limits or (0.0, 0.0)
    return 1 + int((high - low + 2.0 * SLACK) // TURN)


# --- tool axes to angles ---


@dataclass(frozen=True)
class _Turn:
    """An axis as it turns the tool, seen from the workpiece: a command counts `factor` times."""

    column: int
    direction: Triple
    factor: int


def attitudes(chain: Chain, axis: Floats, tolerance: float = TOLERANCE) -> Attitudes:
    """Return the angles which give tool axes (n, 3), of any length, in the workpiece's frame.

    Raises UsageError for a chain of more than two rotary axes, or of two that do the same, and
    ValueError for a vector without length.
    """
    length = np.linalg.norm(axis, axis=-1, keepdims=True)
    if not (np.isfinite(length) & (length > 0.0)).all():
        raise ValueError("a tool axis needs a length")
    loop = _loop(chain)
    free = loop[0].column if loop else None
    first = loop[0].direction if loop else SPINDLE
    unit = axis / length
    tilt = _between(unit, first)
    if len(loop) == 2:
        angle, miss, border = _by_two(loop[0], loop[1], unit, tilt)
    else:
        angle, miss, border = _by_one(loop, unit, tilt)
    pole = (np.sin(tilt) <= math.radians(TOLERANCE)) & (free is not None)
    if free is not None:
        low, high = chain.axes[free].limits or (0.0, 0.0)
        angle[pole, :, free] = min(max(0.0, low), high)
    state = np.select(
        [miss > math.radians(tolerance), pole, border <= math.radians(TOLERANCE)],
        [State.UNREACHABLE, State.POLE, State.BORDER],
        State.REACHED,
    ).astype(np.uint8)
    principal = -np.remainder(-angle + TURN / 2, TURN) + TURN / 2
    degrees = (np.degrees(miss), np.degrees(tilt))
    return Attitudes(np.where(pole[:, None, None], angle, principal), state, *degrees, free)


def _loop(chain: Chain) -> list[_Turn]:
    """Return the axes on the way from the workpiece to the tool."""
    table = [_Turn(k, axis.direction, -axis.sign) for k, axis in enumerate(chain.table)]
    first = len(chain.table)
    head = [_Turn(k, axis.direction, axis.sign) for k, axis in enumerate(chain.head, first)]
    loop = table[::-1] + head
    if len(loop) > 2:
        letters = ", ".join(chain.letters)
        hint = "give the angles of the axes; or take one that stands still out of the machine file"
        message = f"angles of the tool axis are not found for the {len(loop)} axes {letters}"
        raise UsageError.one("GX453", message, hint=hint)
    ends = [turn.direction for turn in loop] + [SPINDLE] * (len(loop) == 2)
    if any(_sine(one, other) < PARALLEL for one, other in itertools.pairwise(ends)):
        message = f"the axes {' and '.join(chain.letters)} cannot give the tool two directions"
        raise UsageError.one("GX453", f"{message}: an axis is parallel to the next, or to the tool")
    return loop


def _by_two(one: _Turn, two: _Turn, axis: Floats, tilt: Floats) -> tuple[Floats, Floats, Floats]:
    """Return angles (n, 2, m) in degrees, miss (n,) and distance to the border (n,) in rad."""
    spindle = np.array(SPINDLE)
    a = float(_between(spindle, two.direction))
    b = float(_between(np.array(one.direction), two.direction))
    least, most = abs(a - b), min(a + b, 2.0 * math.pi - a - b)
    corner = np.degrees(_corner(a, b, tilt))
    nearest = _azimuth(np.array(one.direction), two.direction, SPINDLE)
    angle = np.empty((len(axis), 2, 2))
    for branch, side in enumerate((two.factor, -two.factor)):
        second = nearest + side * corner
        carried = turned(np.broadcast_to(spindle, axis.shape), two.direction, second)
        first = _azimuth(axis, one.direction) - _azimuth(carried, one.direction)
        angle[:, branch, two.column] = two.factor * second
        angle[:, branch, one.column] = one.factor * first
    miss = np.maximum(np.maximum(least - tilt, tilt - most), 0.0)
    return angle, miss, np.minimum(np.abs(tilt - least), np.abs(tilt - most))


def _by_one(loop: list[_Turn], axis: Floats, tilt: Floats) -> tuple[Floats, Floats, Floats]:
    """Return the same for one axis, or none: one branch, and no border."""
    angle = np.zeros((len(axis), 1, len(loop)))
    fixed = np.zeros(1)
    for turn in loop:
        spindle = np.array([SPINDLE])
        fixed = _between(spindle, turn.direction)
        if math.sin(fixed[0]) > PARALLEL:
            own = _azimuth(axis, turn.direction) - _azimuth(spindle, turn.direction)
            angle[:, 0, turn.column] = turn.factor * own
    return angle, np.abs(tilt - fixed), np.full(len(axis), math.pi)


def _corner(a: float, b: float, tilt: Floats) -> Floats:
    """Return the angle (n,) of a spherical triangle between its sides a and b, rad."""
    sine = np.sin((tilt + a - b) / 2.0) * np.sin((tilt - a + b) / 2.0)
    cosine = np.sin((a + b + tilt) / 2.0) * np.sin((a + b - tilt) / 2.0)
    return np.asarray(
        2.0 * np.arctan2(np.sqrt(np.maximum(sine, 0.0)), np.sqrt(np.maximum(cosine, 0.0)))
    )


def _between(vectors: Floats, direction: Triple) -> Floats:
    """Return the angles (...) of vectors (..., 3) to a direction, 0 to pi rad."""
    across = np.linalg.norm(np.cross(vectors, direction), axis=-1)
    return np.asarray(np.arctan2(across, vectors @ np.array(direction)))


def _sine(one: Triple, other: Triple) -> float:
    return float(np.linalg.norm(np.cross(one, other)))


def _azimuth(vectors: Floats, direction: Triple, start: Triple | None = None) -> Floats:
    """Return the angles (...) of vectors (..., 3) about a direction from some start, degrees."""
    axis = np.array(direction)
    zero = np.array(start) if start else np.eye(3)[np.argmin(np.abs(axis))]
    right = np.cross(axis, zero)
    ahead = np.cross(right, axis)
    return np.asarray(np.degrees(np.arctan2(vectors @ right, vectors @ ahead)))
