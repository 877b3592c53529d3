"""Error models of the kind `axis-functions`: nine functions, or eighteen with angular errors.

Names are those of ISO 230-1: EYX is the error in Y of the axis X, EAX its roll, A0Z the squareness
of Z about X. Squareness is folded into the functions of the axis that is out of square. Errors of
carriages become errors of the tool relative to the workpiece: where a carriage moves the workpiece,
its displacement d and turn e count as -d - e x (its own position), at the nodes.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Annotated, Any, Literal

import msgspec
import numpy as np

from gcxform.config.keys import says
from gcxform.config.toml_text import TomlText, convert
from gcxform.diagnostics import Diagnostic, UsageError
from gcxform.errormodel.functions import COLUMNS, AxisFunction, AxisFunctions, faults
from gcxform.errormodel.model import AXES
from gcxform.errormodel.rigid import NOWHERE, RigidBody
from gcxform.system.arrays import Floats

FRAME = "F"
Triple = tuple[float, float, float]


class _Table(msgspec.Struct, forbid_unknown_fields=True, kw_only=True):
    position: Annotated[list[float], says("positions that were measured, mm, rising")]
    at: Annotated[Triple, says("where the other axes stood, mm; it matters with turns")] = NOWHERE


class TableX(_Table, kw_only=True):
    """The functions of the axis X, mm and rad, over its position in mm."""

    EXX: Annotated[list[float], says("errors in X at the positions, mm")]
    EYX: Annotated[list[float], says("errors in Y at the positions, mm")]
    EZX: Annotated[list[float], says("errors in Z at the positions, mm")]
    EAX: Annotated[list[float] | None, says("turns about X at the positions, rad")] = None
    EBX: Annotated[list[float] | None, says("turns about Y at the positions, rad")] = None
    ECX: Annotated[list[float] | None, says("turns about Z at the positions, rad")] = None


class TableY(_Table, kw_only=True):
    """The functions of the axis Y, mm and rad, over its position in mm."""

    EXY: Annotated[list[float], says("errors in X at the positions, mm")]
    EYY: Annotated[list[float], says("errors in Y at the positions, mm")]
    EZY: Annotated[list[float], says("errors in Z at the positions, mm")]
    EAY: Annotated[list[float] | None, says("turns about X at the positions, rad")] = None
    EBY: Annotated[list[float] | None, says("turns about Y at the positions, rad")] = None
    ECY: Annotated[list[float] | None, says("turns about Z at the positions, rad")] = None


class TableZ(_Table, kw_only=True):
    """The functions of the axis Z, mm and rad, over its position in mm."""

    EXZ: Annotated[list[float], says("errors in X at the positions, mm")]
    EYZ: Annotated[list[float], says("errors in Y at the positions, mm")]
    EZZ: Annotated[list[float], says("errors in Z at the positions, mm")]
    EAZ: Annotated[list[float] | None, says("turns about X at the positions, rad")] = None
    EBZ: Annotated[list[float] | None, says("turns about Y at the positions, rad")] = None
    ECZ: Annotated[list[float] | None, says("turns about Z at the positions, rad")] = None


class Squareness(msgspec.Struct, forbid_unknown_fields=True, kw_only=True):
    """Squareness errors in rad, right-handed turns of an axis: Y to X, Z to X, Z to Y."""

    C0Y: Annotated[float, says("turns Y about Z, from where it is square to X, rad")] = 0.0
    B0Z: Annotated[float, says("turns Z about Y, from where it is square to X, rad")] = 0.0
    A0Z: Annotated[float, says("turns Z about X, from where it is square to Y, rad")] = 0.0


class AxisFunctionsFile(msgspec.Struct, forbid_unknown_fields=True, rename="kebab", kw_only=True):
    """An error model of the kind `axis-functions`: one table per moving axis.

    `at` of a table is where the machine (mm) stood on the other axes when it was measured, `tool`
    the way (mm) from the gauge point to the measured point; both matter with angular errors only.
    """

    format: Annotated[int, says("the form of this file; now 1")]
    kind: Annotated[Literal["axis-functions"], says("the kind of the model")]
    values: Annotated[
        Literal["error", "correction"], says("what the numbers are: errors, or their corrections")
    ]
    convention: Annotated[
        Literal["relative", "carriage"],
        says("relative: of the tool to the workpiece; carriage: of what each axis moves"),
    ]
    order: Annotated[
        str,
        says("axes from the workpiece to the tool; with carriages F is the frame of the machine"),
    ] = AXES
    tool: Annotated[
        Triple | None,
        says("from the gauge point to the point that was measured, mm; turns need it"),
    ] = None
    X: Annotated[TableX | None, says("the functions of X")] = None
    Y: Annotated[TableY | None, says("the functions of Y")] = None
    Z: Annotated[TableZ | None, says("the functions of Z")] = None
    squareness: Annotated[Squareness | None, says("squareness of the axes")] = None


def axis_functions(document: TomlText) -> AxisFunctions | RigidBody:
    """Return the model of a file of this kind. Raises UsageError for all that is wrong with it."""
    file = convert(document, AxisFunctionsFile)
    if found := [*_refusals(document, file), *_table_findings(document, file)]:
        raise UsageError(tuple(sorted(found, key=_line)))
    slopes = shear(file.squareness)
    x, y, z = (_function(file, k, slopes[k]) for k in range(3))
    order = file.order.replace(FRAME, "")
    if not any(f is not None and f.values.shape[1] > 3 for f in (x, y, z)):
        return AxisFunctions((x, y, z), order)
    at = [NOWHERE if (t := _table(file, k)) is None else t.at for k in range(3)]
    x, y, z = (None if f is None else _with_turns(f) for f in (x, y, z))
    return RigidBody((x, y, z), order, (at[0], at[1], at[2]), file.tool or NOWHERE)


def _with_turns(function: AxisFunction) -> AxisFunction:
    """Return the function with columns of angular errors, zero if it had none."""
    values = np.zeros((len(function.position), len(COLUMNS)))
    values[:, : function.values.shape[1]] = function.values
    return AxisFunction(function.position, values)


def _line(finding: Diagnostic) -> int:
    return finding.where.line if finding.where else 0


def _table(file: AxisFunctionsFile, axis: int) -> _Table | None:
    table: _Table | None = getattr(file, AXES[axis])
    return table


def _functions(table: _Table) -> dict[str, list[float]]:
    """Return the columns of a table which are there, without the position."""
    columns = msgspec.structs.asdict(table)
    return {name: v for name, v in columns.items() if name[0] == "E" and v is not None}


def _function(file: AxisFunctionsFile, axis: int, slopes: Floats) -> AxisFunction | None:
    """Return the function of one axis, the squareness (3,) in mm per mm folded in."""
    table = _table(file, axis)
    if table is None:
        return None
    functions = _functions(table)
    names = [f"E{letter}{AXES[axis]}" for letter in COLUMNS]
    position = np.array(table.position, dtype=np.float64)
    nothing = [0.0] * len(position)
    values = np.array([functions.get(name, nothing) for name in names], dtype=np.float64).T
    if file.convention == "carriage" and AXES[axis] in _workpiece_side(file):
        way = np.zeros((len(position), 3))
        way[:, axis] = position
        values[:, :3] += np.cross(values[:, 3:], way)
        values = -values
    values = (-1.0 if file.values == "correction" else 1.0) * values
    values[:, :3] += position[:, None] * slopes
    return AxisFunction(position, values if values[:, 3:].any() else values[:, :3])


def _workpiece_side(file: AxisFunctionsFile) -> str:
    """Return the axes that move the workpiece: those before the frame."""
    return file.order.partition(FRAME)[0]


def shear(square: Squareness | None) -> Floats:
    """Return the slopes (axis, direction) in mm per mm of squareness errors.

    An axis turned by a small e moves by q (e x u) off its nominal line q u (rigid body, first
    order): about Z for u = Y that is -C0Y y in X, for u = Z it is B0Z z in X and -A0Z z in Y.
    """
    slopes = np.zeros((3, 3))
    if square is not None:
        slopes[1, 0] = -square.C0Y
        slopes[2, 0], slopes[2, 1] = square.B0Z, -square.A0Z
    return slopes


def not_finite(
    document: TomlText, keys: tuple[Any, ...], numbers: Sequence[float]
) -> Iterator[Diagnostic]:
    """Yield the numbers of a list in a file that are none, or without end."""
    for k, value in enumerate(numbers):
        if not np.isfinite(value):
            yield Diagnostic("GX412", f"{keys[-1]} holds {value}", document.where(*keys, k))


def _refusals(document: TomlText, file: AxisFunctionsFile) -> Iterator[Diagnostic]:
    """Yield what contradicts itself in a file, and what is missing in it."""
    yield from not_finite(document, ("tool",), file.tool or ())
    if file.convention == "carriage" and FRAME not in file.order:
        yield Diagnostic(
            "GX413",
            "errors of the carriages need to know which axes carry the workpiece",
            document.where("convention"),
            "put F for the frame into order: order = 'XYFZ' where X and Y move the table",
        )
    if sorted(file.order.replace(FRAME, "", 1)) != sorted(AXES):
        message = f"order {file.order!r} has to name each of X, Y and Z once, and F at most once"
        yield Diagnostic("GX421", message, document.where("order"))
    else:
        yield from _lever_findings(document, file)
    if all(_table(file, k) is None for k in range(3)):
        message = "the error model has no table, needed is one of [X], [Y] and [Z]"
        yield Diagnostic("GX422", message, document.where())
    for name in ("C0Y", "B0Z", "A0Z"):
        yield from _squareness_findings(document, file, name)


def _squareness_findings(
    document: TomlText, file: AxisFunctionsFile, name: str
) -> Iterator[Diagnostic]:
    value = float(getattr(file.squareness, name, 0.0))
    where = document.where("squareness", name)
    if not np.isfinite(value):
        yield Diagnostic("GX412", f"{name} is {value}", where)
    elif value and getattr(file, name[2]) is None:
        message = f"{name} turns the axis {name[2]}, which has no table [{name[2]}]"
        hint = f"give [{name[2]}] with functions of 0.0 over the travel of the axis"
        yield Diagnostic("GX420", message, where, hint)
    elif value and file.values == "correction":
        # Is the angle the machine's or the correction's? Both are in use; a guess doubles it.
        message = f"the sign of {name} is not certain in a file of corrections"
        hint = "give the negated tables as values = 'error', and squareness as the machine's"
        yield Diagnostic("GX420", message, where, hint)


def _table_findings(document: TomlText, file: AxisFunctionsFile) -> Iterator[Diagnostic]:
    for k, axis in enumerate(AXES):
        table = _table(file, k)
        if table is None:
            continue
        functions = _functions(table)
        for fault in faults(table.position, functions):
            row = () if fault.row is None else (fault.row,)
            where = document.where(axis, fault.column, *row)
            yield Diagnostic(fault.code, f"[{axis}] {fault.message}", where)
        yield from not_finite(document, (axis, "at"), table.at)


def _lever_findings(document: TomlText, file: AxisFunctionsFile) -> Iterator[Diagnostic]:
    """Yield angular errors whose effect is not limited or not known."""
    order = file.order.replace(FRAME, "")
    for k, axis in enumerate(AXES):
        table = _table(file, k)
        turns = (
            [n for n, v in _functions(table).items() if n[1] in "ABC" and any(v)] if table else []
        )
        after = [
            letter for letter in order[order.index(axis) + 1 :] if getattr(file, letter) is None
        ]
        where = document.where(axis, turns[0]) if turns else None
        if turns and after:
            message = f"{turns[0]} acts on the lever of {after[0]}, which has no table [{after[0]}]"
            hint = f"give [{after[0]}] with functions of 0.0 over the travel of the axis"
            yield Diagnostic("GX414", message, where, hint)
        if turns and file.tool is None:
            message = f"{turns[0]} is not zero, and the file does not say which point was measured"
            hint = "add tool = [x, y, z]: from the gauge point of the spindle to that point, in mm"
            yield Diagnostic("GX414", message, where, hint)
            return
