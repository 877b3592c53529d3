"""CSV files of diagonal measurements and of linear tests.

Their common form is that of `gcxform/calibrate/csv_text.py`.

Diagonals: a row for each stop, in the order of the measurement.

    diagonal, direction, X [mm], Y [mm], Z [mm], reading [mm], temperature table [degC]
    ppp,      +,         0,      0,      0,      0.0000,       20.1
    ppp,      +,         48,     0,      0,      31.2799,      20.1
    ppp,      +,         48,     33,     0,      46.0626,      20.1
    ppp,      +,         48,     33,     45,     73.5620,      20.1
    ...

`diagonal` has the signs of the motions of X, Y, Z: ppp, npp, pnp, ppn (or +++, -++ ...). X, Y and Z
are nominal machine positions. There is either `reading`, what the laser shows along the beam, or
`deviation`, the reading minus its nominal. Optional: `direction`, + on the way out (also without
the column) and - on the way back, which is measured Z, Y, X; `run`, any text that tells repetitions
apart. Columns whose names begin with temperature, pressure or humidity go to the report, with their
units. A leg ends where diagonal, run or direction change. For a plain test two rows a leg do.

Linear tests: the moving axis is the one position column there is.

    X [mm], direction, deviation [um], temperature [degC]
    0,      +,         0.0,            20.2
    48,     +,         -0.9,           20.2

A constant in a run means nothing: where it was set to zero is not used.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from gcxform.calibrate.csv_text import CsvTable, parse_csv, read_csv
from gcxform.calibrate.diagonal.readings import (
    Diagonals,
    Leg,
    LinearTest,
    Signs,
    Volume,
    beam,
    plain_diagonals,
    step_diagonals,
)
from gcxform.diagnostics import InputError, Location
from gcxform.errormodel.model import AXES, BORDER
from gcxform.system.arrays import Floats

CONDITIONS = ("temperature", "pressure", "humidity")
_WAYS = {"": True, "+": True, "-": False}
_SIGNS = re.compile(r"[pn+-]{3}")
_VALUES = ("reading", "deviation")
_LABELS = ("run", "direction")


class Measured(NamedTuple):
    """A file as read: its name, the diagonals, what was carried (column: least, mean, most)."""

    file: str
    diagonals: Diagonals
    conditions: dict[str, dict[str, Any]]


class MeasuredLinear(NamedTuple):
    """A file of linear tests: its name, the runs, what was carried."""

    file: str
    tests: tuple[LinearTest, ...]
    conditions: dict[str, dict[str, Any]]


def read_diagonals(path: Path, plain: bool = False) -> Measured:
    """Return the diagonals of a file. Raises FileError, and InputError with the place."""
    return _measured(read_csv(path), plain)


def parse_diagonals(text: str, plain: bool = False) -> Measured:
    """Return the same from a text."""
    return _measured(parse_csv(text), plain)


def read_linear(path: Path, volume: Volume) -> MeasuredLinear:
    """Return the linear tests of a file. Raises FileError, and InputError with the place."""
    return _linear(read_csv(path), volume)


def parse_linear(text: str, volume: Volume) -> MeasuredLinear:
    """Return the same from a text."""
    return _linear(parse_csv(text), volume)


def _measured(table: CsvTable, plain: bool) -> Measured:
    letters = [axis.lower() for axis in AXES]
    table.refuse_unknown(["diagonal", *_LABELS, *letters, *_VALUES], CONDITIONS)
    table.need("diagonal", *letters)
    kind = _value_column(table)
    position = np.column_stack([table.lengths(letter) for letter in letters])
    values = table.lengths(kind)
    signs, forward = _signs(table), _forward(table)
    parts = _parts(table, "diagonal", *_LABELS)
    legs = [
        _leg(signs[part.start], forward[part.start], position[part], values[part], kind)
        for part in parts
    ]
    check = plain_diagonals if plain else step_diagonals

    def where(leg: int, row: int, column: str) -> Location:
        return table.where(parts[leg].start + row, column)

    return Measured(table.file, check(legs, where), _conditions(table, parts, "diagonal"))


def _value_column(table: CsvTable) -> str:
    """Return which of `reading` and `deviation` there is."""
    present = [name for name in _VALUES if name in table.headings]
    if len(present) != 1:
        has = "both columns" if present else "neither of the columns"
        message = f"the table has {has} reading and deviation"
        place = table.heading_place(present[-1] if present else "")
        raise InputError.one(
            "GX470", message, place, "give one of them, with its unit: reading [mm]"
        )
    return present[0]


def _leg(signs: Signs, forward: bool, position: Floats, values: Floats, kind: str) -> Leg:
    """Return a leg; of readings the nominal is taken off."""
    if kind == "reading":
        away = position - position[0]
        travel = np.abs(away[-1])
        nominal = away @ beam(signs, travel) if travel.any() else 0.0
        values = values - values[0] - nominal
    return Leg(signs, position, values, forward)


def _signs(table: CsvTable) -> list[Signs]:
    found: list[Signs] = []
    for row, text in enumerate(table.texts("diagonal")):
        if not _SIGNS.fullmatch(text.lower()):
            message = f"{text!r} is not a diagonal"
            hint = "write the signs of the motions of X, Y and Z: ppp, npp, pnp, ppn"
            raise InputError.one("GX472", message, table.where(row, "diagonal"), hint)
        x, y, z = (1 if mark in "p+" else -1 for mark in text.lower())
        found.append((x, y, z))
    return found


def _forward(table: CsvTable) -> list[bool]:
    texts = table.texts("direction")
    for row, text in enumerate(texts):
        if text not in _WAYS or ("direction" in table.headings and not text):
            message = f"{text!r} is not a direction"
            hint = "write + on the way out and - on the way back"
            raise InputError.one("GX472", message, table.where(row, "direction"), hint)
    return [_WAYS[text] for text in texts]


def _parts(table: CsvTable, *labels: str) -> list[slice]:
    """Return the stretches of rows with the same labels."""
    marks = list(zip(*(table.texts(label) for label in labels), strict=True))
    starts = [k for k in range(len(marks)) if k == 0 or marks[k] != marks[k - 1]]
    return [slice(a, b) for a, b in zip(starts, [*starts[1:], len(marks)], strict=True)]


def _conditions(table: CsvTable, parts: Sequence[slice], label: str) -> dict[str, dict[str, Any]]:
    """Return least, mean and most of each condition over the file, and its mean in each part."""
    found: dict[str, dict[str, Any]] = {}
    names = table.texts(label)
    for heading in table.headings.values():
        if heading.name.startswith(CONDITIONS):
            values = table.numbers(heading.name)
            means = [[names[p.start], round(float(values[p].mean()), 6)] for p in parts]
            found[heading.name] = {
                "unit": heading.unit,
                "least": float(values.min()),
                "mean": round(float(values.mean()), 6),
                "most": float(values.max()),
                "legs": means,
            }
    return found


def _linear(table: CsvTable, volume: Volume) -> MeasuredLinear:
    letters = [axis.lower() for axis in AXES]
    table.refuse_unknown([*letters, *_LABELS, "deviation"], CONDITIONS)
    table.need("deviation")
    moving = [letter for letter in letters if letter in table.headings]
    if len(moving) != 1:
        has = " and ".join(letter.upper() for letter in moving) or "no axis"
        message = f"a linear test has a column for the axis that moves, and this table has {has}"
        raise InputError.one("GX470", message, table.heading_place(), "as in: X [mm]")
    axis = letters.index(moving[0])
    position, values = table.lengths(moving[0]), table.lengths("deviation")
    _forward(table)
    _check_inside(table, moving[0], position, volume)
    parts = _parts(table, *_LABELS)
    for part in parts:
        if np.ptp(position[part]) <= BORDER:
            message = "a run of a linear test needs two positions"
            raise InputError.one("GX474", message, table.where(part.start, moving[0]))
    tests = tuple(LinearTest(axis, position[part], values[part]) for part in parts)
    return MeasuredLinear(table.file, tests, _conditions(table, parts, moving[0]))


def _check_inside(table: CsvTable, name: str, position: Floats, volume: Volume) -> None:
    """Raise InputError (GX474) for a position at which the diagonals say nothing."""
    axis = AXES.lower().index(name)
    low, high = volume.nodes(axis)[[0, -1]]
    beyond = np.flatnonzero((position < low - BORDER) | (position > high + BORDER))
    if len(beyond):
        at = position[beyond[0]]
        message = f"{AXES[axis]} {at:.6g} is outside the diagonals, {low:.6g} to {high:.6g} mm"
        hint = "leave the positions outside out: a constant in a run means nothing"
        raise InputError.one("GX474", message, table.where(int(beyond[0]), name), hint)
