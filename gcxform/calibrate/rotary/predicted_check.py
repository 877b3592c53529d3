"""The check of a rotary axis with RTCP on and the ball at rest, predicted from a covariance.

One axis turns, the others stand at 0, the spindle's dial stays on the ball. As in
`gcxform/calibrate/rotary/check.py`, but for unknowns as a bundle has them: two shifts and two tilts
across the axis.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from gcxform.calibrate.bundle.bundle import across
from gcxform.calibrate.rotary.axis import crossing
from gcxform.calibrate.rotary.check import dial
from gcxform.machine.chain import Rotary, turned
from gcxform.machine.machine import Axis
from gcxform.system.arrays import Floats

FAR = 1.0  # mm; an axis is not adjusted so badly


class Check(NamedTuple):
    """The dial at angles (n,): its sd with the axis found, and as it was before, mm."""

    degrees: Floats
    spread: Floats
    before: Floats


def predicted(
    before: Rotary, found: Rotary, covariance: Floats, ball: Floats, degrees: Floats
) -> Check:
    """Return the check of an axis with the covariance (4, 4) of its unknowns, mm and rad.

    `ball` (3,) is where the ball is with all axes at 0; for an axis of the head, the tip.
    """
    rows = (shown(found, ball, angle) for angle in degrees.tolist())
    spread = [math.sqrt(max(0.0, float(np.trace(row @ covariance @ row.T)))) for row in rows]
    shift = np.linalg.norm(dial(found, before, ball, degrees), axis=1)
    return Check(degrees, np.array(spread), shift)


def shown(axis: Rotary, ball: Floats, degrees: float) -> Floats:
    """Return what the unknowns of an axis do to the dial at an angle (3, 4)."""
    whole = np.full(3, axis.sign * degrees)
    rotation = turned(np.eye(3), axis.direction, whole).T
    lever = ball - np.array(axis.point)
    shift, turn = effects(axis)
    tilt = -crossing(rotation @ lever) + rotation @ crossing(lever)
    return np.hstack([(np.eye(3) - rotation) @ shift, tilt @ turn])


def effects(axis: Rotary) -> tuple[Floats, Floats]:
    """Return what the unknowns of an axis are in X, Y and Z: shifts (3, 2), and turns (3, 2)."""
    basis = across(axis)
    return basis.T, np.cross(axis.direction, basis).T


def spreads(axis: Rotary, covariance: Floats, number: int) -> tuple[Floats, Floats]:
    """Return the standard deviations of point (3,), mm, and direction (3,) of an axis.

    Of a `covariance` of the unknowns of several axes, those of this `number` are taken.
    """
    basis, first = across(axis).T, 4 * number
    parts = (slice(first, first + 2), slice(first + 2, first + 4))
    shift, tilt = (
        np.sqrt(np.diag(basis @ covariance[part, part] @ basis.T).clip(0.0)) for part in parts
    )
    return shift, tilt


def astray(letter: str, before: Rotary | Axis | None, point: Floats) -> Iterator[str]:
    """Yield how far a point (3,) mm is from the axis as it was, if that is no error of a machine.

    Such is a probe whose length is in the readings and was not told, or told and not in them.
    """
    if before is None or before.point is None or before.direction is None:
        return
    away = float(np.linalg.norm(np.cross(point - np.array(before.point), before.direction)))
    if away > FAR:
        yield (
            f"the axis {letter} is {away:.4g} mm from where the machine file has it; if it is not, "
            "look at the units, at the zero of X, Y and Z, and whether they are those of the tip "
            "or, with --tool, of the axes"
        )


def worded(check: Check, letter: str) -> str:
    """Return a check in words."""
    worst, was = int(check.spread.argmax()), int(check.before.argmax())
    return (
        f"check with RTCP on, the ball at rest, {letter} turned by {check.degrees[worst]:g} "
        f"degrees: the dial is predicted to read 0 +- {1e3 * check.spread[worst]:.3g} um; with the "
        f"axis as it was {1e3 * check.before[was]:.3g} um, at {check.degrees[was]:g} degrees"
    )
