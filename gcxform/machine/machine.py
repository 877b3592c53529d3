"""Machines: axes with limits and speeds, work offsets and tools, as a file has them."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import msgspec

from gcxform.config.keys import says
from gcxform.config.quantities import ANGLE, LENGTH
from gcxform.config.schemas import with_unit
from gcxform.diagnostics import Location

SWITCHES = ("tip-on", "tip-off")
TIP_AT_START = "tip-at-start"
"""Settings that name the M codes with which the control follows the tip of the tool, and stops."""
Length = Annotated[float, with_unit(LENGTH)]
Angle = Annotated[float, with_unit(ANGLE)]
Place = Annotated[float, with_unit(LENGTH, ANGLE)]
"""What may be written with a unit: `gcxform.machine.file` makes numbers of it."""
Triple = tuple[Length, Length, Length]


class Axis(msgspec.Struct, frozen=True, forbid_unknown_fields=True, rename="kebab", kw_only=True):
    """An axis: travel (mm or degrees), top speed (mm/min or deg/min), and where a rotary one turns.

    `direction` is a unit vector along the axis and `point` (mm) lies on it, both in machine
    coordinates with all axes at 0; `sign` is +1 where a positive command turns right-handed about
    `direction`, -1 where left-handed; `wrap` is the modulo of the display in degrees. An axis may
    be given either way round: read from a file, the largest component of its direction is positive.
    """

    limits: Annotated[tuple[Place, Place] | None, says("its travel from to, mm or degrees")] = None
    max_speed: Annotated[float | None, says("its top speed, mm/min or degrees/min")] = None
    direction: Annotated[
        tuple[float, float, float] | None, says("the way it points, with all axes at 0: any length")
    ] = None
    point: Annotated[Triple | None, says("a point on a rotary axis, with all axes at 0, mm")] = None
    sign: Annotated[
        int | None,
        says("1: a positive command turns right-handed about the direction, -1: left-handed"),
    ] = None
    wrap: Annotated[Angle | None, says("where the display begins anew, degrees")] = None


NOT_SAID = float("nan")
"""A length or a radius that no file has said: never taken for 0."""


class Tool(msgspec.Struct, frozen=True, forbid_unknown_fields=True, rename="kebab", kw_only=True):
    """A tool, in mm: length from gauge point to tip, radius, offset of the tip in X and Y.

    Length and radius are nan where they are not known; `d` gives way to the radius when a file is
    loaded.
    """

    length: Annotated[Length, says("from gauge point to the tip, mm; else not known")] = NOT_SAID
    radius: Annotated[Length, says("of the cutter, mm; else not known")] = NOT_SAID
    d: Annotated[
        Length, says("instead of the radius: what D calls, as the control shows it, mm; see `d-is`")
    ] = NOT_SAID
    x: Annotated[Length, says("offset of the tip in X, mm")] = 0.0
    y: Annotated[Length, says("offset of the tip in Y, mm")] = 0.0
    name: Annotated[str, says("what it is called where programs call tools by their names")] = ""

    @property
    def vector(self) -> tuple[float, float, float]:
        """From the tip to the gauge point, mm."""
        return float(self.x), float(self.y), float(self.length)


class Offset(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """A work offset: the position of its origin by axis, mm and degrees."""

    X: Annotated[Length | None, says("where its zero is on X, mm")] = None
    Y: Annotated[Length | None, says("where its zero is on Y, mm")] = None
    Z: Annotated[Length | None, says("where its zero is on Z, mm")] = None
    U: Annotated[Length | None, says("where its zero is on U, mm")] = None
    V: Annotated[Length | None, says("where its zero is on V, mm")] = None
    W: Annotated[Length | None, says("where its zero is on W, mm")] = None
    A: Annotated[Angle | None, says("where its zero is on A, degrees")] = None
    B: Annotated[Angle | None, says("where its zero is on B, degrees")] = None
    C: Annotated[Angle | None, says("where its zero is on C, degrees")] = None


class MachineFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True, rename="kebab"):
    """A machine file as it is written."""

    format: Annotated[int, says("the form of this file; now 1")]
    name: Annotated[str, says("what the machine is called in what is printed")] = ""
    kinematics: Annotated[
        str | None,
        says(
            "a kind of machines, which names and places its rotary axes (`gcxform list kinematics`)"
        ),
    ] = None
    inclination: Annotated[Angle | None, says("by how much a nutating axis leans, degrees")] = None
    table: Annotated[
        list[str],
        says("letters of the rotary axes that carry the workpiece, from the base outwards"),
    ] = []
    head: Annotated[
        list[str], says("letters of the rotary axes that carry the spindle, from the base outwards")
    ] = []
    gauge_point: Annotated[
        Triple, says("of the spindle, in the machine with all axes at 0, mm")
    ] = (0.0, 0.0, 0.0)
    errors: Annotated[str | None, says("the error model of the machine: a file")] = None
    axis: Annotated[dict[str, Axis], says("an axis by its letter")] = {}
    work_offset: Annotated[
        dict[str, Offset],
        says(
            'where the zero of a work offset is in the machine, by its code: G54, "G54.1 P1", G505'
        ),
    ] = {}
    home: Annotated[
        dict[str, Offset],
        says(
            "where in the machine a reference point is, the end of travel, or the point that M92 "
            "counts from: G28, G30, M140, M92"
        ),
    ] = {}
    tool: Annotated[dict[str, Tool], says("a tool by its number, that of T or of H")] = {}
    tool_table: Annotated[str | None, says("a tool table of a control: a file")] = None
    tool_table_units: Annotated[
        Literal["mm", "in"] | None, says("the unit of its lengths, which it does not say itself")
    ] = None
    tool_table_control: Annotated[
        str, says("the control whose table it is (`gcxform list controls`)")
    ] = "linuxcnc"
    ini: Annotated[str | None, says("what a control says of programs: its INI file")] = None
    ini_control: Annotated[str, says("the control whose file it is (`gcxform list controls`)")] = (
        "linuxcnc"
    )
    control: Annotated[
        dict[str, str | float | list[int] | dict[str, dict[str, str | int]]],
        says("settings of the control on which the meaning of codes depends"),
    ] = {}


class Machine(msgspec.Struct, frozen=True, kw_only=True):
    """A machine: its axes by letter, work offsets by code (mm, degrees) and tools by number.

    `table` and `head` name the rotary axes from the base to the workpiece and to the spindle;
    `gauge_point` (mm) is that of the spindle with all axes at 0; `errors` is a file. `homes` are
    the machine positions of G28 and G30; `control` has settings that codes depend on; `inert_m` are
    M codes of the machine's own that move no axis and set no variable. `open` has the places of
    values that the file leaves to be filled in; `taken` says what is from a preset, and its source.
    `subprograms` are folders and `told` values of parameters that a file of the control names.
    """

    file: Path
    name: str = ""
    table: tuple[str, ...] = ()
    head: tuple[str, ...] = ()
    gauge_point: tuple[float, float, float] = (0.0, 0.0, 0.0)
    errors: Path | None = None
    axes: dict[str, Axis] = {}
    work_offsets: dict[str, dict[str, float]] = {}
    homes: dict[str, dict[str, float]] = {}
    tools: dict[int, Tool] = {}
    control: dict[str, str | float] = {}
    inert_m: frozenset[int] = frozenset()
    open: dict[tuple[str, ...], Location] = {}
    taken: tuple[str, ...] = ()
    subprograms: tuple[Path, ...] = ()
    told: dict[str, float] = {}
