"""Facts a toolpath may have, each with the check that decides it.

A chain of passes is checked by facts before any program is read: a pass requires some, ensures
some and clears some. A program just read has the facts of `AT_READING`.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from gcxform.system.arrays import Flags
from gcxform.system.distinct import distinct, one_of
from gcxform.toolpath.path import OWN_DISTANCES, Form, Plane, Toolpath
from gcxform.values import dataclass


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
    plain = path.block[~one_of(path.form, OWN_DISTANCES)]
    return not path.blocks.incremental[plain].any()


ABSOLUTE = Fact(
    "ABSOLUTE",
    "every block but returns to reference, cycles and moves from nowhere known is in G90",
    _absolute,
)


def inseparable_cycles(path: Toolpath, in_step: bool = False) -> Flags:
    """Return the rows (n,) of cycles that cannot be written as plain moves.

    These are tapping, cycles that orient the spindle, and the cycles between which and one of these
    there is no plain move: what stays in force, the level they began from above all, ties them.
    `in_step`: tapping is said by another code, and ties none.
    """
    cycle = one_of(path.form, (Form.CYCLE, Form.SYNCHRONISED))
    tied = (path.form == Form.SYNCHRONISED) & (not in_step)
    oriented = [event.row - 1 for event in path.events if event.within and event.what == "M19"]
    tied[oriented] = True
    run = np.cumsum(~cycle)
    return np.asarray(cycle & np.isin(run, distinct(run[cycle & tied])))


IN_AIR = 0.1
"""mm; how far the moves between the taps of a pattern may be from where they shall be."""


def between_taps(path: Toolpath) -> Flags:
    """Return the rows (n,) of tapping cycles that no words of their own say where to end.

    Over the hole the tool arrives at a height that an earlier block has settled, and it goes back
    to one. Where the way out leads past R, it retraces the way in, which has words, up to there.
    """
    tied, cycle = path.form == Form.SYNCHRONISED, path.form == Form.CYCLE
    lines = np.zeros(len(path.blocks.inch), np.bool_)
    lines[path.block[tied]] = True
    together = path.block[1:] == path.block[:-1]
    way_out = np.append(False, tied[1:] & tied[:-1] & together)[: len(path)]
    to_r = np.append(tied[1:] & together, False)[: len(path)]
    began = np.empty_like(path.end)
    began[1:], began[:1] = path.start[:-1], np.nan
    past = (np.abs(path.end - began)[:, :3] > 1e-7).any(axis=1)
    return np.asarray(lines[path.block] & ((cycle & ~to_r) | (way_out & past)))


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

TIP_POSITIONS = Fact(
    "TIP_POSITIONS", "X, Y and Z are those of the tool's tip on the workpiece", _always
)
AXIS_POSITIONS = Fact("AXIS_POSITIONS", "X, Y and Z are those of the machine's axes", _always)

AT_READING = ((NOMINAL, COMPENSATED), (TIP_POSITIONS, AXIS_POSITIONS))
"""What a program may be when it is read; the first of each unless a pass takes it for another."""
FACTS = (
    ABSOLUTE,
    METRIC,
    LINEAR_ONLY,
    XY_ARCS,
    KNOWN_POSITIONS,
    NOMINAL,
    COMPENSATED,
    TIP_POSITIONS,
    AXIS_POSITIONS,
    WORKPIECE_FRAME,
    NO_CYCLES,
    NO_CUTTER_COMP,
)
