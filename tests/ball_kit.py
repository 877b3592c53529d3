"""Ball centres for the tests of calibration: circles of known axes, clean and with noise."""

from __future__ import annotations

import math

import numpy as np

from gcxform.calibrate.rotary.axis import Centres
from gcxform.machine.chain import Rotary
from gcxform.simulate.balls import simulate_balls
from gcxform.system.arrays import Floats

CENTRE = np.array((102.532, 51.230, 128.947))  # of the published simulation, mm
NOISE = 0.01
UPRIGHT = Rotary("C", (0.0, 0.0, 1.0), (102.532, 51.230, 128.947), 1)


def off(x: float, y: float = 0.0, z: float = 0.0) -> Floats:
    """Return a place (3,) beside the centre."""
    return np.asarray(CENTRE + np.array((x, y, z)))


def around(count: int, degrees: float = 360.0) -> Floats:
    """Return angles all around, or on an arc with both of its ends."""
    return np.linspace(0.0, degrees, count, endpoint=degrees < 360.0)


def measured(
    count: int, arc: float = 360.0, radius: float = 261.0, circles: int = 2000, seed: int = 0
) -> Floats:
    generator = np.random.default_rng(seed)
    ball = off(radius)
    angles = around(count, arc)
    return simulate_balls(UPRIGHT, ball, angles, noise=NOISE, circles=circles, generator=generator)


def rms(vectors: Floats) -> float:
    return math.sqrt((vectors**2).sum(axis=-1).mean())


def skew(sign: int = 1, letter: str = "A") -> Rotary:
    """Return an axis that points nearly along X, anywhere."""
    direction = np.array((1.0, -0.0021, 0.0043))
    x, y, z = (direction / np.linalg.norm(direction)).tolist()
    return Rotary(letter, (x, y, z), (5.013, -32.017, -95.032), sign)


def clean(axis: Rotary, degrees: Floats, noise: float = 0.0) -> Centres:
    points = simulate_balls(axis, (40.0, 60.0, -80.0), degrees, noise=noise)
    return Centres(np.asarray(degrees, float), points)
