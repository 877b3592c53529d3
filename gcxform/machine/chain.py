"""Kinematic chains: where the tool is on the workpiece, for positions of the machine's axes.

The linear axes carry the head along, and each rotary axis turns what follows it, on the way from
the base to the workpiece or to the spindle. With all rotary axes at 0 workpiece and machine are one
frame. Any machine whose linear axes come before its rotary ones is such a chain, with axes that
point and lie anywhere (screws by their directions and points; reference: product of exponentials).

With M_T and M_H what table and head do at angles q, R_T and R_H the turns in them, and j the
position of X, Y and Z:

    tip = M_T(q)^-1 (j + M_H(q) tip0)        tool axis = R_T(q)^-1 R_H(q) (0, 0, 1)
    j = M_T(q) tip - M_H(q) tip0

The oracles are `tests/quaternions.py`, which shares no code and not even numpy, matrices of scipy,
and LinuxCNC's own modules (`tests/oracles/linuxcnc_kins.py`).
"""

from __future__ import annotations

import math
from dataclasses import field, replace

import numpy as np

from gcxform.diagnostics import Location, UsageError
from gcxform.machine.machine import Axis, Machine, Tool
from gcxform.system.arrays import Floats
from gcxform.values import dataclass

Triple = tuple[float, float, float]
Span = tuple[float, float]
SPINDLE: Triple = (0.0, 0.0, 1.0)
"""From the tip to the spindle with all axes at 0."""
EVERYWHERE: Span = (-math.inf, math.inf)
LINEAR = "XYZ"


@dataclass(frozen=True)
class Rotary:
    """A rotary axis: the line it turns about, with all axes at 0, and how it is commanded.

    `direction` has the length 1, `point` is in mm; a positive command turns right-handed about the
    direction where `sign` is +1. Limits and wrap are degrees, the speed degrees a minute.
    """

    letter: str
    direction: Triple
    point: Triple
    sign: int
    limits: Span | None = None
    wrap: float | None = None
    max_speed: float | None = None

    def turn(self, points: Floats, degrees: Floats) -> Floats:
        """Return points (..., 3) as the axis carries them when it is commanded to angles (...)."""
        point = np.array(self.point)
        return np.asarray(turned(points - point, self.direction, self.sign * degrees) + point)

    def swing(self, vectors: Floats, degrees: Floats) -> Floats:
        """Return vectors (..., 3) as the axis carries them."""
        return turned(vectors, self.direction, self.sign * degrees)

    def shown(self, degrees: Floats) -> Floats:
        """Return angles as the display has them, from 0 up to the wrap if there is one."""
        if self.wrap is None:
            return degrees
        found = np.mod(degrees, self.wrap)
        return np.where(found < self.wrap, found, 0.0)  # the remainder of -1e-17 is the wrap


def turned(vectors: Floats, direction: Triple, degrees: Floats) -> Floats:
    """Return vectors (..., 3) turned right-handed about a unit vector by angles (...).

    The formula of Rodrigues: v + sin K v + (1 - cos) K K v, with K v = direction x v. Column by
    column, because products with small matrices are slow.
    """
    radians = np.radians(np.fmod(degrees, 360.0))
    sine, rest = np.sin(radians), 1.0 - np.cos(radians)
    x, y, z = direction
    a, b, c = vectors[..., 0], vectors[..., 1], vectors[..., 2]
    sideways = y * c - z * b, z * a - x * c, x * b - y * a
    inwards = (
        y * sideways[2] - z * sideways[1],
        z * sideways[0] - x * sideways[2],
        x * sideways[1] - y * sideways[0],
    )
    shape = np.broadcast_shapes(vectors.shape[:-1], degrees.shape)
    found = np.empty((*shape, 3))
    for k, (own, across, back) in enumerate(zip((a, b, c), sideways, inwards, strict=True)):
        found[..., k] = own + sine * across + rest * back
    return found


@dataclass(frozen=True)
class Chain:
    """A machine's rotary axes from the base outwards, and the tip with all axes at 0, in mm.

    Angles are arrays (..., m) in degrees, as commanded: a column an axis, those of the table
    first. `travel` has the limits of X, Y and Z in mm.
    """

    table: tuple[Rotary, ...] = ()
    head: tuple[Rotary, ...] = ()
    tip: Triple = (0.0, 0.0, 0.0)
    travel: tuple[Span, Span, Span] = field(default=(EVERYWHERE, EVERYWHERE, EVERYWHERE))

    @property
    def axes(self) -> tuple[Rotary, ...]:
        """The axes in the order of the columns of angles."""
        return self.table + self.head

    @property
    def letters(self) -> tuple[str, ...]:
        """The letters of the axes in that order."""
        return tuple(axis.letter for axis in self.axes)

    def with_tool(self, tool: Tool, gauge_point: Triple = (0.0, 0.0, 0.0)) -> Chain:
        """Return the chain with the tip of a tool that is held at a gauge point."""
        x, y, z = np.subtract(gauge_point, tool.vector).tolist()
        return replace(self, tip=(x, y, z))

    # --- from the machine to the workpiece and back ---

    def forward(self, linear: Floats, angles: Floats) -> tuple[Floats, Floats]:
        """Return tip (..., 3) in mm and tool axis (..., 3) in the frame of the workpiece.

        `linear` (..., 3) are X, Y and Z. The tool axis is a unit vector from tip to spindle.
        """
        return self.tip_at(linear, angles), self.tool_axis(angles)

    def tip_at(self, linear: Floats, angles: Floats) -> Floats:
        """Return the tip (..., 3) alone, in mm in the frame of the workpiece."""
        return self.onto_workpiece(linear + self.arm(angles), angles)

    def linear(self, tip: Floats, angles: Floats) -> Floats:
        """Return X, Y and Z (..., 3) that bring the tip to points of the workpiece."""
        return np.asarray(self.onto_machine(tip, angles) - self.arm(angles))

    def onto_workpiece(self, points: Floats, angles: Floats) -> Floats:
        """Return points (..., 3) of the machine in the frame of the workpiece, mm."""
        for k, axis in enumerate(self.table):
            points = axis.turn(points, -angles[..., k])
        return points

    def onto_machine(self, points: Floats, angles: Floats) -> Floats:
        """Return points (..., 3) of the workpiece where they are in the machine, mm."""
        for k, axis in reversed([*enumerate(self.table)]):
            points = axis.turn(points, angles[..., k])
        return points

    def arm(self, angles: Floats) -> Floats:
        """Return the tip (..., 3) with X, Y and Z at 0, in machine coordinates, mm."""
        points = self._everywhere(self.tip, angles)
        for k, axis in reversed([*enumerate(self.head, len(self.table))]):
            points = axis.turn(points, angles[..., k])
        return points

    def tool_axis(self, angles: Floats) -> Floats:
        """Return the tool axis (..., 3) in the frame of the workpiece, from tip to spindle."""
        vectors = self.spindle(angles)
        for k, axis in enumerate(self.table):
            vectors = axis.swing(vectors, -angles[..., k])
        return vectors

    def spindle(self, angles: Floats) -> Floats:
        """Return the tool axis (..., 3) in machine coordinates, from tip to spindle."""
        vectors = self._everywhere(SPINDLE, angles)
        for k, axis in reversed([*enumerate(self.head, len(self.table))]):
            vectors = axis.swing(vectors, angles[..., k])
        return vectors

    def upwards(self, angles: Floats) -> Floats:
        """Return the Z of the workpiece (..., 3) in machine coordinates: out of the table."""
        vectors = self._everywhere(SPINDLE, angles)
        for k, axis in reversed([*enumerate(self.table)]):
            vectors = axis.swing(vectors, angles[..., k])
        return vectors

    @staticmethod
    def _everywhere(point: Triple, angles: Floats) -> Floats:
        return np.broadcast_to(np.array(point), (*angles.shape[:-1], 3)).copy()


# --- the chain of a machine file ---


def chain_of(machine: Machine, tool: Tool | None = None) -> Chain:
    """Return the chain of a machine with a tool; without one the tip is the gauge point.

    Raises UsageError for a rotary axis that is in no chain or nowhere, and for a linear one that
    points elsewhere.
    """
    where = Location(str(machine.file))
    for letter, axis in machine.axes.items():
        if reason := _unfit(machine, letter, axis):
            raise UsageError.one("GX452", reason, where)
    table, head = (
        tuple(_rotary(letter, machine.axes[letter]) for letter in letters)
        for letters in (machine.table, machine.head)
    )
    x, y, z = (_travel(machine.axes.get(letter)) for letter in LINEAR)
    chain = Chain(table, head, machine.gauge_point, (x, y, z))
    return chain.with_tool(tool, machine.gauge_point) if tool else chain


def tables_of(machine: Machine) -> Chain | None:
    """Return the chain of a machine of which only tables turn; None where it is not known."""
    if machine.head or not machine.table:
        return None
    try:
        return chain_of(machine)
    except UsageError:
        return None


def _unfit(machine: Machine, letter: str, axis: Axis) -> str:
    """Return why an axis cannot be followed, or nothing."""
    if letter in LINEAR:
        own = tuple(float(letter == other) for other in LINEAR)
        skew = axis.direction is not None and axis.direction != own
        errors = "squareness belongs into the error model"
        return f"the direction of axis {letter} is not {letter}: {errors}" if skew else ""
    if letter in "UVW":
        return f"the axis {letter} is not followed, only X, Y, Z and rotary axes are"
    if letter not in machine.table + machine.head:
        return f"the axis {letter} turns neither the table nor the head: add it to one of them"
    return "" if axis.point is not None else f"the point of axis {letter} is missing"


def _rotary(letter: str, axis: Axis) -> Rotary:
    assert axis.direction is not None
    assert axis.point is not None
    assert axis.sign is not None
    stated = (axis.direction, axis.point, axis.sign)
    return Rotary(letter, *stated, axis.limits, axis.wrap, axis.max_speed)


def _travel(axis: Axis | None) -> Span:
    return EVERYWHERE if axis is None or axis.limits is None else axis.limits
