"""The text tables of Optodyne's LDDM: one file per moving axis, one row per position."""

from __future__ import annotations

from pathlib import Path
from typing import ClassVar

import numpy as np

import gcxform as gx

AXES = "XYZ"
_FILES = tuple(f"table_{axis.lower()}.txt" for axis in AXES)
_POSITION = "position"
_HEADINGS = {"posizione": _POSITION}
"""What the instrument calls columns in other languages."""


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

    def read(self, path: Path) -> gx.AxisFunctions:
        """Return the model of the three files, of which any one may be named."""
        directory = path if path.is_dir() else path.parent
        x, y, z = (
            _read_axis(directory / name, axis) for name, axis in zip(_FILES, AXES, strict=True)
        )
        return gx.AxisFunctions((x, y, z))

    def write(self, model: gx.ErrorModel) -> dict[str, str]:
        """Return the three tables of nine functions."""
        if not isinstance(model, gx.AxisFunctions):
            hint = "--kind nine-functions fits them, and says what is left"
            raise gx.cannot_hold(self.name, f"a model of the kind {model.kind!r}", hint)
        tables = {}
        for file, axis, function in zip(_FILES, AXES, model.axes, strict=True):
            if function is None:
                raise gx.cannot_hold(self.name, f"the axis {axis} without a table")
            tables[file] = _table(axis, function)
        return tables


def _read_axis(path: Path, axis: str) -> gx.AxisFunction:
    """Return the function of one moving axis from its file."""
    rows = gx.text_rows(path)
    if not rows:
        raise gx.UsageError.one("GX417", "the table is empty", gx.Location(str(path)))
    names = [_POSITION, *(f"d{axis}{direction}".lower() for direction in AXES)]
    order = _columns(rows[0], names)
    if found := [finding for row in rows[1:] for finding in gx.number_findings(row, len(names))]:
        raise gx.UsageError(tuple(found))
    numbers = np.array([[float(row.words[k][0]) for k in order] for row in rows[1:]])
    table = numbers.reshape(-1, len(names))
    columns = dict(zip(names[1:], table.T[1:], strict=True))
    if broken := list(gx.faults(table[:, 0], columns)):
        raise gx.UsageError(
            tuple(
                gx.placed(f, rows[0 if f.row is None else f.row + 1], order[names.index(f.column)])
                for f in broken
            )
        )
    return gx.AxisFunction(table[:, 0], table[:, 1:])


def _columns(header: gx.TextRow, names: list[str]) -> list[int]:
    """Return where the named columns stand, or raise gx.UsageError."""
    present = [_HEADINGS.get(word[0].lower(), word[0].lower()) for word in header.words]
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


def _table(axis: str, function: gx.AxisFunction) -> str:
    """Return the text of one table, squareness included as it is in the model."""
    rows = np.column_stack([function.position, function.values])
    lines = [" ".join([_POSITION, *(f"d{axis}{direction}".lower() for direction in AXES)])]
    lines += [" ".join(map(gx.decimal, row)) for row in rows.tolist()]
    return "\n".join(lines) + "\n"
