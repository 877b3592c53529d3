"""A plugin for gcxform: the dialect `acme9000` and the pass `shift`."""

from dataclasses import dataclass

import numpy as np

import gcxform as gx


class Acme9000(gx.Dialect):
    """Acme 9000 mill control, firmware 3: arcs in XY only, no tape signs, four decimals."""

    name = "acme9000"
    axes = "XYZA"
    arc_rule = gx.ArcRule(planes=frozenset({"XY"}))
    has_percent = False
    has_program_number = False
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


@gx.hookimpl
def gcxform_dialects() -> list[type[gx.Dialect]]:
    return [Acme9000]


@gx.hookimpl
def gcxform_passes() -> list[type[gx.Pass]]:
    return [Shift]
