"""LinuxCNC's compensation files: one per joint, `nominal forward reverse`, nothing else.

The control adds a trim to the commanded position of the joint: the nominal position minus the
actual one, that of the direction of travel, linear between the entries.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, ClassVar, Literal

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Floats
from gcxform_plugins.formats.shared import pitches

ENTRIES_AT_MOST = 256


@dataclass(frozen=True)
class LinuxCncComp(gx.ErrorFormat):
    """LinuxCNC compensation files: COMP_FILE with COMP_FILE_TYPE 0 or 1, or a directory of them.

    Type 0 holds the actual positions after travel forward and reverse, type 1 the trims, which are
    minus the errors. LinuxCNC stops reading at the first line that is not three numbers, without a
    word; here it is an error. A directory holds x.comp, y.comp and z.comp, or some of them.
    """

    type: Annotated[Literal["0", "1"], gx.Option("COMP_FILE_TYPE of the INI file")]
    units: Annotated[Literal["mm", "in"], gx.Option("units of the machine")]
    axis: Annotated[
        Literal["X", "Y", "Z"] | None, gx.Option("axis of the file; absent: a directory of files")
    ] = None

    name: ClassVar[str] = "linuxcnc-comp"
    suffixes: ClassVar[tuple[str, ...]] = (".comp",)
    control: ClassVar[str] = (
        "LinuxCNC, [JOINT_n] COMP_FILE = ... and COMP_FILE_TYPE = 0 or 1; it takes the place of "
        "BACKLASH"
    )

    @classmethod
    def recognises(cls, path: Path) -> bool:
        """Return whether the path is a .comp file or a directory with those of axes."""
        if path.is_dir():
            return any((path / _file(axis)).is_file() for axis in pitches.AXES)
        return path.suffix.lower() in cls.suffixes and path.is_file()

    def read(self, path: Path) -> gx.PitchTables:
        """Return the errors of one axis, or of those in a directory."""
        if path.is_dir():
            files = {axis: path / _file(axis) for axis in pitches.AXES}
            files = {axis: file for axis, file in files.items() if file.is_file()}
            return pitches.tables_of({axis: self._table(file) for axis, file in files.items()})
        if self.axis is None:
            message = "the file does not say which axis it is for"
            raise gx.UsageError.one("GX480", message, gx.Location(str(path)), "add axis=X")
        return pitches.tables_of({self.axis: self._table(path)})

    def _table(self, path: Path) -> gx.PitchTable:
        rows = gx.text_rows(path)
        lines = [row.line for row in rows]
        if lines != list(range(1, len(rows) + 1)):
            gap = next(k for k, line in enumerate(lines, 1) if line != k)
            message = "LinuxCNC ends the table at the empty line before this one"
            raise rows[gap - 1].refuse("GX418", message)
        if len(rows) > ENTRIES_AT_MOST:
            message = f"LinuxCNC takes {ENTRIES_AT_MOST} entries, this is one more"
            raise rows[ENTRIES_AT_MOST].refuse("GX482", message)
        found = [f for row in rows for f in gx.number_findings(row, 3)]
        if found:
            raise gx.UsageError(tuple(found))
        numbers = np.array([row.numbers(3) for row in rows]).reshape(-1, 3) * self._mm
        if not rows:
            raise gx.UsageError.one("GX411", "the table is empty", gx.Location(str(path)))
        pitches.checked(rows, numbers)
        position, forward, reverse = numbers.T
        return gx.PitchTable(
            position, self._error(position, forward), self._error(position, reverse)
        )

    def _error(self, position: Floats, column: Floats) -> Floats:
        """Return the errors: of actual positions, or of trims. It is its own inverse but for sign.

        At 100 the machine stands at 100.005 after travel forward: the error is +0.005, type 0 says
        100.005, type 1 says -0.005, and LinuxCNC commands 99.995.
        """
        error = column - position if self.type == "0" else -column
        return error.round(12) if np.abs(error).max() < 1e6 else error  # what differences add

    @property
    def _mm(self) -> float:
        return pitches.UNITS[self.units]

    def write(self, model: gx.ErrorModel) -> dict[str, str]:
        """Return one file, or a file for each axis."""
        tables = pitches.pitch_tables(self.name, model)
        if self.axis is None:
            return {_file(axis): self._text(table) for axis, table in tables.items()}
        for axis, table in tables.items():
            if axis != self.axis and (table.forward.any() or table.reverse.any()):
                hint = "leave the axis out: a directory takes a file for each"
                raise gx.cannot_hold(self.name, f"the axis {axis} in the file of {self.axis}", hint)
        if self.axis not in tables:
            raise gx.cannot_hold(self.name, f"a model without errors of {self.axis}")
        return {"": self._text(tables[self.axis])}

    def _text(self, table: gx.PitchTable) -> str:
        if len(table.position) > ENTRIES_AT_MOST:
            what = f"{len(table.position)} positions, {ENTRIES_AT_MOST} at most"
            raise gx.cannot_hold(self.name, what)
        start = table.position if self.type == "0" else 0.0
        sign = 1.0 if self.type == "0" else -1.0
        columns = [table.position, *(start + sign * e for e in (table.forward, table.reverse))]
        rows = np.column_stack(columns) / self._mm
        return "".join(" ".join(gx.decimal(v, 10) for v in row) + "\n" for row in rows.tolist())


def _file(axis: str) -> str:
    return f"{axis.lower()}.comp"
