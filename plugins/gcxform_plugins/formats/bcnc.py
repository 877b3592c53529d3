"""bCNC's probe files: three lines of limits, and the probed points."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, ClassVar, Literal

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Floats
from gcxform_plugins.formats.shared import height_points as heightpoints
from gcxform_plugins.formats.shared.height_points import UNITS


@dataclass(frozen=True)
class BcncProbe(gx.ErrorFormat):
    """bCNC probe files: limits and counts on X and Y, depth and feed of probing, then the points.

    To write one, say how bCNC shall probe the next time: depth and feed move the machine.
    """

    units: Annotated[Literal["mm", "in"], gx.Option("units of the numbers")]
    z_min: Annotated[gx.Length | None, gx.Option("to write: lowest Z when probing")] = None
    z_max: Annotated[gx.Length | None, gx.Option("to write: Z to probe from")] = None
    feed: Annotated[float | None, gx.Option("to write: feed of probing, mm/min", above=0.0)] = None

    name: ClassVar[str] = "bcnc-probe"
    suffixes: ClassVar[tuple[str, ...]] = (".probe",)
    control: ClassVar[str] = "bCNC levels a program with it itself"

    def read(self, path: Path) -> gx.Lattice:
        """Return the height map of the points."""
        rows = gx.text_rows(path)
        if len(rows) < 4:
            where = rows[-1].where() if rows else gx.Location(str(path))
            message = "the file ends before its points: it has X, Y, Z and feed, and points"
            raise gx.UsageError.one("GX417", message, where)
        most = len(rows) - 3
        x, y = (_limits(row, letter, most) for row, letter in zip(rows, "XY", strict=False))
        rows[2].numbers(3)
        if found := [f for row in rows[3:] for f in gx.number_findings(row, 3)]:
            raise gx.UsageError(tuple(found))
        height = heightpoints.gridded(rows[3:], x, y)
        mm = UNITS[self.units]
        return heightpoints.surface(x * mm, y * mm, height * mm)

    def write(self, model: gx.ErrorModel) -> dict[str, str]:
        """Return the probe file of a height map."""
        if self.z_min is None or self.z_max is None or self.feed is None:
            hint = "add z-min=... z-max=... feed=..."
            raise gx.cannot_hold(self.name, "a map without depth and feed of probing", hint)
        mm = UNITS[self.units]
        x, y, height = (part / mm for part in heightpoints.heights(self.name, model))
        heightpoints.even(self.name, "X", x)
        heightpoints.even(self.name, "Y", y)
        head = [
            *(f"{_text(n[0])} {_text(n[-1])} {len(n)}" for n in (x, y)),
            f"{_text(self.z_min / mm)} {_text(self.z_max / mm)} {self.feed / mm:g}",
        ]
        lines = [line for row in heightpoints.points(x, y, height) for line in ("", *row)]
        return {"": "\n".join([*head, *lines]) + "\n"}


def _text(value: float) -> str:
    return gx.decimal(value, 10)


def _limits(row: gx.TextRow, letter: str, most: int) -> Floats:
    """Return the positions of the grid: the first, the last, and how many there are."""
    low, high, count = row.numbers(3)
    if not 2 <= count <= most or count != int(count):
        message = f"{row.word(2)} is not a number of positions on {letter} for {most} points"
        raise row.refuse("GX417", message, 2)
    if not low < high:
        raise row.refuse("GX408", f"{letter} does not rise from {low:g} to {high:g}", 1)
    return np.linspace(low, high, int(count))
