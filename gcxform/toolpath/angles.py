"""How far arcs turn: angles between two points of a circle, in its sense."""

from __future__ import annotations

import numpy as np

from gcxform.system.arrays import Floats

TURN = 2 * np.pi
SAME_POINT = 1e-9  # mm; closer points of an arc's plane are one point
SAME_ANGLE = 1e-6  # rad; LinuxCNC takes an arc that turns by less for a full circle


def swept(start: Floats, end: Floats, sense: Floats) -> Floats:
    """Return the angle (rad) from 0 to a full turn between radius vectors (n, 2), by the sense.

    Vectors to one and the same point make a full turn.
    """
    cross = start[:, 0] * end[:, 1] - start[:, 1] * end[:, 0]
    dot = start[:, 0] * end[:, 0] + start[:, 1] * end[:, 1]
    angle = np.mod(np.arctan2(cross * sense, dot), TURN)
    same = (np.hypot(*(end - start).T) < SAME_POINT) | (angle < SAME_ANGLE)
    return np.where(same, TURN, angle)
