"""Deviations hold for the noise that there is, and whoever stated another one is told so.

Coverage: how often the true value is within 1.96 standard deviations, over many measurements with
noise of seeds, for the noise that is stated and for one that is 2.5 times as large.
"""

from __future__ import annotations

import math
from functools import partial

import numpy as np
import pytest
from ball_kit import CENTRE, around, measured
from ball_kit import NOISE as BALL
from ballbar_kit import identified
from ballbar_kit import measured as traces
from scipy.optimize import least_squares
from scipy.special import chdtri

from gcxform.calibrate.rotary.axis import Centres, locate
from gcxform.calibrate.solution import CAUCHY, TIGHT, Scatter, belonging, cauchy, plausible
from gcxform.diagnostics import InputError

SEEDS = 80
FACTORS = [1.0, 2.5]


def rotary(stated: float, seed: int):
    """Return how far the axis of eleven centres is off, in its deviations, and what was found."""
    (points,) = measured(11, circles=1, seed=seed)
    found = locate(Centres(around(11), points), BALL / stated)
    away = np.concatenate([found.point - CENTRE, found.direction - (0.0, 0.0, 1.0)])[:5]
    return away / np.sqrt(np.diag(found.covariance)[:5]), found.scatter


def ballbar(stated: float, seed: int, exact: np.ndarray):
    """Return how far the axes of four circular tests are off, in their deviations."""
    noisy = traces(samples=37, noise=0.001, rng=np.random.default_rng(seed))
    found = identified(noisy, noise=0.001 / stated)
    return (found.unknowns - exact) / np.sqrt(np.diag(found.covariance)), found.scatter


def exact_ballbar() -> np.ndarray:
    """Return the unknowns that readings without noise give."""
    return identified(traces(samples=37)).unknowns


def accepted(once, times: float, seed: int):
    """Return what a measurement gives, None where it contradicts the stated noise (GX475)."""
    try:
        return once(times, seed)
    except InputError as error:
        if error.diagnostics[0].code != "GX475":
            raise
        return None


@pytest.mark.parametrize("kind", ["rotary", "ballbar"])
@pytest.mark.parametrize("times", FACTORS)
def test_intervals_hold_the_truth(kind, times) -> None:
    """They hit 48 to 65 % of 95 with noise 2.5 times as stated; here at least 91, at most 99.5."""
    once = rotary if kind == "rotary" else partial(ballbar, exact=exact_ballbar())
    every = [found for seed in range(SEEDS) if (found := accepted(once, times, seed))]
    assert len(every) >= (SEEDS if times == 1.0 else 0.75 * SEEDS)
    hit = np.mean([np.abs(away) < 1.96 for away, _ in every])
    assert 0.91 <= hit <= 0.995
    warned = np.mean([not scatter.plausible for _, scatter in every])
    assert warned <= 0.02 if times == 1.0 else warned >= 0.97


def test_the_figures_are_those_of_chi_square() -> None:
    scatter = Scatter(0.002, 80.0, 20)
    assert scatter.ratio == scatter.factor == 2.0
    assert scatter.observed == scatter.effective == 0.004
    assert not scatter.plausible
    assert "2 times those of the stated noise" in scatter.warnings[0]
    assert scatter.report()["degrees-of-freedom"] == 20


def test_less_scatter_than_stated_makes_nothing_better() -> None:
    scatter = Scatter(0.002, 5.0, 20)
    assert scatter.factor == 1.0
    assert scatter.effective == 0.002
    assert scatter.warnings == []


def test_without_redundancy_the_stated_noise_holds() -> None:
    scatter = Scatter(0.002, 0.0, 0)
    assert math.isnan(scatter.observed)
    assert scatter.effective == 0.002
    assert scatter.plausible
    assert scatter.report()["observed"] is None


@pytest.mark.parametrize("degrees", [1, 2, 5, 17, 60, 300])
def test_what_is_plausible_is_the_table_of_chi_square(degrees) -> None:
    assert plausible(degrees) == pytest.approx(chdtri(degrees, 0.001), rel=1e-9)


def test_outliers_are_told_from_readings_that_are_all_worse() -> None:
    normal = np.abs(np.random.default_rng(1).standard_normal((40, 3)))
    assert belonging(normal, 4.0).all()
    assert belonging(2.8 * normal, 4.0).mean() > 0.9
    lying = normal.copy()
    lying[3] = 30.0
    assert np.flatnonzero(~belonging(lying, 4.0)).tolist() == [3]
    assert np.flatnonzero(~belonging(2.8 * lying, 4.0)).tolist() == [3]


def test_the_robust_fit_is_that_of_reweighting() -> None:
    """Places measured in three coordinates, some of them far off."""
    points = np.random.default_rng(0).normal(size=(20, 3))
    points[:4] += (9.0, 12.0, -5.0)
    found = least_squares(lambda x: (x - points).ravel(), np.zeros(3), loss=cauchy, **TIGHT).x
    middle = points.mean(axis=0)
    for _ in range(200):
        weights = 1.0 / (1.0 + ((points - middle) ** 2).sum(axis=1) / CAUCHY**2)
        middle = weights @ points / weights.sum()
    assert found == pytest.approx(middle, abs=1e-6)
    assert np.linalg.norm(found - points[4:].mean(axis=0)) < 0.3
