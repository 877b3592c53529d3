"""How well a circle of ball centres tells where a rotary axis is: 500 circles of each kind.

    python examples/ball-circles/table.py [--circles 500] [--noise 0.01]

Circles of 3, 4, 5 and 10 points all around, of two radii, with the noise of 0.01 mm on each
coordinate; fitted as points alone, without their angles. Beside the errors found stands what the
closed forms say: noise sqrt(5 / n) for the centre, 2 noise / (r sqrt n) for the direction.
"""

from __future__ import annotations

import argparse
import math

import numpy as np

from gcxform.calibrate.rotary.circle import fit_circles
from gcxform.machine.chain import Rotary
from gcxform.simulate.balls import simulate_balls

CENTRE = (102.532, 51.230, 128.947)
AXIS = Rotary("C", (0.0, 0.0, 1.0), CENTRE, 1)
COUNTS = (3, 4, 5, 10)
RADII = (500.0, 50.0)
HEAD = """{circles} circles, noise {noise:g} um on each coordinate
              centre um                direction urad
 r mm   n     mean    rms  closed      mean     rms  closed"""


def row(count: int, radius: float, circles: int, noise: float) -> str:
    """Return the line of the table for circles of some points."""
    degrees = np.arange(count) * 360.0 / count
    ball = np.add(CENTRE, (radius, 0.0, 0.0))
    points = simulate_balls(AXIS, ball, degrees, noise=noise, circles=circles)
    found = fit_circles(points)
    centre = 1e3 * np.linalg.norm(found.centre - CENTRE, axis=1)
    tilt = 1e6 * np.linalg.norm(found.direction[:, :2], axis=1)
    closed = 1e3 * noise * math.sqrt(5 / count), 2e6 * noise / (radius * math.sqrt(count))
    sizes = [(v.mean(), math.sqrt((v**2).mean())) for v in (centre, tilt)]
    return (
        f"{radius:5.0f} {count:3d}  {sizes[0][0]:7.2f}{sizes[0][1]:7.2f}{closed[0]:8.2f}"
        f"  {sizes[1][0]:8.1f}{sizes[1][1]:8.1f}{closed[1]:8.1f}"
    )


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--circles", type=int, default=500)
    parser.add_argument("--noise", type=float, default=0.01, help="mm")
    asked = parser.parse_args()
    print(HEAD.format(circles=asked.circles, noise=1e3 * asked.noise))
    for radius in RADII:
        for count in COUNTS:
            print(row(count, radius, asked.circles, asked.noise))


if __name__ == "__main__":
    main()
