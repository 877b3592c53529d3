"""Siemens' leadscrew and encoder error compensation: the file %_N_AX_EEC_INI."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, ClassVar, Literal

import numpy as np

import gcxform as gx
from gcxform_plugins.formats.shared import sinumerik as siemens
from gcxform_plugins.formats.shared.pitches import pitch_tables
from gcxform_plugins.formats.shared.sinumerik import UNITS, Table

VALUE = "$AA_ENC_COMP"
KEYS = ("_STEP", "_MIN", "_MAX", "_IS_MODULO")
WIDTHS = {VALUE: 5, **{VALUE + key: 4 for key in KEYS}}


@dataclass(frozen=True)
class SiemensEec(siemens.Compensation):
    """Siemens EEC/LEC files ($AA_ENC_COMP): the positioning error of axes, in equal steps.

    A positive value moves the axis in the negative direction, so values are errors. They hold for
    both directions of travel; constant backlash is MD32450. At the reference point the value should
    be 0, or the axis jumps when the compensation begins.
    """

    units: Annotated[Literal["mm", "in"], gx.Option("basic system of the control, MD10240")]
    axes: Annotated[str, gx.Option("machine axes X, Y and Z by their names in the control")] = (
        "X1,Y1,Z1"
    )
    points: Annotated[int, gx.Option("to write: room for points, MD38000", at_least=2)] = 200

    name: ClassVar[str] = "siemens-eec"
    value: ClassVar[str] = VALUE
    control: ClassVar[str] = (
        "Siemens 840D, 828D, 808D: MD38000 for the points, load the file with MD32700 = 0, then "
        "MD32700 = 1"
    )

    def read(self, path: Path) -> gx.AxisFunctions:
        """Return the positioning errors of the axes."""
        names = siemens.names_of(self.axes, "axes")

        def axis_of(row: gx.TextRow) -> str:
            axis = len(row.words) - 2
            if row.word(axis).upper() not in names:
                message = f"{row.word(axis)} is not one of the axes {self.axes}"
                raise row.refuse("GX482", message, axis, "axes=... names X, Y and Z")
            if siemens.whole(row, 1):
                raise row.refuse("GX482", "a second encoder is not supported", 1)
            return names[row.word(axis).upper()]

        tables = self.read_tables(path, WIDTHS, axis_of)
        x, y, z = (self._function(k, tables.get(axis)) for k, axis in enumerate(siemens.AXES))
        return gx.AxisFunctions((x, y, z))

    def _function(self, axis: int, table: Table | None) -> gx.AxisFunction | None:
        if table is None:
            return None
        table.refuse_unless_zero("_IS_MODULO", "a modulo axis is not one of X, Y and Z")
        position, value = table.points()
        values = np.zeros((len(position), 3))
        values[:, axis] = value
        return gx.AxisFunction(position * UNITS[self.units], values * UNITS[self.units])

    def write(self, model: gx.ErrorModel) -> dict[str, str]:
        """Return the file with a table for each axis."""
        names = {axis: name for name, axis in siemens.names_of(self.axes, "axes").items()}
        lines = ["%_N_AX_EEC_INI", "CHANDATA(1)"]
        for axis, table in pitch_tables(self.name, model).items():
            if table.backlash:
                hint = "--backlash mean, and MD32450; or siemens-cec has tables for each direction"
                raise gx.cannot_hold(self.name, f"the backlash of {axis}", hint)
            lines += self._lines(names[axis], axis, table)
        return {"": "\n".join([*lines, "M17"]) + "\n"}

    def _lines(self, name: str, axis: str, table: gx.PitchTable) -> list[str]:
        mm = UNITS[self.units]
        position = siemens.stepped(self.name, axis, table.position, self.points)
        value = np.interp(position, table.position, table.forward) / mm
        lines = [f"{VALUE}[0,{k},{name}]={gx.decimal(v, 10)}" for k, v in enumerate(value)]
        ends = (position[1] - position[0]) / mm, position[0] / mm, position[-1] / mm, 0.0
        return lines + [
            f"{VALUE}{key}[0,{name}]={gx.decimal(end, 12)}"
            for key, end in zip(KEYS, ends, strict=True)
        ]
