"""What the tests of table formats share: models, files on disk, and a way there and back."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from gcxform.catalogue import CATALOGUE
from gcxform.diagnostics import Diagnostic, UsageError
from gcxform.errormodel.converting import difference
from gcxform.errormodel.formats import ErrorFormat
from gcxform.errormodel.functions import AxisFunction, AxisFunctions
from gcxform.errormodel.model import ErrorModel
from gcxform.errormodel.pitch import PitchTable, PitchTables
from gcxform.errormodel.rigid import RigidBody


def nodes(rng: Any, count: int, step: float = 0.0) -> Any:
    """Return positions in mm: with equal steps, or with any."""
    steps = np.full(count - 1, step) if step else rng.integers(5, 60, count - 1)
    return np.concatenate([[0.0], np.cumsum(steps)]) - float(rng.integers(0, 200))


def microns(rng: Any, *shape: int) -> Any:
    """Return errors in mm with whole tenths of micrometres."""
    return rng.integers(-200, 200, shape) / 1e4


def pitch(seed: int, axes: str = "XYZ", step: float = 0.0, backlash: bool = True) -> PitchTables:
    rng = np.random.default_rng(seed)
    tables: list[PitchTable | None] = [None, None, None]
    for axis in axes:
        position = nodes(rng, int(rng.integers(2, 12)), step)
        forward = microns(rng, len(position))
        reverse = microns(rng, len(position)) if backlash else forward
        tables["XYZ".index(axis)] = PitchTable(position, forward, reverse)
    return PitchTables((tables[0], tables[1], tables[2]))


def nine(seed: int, step: float = 0.0) -> AxisFunctions:
    rng = np.random.default_rng(seed)
    each = [nodes(rng, int(rng.integers(2, 9)), step) for _ in range(3)]
    x, y, z = (AxisFunction(n, microns(rng, len(n), 3)) for n in each)
    return AxisFunctions((x, y, z))


def rigid(seed: int, order: str = "XYZ", tool: Any = (10.0, 0.0, -120.0)) -> RigidBody:
    rng = np.random.default_rng(seed)
    parts = []
    for _ in range(3):
        position = nodes(rng, int(rng.integers(2, 9)))
        turns = rng.integers(-300, 300, (len(position), 3)) / 1e7
        parts.append(AxisFunction(position, np.hstack([microns(rng, len(position), 3), turns])))
    return RigidBody((parts[0], parts[1], parts[2]), order, measured=tool)


def written(form: ErrorFormat, model: ErrorModel, place: Path) -> Path:
    """Write the files of a model at a place."""
    for name, text in form.write(model).items():
        file = place / name if name else place
        file.parent.mkdir(exist_ok=True)
        file.write_text(text, encoding="utf-8")
    return place


def apart(one: ErrorModel, other: ErrorModel) -> float:
    """Return by how much (mm) two models differ, in any direction of travel."""
    return max(float(difference(one, other, sense).max()) for sense in (-1.0, 0.0, 1.0))


def refusal(form: ErrorFormat, path: Path, text: str | bytes) -> Diagnostic:
    """Return the first thing wrong with a text."""
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    with pytest.raises(UsageError) as caught:
        form.read(path)
    assert all(d.code in CATALOGUE for d in caught.value.diagnostics)
    return caught.value.diagnostics[0]


def cannot(form: ErrorFormat, model: ErrorModel) -> str:
    """Return what a format says that it cannot hold."""
    with pytest.raises(UsageError) as caught:
        form.write(model)
    (found,) = caught.value.diagnostics
    assert found.code == "GX481"
    return found.message


def at(model: ErrorModel, x: float, y: float = 0.0, z: float = 0.0, sense: float = 0.0) -> Any:
    """Return the error at one place."""
    return model.error(np.array([[x, y, z]]), sense=np.full((1, 3), sense))[0]
