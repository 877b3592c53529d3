"""How the tables of a machine stand so that the tool is square to a plane, and what is left of it.

A plane is a matrix (3, 3) whose columns are its axes X, Y and Z in the workpiece, with all rotary
axes at 0. In a pose its Z is that of the machine, and its X is turned from that of the machine by
the `spin`. Which of the poses a control takes is a matter of the control.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping

import numpy as np

from gcxform.machine.chain import Chain
from gcxform.machine.inverse import SLACK, TURN, Attitudes, State, attitudes
from gcxform.system.arrays import Floats
from gcxform.values import dataclass

LEVEL = 1e-9  # degrees that may be left of a spin
NEAR_POLE = 1e-2  # degrees: nearer to its direction an axis turns far for what rounding leaves


@dataclass(frozen=True)
class Pose:
    """Angles of axes by their letters, from above -180 up to 180 degrees, and the spin (deg)."""

    angles: Mapping[str, float]
    spin: float


@dataclass(frozen=True)
class Poses:
    """All poses for a plane; none where it cannot be reached.

    `free` is the axis whose angle is free in it, or nothing: it is at 0 in the first pose, and in
    `level` where no spin is left. `near`: it is almost free, so that no angle of it is certain.
    """

    found: tuple[Pose, ...]
    free: str = ""
    level: Pose | None = None
    near: bool = False


def poses(chain: Chain, plane: Floats) -> Poses:
    """Return the poses in which the tool is square to a plane (3, 3)."""
    found = attitudes(chain, plane[:, 2][None, :])
    state, tilt = State(int(found.state[0])), float(found.tilt[0])
    if state is State.UNREACHABLE:
        return Poses(())
    made = [_pose(chain, plane, angles) for angles in found.angle[0]]
    if state is State.POLE:
        assert found.free is not None
        return Poses((made[0],), chain.letters[found.free], _level(chain, plane, found))
    near = min(tilt, 180.0 - tilt) < NEAR_POLE and len(chain.axes) > 1
    if len(made) > 1 and made[0].angles == made[1].angles:
        made = made[:1]
    return Poses(tuple(made), near=near)


def _level(chain: Chain, plane: Floats, found: Attitudes) -> Pose | None:
    """Return the pose in which the axis that is free has taken the spin along."""
    angles = np.array(found.angle[0, 0])
    free = found.free
    for way in (1.0, -1.0):
        turned = angles.copy()
        turned[free] += way * spin(carried(chain, plane, angles))
        made = _pose(chain, plane, turned)
        if abs(made.spin) <= LEVEL:
            return made
    return None


def _pose(chain: Chain, plane: Floats, angles: Floats) -> Pose:
    within = -np.remainder(-angles + TURN / 2, TURN) + TURN / 2
    named = dict(zip(chain.letters, map(float, within), strict=True))
    return Pose(named, spin(carried(chain, plane, angles)))


def turns_of(chain: Chain, letter: str, angle: float) -> list[float]:
    """Return an angle (deg) with all full turns that are within the limits of its axis.

    Without limits it is the angle alone.
    """
    axis = chain.axes[chain.letters.index(letter)]
    if axis.limits is None:
        return [angle]
    low, high = axis.limits
    first = angle + TURN * np.ceil((low - SLACK - angle) / TURN)
    steps = itertools.takewhile(lambda each: each <= high + SLACK, itertools.count(first, TURN))
    return [float(min(max(each, low), high)) for each in steps]


def carried(chain: Chain, matrix: Floats, angles: Floats) -> Floats:
    """Return directions (3, 3), in columns, as the table carries them."""
    points = chain.onto_machine(np.vstack([matrix.T, np.zeros(3)]), np.tile(angles, (4, 1)))
    return np.asarray((points[:3] - points[3]).T)


def spin(turned: Floats) -> float:
    """Return by how much the X of a plane is turned from that of the machine, degrees."""
    return float(np.degrees(np.arctan2(turned[1, 0], turned[0, 0])))
