"""The step diagonal: published figures, what is observable, covariance, what is refused."""

from __future__ import annotations

import numpy as np
import pytest
from diagonal_kit import (
    ALIGNED,
    EXAMPLE,
    FREE,
    LENGTHS,
    LOW,
    SLOPES,
    TRAVEL,
    apart,
    linear,
    published,
    readings,
    reframed,
    turned,
    values,
)
from gcxform_plugins.formats.lddm import Lddm
from step_diagonal_kit import simulate_linear, simulate_step_diagonal, step_positions

from gcxform.calibrate.diagonal.readings import step_diagonals
from gcxform.calibrate.diagonal.slopes import together, worded
from gcxform.calibrate.diagonal.step_diagonal import Assumed, identify, misalignment_gain, solved
from gcxform.calibrate.solution import plausible
from gcxform.diagnostics import InputError
from gcxform.errormodel.functions import AxisFunctions
from gcxform.errormodel.model_file import load_model

SAMPLES = 700


def misaligned(diagonal: int, towards: int, angle: float = 1e-4) -> np.ndarray:
    angles = np.zeros((4, 2))
    angles[diagonal, towards] = angle
    return angles


# --- S1: the published figures ---


def test_s1_the_diagonals_of_the_published_machine():
    ends = [leg.deviation[-1] * 1e3 for leg in readings().legs]
    assert ends == pytest.approx(LENGTHS, abs=5e-4)


@pytest.mark.parametrize("source", ["example", "shared"])
def test_s1_round_trip_of_the_published_machine(source, request):
    folder = request.getfixturevalue("shared") / "data" if source == "shared" else EXAMPLE.parent
    truth = load_model(folder / "lddm" / "table_x.txt", [Lddm])
    assert isinstance(truth, AxisFunctions)
    measured = step_diagonals(simulate_step_diagonal(truth, LOW, TRAVEL, 10))
    found = identify(measured, assumed=ALIGNED)
    assert apart(found.model(), truth) <= 1e-12
    assert found.slopes[0][3:] * 1e6 == pytest.approx(SLOPES, abs=5e-4)
    assert found.redundancy_rms <= 1e-12


def test_the_closed_form_of_the_vector_method_is_the_least_squares_solution():
    """Four readings of a step give its three errors: kinematics 2, written out."""
    rng = np.random.default_rng(5)
    legs = simulate_step_diagonal(published(), LOW, TRAVEL, 10, noise=0.001, generator=rng)
    found = solved(step_diagonals(legs), assumed=ALIGNED)
    a, b, c = np.array(TRAVEL) / np.linalg.norm(TRAVEL)
    ppp, npp, pnp, ppn = (np.diff(leg.deviation)[0::3] for leg in legs)
    npp = npp[::-1]  # cells are counted by position
    x = (ppp + npp + pnp + ppn) / (4 * a)
    y = (ppp - npp - pnp + ppn) / (4 * b)
    z = (ppp - npp + pnp - ppn) / (4 * c)
    grown = found.solution.value[: found.layout.errors].reshape(3, 3, -1)
    assert grown[0] == pytest.approx(np.array([x, y, z]), abs=1e-14)
    closure = np.abs(ppp + npp - pnp - ppn) / 2
    assert found.redundancy[0] == pytest.approx(closure, abs=1e-14)


def test_steps_go_x_y_z_in_turn_from_the_corner():
    stops = step_positions((1.0, 2.0, 3.0), (10.0, 20.0, 30.0), 2, (1, -1, 1))
    assert stops.tolist() == [
        [1, 22, 3], [6, 22, 3], [6, 12, 3], [6, 12, 18], [11, 12, 18], [11, 2, 18], [11, 2, 33],
    ]  # fmt: skip


# --- S2: what is observable ---


@pytest.mark.parametrize(
    ("assumed", "tests", "slopes", "rank"),
    [(FREE, (), 4, 93), (FREE, (0,), 5, 95), (FREE, (0, 1), 6, 97), (FREE, (1, 2), 6, 97),
     (FREE, (0, 1, 2), 6, 98), (ALIGNED, (), 6, 90)],
)  # fmt: skip
def test_s2_rank(assumed, tests, slopes, rank):
    """Of 9 N + 8 unknowns 3 turns are never seen, with free beams 2 scales neither."""
    found = identify(readings(), linear(*tests), assumed)
    assert len(found.observable_slopes) == slopes
    assert len(found.hidden_slopes) == 6 - slopes
    assert found.solution.rank == rank


def test_s2_what_diagonals_alone_tell():
    found = identify(readings())
    combination = found.observable_slopes[0, :3]
    square = np.array(TRAVEL) ** 2
    assert combination == pytest.approx(square / square[0], rel=1e-9)
    assert [worded(row) for row in found.observable_slopes] == [
        "scale X + 0.4727 scale Y + 0.8789 scale Z", "EXY slope", "EXZ slope", "EYZ slope",
    ]  # fmt: skip
    assert [together(row) for row in found.hidden_slopes] == [
        "scale X +1 with scale Z -1.138", "scale Y +1 with scale Z -0.5378",
    ]  # fmt: skip
    assert found.slopes[0][3:] * 1e6 == pytest.approx(SLOPES, abs=5e-4)
    aligned = identify(readings(), assumed=ALIGNED)
    assert found.mean_scale[0] == pytest.approx(aligned.mean_scale[0], abs=1e-12)
    assert found.shapes == pytest.approx(aligned.shapes, abs=1e-12)
    known = ["EXX", "EYY", "EZZ"]
    assert found.determined.sum() == 6
    assert not np.diag(found.determined).any(), known


@pytest.mark.parametrize("tests", [(), (0,), (1,), (2,)])
def test_s2_no_scale_without_two_linear_tests(tests):
    found = identify(readings(), linear(*tests))
    with pytest.raises(InputError, match=r"GX476.*scale"):
        found.model()


def test_s2_hidden_directions_change_no_reading():
    """Scale errors in the hidden directions, with the beams that hide them, are not seen."""
    found = identify(readings())
    base = identify(readings(), linear(0, 1))
    for direction in found.solution.free.T:
        assert np.abs(_rows(found) @ direction).max() < 1e-12
    assert base.solution.free.shape == (len(base.solution.value), 3)


def _rows(found):
    from gcxform.calibrate.diagonal.equations import equations

    noise = found.assumed.noise
    return equations(found.diagonals, found.linear, noise, noise, found.assumed.free_beams).matrix


def test_linear_tests_restore_the_machine_behind_misaligned_beams():
    angles = np.array([[1.0, -0.5], [0.3, 0.2], [0.0, 0.0], [-0.4, 0.6]]) * 1e-4
    found = identify(readings(angles), linear(0, 1))
    assert apart(found.model(), published()) <= 5e-6  # second order: 736 mm (1e-4)^2 / 2
    assert found.misalignments is not None
    assert found.misalignments[0] == pytest.approx(angles, abs=1e-8)
    assert identify(readings(angles)).misalignments is None


# --- S3: a misaligned beam ---


@pytest.mark.parametrize("diagonal", range(4))
@pytest.mark.parametrize("towards", range(2))
def test_s3_a_misaligned_beam_changes_slopes_only_and_is_flagged(diagonal, towards):
    straight = solved(readings(), assumed=ALIGNED)
    measured = readings(misaligned(diagonal, towards))
    bent = solved(measured, assumed=ALIGNED)
    assert np.abs(bent.shapes - straight.shapes).max() < 1e-6
    assert np.abs(bent.slopes[0] - straight.slopes[0]).max() > 5e-6
    gain, limit = misalignment_gain(bent)
    assert gain > 2 * limit
    with pytest.raises(InputError, match=r"GX475.*not along"):
        identify(measured, assumed=ALIGNED)


def test_s3_the_redundancy_of_misaligned_beams():
    """0.1 mrad at random on four beams is 3.4 um a step (kinematics 2)."""
    rng = np.random.default_rng(1)
    squares = [
        solved(readings(1e-4 * rng.standard_normal((4, 2))), assumed=ALIGNED).redundancy_rms ** 2
        for _ in range(60)
    ]
    assert np.sqrt(np.mean(squares)) * 1e3 == pytest.approx(3.4, abs=0.6)


def test_aligned_beams_are_not_flagged_by_noise():
    flagged = 0
    for seed in range(60):
        rng = np.random.default_rng(seed)
        legs = simulate_step_diagonal(published(), LOW, TRAVEL, 4, noise=0.001, generator=rng)
        gain, limit = misalignment_gain(solved(step_diagonals(legs), assumed=ALIGNED))
        flagged += gain > limit
    assert flagged <= 1


@pytest.mark.parametrize(("degrees", "quantile"), [(1, 10.828), (3, 16.266), (10, 29.588)])
def test_what_chi_square_exceeds_once_in_a_thousand(degrees, quantile):
    assert plausible(degrees) == pytest.approx(quantile, rel=1e-4)


# --- V9: the frame ---


def test_v9_a_turned_table_returns_to_its_frame():
    truth = published()
    moved = turned(truth, np.array([30e-6, -20e-6, 50e-6]))
    assert apart(moved, truth) > 0.01
    assert apart(reframed(moved), truth) <= 1e-12


def test_v9_slopes_that_are_dropped_and_not_carried_over_change_the_squareness():
    moved = turned(published(), np.array([30e-6, -20e-6, 50e-6]))
    found = values(reframed(moved))
    ends = found[:, :, -1]
    assert (ends[0, 1], ends[0, 2], ends[1, 2]) == (0.0, 0.0, 0.0)
    slopes = np.array([ends[1, 0] / 330, ends[2, 0] / 450, ends[2, 1] / 450])
    assert slopes * 1e6 == pytest.approx(SLOPES, abs=5e-4)
    dropped = values(moved)[:, :, -1]
    assert abs(dropped[1, 0] / 330 - slopes[0]) > 40e-6


def test_v9_the_readings_of_a_turned_machine_give_the_same_model():
    moved = turned(published(), np.array([30e-6, -20e-6, 50e-6]))
    measured = step_diagonals(simulate_step_diagonal(moved, LOW, TRAVEL, 10))
    assert apart(identify(measured, assumed=ALIGNED).model(), published()) <= 1e-12


# --- covariance ---


def test_the_standard_deviation_at_the_end_of_travel():
    """sqrt(N) / (2 cos) of the step: 2.43, 3.53, 2.59 um for 1 um and N = 10 (kinematics 2)."""
    found = identify(readings(), assumed=ALIGNED)
    ends = found.deviations[:, :, -1] * 1e3
    assert np.diag(ends) == pytest.approx([2.43, 3.53, 2.59], abs=0.006)
    cosine = np.array(TRAVEL) / np.linalg.norm(TRAVEL)
    assert np.diag(ends) == pytest.approx(np.sqrt(10) / (2 * cosine), rel=1e-12)
    assert (ends[0, 1], ends[0, 2], ends[1, 2]) == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)


@pytest.mark.parametrize("free", [True, False], ids=["free", "aligned"])
def test_covariance_against_a_monte_carlo(free):
    """Noisy measurements scatter as the covariance says, in every combination."""
    rng = np.random.default_rng(11)
    truth, count, samples = published(), 2, []
    assumed = Assumed(0.001, 0.0005, free)
    angles = 2e-5 if free else 0.0
    for _ in range(SAMPLES):
        legs = simulate_step_diagonal(
            truth, LOW, TRAVEL, count, noise=0.001, misalignment=angles,
            bidirectional=True, generator=rng,
        )  # fmt: skip
        tests = [
            test
            for axis in (0, 2)
            for test in simulate_linear(
                truth, axis, np.linspace(0, TRAVEL[axis], count + 1), noise=0.0005, generator=rng
            )
        ]
        found = solved(step_diagonals(legs), tests, assumed)
        samples.append(found.functions.ravel())
    seen = np.cov(np.array(samples).T)
    size, vectors = np.linalg.eigh(found.covariance / found.scatter.factor**2)
    kept = size > 1e-9 * size[-1]
    white = vectors[:, kept] / np.sqrt(size[kept])
    ratio = np.linalg.eigvalsh(white.T @ seen @ white)
    spread_of_samples = 2.0 * np.sqrt(kept.sum() / SAMPLES)  # Marchenko and Pastur
    assert ratio.min() > 1.0 - 1.3 * spread_of_samples
    assert ratio.max() < 1.0 + 1.5 * spread_of_samples
    assert ratio.mean() == pytest.approx(1.0, abs=0.03)
    assert kept.sum() == 15  # three ends are zero
    mean = (
        np.array(samples).mean(axis=0)
        - solved(
            step_diagonals(simulate_step_diagonal(truth, LOW, TRAVEL, count)), assumed=ALIGNED
        ).functions.ravel()
    )
    sigma = np.sqrt(np.diag(found.covariance).clip(1e-30))
    assert (np.abs(mean) < 4.5 * sigma / np.sqrt(SAMPLES) + 3e-7).all()


def test_ways_back_and_runs_count_as_more_readings():
    legs = simulate_step_diagonal(published(), LOW, TRAVEL, 10, bidirectional=True, runs=2)
    found = identify(step_diagonals(legs), assumed=ALIGNED)
    once = identify(readings(), assumed=ALIGNED)
    assert len(legs) == 16
    assert found.deviations == pytest.approx(once.deviations / 2, rel=1e-9)
    assert apart(found.model(), published()) <= 1e-12
    assert found.increments.scatter == pytest.approx(0.0, abs=1e-15)
    assert np.isnan(once.increments.scatter)


def test_repeated_readings_show_their_noise():
    rng = np.random.default_rng(2)
    legs = simulate_step_diagonal(published(), LOW, TRAVEL, 10, noise=0.002, runs=4, generator=rng)
    found = solved(step_diagonals(legs), assumed=Assumed(0.002, free_beams=False))
    assert found.increments.scatter == pytest.approx(0.002, rel=0.15)
    assert found.redundancy_rms == pytest.approx(0.002, rel=0.4)


def test_a_misaligned_beam_is_as_uncertain_as_it_scatters():
    rng = np.random.default_rng(3)
    seen = []
    for _ in range(200):
        legs = simulate_step_diagonal(published(), LOW, TRAVEL, 2, noise=0.001, generator=rng)
        tests = [
            test
            for axis in (0, 1)
            for test in simulate_linear(
                published(), axis, np.linspace(0, TRAVEL[axis], 3), noise=0.001, generator=rng
            )
        ]
        found = solved(step_diagonals(legs), tests)
        assert found.misalignments is not None
        seen.append(found.misalignments[0])
    stated = found.misalignments[1] / found.scatter.factor
    assert np.std(seen, axis=0) == pytest.approx(stated, rel=0.25)


# --- what is refused ---


def test_readings_that_contradict_each_other_are_refused():
    legs = list(readings().legs)
    legs[2].deviation[14:] += 0.05  # a beam that was interrupted
    with pytest.raises(InputError, match="GX475") as refusal:
        identify(step_diagonals(legs), assumed=FREE)
    assert "the step of Y from 165 to 198 mm" in str(refusal.value)


def test_the_limit_is_three_times_the_noise():
    legs = list(readings().legs)
    rng = np.random.default_rng(7)
    for leg in legs:
        leg.deviation[:] += np.cumsum(0.004 * rng.standard_normal(31))
    measured = step_diagonals(legs)
    shown = solved(measured).redundancy_rms
    identify(measured, assumed=Assumed(shown / 2.99))
    with pytest.raises(InputError, match="GX475"):
        identify(measured, assumed=Assumed(shown / 3.01))


def test_linear_tests_that_contradict_the_diagonals_are_refused():
    tests = linear(0)
    tests[0].deviation[:] *= -1.0  # corrections in place of errors
    with pytest.raises(InputError, match=r"GX475.*linear tests contradict"):
        identify(readings(), tests, ALIGNED)


@pytest.mark.parametrize("axes", [(0, 1), (0, 1, 2)])
def test_a_linear_test_of_the_other_sign_is_named(axes):
    """With free beams its scale contradicts nothing, or little; its shape does."""
    tests = linear(*axes)
    tests[1].deviation[:] *= -1.0
    with pytest.raises(InputError, match=r"GX475.*linear test of Y.*opposite sign"):
        identify(readings(1e-4), tests, Assumed(linear_noise=0.0005))


def test_a_linear_test_at_another_temperature_is_refused():
    """3 K of steel are 34.5 um/m: the scales of three axes are told by four readings then."""
    tests = linear(0, 1, 2)
    tests[0].deviation[:] += 34.5e-6 * tests[0].position
    with pytest.raises(InputError, match=r"GX475.*scales of the linear tests"):
        identify(readings(1e-4), tests, Assumed(0.0003))
    identify(readings(1e-4), tests[:2], Assumed(0.0003))  # nothing else tells these scales


def test_good_readings_are_hardly_ever_refused():
    """A false alarm in a thousand of each test, also where the noise is twice the stated one."""
    rng = np.random.default_rng(11)
    for scatter in (0.001, 0.002):
        refused = 0
        for _ in range(15):
            legs, tests = list(readings(1e-4, steps=4).legs), linear(0, 1, 2)
            for leg in legs:
                leg.deviation[:] += np.cumsum(scatter * rng.standard_normal(13))
            for test in tests:
                test.deviation[:] += scatter * rng.standard_normal(11)
            try:
                identify(step_diagonals(legs), tests)
            except InputError:
                refused += 1
        assert refused <= 1


def test_one_step_with_free_beams_has_nothing_to_test_it(tmp_path):
    found = identify(readings(steps=1), linear(0, 1))
    assert found.solution.rank == found.layout.size - 3
    assert identify(readings(steps=1)).solution.redundancy == 0
    assert np.isnan(identify(readings(steps=1)).redundancy_rms)
