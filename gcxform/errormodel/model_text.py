"""Error models as native TOML, every number of which reads back as the same bits; fingerprints."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable
from typing import Any

import numpy as np

from gcxform.errormodel.functions import COLUMNS, AxisFunction, AxisFunctions
from gcxform.errormodel.lattice import Lattice
from gcxform.errormodel.linear import Linear
from gcxform.errormodel.model import AXES, ErrorModel
from gcxform.errormodel.pitch import PitchTables
from gcxform.errormodel.rigid import RigidBody
from gcxform.system.arrays import Floats


def to_toml(model: ErrorModel) -> str:
    """Return a model as native TOML. Raises TypeError for a kind that has no text of its own."""
    match model:
        case AxisFunctions():
            lines = _functions(model.order, model.axes)
        case RigidBody():
            lines = _functions(model.order, model.axes, model)
        case Lattice():
            lines = _lattice(model)
        case Linear():
            lines = _linear(model)
        case PitchTables():
            lines = _pitch(model)
        case _:
            raise TypeError(f"models of the kind {model.kind!r} are not written")
    return "\n".join(["format = 1", f'kind = "{model.kind}"', *lines]) + "\n"


def _functions(
    order: str, axes: Iterable[AxisFunction | None], rigid: RigidBody | None = None
) -> list[str]:
    lines = ['values = "error"', 'convention = "relative"', f'order = "{order}"']
    if rigid is not None:
        lines.append(f"tool = {_plain(rigid.measured)}")
    for k, (axis, function) in enumerate(zip(AXES, axes, strict=True)):
        if function is not None:
            lines += ["", f"[{axis}]"]
            if rigid is not None and any(rigid.at[k]):
                lines.append(f"at = {_plain(rigid.at[k])}")
            lines.append(f"position = {function.position.tolist()}")
            columns = zip(COLUMNS, function.values.T.tolist(), strict=False)
            lines += [f"E{direction}{axis} = {values}" for direction, values in columns]
    return lines


def _lattice(model: Lattice) -> list[str]:
    lines = ['values = "error"']
    if model.measured is not None:
        lines.append(f"tool = {_plain(model.measured)}")
    lines += [f"{axis} = {nodes.tolist()}" for axis, nodes in zip(AXES, model.grid, strict=True)]
    for letters, values in (("XYZ", model.values), ("ABC", model.turns)):
        if values is not None:
            lines += [f"E{a} = {_rows(values[..., k])}" for k, a in enumerate(letters)]
    return lines


def _plain(values: Iterable[float]) -> list[float]:
    """Return numbers that print as such: those of numpy do not."""
    return [float(value) for value in values]


def _rows(values: Floats) -> str:
    """Return a nested list, a line for each position on X."""
    return "[\n" + "".join(f"  {plane.tolist()},\n" for plane in values) + "]"


def _linear(model: Linear) -> list[str]:
    """Return squareness and scale; the matrix has nothing else above its diagonal."""
    m = model.matrix
    if m[1, 0] or m[2, 0] or m[2, 1]:
        raise TypeError("a matrix with errors below its diagonal is no skew")
    square = {"C0Y": -m[0, 1], "B0Z": m[0, 2], "A0Z": -m[1, 2]}
    return [
        f"scale = {m.diagonal().tolist()}",
        f"origin = {model.origin.tolist()}",
        "",
        "[squareness]",
        *(f"{name} = {float(value)}" for name, value in square.items()),
    ]


def _pitch(model: PitchTables) -> list[str]:
    lines = ['values = "error"']
    for axis, table in zip(AXES, model.axes, strict=True):
        if table is not None:
            lines += ["", f"[{axis}]"]
            for name in ("position", "forward", "reverse"):
                lines.append(f"{name} = {getattr(table, name).tolist()}")
    return lines


def fingerprint(part: Any) -> bytes:
    """Return bytes that are the same for the same model, whatever files it came from."""
    if dataclasses.is_dataclass(part):
        values = [getattr(part, f.name) for f in dataclasses.fields(part) if f.compare]
        return type(part).__name__.encode() + b"(" + b",".join(map(fingerprint, values)) + b")"
    if isinstance(part, tuple):
        return b"(" + b",".join(map(fingerprint, part)) + b")"
    if isinstance(part, np.ndarray):
        return repr(part.shape).encode() + part.tobytes()
    return repr(part).encode()
