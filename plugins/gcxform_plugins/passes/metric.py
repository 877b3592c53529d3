"""`metric`: G20 becomes G21."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

import gcxform as gx

LENGTHS = frozenset("XYZUVWIJKR")
FOLDED = frozenset({"set-work", "local", "preset", "rotate", "scale", "mirror"})
"""What codes do that are not written where they are folded into the words of moves."""


@dataclass(frozen=True)
class Metric(gx.Pass):
    """Write millimetres instead of inches: G20 becomes G21.

    Lengths and feeds are converted, the points of G28, G30 and G53 too; angles, counts, speeds and
    times are not lengths and stay.
    """

    name = "metric"
    ensures = frozenset({gx.METRIC})

    def apply(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        """Return the path with every block in millimetres."""
        _refuse_lengths(path, context.source)
        never = np.zeros(len(path.blocks.inch), np.bool_)
        return path.replace(blocks=replace(path.blocks, inch=never))


def _refuse_lengths(path: gx.Toolpath, dialect: type[gx.Dialect]) -> None:
    """Raise InputError where a code has a length in inches: its number would be one of mm."""
    found = [
        gx.Diagnostic(
            "GX501",
            f"the words of {event.what} are in inches, stay, and would be read as mm",
            gx.Location("", event.line + 1),
            _way_out(event, dialect),
        )
        for event in path.events
        if path.blocks.inch[event.line - path.blocks.first] and _has_length(event, path, dialect)
    ]
    if found:
        raise gx.InputError(tuple(found))


def _has_length(event: gx.Event, path: gx.Toolpath, dialect: type[gx.Dialect]) -> bool:
    """Whether an event is written with a word that is a length: that of G64 is a tolerance."""
    code = dialect.codes.get(event.what)
    if code is None or (path.folded and code.act in FOLDED):
        return False
    letters = {address for address, value in event.values if value}  # 0 has no unit
    return bool(letters & LENGTHS or (event.what == "G64" and letters))


def _way_out(event: gx.Event, dialect: type[gx.Dialect]) -> str:
    """Return what to do: to leave the block out would shift the part."""
    if dialect.codes[event.what].act in FOLDED:
        return gx.put_before("offsets", why=": it writes what the block does into the moves")
    return "write the block in mm (G21)"
