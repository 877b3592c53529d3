"""What the formats of pitch tables share: which part of a model is the positioning of an axis."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

import gcxform as gx

AXES = "XYZ"
UNITS = {"mm": 1.0, "in": 25.4}
HINT = "--kind pitch keeps the positioning errors, and says what is left"


def pitch_tables(name: str, model: gx.ErrorModel) -> dict[str, gx.PitchTable]:
    """Return the tables of a model by axis, or refuse what else it has, for the format `name`."""
    if isinstance(model, gx.PitchTables):
        return {a: table for a, table in zip(AXES, model.axes, strict=True) if table is not None}
    if not isinstance(model, gx.AxisFunctions):
        raise gx.cannot_hold(name, f"a model of the kind {model.kind!r}", HINT)
    found = {}
    for k, (axis, function) in enumerate(zip(AXES, model.axes, strict=True)):
        if function is None:
            continue
        for d, direction in enumerate(AXES):
            if d != k and function.values[:, d].any():
                raise gx.cannot_hold(name, f"E{direction}{axis}", HINT)
        values = function.values[:, k]
        found[axis] = gx.PitchTable(function.position, values, values)
    return found


def tables_of(found: dict[str, gx.PitchTable]) -> gx.PitchTables:
    """Return the model of some axes."""
    x, y, z = (found.get(axis) for axis in AXES)
    return gx.PitchTables((x, y, z))


def checked(
    rows: Sequence[gx.TextRow], numbers: np.ndarray[tuple[int, int], np.dtype[np.float64]]
) -> None:
    """Raise UsageError if positions, in the first column, do not rise or numbers are not finite."""
    if not rows:
        return
    names = [f"column {k + 1}" for k in range(numbers.shape[1])]
    columns = dict(zip(names, numbers.T, strict=True))
    faults = list(gx.faults(numbers[:, 0], columns))
    if faults:
        raise gx.UsageError(tuple(_at(fault, rows) for fault in faults))


def _at(fault: gx.Fault, rows: Sequence[gx.TextRow]) -> gx.Diagnostic:
    column = 0 if fault.column == "position" else int(fault.column.split()[1]) - 1
    return gx.placed(fault, rows[fault.row or 0], column)


def named(found: dict[str, gx.PitchTable]) -> Iterator[tuple[str, gx.PitchTable]]:
    """Yield the axes with their tables in the order of the axes."""
    return ((axis, found[axis]) for axis in AXES if axis in found)
