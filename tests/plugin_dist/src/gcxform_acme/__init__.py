"""A plugin for gcxform: the dialect `acme9000`, the pass `shift` and the files of the control."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Axis, Machine, Tool


class Acme9000(gx.Dialect):
    """Acme 9000 mill control, firmware 3: arcs in XY only, no tape signs, four decimals."""

    name = "acme9000"
    axes = "XYZA"
    arc_rule = gx.ArcRule(planes=frozenset({"XY"}))
    program_rule = gx.ProgramRule(has_percent=False, has_program_number=False)
    numbers = gx.NumberFormat(mm=4, angle=2, zeros=True)


@dataclass(frozen=True)
class Shift(gx.Pass):
    """Move every point by a constant vector."""

    name = "shift"
    by: gx.Vector = (0.0, 0.0, 0.0)

    def apply(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        return self._moved(path, 1.0)

    def undo(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        return self._moved(path, -1.0)

    def _moved(self, path: gx.Toolpath, sign: float) -> gx.Toolpath:
        by = np.pad(sign * np.array(self.by), (0, len(path.axes) - 3))
        centre = path.centre + by[:3]
        return path.replace(end=path.end + by, entry=path.entry + by, centre=centre)


@dataclass(frozen=True)
class AcmeFiles(gx.ControlFiles):
    """Acme 9000: the pivot of its swivel head, and its tool list."""

    name = "acme"
    turns: Annotated[Literal["left", "right"], gx.Option("hand of the head, from its plate")]

    def kinematics(self, path: Path) -> Machine:
        """Take over the pivot of a swivel head B, such as PIVOT 250.0."""
        (row,) = gx.text_rows(path)
        if row.word(0) != "PIVOT":
            raise row.refuse("GX454", "not a pivot", 0)
        sign, point = (1 if self.turns == "right" else -1), (0.0, 0.0, row.number(1))
        axis = Axis(direction=(0.0, 1.0, 0.0), point=point, sign=sign)
        return Machine(file=path, name="acme", head=("B",), axes={"B": axis})

    @staticmethod
    def tools(path: Path, units: Literal["mm", "in"]) -> dict[int, Tool]:
        lengths = {int(row.number(0)): row.number(1) for row in gx.text_rows(path, comment=";")}
        return {n: Tool(length=z * {"mm": 1.0, "in": 25.4}[units]) for n, z in lengths.items()}


@gx.hookimpl
def gcxform_dialects() -> list[type[gx.Dialect]]:
    return [Acme9000]


@gx.hookimpl
def gcxform_passes() -> list[type[gx.Pass]]:
    return [Shift]


@gx.hookimpl
def gcxform_control_files() -> list[type[gx.ControlFiles]]:
    return [AcmeFiles]
