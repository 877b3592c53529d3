"""Where plain patterns of holes leave the tool: for all of a window from its columns, at once.

A pattern is plain if it begins without a cycle in force, ends with G80, and has one cycle: then it
keeps nothing but its dwell, and its end hangs on its own words, and on where the tool was.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gcxform.modal.moves.cycle_calls import CallColumns
from gcxform.modal.state import CYCLE_OFF
from gcxform.system.arrays import Floats, Ints
from gcxform.values import dataclass


@dataclass(frozen=True, slots=True)
class PatternEnd:
    """The end of a pattern that is plain if no cycle is in force before it; lengths are mm.

    last       the line behind it
    words      (3,) where X, Y and Z are placed, nan where they are not
    dwell      s, nan where none is said
    drills     whether any of its calls does
    clearance  R of the last that does, nan without it; `relative`: it counts from the level before
    high       whether that one goes back to the level before, if that is above R
    stepped    lines of it go by increments
    """

    last: int
    words: tuple[float, float, float]
    dwell: float
    drills: bool
    clearance: float
    relative: bool
    high: bool
    stepped: bool


def pattern_ends(columns: CallColumns, borders: Sequence[tuple[int, int]]) -> dict[int, PatternEnd]:
    """Return the ends of patterns among stretches, by the first line of each."""
    live, modes = columns.lines.live, columns.modes
    bounds = np.array(borders, np.int64).reshape(-1, 2)
    bounds = bounds[(bounds[:, 0] < bounds[:, 1]) & (bounds[:, 1] < live)]
    first, last = bounds[columns.calls[bounds[:, 0]]].T
    changes = columns.changes_until[last] - columns.changes_until[first + 1]
    plain = (modes.cycle[last] == CYCLE_OFF) & (changes == 0)
    first, last = first[plain], last[plain]
    if not len(first):
        return {}
    words = zip(*(_said(columns, axis, first, last - 1) for axis in "XYZ"), strict=True)
    called = columns.last_drilled[last - 1]
    rule = columns.lines.dialect.cycle_rule
    stay = rule is not None and rule.stays.levels
    of = (
        _said(columns, "P", first, last - 1).tolist(),
        (called >= first).tolist(),
        _said(columns, "R", first, called).tolist(),
        modes.incremental[columns.lasts("R")[called] if stay else called].tolist(),
        columns.common.initial[called].tolist(),
        (columns.added_until[first] != columns.added_until[last]).tolist(),
    )
    ends = map(PatternEnd, last.tolist(), words, *of)
    return dict(zip(first.tolist(), ends, strict=True))


def _said(columns: CallColumns, address: str, first: Ints, until: Ints) -> Floats:
    """Return the last word on lines from `first` to `until`, nan where there is none."""
    place = columns.lasts(address)[until]
    return np.where(place >= first, columns.word(address, place), np.nan)
