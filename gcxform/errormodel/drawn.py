"""An error model as a small picture: the edges of its volume, and where the machine really is."""

from __future__ import annotations

from itertools import product
from typing import Protocol

import numpy as np

from gcxform.notebook import Stroke, drawn, shown
from gcxform.system.arrays import Floats

ENDLESS = 100.0  # mm; what is drawn of an axis without a range
POINTS = 25  # of an edge
SHOWN = 0.08  # of the size of the volume; the largest error is drawn as long


class Field(Protocol):
    """What is asked of an error model."""

    @property
    def kind(self) -> str:
        """What kind of model it is."""

    def range_of(self, axis_index: int) -> tuple[float, float]:
        """Return the range of an axis, mm."""

    def error(self, position: Floats) -> Floats:
        """Return E (n, 3) at positions (n, 3), mm."""


def cell(model: Field) -> str:
    """Return a model as HTML for a notebook: its kind, its ranges, its error at the edges."""
    box = np.array([model.range_of(axis) for axis in range(3)])
    rows: list[tuple[str, object]] = [("kind", model.kind)]
    for axis, (low, high) in zip("XYZ", box.tolist(), strict=True):
        ends = f"{low:g} to {high:g} mm" if np.isfinite([low, high]).all() else "no table"
        rows.append((axis, ends))
    box[~np.isfinite(box).all(axis=1)] = -ENDLESS, ENDLESS
    edges = _edges(box)
    error = model.error(edges)
    known = np.nan_to_num(np.linalg.norm(error, axis=1))
    most = float(known.max())
    factor = SHOWN * float(np.linalg.norm(np.ptp(box, axis=1))) / most if most > 0.0 else 0.0
    rows.append(("largest at the edges", f"{most * 1000.0:.4g} um, drawn {factor:.3g} times"))
    there = _apart(edges + factor * error)
    strokes = [Stroke(_apart(edges), "rapid"), Stroke(there, "error")]
    return shown("error model", rows, drawn(strokes, "the volume, and where the machine is in it"))


def _edges(box: Floats) -> Floats:
    """Return points (12 * POINTS, 3) along the edges of a box (3, 2), one edge behind the other."""
    lines = []
    for axis in range(3):
        one, other = (k for k in range(3) if k != axis)
        for a, b in product(box[one], box[other]):
            line = np.empty((POINTS, 3))
            line[:, axis] = np.linspace(box[axis, 0], box[axis, 1], POINTS)
            line[:, one], line[:, other] = a, b
            lines.append(line)
    return np.concatenate(lines)


def _apart(points: Floats) -> Floats:
    """Return the points of edges with nan between them."""
    apart = points.reshape(-1, POINTS, 3)
    gaps = np.full((len(apart), 1, 3), np.nan)
    return np.concatenate([apart, gaps], axis=1).reshape(-1, 3)
