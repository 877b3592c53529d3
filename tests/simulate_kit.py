"""What the tests of virtual machines share: small models with closed forms, and chains."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import gcxform as gx
from gcxform.plugin.registry import default_registry
from gcxform.simulate.positions import Chain

EXAMPLE = Path(__file__).parents[1] / "examples" / "lddm" / "model.toml"
TRAVEL = 400.0


def functions(**slopes: float) -> gx.AxisFunctions:
    """Return a model of straight lines: `EXY=1e-5` is an error of 1e-5 mm in X for a mm of Y."""
    position = np.array([0.0, TRAVEL])
    axes = []
    for axis in "XYZ":
        found = [slopes.get(f"E{letter}{axis}", 0.0) for letter in "XYZ"]
        axes.append(gx.AxisFunction(position, np.outer(position, found)))
    return gx.AxisFunctions(tuple(axes))


class Loose(gx.AxisFunctions):
    """No error but backlash: X stands short by half of `LOST` in the direction it came."""

    LOST = 0.004
    backlash = np.array([True, False, False])

    def error(self, position, outside=gx.Outside.ERROR, tool=None, sense=None):
        found = super().error(position, outside)
        if sense is not None:
            found[:, 0] -= self.LOST / 2 * sense[:, 0]
        return found


def file_of(model: gx.ErrorModel) -> gx.ModelFile:
    return gx.ModelFile(Path("model.toml"), model, "")


def chain_of(model: gx.ErrorModel, dialect: str = "linuxcnc", **options) -> Chain:
    return Chain(file_of(model), default_registry().dialect(dialect), **options)


def lddm(dialect: str = "linuxcnc", **options) -> Chain:
    kind = default_registry().dialect(dialect)
    return Chain(gx.ModelFile.load(EXAMPLE), kind, **options)
