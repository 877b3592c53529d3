"""The plain diagonal test, of totals alone: squareness, its spread, and what it is blind to."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from diagonal_kit import ALIGNED, LOW, SLOPES, TRAVEL, readings, values
from step_diagonal_kit import simulate_step_diagonal

from gcxform.calibrate.diagonal.plain_diagonal import BLIND, spread, squareness
from gcxform.calibrate.diagonal.readings import plain_diagonals
from gcxform.calibrate.diagonal.step_diagonal import identify


def test_s1_squareness_from_the_totals():
    measured = readings()
    found = squareness(plain_diagonals(measured.legs), 0.001)
    assert found.slopes * 1e6 == pytest.approx(SLOPES, abs=5e-4)
    stepwise = identify(measured, assumed=ALIGNED)
    assert found.slopes == pytest.approx(stepwise.slopes[0][3:], abs=1e-15)
    assert found.mean_scale == pytest.approx(stepwise.mean_scale[0], abs=1e-15)


def test_a_plain_test_is_blind_to_some_scales():
    """On a cube of 1 m scales of +50, -50 and 0 ppm change the diagonals by 0.001 um."""
    scale = np.array([50e-6, -50e-6, 0.0])
    cube = SimpleNamespace(error=lambda position: position * scale)
    legs = simulate_step_diagonal(cube, LOW, (1000.0,) * 3, 1)
    exact = np.linalg.norm(1000.0 * (1 + scale)) - np.linalg.norm([1000.0] * 3)
    assert abs(exact) < 2e-6
    assert max(abs(leg.deviation[-1]) for leg in legs) < 1e-12
    found = squareness(plain_diagonals(legs), 0.001)
    assert abs(found.mean_scale) < 1e-15
    assert "X^2 sX + Y^2 sY + Z^2 sZ = 0" in BLIND


def test_the_spread_of_a_plain_test():
    """Each of four equal lengths has a quarter of the weight: sigma R / (2 X Y)."""
    found = squareness(plain_diagonals(readings().legs), 0.001)
    size = np.linalg.norm(TRAVEL)
    x, y, z = TRAVEL
    expected = 0.0005 * np.array([1 / size, size / (x * y), size / (x * z), size / (y * z)])
    assert spread(found) == pytest.approx(expected, rel=1e-12)


def test_the_model_of_a_plain_test_has_the_squareness_alone():
    model = squareness(plain_diagonals(readings().legs), 0.001).model()
    legs = simulate_step_diagonal(model, LOW, TRAVEL, 1)
    assert squareness(plain_diagonals(legs), 0.001).slopes * 1e6 == pytest.approx(SLOPES, abs=5e-4)
    assert np.diag(values(model)[:, :, -1]) == pytest.approx([0, 0, 0])
