"""Where a probe gets to a ball and to nothing else, and how high it has to be to turn.

The touches and the ways between them are in the half-space of the ball that the probe comes out of,
and a post that leans from it by less than a right angle is in the other one. A probe that comes
down along Z and leaves along Z stays in its half-space, as long as neither it nor the table hangs
over. Of other balls it is kept away as if it went on for ever behind its tip, and their posts
below them. While the axes turn, each in its own time, the tip stands above all balls at whatever
angles there are on the way.

Angles (n, m) are degrees, places of balls are those of the workpiece, and lengths are mm.

All of this is decided by bounds, and not by samples alone.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from gcxform.machine.chain import SPINDLE, Chain, Rotary, Triple
from gcxform.system.arrays import Flags, Floats

STEP: Final = 1.0  # degrees between the angles at which heights are looked at
HANGING: Final = -0.02
"""The height of a unit vector along the probe below which the spindle is lower than the tip."""
SUBSETS: Final = ((0,), (1,), (2,), (0, 1), (0, 2), (1, 2), (0, 1, 2))


def upright(chain: Chain, degrees: Floats, tilt: float) -> Flags:
    """Return where table and probe lean no farther than by a tilt, from Z and from each other."""
    leaning = [chain.tool_axis(degrees), chain.spindle(degrees), chain.upwards(degrees)]
    least = np.min([vectors[:, 2] for vectors in leaning], axis=0)
    return np.asarray(least >= math.cos(math.radians(tilt)) - 1e-12)


def inside(chain: Chain, stands: Floats, degrees: Floats, room: float) -> Flags:
    """Return for which positions (n, 3) X, Y and Z have room all around a ball, and before it.

    Around is across the probe, and before it is along the probe towards the spindle.
    """
    low, high = np.array(chain.travel).T
    along = chain.spindle(degrees)
    around = np.sqrt((1.0 - along**2).clip(0.0))
    below, above = room * (around + (-along).clip(0.0)), room * (around + along.clip(0.0))
    return np.asarray(((stands >= low + below) & (stands <= high - above)).all(axis=1))


def clear(chain: Chain, balls: Sequence[Triple], number: int, degrees: Floats, gap: float) -> Flags:
    """Return at which angles a probe that comes down to a ball stays a gap away from the others."""
    along, up = chain.spindle(degrees), chain.upwards(degrees)
    ways = np.stack([along, np.broadcast_to(np.array(SPINDLE), along.shape), up], axis=2)
    places = [chain.onto_machine(np.tile(ball, (len(degrees), 1)), degrees) for ball in balls]
    good = np.ones(len(degrees), dtype=bool)
    for other in places[:number] + places[number + 1 :]:
        good &= _from_cone(ways, other - places[number]) >= gap
    return good


def _from_cone(ways: Floats, goals: Floats) -> Floats:
    """Return how far goals (n, 3) are from all sums of ways (n, 3, columns), none backwards.

    The nearest sum is the nearest of all sums of those ways that it needs.
    """
    nearest = np.linalg.norm(goals, axis=1)
    for subset in SUBSETS:
        part = ways[:, :, list(subset)]
        shares = np.linalg.pinv(part) @ goals[:, :, None]
        left = np.linalg.norm(goals - (part @ shares)[:, :, 0], axis=1)
        possible = (shares[:, :, 0] >= 0.0).all(axis=1)
        nearest = np.where(possible, np.minimum(nearest, left), nearest)
    return np.asarray(nearest)


# --- turning ---


def hangs(chain: Chain, degrees: Floats) -> bool:
    """Return whether the spindle may be below the tip on the way between some angles."""
    return bool(chain.spindle(_between(chain, degrees, chain.head))[:, 2].min() < HANGING)


def least_height(chain: Chain, balls: Floats, degrees: Floats, room: float) -> float:
    """Return the Z from which on the tip has room above all balls (b, 3), at angles and between."""
    tips = chain.arm(_between(chain, degrees, chain.head))[:, 2]
    lowest = float(tips.min()) - _bend(chain.head, [chain.tip])
    angles = _between(chain, degrees, chain.table)
    heights = [chain.onto_machine(np.tile(b, (len(angles), 1)), angles)[:, 2] for b in balls]
    highest = float(np.max(heights)) + _bend(chain.table, balls.tolist())
    return highest + room - lowest


def _between(chain: Chain, degrees: Floats, axes: Sequence[Rotary]) -> Floats:
    """Return angles (k, m) in every combination that some axes may pass, 0 too; the others at 0."""
    every = []
    for k, axis in enumerate(chain.axes):
        low, high = min(0.0, degrees[:, k].min()), max(0.0, degrees[:, k].max())
        if axis.limits is None or axis.wrap is not None:  # the other way around may be shorter
            low, high = low, max(high, low + 360.0)
        count = math.ceil((high - low) / STEP) + 1
        every.append(np.linspace(low, high, count).tolist() if axis in axes else [0.0])
    return np.array([*itertools.product(*every)])


def _bend(axes: Sequence[Rotary], points: Sequence[Sequence[float]]) -> float:
    """Return how far a height may be beyond those at steps: of each axis step^2 / 8 times its arm.

    The second derivative along an angle is at most the distance from its axis; all of that was
    moved by other axes before is at most as far from the origin as `reach`.
    """
    reach = max(math.hypot(*p) for p in points) + 2.0 * sum(math.hypot(*a.point) for a in axes)
    return len(axes) * reach * math.radians(STEP) ** 2 / 8.0
