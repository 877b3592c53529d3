"""Readings of temperature sensors: a CSV file of one row a time, and the row that holds at a time.

    time,T0 [degC],T1 [degC],housing [K]
    2026-03-04T08:00:00,22.0,22.1,295.4

The first column is the time (ISO 8601, ascending; with an offset from UTC in all rows or in none).
Cells are set off by commas, or by semicolons if the header has some; `#` begins a remark. Only the
cells that are asked for are read as numbers: a gap of last week is no reason to refuse today.
"""

from __future__ import annotations

import bisect
import itertools
import math
from collections.abc import Sequence
from dataclasses import replace
from datetime import datetime
from pathlib import Path
from typing import NamedTuple

from gcxform.config.toml_text import did_you_mean, read_text
from gcxform.diagnostics import Diagnostic, Location, UsageError
from gcxform.values import dataclass

TIME = "time"
KELVIN = 273.15  # K at 0 degC
UNITS = {"degC": 0.0, "°C": 0.0, "C": 0.0, "K": KELVIN}
"""What is taken off a reading to have it in degC, by unit."""


class Cell(NamedTuple):
    """A cell of the file: its text, and the column (from 1) where the text begins."""

    text: str
    column: int


class Row(NamedTuple):
    """A row of the file: its line (from 1), its text, and its time."""

    line: int
    text: str
    time: datetime


@dataclass(frozen=True)
class Readings:
    """A file of readings: its name, what separates cells, the sensors with their units, the rows.

    Each sensor is the column (from 0) and what is taken off to have degC.
    """

    file: str
    separator: str
    sensors: dict[str, tuple[int, float]]
    rows: tuple[Row, ...]

    def at(self, time: datetime | None, oldest: float, where: Location | None) -> Row:
        """Return the last row at or before a time, at most `oldest` s before it; None: the last.

        Raises UsageError, at the place `where` the time was said.
        """
        if time is None:
            return self.rows[-1]
        if (time.tzinfo is None) != (self.rows[0].time.tzinfo is None):
            has = "no offset" if self.rows[0].time.tzinfo is None else "an offset"
            message = f"the times of {Path(self.file).name} have {has} from UTC, unlike {time}"
            raise UsageError.one("GX426", message, where, "write the time as in the file")
        number = bisect.bisect_right([row.time for row in self.rows], time)
        if not number:
            message = f"there are no readings before {self.rows[0].time.isoformat()}"
            raise UsageError.one("GX426", message, where)
        row = self.rows[number - 1]
        age = (time - row.time).total_seconds()
        if age > oldest:
            message = f"the last readings before {time.isoformat()} are {age:g} s old"
            place = f"line {row.line} of {Path(self.file).name}"
            hint = f"they may be {oldest:g} s old (max-age), and are in {place}"
            raise UsageError.one("GX426", message, where, hint)
        return row

    def temperatures(
        self, row: Row, names: Sequence[str], valid: tuple[float, float]
    ) -> tuple[float, ...]:
        """Return the readings of sensors in a row, degC. Raises UsageError for each not `valid`."""
        cells = _cells(row.text, self.separator)
        if len(cells) <= max(self.sensors[name][0] for name in names):
            message = f"the row has {len(cells)} of {len(self.sensors) + 1} cells"
            end = len(row.text.rstrip()) + 1
            raise UsageError.one("GX418", message, self._place(row, Cell("", end)))
        if more := [cell for cell in cells[len(self.sensors) + 1 :] if cell.text]:
            message = f"the row has {len(cells)} cells, and {len(self.sensors) + 1} have a name"
            hint = "decimals are set off by a point" if self.separator == "," else ""
            raise UsageError.one("GX418", message, self._place(row, more[0]), hint)
        found, faults = [], []
        for name in names:
            column, offset = self.sensors[name]
            value, fault = _temperature(name, cells[column].text, offset, valid)
            found.append(value)
            if fault:
                faults.append(Diagnostic(*fault, self._place(row, cells[column])))
        if faults:
            raise UsageError(tuple(dict.fromkeys(faults)))
        return tuple(found)

    def _place(self, row: Row, cell: Cell) -> Location:
        return Location(self.file, row.line, cell.column, row.text, max(1, len(cell.text)))


def _temperature(
    name: str, text: str, offset: float, valid: tuple[float, float]
) -> tuple[float, tuple[str, str] | None]:
    """Return a reading in degC, and code and message if it is none."""
    if not text:
        return math.nan, ("GX427", f"the sensor {name} has no reading")
    try:
        value = float(text.replace("_", "?")) - offset  # Python takes 2_2 for 22
    except ValueError:
        return math.nan, ("GX419", f"the sensor {name} reads {text!r}, which is not a number")
    if not math.isfinite(value):
        return value, ("GX427", f"the sensor {name} reads {text}")
    low, high = valid
    if not low <= value <= high:
        message = f"the sensor {name} reads {value:g} degC, outside of {low:g} to {high:g}"
        return value, ("GX427", message)
    return value, None


def read_readings(path: Path) -> Readings:
    """Return a file of readings. Raises UsageError with file, line and column."""
    text = read_text(path, "GX401", "GX402")
    lines = [(k, line) for k, line in enumerate(text.splitlines(), 1) if _has_cells(line)]
    if len(lines) < 2:
        message = "the file has no readings: needed are a header and a row"
        raise UsageError.one("GX411", message, Location(str(path)))
    (number, header), *rest = lines
    separator = ";" if ";" in header else ","
    sensors = _sensors(path, number, header, separator)
    rows = tuple(_row(path, k, line, separator) for k, line in rest)
    _check_ascending(path, rows)
    return Readings(str(path), separator, sensors, rows)


def _has_cells(line: str) -> bool:
    return bool(line.strip()) and not line.lstrip().startswith("#")


def _cells(line: str, separator: str) -> list[Cell]:
    cells, at = [], 0
    for part in line.split(separator):
        cells.append(Cell(part.strip(), at + len(part) - len(part.lstrip()) + 1))
        at += len(part) + 1
    return cells


def _sensors(path: Path, number: int, header: str, separator: str) -> dict[str, tuple[int, float]]:
    """Return column and offset of each sensor of the header."""
    found: dict[str, tuple[int, float]] = {}
    for column, cell in enumerate(_cells(header, separator)):
        where = Location(str(path), number, cell.column, header, max(1, len(cell.text)))
        if not column:
            if cell.text != TIME:
                message = f"the first column is not {TIME!r}"
                ours = any(other.text == TIME for other in _cells(header, separator))
                where = where if ours else replace(where, text="")  # others may be secret
                raise UsageError.one("GX417", message, where)
            continue
        name, _, unit = cell.text.removesuffix("]").partition("[")
        name = name.strip()
        if unit not in UNITS or not name:
            hint = f"write {name or 'T0'} [degC] or {name or 'T0'} [K]"
            message = f"{cell.text!r} is not the name of a sensor and its unit"
            raise UsageError.one("GX417", message, where, hint)
        if name in found:
            raise UsageError.one("GX417", f"the sensor {name} stands twice", where)
        found[name] = column, UNITS[unit]
    return found


def _row(path: Path, number: int, line: str, separator: str) -> Row:
    cell = _cells(line, separator)[0]
    try:
        return Row(number, line, datetime.fromisoformat(cell.text))
    except ValueError:
        where = Location(str(path), number, cell.column, line, max(1, len(cell.text)))
        message = f"{cell.text!r} is not a time"
        hint = "write 2026-03-04T08:00:00, with an offset such as +01:00 in all rows or in none"
        raise UsageError.one("GX419", message, where, hint) from None


def _check_ascending(path: Path, rows: Sequence[Row]) -> None:
    """Refuse times that do not ascend, or of which some only have an offset from UTC."""
    for before, row in itertools.pairwise(rows):
        where = Location(str(path), row.line, 1, row.text)
        if (before.time.tzinfo is None) != (row.time.tzinfo is None):
            message = f"one of {before.time} and {row.time} has an offset from UTC"
            raise UsageError.one("GX426", message, where)
        if row.time == before.time:
            raise UsageError.one("GX409", f"the time {row.time.isoformat()} stands twice", where)
        if row.time < before.time:
            message = f"the time {row.time.isoformat()} comes after {before.time.isoformat()}"
            raise UsageError.one("GX408", message, where)


def unknown_sensor(readings: Readings, name: str, where: Location) -> UsageError:
    """Return the error for a sensor which the file does not have."""
    message = f"{Path(readings.file).name} has no sensor {name!r}"
    return UsageError.one("GX427", message, where, did_you_mean(name, readings.sensors))
