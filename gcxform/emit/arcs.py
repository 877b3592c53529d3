"""Centres of arcs on the formatted grid, tested with the control's own rule before writing.

Both ends of an arc are already rounded; a centre that is rounded on its own leaves them on two
different circles, and the control stops in the cut. So the centre is first moved onto the bisector
of the rounded ends, then the grid points around it are tried and the best is taken.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gcxform.dialect import ArcRule
from gcxform.modal.arcs import TURN, accepts, swept

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

NEAR_FULL = np.radians(350.0)  # beyond it the bisector of the ends says little about the centre
SWEEP_SLIP = np.radians(1.0)  # a sweep that changes by more in formatting is another arc
STRICT = 0.002  # mm; tighter than any control asks, so that the arc passes elsewhere too


@dataclass(frozen=True, slots=True)
class ArcEnds:
    """Arcs of one plane, (n, 2) in mm: start and end as formatted, and the centre that is meant.

    `base` (n, 2) is what the centre words are counted from, `step` (n,) the last decimal in mm.
    """

    start: Floats
    end: Floats
    centre: Floats
    base: Floats
    step: Floats
    sweep: Floats
    sense: Floats


def centre_words(arcs: ArcEnds, rule: ArcRule, refit: bool) -> tuple[Floats, Flags]:
    """Return the centre words (n, 2) as whole numbers of the last decimal, and which arcs are good.

    An arc is good if the control accepts it and its sweep is still the one that was meant.
    """
    if not refit:
        words = _rounded((arcs.centre - arcs.base) / arcs.step[:, None])
        return words, _good(arcs, words, rule)
    aim = (_on_bisector(arcs) - arcs.base) / arcs.step[:, None]
    best = _rounded(aim)
    least = _mismatch(arcs, best)
    for shift in ((1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (1, -1), (-1, 1), (-1, -1)):
        if not (least > arcs.step / 2).any():
            break
        trial = _rounded(aim) + shift
        delta = _mismatch(arcs, trial)
        better = (delta < least) & (least > arcs.step / 2)
        best = np.where(better[:, None], trial, best)
        least = np.where(better, delta, least)
    return best, _good(arcs, best, rule)


def _rounded(value: Floats) -> Floats:
    return np.copysign(np.floor(np.abs(value) + (0.5 + 1e-6)), value)


def _on_bisector(arcs: ArcEnds) -> Floats:
    """Return the points equally far from start and end that are nearest to the centres."""
    chord = arcs.end - arcs.start
    length = np.hypot(*chord.T)
    partial = (np.mod(arcs.sweep, TURN) < NEAR_FULL) & (length > 4 * arcs.step)
    with np.errstate(invalid="ignore", divide="ignore"):
        along = chord / length[:, None]
    middle = (arcs.start + arcs.end) / 2
    beside = ((arcs.centre - middle) * along).sum(axis=1)[:, None] * along
    return np.where(partial[:, None], arcs.centre - beside, arcs.centre)


def _radii(arcs: ArcEnds, words: Floats) -> tuple[Floats, Floats, Floats]:
    centre = arcs.base + words * arcs.step[:, None]
    return np.hypot(*(arcs.start - centre).T), np.hypot(*(arcs.end - centre).T), centre


def _mismatch(arcs: ArcEnds, words: Floats) -> Floats:
    first, last, _ = _radii(arcs, words)
    return np.abs(first - last)


def _good(arcs: ArcEnds, words: Floats, rule: ArcRule) -> Flags:
    first, last, centre = _radii(arcs, words)
    sweep = swept(arcs.start - centre, arcs.end - centre, arcs.sense)
    slip = np.abs(sweep - (np.mod(arcs.sweep - 1e-12, TURN) + 1e-12))
    delta = np.abs(first - last)
    tight = delta <= np.maximum(STRICT, arcs.step)
    good: Flags = accepts(rule, first, last) & tight & (slip < SWEEP_SLIP)
    return good
