"""Thermal models: the numbers of the published screw (T1, T3, T4), and bounds."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from thermal_kit import (
    ALPHA,
    AT,
    COLD,
    HELD_SECTION,
    NAMES,
    PITCH,
    SCREW,
    WARM,
    along,
    growth,
    text,
    warm,
    written,
)

from gcxform.errormodel.functions import AxisFunction, AxisFunctions
from gcxform.errormodel.model import Outside, compensate
from gcxform.errormodel.model_file import load_model
from gcxform.errormodel.sum import Sum
from gcxform.errormodel.thermal import Held, Rod, Stretch, ThermalScrew, drift, stretch

VECTOR = [0, 13.084, 30.636, 56.166, 91.270, 133.394, 176.795, 214.452, 242.535]
VECTOR += [261.682, 275.086, 285.936]
BETWEEN = {50: 5.499, 300: 47.509, 500: 111.884, 555.5: 133.595, 700: 189.279, 1000: 261.820}
SCREWED = Rod(AT, ALPHA, 200.0, 1)
TURNED = Rod(AT, ALPHA, 900.0, -1)


def one_axis(found: Stretch) -> ThermalScrew:
    return ThermalScrew((found, None, None))


# --- numbers --------------------------------------------------------------------------------


def test_t1_the_published_screw():
    free = Rod(AT, ALPHA)
    assert 1000 * free.growth(WARM - COLD, AT) == pytest.approx(VECTOR, abs=1e-3)
    places = np.array(list(BETWEEN), dtype=float)
    assert 1000 * free.growth(WARM - COLD, places) == pytest.approx(
        list(BETWEEN.values()), abs=1e-3
    )
    assert 1000 * growth(700.0) == pytest.approx(BETWEEN[700], abs=1e-3)


@pytest.mark.parametrize(("rod", "expected"), [(SCREWED, 162.578), (TURNED, 168.688)])
def test_t3_both_senses(rod, expected, tmp_path):
    sense = {1: "1", -1: "-1"}[rod.sense]
    screw = f"[X.screw]\nnut = {rod.zero}\ndirection = {sense}\nhomed-at = 0.0\n"
    loaded = load_model(written(tmp_path, text(screw)))
    for model in (one_axis(stretch(rod, WARM - COLD, (0.0, 520.0))), loaded):
        assert along(model, 500.0) == pytest.approx(expected, abs=1e-3)
        assert along(model, 0.0) == pytest.approx(0.0, abs=1e-12)
        x = np.linspace(0, 520, 14)
        wanted = [
            1000 * rod.sense * (growth(rod.zero + rod.sense * v) - growth(rod.zero)) for v in x
        ]
        assert along(model, x) == pytest.approx(wanted, abs=1e-3)


def test_where_the_axis_was_homed_there_is_no_error(tmp_path):
    screw = "[X.screw]\nnut = 200.0\ndirection = 1\nhomed-at = 400.0\n"
    model = load_model(written(tmp_path, text(screw)))
    assert along(model, [400.0, 0.0]) == pytest.approx(
        [0.0, 1000 * (growth(200) - growth(600))], abs=1e-3
    )


def test_the_command_for_300_mm():
    """Geometry of -14.3 um on 480 mm is added, and the sum inverted."""
    scale = np.array([[0.0, 0, 0], [-0.0143, 0, 0]])
    geometry = AxisFunctions((AxisFunction(np.array([0.0, 480.0]), scale), None, None))
    model = Sum((geometry, one_axis(stretch(SCREWED, WARM - COLD, (0.0, 520.0)))))
    found = compensate(model, np.array([[300.0, 0.0, 0.0]])).position[0]
    assert found == pytest.approx([299.923781, 0.0, 0.0], abs=1e-6)


@pytest.mark.parametrize(
    ("stiffness", "largest"), [(200.0, 97.0), (500.0, 70.0), (1000.0, 55.0), (np.inf, 35.0)]
)
def test_a_screw_held_at_both_ends(stiffness, largest, tmp_path):
    """The published figures leave off what is less than 1 um; free it grows by 286 um."""
    held = Held(1000 * stiffness, 1000 * stiffness, HELD_SECTION, 1221.0)
    fine = np.linspace(0.0, 1221.0, 2443)
    grown = 1000 * Rod(AT, ALPHA, held=held).growth(WARM - COLD, fine)
    assert largest <= np.abs(grown).max() < largest + 1
    force = held.section * held.strain(growth(1221.0))
    assert grown[0] == pytest.approx(1000 * force / held.a, abs=1e-3)
    assert grown[-1] == pytest.approx(-1000 * force / held.b, abs=1e-3)
    ends = f"\n[X.screw.held]\nkA = {stiffness}\nkB = {stiffness}\n"
    ends += f"EA = {HELD_SECTION}\nlength = 1221.0\n"
    model = load_model(written(tmp_path, text(f"[X.screw]\n{SCREW}{ends}")))
    x = np.linspace(0, 520, 53)
    wanted = np.interp(200.0 + x, fine, grown) - np.interp(200.0, fine, grown)
    assert along(model, x) == pytest.approx(wanted, abs=2e-3)


def test_a_scale_grows_from_where_it_is_fixed(tmp_path):
    rod = "[X.scale]\nfixed-at = 150.0\n"
    model = load_model(written(tmp_path, text(rod, expansion="8e-6")))
    x = np.array([0.0, 150.0, 520.0])
    wanted = [1000 * (growth(v, alpha=8e-6) - growth(150.0, alpha=8e-6)) for v in x]
    assert along(model, x) == pytest.approx(wanted, abs=1e-3)
    assert wanted[0] < 0 < wanted[2]


def test_drift_is_5_75_um_per_kelvin_over_500_mm_of_steel(tmp_path):
    for rod in (SCREWED, TURNED):
        assert 1000 * drift(rod, (0.0, 500.0)) == pytest.approx(5.75, abs=1e-12)
    state = load_model(written(tmp_path, text(travel="[10.0, 510.0]"))).states[0]
    assert 1000 * state.drift == pytest.approx(5.75, abs=1e-9)
    assert (state.axis, state.time) == ("X", "2026-03-04T10:00:00")
    assert state.sensors == tuple(NAMES)
    assert state.temperatures == tuple(WARM)
    assert 1000 * state.largest == pytest.approx((growth(710) - growth(200)) * 1000, abs=1e-3)


def test_t4_what_a_control_makes_of_the_errors_at_the_sensors(tmp_path):
    bend = text(general='node-interpolation = "linear"', travel="[0.0, 600.0]")
    linear = load_model(written(tmp_path, bend))
    exact = load_model(written(tmp_path, text(travel="[0.0, 600.0]")))
    x = np.linspace(0, 600, 6001)
    off = np.abs(along(linear, x) - along(exact, x))
    assert 1.27 < off.max() <= 1.28
    nodes = AT[(AT > 200) & (AT < 800)] - 200
    assert along(linear, nodes) == pytest.approx(along(exact, nodes), abs=1e-9)
    assert not linear.curvature().any()
    assert np.array_equal(linear.nodes[0], exact.nodes[0])


# --- bounds; those of all models are in test_rigid.py -------------------------------------------


@settings(max_examples=40)
@given(st.integers(0, 10_000), st.sampled_from([1, -1]), st.booleans())
def test_a_stretch_is_the_error_of_its_rod(seed, sense, held):
    rng = np.random.default_rng(seed)
    at = np.cumsum(rng.uniform(20, 200, 6))
    zero = rng.uniform(at[0], at[-1])
    ends = Held(1e5, 4e5, HELD_SECTION, at[-1]) if held else None
    if held:
        at[0] = 0.0
    rod = Rod(at, ALPHA, zero, sense, 0.0, ends)
    warmer = rng.uniform(-20, 40, 6)
    low, high = sorted(rod.positions(rng.uniform(at[0], at[-1], 2)))
    if high - low < 1.0:
        return
    found = stretch(rod, warmer, (low, high))
    x = np.linspace(low, high, 200)
    assert found.at(x) == pytest.approx(rod.error(warmer, x), abs=1e-12)
    assert np.abs(found.at(x)).max() <= found.largest + 1e-15
    assert found.largest <= np.abs(found.at(np.linspace(low, high, 20_000))).max() + 1e-8
    slopes = np.diff(found.at(x)) / np.diff(x)
    assert np.abs(slopes).max() <= found.steepest * (1 + 1e-6) + 1e-12
    outer = np.array([low - 50.0, low - 10.0, low, high, high + 10.0, high + 50.0])
    slope = np.diff(found.at(outer)) / np.diff(outer)
    assert slope[0] == pytest.approx(slope[1], abs=1e-15)
    assert slope[-1] == pytest.approx(slope[-2], abs=1e-15)
    assert slope[1] == pytest.approx(found.slope[0], abs=1e-15)
    step = 1e-3 * (high - low)
    near = (found.at(np.array([high])) - found.at(np.array([high - step]))) / step
    assert slope[-1] == pytest.approx(near[0], abs=np.abs(found.bend).max() * step + 1e-12)


def test_bounds_that_are_reached():
    """Warmest at the far end: the steepest place is there, and all axes are farthest off there."""
    far = stretch(Rod(AT, ALPHA), np.linspace(0, 33, 12), (0.0, 1221.0))
    model = ThermalScrew((far, far, far))
    assert model.lipschitz() == pytest.approx(ALPHA * 33, rel=1e-9)
    assert model.curvature() == pytest.approx(np.eye(3) * ALPHA * 3 / PITCH, rel=1e-9)
    corner = model.error(np.full((1, 3), 1221.0))[0]
    assert corner == pytest.approx([ALPHA * 33 * 1221 / 2] * 3, rel=1e-9)
    assert model.largest() == pytest.approx(np.linalg.norm(corner), rel=1e-9)


@pytest.mark.parametrize("policy", Outside)
def test_policies_outside(policy):
    model = warm(3)
    beyond = np.array([[320.0, 0, 0], [0, 0, 0], [np.nan, 0, 0]])
    found = model.error(beyond, policy)
    border = model.error(np.array([[300.0, 0, 0]]))[0]
    assert np.array_equal(found[1], model.error(beyond)[1])
    assert np.isnan(found[2, 0])
    if policy is Outside.ZERO:
        assert not found[0].any()
    elif policy is Outside.CLAMP:
        assert np.array_equal(found[0], border)
    else:
        slope = model.axes[0].at(np.array([301.0]))[0] - border[0]
        assert found[0, 0] == pytest.approx(border[0] + 20 * slope, abs=1e-12)
    assert model.outside(beyond).tolist() == [[True, False, False], [False] * 3, [False] * 3]
