"""What a ballbar reads while the control follows the tip and a rotary axis of the table turns.

The control knows one machine, the axes are another; `gcxform.calibrate.ballbar.ballbar.readings`
says what comes of it. Here noise is added, and the four tests of a trunnion are laid out.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from gcxform.calibrate.ballbar.ballbar import SetUp, Trace, readings
from gcxform.machine.chain import Chain, Triple
from gcxform.system.arrays import Floats


def simulate_trace(
    control: Chain,
    true: Chain,
    setup: SetUp,
    degrees: npt.ArrayLike,
    spindle: tuple[float, float] = (0.0, 0.0),
    *,
    noise: float = 0.0,
    generator: np.random.Generator | None = None,
) -> Trace:
    """Return the readings of a test at angles (n,), degrees; `noise` in mm.

    `control` is the machine that the control knows, `true` the one there is, `spindle` how far the
    spindle ball is off the spindle in X and Y. Without `generator` the noise is always the same.
    """
    generator = generator or np.random.default_rng(0)
    turned = np.asarray(degrees, np.float64)
    exact = readings(control, true, setup, turned, spindle)
    return Trace(setup, turned, exact + noise * generator.standard_normal(len(turned)))


def standard_setups(chain: Chain, ball: Triple) -> list[tuple[SetUp, Floats]]:
    """Return two tests of each axis of the table, a bar square to it and one along it.

    The ball is the same in all. With each test stand the ends (2,) of its arc in degrees: the
    limits of the axis, and a whole turn where there are none or more.
    """
    tests = []
    for axis in chain.table:
        along = int(np.abs(axis.direction).argmax())
        square = 2 if along != 2 else 0
        low, high = axis.limits or (0.0, 360.0)
        arc = np.array([low, min(high, low + 360.0)])
        for way in (square, along):
            x, y, z = np.eye(3)[way].tolist()
            tests.append((SetUp(axis.letter, (x, y, z), ball), arc))
    return tests


def simulate_tests(
    control: Chain,
    true: Chain,
    tests: Sequence[tuple[SetUp, Floats]],
    samples: int,
    spindle: tuple[float, float] = (0.0, 0.0),
    *,
    noise: float = 0.0,
    seed: int = 0,
) -> tuple[Trace, ...]:
    """Return the traces of tests, so many readings each, at equal steps of the angle."""
    generator = np.random.default_rng(seed)
    return tuple(
        simulate_trace(
            control,
            true,
            setup,
            np.linspace(arc[0], arc[1], samples).round(6),
            spindle,
            noise=noise,
            generator=generator,
        )
        for setup, arc in tests
    )
