"""Centres of arcs on the formatted grid, tested with the control's own rule before writing.

Both ends of an arc are already rounded; a centre that is rounded on its own leaves them on two
different circles, and the control stops in the cut. So the grid points around the centre are
tried: of those that the control takes, the one that moves the arc least is written.
"""

from __future__ import annotations

from dataclasses import fields

import numpy as np

from gcxform.dialect.move_rules import ArcRule
from gcxform.modal.moves.arcs import accepts
from gcxform.system.arrays import Flags, Floats, Ints
from gcxform.toolpath.angles import TURN, swept
from gcxform.values import dataclass

SWEEP_SLIP = np.radians(1.0)  # a sweep that changes by more in formatting is another arc
STRICT = 0.002  # mm; tighter than any control asks, so that the arc passes elsewhere too
REACH = 2  # grid points tried on either side of the centre
NEAREST = 0.49  # of a step; all other points are farther from a centre than that


@dataclass(frozen=True, slots=True)
class ArcEnds:
    """Arcs of one plane, (n, 2) in mm: start and end as formatted, and the centre that is meant.

    `base` (n, 2) is what the centre words are counted from, `step` (n,) the last decimal in mm,
    `spiral` (n,) by how much the radii at start and end differ before rounding; `inch` (n,): the
    block is written in inches.
    """

    start: Floats
    end: Floats
    centre: Floats
    base: Floats
    step: Floats
    sweep: Floats
    sense: Floats
    spiral: Floats
    inch: Flags

    def take(self, k: Ints) -> ArcEnds:
        """Return some of the arcs."""
        return ArcEnds(*(getattr(self, each.name)[k] for each in fields(self)))


def centre_words(arcs: ArcEnds, rule: ArcRule, refit: bool) -> tuple[Floats, Flags]:
    """Return the centre words (n, 2) as whole numbers of the last decimal, and which arcs are good.

    An arc is good if the control accepts it and its sweep is still the one that was meant.
    """
    near = _rounded((arcs.centre - arcs.base) / arcs.step[:, None])
    if not refit:
        return near, _good(arcs, near, rule)
    least = _cost(arcs, near, rule)
    open_ones = np.flatnonzero(~(least < NEAREST * arcs.step))
    if len(open_ones):
        near[open_ones], least[open_ones] = _refitted(arcs.take(open_ones), near[open_ones], rule)
    return near, np.isfinite(least) & _good(arcs, near, rule)


def _refitted(arcs: ArcEnds, near: Floats, rule: ArcRule) -> tuple[Floats, Floats]:
    """Return the best of the grid points around centres (n, 2), and what they cost (n,), mm."""
    best, least = near, np.full(len(near), np.inf)
    for x in range(-REACH, REACH + 1):
        for y in range(-REACH, REACH + 1):
            trial = near + np.array([x, y])
            cost = _cost(arcs, trial, rule)
            best = np.where((cost < least)[:, None], trial, best)
            least = np.minimum(cost, least)
    return best, least


def _rounded(value: Floats) -> Floats:
    return np.copysign(np.floor(np.abs(value) + (0.5 + 1e-6)), value)


def _radii(arcs: ArcEnds, words: Floats) -> tuple[Floats, Floats, Floats]:
    centre = arcs.base + words * arcs.step[:, None]
    return np.hypot(*(arcs.start - centre).T), np.hypot(*(arcs.end - centre).T), centre


def _limit(arcs: ArcEnds, rule: ArcRule) -> Floats:
    """Return by how much (mm) the radii may differ: an arc that is a spiral may stay one."""
    round_one = np.minimum(np.maximum(STRICT, arcs.step), rule.absolute / 2)
    return np.asarray(np.maximum(round_one, arcs.spiral + 1.5 * arcs.step))


def _cost(arcs: ArcEnds, words: Floats, rule: ArcRule) -> Floats:
    """Return how much (mm) an arc is moved by a centre; inf if the radii differ too much."""
    first, last, centre = _radii(arcs, words)
    delta = np.abs(first - last)
    moved = np.hypot(*(centre - arcs.centre).T)
    return np.where(delta <= _limit(arcs, rule), moved + delta / 2, np.inf)


def _good(arcs: ArcEnds, words: Floats, rule: ArcRule) -> Flags:
    first, last, centre = _radii(arcs, words)
    sweep = swept(arcs.start - centre, arcs.end - centre, arcs.sense)
    slip = np.abs(sweep - (np.mod(arcs.sweep - 1e-12, TURN) + 1e-12))
    good: Flags = accepts(rule, first, last, arcs.inch) & (slip < SWEEP_SLIP)
    return good
