"""Error models on grids and without them: the kinds `lattice`, `height-map` and `skew`."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Annotated, Any, Literal

import msgspec
import numpy as np

from gcxform.config.keys import says
from gcxform.config.toml_text import TomlText, convert
from gcxform.diagnostics import Diagnostic, UsageError
from gcxform.errormodel.functions import ascending
from gcxform.errormodel.functions_file import Squareness, Triple, not_finite, shear
from gcxform.errormodel.lattice import Lattice
from gcxform.errormodel.linear import Linear
from gcxform.errormodel.model import AXES
from gcxform.errormodel.rigid import NOWHERE
from gcxform.system.arrays import Floats

Grid = list[list[list[float]]]


class LatticeFile(msgspec.Struct, forbid_unknown_fields=True, kw_only=True):
    """An error model of the kind `lattice`: errors at the points of a grid.

    `X`, `Y` and `Z` are the positions of the grid in mm, one or more on each axis. `EX`, `EY` and
    `EZ` are the errors in mm at `[x][y][z]`, `EA`, `EB` and `EC` the angular errors in rad, which
    need `tool`: the way in mm from the gauge point to the measured point.
    """

    format: Annotated[int, says("the form of this file; now 1")]
    kind: Annotated[Literal["lattice"], says("the kind of the model")]
    values: Annotated[
        Literal["error", "correction"], says("what the numbers are: errors, or their corrections")
    ]
    X: Annotated[list[float], says("positions of the grid in X, mm, rising")]
    Y: Annotated[list[float], says("positions of the grid in Y, mm, rising")]
    Z: Annotated[list[float], says("positions of the grid in Z, mm, rising")]
    EX: Annotated[Grid, says("errors in X at `[x][y][z]`, mm")]
    EY: Annotated[Grid, says("errors in Y at `[x][y][z]`, mm")]
    EZ: Annotated[Grid, says("errors in Z at `[x][y][z]`, mm")]
    EA: Annotated[Grid | None, says("turns about X at `[x][y][z]`, rad")] = None
    EB: Annotated[Grid | None, says("turns about Y at `[x][y][z]`, rad")] = None
    EC: Annotated[Grid | None, says("turns about Z at `[x][y][z]`, rad")] = None
    tool: Annotated[
        Triple | None,
        says("from the gauge point to the point that was measured, mm; turns need it"),
    ] = None


class HeightMapFile(msgspec.Struct, forbid_unknown_fields=True, kw_only=True):
    """An error model of the kind `height-map`: how high a probed surface is.

    `height` has one row for each position on `Y`, of one number for each on `X`, all in mm. Where
    the surface is higher than nominal the tool is too low by as much, so the tool is raised.
    """

    format: Annotated[int, says("the form of this file; now 1")]
    kind: Annotated[Literal["height-map"], says("the kind of the model")]
    X: Annotated[list[float], says("positions that were probed in X, mm, rising")]
    Y: Annotated[list[float], says("positions that were probed in Y, mm, rising")]
    height: Annotated[list[list[float]], says("heights, a row for each position in Y, mm")]


class SkewFile(msgspec.Struct, forbid_unknown_fields=True, kw_only=True):
    """An error model of the kind `skew`: squareness in rad, scale errors in mm per mm.

    There is no error at `origin` (mm), and no limit.
    """

    format: Annotated[int, says("the form of this file; now 1")]
    kind: Annotated[Literal["skew"], says("the kind of the model")]
    squareness: Annotated[Squareness, says("squareness of the axes")]
    scale: Annotated[Triple, says("scale errors of X, Y and Z, mm per mm")] = NOWHERE
    origin: Annotated[Triple, says("where there is no error, mm")] = NOWHERE


def lattice(document: TomlText) -> Lattice:
    """Return the model of a file of the kind `lattice`. Raises UsageError."""
    file = convert(document, LatticeFile)
    names = ["EX", "EY", "EZ"]
    turns = [name for name in ("EA", "EB", "EC") if getattr(file, name) is not None]
    names += turns
    sizes = [len(file.X), len(file.Y), len(file.Z)]
    found = [*_positions(document, file, AXES), *_turn_findings(document, file, turns)]
    for name in names:
        found += _shape_findings(document, (name,), getattr(file, name) or [], sizes)
    if found:
        raise UsageError(tuple(found))
    sign = -1.0 if file.values == "correction" else 1.0
    values = sign * np.stack([np.array(getattr(file, n), np.float64) for n in names], axis=-1)
    grid = np.array(file.X), np.array(file.Y), np.array(file.Z)
    return Lattice(grid, values[..., :3], values[..., 3:] if turns else None, file.tool)


def height_map(document: TomlText) -> Lattice:
    """Return the model of a file of the kind `height-map`. Raises UsageError."""
    file = convert(document, HeightMapFile)
    sizes = [len(file.Y), len(file.X)]
    found = [*_positions(document, file, "XY")]
    found += _shape_findings(document, ("height",), file.height, sizes)
    if found:
        raise UsageError(tuple(found))
    return surface(np.array(file.X), np.array(file.Y), np.array(file.height))


def surface(x: Floats, y: Floats, height: Floats) -> Lattice:
    """Return the model of a surface: `height` (ny, nx) in mm over the positions x and y in mm."""
    values = np.zeros((len(x), len(y), 1, 3))
    values[:, :, 0, 2] = -height.T
    return Lattice((x, y, np.zeros(1)), values)


def skew(document: TomlText) -> Linear:
    """Return the model of a file of the kind `skew`. Raises UsageError."""
    file = convert(document, SkewFile)
    matrix = shear(file.squareness).T + np.diag(file.scale)
    if not np.isfinite(matrix).all() or not np.isfinite(file.origin).all():
        raise UsageError.one("GX412", "the skew is not finite", document.where("squareness"))
    return Linear(matrix, np.array(file.origin))


def _positions(document: TomlText, file: msgspec.Struct, axes: str) -> Iterator[Diagnostic]:
    """Yield what is wrong with the positions of the grid."""
    for axis in axes:
        nodes = getattr(file, axis)
        if not nodes:
            yield Diagnostic("GX411", f"{axis} has no position", document.where(axis))
        yield from not_finite(document, (axis,), nodes)
        for fault in ascending(nodes) if np.isfinite(nodes).all() else ():
            yield Diagnostic(
                fault.code, f"{axis}: {fault.message}", document.where(axis, fault.row or 0)
            )


def _turn_findings(
    document: TomlText, file: LatticeFile, turns: Sequence[str]
) -> Iterator[Diagnostic]:
    yield from not_finite(document, ("tool",), file.tool or ())
    if not turns:
        return
    missing = [name for name in ("EA", "EB", "EC") if name not in turns]
    if missing:
        message = f"{turns[0]} is there and {missing[0]} is not"
        yield Diagnostic("GX404", message, document.where(turns[0]), "give all three, or none")
    if file.tool is None:
        message = f"{turns[0]} is given, and the file does not say which point was measured"
        hint = "add tool = [x, y, z]: from the gauge point of the spindle to that point, in mm"
        yield Diagnostic("GX414", message, document.where(turns[0]), hint)


def _shape_findings(
    document: TomlText, keys: tuple[Any, ...], rows: Any, sizes: Sequence[int]
) -> list[Diagnostic]:
    """Return what is wrong with the size and the numbers of a nested list."""
    name = str(keys[0]) + "".join(f"[{k + 1}]" for k in keys[1:])
    if not sizes:
        bad = (
            []
            if np.isfinite(rows)
            else [Diagnostic("GX412", f"{name} is {rows}", document.where(*keys))]
        )
        return bad
    if len(rows) != sizes[0]:
        message = f"{name} has {len(rows)} of {sizes[0]} entries"
        return [Diagnostic("GX410", message, document.where(*keys))]
    if len(sizes) == 1 and np.isfinite(rows).all():
        return []
    return [
        f
        for k, row in enumerate(rows)
        for f in _shape_findings(document, (*keys, k), row, sizes[1:])
    ]
