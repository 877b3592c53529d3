"""Which grid point becomes the centre of an arc: of those around it the one that moves it least."""

from __future__ import annotations

from itertools import product
from math import hypot, inf

import numpy as np
import pytest

from gcxform.dialect.move_rules import ArcRule
from gcxform.emit.arcs import REACH, ArcEnds, centre_words

STEP = 0.01  # mm
Point = tuple[float, float]


def drawn(seed: int, count: int) -> ArcEnds:
    """Return arcs whose ends are on the grid; every second centre is near it as well."""
    draw = np.random.default_rng(seed)
    centre, radius = draw.uniform(-9, 9, (count, 2)), draw.uniform(0.5, 20, (count, 1))
    begin, sweep = draw.uniform(0, 6, count), draw.uniform(0.3, 5, count)
    ends = (np.column_stack([np.cos(a), np.sin(a)]) for a in (begin, begin + sweep))
    start, end = (np.round((centre + radius * out) / STEP) * STEP for out in ends)
    centre[::2] = np.round(centre[::2] / STEP) * STEP + draw.normal(0, STEP / 9, (count, 2))[::2]
    zero, none = np.zeros(count), np.zeros(count, np.bool_)
    step, sense = np.full(count, STEP), np.ones(count)
    return ArcEnds(start, end, centre, np.zeros((count, 2)), step, sweep, sense, zero, none)


def cost(start: Point, end: Point, meant: Point, word: Point) -> float:
    """Return how far (mm) a centre moves an arc; inf if its ends are too unlike."""
    x, y = word[0] * STEP, word[1] * STEP
    unlike = abs(hypot(start[0] - x, start[1] - y) - hypot(end[0] - x, end[1] - y))
    if unlike > 1.5 * STEP:
        return inf
    return hypot(meant[0] - x, meant[1] - y) + unlike / 2


@pytest.mark.parametrize("seed", range(3))
def test_no_other_centre_moves_an_arc_less(seed: int) -> None:
    arcs = drawn(seed, 200)
    words, good = centre_words(arcs, ArcRule(), True)
    assert good.any()
    around = [*product(range(-REACH, REACH + 1), repeat=2)]
    for start, end, meant, word in zip(arcs.start, arcs.end, arcs.centre, words, strict=True):
        near = np.floor(meant / STEP + 0.5)
        least = min(cost(start, end, meant, near + out) for out in around)
        assert cost(start, end, meant, word) <= least + 1e-9 or least == inf
