"""The rigid-body model by homogeneous matrices: exact, slow, and without code of the package.

A chain is a word such as "XYFZ", from the workpiece to the tool, F the frame. Every axis is a map
x -> R(e)(x - a) + a + q u + d; an axis that moves the workpiece is, as the tool sees it, the same
map (reference/kinematics.md 1.4).
"""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

UNITS = dict(zip("XYZ", np.eye(3), strict=True))


def actual(chain, position, functions, pivots, tool):
    """Return the actual tip (3,) for one position; functions: axis -> (d (3,), e (3,))."""
    point = np.array(tool, dtype=float)
    for axis in reversed(chain.replace("F", "")):
        d, e = functions[axis](position["XYZ".index(axis)])
        a = pivots[axis]
        travel = position["XYZ".index(axis)] * UNITS[axis]
        point = Rotation.from_rotvec(e).apply(point - a) + a + travel + d
    return point
