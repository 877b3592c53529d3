"""`metric`: G20 becomes G21."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

import gcxform as gx


@dataclass(frozen=True)
class Metric(gx.Pass):
    """Write millimetres instead of inches: G20 becomes G21.

    Lengths and feeds are converted; angles, counts, speeds and times are not lengths and stay.
    """

    name = "metric"
    ensures = frozenset({gx.METRIC})

    def apply(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        """Return the path with every block in millimetres."""
        never = np.zeros(len(path.blocks.inch), np.bool_)
        return path.replace(blocks=replace(path.blocks, inch=never))
