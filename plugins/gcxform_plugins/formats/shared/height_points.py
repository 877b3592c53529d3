"""What the formats of height maps share: points on a grid, and the heights of a model.

Where the surface is higher than nominal the tool is too low by as much relative to it: the error in
Z is minus the height.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Floats

UNITS = {"mm": 1.0, "in": 25.4}
BESIDE = 1e-3  # of a step: so far a point may be from its place, as numbers are rounded


def surface(x: Floats, y: Floats, height: Floats) -> gx.Lattice:
    """Return the model of heights (ny, nx) over x and y, all in mm."""
    values = np.zeros((len(x), len(y), 1, 3))
    values[:, :, 0, 2] = -height.T
    return gx.Lattice((x, y, np.zeros(1)), values)


def heights(name: str, model: gx.ErrorModel) -> tuple[Floats, Floats, Floats]:
    """Return x, y and heights (ny, nx) of a model in mm, or refuse what else it has."""
    if not isinstance(model, gx.Lattice):
        hint = "--kind lattice makes points of it"
        raise gx.cannot_hold(name, f"a model of the kind {model.kind!r}", hint)
    for letter, values in zip("XY", np.moveaxis(model.values, -1, 0), strict=False):
        if values.any():
            raise gx.cannot_hold(name, f"errors in {letter}: it holds heights alone")
    if model.turns is not None and model.turns.any():
        raise gx.cannot_hold(name, "angular errors: it holds heights alone")
    if len(model.grid[2]) > 1:
        raise gx.cannot_hold(name, "heights that depend on Z")
    x, y, _ = model.grid
    if len(x) < 2 or len(y) < 2:
        raise gx.cannot_hold(name, "heights along a line: it needs two positions on X and on Y")
    return x, y, -model.values[:, :, 0, 2].T


def even(name: str, letter: str, nodes: Floats) -> None:
    """Refuse positions which are not equally spaced."""
    step = (nodes[-1] - nodes[0]) / (len(nodes) - 1)
    wanted = np.linspace(nodes[0], nodes[-1], len(nodes))
    if np.abs(nodes - wanted).max() > 1e-6 * step:
        raise gx.cannot_hold(name, f"positions on {letter} which are not equally spaced")


def gridded(rows: list[gx.TextRow], x: Floats, y: Floats) -> Floats:
    """Return the heights (ny, nx) of rows `x y z` at the places of a grid.

    Raises UsageError for points that are missing, double, or beside the grid.
    """
    height = np.full((len(y), len(x)), np.nan)
    for row in rows:
        at_x, at_y, z = row.numbers(3)
        if not np.isfinite([at_x, at_y, z]).all():
            column = int(np.flatnonzero(~np.isfinite([at_x, at_y, z]))[0])
            raise row.refuse("GX412", f"the point holds {row.word(column)}", column)
        i, j = _place(row, 1, y, at_y), _place(row, 0, x, at_x)
        if not np.isnan(height[i, j]):
            raise row.refuse("GX483", f"the point ({at_x:g}, {at_y:g}) stands twice", 0)
        height[i, j] = z
    if np.isnan(height).any():
        i, j = np.argwhere(np.isnan(height))[0]
        message = f"there is no height at X {x[j]:g}, Y {y[i]:g}"
        raise rows[-1].refuse("GX483", message, 0)
    return height


def _place(row: gx.TextRow, column: int, nodes: Floats, value: float) -> int:
    """Return which position of the grid a value is."""
    k = int(np.abs(nodes - value).argmin())
    step = np.diff(nodes).min(initial=np.inf)
    if abs(nodes[k] - value) > BESIDE * step:
        message = f"{row.word(column)} is beside the grid, whose nearest line is at {nodes[k]:g}"
        raise row.refuse("GX483", message, column)
    return k


def points(x: Floats, y: Floats, height: Floats) -> Iterable[list[str]]:
    """Yield the lines `x y z` of each row of a map, x fastest."""
    for at_y, row in zip(y.tolist(), height.tolist(), strict=True):
        yield [
            " ".join(gx.decimal(v, 10) for v in (at_x, at_y, z))
            for at_x, z in zip(x.tolist(), row, strict=True)
        ]
