"""Rotary axes from ball centres: C1 to C5, C7 and C8 of the reference, its tables, refusals."""

from __future__ import annotations

import math

import numpy as np
import pytest

from gcxform.calibrate.circle import fit_circles, spread
from gcxform.calibrate.rotary import (
    Centres,
    Placed,
    arc,
    condition,
    fitted,
    locate,
    without_each,
)
from gcxform.calibrate.rotarycheck import (
    advice,
    checked_angles,
    dial,
    dial_spread,
    harmonics,
    next_angle,
    rotary_of,
    standing,
    warnings,
)
from gcxform.diagnostics import InputError
from gcxform.machine.chain import Rotary
from gcxform.machine.errors import FloatArray
from gcxform.simulate.balls import simulate_balls

CENTRE = np.array((102.532, 51.230, 128.947))  # of the published simulation, mm
NOISE = 0.01
UPRIGHT = Rotary("C", (0.0, 0.0, 1.0), (102.532, 51.230, 128.947), 1)


def off(x: float, y: float = 0.0, z: float = 0.0) -> FloatArray:
    """Return a place (3,) beside the centre."""
    return np.asarray(CENTRE + np.array((x, y, z)))


def around(count: int, degrees: float = 360.0) -> FloatArray:
    """Return angles all around, or on an arc with both of its ends."""
    return np.linspace(0.0, degrees, count, endpoint=degrees < 360.0)


def measured(
    count: int, arc: float = 360.0, radius: float = 261.0, circles: int = 2000, seed: int = 0
) -> FloatArray:
    generator = np.random.default_rng(seed)
    ball = off(radius)
    angles = around(count, arc)
    return simulate_balls(UPRIGHT, ball, angles, noise=NOISE, circles=circles, generator=generator)


def rms(vectors: FloatArray) -> float:
    return math.sqrt((vectors**2).sum(axis=-1).mean())


def skew(sign: int = 1, letter: str = "A") -> Rotary:
    """Return an axis that points nearly along X, anywhere."""
    direction = np.array((1.0, -0.0021, 0.0043))
    x, y, z = (direction / np.linalg.norm(direction)).tolist()
    return Rotary(letter, (x, y, z), (5.013, -32.017, -95.032), sign)


def clean(axis: Rotary, degrees: FloatArray, noise: float = 0.0) -> Centres:
    points = simulate_balls(axis, (40.0, 60.0, -80.0), degrees, noise=noise)
    return Centres(np.asarray(degrees, float), points)


# --- circles without angles ---


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


# --- axes from centres and angles ---


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
    inverse = np.linalg.inv(found.covariance[np.ix_(chosen, chosen)])
    chi = np.einsum("ni,ij,nj->n", away, inverse, away)
    assert chi.mean() / len(chosen) == pytest.approx(1.0, abs=4 * math.sqrt(2 / 5 / 400))
    ratio = np.std(away, axis=0) / np.sqrt(np.diag(found.covariance)[chosen])
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


# --- what is told beside ---


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


def head_data(axis: Rotary, tip: FloatArray, degrees: FloatArray) -> FloatArray:
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
    sd = np.sqrt(np.diag(found.covariance)[:3])
    assert np.std(away, axis=0) == pytest.approx(sd, rel=0.17)


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
