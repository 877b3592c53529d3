"""Machines: axes with limits and speeds, work offsets and tools, as a file has them."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import msgspec

from gcxform.diagnostics import Location

MARK = "a number, or a string with a unit"
"""The description, in the schema, of what may be written with a unit."""
SWITCHES = ("tip-on", "tip-off")
TIP_AT_START = "tip-at-start"
"""Settings that name the M codes with which the control follows the tip of the tool, and stops."""
Value = Annotated[float, msgspec.Meta(description=MARK)]
Triple = tuple[Value, Value, Value]


class Axis(msgspec.Struct, frozen=True, forbid_unknown_fields=True, rename="kebab", kw_only=True):
    """An axis: travel (mm or degrees), top speed (mm/min or deg/min), and where a rotary one turns.

    `direction` is a unit vector along the axis and `point` (mm) lies on it, both in machine
    coordinates with all axes at 0; `sign` is +1 where a positive command turns right-handed about
    `direction`, -1 where left-handed; `wrap` is the modulo of the display in degrees. An axis may
    be given either way round: read from a file, the largest component of its direction is positive.
    """

    limits: tuple[Value, Value] | None = None
    max_speed: float | None = None
    direction: tuple[float, float, float] | None = None
    point: Triple | None = None
    sign: int | None = None
    wrap: Value | None = None


NOT_SAID = float("nan")
"""A length or a radius that no file has said: never taken for 0."""


class Tool(msgspec.Struct, frozen=True, forbid_unknown_fields=True, rename="kebab", kw_only=True):
    """A tool, in mm: length from gauge point to tip, radius, offset of the tip in X and Y.

    Length and radius are nan where they are not known.
    """

    length: Value = NOT_SAID
    radius: Value = NOT_SAID
    x: Value = 0.0
    y: Value = 0.0

    @property
    def vector(self) -> tuple[float, float, float]:
        """From the tip to the gauge point, mm."""
        return float(self.x), float(self.y), float(self.length)


class Offset(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """A work offset: the position of its origin by axis, mm and degrees."""

    X: Value | None = None
    Y: Value | None = None
    Z: Value | None = None
    U: Value | None = None
    V: Value | None = None
    W: Value | None = None
    A: Value | None = None
    B: Value | None = None
    C: Value | None = None


class MachineFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True, rename="kebab"):
    """A machine file as it is written."""

    format: int
    name: str = ""
    kinematics: str | None = None
    inclination: Value | None = None
    table: list[str] = []
    head: list[str] = []
    gauge_point: Triple = (0.0, 0.0, 0.0)
    errors: str | None = None
    axis: dict[str, Axis] = {}
    work_offset: dict[str, Offset] = {}
    home: dict[str, Offset] = {}
    tool: dict[str, Tool] = {}
    tool_table: str | None = None
    tool_table_units: Literal["mm", "in"] | None = None
    tool_table_control: str = "linuxcnc"
    control: dict[str, str | float | list[int] | dict[str, dict[str, str | int]]] = {}


class Machine(msgspec.Struct, frozen=True, kw_only=True):
    """A machine: its axes by letter, work offsets by code (mm, degrees) and tools by number.

    `table` and `head` name the rotary axes from the base to the workpiece and to the spindle;
    `gauge_point` (mm) is that of the spindle with all axes at 0; `errors` is a file. `homes` are
    the machine positions of G28 and G30; `control` has settings that codes depend on; `inert_m` are
    M codes of the machine's own that move no axis and set no variable. `open` has the places of
    values that the file leaves to be filled in; `taken` says what is from a preset, and its source.
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
