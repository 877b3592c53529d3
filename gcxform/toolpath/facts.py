"""Facts a toolpath may have, each with the check that decides it.

A chain of passes is checked by facts before any program is read: a pass requires some, ensures
some and clears some. A program just read has the facts of `AT_READING`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from gcxform.toolpath.path import Plane, Toolpath


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


ABSOLUTE = Fact("ABSOLUTE", "every block is in G90", lambda path: not path.blocks.incremental.any())
METRIC = Fact("METRIC", "every block is in millimetres", lambda path: not path.blocks.inch.any())
LINEAR_ONLY = Fact("LINEAR_ONLY", "there is no arc", lambda path: not path.has_arcs)
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

AT_READING = frozenset({NOMINAL})
FACTS = (
    ABSOLUTE,
    METRIC,
    LINEAR_ONLY,
    XY_ARCS,
    KNOWN_POSITIONS,
    NO_CUTTER_COMP,
    NOMINAL,
    COMPENSATED,
)
