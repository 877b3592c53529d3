"""Circular tests of linear axes: what is put in comes out, and what is not told is not said."""

from __future__ import annotations

import numpy as np
import pytest
from circle_kit import (
    AROUND,
    AXES,
    CENTRE,
    FEED,
    ROUGH,
    both,
    errors,
    fitted,
    read_tests,
    run,
)

from gcxform.calibrate.circles.causes import SetUp, causes
from gcxform.calibrate.circles.circles import Asked, Run, fit
from gcxform.calibrate.circles.deviations import circular_deviation, hysteresis
from gcxform.calibrate.circles.machine import Identified
from gcxform.calibrate.circles.report import advice, lines, warnings
from gcxform.diagnostics import InputError
from gcxform.errormodel.linear import Linear
from gcxform.simulate.drives import Drives

# The test vector of Renishaw's causes in their table: sizes in mm, and readings in um (CCW, CW).
SIZES = {
    "radius": 1.2e-3,
    "centre 1": 3e-3,
    "centre 2": -2e-3,
    "scale mismatch": 30e-4,
    "squareness": -40e-4,
    "servo mismatch": 0.2e-3 * FEED,
    "backlash X at +X": 6e-3,
    "backlash X at -X": 4e-3,
    "backlash Y at +Y": -3e-3,
    "backlash Y at -Y": -3e-3,
    "lateral play X": 2e-3,
    "straightness X": -8e-3,
    "straightness Y": 5e-3,
    "cyclic error X cosine": 0.8e-3,
}
SAMPLES = {
    0.25: (3.517, -2.534),
    45.25: (7.450, -3.450),
    90.25: (1.145, 2.196),
    135.25: (-5.846, 1.237),
    179.75: (2.839, 6.873),
    180.25: (6.969, 2.918),
    225.25: (9.328, -0.581),
    269.75: (0.231, -4.820),
    270.25: (-2.831, -1.780),
    315.25: (-3.315, 4.777),
    359.75: (-2.508, 3.525),
}


def vector(sense):
    """Return the run of the test vector in a sense."""
    setup, senses = SetUp("XY", 100.0, FEED), np.full(len(AROUND), sense)
    columns = {
        c.name: c.column for c in causes(setup, AROUND, senses, 360.0, {"X": 10.0, "Y": 10.0})
    }
    whole = sum(size * columns[name] for name, size in SIZES.items())
    return Run(sense, AROUND, np.asarray(whole))


def test_the_readings_are_those_of_the_table_of_causes():
    for sense, place in ((1, 0), (-1, 1)):
        found = dict(zip(AROUND.tolist(), 1e3 * vector(sense).readings, strict=True))
        for angle, pair in SAMPLES.items():
            assert found[angle] == pytest.approx(pair[place], abs=6e-4), (angle, sense)


def test_the_sizes_come_back_with_the_known_condition_and_figures():
    found = fitted([vector(1), vector(-1)], pitch=10.0, behind=0.0)
    for cause, size in zip(found.causes, found.solution.value, strict=True):
        assert size == pytest.approx(SIZES.get(cause.name, 0.0), abs=1e-7), cause.name
    assert found.condition == pytest.approx(5.90, abs=0.01)
    wanted = {"scale mismatch": 0.77, "squareness": 0.75, "servo mismatch": 0.013}
    wanted |= {"centre 1": 0.055, "radius": 0.027, "backlash X at +X": 0.17, "lateral play Y": 0.1}
    for name, deviation in wanted.items():
        assert found.size(name).deviation == pytest.approx(deviation, rel=0.05), name
    figures = {name: round(1e3 * value, 3) for name, value in found.figures.items()}
    assert (figures["G(CCW)"], figures["G(CW)"], figures["G(b)"]) == (18.261, 12.622, 17.998)
    assert figures["H"] == 10.929


DRIVEN = {
    "lag": ((0.004, 0.0, 0.0), "servo mismatch", 0.004),
    "backlash": ((0.0, 0.006, 0.0), "backlash Y at -Y", 0.006),
    "play": ((0.003, 0.0, 0.0), "lateral play X", 0.003),
}


@pytest.mark.parametrize("name", DRIVEN)
def test_what_drives_do_is_what_their_column_says(name):
    values, cause, size = DRIVEN[name]
    found = fitted(both("XY", drives=Drives(**{name: values})), pitch=7.0)
    sizes = dict(zip([c.name for c in found.causes], found.solution.value, strict=True))
    assert sizes.pop(cause) == pytest.approx(size, abs=2e-6)
    others = {c: s for c, s in sizes.items() if c != "radius" and cause[:10] not in c}
    assert max(map(abs, others.values())) < 2e-6


@pytest.mark.parametrize(
    ("plane", "slope", "name", "value"),
    [
        ("XY", {"EXY": 5e-5}, "C0Y", -5e-5),
        ("XY", {"EYX": 5e-5}, "C0Y", -5e-5),
        ("YZ", {"EYZ": 5e-5}, "A0Z", -5e-5),
        ("ZX", {"EXZ": 5e-5}, "B0Z", 5e-5),
    ],
)
def test_squareness_has_the_sign_of_the_model_that_is_written(plane, slope, name, value):
    """C0Y turns Y about Z, away from X where it is positive (ISO 230-1): EXY has slope -C0Y."""
    found = Identified((fitted(both(plane, slopes=slope), plane),))
    assert found.squareness[name].value == pytest.approx(value, abs=2e-8)
    into, along = "XYZ".index(next(iter(slope))[1]), "XYZ".index(next(iter(slope))[2])
    if {"C0Y": 0, "A0Z": 1, "B0Z": 0}[name] == into:
        assert found.slopes()[into, along] == pytest.approx(5e-5, abs=2e-8)


SCALES = {"EXX": 4e-5, "EYY": -2e-5, "EZZ": 1e-5}


def three(slopes, **machine):
    return [fitted(both(plane, slopes=slopes, **machine), plane) for plane in AXES]


def test_three_planes_tell_the_scales_from_one_that_is_right():
    slopes = SCALES | {"EXY": 3e-5, "EXZ": 2e-5, "EYZ": -1e-5}
    found = Identified(tuple(three(slopes)), "X")
    scales = {letter: told.value for letter, told in found.scales.items()}
    assert scales == pytest.approx({"Y": -6e-5, "Z": -3e-5}, abs=1e-8)
    model = found.model()
    assert [model.range_of(k) for k in range(3)] == [(c - 100.0, c + 100.0) for c in CENTRE]
    places = np.array(CENTRE) + np.array([[0, 0, 0], [100, 0, 0], [0, 100, 0], [50, -50, 90.0]])
    away = places - CENTRE
    exact = away @ np.array([[0, 3e-5, 2e-5], [0, -6e-5, -1e-5], [0, 0, -3e-5]]).T
    assert model.error(places) == pytest.approx(exact, abs=3e-6)
    endless = found.model(limited=False)
    assert isinstance(endless, Linear)
    assert endless.error(places) == pytest.approx(exact, abs=3e-6)
    assert [*warnings(found)] == []


def test_scales_are_left_out_unless_one_is_taken_to_be_right():
    found = Identified(tuple(three(SCALES)))
    assert np.abs(np.diag(found.slopes())).max() == 0.0
    assert [w for w in warnings(found) if "which is wrong" in w]
    assert found.mismatches["ZX"].value == pytest.approx(-3e-5, abs=1e-8)


def test_a_calibrated_bar_tells_scales_by_two_feeds():
    """Lagging by v T makes the radius smaller by (v T)^2 / (2 r): 20 um at the high feed."""
    tests = []
    for plane in AXES:
        for times in (0.25, 1.0):
            drives = Drives(lag=(2.0 * times,) * 3)
            runs = both(plane, slopes=SCALES, drives=drives)
            tests.append(fitted(runs, plane, feed=FEED * times))
    scales = {letter: told.value for letter, told in Identified(tuple(tests), "bar").scales.items()}
    assert scales == pytest.approx({"X": 4e-5, "Y": -2e-5, "Z": 1e-5}, abs=3e-8)
    with pytest.raises(InputError, match=r"GX476.*do not tell the scale of X, Y, Z from bar"):
        Identified(tuple(tests[1::2]), "bar").model()


def test_a_ring_that_was_probed_tells_its_scales_at_rest():
    runs = {plane: [run(plane, 0, ROUGH, slopes=SCALES)] for plane in AXES}
    tests = [fitted(runs[plane], plane, feed=None) for plane in AXES]
    found = Identified(tuple(tests), "bar")
    scales = {letter: told.value for letter, told in found.scales.items()}
    assert scales == pytest.approx({"X": 4e-5, "Y": -2e-5, "Z": 1e-5}, abs=1e-8)
    names = [cause.name for cause in tests[0].causes]
    assert not [name for name in names if name.startswith(("servo", "backlash", "lateral"))]
    assert "turn the ring" in next(advice(found))


RINGS = SCALES | {"EXY": 3e-5}


def rings(*radii, plane="XY", real=0.0):
    """Return tests of probed rings of these radii, the first of which has another, `real`."""
    found = []
    for radius in radii:
        read = run(plane, 0, ROUGH, slopes=RINGS, radius=radius)
        read = Run(0, read.degrees, read.readings + (real if radius == radii[0] else 0.0))
        found.append(fitted([read], plane, radius, None, str(radius)))
    return found


def test_a_ring_that_has_not_its_radius_is_found_by_another():
    found = Identified(tuple(rings(25.0, 50.0)), "bar")
    assert found.network.doubt is None
    assert found.scales["X"].value == pytest.approx(4e-5, abs=1e-8)
    doubted = Identified(tuple(rings(25.0, 50.0, real=0.01)), "bar")
    assert [w for w in warnings(doubted) if "one of them is not that of its bar or ring" in w]
    with pytest.raises(InputError, match=r"GX475.*differs by .* um of a radius"):
        doubted.model()
    other = rings(25.0, real=0.01) + rings(25.0, plane="YZ") + rings(25.0, plane="ZX")
    with pytest.raises(InputError, match=r"GX475.*differs by"):
        Identified(tuple(other), "bar").model()
    Identified(tuple(other), "bar", radius_noise=0.01).model()


def test_one_ring_is_believed_as_far_as_a_scale_can_be():
    """1 % of it would be a scale that no machine has; less is a scale, and the sheet says so."""
    with pytest.raises(InputError, match=r"GX475.*off by -1 %"):
        Identified(tuple(rings(25.0, real=-0.25)), "bar").model()
    found = Identified(tuple(rings(25.0)), "bar")
    said = "the scales rest on the stated radius of 25 mm: 1 um of it is 40 ppm of all scales"
    assert said in lines(found)
    assert found.scales["X"].deviation == pytest.approx(4e-5, rel=0.02)  # 1 um of 25 mm


def test_points_without_a_radius_tell_no_scale():
    head = "plane,sense,X [mm],Y [mm]\n"
    points = CENTRE[:2] + 25.0 * np.column_stack([np.cos(ROUGH), np.sin(ROUGH)])
    text = head + "".join(f"XY,probed,{x},{y}\n" for x, y in points.tolist())
    ((setup, runs),) = read_tests(text, centre=CENTRE)
    found = Identified((fit(setup, runs, Asked()),), "bar")
    assert found.scales == {}
    with pytest.raises(InputError, match=r"GX476.*from bar(.|\n)*--radius"):
        found.model()


BENT = {"EYX2": 8e-7, "EXY2": -5e-7, "EZY2": 3e-7, "EXZ2": -6e-7, "EYZ2": 4e-7, "EZX2": 2e-7}


def test_bows_go_into_the_model_if_that_is_asked():
    slopes = SCALES | {"EXY": 3e-5} | BENT
    found = Identified(tuple(three(slopes)), "X", bent=True)
    model = found.model()
    places = np.array(CENTRE) + np.array([[0, 0, 0], [100, 0, 0], [0, -77, 0], [50, -50, 90.0]])
    straight = Identified(tuple(three(slopes)), "X").model()
    assert model.error(places) - straight.error(places) == pytest.approx(
        errors(BENT, places - CENTRE), abs=1e-5
    )
    assert "EYX: a bow of +8.00" in "\n".join(lines(found))


def test_a_bow_is_not_told_from_a_pitch_that_grows():
    """So a model has it only on demand: 8 um in EXX look like bows of Y in X, of the other sign."""
    found = fitted(both("XY", slopes={"EXX2": 8e-7}))
    assert found.size("straightness Y").value == pytest.approx(-8.0, abs=0.05)
    assert found.scatter.observed < 1e-4


def test_bows_of_arcs_and_of_circles_at_two_places_are_refused():
    arc = fitted(both("XY", np.arange(10.25, 230.0, 0.5)))
    with pytest.raises(InputError, match=r"GX476.*does not tell the straightness of X"):
        Identified((arc,), bent=True).model()
    tests = fitted(both("XY")), fitted(both("ZX", radius=150.0), "ZX", 150.0)
    with pytest.raises(InputError, match=r"GX476.*X goes stand at different places"):
        Identified(tests, bent=True).model()


def test_a_pitch_that_is_not_given_is_looked_for():
    """0.5 um of a pitch of 8 mm in noise of 0.5 um; Y has none."""
    drives = Drives(cyclic=(5e-4, 0.0, 0.0), pitch=8.0, backlash=(0.004, 0.0, 0.0))
    found = fitted(both("XY", drives=drives, noise=5e-4), noise=5e-4, search=True)
    (period,) = found.looked.found
    assert (period.letter, period.pitch) == ("X", pytest.approx(8.0, abs=0.02))
    assert 0.0 < period.chance < 1e-6
    size = np.hypot(*(found.size(f"cyclic error X {part}").value for part in ("cosine", "sine")))
    assert size == pytest.approx(0.5, abs=0.06)
    said = "\n".join(lines(Identified((found,))))
    assert "cyclic error X: a period of 8" in said
    assert "no cyclic error of Y is seen with a period of 2.18 to 33.3 mm" in said


def test_both_axes_have_a_pitch():
    drives = Drives(cyclic=(8e-4, 1e-3, 0.0), pitch=12.0)
    found = fitted(both("XY", ROUGH, drives=drives, noise=5e-4), noise=5e-4, search=True)
    assert found.looked.pitches == pytest.approx({"Y": 12.0, "X": 12.0}, abs=0.05)


def test_noise_has_no_pitch():
    """Some thousand periods are looked at in each of 20 tests, and none of them is one."""
    rng = np.random.default_rng(3)
    for _ in range(20):
        found = fitted(both("XY", ROUGH, noise=1e-3, rng=rng), search=True)
        assert found.looked.found == ()


def test_one_sense_does_not_tell_squareness_from_servo_mismatch():
    slope, drives = {"EXY": 5e-5}, Drives(lag=(0.004, 0.0, 0.0))
    found = Identified((fitted([run("XY", 1, slopes=slope, drives=drives)]),))
    assert found.squareness == {}
    assert [w for w in warnings(found) if "squareness, servo mismatch" in w]
    assert np.isnan(found.tests[0].size("squareness").value)
    assert found.tests[0].index("centre 1") is not None
    with pytest.raises(InputError, match=r"GX476.*squareness from servo mismatch"):
        found.model()


@pytest.mark.parametrize(("arc", "told"), [(330.0, True), (220.0, True), (100.0, False)])
def test_arcs_tell_what_they_can(arc, told):
    degrees = np.arange(10.25, 10.0 + arc, 0.5)
    found = fitted(both("XY", degrees, slopes={"EXY": 5e-5}), pitch=10.0)
    names = [cause.name for cause in found.causes]
    assert ("straightness X" in names) is (arc >= 300.0)
    assert (found.index("squareness") is not None) is told
    if told:
        assert 1e-6 * found.size("squareness").value == pytest.approx(-5e-5, abs=1e-7)
    else:
        assert [w for w in warnings(Identified((found,))) if "cannot be told apart" in w]
        with pytest.raises(InputError, match=r"GX476.*does not tell squareness"):
            Identified((found,)).model()
    assert fitted(both("XY", degrees), every=True).condition > found.condition or arc > 300.0


def test_backlash_at_an_end_that_is_not_reached_is_that_of_the_axis():
    degrees = np.arange(-60.0, 200.0, 0.5) + 0.25
    found = fitted(both("XY", degrees, drives=Drives(backlash=(0.006, 0.004, 0.0))))
    names = [cause.name for cause in found.causes]
    assert {"backlash X at +X", "backlash X at -X", "backlash Y"} <= set(names)
    assert found.size("backlash Y").value == pytest.approx(4.0, abs=0.05)


def test_a_pivot_that_is_far_off_spoils_no_squareness():
    """0.5 mm of 100 mm are 12.5 urad of squareness to the second order."""
    found = fitted(both("XY", slopes={"EXY": 5e-5}, pivot=(0.36, 0.35)))
    assert found.size("squareness").value == pytest.approx(-50.0, abs=0.1)
    assert found.size("scale mismatch").value == pytest.approx(0.0, abs=0.1)
    assert found.size("centre 1").value == pytest.approx(360.0, abs=0.1)
    assert np.abs(found.residuals).max() < 2e-5


def test_spikes_are_seen_where_an_axis_sticks_and_spoil_no_cause():
    """An axis that stands is off by r (1 - cos): 8.6 um at 0.75 degrees."""
    runs = both("XY", drives=Drives(stick=(1.5, 0.0, 0.0)), noise=2e-4)
    found = fitted(runs, noise=2e-4)
    seen = {(s.end, s.sense): 1e3 * s.height for s in found.spikes if s.seen}
    assert set(seen) == {("+X", 1), ("+X", -1), ("-X", 1), ("-X", -1)}
    assert list(seen.values()) == pytest.approx([8.57] * 4, abs=0.8)
    assert abs(found.size("backlash X at +X").value) < 0.2
    assert found.effects["reversal spikes"] == pytest.approx(1e-3 * max(seen.values()))


def test_tests_of_one_plane_have_one_squareness_and_say_if_they_differ():
    def at(slope, seed):
        rng = np.random.default_rng(seed)
        return fitted(both("XY", slopes={"EXY": slope}, noise=1e-3, rng=rng), name=str(seed))

    same = Identified((at(5e-5, 1), at(5e-5, 2))).squareness["C0Y"]
    assert same.value == pytest.approx(-5e-5, abs=3e-6)
    assert same.deviation < 0.8e-6
    other = Identified((at(5e-5, 1), at(9e-5, 2)))
    assert other.squareness["C0Y"].deviation > 1e-5
    assert [w for w in warnings(other) if "not the same everywhere" in w]


def test_scales_that_do_not_close_are_named():
    tests = three(SCALES)
    tests[0] = fitted(both("XY", slopes=SCALES | {"EXX": 9e-5}))
    assert [w for w in warnings(Identified(tuple(tests))) if "do not close" in w]


def test_more_noise_than_stated_widens_deviations_and_much_more_refuses_a_model():
    rng = np.random.default_rng(5)
    runs = both("XY", noise=2e-3, rng=rng)
    found = fitted(runs, noise=1e-3)
    assert found.factor == pytest.approx(2.0, rel=0.1)
    Identified((found,)).model()
    found = Identified((fitted(runs, noise=4e-4),))
    with pytest.raises(InputError, match=r"GX475.*off its causes by 1.94"):
        found.model()
    assert [w for w in warnings(found) if "deviations are those of what is left" in w]


def test_what_is_left_and_smooth_is_not_taken_for_noise():
    """A fifth harmonic is no cause of the table; there are no 1440 readings of it."""
    runs = [
        Run(r.sense, r.degrees, r.readings + 2e-3 * np.cos(5 * np.radians(r.degrees)))
        for r in both("XY", noise=1e-3)
    ]
    found = fitted(runs)
    assert found.correlation > 0.5
    assert found.factor > 2.0 * found.scatter.factor
    assert [w for w in warnings(Identified((found,))) if "is smooth" in w]


def test_deviations_are_those_that_repeated_tests_show():
    """Squares of errors over deviations have the mean 1: the covariance is neither wide nor thin"""
    rng, squares = np.random.default_rng(7), []
    drives = Drives(lag=(0.003, 0.0, 0.0), backlash=(0.005, -0.002, 0.0))
    exact = fitted(both("XY", ROUGH, drives=drives)).solution.value
    for _ in range(60):
        found = fitted(both("XY", ROUGH, noise=1e-3, rng=rng, drives=drives))
        part = (found.solution.value - exact) / np.sqrt(np.diag(found.solution.covariance))
        squares.append(part**2)
    mean = np.mean(squares, axis=0)
    assert mean.mean() == pytest.approx(1.0, abs=0.1)
    assert ((mean > 0.5) & (mean < 1.6)).all()


def test_hysteresis_is_between_readings_at_one_angle():
    angle = np.radians(np.arange(0.0, 90.0, 1.0))
    unit = np.column_stack([np.cos(angle), np.sin(angle)])
    assert hysteresis(100.0 * unit, 100.004 * unit) == pytest.approx(0.004)
    assert np.isnan(hysteresis(100.0 * unit, -100.0 * unit))
    near = hysteresis(100.0 * unit[:60], 100.0 * unit[30:] * (1.0 + 1e-5))
    assert near == pytest.approx(1e-3, rel=1e-6)
    assert circular_deviation(100.0 * unit) < 1e-9


def test_the_sheet_has_the_largest_cause_first_and_its_share_of_g():
    drives = Drives(backlash=(0.010, 0.0, 0.0))
    found = Identified((fitted(both("XY", slopes={"EXY": 2e-5}, drives=drives, pivot=(0.05, 0))),))
    said = lines(found)
    assert said[2].split()[:2] == ["backlash", "X"]
    share = found.tests[0].effects["backlash X"] / found.tests[0].figures["G(b)"]
    assert said[2].endswith(f"{100 * share:.0f} %")
    assert [line for line in said if line.startswith("  centre") and line.endswith("set-up")]


def test_few_readings_tell_little_and_say_so():
    """Eight in each sense, of which those at reversals are left out: fewer than causes."""
    found = fitted(both("XY", np.arange(0.0, 360.0, 45.0)))
    said = [line for line in warnings(Identified((found,))) if "do not tell" in line]
    assert said[0].endswith("they are too few, or too near")
    assert [line for line in lines(Identified((found,))) if "centre            not told" in line]
    assert "not all causes told; residuals" in lines(Identified((found,)))[0]
    with pytest.raises(InputError, match=r"GX476(.|\n)*more readings"):
        Identified((fitted(both("XY", 45.0 * np.arange(8) + 5.0), pitch=10.0),)).model()


def test_a_run_of_few_readings_is_no_circle():
    with pytest.raises(InputError, match=r"GX477.*8 are the least"):
        fitted([run("XY", 1, np.arange(0.0, 350.0, 50.0))])
    with pytest.raises(InputError, match=r"GX477"):
        fitted([Run(1, np.zeros(9), np.zeros(9))])
