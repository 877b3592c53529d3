"""What the tests of diagonal measurements share: the published machine, and its readings."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from step_diagonal_kit import simulate_linear, simulate_step_diagonal

from gcxform.calibrate.diagonal.readings import Diagonals, LinearTest, step_diagonals
from gcxform.calibrate.diagonal.reframe import slopes_of, turn_of
from gcxform.calibrate.diagonal.step_diagonal import Assumed
from gcxform.errormodel.functions import AxisFunction, AxisFunctions
from gcxform.errormodel.model_file import load_model
from gcxform.system.arrays import Floats

EXAMPLE = Path(__file__).parents[1] / "examples" / "lddm"
LOW = (0.0, 0.0, 0.0)
TRAVEL = (480.0, 330.0, 450.0)
LENGTHS = [4.254, -26.823, -27.853, -37.184]  # um: what its diagonals are longer by
SLOPES = [25.264, 34.424, 52.624]  # urad: EXY + EYX, EXZ + EZX, EYZ + EZY
ALIGNED = Assumed(free_beams=False)
FREE = Assumed()


def published(path: Path = EXAMPLE / "model.toml") -> AxisFunctions:
    model = load_model(path)
    assert isinstance(model, AxisFunctions)
    return model


def readings(misalignment: object = 0.0, steps: int = 10) -> Diagonals:
    """Return what the diagonals of the published machine read, without noise."""
    angles = np.asarray(misalignment, np.float64)
    legs = simulate_step_diagonal(published(), LOW, TRAVEL, steps, misalignment=angles)
    return step_diagonals(legs)


def linear(*axes: int) -> list[LinearTest]:
    """Return direct linear tests of axes of the published machine, without noise."""
    return [
        test
        for axis in axes
        for test in simulate_linear(published(), axis, np.linspace(0.0, TRAVEL[axis], 11))
    ]


def values(model: AxisFunctions) -> Floats:
    """Return the nine functions (axis, direction, node) in mm; all axes have as many nodes."""
    functions = [f for f in model.axes if f is not None]
    return np.array([f.values.T for f in functions])


def apart(one: AxisFunctions, other: AxisFunctions) -> float:
    """Return the largest difference of two models at their nodes, mm."""
    return float(np.abs(values(one) - values(other)).max())


def turned(model: AxisFunctions, turn: Sequence[float]) -> AxisFunctions:
    """Return a model turned as a whole by small angles (3,) in rad: E + turn x p."""
    axes = []
    for k, function in enumerate(model.axes):
        assert function is not None
        point = np.zeros((len(function.position), 3))
        point[:, k] = function.position
        axes.append(AxisFunction(function.position, function.values + np.cross(turn, point)))
    return AxisFunctions((axes[0], axes[1], axes[2]))


# --- the end-point frame ---


def reframed(model: AxisFunctions) -> AxisFunctions:
    """Return a model in the end-point frame; it must have all three axes."""
    x, y, z = model.axes
    assert x is not None
    assert y is not None
    assert z is not None
    functions = (x, y, z)
    ends = [(f.values[-1] - f.values[0]) / (f.position[-1] - f.position[0]) for f in functions]
    added = slopes_of(turn_of(np.array(ends)))
    x, y, z = (_moved(f, rate) for f, rate in zip(functions, added, strict=True))
    return AxisFunctions((x, y, z), model.order)


def _moved(function: AxisFunction, rate: Floats) -> AxisFunction:
    """Return a function that begins at zero, with slopes (3,) in mm per mm added."""
    along = function.position - function.position[0]
    values = function.values - function.values[0] + along[:, None] * rate
    return AxisFunction(function.position, values)
