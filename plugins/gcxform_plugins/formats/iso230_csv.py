"""Positioning tests as CSV: a definition of our own, for what any instrument can be made to say."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import gcxform as gx
from gcxform_plugins.formats.shared import pitches, positioning
from gcxform_plugins.formats.shared.positioning import Reading

WORDS = r"[^\s,;]+"
LONG = ("axis", "target_mm", "run", "direction", "deviation_um")
WIDE = LONG[:2]
TEMPERATURE = "temp_C"
SENSES = {"+": 1, "-": -1}
UM = 1e-3


@dataclass(frozen=True)
class Iso230Csv(gx.ErrorFormat):
    """Positioning tests of ISO 230-2 as CSV: deviations by axis, target, run and direction.

    Long: columns axis, target_mm, run, direction (+ or -), deviation_um, and temp_C if known. Wide:
    axis, target_mm, and a column for each run, named by number and direction, such as 1+, 1-, 2+,
    with deviations in um. A deviation is actual minus target; the mean of the runs is the error.
    """

    name: ClassVar[str] = "iso230-csv"
    suffixes: ClassVar[tuple[str, ...]] = (".csv",)

    @classmethod
    def recognises(cls, path: Path) -> bool:
        """Return whether the first line has the columns of a positioning test."""
        first = gx.head_of(path).partition("\n")[0]
        return tuple(re.findall(WORDS, first))[:2] == WIDE

    def read(self, path: Path) -> gx.PitchTables:
        """Return the mean errors of the axes, forward and reverse."""
        rows = gx.text_rows(path, WORDS, "#")
        if len(rows) < 2:
            where = rows[0].where() if rows else gx.Location(str(path))
            raise gx.UsageError.one("GX411", "the file has no deviations", where)
        names = [word[0] for word in rows[0].words]
        long = names in ([*LONG], [*LONG, TEMPERATURE])
        columns = {} if long else _runs(rows[0])
        found: dict[str, list[Reading]] = {}
        for row in rows[1:]:
            if len(row.words) != len(names):
                message = f"the row has {len(row.words)} of {len(names)} columns"
                raise row.refuse("GX418", message, min(len(row.words), len(names)))
            if row.word(0) not in pitches.AXES:
                raise row.refuse("GX482", f"{row.word(0)!r} is not one of X, Y and Z", 0)
            found.setdefault(row.word(0), []).extend(_long(row) if long else _wide(row, columns))
        tables = {axis: positioning.table(axis, readings) for axis, readings in found.items()}
        return pitches.tables_of(tables)


def _runs(header: gx.TextRow) -> dict[int, tuple[str, int]]:
    """Return run and direction of the columns of a wide table."""
    found: dict[int, tuple[str, int]] = {}
    for column, word in enumerate(header.words):
        said = re.fullmatch(r"([0-9]+)([+-])", word[0])
        if column < len(WIDE) and word[0] == WIDE[column]:
            continue
        if column < len(WIDE) or said is None or (said[1], SENSES[said[2]]) in found.values():
            hint = f"columns: {','.join(LONG)} or {','.join(WIDE)},1+,1-,2+ ..."
            raise header.refuse("GX417", f"the column {word[0]!r} is not known here", column, hint)
        found[column] = said[1], SENSES[said[2]]
    if not found:
        raise header.refuse("GX417", "there is no column of a run", len(header.words))
    return found


def _number(row: gx.TextRow, column: int) -> float:
    value = row.number(column)
    if not math.isfinite(value):
        raise row.refuse("GX412", f"{row.word(column)} is not finite", column)
    return value


def _long(row: gx.TextRow) -> Iterator[Reading]:
    if row.word(3) not in SENSES:
        raise row.refuse("GX419", f"{row.word(3)!r} is not a direction, + or -", 3)
    if len(row.words) > len(LONG):
        _number(row, len(LONG))
    deviation = _number(row, 4) * UM
    yield Reading(_number(row, 1), SENSES[row.word(3)], row.word(2), deviation, row)


def _wide(row: gx.TextRow, columns: dict[int, tuple[str, int]]) -> Iterator[Reading]:
    for column, (run, sense) in columns.items():
        yield Reading(_number(row, 1), sense, run, _number(row, column) * UM, row)
