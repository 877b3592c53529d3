"""Error models of the kind `pitch`: the positioning error of axes in both directions of travel."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Literal

import msgspec
import numpy as np

from gcxform.config.keys import says
from gcxform.config.toml_text import TomlText, convert
from gcxform.diagnostics import Diagnostic, UsageError
from gcxform.errormodel.functions import faults
from gcxform.errormodel.model import AXES
from gcxform.errormodel.pitch import PitchTable, PitchTables


class PitchAxis(msgspec.Struct, forbid_unknown_fields=True, kw_only=True):
    """The positioning error (mm) of one axis over its position (mm).

    `forward` is that after travel in the positive direction, `reverse` after the negative; without
    it there is no backlash.
    """

    position: Annotated[list[float], says("positions that were measured, mm, rising")]
    forward: Annotated[list[float], says("errors there after travel in the positive direction, mm")]
    reverse: Annotated[
        list[float] | None,
        says("errors there after travel in the negative direction, mm; absent: as forward"),
    ] = None


class PitchFile(msgspec.Struct, forbid_unknown_fields=True, kw_only=True):
    """An error model of the kind `pitch`: a table for each axis that was measured."""

    format: Annotated[int, says("the form of this file; now 1")]
    kind: Annotated[Literal["pitch"], says("the kind of the model")]
    values: Annotated[
        Literal["error", "correction"], says("what the numbers are: errors, or their corrections")
    ]
    X: Annotated[PitchAxis | None, says("the table of X")] = None
    Y: Annotated[PitchAxis | None, says("the table of Y")] = None
    Z: Annotated[PitchAxis | None, says("the table of Z")] = None


def pitch(document: TomlText) -> PitchTables:
    """Return the model of a file of this kind. Raises UsageError for all that is wrong with it."""
    file = convert(document, PitchFile)
    axes = [getattr(file, axis) for axis in AXES]
    if not any(axes):
        hint = "add [X], [Y] or [Z] with position, forward and reverse"
        raise UsageError.one("GX422", "the file has no table of an axis", document.where(), hint)
    if found := tuple(_findings(document, axes)):
        raise UsageError(found)
    sign = -1.0 if file.values == "correction" else 1.0
    x, y, z = (None if table is None else _table(table, sign) for table in axes)
    return PitchTables((x, y, z))


def _table(table: PitchAxis, sign: float) -> PitchTable:
    forward = sign * np.array(table.forward, np.float64)
    reverse = forward if table.reverse is None else sign * np.array(table.reverse, np.float64)
    return PitchTable(np.array(table.position, np.float64), forward, reverse)


def _findings(document: TomlText, axes: list[PitchAxis | None]) -> Iterator[Diagnostic]:
    for axis, table in zip(AXES, axes, strict=True):
        if table is None:
            continue
        columns = {"forward": table.forward}
        if table.reverse is not None:
            columns["reverse"] = table.reverse
        for fault in faults(table.position, columns):
            row = () if fault.row is None else (fault.row,)
            where = document.where(axis, fault.column, *row)
            yield Diagnostic(fault.code, f"[{axis}] {fault.message}", where)
