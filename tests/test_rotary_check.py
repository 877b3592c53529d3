"""What is told of a rotary axis beside where it is: the check, what to measure next, harmonics."""

from __future__ import annotations

import numpy as np
import pytest
from ball_kit import CENTRE, UPRIGHT, around, clean, off, skew

from gcxform.calibrate.rotary.axis import Centres, Placed, arc, fitted, locate, without_each
from gcxform.calibrate.rotary.check import (
    advice,
    checked_angles,
    dial,
    dial_spread,
    harmonics,
    next_angle,
    rotary_of,
    standing,
)
from gcxform.machine.chain import Rotary
from gcxform.simulate.balls import simulate_balls


def test_leaving_one_out_is_a_fit_of_the_others():
    centres = clean(skew(), around(6), noise=0.002)
    found = locate(centres, 0.002)
    point, direction = without_each(found)
    rest = np.delete(np.arange(6), 2)
    other = fitted(Centres(centres.degrees[rest], centres.points[rest]), np.ones(5))
    moved = other.centre - found.point
    along = (moved @ found.direction) * found.direction
    assert point[2] == pytest.approx(moved - along, abs=1e-8)
    assert np.linalg.norm(point, axis=1).max() > 5e-5
    assert np.linalg.norm(direction, axis=1).max() > 1e-7


def test_the_check_reads_twice_the_error_over_half_a_turn():
    """Reference 6.4: |(I - R) dT| = 2 sin(q/2) |dT|: 10 um over 180 degrees are 5 um of T."""
    x, y, z = UPRIGHT.point
    wrong = Rotary("C", UPRIGHT.direction, (x + 0.003, y - 0.004, z + 7.0), 1)
    angles = np.array((0.0, 60.0, 180.0))
    shown = np.linalg.norm(dial(UPRIGHT, wrong, off(80.0, 9.0, 3.0), angles), axis=1)
    assert shown == pytest.approx(0.005 * 2 * np.sin(np.radians(angles / 2)), abs=1e-12)


@pytest.mark.parametrize("start", [0.0, 40.0])
def test_the_predicted_reading_is_what_many_checks_show(start):
    angles = around(6, 200.0) + start
    true = skew(-1)
    generator = np.random.default_rng(2)
    every = simulate_balls(
        true, (40.0, 60.0, -80.0), angles, noise=0.002, circles=300, generator=generator
    )
    shown = []
    for points in every:
        found = locate(Centres(angles, points), 0.002, robust=False)
        ball = true.turn(np.array([[40.0, 60.0, -80.0]]), angles[:1])[0]
        shown.append(dial(true, rotary_of(found, "A"), ball, checked_angles(found)))
    seen = np.sqrt((np.array(shown) ** 2).sum(axis=2).mean(axis=0))
    predicted = dial_spread(found, checked_angles(found))
    assert seen[0] == pytest.approx(0.0, abs=1e-12)
    assert predicted[0] == pytest.approx(0.0, abs=1e-9)
    assert seen[1:] == pytest.approx(predicted[1:], rel=0.14)
    assert standing(found) == pytest.approx(ball - found.point, abs=0.05)


def test_what_to_measure_next():
    found: Placed = locate(clean(skew(), around(7, 120.0)), 0.002)
    said = list(advice(found))
    assert said[0].startswith("the arc is 120 of 360 degrees: a longer one helps most")
    assert 210.0 <= next_angle(found) <= 270.0
    assert next_angle(found, (-20.0, 150.0)) == 150.0
    assert not any("the arc is" in line for line in advice(found, (0.0, 120.0)))
    few = locate(clean(skew(), around(4)), 0.002)
    assert any("with 5 or more a bad one shows" in line for line in advice(few))


def test_the_next_position_is_the_best_one():
    """No other position leaves a smaller variance, measured by doing it."""
    angles = around(7, 120.0)

    def left(extra: float) -> float:
        found = locate(clean(skew(), np.append(angles, extra)), 0.002)
        cov = found.covariance
        across = np.eye(3) - np.outer(found.direction, found.direction)
        radius = found.figure.radius
        return float(np.trace(cov[:3, :3]) + radius**2 * np.trace(across @ cov[3:, 3:]))

    best = next_angle(locate(clean(skew(), angles), 0.002))
    every = [left(extra + 0.001) for extra in np.arange(0.0, 360.0, 15.0)]
    assert left(best + 0.001) <= min(every) * (1 + 1e-6)


def test_squareness_shows_as_the_second_harmonic():
    """Reference 6.4: the second harmonic in the plane tells of squareness and scales."""
    points = simulate_balls(UPRIGHT, off(200.0), around(12))
    points[:, 0] += 4e-5 * (points[:, 1] - CENTRE[1])
    found = locate(Centres(around(12), points), 0.002)
    sizes = harmonics(found)
    assert sizes is not None
    assert sizes["radial"][1] == pytest.approx(0.5 * 4e-5 * 200.0, rel=0.01)
    assert sizes["axial"] == pytest.approx([0.0, 0.0], abs=1e-9)
    assert harmonics(locate(clean(skew(), around(5)), 0.002)) is None


def test_arcs_are_turns_less_the_largest_gap():
    assert arc(around(4)) == 360.0
    assert arc(around(11, 150.0) - 60.0) == pytest.approx(150.0)
    assert arc(np.array((350.0, 10.0, 40.0))) == pytest.approx(50.0)
    assert arc(np.array((-90.0, 0.0, 90.0))) == pytest.approx(180.0)
    assert arc(np.array((25.0,))) == 0.0
