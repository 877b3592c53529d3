"""What stands around the path: the machine's travel, and the errors of a model.

All is in the coordinates of the path. Where the machine is there says its file: the work offset of
the first frame. Where that is not known, nothing that belongs to the machine is shown.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np

from gcxform.contract.options import ModelFile
from gcxform.contract.passes import Pass
from gcxform.errormodel.model import ErrorModel, Outside
from gcxform.machine.machine import Machine
from gcxform.simulate.virtual import ranges
from gcxform.system.arrays import Floats
from gcxform.toolpath.path import Toolpath
from gcxform.view.reading import given

PLACES: Final = 7  # of the errors shown, along each axis
ENDLESS: Final = 100.0  # mm to each side of 0 of a model that has no limits


def around(path: Toolpath, machine: Machine | None, steps: Sequence[Pass] = ()) -> dict[str, Any]:
    """Return what the page is told of the machine of a program, and of its errors."""
    found: dict[str, Any] = {}
    origin = None
    if machine is not None:
        offset = machine.work_offsets.get(path.first, {})
        if all(axis in offset for axis in "XYZ"):
            origin = np.array([offset[axis] for axis in "XYZ"])
        found |= _envelope(machine, origin)
    for step in steps:
        for file in given([step], ModelFile):
            found["lattice"] = _lattice(file.model, _place(step, origin))
    return found


def _place(step: Pass, origin: Floats | None) -> Floats:
    """Return where in the model the zero of the path is, mm."""
    part = origin if origin is not None else getattr(step, "part_origin", None)
    table = getattr(step, "table_origin", None)
    zero = (0.0, 0.0, 0.0)
    return np.subtract(zero if part is None else part, zero if table is None else table)


def _envelope(machine: Machine, origin: Floats | None) -> dict[str, Any]:
    """Return the box that X, Y and Z can reach, if all of it is known."""
    axes = [machine.axes.get(letter) for letter in "XYZ"]
    limits = [axis.limits for axis in axes if axis is not None and axis.limits is not None]
    if origin is None or len(limits) < 3:
        return {}
    low, high = (np.array(ends, np.float64) - origin for ends in zip(*limits, strict=True))
    return {"envelope": [low.tolist(), high.tolist()]}


def _lattice(model: ErrorModel, place: Floats) -> dict[str, Any]:
    """Return points (n, 3) of the path's coordinates and the errors there (n, 3), mm."""
    box = ranges(model)
    box = box if (box[:, 1] > box[:, 0]).any() else np.tile([-ENDLESS, ENDLESS], (3, 1))
    places = [np.linspace(low, high, PLACES if high > low else 1) for low, high in box.tolist()]
    points = np.stack(np.meshgrid(*places, indexing="ij"), axis=-1).reshape(-1, 3)
    error = np.nan_to_num(model.error(points, Outside.CLAMP))
    return {
        "points": np.round(points - place, 4).ravel().tolist(),
        "errors": np.round(error, 7).ravel().tolist(),
    }
