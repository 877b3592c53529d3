"""Rotary axes from ball centres: C3 to C5, C7 and C8 of the reference, refusals."""

from __future__ import annotations

import math

import numpy as np
import pytest
from ball_kit import CENTRE, NOISE, around, clean, measured, rms, skew

from gcxform.calibrate.rotary.axis import Centres, fitted, locate, residuals, slopes, without_each
from gcxform.calibrate.rotary.check import warnings
from gcxform.calibrate.rotary.circle import fit_circles
from gcxform.diagnostics import InputError
from gcxform.machine.chain import Rotary
from gcxform.system.arrays import Floats


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("degrees", [around(8), around(9, 140.0) - 30.0, around(3), around(4, 45)])
def test_an_axis_is_found_exactly_without_noise(degrees, sign):
    axis = skew(sign)
    found = locate(clean(axis, degrees), 0.002)
    assert found.sign == sign
    assert np.abs(found.direction - axis.direction).max() < 1e-12
    assert np.linalg.norm(np.cross(found.point - axis.point, axis.direction)) < 1e-9
    assert found.kept.all()


def test_c8_an_axis_turned_around_is_the_same_axis():
    """C8: V and -V give the same; and the sense comes from the angles."""
    axis = skew(1)
    x, y, z = axis.direction
    other = Rotary("A", (-x, -y, -z), axis.point, -1)
    one, same = (locate(clean(a, around(8)), 0.002) for a in (axis, other))
    assert (one.sign, same.sign) == (1, 1)
    assert same.direction == pytest.approx(one.direction, abs=1e-14)
    assert same.point == pytest.approx(one.point, abs=1e-11)


@pytest.mark.parametrize(("degrees", "count", "um"), [(360, 8, 5.2), (150, 11, 6.0), (30, 5, 35.0)])
def test_the_angles_make_the_centre_better(degrees, count, um):
    """Reference 6.3: rms of the centre in its plane 7.3 -> 5.2, 12.5 -> 6.0, 326 -> 35 um."""
    every = [
        fitted(Centres(around(count, degrees), points), np.ones(count)).centre - CENTRE
        for points in measured(count, degrees, circles=300)
    ]
    # within four standard deviations of such an rms, and of its two digits
    assert 1e3 * rms(np.array(every)[:, :2]) == pytest.approx(um, rel=0.17)


@pytest.mark.parametrize("size", [1e-5, 0.01, 0.7])
def test_the_slopes_of_the_fit_are_those_of_its_residuals(size):
    """Far from the start as well, where turns do not add up."""
    centres = clean(skew(), around(7, 200))
    figure, step = locate(centres, NOISE).figure, size * np.random.default_rng(0).normal(size=7)
    apart = [
        residuals(centres, figure.moved(step + little))
        - residuals(centres, figure.moved(step - little))
        for little in np.eye(7) * 1e-6
    ]
    wanted = np.reshape(apart, (7, -1)).T / 2e-6
    assert slopes(centres, figure, step) == pytest.approx(wanted, abs=1e-6)


@pytest.mark.parametrize("degrees", [360, 150, 60])
def test_c3_the_covariance_with_angles_is_that_of_many(degrees):
    """C3 for the fit that is used: chi square of point and direction over 400 measurements."""
    every = measured(11, degrees, circles=400, seed=3)
    angles = around(11, degrees)
    chosen = [0, 1, 2, 3, 4]
    away = []
    for points in every:
        found = locate(Centres(angles, points), NOISE, robust=False)
        away.append(np.concatenate([found.point - CENTRE, found.direction])[chosen])
    stated = found.covariance / found.scatter.factor**2
    inverse = np.linalg.inv(stated[np.ix_(chosen, chosen)])
    chi = np.einsum("ni,ij,nj->n", away, inverse, away)
    assert chi.mean() / len(chosen) == pytest.approx(1.0, abs=4 * math.sqrt(2 / 5 / 400))
    ratio = np.std(away, axis=0) / np.sqrt(np.diag(stated)[chosen])
    assert ratio == pytest.approx(np.ones(5), abs=4 * math.sqrt(0.5 / 400))


def test_c7_an_outlier_does_not_spoil_the_rest():
    """C7: one of 8 off by 0.1 mm: robust rms at most 0.45 of that of least squares.

    As in the reference the least squares are those of the circle. Angles known make them better by
    themselves, and then it is the fit of the seven good ones that nothing can improve on.
    """
    points = measured(8, circles=100)
    generator = np.random.default_rng(5)
    aside = generator.standard_normal((100, 3))
    points[:, 3] += 0.1 * aside / np.linalg.norm(aside, axis=1)[:, None]
    robust, plain, best = [], [], []
    for one in points:
        found = locate(Centres(around(8), one), NOISE)
        assert not found.kept[3]
        assert found.standardised[3] > 4.0
        assert any("outlier, left out: centre 4 at 135 degrees" in w for w in warnings(found))
        robust.append(found.point - CENTRE)
        plain.append(fitted(found.centres, np.ones(8)).centre - CENTRE)
        best.append(fitted(found.centres, (np.arange(8) != 3).astype(float)).centre - CENTRE)
    circles = fit_circles(points).centre - CENTRE
    size = rms(np.array(robust))
    assert size <= 0.45 * rms(circles)
    assert size <= 0.55 * rms(np.array(plain))
    assert size <= 1.02 * rms(np.array(best))


def test_few_are_left_out_where_nothing_is_wrong():
    kept = [locate(Centres(around(8), p), NOISE).kept.sum() for p in measured(8, circles=200)]
    assert np.mean(kept) > 7.95


# --- C4, C5: what is refused, and what is said ---


def refused(centres: Centres, noise: float = 0.002) -> str:
    with pytest.raises(InputError) as caught:
        locate(centres, noise)
    diagnostic = caught.value.diagnostics[0]
    return f"{diagnostic.code}: {diagnostic.message}"


def test_c4_short_arcs_are_said_and_refused():
    """C4: condition above 20 is said, above 100 refused."""
    said = [w for w in warnings(locate(clean(skew(), around(11, 85)), 0.002)) if "condition" in w]
    assert said == []
    (said,) = warnings(locate(clean(skew(), around(11, 80)), 0.002))
    assert said.startswith("badly conditioned: 2")
    locate(clean(skew(), around(11, 40)), 0.002)
    assert refused(clean(skew(), around(11, 36))).startswith("GX487: an arc of 36 degrees")


def test_c5_too_few_the_same_or_in_a_line_are_refused():
    """C5: collinear, duplicate or fewer than three points are errors."""
    good = clean(skew(), around(5))
    two = Centres(good.degrees[:2], good.points[:2])
    assert refused(two).startswith("GX486: 2 centres are no circle")
    line = Centres(good.degrees, np.linspace(0, 1, 5)[:, None] * (100.0, 20.0, 3.0))
    assert "straight line" in refused(line)
    for angle in (0.0, 72.0):
        again = good.points[[0, 1, 2, 3, 0]]
        twice = Centres(np.array((0.0, 72.0, 144.0, 216.0, angle)), again)
        assert ("the same centre stands twice, also in row 1" in refused(twice)) is True
    back = np.array((0.0, 90.0, 360.0, 450.0))
    assert "fewer than three angles" in refused(clean(skew(), back, noise=0.001))
    still = Centres(good.degrees, np.random.default_rng(0).normal(0.0, 0.002, (5, 3)))
    assert "hardly moves" in refused(still)


def test_a_full_turn_that_ends_where_it_began_is_no_duplicate():
    locate(clean(skew(), np.array((0.0, 90.0, 180.0, 270.0, 360.0))), 0.002)


def test_c5_three_points_have_no_redundancy():
    """C5: n = 3 is said to be without redundancy; a fourth is enough to be silent."""
    (said,) = warnings(locate(clean(skew(), around(3)), 0.002))
    assert "no redundancy" in said
    assert list(warnings(locate(clean(skew(), around(4)), 0.002))) == []
    assert np.isnan(without_each(locate(clean(skew(), around(3)), 0.002))[0]).all()


def test_angles_of_another_axis_are_refused():
    good = clean(skew(), around(7))
    wrong = Centres(good.degrees[[3, 0, 5, 1, 6, 2, 4]], good.points)
    assert refused(wrong)[:5] in ("GX475", "GX486")
    half = Centres(good.degrees / 2, good.points)
    assert refused(half)[:5] in ("GX475", "GX486")


def test_residuals_above_the_noise_are_refused():
    noisy = clean(skew(), around(9), noise=0.02)
    assert refused(noisy).startswith("GX475")
    locate(noisy, 0.02)


# --- axes of the head ---


def head_data(axis: Rotary, tip: Floats, degrees: Floats) -> Floats:
    """Return X, Y, Z that keep the tip on a ball: the tip less where the axis carries it."""
    return np.array((300.0, 200.0, -100.0)) - axis.turn(np.tile(tip, (len(degrees), 1)), degrees)


def test_a_probe_in_a_turning_head_finds_the_axis_of_the_head():
    axis, tip = skew(1, "B"), np.array((7.0, -30.0, -250.0))
    degrees = around(7, 180.0) - 90.0
    points = head_data(axis, tip, degrees)
    found = locate(Centres(degrees, points), 0.002, tip=(7.0, -30.0, -250.0))
    assert found.sign == 1
    assert found.direction == pytest.approx(np.array(axis.direction), abs=1e-12)
    assert np.linalg.norm(np.cross(found.point - axis.point, axis.direction)) < 1e-9


def test_the_covariance_of_the_point_of_a_head():
    axis, tip = skew(1, "B"), (7.0, -30.0, -250.0)
    degrees = around(7, 100.0) + 40.0
    exact = head_data(axis, np.array(tip), degrees)
    generator = np.random.default_rng(4)
    away = []
    for _ in range(300):
        noisy = exact + 0.002 * generator.standard_normal(exact.shape)
        found = locate(Centres(degrees, noisy), 0.002, tip, robust=False)
        away.append(found.point)
    sd = np.sqrt(np.diag(found.covariance)[:3]) / found.scatter.factor
    assert np.std(away, axis=0) == pytest.approx(sd, rel=0.17)
