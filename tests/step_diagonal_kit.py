"""What tests measure: a step diagonal and linear tests on a machine whose errors are known.

The mirror is flat and square to the beam, so a reading is the motion of the machine, nominal plus
error, along the beam: w . (p - p0 + E(p) - E(p0)), first order in nothing. The beam w lies along
the nominal diagonal but for its misalignment, two angles towards `sideways` (level first).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Protocol

import numpy as np
import numpy.typing as npt

from gcxform.calibrate.diagonal.readings import AXES, FOUR, Leg, LinearTest, Signs, beam, sideways
from gcxform.system.arrays import Floats


class HasError(Protocol):
    """Anything that says the error (n, 3) in mm at positions (n, 3) in mm."""

    def error(self, position: Floats) -> Floats:
        """Return the errors (n, 3) in mm."""
        ...


def step_positions(low: npt.ArrayLike, travel: npt.ArrayLike, steps: int, signs: Signs) -> Floats:
    """Return the stops (3 steps + 1, 3) in mm of a diagonal: its corner, then X, Y, Z in turn."""
    corner, size = np.asarray(low, np.float64), np.asarray(travel, np.float64)
    moved = (np.arange(3 * steps + 1)[:, None] + 2 - np.arange(3)) // 3  # steps of each axis so far
    part = moved / steps
    along = np.where(np.array(signs) > 0, part, 1.0 - part)
    stops: Floats = corner + size * along
    return stops


def simulate_step_diagonal(
    model: HasError,
    low: npt.ArrayLike,
    travel: npt.ArrayLike,
    steps: int,
    *,
    noise: float = 0.0,
    misalignment: npt.ArrayLike = 0.0,
    bidirectional: bool = False,
    runs: int = 1,
    diagonals: Sequence[Signs] = FOUR,
    generator: np.random.Generator | None = None,
) -> tuple[Leg, ...]:
    """Return what the diagonals of the box from `low` (3,) with sides `travel` (3,), mm, read.

    `noise` is the standard deviation in mm of one step; steps are independent, so that readings
    wander. `misalignment` is in rad, broadcast to (diagonals, 2). Bidirectional: each run is a leg
    out and a leg back. Without `generator` the noise is the same every time.
    """
    generator = generator or np.random.default_rng(0)
    size = np.asarray(travel, np.float64)
    angles = np.broadcast_to(np.asarray(misalignment, np.float64), (len(diagonals), 2))
    legs = []
    for signs, angle in zip(diagonals, angles, strict=True):
        stops = step_positions(low, size, steps, signs)
        ideal = beam(signs, size)
        aside = _normalised(ideal + angle @ sideways(signs, size)) - ideal if angle.any() else 0.0
        for forward in (True, False)[: 1 + bidirectional] * runs:
            position = stops if forward else stops[::-1]
            error = model.error(position)
            deviation = (error - error[0]) @ (ideal + aside)
            deviation += ((position - position[0]) * aside).sum(axis=1)
            deviation[1:] += np.cumsum(noise * generator.standard_normal(len(stops) - 1))
            legs.append(Leg(signs, position, deviation, forward))
    return tuple(legs)


def simulate_linear(
    model: HasError,
    axis: int,
    position: npt.ArrayLike,
    base: npt.ArrayLike = (0.0, 0.0, 0.0),
    *,
    noise: float = 0.0,
    runs: int = 1,
    generator: np.random.Generator | None = None,
) -> tuple[LinearTest, ...]:
    """Return runs of a linear test of an axis at positions (n,), mm, the others standing at `base`.

    `noise` is the standard deviation in mm of one reading.
    """
    generator = generator or np.random.default_rng(0)
    at = np.asarray(position, np.float64)
    points = np.tile(np.asarray(base, np.float64), (len(at), 1))
    points[:, axis] = at
    error = model.error(points)[:, axis]
    return tuple(
        LinearTest(axis, at, error - error[0] + noise * generator.standard_normal(len(at)))
        for _ in range(runs)
    )


def _normalised(vector: Floats) -> Floats:
    unit: Floats = vector / np.linalg.norm(vector)
    return unit


# --- files ---


def diagonals_csv(legs: Iterable[Leg]) -> str:
    """Return legs as a file that reads back as the same, up to the rounding of um to mm."""
    lines = ["diagonal,run,direction,X [mm],Y [mm],Z [mm],deviation [um]"]
    runs: dict[tuple[Signs, bool], int] = {}
    for leg in legs:
        key = leg.signs, leg.forward
        runs[key] = runs.get(key, 0) + 1
        head = f"{leg.name},{runs[key]},{'+' if leg.forward else '-'}"
        for (x, y, z), value in zip(leg.position.tolist(), leg.deviation.tolist(), strict=True):
            lines.append(f"{head},{x!r},{y!r},{z!r},{value * 1e3!r}")
    return "\n".join(lines) + "\n"


def linear_csv(tests: Iterable[LinearTest]) -> str:
    """Return runs of one axis as a file."""
    tests = list(tests)
    lines = [f"{AXES[tests[0].axis]} [mm],run,deviation [um]"]
    for run, test in enumerate(tests, 1):
        for at, value in zip(test.position.tolist(), test.deviation.tolist(), strict=True):
            lines.append(f"{at!r},{run},{value * 1e3!r}")
    return "\n".join(lines) + "\n"
