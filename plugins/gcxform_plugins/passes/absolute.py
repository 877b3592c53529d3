"""`absolute`: G91 becomes G90."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

import gcxform as gx


@dataclass(frozen=True)
class Absolute(gx.Pass):
    """Write positions instead of distances: G91 becomes G90.

    Positions are summed exactly as the control does and rounded once, so nothing drifts.
    """

    name = "absolute"
    ensures = frozenset({gx.ABSOLUTE})

    def apply(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        """Return the path with every block in absolute distance mode."""
        never = np.zeros(len(path.blocks.incremental), np.bool_)
        return path.replace(blocks=replace(path.blocks, incremental=never))
