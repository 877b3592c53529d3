"""`metric`: G20 becomes G21."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

import gcxform as gx

TOLERANCES = ("G64",)
"""Codes whose words are lengths that stay as they are written."""


@dataclass(frozen=True)
class Metric(gx.Pass):
    """Write millimetres instead of inches: G20 becomes G21.

    Lengths and feeds are converted; angles, counts, speeds and times are not lengths and stay.
    """

    name = "metric"
    ensures = frozenset({gx.METRIC})

    def apply(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        """Return the path with every block in millimetres."""
        _refuse_tolerances(path)
        never = np.zeros(len(path.blocks.inch), np.bool_)
        return path.replace(blocks=replace(path.blocks, inch=never))


def _refuse_tolerances(path: gx.Toolpath) -> None:
    """Raise InputError where a tolerance is given in inches: its number would be one of mm."""
    found = [
        gx.Diagnostic(
            "GX501",
            f"the tolerance of {event.what} is in inches and would be read as mm",
            gx.Location("", event.line + 1),
            "leave the tolerance out, or write that block in mm (G21)",
        )
        for event in path.events
        if event.what in TOLERANCES
        and event.values
        and path.blocks.inch[event.line - path.blocks.first]
    ]
    if found:
        raise gx.InputError(tuple(found))
