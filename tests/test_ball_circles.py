"""Circles without angles: C1 to C3 of the reference, and its tables."""

from __future__ import annotations

import math

import numpy as np
import pytest
from ball_kit import CENTRE, NOISE, UPRIGHT, around, measured, off, rms

from gcxform.calibrate.rotary.axis import condition
from gcxform.calibrate.rotary.circle import fit_circles, spread
from gcxform.simulate.balls import simulate_balls


@pytest.mark.parametrize(("circles", "band"), [(500, 0.08), (20_000, 0.015)])
@pytest.mark.parametrize("radius", [500.0, 50.0])
@pytest.mark.parametrize("count", [3, 4, 5, 10])
def test_c1_circles_are_as_good_as_the_closed_forms_say(count, radius, circles, band):
    """C1: rms of the centre sigma sqrt(5/n), of the direction 2 sigma / (r sqrt n)."""
    found = fit_circles(measured(count, radius=radius, circles=circles))
    assert found.converged.all()
    assert rms(found.centre - CENTRE) == pytest.approx(NOISE * math.sqrt(5 / count), rel=band)
    tilt = 2 * NOISE / (radius * math.sqrt(count))
    assert rms(found.direction[:, :2]) == pytest.approx(tilt, rel=band)


SEED_TABLE = {  # points: mean, rms of the centre (um); mean, rms of the direction at r = 500 (urad)
    3: (11.89, 12.91, 20.4, 23.3),
    4: (10.22, 11.13, 17.9, 19.9),
    5: (8.96, 9.79, 16.1, 18.0),
    10: (6.64, 7.18, 11.2, 12.7),
}


@pytest.mark.parametrize("count", SEED_TABLE)
def test_the_table_of_the_published_simulation(count):
    """Reference 6.1: 500 circles, seed 0, in each of its digits."""
    found = fit_circles(measured(count, radius=500.0, circles=500))
    away = np.linalg.norm(found.centre - CENTRE, axis=1)
    tilt = np.linalg.norm(found.direction[:, :2], axis=1)
    shown = (1e3 * away.mean(), 1e3 * rms(found.centre - CENTRE))
    assert np.round(shown, 2).tolist() == [*SEED_TABLE[count][:2]]
    assert [1e6 * tilt.mean(), 1e6 * rms(found.direction[:, :2])] == pytest.approx(
        SEED_TABLE[count][2:], abs=0.06
    )


@pytest.mark.parametrize("count", SEED_TABLE)
def test_c2_the_radius_changes_the_direction_and_not_the_centre(count):
    """C2: ratios of errors at r = 50 and r = 500, same seed: 10.000 +- 0.01 and 1.000 +- 0.001."""
    near, far = (fit_circles(measured(count, radius=r, circles=500)) for r in (50.0, 500.0))
    ratio = rms(near.direction[:, :2]) / rms(far.direction[:, :2])
    assert ratio == pytest.approx(10.0, abs=0.01)
    assert rms(near.centre - CENTRE) / rms(far.centre - CENTRE) == pytest.approx(1.0, abs=0.001)


ARCS = {  # arc: sd of the centre along and across (um), radius (um), tilts (urad), condition
    360: (4.26, 4.26, 3.02, 16.3, 16.3, 1.4),
    270: (4.96, 3.93, 3.18, 19.0, 15.1, 1.7),
    180: (8.52, 4.08, 5.75, 32.7, 15.6, 3.9),
    150: (11.5, 4.47, 8.50, 44.1, 17.1, 5.7),
    120: (17.1, 5.19, 13.9, 65.4, 19.9, 9.3),
    90: (29.1, 6.53, 25.9, 112, 25.0, 17),
    60: (63.7, 9.41, 60.3, 244, 36.0, 40),
}


@pytest.mark.parametrize("degrees", ARCS)
def test_c3_the_covariance_of_a_circle_is_that_of_many(degrees):
    """C3: predicted against 2000 samples within 6 %, and the table of the reference, 6.2."""
    points = measured(11, degrees)
    exact = simulate_balls(UPRIGHT, off(261.0), around(11, degrees))
    both, of_radius = spread(exact, fit_circles(exact), NOISE)
    found = fit_circles(points)
    middle = math.radians(degrees / 2 if degrees < 360 else 0.0)
    along = np.array((math.cos(middle), math.sin(middle), 0.0))
    across = np.array((-along[1], along[0], 0.0))
    predicted, seen = [], []
    for part, values, scale in ((0, found.centre - CENTRE, 1e3), (3, found.direction, 1e6)):
        for line in (along, across):
            variance = line @ both[part : part + 3, part : part + 3] @ line
            predicted.append(scale * math.sqrt(variance))
            seen.append(scale * float((values @ line).std()))
    predicted.insert(2, 1e3 * math.sqrt(of_radius))
    seen.insert(2, 1e3 * float(found.radius.std()))
    predicted.append(1e3 * math.sqrt(both[2, 2]))
    seen.append(1e3 * float(found.centre[:, 2].std()))
    assert seen == pytest.approx(predicted, rel=0.06)
    assert predicted[:5] == pytest.approx(ARCS[degrees][:5], rel=0.006)
    assert condition(around(11, degrees)) == pytest.approx(ARCS[degrees][5], rel=0.04)


def test_a_straight_line_is_no_circle():
    steps = np.linspace(0.0, 1.0, 5)[:, None]
    found = fit_circles(np.array((1.0, 2.0, 3.0)) + steps * np.array((30.0, -20.0, 10.0)))
    assert not found.converged
