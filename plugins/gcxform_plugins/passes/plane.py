"""`plane`: arcs in planes that the target lacks become lines.

The chords are those of `segment`, so there is one way to make lines of arcs.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

import gcxform as gx
from gcxform_plugins.passes.segment import ANGLE_ERROR, chords, cut_arcs


@dataclass(frozen=True)
class PlanePass(gx.Pass):
    """Make lines of the arcs in planes in which the target control has no arcs."""

    name = "plane"
    demands = gx.Demands(promise_angle=ANGLE_ERROR)
    chord_error: Annotated[
        gx.Length, gx.Option("largest distance of a line from the arc it replaces", above=0.0)
    ] = 0.002

    @property
    def promise(self) -> float:
        """The chord error."""
        return self.chord_error

    def apply(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        """Return the path with arcs in the target's planes only."""
        lacking = [p for p in gx.Plane if p.name not in context.target.arc_rule.planes]
        todo = path.is_arc & np.isin(path.plane, lacking)
        if not todo.any():
            return path
        pieces = np.where(todo, chords(path, self.chord_error), 1)
        return cut_arcs(path, pieces, todo, keep=False)
