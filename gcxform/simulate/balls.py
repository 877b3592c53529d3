"""Centres of a ball as a rotary axis of known direction and point carries it, as probed.

A ball on the table is probed in the spindle at each angle q: p = T + R(V, sign q) (b - T), with b
the place of the ball at 0. Noise is that of each coordinate of a centre.

Of a whole machine the readings are where X, Y and Z stand when the tip of the probe is at the
centre: what the chain says, less the error of the linear axes.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from gcxform.calibrate.bundle.bundle import Poses
from gcxform.diagnostics import UsageError
from gcxform.errormodel.model import ErrorModel, compensate
from gcxform.machine.chain import Chain, Rotary
from gcxform.system.arrays import Floats


def simulate_balls(
    axis: Rotary,
    ball: npt.ArrayLike,
    degrees: npt.ArrayLike,
    *,
    noise: float = 0.0,
    circles: int | None = None,
    generator: np.random.Generator | None = None,
) -> Floats:
    """Return centres (n, 3), mm, at angles (n,); with `circles` as many measurements (m, n, 3).

    Without `generator` the noise is the same every time.
    """
    generator = generator or np.random.default_rng(0)
    angles = np.asarray(degrees, np.float64)
    places = np.tile(np.asarray(ball, np.float64), (len(angles), 1))
    ideal = axis.turn(places, angles)
    shape = ideal.shape if circles is None else (circles, *ideal.shape)
    return np.asarray(ideal + noise * generator.standard_normal(shape))


def simulate_poses(
    true: Chain,
    plan: Poses,
    model: ErrorModel | None = None,
    *,
    noise: float = 0.0,
    generator: np.random.Generator | None = None,
) -> Poses:
    """Return what is read at the poses of a plan on the machine as it is; noise in mm.

    A ball is where the true machine has it when its first row of the plan is reached; `model` is
    the error of the linear axes. Raises UsageError for positions beyond the model (GX738).
    """
    generator = generator or np.random.default_rng(0)
    tips = true.tip_at(plan.points, plan.degrees)
    balls = np.array([tips[plan.ball.index(name)] for name in plan.balls])
    stands = true.linear(balls[plan.index], plan.degrees)
    if model is not None:
        if model.outside(stands).any():
            raise UsageError.one("GX738", "a ball is beyond the error model of the machine")
        stands = compensate(model, stands).position
    return replace(plan, points=stands + noise * generator.standard_normal(stands.shape))
