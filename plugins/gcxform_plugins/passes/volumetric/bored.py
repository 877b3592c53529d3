"""Holes that the control bores by itself, in calls that stay: how far off their grounds are.

What is corrected is the move that leads the tool over the hole. On the way down the error changes,
so that the ground is beside where it should be; and along the tool it is off by all of the error.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

import gcxform as gx
from gcxform.vocabulary import GROUND, Floats, Ints
from gcxform_plugins.passes.volumetric.forward.window import Window
from gcxform_plugins.passes.volumetric.ranges import beyond_tables

FIGURES = (
    "holes called as they stand: grounds off across the tool, mm",
    "holes called as they stand: grounds off along the tool, mm",
)
"""What the certificate calls it."""


@dataclass(frozen=True)
class Bored:
    """The calls that bore: their rows (n,), the axes along the tool (n,), and the depths (n,) mm.

    A depth is below the end of the call.
    """

    rows: Ints
    along: Ints
    depth: Floats

    @classmethod
    def of(cls, path: gx.Toolpath) -> Bored:
        """Return those of a path."""
        said = [(each.row, dict(each.values)) for each in path.events if each.values]
        said = [(row, values) for row, values in said if GROUND in values]
        rows = np.array([row for row, _ in said], np.int64)
        along = [next(k for k, axis in enumerate("XYZ") if axis in values) for _, values in said]
        depth = np.array([values[GROUND] for _, values in said], np.float64)
        depth *= np.where(path.blocks.inch[path.block[rows]], 25.4, 1.0)
        return cls(rows, np.array(along, np.int64), depth)

    def grounds(self, window: Window) -> Floats:
        """Return where the tool turns back (n, 3), in the table."""
        ground = window.end[self.rows].copy()
        ground[np.arange(len(ground)), self.along] -= self.depth
        return ground

    def off(self, window: Window) -> tuple[Floats, Floats]:
        """Return how far the grounds are off (n,) mm: across the tool, and along it."""
        each, rows = np.arange(len(self.rows)), self.rows
        ground, called = self.grounds(window), window.end[rows].copy()
        began = window.start[rows, self.along]
        called[each, self.along] = np.where(np.isnan(began), called[each, self.along], began)
        lean = window.command(ground, rows) - ground
        along = np.abs(lean[each, self.along])
        lean -= window.command(called, rows) - called
        lean[each, self.along] = 0.0
        return np.sqrt((lean**2).sum(axis=1)), along

    def figures(self, window: Window) -> dict[str, float]:
        """Return how far grounds are off at most, by what the certificate calls it."""
        return dict(
            zip(
                FIGURES,
                (float(np.nanmax(off, initial=0.0)) for off in self.off(window)),
                strict=True,
            )
        )


def check_bored(window: Window) -> None:
    """Refuse grounds outside the tables, and those that are farther off than `lean` allows."""
    bored, step = Bored.of(window.path), window.step
    if not len(bored.rows):
        return
    grounds = bored.grounds(window)
    beyond = np.flatnonzero(beyond_tables(step, grounds))
    if len(beyond):
        ground = " ".join(f"{a}{x:.3f}" for a, x in zip("XYZ", grounds[beyond[0]], strict=True))
        message = f"the ground of this hole, {ground} in the error table, is outside of it"
        hint = 'outside = "clamp" or "extrapolate" goes beyond, or measure a larger volume'
        raise window.path.refuse("GX310", bored.rows[beyond[:1]], message, hint)
    across, _ = bored.off(window)
    wrong = np.flatnonzero(across > step.lean)[:1]  # unknown places are refused by what writes
    if len(wrong):
        off, depth = float(across[wrong[0]]) * 1000, float(bored.depth[wrong[0]])
        message = f"{depth:.6g} mm below where it ends, the ground of this hole is {off:.2f} um "
        message += f"beside its place, and {step.lean * 1000:g} um are allowed"
        hint = f"lean = {math.ceil(off) / 1000:g} allows it, or let the CAM write plain moves"
        raise window.path.refuse("GX318", bored.rows[wrong], message, hint)
