"""Where a machine with known errors stands while it runs a program.

The program is read as the control reads it, the compensated one is what the pipeline writes, and
`VirtualMachine.actual` is the one place where the error model is asked.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from gcxform.api import read
from gcxform.contract.options import ModelFile
from gcxform.dialect.dialect import Dialect, NumberFormat
from gcxform.errormodel.model import ErrorModel, Outside
from gcxform.pipeline.certificate import Certificate
from gcxform.pipeline.pipeline import Pipeline
from gcxform.plugin.registry import default_registry
from gcxform.simulate.programs import StandardProgram
from gcxform.system.arrays import Floats, Ints
from gcxform.toolpath.circles import points_on_arcs, radius_and_angle
from gcxform.toolpath.path import Plane, Toolpath
from gcxform.values import dataclass

STILL = 1e-9  # mm; an axis that moves by less has not moved
CORRECTION = 10.0  # mm; a virtual machine may be as bad as it likes
FAR = 1e9  # cells; it has an error wherever it is
PASS = "volumetric"


@dataclass(frozen=True)
class VirtualMachine:
    """A machine that goes where it is told, plus its error.

    `tool` (3,) mm is the way from the gauge point to the tip; None: that of the measurement.
    """

    model: ErrorModel
    outside: Outside = Outside.ERROR
    tool: Floats | None = None

    def actual(self, commanded: Floats, sense: Floats) -> Floats:
        """Return where the tool is (n, 3) when the machine is told to be at `commanded` (n, 3), mm.

        `sense` (n, 3) is the direction, -1 or +1, in which each axis moved last; 0: not yet.
        """
        return commanded + self.model.error(commanded, self.outside, self.tool, sense)


@dataclass(frozen=True)
class Track:
    """Where the tool has been: points in their order, a few on each move.

    commanded, actual  (n, 3) mm
    line               (n,) line of the standard program, from 0, that the point came from
    """

    commanded: Floats
    actual: Floats
    line: Ints

    def on(self, line: int) -> Floats:
        """Return the actual points (k, 3) in mm on the moves of a line."""
        return np.asarray(self.actual[self.line == line])

    def stops(self, lines: tuple[int, ...]) -> Floats:
        """Return where the tool stands (k, 3) in mm at the end of each line; they ascend."""
        last = np.searchsorted(self.line, lines, side="right") - 1
        return np.asarray(self.actual[last])


@dataclass(frozen=True)
class Chain:
    """How the program is compensated: the model and what the pass `volumetric` is told.

    tolerance  mm that the tool may be off between blocks
    decimals   of a millimetre in the compensated program; None: as the dialect writes
    """

    model: ModelFile
    dialect: type[Dialect]
    tolerance: float = 0.001
    decimals: int | None = None
    outside: Outside = Outside.ERROR

    @property
    def machine(self) -> VirtualMachine:
        """The machine whose errors the model describes."""
        return VirtualMachine(self.model.model, self.outside)

    @property
    def numbers(self) -> NumberFormat:
        """How numbers are written."""
        own = self.dialect.numbers
        return own if self.decimals is None else replace(own, mm=self.decimals)

    def pipeline(self) -> Pipeline:
        """Return the pipeline that compensates; the program's origin is that of the machine.

        Of a machine with backlash the mean of both directions is compensated.
        """
        options: Mapping[str, Any] = {
            "model": self.model,
            "backlash": "mean",
            "tolerance": self.tolerance,
            "outside": self.outside,
            "part_origin": (0.0, 0.0, 0.0),
            "max_correction": CORRECTION,
            "max_extrapolation": FAR,
        }
        chosen: Any = default_registry().pass_(PASS)
        step = chosen(**options)
        return Pipeline(self.dialect, self.dialect, (step,), numbers=self.numbers)

    def before(self, program: StandardProgram, spacing: float) -> Track:
        """Return where the machine goes with the program as it stands; `spacing` as in `track`."""
        path = read(program.text, self.dialect).path
        return track(self.machine, path, path.source, spacing)

    def after(self, program: StandardProgram, spacing: float) -> tuple[Track, Compensated]:
        """Return where it goes with the compensated program, and that program."""
        result = self.pipeline().run(program.text)
        path = read(result.text, self.dialect).path
        line = np.array(result.source_map, dtype=np.int64)[path.source]
        done = Compensated(result.text, result.certificate)
        return track(self.machine, path, line, spacing), done


@dataclass(frozen=True)
class Compensated:
    """The compensated program, proved."""

    text: bytes
    certificate: Certificate


def track(machine: VirtualMachine, path: Toolpath, line: Ints, spacing: float) -> Track:
    """Return the points of a machine on a path, at most `spacing` (mm) apart on each move.

    Every move is cut into equal parts and its end is a point; its start is the end before it.
    """
    rows, part = parts_of(path, spacing)
    commanded = points_at(path, rows, part)
    known = ~np.isnan(commanded).any(axis=1)
    commanded, rows = commanded[known], rows[known]
    return Track(commanded, machine.actual(commanded, senses(commanded)), line[rows])


def parts_of(path: Toolpath, spacing: float) -> tuple[Ints, Floats]:
    """Return the row (n,) and the part (n,), up to 1, of points at most `spacing` (mm) apart."""
    start, end = path.start[:, :3], path.end[:, :3]
    length = np.sqrt(((end - start) ** 2).sum(axis=1))
    if path.has_arcs:
        arcs = np.flatnonzero(path.is_arc)
        first, last, _ = radius_and_angle(path, arcs)
        along = end[arcs] - start[arcs]
        rise = along[np.arange(len(arcs)), [normal(path, row) for row in arcs.tolist()]]
        length[arcs] = np.hypot((first + last) / 2 * path.sweep[arcs], rise)
    count = np.maximum(np.ceil(np.nan_to_num(length) / spacing - 1e-9), 1.0).astype(np.int64)
    rows = np.repeat(np.arange(len(path)), count)
    nth = np.arange(len(rows)) - np.repeat(np.cumsum(count) - count, count) + 1
    return rows, nth / count[rows]


def normal(path: Toolpath, row: int) -> int:
    """Return the axis normal to the plane of an arc."""
    return int(Plane(int(path.plane[row])).axes[2])


def points_at(path: Toolpath, rows: Ints, part: Floats) -> Floats:
    """Return the points (n, 3) in mm at parts of rows that are lines and arcs."""
    start, end = path.start[rows, :3], path.end[rows, :3]
    point = start + part[:, None] * (end - start)
    ends = part == 1.0
    point[ends] = end[ends]
    arcs = path.is_arc[rows] & ~ends
    if arcs.any():
        point[arcs] = points_on_arcs(path, rows[arcs], part[arcs])
    return np.asarray(point)


def senses(points: Floats) -> Floats:
    """Return the direction (n, 3) in which each axis moved last on the way to points (n, 3)."""
    way = np.diff(points, axis=0, prepend=points[:1])
    sense = np.where(np.abs(way) > STILL, np.sign(way), 0.0)
    moved = np.where(sense != 0.0, np.arange(len(points))[:, None], 0)
    last = np.maximum.accumulate(moved, axis=0)
    return np.take_along_axis(sense, last, axis=0)
