"""Renishaw's linear capture files, .rtl: what a laser interferometer recorded, in sections."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, ClassVar, Literal

import gcxform as gx
from gcxform_plugins.formats.shared import pitches, positioning
from gcxform_plugins.formats.shared.positioning import UNITS, Reading

SECTION = re.compile(r"([A-Z][A-Z -]*)::")
TARGETS = "TARGET DATA"
USER = "USER-TEXT"
RUNS = "RUNS"
DEVIATIONS = "DEVIATIONS"
Sections = dict[str, list[gx.TextRow]]


@dataclass(frozen=True)
class RenishawRtl(gx.ErrorFormat):
    """Renishaw .rtl files: targets, and the deviations of runs that go to and fro.

    The first run visits the targets in the order of the file, the second goes back, and so on. The
    files of different programs hold deviations in um or in mm: the unit has to be said.
    """

    deviations: Annotated[Literal["um", "mm"], gx.Option("unit of the deviations")]
    axis: Annotated[Literal["X", "Y", "Z"] | None, gx.Option("axis; absent: as the file says")] = (
        None
    )

    name: ClassVar[str] = "renishaw-rtl"
    suffixes: ClassVar[tuple[str, ...]] = (".rtl",)

    def read(self, path: Path) -> gx.PitchTables:
        """Return the mean errors of the axis, forward and reverse."""
        sections = _sections(path)
        for name in (TARGETS, DEVIATIONS):
            if name not in sections:
                message = f"the file has no section {name}::"
                raise gx.UsageError.one("GX417", message, gx.Location(str(path)))
        axis = self._axis(sections.get(USER, []), path)
        targets, both = _targets(sections[TARGETS])
        readings = list(_readings(sections[DEVIATIONS], targets, both, UNITS[self.deviations]))
        _check_runs(sections.get(RUNS, []), readings)
        return pitches.tables_of({axis: positioning.table(axis, readings)})

    def _axis(self, rows: list[gx.TextRow], path: Path) -> str:
        """Return the axis: as it was said, and as the file says."""
        said = {}
        for row in rows:
            found = re.fullmatch(r"Axis\s*:\s*([XYZ])(?:[\s-]*axis)?\s*", row.text, re.I)
            if found:
                said[found[1].upper()] = row
        if self.axis and said and self.axis not in said:
            axis, row = next(iter(said.items()))
            raise row.refuse("GX482", f"the file is of the axis {axis}, not of {self.axis}")
        if self.axis is None and len(said) != 1:
            message = "the file does not say which of X, Y and Z was measured"
            raise gx.UsageError.one("GX480", message, gx.Location(str(path)), "add axis=X")
        return self.axis or next(iter(said))


def _sections(path: Path) -> Sections:
    """Return the lines of a file by section, the head of each among them."""
    found: Sections = {}
    name = ""
    for row in gx.text_rows(path):
        if head := SECTION.fullmatch(row.text.strip()):
            name = head[1]
        found.setdefault(name, []).append(row)
    return found


def _targets(rows: list[gx.TextRow]) -> tuple[list[float], bool]:
    """Return the targets in the order of the file, and whether runs alternate in direction."""
    targets: list[float] = []
    count, both, open_ = None, None, False
    for row in rows[1:]:
        key, colon, rest = row.text.partition(":")
        key = key.strip().lower()
        if colon and key == "target-count":
            count = rest.strip()
        elif colon and key == "flags":
            both, open_ = _bidirectional(row, rest.split()), False
        elif colon and key == "targets":
            open_ = True
            words = [k for k, w in enumerate(row.words) if w.start() > row.text.index(":")]
            targets += [_number(row, k) for k in words]
        elif open_:
            targets += [_number(row, k) for k in range(len(row.words))]
    if both is None:
        raise rows[0].refuse("GX417", "the section has no Flags: one direction, or both?", 0)
    if count != str(len(targets)):
        raise rows[0].refuse("GX483", f"there are {len(targets)} targets, not {count}", 0)
    return targets, both


def _bidirectional(row: gx.TextRow, flags: list[str]) -> bool:
    if flags[:2] not in (["0", "0"], ["0", "1"]):
        raise row.refuse("GX482", "these flags are not known: 0 0 2 0 is both directions", 0)
    return flags[1] == "0"


def _number(row: gx.TextRow, column: int) -> float:
    value = row.number(column)
    if not math.isfinite(value):
        raise row.refuse("GX412", f"{row.word(column)} is not finite", column)
    return value


def _readings(
    rows: list[gx.TextRow], targets: list[float], both: bool, unit: float
) -> Iterator[Reading]:
    """Yield the rows `run target deviation`; odd runs go through the targets as they stand."""
    rising = 1 if targets[-1:] > targets[:1] else -1
    data = [row for row in rows[1:] if not row.text.strip().endswith(":")]
    if not data:
        raise rows[0].refuse("GX411", "there are no deviations", 0)
    for row in data:
        if found := list(gx.number_findings(row, 3)):
            raise gx.UsageError(tuple(found))
        run, at = (_count(row, k) for k in (0, 1))
        if at > len(targets):
            raise row.refuse("GX483", f"there is no target {at}", 1)
        sense = rising if run % 2 or not both else -rising
        yield Reading(targets[at - 1], sense, str(run), _number(row, 2) * unit, row)


def _check_runs(rows: list[gx.TextRow], readings: list[Reading]) -> None:
    """Refuse a file that has not as many runs as it says."""
    runs = len({reading.run for reading in readings})
    for row in rows[1:]:
        key, _, count = row.text.partition(":")
        if key.strip().lower() == "run-count" and count.strip() != str(runs):
            raise row.refuse("GX483", f"there are {runs} runs, not {count.strip()}", 0)


def _count(row: gx.TextRow, column: int) -> int:
    if not re.fullmatch("[1-9][0-9]*", row.word(column)):
        raise row.refuse("GX419", f"{row.word(column)!r} is not a number from 1", column)
    return int(row.word(column))
