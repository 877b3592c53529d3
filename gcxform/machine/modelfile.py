"""Files of error models: the native TOML and the door to foreign formats.

Names are those of ISO 230-1: EYX is the error in Y of the axis X, A0Z the squareness of Z about X.
Lengths are in mm, angles in rad. What is read is the error, actual minus nominal; a file of
corrections (`values = "correction"`) is negated.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Literal

import msgspec
import numpy as np

from gcxform.diagnostics import Diagnostic, Location, UsageError
from gcxform.machine.errors import (
    AXES,
    AxisFunction,
    AxisFunctions,
    ErrorModel,
    FloatArray,
    check_contraction,
    faults,
)
from gcxform.machine.formats import ErrorFormat
from gcxform.tomltext import Codes, TomlText, convert, did_you_mean, read_toml

FORMAT = 1
CODES = Codes("GX401", "GX402", "GX403", "GX404", "GX405")
SUFFIX = ".toml"


class _Table(msgspec.Struct, forbid_unknown_fields=True, kw_only=True):
    position: list[float]


class TableX(_Table, kw_only=True):
    """The functions of the axis X, mm and rad, over its position in mm."""

    EXX: list[float]
    EYX: list[float]
    EZX: list[float]
    EAX: list[float] | None = None
    EBX: list[float] | None = None
    ECX: list[float] | None = None


class TableY(_Table, kw_only=True):
    """The functions of the axis Y, mm and rad, over its position in mm."""

    EXY: list[float]
    EYY: list[float]
    EZY: list[float]
    EAY: list[float] | None = None
    EBY: list[float] | None = None
    ECY: list[float] | None = None


class TableZ(_Table, kw_only=True):
    """The functions of the axis Z, mm and rad, over its position in mm."""

    EXZ: list[float]
    EYZ: list[float]
    EZZ: list[float]
    EAZ: list[float] | None = None
    EBZ: list[float] | None = None
    ECZ: list[float] | None = None


class Squareness(msgspec.Struct, forbid_unknown_fields=True, kw_only=True):
    """Squareness errors in rad, right-handed turns of an axis: Y to X, Z to X, Z to Y."""

    C0Y: float = 0.0
    B0Z: float = 0.0
    A0Z: float = 0.0


class AxisFunctionsFile(msgspec.Struct, forbid_unknown_fields=True, rename="kebab", kw_only=True):
    """An error model of the kind `axis-functions`: one table per moving axis."""

    format: int
    kind: Literal["axis-functions"]
    values: Literal["error", "correction"]
    convention: Literal["relative", "carriage"]
    order: str = AXES
    X: TableX | None = None
    Y: TableY | None = None
    Z: TableZ | None = None
    squareness: Squareness | None = None


def load_model(path: Path, formats: Sequence[type[ErrorFormat]] = ()) -> ErrorModel:
    """Return the error model of a file: native TOML by its suffix, otherwise a foreign format.

    Raises UsageError, with the place in the file, for all that is wrong with it.
    """
    model = _foreign(path, formats) if path.suffix.lower() != SUFFIX else _native(path)
    check_contraction(model, Location(str(path)))
    return model


def _foreign(path: Path, formats: Sequence[type[ErrorFormat]]) -> ErrorModel:
    where = Location(str(path))
    if not path.exists():
        raise UsageError.one("GX401", "the file cannot be read: it does not exist", where)
    for form in formats:
        if form.recognises(path):
            return form.read(path)
    known = [f"TOML ({SUFFIX})", *(f"{f.name} ({', '.join(f.suffixes)})" for f in formats)]
    raise UsageError.one(
        "GX416",
        f"no format of error models fits this {'directory' if path.is_dir() else 'file'}",
        where,
        f"known: {', '.join(known)}",
    )


def _native(path: Path) -> ErrorModel:
    document = read_toml(path, CODES)
    check_version(document, "error models")
    kind = document.values.get("kind")
    if kind is None:
        raise document.missing_key(("kind",))
    if not isinstance(kind, str) or kind not in KINDS:
        raise UsageError.one(
            "GX407",
            f"error models of the kind {kind!r} are not known",
            document.where("kind"),
            did_you_mean(str(kind), KINDS),
        )
    return KINDS[kind](document)


def check_version(document: TomlText, what: str) -> None:
    """Raise UsageError unless a file of machines or their errors has the format of today."""
    version = document.values.get("format")
    if version is None:
        raise document.missing_key(("format",))
    if version != FORMAT or isinstance(version, bool):
        message = f"format {version!r} of {what} is not known, only format = {FORMAT} is"
        raise UsageError.one("GX406", message, document.where("format"))


def _axis_functions(document: TomlText) -> AxisFunctions:
    file = convert(document, AxisFunctionsFile)
    if found := [*_refusals(document, file), *_table_findings(document, file)]:
        raise UsageError(tuple(sorted(found, key=_line)))
    sign = -1.0 if file.values == "correction" else 1.0
    shear = _shear(file.squareness)
    x, y, z = (_function(_table(file, k), k, sign, shear[k]) for k in range(3))
    return AxisFunctions((x, y, z), file.order)


def _line(finding: Diagnostic) -> int:
    return finding.where.line if finding.where else 0


KINDS: dict[str, Callable[[TomlText], ErrorModel]] = {AxisFunctions.kind: _axis_functions}


def _table(file: AxisFunctionsFile, axis: int) -> _Table | None:
    table: _Table | None = getattr(file, AXES[axis])
    return table


def _functions(table: _Table) -> dict[str, list[float]]:
    """Return the columns of a table which are there, without the position."""
    columns = msgspec.structs.asdict(table)
    del columns["position"]
    return {name: values for name, values in columns.items() if values is not None}


def _function(
    table: _Table | None, axis: int, sign: float, shear: FloatArray
) -> AxisFunction | None:
    """Return the function of one axis, the squareness (3,) in mm per mm folded in."""
    if table is None:
        return None
    functions = _functions(table)
    columns = [functions[f"E{direction}{AXES[axis]}"] for direction in AXES]
    position = np.array(table.position, dtype=np.float64)
    values = sign * np.array(columns, dtype=np.float64).T + position[:, None] * shear
    return AxisFunction(position, values)


def _shear(square: Squareness | None) -> FloatArray:
    """Return the slopes (axis, direction) in mm per mm of squareness errors.

    An axis turned by a small e moves by q (e x u) off its nominal line q u (rigid body, first
    order): about Z for u = Y that is -C0Y y in X, for u = Z it is B0Z z in X and -A0Z z in Y.
    """
    shear = np.zeros((3, 3))
    if square is not None:
        shear[1, 0] = -square.C0Y
        shear[2, 0], shear[2, 1] = square.B0Z, -square.A0Z
    return shear


def _refusals(document: TomlText, file: AxisFunctionsFile) -> Iterator[Diagnostic]:
    """Yield what the model of nine functions cannot honour."""
    if file.convention == "carriage":
        yield Diagnostic(
            "GX413",
            "errors of the carriages need to know which axes carry the workpiece",
            document.where("convention"),
            "give the errors of the tool relative to the workpiece: convention = 'relative'",
        )
    if sorted(file.order) != sorted(AXES):
        message = f"order {file.order!r} has to name each of X, Y and Z once"
        yield Diagnostic("GX421", message, document.where("order"))
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
        for name, values in functions.items():
            if name[1] in "ABC" and any(values):
                yield Diagnostic(
                    "GX414",
                    f"{name} is not zero and the model of nine functions has no angular errors",
                    document.where(axis, name),
                    "leave it out only if the error at the tool tip is in the tables already",
                )


def to_toml(model: AxisFunctions) -> str:
    """Return a model as native TOML; every number reads back as the same bits."""
    head = {
        "kind": model.kind,
        "values": "error",
        "convention": "relative",
        "order": model.order,
    }
    lines = [f"format = {FORMAT}", *(f'{key} = "{value}"' for key, value in head.items())]
    for axis, function in zip(AXES, model.axes, strict=True):
        if function is not None:
            lines += ["", f"[{axis}]", f"position = {function.position.tolist()}"]
            columns = zip(AXES, function.values.T.tolist(), strict=True)
            lines += [f"E{direction}{axis} = {values}" for direction, values in columns]
    return "\n".join(lines) + "\n"
