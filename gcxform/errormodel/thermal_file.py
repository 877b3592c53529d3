"""Error models of the kind `thermal-screw`: what the axes are, and where their temperatures stand.

The temperatures count from the state in which the geometry was measured, so that a table of the
geometry and this model can be added: what that state did to the axes is in the table already.

Readings are looked up when a model is loaded, or when a pass asks for another time
(`ErrorModel.at_time`). What is missing, out of range or above the limit is refused.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from datetime import datetime
from pathlib import Path
from typing import Annotated, Literal

import msgspec
import numpy as np

from gcxform.config.keys import says
from gcxform.config.toml_text import TomlText, convert
from gcxform.diagnostics import Diagnostic, UsageError
from gcxform.errormodel.functions import faults
from gcxform.errormodel.model import AXES, BORDER, State
from gcxform.errormodel.temperatures import Readings, Row, read_readings, unknown_sensor
from gcxform.errormodel.thermal import Held, Rod, Stretch, ThermalScrew, drift, stretch
from gcxform.system.arrays import Floats
from gcxform.system.inputs import referred

UM = 1e-3  # mm


class HeldFile(msgspec.Struct, forbid_unknown_fields=True, kw_only=True):
    """A screw held at both ends, over `length` in mm from bearing A, the fixed one, to bearing B.

    `kA` and `kB` are the axial stiffness of the bearings in N/um (inf: rigid), `EA` is modulus of
    elasticity times cross-section of the screw in N.
    """

    kA: Annotated[float, says("stiffness of the fixed bearing, N/um; inf is rigid")]  # noqa: N815 (the names of the formula)
    kB: Annotated[float, says("stiffness of the other bearing, N/um; inf is rigid")]  # noqa: N815
    EA: Annotated[float, says("modulus of elasticity times cross-section of the screw, N")]
    length: Annotated[float, says("between the bearings, mm")]


class ScrewFile(msgspec.Struct, forbid_unknown_fields=True, rename="kebab", kw_only=True):
    """The screw of an axis whose position is measured at the motor.

    `nut` is the distance in mm of the nut from the fixed bearing when the axis stands at 0,
    `direction` +1 if the nut runs away from that bearing with ascending positions, and -1 if it
    comes nearer. `homed-at` is the position in mm at which the axis was homed in this state.
    """

    nut: Annotated[float, says("from the fixed bearing to the nut where the axis is at 0, mm")]
    direction: Annotated[
        Literal[1, -1],
        says("1: the nut runs away from the fixed bearing as positions rise, -1: it comes nearer"),
    ]
    homed_at: Annotated[float, says("the position at which the axis was homed in this state, mm")]
    held: Annotated[HeldFile | None, says("what holds the screw where it is held at both ends")] = (
        None
    )


class ScaleFile(msgspec.Struct, forbid_unknown_fields=True, rename="kebab", kw_only=True):
    """The scale of an axis whose position is measured with it: `fixed-at` is where, in mm."""

    fixed_at: Annotated[float, says("the position at which the scale is fixed, mm")]


class ThermalAxis(msgspec.Struct, forbid_unknown_fields=True, kw_only=True):
    """A warm axis: a screw, or a scale if it has one.

    `travel` is in mm, `expansion` in 1/K. `sensors` are columns of the readings and `at` their
    places in mm: from the fixed bearing along a screw, axis positions along a scale.
    """

    travel: Annotated[tuple[float, float], says("from to, mm")]
    expansion: Annotated[float, says("of the screw or the scale, 1/K")]
    sensors: Annotated[list[str], says("columns of the readings")]
    at: Annotated[
        list[float],
        says("their places, mm: from the fixed bearing along a screw, positions along a scale"),
    ]
    screw: Annotated[
        ScrewFile | None, says("the screw, where the position is measured at the motor")
    ] = None
    scale: Annotated[
        ScaleFile | None, says("the scale, where the position is measured with one")
    ] = None


class ThermalScrewFile(msgspec.Struct, forbid_unknown_fields=True, rename="kebab", kw_only=True):
    """An error model of the kind `thermal-screw`: axes that are warmer than when measured.

    `readings` is a CSV file; the state is its last row, or the last one at or before `time`, by at
    most `max-age` s. `reference` is the state in which the geometry was measured, degC or a time of
    the readings. Readings outside of `sensor-range` (degC), and errors above `limit` (mm) within
    the travel, are refused. `node-interpolation = "linear"` is for what a control does that is sent
    the errors at the sensors.
    """

    format: Annotated[int, says("the form of this file; now 1")]
    kind: Annotated[Literal["thermal-screw"], says("the kind of the model")]
    readings: Annotated[str, says("temperatures by time: a CSV file")]
    reference: Annotated[
        float | datetime,
        says("the state in which the geometry was measured: degC, or a time of the readings"),
    ]
    sensor_range: Annotated[tuple[float, float], says("readings outside are refused, degC")]
    time: Annotated[
        datetime | None, says("the state is that at this time; absent: the last one")
    ] = None
    max_age: Annotated[float, says("how old a reading may be, s")] = 600.0
    limit: Annotated[float, says("a larger error within the travel is refused, mm")] = 0.2
    node_interpolation: Annotated[
        Literal["exact", "linear"],
        says("between sensors: as the rod is, or straight as a control does"),
    ] = "exact"
    X: Annotated[ThermalAxis | None, says("the axis X")] = None
    Y: Annotated[ThermalAxis | None, says("the axis Y")] = None
    Z: Annotated[ThermalAxis | None, says("the axis Z")] = None

    @property
    def axes(self) -> tuple[ThermalAxis | None, ThermalAxis | None, ThermalAxis | None]:
        """The axes in their order."""
        return self.X, self.Y, self.Z


def thermal_screw(document: TomlText) -> ThermalScrew:
    """Return the model of a file of this kind. Raises UsageError for all that is wrong with it."""
    file = convert(document, ThermalScrewFile)
    if found := [*_general_findings(document, file), *_axis_findings(document, file)]:
        raise UsageError(tuple(found))
    readings = read_readings(_readings_of(document, file))
    for axis, name in zip(AXES, file.axes, strict=True):
        for k, sensor in enumerate(name.sensors if name else ()):
            if sensor not in readings.sensors:
                raise unknown_sensor(readings, sensor, document.where(axis, "sensors", k))
    work = _Work(document, file, readings)
    row = readings.at(file.time, file.max_age, document.where("time"))
    return work.model(row)


def _readings_of(document: TomlText, file: ThermalScrewFile) -> Path:
    """Return the place of the readings. Raises UsageError, where it is said, if none are there."""
    where, folder = document.where("readings"), Path(document.file).parent
    place = folder if "\0" in file.readings else referred(folder, file.readings, where)
    if place.is_dir() or not place.exists():
        message = f"there is no file {file.readings!r}"
        raise UsageError.one("GX401", message, where)
    return place


class _Work:
    """A file with its readings, from which models of several times are made."""

    def __init__(self, document: TomlText, file: ThermalScrewFile, readings: Readings) -> None:
        self.document = document
        self.file = file
        self.readings = readings

    def chosen(self, time: str) -> ThermalScrew:
        """Return the model at a time (ISO 8601). Raises UsageError."""
        try:
            asked = datetime.fromisoformat(time)
        except ValueError:
            hint = "write it as in the readings: 2026-03-04T08:00:00"
            raise UsageError.one("GX702", f"{time!r} is not a time", hint=hint) from None
        return self.model(self.readings.at(asked, self.file.max_age, None))

    def model(self, row: Row) -> ThermalScrew:
        """Return the model in the state of a row."""
        axes: list[Stretch | None] = []
        states = []
        for letter, axis in zip(AXES, self.file.axes, strict=True):
            if axis is None:
                axes.append(None)
                continue
            rod = _rod(axis)
            warm = self._temperatures(axis, row)
            warmer = np.array(warm) - self._reference(axis)
            linear = self.file.node_interpolation == "linear"
            axes.append(found := stretch(rod, warmer, axis.travel, linear))
            names = tuple(axis.sensors)
            rest = (axis.travel, found.largest, drift(rod, axis.travel))
            states.append(State(letter, row.time.isoformat(), names, warm, *rest))
        self._check_limit(states)
        return ThermalScrew((axes[0], axes[1], axes[2]), tuple(states), self.chosen)

    def _temperatures(self, axis: ThermalAxis, row: Row) -> tuple[float, ...]:
        """Return the readings of the sensors of an axis in a row, degC."""
        return self.readings.temperatures(row, axis.sensors, self.file.sensor_range)

    def _reference(self, axis: ThermalAxis) -> Floats:
        """Return the temperatures (n,) of the sensors when the geometry was measured, degC."""
        if isinstance(self.file.reference, float):
            return np.full(len(axis.sensors), self.file.reference)
        where = self.document.where("reference")
        row = self.readings.at(self.file.reference, self.file.max_age, where)
        return np.array(self._temperatures(axis, row))

    def _check_limit(self, states: list[State]) -> None:
        """Refuse errors above the limit: what moves so far is no machine in a known state."""
        for state in states:
            if not state.largest <= self.file.limit:
                raise UsageError.one(
                    "GX425",
                    f"{state.axis} is off by up to {state.largest / UM:.1f} um at {state.time}, "
                    f"the limit is {self.file.limit / UM:g} um",
                    self.document.where("limit" if "limit" in self.document.values else state.axis),
                    "let the machine cool down, or look for a wrong sensor; limit = raises it",
                )


def _rod(axis: ThermalAxis) -> Rod:
    """Return the screw or the scale of an axis."""
    at = np.array(axis.at, dtype=np.float64)
    if axis.screw is None:
        assert axis.scale is not None
        return Rod(at, axis.expansion, still=axis.scale.fixed_at)
    screw, ends = axis.screw, axis.screw.held
    held = None if ends is None else Held(ends.kA / UM, ends.kB / UM, ends.EA, ends.length)
    return Rod(at, axis.expansion, screw.nut, screw.direction, screw.homed_at, held)


# --- what is wrong with a file ---


def _general_findings(document: TomlText, file: ThermalScrewFile) -> Iterator[Diagnostic]:
    if all(axis is None for axis in file.axes):
        message = "the error model has no table, needed is one of [X], [Y] and [Z]"
        yield Diagnostic("GX422", message, document.where())
    low, high = file.sensor_range
    if not -math.inf < low < high < math.inf:
        message = f"sensor-range {low:g} to {high:g} degC is no range"
        yield Diagnostic("GX429", message, document.where("sensor-range"))
    if isinstance(file.reference, float) and not low <= file.reference <= high:
        message = f"the reference {file.reference:g} degC is outside of sensor-range"
        yield Diagnostic("GX429", message, document.where("reference"))
    for name, value in (("max-age", file.max_age), ("limit", file.limit)):
        if not value > 0.0:
            yield Diagnostic("GX429", f"{name} {value:g} is not above 0", document.where(name))


def _axis_findings(document: TomlText, file: ThermalScrewFile) -> Iterator[Diagnostic]:
    for letter, axis in zip(AXES, file.axes, strict=True):
        if axis is not None:
            found = [*_table_findings(document, letter, axis)]
            yield from found or _reach_findings(document, letter, axis)


def _table_findings(document: TomlText, letter: str, axis: ThermalAxis) -> Iterator[Diagnostic]:
    """Yield what is wrong with the numbers of an axis."""
    if len(axis.sensors) != len(axis.at):
        message = f"[{letter}] at has {len(axis.at)} places for {len(axis.sensors)} sensors"
        yield Diagnostic("GX410", message, document.where(letter, "at"))
    for fault in faults(axis.at, {}):
        row = () if fault.row is None else (fault.row,)
        message = f"[{letter}] at: {fault.message}"
        yield Diagnostic(fault.code, message, document.where(letter, "at", *row))
    low, high = axis.travel
    if not -math.inf < low < high < math.inf:
        message = f"[{letter}] travel {low:g} to {high:g} mm is none"
        yield Diagnostic("GX429", message, document.where(letter, "travel"))
    if (axis.screw is None) == (axis.scale is None):
        which = "neither" if axis.screw is None else "both"
        message = f"[{letter}] has {which} of [{letter}.screw] and [{letter}.scale]"
        hint = "screw: its position is measured at the motor; scale: with a linear scale"
        yield Diagnostic("GX429", message, document.where(letter), hint)
    yield from _number_findings(document, letter, axis)


def _number_findings(document: TomlText, letter: str, axis: ThermalAxis) -> Iterator[Diagnostic]:
    """Yield the numbers of an axis that are out of their range."""
    finite: dict[tuple[str, ...], float] = {}
    positive: dict[tuple[str, ...], float] = {("expansion",): axis.expansion}
    if axis.scale is not None:
        finite["scale", "fixed-at"] = axis.scale.fixed_at
    if axis.screw is not None:
        finite["screw", "nut"], finite["screw", "homed-at"] = axis.screw.nut, axis.screw.homed_at
        for name, value in (
            msgspec.structs.asdict(axis.screw.held).items() if axis.screw.held else ()
        ):
            positive["screw", "held", name] = value
    for keys, value in finite.items():
        if not math.isfinite(value):
            message = f"[{letter}] {keys[-1]} is {value}"
            yield Diagnostic("GX429", message, document.where(letter, *keys))
    for keys, value in positive.items():
        rigid = value == math.inf and keys[-1] in ("kA", "kB")
        if not (0.0 < value < math.inf or rigid):
            message = f"[{letter}] {keys[-1]} {value:g} is not above 0"
            yield Diagnostic("GX429", message, document.where(letter, *keys))


def _reach_findings(document: TomlText, letter: str, axis: ThermalAxis) -> Iterator[Diagnostic]:
    """Yield places of the rod whose temperature is not known: no sensor is beyond them."""
    rod = _rod(axis)
    needed = rod.places(np.array([*axis.travel, rod.still]))
    if rod.held is not None:
        needed = np.append(needed, [0.0, rod.held.length])
    low, high = float(needed.min()), float(needed.max())
    first, last = axis.at[0], axis.at[-1]
    if low < first - BORDER or high > last + BORDER:
        what = "screw" if axis.screw else "scale"
        yield Diagnostic(
            "GX428",
            f"[{letter}] sensors are at {first:g} to {last:g} mm, the temperature of the {what} "
            f"matters from {low:g} to {high:g} mm",
            document.where(letter, "at"),
            "name the nearest sensor a second time, at the end, if it is as warm there",
        )
