"""Arcs whose radius changes on the way, as controls take them: how far one is from another.

Many arcs of real programs end some micrometres off their circle, so their radius changes evenly.
The oracle samples both curves, and knows nothing of the bounds.
"""

from __future__ import annotations

import random

import numpy as np
import pytest
from seeds_kit import some

import gcxform as gx
from gcxform.deviations.spirals import NEAR
from gcxform.modal.interpreter import Interpreter
from gcxform.modal.reader import WindowReader
from gcxform.modal.state import Reading
from gcxform.plugin.registry import default_registry
from gcxform.system.arrays import Floats
from gcxform.toolpath.circles import points_on_arcs
from gcxform.toolpath.path import Toolpath

SAMPLES = 1500
Point = tuple[float, float]


def drawn(seed: int) -> tuple[Point, Point, Point, Point]:
    """Return start, end and two centres, each off by as much as LinuxCNC lets it be."""
    choose = random.Random(seed)
    radius = choose.choice([1.0, 5.0, 25.0, 300.0])
    sweep = choose.choice([0.05, 0.3, 1.5, 3.0, 5.5])
    start, end = (radius, 0.0), (radius * np.cos(sweep), radius * np.sin(sweep))
    off = choose.choice([0.0005, 0.004, 0.009]) * (0.5 if radius == 1.0 else 1.0)
    first = (choose.uniform(-off, off), choose.uniform(-off, off))
    return start, end, first, (choose.uniform(-off, off), choose.uniform(-off, off))


def arc(start: Point, end: Point, centre: Point) -> Toolpath:
    """Return an arc as LinuxCNC reads it, behind the rapid to its start."""
    i, j = centre[0] - start[0], centre[1] - start[1]
    text = (
        f"G21 G90 G17 G94\nG0 X{start[0]:.9f} Y{start[1]:.9f} Z0\n"
        f"G3 X{end[0]:.9f} Y{end[1]:.9f} I{i:.9f} J{j:.9f} F100\n"
    ).encode()
    dialect = default_registry().dialect("linuxcnc")
    reader = WindowReader(dialect)
    window = reader.read(text)
    return Interpreter(dialect, Reading(), "XYZ", "-").interpret(window, reader.table).path


def sampled(path: Toolpath) -> Floats:
    part = np.linspace(0.0, 1.0, SAMPLES)
    return points_on_arcs(path, np.ones(SAMPLES, np.int64), part)[:, :2]


def farthest(one: Floats, other: Floats) -> float:
    """Return how far a point of one curve is from the other at most: never more than the truth."""
    apart = np.hypot(*(one[:, None] - other[None]).transpose(2, 0, 1))
    step = np.hypot(*np.diff(other, axis=0).T).max()
    return float(np.sqrt(np.maximum(apart.min(axis=1).max() ** 2 - (step / 2) ** 2, 0.0)))


@pytest.mark.parametrize("seed", some(60))
def test_a_spiral_beside_a_spiral(seed: int) -> None:
    start, end, first, second = drawn(seed)
    one, two = arc(start, end, first), arc(start, end, second)
    bound = float(gx.deviation(one, two, np.arange(2)).distance[1])
    p, q = sampled(one), sampled(two)
    truth = max(farthest(p, q), farthest(q, p))
    assert truth <= bound + 1e-9
    size = float(np.hypot(*np.subtract(first, second)))
    assert bound <= max(1.5 * truth, 2.0 * size) + NEAR


def test_a_spiral_that_bulges_is_seen() -> None:
    """On the half of a turn a centre that is 15 um aside takes the arc half as far away."""
    one, two = (arc((25.0, 0.0), (-25.0, 0.0), (0.0, y)) for y in (0.0, 0.015))
    bound = float(gx.deviation(one, two, np.arange(2)).distance[1])
    assert 0.0149 < bound < 0.0151


@pytest.mark.parametrize(
    ("radius", "sweep", "first", "second"),
    [
        (1.0, 1.5, (0.0105, 0.0084), (-0.0052, 0.0079)),
        (5.0, 5.5, (-0.0135, 0.0128), (-0.0107, 0.0021)),
        (5.0, 3.0, (-0.0081, 0.0156), (-0.0005, -0.0112)),
        (5.0, 5.5, (-0.0148, 0.0166), (-0.001, 0.0032)),
    ],
)
def test_no_spiral_counts_as_a_circle(
    radius: float, sweep: float, first: Point, second: Point
) -> None:
    """Bounds for circles were up to 3 % less than how far these are apart."""
    start, end = (radius, 0.0), (radius * np.cos(sweep), radius * np.sin(sweep))
    one, two = arc(start, end, first), arc(start, end, second)
    bound = float(gx.deviation(one, two, np.arange(2)).distance[1])
    p, q = sampled(one), sampled(two)
    assert max(farthest(p, q), farthest(q, p)) <= bound + 1e-9


@pytest.mark.parametrize("bulge", [0.05, 0.3])
def test_flat_arcs_about_far_centres(bulge: float) -> None:
    """Of two flat arcs on one chord the sagittas differ; their centres are a radius apart."""
    start, end = (1.0, -0.5), (1.0, 0.5)
    paths, sagittas = [], []
    for height in (0.01, 0.01 + bulge / 10):
        radius = (0.25 + height**2) / (2 * height)
        paths.append(arc(start, end, (1.0 + height - radius, 1e-4)))
        sagittas.append(height)
    bound = float(gx.deviation(*paths, np.arange(2)).distance[1])
    truth = max(farthest(*map(sampled, paths)), farthest(*map(sampled, paths[::-1])))
    assert truth <= bound + 1e-9
    assert bound < 1.2 * abs(sagittas[1] - sagittas[0]) + 3e-4
