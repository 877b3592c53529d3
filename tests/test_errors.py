"""The model of nine functions, its inverse and the constants which bound it."""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcxform.diagnostics import InputError, UsageError
from gcxform.errormodel import functions as machine_functions
from gcxform.errormodel.functions import AxisFunction, AxisFunctions
from gcxform.errormodel.model import BLOCK, Outside, check_contraction, compensate
from gcxform.errormodel.model_file import load_model

LDDM = Path(__file__).parents[1] / "examples" / "lddm" / "model.toml"

# Published table, evaluated by hand: position and error in mm.
VECTORS = [
    ((48, 33, 45), (-0.000216, -0.0030475, 0.0017456)),
    ((100, 70, 80), (-0.001032370, -0.003928376, -0.001952458)),
    ((240, 165, 225), (0.0027802, -0.0048027, -0.0062673)),
    ((333.3, 200.1, 111.1), (-0.003155224, -0.010618645, -0.003039958)),
    ((480, 330, 450), (0.009546, 0.013862, -0.01339)),
]


@pytest.fixture(scope="module")
def lddm() -> AxisFunctions:
    model = load_model(LDDM)
    assert isinstance(model, AxisFunctions)
    return model


def axis(position, *values) -> AxisFunction:
    return AxisFunction(np.array(position, dtype=float), np.array(values, dtype=float))


def interpolated(model: AxisFunctions, point) -> np.ndarray:
    """The error at one point in mm, from the definition: slow and without shared code."""
    total = np.zeros(3)
    for function, c in zip(model.axes, point, strict=True):
        if function is None:
            continue
        nodes, values = function.position.tolist(), function.values.tolist()
        i = 0
        while i < len(nodes) - 2 and c >= nodes[i + 1]:
            i += 1
        part = (c - nodes[i]) / (nodes[i + 1] - nodes[i])
        for k in range(3):
            total[k] += values[i][k] + part * (values[i + 1][k] - values[i][k])
    return total


def inside(model, count=5000, seed=1) -> np.ndarray:
    low, high = np.transpose([model.range_of(k) for k in range(3)])
    return np.random.default_rng(seed).uniform(low, high, (count, 3))


# --- the published table ---------------------------------------------------------------------


@pytest.mark.parametrize(("position", "expected"), VECTORS)
def test_published_vectors(lddm, position, expected):
    """V2: the errors."""
    found = lddm.error(np.array([position], dtype=float))[0]
    assert found == pytest.approx(expected, abs=1e-9)


def test_published_command(lddm):
    """V2: the command."""
    command = compensate(lddm, np.array([[333.3, 200.1, 111.1]]))
    assert command.position[0] == pytest.approx(
        (333.303154449, 200.110617743, 111.103039873), abs=1e-9
    )
    assert command.steps <= 4


def test_published_bounds(lddm):
    assert lddm.lipschitz() == pytest.approx(2.017e-4, abs=5e-8)
    assert lddm.largest() == pytest.approx(0.03204, abs=5e-6)


def test_ranges_and_nodes(lddm):
    assert [lddm.range_of(k) for k in range(3)] == [(0, 480), (0, 330), (0, 450)]
    assert [len(n) for n in lddm.nodes] == [11, 11, 11]


def test_the_field_is_column_major_and_new(lddm):
    positions = inside(lddm, 10)
    first, second = lddm.error(positions), lddm.error(positions)
    assert first.shape == (10, 3)
    assert first.flags.f_contiguous
    assert not np.shares_memory(first, second)
    assert np.array_equal(first, lddm.error(np.asfortranarray(positions)))


def test_no_points(lddm):
    assert lddm.error(np.empty((0, 3))).shape == (0, 3)
    assert compensate(lddm, np.empty((0, 3))).position.shape == (0, 3)


def test_more_points_than_a_block(lddm):
    positions = inside(lddm, 2 * BLOCK + 7)
    found = lddm.error(positions)
    for row in (0, BLOCK - 1, BLOCK, 2 * BLOCK + 6):
        assert found[row] == pytest.approx(interpolated(lddm, positions[row]), abs=1e-15)
    command = compensate(lddm, positions)
    assert np.abs(command.position + lddm.error(command.position) - positions).max() < 1e-9


# --- against the definition ------------------------------------------------------------------

micrometres = st.integers(-50, 50).map(lambda um: um / 1000)


@st.composite
def functions(draw):
    count = draw(st.integers(2, 8))
    start = draw(st.integers(-3000, 3000)) / 10
    if draw(st.booleans()):
        step = draw(st.sampled_from([0.1, 1 / 3, 33.0, 48.0]))
        nodes = start + step * np.arange(count)
    else:
        gaps = draw(st.lists(st.floats(1.0, 90.0), min_size=count - 1, max_size=count - 1))
        nodes = start + np.concatenate([[0.0], np.cumsum(gaps)])
    values = draw(
        st.lists(st.tuples(*[micrometres] * 3), min_size=count, max_size=count).map(np.array)
    )
    return AxisFunction(nodes, values)


models = st.tuples(*[st.none() | functions()] * 3).map(AxisFunctions)
coordinates = st.floats(-2000, 2000)


@given(models, st.lists(st.tuples(*[coordinates] * 3), max_size=20), st.data())
def test_the_field_is_the_interpolation(model, points, data):
    nodes = [st.sampled_from(n.tolist()) if len(n) else coordinates for n in model.nodes]
    points += data.draw(st.lists(st.tuples(*nodes), max_size=5))
    found = model.error(np.array(points).reshape(-1, 3), Outside.EXTRAPOLATE)
    for point, error in zip(points, found, strict=True):
        expected = interpolated(model, point)
        assert error == pytest.approx(expected, abs=1e-12, rel=1e-9)


@given(functions())
def test_uniform_and_searched_cells_agree(function):
    searched = AxisFunction(function.position, function.values)
    object.__setattr__(searched, "_uniform", False)
    reach = np.ptp(function.position)
    points = np.concatenate(
        [function.position, np.linspace(-1, 2, 301) * reach + function.position[0]]
    )
    one, other = np.zeros((3, len(points))), np.zeros((3, len(points)))
    function.add_columns(one, points, range(3))
    searched.add_columns(other, points, range(3))
    assert one == pytest.approx(other, abs=1e-12, rel=1e-9)


def test_which_grids_are_uniform():
    def uniform(position):
        return axis(position, *np.zeros((len(position), 3)))._uniform

    assert uniform([0.1 * k for k in range(100)])
    assert uniform([0, 48, 96])
    assert not uniform([0, 33.333, 66.666, 100])
    assert not uniform([0, 1, 3])


# --- policies --------------------------------------------------------------------------------

RAMP = AxisFunctions((axis([0, 10, 30], (0, 0, 0), (0.001, 0.002, 0), (0.003, 0, 0)), None, None))


@pytest.mark.parametrize(
    ("policy", "x", "expected"),
    [
        (Outside.EXTRAPOLATE, -10, (-0.001, -0.002, 0)),
        (Outside.EXTRAPOLATE, 50, (0.005, -0.002, 0)),
        (Outside.ERROR, 50, (0.005, -0.002, 0)),
        (Outside.CLAMP, -10, (0, 0, 0)),
        (Outside.CLAMP, 50, (0.003, 0, 0)),
        (Outside.ZERO, 50, (0, 0, 0)),
        (Outside.ZERO, 30, (0.003, 0, 0)),
        (Outside.ZERO, 30 + 5e-10, (0.003, 0, 0)),
        (Outside.ZERO, 30 + 5e-9, (0, 0, 0)),
    ],
)
def test_policies(policy, x, expected):
    """V7: what each policy makes of a place outside."""
    found = RAMP.error(np.array([[x, 1e6, -1e6]], dtype=float), policy)[0]
    assert found == pytest.approx(expected, abs=1e-12)


def test_zero_is_zero_for_the_whole_vector(lddm):
    found = lddm.error(np.array([[100.0, 70.0, 451.0]]), Outside.ZERO)
    assert not found.any()


def test_outside_is_told_per_coordinate(lddm):
    positions = np.array(
        [[-1e-9, 330 + 1e-9, 0], [-2e-9, 331, 0], [np.nan, 0, 451], [480, -1, 450]], dtype=float
    )
    expected = [[0, 0, 0], [1, 1, 0], [0, 0, 1], [0, 1, 0]]
    assert np.array_equal(lddm.outside(positions), np.array(expected, dtype=bool))


def test_an_axis_without_functions_has_no_limits():
    assert RAMP.range_of(1) == (-np.inf, np.inf)
    assert not RAMP.outside(np.array([[0.0, 1e9, -1e9]])).any()
    assert [len(n) for n in RAMP.nodes] == [3, 0, 0]


@pytest.mark.parametrize("policy", Outside)
def test_an_unknown_coordinate_makes_the_error_unknown(lddm, policy):
    found = lddm.error(np.array([[np.nan, 70.0, 80.0], [100.0, 70.0, 80.0]]), policy)
    assert np.isnan(found[0]).all()
    assert np.isfinite(found[1]).all()


Z2 = np.zeros((2, 3))


@pytest.mark.parametrize("position", [[0, 10, 20], [0, 10, 30]])
def test_an_unknown_coordinate_without_error_does_no_harm(position):
    model = AxisFunctions((axis(position, *np.full((3, 3), 0.001)), axis([0, 9], *Z2), None))
    assert np.isfinite(model.error(np.array([[5.0, np.nan, np.nan]]))).all()
    assert np.isnan(model.error(np.array([[np.nan, 0.0, 0.0]]))).all()


# --- the constants ---------------------------------------------------------------------------


@given(models)
def test_the_lipschitz_constant_is_the_largest_spectral_norm(model):
    slopes = [np.zeros((1, 3)) if f is None else f.slope for f in model.axes]
    exact = max(np.linalg.norm(np.column_stack(s), 2) for s in itertools.product(*slopes))
    assert model.lipschitz() == pytest.approx(exact, rel=1e-6, abs=1e-300)
    bound = machine_functions._norm_bound(slopes)
    assert exact * (1 - 1e-12) <= bound <= 3 * exact


@given(models)
def test_the_largest_error_is_at_a_node(model):
    grid = [n if len(n) else np.zeros(1) for n in model.nodes]
    points = np.array(list(itertools.product(*grid)))
    exact = np.linalg.norm(model.error(points), axis=1).max()
    assert model.largest() == pytest.approx(exact, abs=1e-12)


def test_large_grids_use_bounds(lddm, monkeypatch):
    monkeypatch.setattr(machine_functions, "COMBINATIONS_AT_MOST", 50)
    coarse = AxisFunctions(lddm.axes)
    assert lddm.lipschitz() <= coarse.lipschitz() < 1.05 * lddm.lipschitz()
    assert lddm.largest() <= coarse.largest() < 2 * lddm.largest()


def test_a_model_in_micrometres_is_refused(lddm):
    check_contraction(lddm)
    wrong = AxisFunctions(tuple(axis(f.position, *(1000 * f.values)) for f in lddm.axes))
    with pytest.raises(UsageError) as caught:
        check_contraction(wrong)
    assert caught.value.diagnostics[0].code == "GX415"


def test_nodes_a_hair_apart_are_refused():
    close = axis([0, 5e-324, 1], (0, 0, 0), (1e-3, 0, 0), (0, 0, 0))
    with pytest.raises(UsageError, match="GX415"):
        check_contraction(AxisFunctions((close, None, None)))


# --- the inverse -----------------------------------------------------------------------------


@pytest.mark.parametrize("factor", [1, 30])
def test_fixed_point_keeps_its_bound(lddm, factor):
    """V8: after k steps it is within L^k |E| / (1 - L); 30 times the errors are |E| of 1 mm."""
    model = AxisFunctions(tuple(axis(f.position, *(factor * f.values)) for f in lddm.axes))
    target = inside(model)
    exact = compensate(model, target, iterations=20).position
    away = [np.linalg.norm(target - exact, axis=1).max()]
    away += [
        np.linalg.norm(compensate(model, target, iterations=k).position - exact, axis=1).max()
        for k in (1, 2, 3)
    ]
    for k, distance in enumerate(away):
        assert (
            distance <= model.lipschitz() ** k * model.largest() / (1 - model.lipschitz()) + 1e-12
        )


def test_one_iteration_is_target_minus_error(lddm):
    target = inside(lddm)
    command = compensate(lddm, target, iterations=1)
    assert np.array_equal(command.position, target - lddm.error(target))
    assert command.steps == 1
    assert command.position.flags.f_contiguous


def test_the_command_reaches_the_target(lddm):
    """V3: before rounding."""
    target = inside(lddm)
    kept = target.copy()
    command = compensate(lddm, target)
    assert np.abs(command.position + lddm.error(command.position) - target).max() < 1e-12
    assert command.steps == 3
    assert np.array_equal(target, kept)


def test_an_unknown_target_stays_unknown(lddm):
    target = np.array([[np.nan, 1.0, 2.0], [333.3, 200.1, 111.1]])
    command = compensate(lddm, target).position
    assert np.isnan(command[0]).any()
    assert command[1] == pytest.approx((333.303154449, 200.110617743, 111.103039873), abs=1e-9)


def test_a_jump_at_the_border_is_refused():
    # The error of -3 um asks for a command outside the table, where there is no error to correct.
    model = AxisFunctions((axis([0, 30], (0, 0, 0), (-0.003, 0, 0)), None, None))
    with pytest.raises(InputError) as caught:
        compensate(model, np.array([[5.0, 0.0, 0.0], [29.999, 7.0, 0.0]]), Outside.ZERO)
    assert caught.value.diagnostics[0].code == "GX309"
    assert "(29.999, 7, 0)" in caught.value.diagnostics[0].message


def test_a_divergent_model_does_not_loop():
    """V8: with L of 3 the fixed point is given up, and says so."""
    steep = AxisFunctions((axis([0, 1, 2], (0, 0, 0), (-3, 0, 0), (0, 0, 0)), None, None))
    assert steep.lipschitz() == pytest.approx(3)
    with pytest.raises(InputError, match="GX309"):
        compensate(steep, np.array([[0.5, 0.0, 0.0]]))


# --- construction ----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("position", "values", "code"),
    [
        ([0], [(0, 0, 0)], "GX411"),
        ([0, 1], [(0, 0, 0)], "GX410"),
        ([0, 0], Z2, "GX409"),
        ([1, 0], Z2, "GX408"),
        ([0, np.nan], Z2, "GX412"),
        ([0, 1], [(0, 0, 0), (0, np.inf, 0)], "GX412"),
    ],
)
def test_a_function_refuses_a_broken_table(position, values, code):
    with pytest.raises(UsageError) as caught:
        axis(position, *values)
    assert caught.value.diagnostics[0].code == code


def test_a_function_is_its_own_and_read_only():
    position, values = np.array([0.0, 1.0]), np.zeros((2, 3))
    function = AxisFunction(position, values)
    values[0, 0] = 1.0
    assert not function.values.any()
    with pytest.raises(ValueError, match="read-only"):
        function.values[0, 0] = 1.0
