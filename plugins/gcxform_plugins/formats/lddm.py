"""The text tables of Optodyne's LDDM: one file per moving axis, one row per position."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import ClassVar, NamedTuple

import numpy as np

import gcxform as gx

AXES = "XYZ"
_FILES = tuple(f"table_{axis.lower()}.txt" for axis in AXES)
_NUMBER = re.compile(
    r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?|[+-]?(?:nan|inf)", re.I
)
_POSITION = "position"


class Lddm(gx.ErrorFormat):
    """LDDM text tables: a directory with table_x.txt, table_y.txt and table_z.txt, or one of them.

    Columns are named in the first line. In `dxy` the first letter after d is the moving axis and
    the second the direction of the error, the reverse of ISO 230-1: dxy is EYX. Values are errors
    in mm, actual minus nominal, squareness included in dyx, dzx and dzy.
    """

    name: ClassVar[str] = "lddm"
    suffixes: ClassVar[tuple[str, ...]] = (".txt",)

    @classmethod
    def recognises(cls, path: Path) -> bool:
        """Return whether the path is one of the three files or a directory with one of them."""
        if path.is_dir():
            return any((path / name).is_file() for name in _FILES)
        return path.name in _FILES and path.is_file()

    @classmethod
    def read(cls, path: Path) -> gx.AxisFunctions:
        """Return the model of the three files, of which any one may be named."""
        directory = path if path.is_dir() else path.parent
        x, y, z = (
            _read_axis(directory / name, axis) for name, axis in zip(_FILES, AXES, strict=True)
        )
        return gx.AxisFunctions((x, y, z))


class _Row(NamedTuple):
    """One line of a table with its words."""

    file: str
    line: int
    text: str
    words: list[re.Match[str]]

    def where(self, column: int | None = None) -> gx.Location:
        """Return the place of a word, of the end of the line if the word is not there."""
        if column is None or column >= len(self.words):
            at = 1 if column is None else len(self.text.rstrip()) + 1
            return gx.Location(self.file, self.line, at, self.text)
        word = self.words[column]
        return gx.Location(self.file, self.line, word.start() + 1, self.text, len(word[0]))


def _rows(path: Path) -> list[_Row]:
    """Return the lines of a file which are not blank."""
    lines = gx.read_text(path, "GX401", "GX419").splitlines()
    rows = [_Row(str(path), i, t, list(re.finditer(r"\S+", t))) for i, t in enumerate(lines, 1)]
    return [row for row in rows if row.words]


def _read_axis(path: Path, axis: str) -> gx.AxisFunction:
    """Return the function of one moving axis from its file."""
    rows = _rows(path)
    if not rows:
        raise gx.UsageError.one("GX417", "the table is empty", gx.Location(str(path)))
    names = [_POSITION, *(f"d{axis}{direction}".lower() for direction in AXES)]
    order = _columns(rows[0], names)
    if found := [finding for row in rows[1:] for finding in _findings(row, len(names))]:
        raise gx.UsageError(tuple(found))
    numbers = np.array([[float(row.words[k][0]) for k in order] for row in rows[1:]])
    table = numbers.reshape(-1, len(names))
    columns = dict(zip(names[1:], table.T[1:], strict=True))
    if broken := list(gx.faults(table[:, 0], columns)):
        raise gx.UsageError(tuple(_placed(f, rows, order[names.index(f.column)]) for f in broken))
    return gx.AxisFunction(table[:, 0], table[:, 1:])


def _columns(header: _Row, names: list[str]) -> list[int]:
    """Return where the named columns stand, or raise gx.UsageError."""
    present = [word[0].lower() for word in header.words]
    for k, name in enumerate(present):
        if name not in names or name in present[:k]:
            reason = "stands twice" if name in names else "does not belong into this table"
            raise gx.UsageError.one(
                "GX417",
                f"the column {header.words[k][0]!r} {reason}",
                header.where(k),
                "" if name in names else gx.did_you_mean(name, names),
            )
    if missing := [name for name in names if name not in present]:
        message = f"the table lacks the column{'s' * (len(missing) > 1)} {', '.join(missing)}"
        raise gx.UsageError.one("GX417", message, header.where(), f"needed: {' '.join(names)}")
    return [present.index(name) for name in names]


def _findings(row: _Row, width: int) -> Iterator[gx.Diagnostic]:
    """Yield what is wrong with the words of one line."""
    if len(row.words) != width:
        message = f"the row has {len(row.words)} of {width} columns"
        yield gx.Diagnostic("GX418", message, row.where(min(len(row.words), width)))
    for k, word in enumerate(row.words):
        if not _NUMBER.fullmatch(word[0]):
            hint = "decimals are set off by a point" if "," in word[0] else ""
            yield gx.Diagnostic("GX419", f"{word[0]!r} is not a number", row.where(k), hint)


def _placed(fault: gx.Fault, rows: list[_Row], column: int) -> gx.Diagnostic:
    """Return a defect of the numbers at its place in the file."""
    where = rows[0].where(column) if fault.row is None else rows[fault.row + 1].where(column)
    return gx.Diagnostic(fault.code, fault.message, where)
