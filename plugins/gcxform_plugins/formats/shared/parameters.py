"""What formats with ISO 230-1 names share: EXX, EAX, C0Y ... as parameters over one axis each.

Signs: an error is actual minus nominal of the tool relative to the workpiece; the axes are taken as
if each moved the tool, in their order from the workpiece to the tool.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Annotated, Literal, NamedTuple

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Floats

AXES = "XYZ"
COLUMNS = "XYZABC"
RAD_PLACES = 12
FUNCTION = re.compile("E[XYZABC][XYZ]")
SQUARENESS = {"C0Y": ("EXY", -1.0), "B0Z": ("EXZ", 1.0), "A0Z": ("EYZ", -1.0)}
"""The functions that squareness adds to, and with which sign times the position."""
HINT = "--kind functions fits functions, and says what is left"
Tool = Annotated[gx.Vector | None, gx.Option("way from the gauge point to the measured point")]
Order = Annotated[
    Literal["XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"] | None,
    gx.Option("axes from the workpiece to the tool: the chain of the control"),
]
Values = Annotated[Literal["error", "correction"], gx.Option("what the file holds")]


class Said(NamedTuple):
    """What the file does not say of itself."""

    name: str
    values: str
    order: str | None
    tool: tuple[float, float, float] | None


@dataclass
class Parameters:
    """The parameters of a file: functions by name, squareness by name, each with its line."""

    functions: dict[str, tuple[Floats, Floats]] = field(default_factory=dict)
    squareness: dict[str, float] = field(default_factory=dict)
    rows: dict[str, gx.TextRow] = field(default_factory=dict)

    def claim(self, name: str, row: gx.TextRow, column: int) -> None:
        """Note where a parameter is. Raises UsageError for one that is not known, or is twice."""
        if name in self.rows:
            raise row.refuse("GX417", f"{name} stands twice in the file", column)
        if not FUNCTION.fullmatch(name) and name not in SQUARENESS:
            message = f"{name} is not a parameter of three linear axes"
            hint = f"known: E.X, E.Y, E.Z, {', '.join(SQUARENESS)}; without the rest if it is zero"
            raise row.refuse("GX482", message, column, hint)
        self.rows[name] = row

    def model(self, said: Said) -> gx.AxisFunctions | gx.RigidBody:
        """Return the model. Raises UsageError for what it needs and does not have."""
        self._fold(said)
        if not self.functions:
            row = next(iter(self.rows.values()))
            raise row.refuse("GX422", "the file has no function of an axis")
        turning = any(n[1] in "ABC" and v.any() for n, (_, v) in self.functions.items())
        x, y, z = (self._axis(axis, turning) for axis in AXES)
        if not turning:
            return gx.AxisFunctions((x, y, z), said.order or AXES)
        tool, order = said.tool, said.order
        if tool is None or order is None:
            row = next(row for name, row in self.rows.items() if name[1] in "ABC")
            hint = f"--from '{said.name} values={said.values} order=XYZ tool=0,0,0'"
            message = "with angular errors the order of the axes and the measured point matter"
            raise row.refuse("GX480", message, None, hint)
        return gx.RigidBody((x, y, z), order, measured=tool)

    def _fold(self, said: Said) -> None:
        """Make squareness part of the functions, and corrections errors."""
        for name, angle in self.squareness.items():
            into, sign = SQUARENESS[name]
            if not angle:
                continue
            if said.values == "correction":
                message = f"the sign of {name} is not certain in a file of corrections"
                raise self.rows[name].refuse("GX420", message)
            position = self._nodes(name[-1])
            if not len(position):
                message = f"{name} needs functions of {name[-1]} to say over which travel"
                raise self.rows[name].refuse("GX420", message)
            before = self._values(into, position)
            self.functions[into] = position, before + sign * angle * position
        if said.values == "correction":
            self.functions = {n: (p, -v) for n, (p, v) in self.functions.items()}

    def _nodes(self, axis: str) -> Floats:
        """Return the positions of all functions of an axis, which have to span the same travel."""
        found: Floats = np.empty(0)
        for name, (position, _) in self.functions.items():
            if name[-1] != axis:
                continue
            if len(found) and (position[0] != found[0] or position[-1] != found[-1]):
                message = f"{name} goes from {position[0]:g} to {position[-1]:g}, another function "
                message += f"of {axis} from {found[0]:g} to {found[-1]:g}"
                raise self.rows[name].refuse("GX482", message)
            found = np.union1d(found, position)
        return found

    def _values(self, name: str, position: Floats) -> Floats:
        if name not in self.functions:
            return np.zeros(len(position))
        return np.interp(position, *self.functions[name])

    def _axis(self, axis: str, turning: bool) -> gx.AxisFunction | None:
        position = self._nodes(axis)
        if not len(position):
            return None
        names = [f"E{column}{axis}" for column in COLUMNS[: 6 if turning else 3]]
        values = [self._values(name, position) for name in names]
        return gx.AxisFunction(position, np.stack(values, axis=1))


def checked_function(rows: Sequence[gx.TextRow], table: Floats, column: int) -> None:
    """Raise UsageError if positions, in a column, do not rise, or a number is not finite."""
    columns = {str(k): values for k, values in enumerate(table.T)}
    if found := list(gx.faults(table[:, column], columns)):
        at = [(f, column if f.column == "position" else int(f.column)) for f in found]
        raise gx.UsageError(tuple(gx.placed(f, rows[f.row or 0], k) for f, k in at))


def functions_of(said: Said, model: gx.ErrorModel) -> Iterable[tuple[str, Floats, Floats]]:
    """Yield axis, positions (n,) and functions (n, 3 or 6) of a model, measured at zero.

    Raises UsageError for what the format cannot hold.
    """
    if not isinstance(model, gx.AxisFunctions | gx.RigidBody):
        raise gx.cannot_hold(said.name, f"a model of the kind {model.kind!r}", HINT)
    if isinstance(model, gx.RigidBody) and (model.order, model.measured) != said[2:]:
        tool = ",".join(f"{part:g}" for part in model.measured)
        hint = f"--to '{said.name} values={said.values} order={model.order} tool={tool}'"
        raise gx.cannot_hold(said.name, "the order of the axes and the measured point", hint)
    sign = -1.0 if said.values == "correction" else 1.0
    for k, (axis, function) in enumerate(zip(AXES, model.axes, strict=True)):
        if function is not None:
            values = function.values.copy()
            if isinstance(model, gx.RigidBody):
                away = np.where(np.isin(range(3), model.after(k)), model.at[k], 0.0)
                values[:, :3] -= np.cross(values[:, 3:], away)
            yield axis, function.position, sign * values


def written(values: Floats) -> list[str]:
    """Return the functions at one position, mm and rad, as texts."""
    return [gx.decimal(v, 9 if k < 3 else RAD_PLACES) for k, v in enumerate(values.tolist())]
