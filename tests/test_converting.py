"""Pitch tables, and from one kind of model to another (V6)."""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import pytest
from format_kit import apart, nine, pitch, rigid
from hypothesis import given
from hypothesis import strategies as st
from thermal_kit import warm

import gcxform as gx
from gcxform.diagnostics import UsageError
from gcxform.errormodel.converting import to_functions, to_lattice, to_nine, to_pitch
from gcxform.errormodel.lattice import Lattice
from gcxform.errormodel.linear import Linear
from gcxform.errormodel.model import Outside
from gcxform.errormodel.model_file import load_model
from gcxform.errormodel.model_text import to_toml
from gcxform.errormodel.pitch import PitchTable, PitchTables
from gcxform.errormodel.sum import Sum

SEEDS = st.integers(0, 10_000)


def inside(model, seed, count=200):
    low, high = np.transpose([np.clip(model.range_of(k), -1e3, 1e3) for k in range(3)])
    return np.random.default_rng(seed).uniform(low, high, (count, 3))


def test_t4_what_a_table_leaves_of_a_warm_screw_between_its_nodes():
    """Straight between the sensors it is off by up to alpha |rise of temperature| h / 8."""
    screw = warm(3)
    fit = to_pitch(screw)
    points = inside(screw, 4, 20_000)
    apart = np.linalg.norm(fit.model.error(points) - screw.error(points), axis=1).max()
    assert apart > 1e-4
    assert apart <= fit.largest < 1.05 * apart


@pytest.mark.parametrize("convert", [to_lattice, lambda m: to_functions(m).model])
def test_a_sum_becomes_no_larger_than_what_its_parts_have_in_common(convert):
    """What is beyond one of them was not measured, and no table may say that it was."""
    wide = rigid(1)
    low, high = wide.range_of(0)
    position = np.array([low + 1.0, (low + high) / 2.0, high - 1.0])
    narrow = PitchTable(position, *2 * [np.array([0.0, 0.01, -0.01])])
    both = Sum((wide, PitchTables((narrow, None, None))))
    made = convert(both)
    assert both.range_of(0) == (low + 1.0, high - 1.0)
    for axis in range(3):
        assert made.range_of(axis) == both.range_of(axis)
    points = inside(both, 5)
    assert made.error(points) == pytest.approx(both.error(points), abs=1e-12)


# --- pitch tables ---


@given(SEEDS, st.sampled_from([-1.0, 0.0, 1.0]))
def test_a_pitch_table_is_that_of_the_direction(seed, sense):
    model = pitch(seed)
    points = inside(model, seed)
    found = model.error(points, sense=np.full(points.shape, sense))
    for k, table in enumerate(model.axes):
        both = [np.interp(points[:, k], table.position, v) for v in (table.forward, table.reverse)]
        expected = {1.0: both[0], -1.0: both[1], 0.0: (both[0] + both[1]) / 2}[sense]
        assert found[:, k] == pytest.approx(expected, abs=1e-15)
    assert np.array_equal(model.error(points), model.error(points, sense=0 * points))


@given(SEEDS)
def test_the_bounds_of_pitch_tables(seed):
    model = pitch(seed, "XZ")
    points = inside(model, seed)
    for sense in itertools.product((-1.0, 1.0), repeat=3):
        senses = np.broadcast_to(sense, points.shape)
        found = model.error(points, sense=senses)
        assert np.linalg.norm(found, axis=1).max() <= model.largest() * (1 + 1e-12)
        moved = points + np.random.default_rng(1).uniform(-1e-3, 1e-3, points.shape)
        rise = np.linalg.norm(model.error(moved, sense=senses) - found, axis=1)
        assert (rise <= model.lipschitz() * np.linalg.norm(moved - points, axis=1) + 1e-15).all()


@pytest.mark.parametrize("policy", Outside)
def test_policies_of_pitch_tables(policy):
    model = pitch(3, "X")
    table = model.axes[0]
    end = table.position[-1]
    found = model.error(np.array([[end + 7.0, 0, 0]]), policy, sense=np.ones((1, 3)))[0, 0]
    slope = np.diff(table.forward)[-1] / np.diff(table.position)[-1]
    beyond = {Outside.ZERO: 0.0, Outside.CLAMP: table.forward[-1]}
    assert found == pytest.approx(beyond.get(policy, table.forward[-1] + 7.0 * slope), abs=1e-15)


def test_pitch_tables_read_back_to_the_bit(tmp_path):
    for seed in range(5):
        text = to_toml(pitch(seed, "XZ"))
        (tmp_path / "model.toml").write_text(text)
        assert to_toml(load_model(tmp_path / "model.toml")) == text


PITCH = 'format = 1\nkind = "pitch"\nvalues = "error"\n'
DEFECTS = {
    "no table": (PITCH, "GX422", 0),
    "short": (PITCH + "[X]\nposition=[0,1]\nforward=[0,0]\nreverse=[0]", "GX410", 7),
    "falls": (PITCH + "[X]\nposition=[1,0]\nforward=[0,0]", "GX408", 5),
    "nan": (PITCH + "[X]\nposition=[0,1]\nforward=[0,nan]", "GX412", 6),
    "steep": (PITCH + "[X]\nposition=[0,1]\nforward=[0,1]", "GX415", 0),
}


@pytest.mark.parametrize("name", DEFECTS)
def test_defects_of_pitch_files(tmp_path, name):
    text, code, line = DEFECTS[name]
    (tmp_path / "model.toml").write_text(text)
    with pytest.raises(UsageError) as caught:
        load_model(tmp_path / "model.toml")
    found = caught.value.diagnostics[0]
    assert (found.code, found.where and found.where.line) == (code, line)


def test_corrections_and_one_direction(tmp_path):
    text = PITCH.replace("error", "correction") + "[Y]\nposition=[0,100]\nforward=[0,0.01]"
    (tmp_path / "model.toml").write_text(text)
    model = load_model(tmp_path / "model.toml")
    assert model.error(np.array([[0, 50.0, 0]]))[0] == pytest.approx([0, -0.005, 0])
    assert not model.backlash.any()


# --- functions to lattice ---


@given(SEEDS, st.sampled_from(["XYZ", "YXZ", "ZYX"]))
def test_functions_become_a_lattice_without_loss(seed, order):
    """V6: at most 1e-12 mm at 500 points, with any tool."""
    model = rigid(seed, order)
    made = to_lattice(model)
    assert isinstance(made, Lattice)
    points = inside(model, seed, 500)
    assert np.abs(made.error(points) - model.error(points)).max() <= 1e-12
    tools = np.random.default_rng(seed).uniform(-200, 200, (500, 3))
    away = made.error(points, tool=tools) - model.error(points, tool=tools)
    assert np.abs(away).max() <= 1e-12


def test_a_lattice_holds_no_backlash_and_no_field_without_limits():
    with pytest.raises(UsageError, match="backlash of X and Y and Z"):
        to_lattice(pitch(1))
    skew = np.array([[0, 1e-5, 0], [0, 0, 0], [0, 0, 0]])
    with pytest.raises(UsageError, match="no positions on Y"):
        to_lattice(Linear(skew, np.zeros(3)))


# --- lattice to functions ---


@given(SEEDS, st.sampled_from(["XYZ", "YXZ", "ZYX"]))
def test_a_lattice_of_functions_becomes_functions_again(seed, order):
    model = rigid(seed, order)
    fit = to_functions(to_lattice(model), order)
    assert fit.largest < 1e-12
    points = inside(model, seed)
    tool = np.array([30.0, -20.0, -90.0])
    assert np.abs(fit.model.error(points, tool=tool) - model.error(points, tool=tool)).max() < 1e-11


@given(SEEDS)
def test_nine_functions_come_back(seed):
    model = nine(seed)
    fit = to_nine(to_lattice(model))
    assert fit.largest < 1e-14
    assert apart(fit.model, model) < 1e-14


@given(SEEDS)
def test_the_fit_is_the_least(seed):
    """The residual of least squares is at right angles to every sum of functions."""
    rng = np.random.default_rng(seed)
    shape = (3, 4, 2)
    grid = tuple(np.cumsum(rng.uniform(20, 60, n)) for n in shape)
    model = Lattice(grid, rng.normal(0, 0.01, (*shape, 3)))
    fit = to_nine(model)
    points = np.stack(np.meshgrid(*grid, indexing="ij"), axis=-1).reshape(-1, 3)
    left = (fit.model.error(points) - model.error(points)).reshape(*shape, 3)
    for axes in ((1, 2), (0, 2), (0, 1)):
        assert np.abs(left.sum(axis=axes)).max() < 1e-13
    size = np.linalg.norm(left, axis=-1)
    assert fit.largest == pytest.approx(size.max())
    assert fit.rms == pytest.approx(np.sqrt((size**2).mean()))


def test_another_order_leaves_something():
    model = rigid(4, "XYZ")
    assert to_functions(to_lattice(model), "ZYX").largest > 1e-4


def test_pitch_keeps_positioning_and_says_the_rest():
    model = nine(2)
    fit = to_pitch(model)
    rest = [f.values.copy() for f in model.axes]
    for k, values in enumerate(rest):
        values[:, k] = 0.0
    total = rest[0][:, None, None] + rest[1][None, :, None] + rest[2][None, None, :]
    assert fit.largest == pytest.approx(np.linalg.norm(total, axis=-1).max())
    assert all(
        np.array_equal(t.forward, f.values[:, k])
        for k, (t, f) in enumerate(zip(fit.model.axes, model.axes, strict=True))
    )


def test_what_is_converted_stays_what_it_is():
    for convert, model in ((to_functions, rigid(1)), (to_nine, nine(1)), (to_pitch, pitch(1))):
        assert convert(model).model is model
    example = load_model(Path(__file__).parents[1] / "examples" / "lddm" / "model.toml")
    assert isinstance(gx.to_lattice(example), gx.Lattice)
