"""The reference frame of nine functions: end points (LDDM, ISO 230-1).

A machine that is shifted or turned as a whole cuts the same parts, so nine functions are told up
to a rigid motion, and somebody has to say which. In the *end-point frame* the error is zero at
the low corner of the volume, and EYX, EZX and EZY end at zero: the axis X goes through both ends
of its line, and the far end of the axis Y lies in the plane XY. Squareness then stands in EXY, EXZ
and EYZ, whose end slopes are -C0Y, +B0Z and -A0Z.

The frame is reached by one turn theta of everything, E + theta x (p - corner). A slope that leaves
EYX is thereby added to EXY: taking it away alone would change the squareness.
"""

from __future__ import annotations

import numpy as np

from gcxform.system.arrays import Floats

FRAME = (
    "end points: the error is zero at the low corner, and EYX, EZX and EZY end at zero; "
    "squareness is in EXY, EXZ and EYZ"
)


def turn_of(slopes: Floats) -> Floats:
    """Return the turn theta (..., 3) in rad that brings end slopes into the end-point frame.

    `slopes` (..., 3, 3) are mm per mm: moving axis, then direction of the error.
    """
    about_z = -slopes[..., 0, 1]
    about_y = slopes[..., 0, 2]
    about_x = -slopes[..., 1, 2]
    return np.stack((about_x, about_y, about_z), axis=-1)


def slopes_of(turn: Floats) -> Floats:
    """Return the slopes (..., 3, 3) that a turn (..., 3) in rad gives: theta x u of each axis u."""
    slopes: Floats = np.cross(turn[..., None, :], np.eye(3))
    return slopes
