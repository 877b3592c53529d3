"""Facts a toolpath may have, each with the check that decides it.

A chain of passes is checked by facts before any program is read: a pass requires some, ensures
some and clears some. A program just read has the facts of `AT_READING`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from gcxform.toolpath.path import OWN_DISTANCES, Flags, Form, Plane, Toolpath


@dataclass(frozen=True)
class Fact:
    """A predicate on toolpaths. `check` returns whether a path has it."""

    name: str
    meaning: str
    check: Callable[[Toolpath], bool]

    def __repr__(self) -> str:
        return self.name

    def __hash__(self) -> int:
        return hash(self.name)


def _always(path: Toolpath) -> bool:
    return True


def _absolute(path: Toolpath) -> bool:
    plain = path.block[~np.isin(path.form, OWN_DISTANCES)]
    return not path.blocks.incremental[plain].any()


ABSOLUTE = Fact("ABSOLUTE", "every block but returns to reference and cycles is in G90", _absolute)


def inseparable_cycles(path: Toolpath) -> Flags:
    """Return the rows (n,) of cycles that cannot be written as plain moves.

    These are tapping, cycles that orient the spindle, and the cycles between which and one of these
    there is no plain move: what stays in force, the level they began from above all, ties them.
    """
    cycle = np.isin(path.form, (Form.CYCLE, Form.SYNCHRONISED))
    tied = path.form == Form.SYNCHRONISED
    oriented = [event.row - 1 for event in path.events if event.within and event.what == "M19"]
    tied[oriented] = True
    run = np.cumsum(~cycle)
    return np.asarray(cycle & np.isin(run, np.unique(run[cycle & tied])))


def _no_cycles(path: Toolpath) -> bool:
    return not ((path.form == Form.CYCLE) & ~inseparable_cycles(path)).any()


NO_CYCLES = Fact("NO_CYCLES", "there is no canned cycle, but tapping and fine boring", _no_cycles)
METRIC = Fact("METRIC", "every block is in millimetres", lambda path: not path.blocks.inch.any())
LINEAR_ONLY = Fact(
    "LINEAR_ONLY",
    "there is no arc and no spline",
    lambda path: not path.has_arcs and not path.has_splines,
)
XY_ARCS = Fact(
    "XY_ARCS",
    "every arc is in the XY plane",
    lambda path: bool((path.plane[path.is_arc] == Plane.XY).all()),
)
KNOWN_POSITIONS = Fact(
    "KNOWN_POSITIONS",
    "X, Y and Z are known at the end of every move",
    lambda path: not bool(np.isnan(path.end[:, :3]).any()),
)
NO_CUTTER_COMP = Fact(
    "NO_CUTTER_COMP",
    "positions are those of the tool's centre: G41 and G42 are resolved",
    lambda path: not bool(path.side.any()),
)
NOMINAL = Fact(
    "NOMINAL", "positions are where the tool shall be, not yet compensated commands", _always
)
COMPENSATED = Fact(
    "COMPENSATED", "positions are commands compensated for a machine's errors", _always
)

WORKPIECE_FRAME = Fact(
    "WORKPIECE_FRAME",
    "words count from the work offset of the start, but for tool lengths",
    lambda path: all(
        frame.matrix is None and frame.work == path.first and not frame.diameter
        for frame in path.frames
    ),
)

AT_READING = frozenset({NOMINAL})
FACTS = (
    ABSOLUTE,
    METRIC,
    LINEAR_ONLY,
    XY_ARCS,
    KNOWN_POSITIONS,
    NOMINAL,
    COMPENSATED,
    WORKPIECE_FRAME,
    NO_CYCLES,
    NO_CUTTER_COMP,
)
