"""`metric`: G20 becomes G21."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import groupby

import numpy as np

import gcxform as gx

LENGTHS = frozenset("XYZUVWIJKR")
OF_PLANES = frozenset("XYZ")
"""The lengths of a code for a plane in space: the others of its words are angles, or directions."""
FOLDED = frozenset({"set-work", "local", "preset", "rotate", "scale", "mirror", "define-plane"})
"""What codes do that are not written where they are folded into the words of moves."""
KEPT = "the words of {} are in inches, stay, and would be read as mm"
SURFACE = "S is in feet a minute under G96, stays, and would be read as metres"


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
    kept = [(e, KEPT.format(e.what)) for e in path.events if _has_length(e, path, dialect)]
    found = [
        gx.Diagnostic("GX501", message, gx.Location("", event.line + 1), _way_out(event, dialect))
        for event, message in (*kept, *((event, SURFACE) for event in _surface_speeds(path)))
        if path.blocks.inch[event.line - path.blocks.first]
    ]
    if found:
        raise gx.InputError(tuple(found))


def _has_length(event: gx.Event, path: gx.Toolpath, dialect: type[gx.Dialect]) -> bool:
    """Whether an event is written with a word that is a length: those of G64 are tolerances."""
    code = dialect.codes.get(event.what)
    if code is None or (path.folded and code.act in FOLDED):
        return False
    letters = {address for address, value in event.values if value}  # 0 has no unit
    if event.what in dialect.tip_rule.unfollowed:
        return not letters.isdisjoint(OF_PLANES)
    return not letters.isdisjoint(LENGTHS.union(code.lengths))


def _surface_speeds(path: gx.Toolpath) -> Iterator[gx.Event]:
    """Yield what says the speed of a surface: G96, and each S until G97."""
    on = False
    for _, line in groupby(path.events, key=lambda event: event.line):
        events = list(line)
        modes = [event.what == "G96" for event in events if event.what in ("G96", "G97")]
        on = modes[-1] if modes else on
        if on:
            yield from (e for e in events if e.what == "G96" or "S" in dict(e.values))


def _way_out(event: gx.Event, dialect: type[gx.Dialect]) -> str:
    """Return what to do: to leave the block out would shift the part."""
    code = dialect.codes.get(event.what)
    if code is not None and code.act in FOLDED:
        return gx.put_before("offsets", why=": it writes what the block does into the moves")
    return "write the block in mm (G21)"
