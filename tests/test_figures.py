"""Statistics of ISO 230-2 and figures of ISO 230-4, against hand-made examples and other means."""

from __future__ import annotations

import math
import statistics

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcxform.calibrate.circles.deviations import circular_deviation, least_squares_circle
from gcxform.simulate.circles import Circles
from gcxform.simulate.figures import Positioning

ANGLES = np.linspace(0.0, 2.0 * np.pi, 3600, endpoint=False)
NUMBERS = st.floats(-0.1, 0.1).map(lambda x: round(x, 6))


def test_figures_of_three_targets_worked_out_by_hand():
    up = [[1.0, 3.0], [4.0, 4.0], [0.0, 2.0]]  # means 2, 4, 1; s sqrt 2, 0, sqrt 2
    down = [[0.0, 0.0], [1.0, 3.0], [-1.0, -3.0]]  # means 0, 2, -2; s 0, sqrt 2, sqrt 2
    found = Positioning(np.array([0.0, 10.0, 20.0]), np.array(up), np.array(down)).figures
    root = math.sqrt(2.0)
    wanted = {
        "B": 3.0,  # 2, 2, 3
        "mean B": 7.0 / 3.0,
        "M": 3.5,  # 1, 3, -0.5
        "E": 6.0,
        "E up": 3.0,
        "E down": 4.0,
        "R up": 4.0 * root,
        "R down": 4.0 * root,
        "R": 4.0 * root + 3.0,  # of the third: 2 s + 2 s + |B|
        "A up": (2.0 + 2.0 * root if 2.0 + 2.0 * root > 4.0 else 4.0) - (1.0 - 2.0 * root),
        "A down": (2.0 + 2.0 * root) - (-2.0 - 2.0 * root),
        "A": (2.0 + 2.0 * root) - (-2.0 - 2.0 * root),
    }
    assert found == pytest.approx(wanted)


def plainly(up: list[list[float]], down: list[list[float]]) -> dict[str, float]:
    """Return the figures by loops and the statistics of the standard library."""
    means = [[statistics.mean(x) for x in way] for way in (up, down)]
    s = [[statistics.stdev(x) for x in way] for way in (up, down)]
    count = range(len(up))
    b = [means[0][i] - means[1][i] for i in count]
    r = [max(2 * s[0][i] + 2 * s[1][i] + abs(b[i]), 4 * s[0][i], 4 * s[1][i]) for i in count]
    middle = [(means[0][i] + means[1][i]) / 2 for i in count]
    high = [[means[w][i] + 2 * s[w][i] for i in count] for w in (0, 1)]
    low = [[means[w][i] - 2 * s[w][i] for i in count] for w in (0, 1)]
    return {
        "A": max(*high[0], *high[1]) - min(*low[0], *low[1]),
        "A up": max(high[0]) - min(low[0]),
        "A down": max(high[1]) - min(low[1]),
        "R": max(r),
        "R up": 4 * max(s[0]),
        "R down": 4 * max(s[1]),
        "E": max(*means[0], *means[1]) - min(*means[0], *means[1]),
        "E up": max(means[0]) - min(means[0]),
        "E down": max(means[1]) - min(means[1]),
        "M": max(middle) - min(middle),
        "B": max(abs(x) for x in b),
        "mean B": statistics.mean(b),
    }


@given(st.data())
def test_figures_are_those_of_plain_loops(data):
    targets, runs = data.draw(st.integers(2, 6)), data.draw(st.integers(2, 5))
    table = st.lists(
        st.lists(NUMBERS, min_size=runs, max_size=runs), min_size=targets, max_size=targets
    )
    up, down = data.draw(table), data.draw(table)
    found = Positioning(np.arange(targets, dtype=float), np.array(up), np.array(down)).figures
    assert found == pytest.approx(plainly(up, down), abs=1e-12)


def test_one_run_has_no_repeatability():
    one = Positioning(np.array([0.0, 1.0]), np.array([[0.0], [2.0]]), np.array([[1.0], [1.0]]))
    assert all(math.isnan(one.figures[s]) for s in ("A", "A up", "R", "R down"))
    assert (one.figures["B"], one.figures["E"], one.figures["M"]) == (1.0, 2.0, 1.0)
    assert one.end == 1.0


# --- circles ---


def circle(radius, centre=(0.0, 0.0)):
    radius = np.broadcast_to(radius, ANGLES.shape)
    return np.column_stack([radius * np.cos(ANGLES), radius * np.sin(ANGLES)]) + np.array(centre)


def test_a_circle_about_another_centre_has_no_circular_deviation():
    found = Circles(100.0, circle(100.002, (0.01, -0.02)), circle(100.002, (0.01, -0.02)))
    figures = found.figures
    assert figures["G(CW)"] == pytest.approx(0.0, abs=1e-12)
    assert figures["G(b)"] == pytest.approx(0.0, abs=1e-12)
    assert figures["D"] == pytest.approx(0.002, abs=1e-12)
    assert found.centre == pytest.approx((0.01, -0.02), abs=1e-12)
    away = math.hypot(0.01, 0.02)
    assert figures["Fmax(CW)"] == pytest.approx(0.002 + away, abs=1e-6)
    assert figures["Fmin(CCW)"] == pytest.approx(0.002 - away, abs=1e-6)


def test_figures_tell_senses_apart():
    """Harmonics that a least-squares centre cannot take up: G is from crest to trough."""
    cw = circle(50.0 + 0.003 * np.cos(2 * ANGLES))
    ccw = circle(50.001 + 0.001 * np.cos(3 * ANGLES))
    found = Circles(50.0, cw, ccw).figures
    wanted = {
        "G(CW)": 0.006,
        "G(CCW)": 0.002,
        "G(b)": 0.006,
        "Fmax(CW)": 0.003,
        "Fmin(CW)": -0.003,
        "Fmax(CCW)": 0.002,
        "Fmin(CCW)": 0.0,
        "D": 0.0005,
        "H": np.abs(0.003 * np.cos(2 * ANGLES) - 0.001 - 0.001 * np.cos(3 * ANGLES)).max(),
    }
    assert found == pytest.approx(wanted, abs=1e-7)


def test_bidirectional_deviation_covers_two_circles_that_are_apart():
    """Two circles a distance apart have no G of their own, and a G(b) of that distance."""
    apart = 0.008
    cw, ccw = circle(100.0, (apart / 2, 0.0)), circle(100.0, (-apart / 2, 0.0))
    found = Circles(100.0, cw, ccw).figures
    assert found["G(CW)"] < 1e-12
    assert found["G(b)"] == pytest.approx(apart, rel=1e-4)


@given(st.integers(0, 2**32))
def test_no_other_circle_is_nearer(seed):
    random = np.random.default_rng(seed)
    points = circle(10.0 + random.normal(0.0, 0.3, len(ANGLES)), random.normal(0.0, 5.0, 2))
    points = points[np.sort(random.choice(len(points), 40, replace=False))]
    centre, radius = least_squares_circle(points)

    def square(x, y, r):
        return float(((np.hypot(points[:, 0] - x, points[:, 1] - y) - r) ** 2).sum())

    least = square(*centre, radius)
    for step in random.normal(0.0, 1e-3, (20, 3)):
        assert square(*centre + step[:2], radius + step[2]) >= least
    assert circular_deviation(points) >= 0.0


def test_points_that_are_no_circle():
    with pytest.raises(ValueError, match="around"):
        least_squares_circle(np.zeros((5, 2)))
