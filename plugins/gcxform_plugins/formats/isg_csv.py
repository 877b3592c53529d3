"""ISG CSV: the machine errors of ISG's kernel, which is also Beckhoff's TF5280."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Floats
from gcxform_plugins.formats.shared import parameters
from gcxform_plugins.formats.shared.parameters import Order, Parameters, Said, Tool, Values

ARGUMENTS = "XYZABC"
BREAK = "#"


@dataclass(frozen=True)
class IsgCsv(gx.ErrorFormat):
    """ISG CSV (ISG kernel, Beckhoff TF5280): component errors by their ISO 230-1 names.

    A header names arguments and parameters, rows of numbers follow, `#` begins another table, `//`
    a comment. Values are mm and rad. Each function depends on its own axis; tables over two axes
    are refused, and so are errors of rotary axes. `workpiece_axes` of the control is to be empty.
    """

    values: Values
    order: Order = None
    tool: Tool = None

    name: ClassVar[str] = "isg-csv"
    suffixes: ClassVar[tuple[str, ...]] = (".csv",)
    control: ClassVar[str] = (
        "ISG kernel or TF5280, file_format[i] = ISG_CSV; the chain in this order of axes, "
        "workpiece_axes empty, negate off for errors"
    )

    @classmethod
    def recognises(cls, path: Path) -> bool:
        """Return whether the first line that is no comment names ISO 230-1 parameters."""
        lines = (line.partition("//")[0].split() for line in gx.head_of(path).splitlines())
        words = next((line for line in lines if line), [])
        return bool(words) and all(
            re.fullmatch("[XYZABC]|[EXYZABC][XYZABC0][XYZABC]", w) for w in words
        )

    @property
    def _said(self) -> Said:
        return Said(self.name, self.values, self.order, self.tool)

    def read(self, path: Path) -> gx.AxisFunctions | gx.RigidBody:
        """Return the functions of the file."""
        rows = gx.text_rows(path, comment="//")
        if not rows:
            raise gx.UsageError.one("GX417", "the table is empty", gx.Location(str(path)))
        found = Parameters()
        table: list[gx.TextRow] = []
        for row in rows:
            if row.word(0) == BREAK:
                _take(table, found)
                table = []
            else:
                table.append(row)
        _take(table, found)
        return found.model(self._said)

    def write(self, model: gx.ErrorModel) -> dict[str, str]:
        """Return one table for each axis."""
        tables = []
        for axis, position, values in parameters.functions_of(self._said, model):
            names = [f"E{column}{axis}" for column in parameters.COLUMNS[: values.shape[1]]]
            lines = [" ".join([axis, *names])]
            for where, row in zip(position.tolist(), values, strict=True):
                lines.append(" ".join([gx.decimal(where), *parameters.written(row)]))
            tables.append("\n".join(lines) + "\n")
        return {"": f"{BREAK}\n".join(tables)}


def _take(rows: list[gx.TextRow], found: Parameters) -> None:
    """Read one table with its header."""
    if not rows:
        return
    header, *lines = rows
    names = [word[0] for word in header.words]
    arguments = [k for k, name in enumerate(names) if name in ARGUMENTS]
    if len(arguments) > 1:
        message = f"a table over {' and '.join(names[k] for k in arguments)}"
        raise header.refuse("GX482", f"{message} is not supported", arguments[1])
    for column, name in enumerate(names):
        if column not in arguments:
            found.claim(name, header, column)
    if bad := [f for row in lines for f in gx.number_findings(row, len(names))]:
        raise gx.UsageError(tuple(bad))
    numbers = np.array([row.numbers(len(names)) for row in lines]).reshape(-1, len(names))
    if arguments:
        _functions(header, lines, names, numbers, arguments[0], found)
    else:
        _constants(header, lines, names, numbers, found)


def _functions(
    header: gx.TextRow,
    lines: list[gx.TextRow],
    names: list[str],
    numbers: Floats,
    argument: int,
    found: Parameters,
) -> None:
    for column, name in enumerate(names):
        if column != argument and (name[0] != "E" or name[-1] != names[argument]):
            message = f"{name} over {names[argument]} is not supported"
            raise header.refuse("GX482", message, column)
    parameters.checked_function(lines or [header], numbers, argument)
    for column, name in enumerate(names):
        if column != argument:
            found.functions[name] = numbers[:, argument], numbers[:, column]


def _constants(
    header: gx.TextRow,
    lines: list[gx.TextRow],
    names: list[str],
    numbers: Floats,
    found: Parameters,
) -> None:
    """Take squareness, which has one row."""
    if functions := [k for k, name in enumerate(names) if name[0] == "E"]:
        message = f"{names[functions[0]]} needs the column {names[functions[0]][-1]}"
        raise header.refuse("GX417", message, functions[0])
    if len(lines) != 1 or not np.isfinite(numbers).all():
        message = f"squareness is one row of numbers, not {len(lines)}"
        raise header.refuse("GX418", message, 0)
    found.squareness.update(zip(names, numbers[0].tolist(), strict=True))
