"""Centres of a ball as a rotary axis of known direction and point carries it, as probed.

A ball on the table is probed in the spindle at each angle q: p = T + R(V, sign q) (b - T), with b
the place of the ball at 0. Noise is that of each coordinate of a centre.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from gcxform.machine.chain import Rotary
from gcxform.machine.errors import FloatArray


def simulate_balls(
    axis: Rotary,
    ball: npt.ArrayLike,
    degrees: npt.ArrayLike,
    *,
    noise: float = 0.0,
    circles: int | None = None,
    generator: np.random.Generator | None = None,
) -> FloatArray:
    """Return centres (n, 3), mm, at angles (n,); with `circles` as many measurements (m, n, 3).

    Without `generator` the noise is the same every time.
    """
    generator = generator or np.random.default_rng(0)
    angles = np.asarray(degrees, np.float64)
    places = np.tile(np.asarray(ball, np.float64), (len(angles), 1))
    ideal = axis.turn(places, angles)
    shape = ideal.shape if circles is None else (circles, *ideal.shape)
    return np.asarray(ideal + noise * generator.standard_normal(shape))
