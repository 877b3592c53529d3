"""What a measured rotary axis is good for: the check afterwards, warnings, and what to do next.

The check turns the axis with RTCP on while the ball is at rest and the spindle's dial on it. Where
the control believes an axis T + d(T) with the direction V + w x V, the dial shows, from where it
was set to zero,

    (I - R) d(T) + w x R l - R (w x l)

with l from the axis to the ball there: over half a turn twice the error across the axis, and
nothing of an error along it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from gcxform.calibrate.rotary.axis import (
    HOPELESS,
    ILL,
    UNKNOWNS,
    Placed,
    arc,
    condition,
    crossing,
    distinct,
    jacobian,
    without_each,
)
from gcxform.machine.chain import Rotary, turned
from gcxform.machine.machine import Axis
from gcxform.system.arrays import Floats

TURN: Final = 360.0
GRID: Final = 5.0  # degrees
FEW: Final = 5
"""Fewer centres than this leave little to find a bad one by."""


def rotary_of(found: Placed, letter: str) -> Rotary:
    """Return the axis as it was found."""
    direction, point = (tuple(map(float, v)) for v in (found.direction, found.point))
    return Rotary(letter, direction, point, found.sign)  # type: ignore[arg-type]


def axis_of(found: Placed) -> Axis:
    """Return what a machine file says of the axis that was found."""
    axis = rotary_of(found, "")
    return Axis(direction=axis.direction, point=axis.point, sign=axis.sign)


def dial_spread(found: Placed, degrees: Floats) -> Floats:
    """Return the standard deviations (n,), mm, of what the check shows at angles from its zero."""
    moves, axis, lever = found.moves[:3], found.direction, standing(found)
    turn = np.hstack([np.zeros((3, 3)), np.eye(3), np.zeros((3, 1))])
    turn = turn - np.outer(axis, axis) @ turn  # about the axis itself: the zero, no error
    spread = []
    for angle in np.asarray(degrees, np.float64).tolist():
        whole = np.full(3, found.sign * angle)
        x, y, z = axis.tolist()
        rotation = turned(np.eye(3), (x, y, z), whole).T
        tilt = -crossing(rotation @ lever) + rotation @ crossing(lever)
        effect = (np.eye(3) - rotation) @ moves + tilt @ turn
        spread.append(math.sqrt(max(0.0, float(np.trace(effect @ found.of_unknowns @ effect.T)))))
    return np.array(spread)


def dial(true: Rotary, believed: Rotary, ball: Floats, degrees: Floats) -> Floats:
    """Return the vectors (n, 3), mm, that the check shows where the control believes an axis.

    `ball` is its centre where the dial is set to zero; the angles (n,) are counted from there.
    """
    places = np.tile(ball, (len(degrees), 1))
    return np.asarray(believed.turn(places, degrees) - true.turn(places, degrees))


def checked_angles(found: Placed) -> Floats:
    """Return the angles (n,) of a check at the measured positions, zero at the first, degrees."""
    degrees = found.centres.degrees
    return np.asarray(np.unique((degrees - degrees[0]).round(9)))


def standing(found: Placed) -> Floats:
    """Return from the point on the axis to the ball at the first position, (3,), mm."""
    arm = found.figure.arms(found.centres.degrees[:1])[0]
    return np.asarray(arm if found.tip is None else -arm)


# --- what is to be said ---


def warnings(found: Placed) -> Iterator[str]:
    """Yield what whoever believes the result has to know."""
    count = int(found.kept.sum())
    if count == 3:
        yield (
            "no redundancy: a circle goes through any three points, and nothing but the angles "
            "tests these; the result is unverified"
        )
    yield from found.scatter.warnings
    if found.condition > ILL:
        yield (
            f"badly conditioned: {found.condition:.0f} (above {ILL:.0f} is poor, above "
            f"{HOPELESS:.0f} is refused), because the arc is {arc(found.centres.degrees):.3g} "
            "degrees"
        )
    for row in np.flatnonzero(~found.kept):
        yield (
            f"outlier, left out: {named(found, int(row))} is off by "
            f"{1e3 * float(np.linalg.norm(found.residuals[row])):.3g} um, "
            f"{found.standardised[row]:.1f} standard deviations"
        )
    if count >= FEW:
        yield from _one_decides(found)


def _one_decides(found: Placed) -> Iterator[str]:
    """Yield which centre moves the point by more than it could by its noise."""
    moved = np.linalg.norm(without_each(found)[0], axis=1)
    limit = 4.0 * math.sqrt(float(np.trace(found.covariance[:3, :3])))
    if np.isfinite(moved).any() and np.nanmax(moved) > limit:
        row = int(np.nanargmax(moved))
        yield f"without {named(found, row)} the point moves by {1e3 * moved[row]:.3g} um"


def named(found: Placed, row: int) -> str:
    """Return a centre in words: its row, line and angle."""
    where = found.centres.where(row)
    line = "" if where is None else f" (line {where.line})"
    return f"centre {row + 1}{line} at {found.centres.degrees[row]:g} degrees"


def advice(found: Placed, limits: tuple[float, float] | None = None) -> Iterator[str]:
    """Yield what makes the next measurement better, most useful first; limits in degrees."""
    degrees = found.centres.degrees[found.kept]
    covered = arc(degrees)
    room = TURN if limits is None else min(TURN, limits[1] - limits[0])
    across, tilt = _across(found), _tilt(found)
    if covered < min(270.0, room - GRID):
        best = found.scatter.effective * math.sqrt(2.0 / len(degrees)) if room >= TURN else None
        gain = "" if best is None else f" (all around it would be {two_digits(1e3 * best)} um)"
        yield (
            f"the arc is {covered:.3g} of {room:.3g} degrees: a longer one helps most; across the "
            f"axis the point is known to {two_digits(1e3 * across)} um{gain}"
        )
    if len(degrees) < FEW:
        yield f"{len(degrees)} centres: with {FEW} or more a bad one shows, and is named"
    yield (
        f"four times as many centres halve every uncertainty: {len(degrees)} give "
        f"{two_digits(1e3 * across)} um and {two_digits(1e6 * tilt)} urad"
    )
    yield (
        f"the direction is known to {two_digits(1e6 * tilt)} urad with the ball at "
        f"{found.figure.radius:.4g} mm; that goes with 1 / radius, so put the ball further out"
    )
    yield f"measure next at {next_angle(found, limits):g} degrees: no other position tells more"


def two_digits(value: float) -> str:
    """Return an uncertainty in words."""
    return f"{float(f'{value:.2g}'):g}"


def _across(found: Placed) -> float:
    """Return the largest standard deviation of the point across the axis, mm."""
    along = np.outer(found.direction, found.direction)
    flat = (np.eye(3) - along) @ found.covariance[:3, :3] @ (np.eye(3) - along)
    return math.sqrt(float(np.linalg.eigvalsh(flat)[-1]))


def _tilt(found: Placed) -> float:
    """Return the largest standard deviation of the direction, rad."""
    return math.sqrt(float(np.linalg.eigvalsh(found.covariance[3:, 3:])[-1]))


def next_angle(found: Placed, limits: tuple[float, float] | None = None) -> float:
    """Return the angle, of every fifth degree, whose centre takes most off the uncertainty.

    That is of the point, and of the direction at the radius of the ball.
    """
    low, high = limits or (0.0, TURN - GRID)
    candidates = np.arange(math.ceil(low / GRID), math.floor(high / GRID) + 1) * GRID
    if not len(candidates):
        candidates = np.array([low, high])
    known = np.linalg.inv(found.of_unknowns)
    worth = np.diag([1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0])
    across = np.eye(3) - np.outer(found.direction, found.direction)
    worth[3:6, 3:6] = found.figure.radius**2 * across
    left = []
    for row in jacobian(found.figure, np.asarray(candidates, np.float64)):
        more = np.linalg.inv(known + row.T @ row / found.scatter.effective**2)
        left.append(float(np.trace(worth @ more)))
    return float(candidates[int(np.argmin(np.round(left, 15)))])


def harmonics(found: Placed) -> dict[str, list[float]] | None:
    """Return amplitudes, mm, of the first two harmonics of the residuals; None of few centres.

    The second one of the radial residuals tells of squareness and scales of the linear axes, the
    first one of the axial residuals of an axis that wobbles.
    """
    degrees = found.centres.degrees[found.kept]
    if distinct(degrees) < UNKNOWNS or condition(degrees) > ILL:
        return None
    q = np.radians(degrees)
    rows = np.column_stack([np.cos(q), np.sin(q), np.cos(2 * q), np.sin(2 * q)])
    parts = components(found)[found.kept]
    fit = np.linalg.lstsq(rows, parts, rcond=None)[0].reshape(2, 2, 3)
    sizes = np.linalg.norm(fit, axis=1)
    return {name: sizes[:, k].tolist() for k, name in enumerate(("radial", "tangential", "axial"))}


def components(found: Placed) -> Floats:
    """Return the residuals (n, 3) away from the axis, in the sense of +, and along it, mm."""
    outwards = found.figure.arms(found.centres.degrees) / found.figure.radius
    axis = found.figure.direction
    frame = np.stack(
        [outwards, np.cross(axis, outwards), np.tile(found.direction, (len(outwards), 1))]
    )
    return np.asarray(np.einsum("knj,nj->nk", frame, found.residuals))
