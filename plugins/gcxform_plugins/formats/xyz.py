"""Height maps as points: `x y z`, one a line, as Universal Gcode Sender and bCNC write them."""

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
class Xyz(gx.ErrorFormat):
    """Points of a height map, `x y z` a line (UGS, bCNC): every X with every Y, in any order.

    The file has no header and no units; those of UGS are the units which its user prefers.
    """

    units: Annotated[Literal["mm", "in"], gx.Option("units of the numbers")]

    name: ClassVar[str] = "xyz"
    suffixes: ClassVar[tuple[str, ...]] = (".xyz",)
    control: ClassVar[str] = "UGS and bCNC level a program with it themselves"

    def read(self, path: Path) -> gx.Lattice:
        """Return the height map of the points."""
        rows = gx.text_rows(path)
        if found := [f for row in rows for f in gx.number_findings(row, 3)]:
            raise gx.UsageError(tuple(found))
        if not rows:
            raise gx.UsageError.one("GX411", "there are no points", gx.Location(str(path)))
        numbers = np.array([row.numbers(3) for row in rows])
        x, y = (_lines(numbers[:, k]) for k in (0, 1))
        height = heightpoints.gridded(rows, x, y)
        if len(x) < 2 or len(y) < 2:
            raise rows[-1].refuse("GX411", "a height map has two positions on X and on Y", 0)
        mm = UNITS[self.units]
        return heightpoints.surface(x * mm, y * mm, height * mm)

    def write(self, model: gx.ErrorModel) -> dict[str, str]:
        """Return the points of a height map, X fastest."""
        mm = UNITS[self.units]
        x, y, height = (part / mm for part in heightpoints.heights(self.name, model))
        lines = [line for row in heightpoints.points(x, y, height) for line in row]
        return {"": "\n".join(lines) + "\n"}


def _lines(values: Floats) -> Floats:
    """Return the lines of the grid: positions that differ by more than rounding."""
    found = np.unique(values[np.isfinite(values)])
    near = 10 * heightpoints.BESIDE * np.ptp(found) / max(len(found), 1) if len(found) else 0.0
    kept = np.concatenate([[True], np.diff(found) > near]) if len(found) else found > 0
    return np.asarray(found[kept])
