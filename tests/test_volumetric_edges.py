"""Places where a compensation or its proof could go wrong: coincidences, borders, windows."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import gcxform as gx
from gcxform.machine.functions import AxisFunction, AxisFunctions
from gcxform.machine.rigid import RigidBody
from gcxform.options import ModelFile
from gcxform.registry import default_registry


def bent(travel=200.0, count=5, size=0.01, angle=0.0, seed=1) -> RigidBody | AxisFunctions:
    """Return a machine with nodes at round positions, about zero."""
    rng = np.random.default_rng(seed)
    position = np.linspace(-travel, travel, count)
    axes = []
    for _ in range(3):
        values = rng.normal(0, size, (count, 6)) * np.repeat([1.0, angle / size], 3)
        axes.append(AxisFunction(position, values if angle else values[:, :3]))
    return RigidBody(tuple(axes)) if angle else AxisFunctions(tuple(axes))


def volumetric(model, **options):
    step = default_registry().pass_("volumetric")
    return step(
        model=ModelFile(Path("model.toml"), model, ""), part_origin=(0.0, 0.0, 0.0), **options
    )


def undone(step, program: str) -> gx.Toolpath:
    path = gx.read(program.encode(), "linuxcnc").path
    return step.undo(path, gx.Pipeline.parse("absolute", "linuxcnc").context)


HEAD = "G21 G90 G17 G94 G0 X100. Y0. Z0.\n"


@pytest.mark.parametrize("move", [
    "G2 X100. Y0. I-100. J0. F500.",
    "G3 X0. Y100. I-100. J0. F500.",
    "G1 X-150. Y-250. F500.",
    "G1 X-100. Y-200. Z200. F500.",
])  # fmt: skip
@pytest.mark.parametrize(("angle", "count"), [(0.0, 5), (2e-5, 5), (0.0, 11)])
def test_nodes_that_are_met_together_make_one_cut(move, angle, count):
    """A quarter of an arc is a node of one axis, and where it is divided anyway."""
    for size in np.geomspace(0.001, 0.01, 12):
        step = volumetric(bent(count=count, size=size, angle=angle), outside="extrapolate")
        path = undone(step, HEAD + move + "\n")
        assert len(path) > 2
        assert (path.sweep[path.is_arc] > 1e-6).all()
        length = np.sqrt(((path.end - path.start)[1:, :3] ** 2).sum(axis=1))
        assert (length > 1e-6).all()
