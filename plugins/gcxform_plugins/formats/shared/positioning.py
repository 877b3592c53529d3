"""What the formats of positioning tests share: deviations by target, direction and run (ISO 230-2).

A deviation is the actual position minus the target. The error of a direction is the mean of its
runs, and each run has every target. An axis which was measured in one direction only has the same
error in both.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

import gcxform as gx

LARGEST, LEAST = 1.0, 1e-5  # mm: beyond these the unit is in doubt
UNITS = {"um": 1e-3, "mm": 1.0}


class Reading(NamedTuple):
    """One deviation (mm) at a target (mm) after travel in a direction, +1 or -1, and its line."""

    target: float
    sense: int
    run: str
    deviation: float
    row: gx.TextRow


def table(axis: str, readings: Iterable[Reading]) -> gx.PitchTable:
    """Return the mean errors of an axis. Raises UsageError for what is missing or double."""
    found: dict[tuple[float, int], dict[str, float]] = {}
    for r in readings:
        own = found.setdefault((r.target, r.sense), {})
        if r.run in own:
            message = f"run {r.run} of {axis} has two deviations at {r.target:g} in one direction"
            raise r.row.refuse("GX483", message, 0)
        own[r.run] = r.deviation
    last = r.row
    targets = sorted({target for target, _ in found})
    if len(targets) < 2:
        raise last.refuse("GX411", f"{axis} has one target, needed are 2", 0)
    senses = sorted({sense for _, sense in found}, reverse=True)
    for sense in senses:
        runs = sorted({run for (_, way), own in found.items() if way == sense for run in own})
        for target in targets:
            if lost := [run for run in runs if run not in found.get((target, sense), ())]:
                message = f"{axis} has no deviation of run {lost[0]} at {target:g}, direction "
                raise last.refuse("GX483", message + ("+" if sense > 0 else "-"), 0)
    columns = {s: np.array([np.mean(list(found[t, s].values())) for t in targets]) for s in senses}
    largest = max(float(np.abs(column).max()) for column in columns.values())
    if not largest <= LARGEST or 0.0 < largest < LEAST:
        message = f"the largest deviation of {axis} is {largest:.3g} mm"
        raise last.refuse("GX485", message, 0, "say the unit of the deviations")
    forward = columns[senses[0]]
    return gx.PitchTable(np.array(targets), forward, columns[senses[-1]])
