"""Tables of measurements in text files: a header with units, rows of numbers, places of faults.

    # what is behind a number sign is a comment
    diagonal, X [mm], Y [mm], Z [mm], reading [mm]
    ppp,      0,      0,      0,      0.0
    ppp,      48,     0,      0,      31.2816

The first row that is neither blank nor a comment is the header. Cells are set off by commas; where
the header has no comma by semicolons, and where it has neither by tabs. A column with a unit has it
in brackets, and there is no default: nobody can tell micrometres from millimetres by looking at
them. Decimals are set off by a point. Case and order of the columns are free.

Of a table that is not of this form a `Layout` says what the header would: the lines above it are
left out, and decimals may be set off by a comma.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from gcxform.config.toml_text import did_you_mean
from gcxform.diagnostics import Diagnostic, FileError, InputError, Location
from gcxform.system import inputs
from gcxform.system.arrays import Floats
from gcxform.values import dataclass

LENGTHS: Final[Mapping[str, float]] = {
    "mm": 1.0,
    "um": 1e-3,
    "\N{MICRO SIGN}m": 1e-3,
    "\N{GREEK SMALL LETTER MU}m": 1e-3,
    "nm": 1e-6,
    "m": 1000.0,
    "in": 25.4,
}
ANGLES: Final[Mapping[str, float]] = {"deg": 1.0, "rad": math.degrees(1.0)}
_HEADING = re.compile(r"(.*?)\s*(?:\[\s*(.*?)\s*\])?")
_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")


class Cell(NamedTuple):
    """The text of a cell without blanks, and the 1-based column in which it begins."""

    text: str
    column: int


class Row(NamedTuple):
    """A line with cells: its number in the file, from 1, and its text."""

    line: int
    text: str
    cells: tuple[Cell, ...]


class Heading(NamedTuple):
    """A column: its name in lower case, its unit (empty if none), where it stands."""

    name: str
    unit: str
    place: int


@dataclass(frozen=True)
class Layout:
    """How a table is laid out: its header where it has none of its own.

    `skip` lines above the table are left out; `comma` sets off decimals.
    """

    columns: str = ""
    skip: int = 0
    comma: bool = False


OWN: Final = Layout()


@dataclass(frozen=True)
class CsvTable:
    """A table as read: no value has been looked at, but every row has a cell for each heading."""

    file: str
    header: Row
    headings: Mapping[str, Heading]
    rows: tuple[Row, ...]
    comma: bool = False

    def __len__(self) -> int:
        return len(self.rows)

    def where(self, row: int, name: str = "") -> Location:
        """Return the place of a cell, of the whole row without a name."""
        return _place(self.file, self.rows[row], self.headings[name].place if name else None)

    def heading_place(self, name: str = "") -> Location:
        """Return the place of a heading, of the header without a name."""
        if not self.header.line:
            return Location("--columns")
        return _place(self.file, self.header, self.headings[name].place if name else None)

    def texts(self, name: str) -> list[str]:
        """Return a column as it stands; empty strings if there is none of that name."""
        if name not in self.headings:
            return [""] * len(self)
        place = self.headings[name].place
        return [row.cells[place].text for row in self.rows]

    def numbers(self, name: str) -> Floats:
        """Return a column (n,) in the unit of its heading. Raises InputError (GX471)."""
        found: list[Diagnostic] = []
        values = np.zeros(len(self))
        texts = self.texts(name)
        for k, text in enumerate(_pointed(texts) if self.comma else texts):
            problem, hint = _problem(text)
            if problem:
                found.append(Diagnostic("GX471", problem, self.where(k, name), hint))
            else:
                values[k] = float(text)
        if found:
            raise InputError(tuple(found))
        return values

    def angles(self, name: str) -> Floats:
        """Return a column (n,) in degrees. Raises InputError for its unit (GX470), its numbers."""
        return self.scaled(name, "an angle", ANGLES)

    def scaled(self, name: str, kind: str, known: Mapping[str, float]) -> Floats:
        """Return a column (n,) times what its unit is worth. Raises InputError as `angles`."""
        return self.numbers(name) * known[self._unit(name, kind, known)]

    def _unit(self, name: str, kind: str, known: Mapping[str, float]) -> str:
        """Return the unit of a column. Raises InputError (GX470) unless it is known."""
        unit = self.headings[name].unit
        if unit not in known:
            listed = [u for u in known if u.isascii()]
            message = f"{unit!r} is not a unit of {kind}" if unit else f"{name!r} has no unit"
            hint = f"write it as {name} [{listed[0]}]; units are {', '.join(listed)}"
            raise InputError.one("GX470", message, self.heading_place(name), hint)
        return unit

    def lengths(self, name: str) -> Floats:
        """Return a column (n,) in mm. Raises InputError for its unit (GX470) and its numbers."""
        unit = self._unit(name, "length", LENGTHS)
        values = self.numbers(name)
        # Through the decimals, so that 7 um are the double nearest to 0.007 mm.
        return values * LENGTHS[unit] if LENGTHS[unit] >= 1.0 else values / (1.0 / LENGTHS[unit])

    def refuse_unknown(self, known: Sequence[str], prefixes: tuple[str, ...] = ()) -> None:
        """Raise InputError (GX470) for a column that means nothing here."""
        for name in self.headings:
            if name not in known and not name.startswith(prefixes or ("\0",)):
                message = f"the column {name!r} means nothing here"
                hint = did_you_mean(name, known)
                raise InputError.one("GX470", message, self.heading_place(name), hint)

    def need(self, *names: str) -> None:
        """Raise InputError (GX470) if one of the columns is missing."""
        if missing := [name for name in names if name not in self.headings]:
            message = f"the table lacks the column{'s' * (len(missing) > 1)} {', '.join(missing)}"
            hint = f"needed: {', '.join(names)}"
            raise InputError.one("GX470", message, self.heading_place(), hint)


def read_csv(path: Path, layout: Layout = OWN) -> CsvTable:
    """Return the table of a file. Raises FileError, and InputError for its form."""
    try:
        data = inputs.read(path)
    except (OSError, ValueError) as error:  # ValueError: a null character in the name
        reason = getattr(error, "strerror", None) or str(error)
        raise FileError.one("GX901", f"cannot read {path}: {reason}") from None
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise InputError.one("GX470", "the file is not UTF-8 text", Location(str(path))) from None
    return parse_csv(text, str(path), layout)


def parse_csv(text: str, file: str = "<text>", layout: Layout = OWN) -> CsvTable:
    """Return the table of a text. Raises InputError."""
    lines = [
        (number, line)
        for number, line in enumerate(text.splitlines(), 1)
        if number > layout.skip and line.strip() and not line.lstrip().startswith("#")
    ]
    if len(lines) + bool(layout.columns) < 2:
        what = "has a header and no rows" if lines else "is empty"
        raise InputError.one("GX470", f"the table {what}", Location(file))
    marks = ";" if layout.comma else ",;"
    mark = next((c for c in marks if c in lines[0][1]), "\t")
    rows = [Row(number, line, _cells(line, mark)) for number, line in lines]
    if layout.columns:
        rows.insert(0, Row(0, layout.columns, _cells(layout.columns, ",")))
    headings = _headings("--columns" if layout.columns else file, rows[0])
    found = [
        Diagnostic(
            "GX471",
            f"the row has {len(row.cells)} of {len(headings)} columns",
            _place(file, row, min(len(row.cells) - 1, len(headings))),
        )
        for row in rows[1:]
        if len(row.cells) != len(headings)
    ]
    if found:
        raise InputError(tuple(found))
    return CsvTable(file, rows[0], headings, tuple(rows[1:]), layout.comma)


def _pointed(texts: Sequence[str]) -> list[str]:
    """Return numbers with a point in place of their comma; what has a point stays no number."""
    return [f"{text} with a point" if "." in text else text.replace(",", ".") for text in texts]


def _cells(line: str, mark: str) -> tuple[Cell, ...]:
    """Return the cells of a line, where each begins counted from 1."""
    cells = []
    start = 0
    for part in line.split(mark):
        indent = len(part) - len(part.lstrip())
        text = part.strip()
        cells.append(Cell(text, start + (indent if text else 0) + 1))
        start += len(part) + 1
    return tuple(cells)


def _headings(file: str, header: Row) -> dict[str, Heading]:
    """Return the columns by name. Raises InputError (GX470)."""
    headings: dict[str, Heading] = {}
    for k, cell in enumerate(header.cells):
        found = _HEADING.fullmatch(cell.text)
        name, unit = (found[1].lower(), found[2] or "") if found else ("", "")
        if not name or name in headings:
            message = f"the column {cell.text!r} stands twice" if name else "a column has no name"
            raise InputError.one("GX470", message, _place(file, header, k))
        headings[name] = Heading(name, unit, k)
    return headings


def _place(file: str, row: Row, cell: int | None) -> Location:
    """Return the place of a cell of a row, or of the row."""
    if cell is None:
        return Location(file, row.line, 1, row.text, max(1, len(row.text)))
    text, column = row.cells[cell]
    return Location(file, row.line, column, row.text, max(1, len(text)))


def _problem(text: str) -> tuple[str, str]:
    """Return what is wrong with the text of a number, and a hint; empty strings if nothing."""
    if not text:
        return "a number is missing", "leave no place empty; measure again, or leave the run out"
    if _NUMBER.fullmatch(text):
        return ("", "") if math.isfinite(float(text)) else (f"{text} is too large", "")
    if text.lower().lstrip("+-") in ("nan", "inf", "infinity"):
        return f"{text} is not a reading", "often the trace of a beam that was interrupted"
    hint = "decimals are set off by a point" if "," in text else ""
    return f"{text!r} is not a number", hint
