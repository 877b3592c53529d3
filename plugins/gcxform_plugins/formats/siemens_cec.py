"""Siemens' sag and angularity compensation, cross error compensation: %_N_NC_CEC_INI."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, ClassVar, Literal, NamedTuple

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Floats
from gcxform_plugins.formats.shared import pitches
from gcxform_plugins.formats.shared import sinumerik as siemens
from gcxform_plugins.formats.shared.sinumerik import UNITS, Table

VALUE = "$AN_CEC"
AXIS_KEYS = ("_INPUT_AXIS", "_OUTPUT_AXIS")
KEYS = (*AXIS_KEYS, "_STEP", "_MIN", "_MAX", "_DIRECTION", "_MULT_BY_TABLE", "_IS_MODULO")
WIDTHS = {VALUE: 4, **{VALUE + key: 3 for key in KEYS}}


class _Part(NamedTuple):
    """What one table says: the error in one axis over the position of another, mm."""

    by: int
    into: int
    sense: int
    position: Floats
    error: Floats


@dataclass(frozen=True)
class SiemensCec(siemens.Compensation):
    """Siemens CEC files ($AN_CEC): errors of an axis over itself or another, as of straightness.

    Nine functions have room, or positioning errors in both directions of travel; angular errors
    have not, as a table knows one position. Products of tables and modulo axes are refused.
    """

    units: Annotated[Literal["mm", "in"], gx.Option("basic system of the control, MD10240")]
    axes: Annotated[str, gx.Option("machine axes of X, Y and Z, such as AX1,AX2,AX3")]
    positive: Annotated[
        Literal["plus", "minus"],
        gx.Option("which way a positive value moves the output axis: try it on the machine"),
    ]
    points: Annotated[int, gx.Option("to write: room for points, MD18342", at_least=2)] = 200
    tables: Annotated[int, gx.Option("to write: room for tables", at_least=1)] = 8

    name: ClassVar[str] = "siemens-cec"
    value: ClassVar[str] = VALUE
    control: ClassVar[str] = (
        "Siemens 840D, 828D: MD18342 for the points, load the file with MD32710 = 0, then "
        "MD32710 = 1"
    )

    @property
    def _sign(self) -> float:
        """The error that a compensation value of +1 is for: one that it moves against."""
        return 1.0 if self.positive == "minus" else -1.0

    # --- reading ---

    def read(self, path: Path) -> gx.AxisFunctions | gx.PitchTables:
        """Return nine functions, or pitch tables if the tables tell directions apart."""
        found = self.read_tables(path, WIDTHS, lambda row: siemens.whole(row, 1))
        parts = [self._part(table) for table in found.values()]
        for part, table in zip(parts, found.values(), strict=True):
            _check_travel(part, parts, table)
        if any(part.sense for part in parts):
            for part, table in zip(parts, found.values(), strict=True):
                if part.by != part.into:
                    row = table.rows["_OUTPUT_AXIS"]
                    message = "directions of travel beside errors of another axis are not supported"
                    raise row.refuse("GX482", message, 0)
            return _pitch(parts)
        return _nine(parts)

    def _part(self, table: Table) -> _Part:
        table.refuse_unless_zero("_MULT_BY_TABLE", "a product of tables is not supported")
        table.refuse_unless_zero("_IS_MODULO", "a modulo axis is not one of X, Y and Z")
        by, into = (self._axis(table, key) for key in AXIS_KEYS)
        sense = table.number("_DIRECTION", 0.0)
        if sense not in (-1.0, 0.0, 1.0):
            message = f"the direction {sense:g} is not one of -1, 0 and 1"
            raise table.rows["_DIRECTION"].refuse("GX482", message, 2)
        position, value = table.points()
        mm = UNITS[self.units]
        return _Part(by, into, int(sense), position * mm, self._sign * value * mm)

    def _axis(self, table: Table, key: str) -> int:
        """Return which of X, Y and Z a table names."""
        names = siemens.names_of(self.axes, "axes")
        if key not in table.rows:
            table.number(key)
        row = table.rows[key]
        name = row.word(2).strip("()").upper()
        if name not in names:
            message = f"{row.word(2)} is not one of the axes {self.axes}"
            raise row.refuse("GX482", message, 2, "axes=... names X, Y and Z")
        return siemens.AXES.index(names[name])

    # --- writing ---

    def write(self, model: gx.ErrorModel) -> dict[str, str]:
        """Return the file with one table for each function that is not zero."""
        parts = list(_parts(self.name, model))
        if len(parts) > self.tables:
            hint = f"tables={len(parts)}, if the control has room for them"
            raise gx.cannot_hold(self.name, f"{len(parts)} tables", hint)
        lines = ["%_N_NC_CEC_INI", "CHANDATA(1)"]
        for number, part in enumerate(parts):
            lines += self._lines(number, part)
        return {"": "\n".join([*lines, "M17"]) + "\n"}

    def _lines(self, number: int, part: _Part) -> list[str]:
        mm = UNITS[self.units]
        names = list(siemens.names_of(self.axes, "axes"))
        axis = siemens.AXES[part.by]
        position = siemens.stepped(self.name, axis, part.position, self.points)
        value = self._sign * np.interp(position, part.position, part.error) / mm
        lines = [f"{VALUE}[{number},{k}]={gx.decimal(v, 10)}" for k, v in enumerate(value)]
        ends = (position[1] - position[0]) / mm, position[0] / mm, position[-1] / mm
        said = [
            *(f"({names[k]})" for k in (part.by, part.into)),
            *(gx.decimal(end, 12) for end in ends),
            str(part.sense),
            "0",
            "0",
        ]
        return lines + [
            f"{VALUE}{key}[{number}]={word}" for key, word in zip(KEYS, said, strict=True)
        ]


def _check_travel(part: _Part, parts: list[_Part], table: Table) -> None:
    """Refuse tables over one axis with different ends: what is beyond them is not certain."""
    for other in parts:
        ends = other.position[0], other.position[-1]
        if other.by == part.by and ends != (part.position[0], part.position[-1]):
            message = f"the tables over {siemens.AXES[part.by]} do not span the same travel"
            raise table.rows["_MIN"].refuse("GX482", message, 0)


def _nine(parts: list[_Part]) -> gx.AxisFunctions:
    """Return the functions of tables, added up."""
    axes: list[gx.AxisFunction | None] = []
    for by in range(3):
        own = [part for part in parts if part.by == by]
        position = np.unique(np.concatenate([[], *(part.position for part in own)]))
        values = np.zeros((len(position), 3))
        for part in own:
            values[:, part.into] += np.interp(position, part.position, part.error)
        axes.append(gx.AxisFunction(position, values) if own else None)
    return gx.AxisFunctions((axes[0], axes[1], axes[2]))


def _pitch(parts: list[_Part]) -> gx.PitchTables:
    """Return the tables of axes, forward and reverse."""
    found = {}
    for by, axis in enumerate(siemens.AXES):
        own = [part for part in parts if part.by == by]
        position = np.unique(np.concatenate([[], *(part.position for part in own)]))
        forward, reverse = np.zeros((2, len(position)))
        for part in own:
            values = np.interp(position, part.position, part.error)
            forward += values * (part.sense >= 0)
            reverse += values * (part.sense <= 0)
        if own:
            found[axis] = gx.PitchTable(position, forward, reverse)
    return pitches.tables_of(found)


def _parts(name: str, model: gx.ErrorModel) -> Iterator[_Part]:
    """Yield the tables of a model which are not zero, and one at least for each axis."""
    if isinstance(model, gx.PitchTables):
        for axis, table in pitches.pitch_tables(name, model).items():
            k = siemens.AXES.index(axis)
            if not table.backlash:
                yield _Part(k, k, 0, table.position, table.forward)
                continue
            yield _Part(k, k, 1, table.position, table.forward)
            yield _Part(k, k, -1, table.position, table.reverse)
        return
    if isinstance(model, gx.RigidBody):
        raise gx.cannot_hold(name, "angular functions", "--kind nine-functions leaves them out")
    if not isinstance(model, gx.AxisFunctions):
        hint = "--kind nine-functions fits them, and says what is left"
        raise gx.cannot_hold(name, f"a model of the kind {model.kind!r}", hint)
    for by, function in enumerate(model.axes):
        if function is None:
            continue
        used = [into for into in range(3) if function.values[:, into].any()] or [by]
        for into in used:
            yield _Part(by, into, 0, function.position, function.values[:, into])
