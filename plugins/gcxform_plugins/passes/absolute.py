"""`absolute`: G91 becomes G90."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

import gcxform as gx


@dataclass(frozen=True)
class Absolute(gx.Pass):
    """Write positions instead of distances: G91 becomes G90.

    Positions are summed exactly as the control does and rounded once, so nothing drifts. Returns to
    reference (`G91 G28 Z0`) and canned cycles stay as they are, and so do moves of an axis of which
    it is not known where it stands, behind a tool change for example.
    """

    name = "absolute"
    ensures = frozenset({gx.ABSOLUTE})

    def apply(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        """Return the path with every plain block in absolute distance mode."""
        own = np.zeros(len(path.blocks.incremental), np.bool_)
        own[path.block[np.isin(path.form, gx.OWN_DISTANCES)]] = True
        incremental = path.blocks.incremental & own
        return path.replace(blocks=replace(path.blocks, incremental=incremental))
