"""From one kind of error model to another, with what is lost on the way.

Functions become a lattice without loss, because the rigid-body model is trilinear in each cell if
every node of its functions is a node of the grid. A lattice becomes functions by least squares over
all its nodes: on a full grid the best sum a(x) + b(y) + c(z) is that of the means over the planes
(analysis of variance without interaction).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import reduce
from typing import NamedTuple

import numpy as np

from gcxform.diagnostics import UsageError
from gcxform.errormodel.functions import AxisFunction, AxisFunctions
from gcxform.errormodel.lattice import Lattice
from gcxform.errormodel.model import AXES, ErrorModel
from gcxform.errormodel.pitch import PitchTable, PitchTables
from gcxform.errormodel.rigid import RigidBody
from gcxform.system.arrays import Flags, Floats

LEVER = 1000.0  # mm: the tool by which turns are asked for
Grid = tuple[Floats, Floats, Floats]


class Fit(NamedTuple):
    """A model made of another, and what it leaves where they are compared: rms and largest, mm."""

    model: ErrorModel
    rms: float
    largest: float


def to_lattice(model: ErrorModel, order: str = AXES) -> Lattice:
    """Return the errors, and the turns if the model has any, at all nodes of a model.

    Without loss for functions with the tool of the measurement and, through the turns, with any
    other. Raises UsageError for a model without limits and for backlash.
    """
    if isinstance(model, Lattice):
        return model
    if model.backlash.any():
        message = f"a lattice cannot hold the backlash of {_letters(model.backlash)}"
        raise UsageError.one(
            "GX481", message, hint="take the mean of both directions: --backlash mean"
        )
    grid = grid_of(model)
    points = points_of(grid)
    values = model.error(points)
    shape = (*(len(nodes) for nodes in grid), 3)
    turns = _turns(model, points, values).reshape(shape) if model.needs_tool else None
    tool = model.tool if model.needs_tool else None
    measured = None if tool is None else (float(tool[0]), float(tool[1]), float(tool[2]))
    return Lattice(grid, values.reshape(shape), turns, measured)


def _turns(model: ErrorModel, points: Floats, values: Floats) -> Floats:
    """Return the angular errors (n, 3): E(q, t) - E(q, t0) = R x (t - t0)."""
    tool = np.zeros(3) if model.tool is None else model.tool
    by_x, by_y = (model.error(points, tool=tool + LEVER * np.eye(3)[k]) - values for k in (0, 1))
    return np.stack([by_y[:, 2], -by_x[:, 2], by_x[:, 1]], axis=1) / LEVER


def to_functions(model: ErrorModel, order: str = AXES) -> Fit:
    """Return the functions that are nearest to a model: eighteen where it has turns, else nine.

    `order` names the axes of the machine from the workpiece to the tool. What is constant is in the
    first axis that has functions.
    """
    if isinstance(model, AxisFunctions | RigidBody):
        return Fit(model, 0.0, 0.0)
    lattice = to_lattice(model)
    if lattice.turns is None:
        return to_nine(lattice)
    turns = _separated(lattice.turns)
    levers = _levers(lattice.grid, order)
    rest = lattice.values - sum(
        np.cross(_spread(turn, k), levers[k]) for k, turn in enumerate(turns)
    )
    parts = [np.hstack(both) for both in zip(_separated(rest), turns, strict=True)]
    x, y, z = map(_function, lattice.grid, parts)
    return _fit(RigidBody((x, y, z), order, measured=lattice.measured or (0.0, 0.0, 0.0)), model)


def to_nine(model: ErrorModel, order: str = AXES) -> Fit:
    """Return the nine functions that are nearest to a model with the tool of its measurement."""
    if isinstance(model, AxisFunctions):
        return Fit(model, 0.0, 0.0)
    lattice = to_lattice(model)
    x, y, z = map(_function, lattice.grid, _separated(lattice.values))
    return _fit(AxisFunctions((x, y, z)), model)


def to_pitch(model: ErrorModel, order: str = AXES) -> Fit:
    """Return the positioning errors alone of the nine functions that are nearest to a model."""
    if isinstance(model, PitchTables):
        return Fit(model, 0.0, 0.0)
    nine = to_nine(model).model
    assert isinstance(nine, AxisFunctions)
    tables = [
        None
        if f is None or not f.values[:, k].any()
        else PitchTable(f.position, f.values[:, k], f.values[:, k])
        for k, f in enumerate(nine.axes)
    ]
    return _fit(PitchTables((tables[0], tables[1], tables[2])), model)


KINDS: dict[str, Callable[[ErrorModel, str], Fit]] = {
    "functions": to_functions,
    "nine-functions": to_nine,
    "lattice": lambda model, order: _fit(to_lattice(model), model),
    "pitch": to_pitch,
}
"""What a model can become, by the name of its kind."""


def difference(
    one: ErrorModel, other: ErrorModel, sense: float = 0.0, away: Floats | None = None
) -> Floats:
    """Return by how much (n,) in mm two models differ at all nodes of both.

    They are compared with the tool of their measurement, or that and the way `away` (3,) in mm.
    Of a model that is curved along an axis they are compared half way between its nodes as well.
    Models that are linear without limits are compared from -`LEVER` to `LEVER`.
    """
    x, y, z = (
        nodes if len(nodes) else LEVER * np.array([-1.0, 0.0, 1.0])
        for nodes in _and_middles(_nodes(one, other), one, other)
    )
    points = points_of((x, y, z))
    senses = np.full(points.shape, sense)
    tools = (None if away is None or m.tool is None else m.tool + away for m in (one, other))
    found = [
        model.error(points, tool=tool, sense=senses)
        for model, tool in zip((one, other), tools, strict=True)
    ]
    return np.asarray(np.linalg.norm(found[1] - found[0], axis=1))


def _and_middles(grid: list[Floats], *models: ErrorModel) -> list[Floats]:
    """Return the nodes, and the middles between them on axes along which a model is curved."""
    curved = np.any([model.curvature().diagonal() for model in models], axis=0)
    return [
        np.union1d(nodes, (nodes[1:] + nodes[:-1]) / 2.0) if bent else nodes
        for nodes, bent in zip(grid, curved, strict=True)
    ]


def _nodes(*models: ErrorModel) -> list[Floats]:
    """Return the nodes of models on each axis, each within the range of its own model."""
    return [reduce(np.union1d, (_inner(model, axis) for model in models)) for axis in range(3)]


def _inner(model: ErrorModel, axis: int) -> Floats:
    """Return the nodes (n,) of a model within its range, which in a sum is that of all parts."""
    nodes, (low, high) = model.nodes[axis], model.range_of(axis)
    return nodes[(nodes >= low) & (nodes <= high)]


def grid_of(model: ErrorModel) -> Grid:
    """Return the nodes of a model; zero on an axis on which it does not depend.

    Raises UsageError for a model that is linear without limits: it has no nodes to stand for it.
    """
    grid = _nodes(model)
    for axis, nodes in enumerate(grid):
        if not len(nodes) and _slopes(model, axis):
            message = f"the model has no positions on {AXES[axis]}, on which its error depends"
            raise UsageError.one("GX481", message)
    x, y, z = (nodes if len(nodes) else np.zeros(1) for nodes in grid)
    return x, y, z


def _slopes(model: ErrorModel, axis: int) -> bool:
    """Return whether a model without nodes on an axis changes along it."""
    two = np.outer([0.0, 100.0], np.eye(3)[axis])
    return bool(np.ptp(model.error(two), axis=0).any())


def points_of(grid: Grid) -> Floats:
    """Return the points (n, 3) of a grid, Z fastest."""
    found: Floats = np.stack(np.meshgrid(*grid, indexing="ij"), axis=-1).reshape(-1, 3)
    return found


def _fit(made: ErrorModel, model: ErrorModel) -> Fit:
    apart = difference(model, made)
    return Fit(made, float(np.sqrt(np.mean(apart**2))), float(apart.max()))


def _separated(values: Floats) -> list[Floats]:
    """Return a, b, c of the best a(x) + b(y) + c(z) to values (nx, ny, nz, k): means of planes.

    The mean of all is in the first axis with more than one position.
    """
    whole = values.mean(axis=(0, 1, 2))
    parts = [values.mean(axis=tuple(j for j in range(3) if j != k)) - whole for k in range(3)]
    first = next((k for k in range(3) if len(parts[k]) > 1), 0)
    parts[first] = parts[first] + whole
    return parts


def _spread(values: Floats, axis: int) -> Floats:
    """Return the values (n, 3) of an axis as an array over the whole grid, to be broadcast."""
    shape = [1, 1, 1, 3]
    shape[axis] = len(values)
    return values.reshape(shape)


def _levers(grid: Grid, order: str) -> list[Floats]:
    """Return the levers of the axes: where those nearer to the tool stand, over the whole grid."""
    points = points_of(grid).reshape(*(len(nodes) for nodes in grid), 3)
    after = [[c in order[order.index(axis) + 1 :] for c in AXES] for axis in AXES]
    return [points * mask for mask in after]


def _function(nodes: Floats, values: Floats) -> AxisFunction | None:
    """Return the function of an axis, None for one on which nothing depends."""
    return AxisFunction(nodes, values) if len(nodes) > 1 else None


def _letters(axes: Flags) -> str:
    return " and ".join(letter for letter, chosen in zip(AXES, axes, strict=True) if chosen)
