"""The rigid-body model of 21 parameters, lattices and sums of models."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from htm import actual
from hypothesis import given, settings
from hypothesis import strategies as st
from seeds_kit import some
from thermal_kit import warm

from gcxform.errormodel.functions import AxisFunction, AxisFunctions
from gcxform.errormodel.lattice import Lattice
from gcxform.errormodel.linear import Linear
from gcxform.errormodel.model import Outside, compensate, reach_of
from gcxform.errormodel.rigid import RigidBody
from gcxform.errormodel.sum import Sum

ORDERS = ["".join(p) for p in itertools.permutations("XYZ")]
CHAINS = ["FXYZ", "XFYZ", "XYFZ", "XYZF", "YFXZ", "YXFZ", "ZFXY", "FZYX", "XFZY"]


def axis(rng, count=6, travel=500.0, size=0.01, angle=20e-6) -> AxisFunction:
    position = np.linspace(-travel, travel, count) + rng.uniform(-30, 30, count)
    values = np.hstack([rng.normal(0, size, (count, 3)), rng.normal(0, angle, (count, 3))])
    return AxisFunction(position, values)


def rigid(seed, order="XYZ", at=((0.0, 0.0, 0.0),) * 3, tool=(0.0, 0.0, 0.0), **kw) -> RigidBody:
    rng = np.random.default_rng(seed)
    return RigidBody(tuple(axis(rng, **kw) for _ in range(3)), order, at, tool)


def scalar(function: AxisFunction):
    """The functions of one axis at a position: np.interp, no code of the package."""

    def at(q):
        columns = [np.interp(q, function.position, column) for column in function.values.T]
        return np.array(columns[:3]), np.array(columns[3:])

    return at


def inside(model, seed, count=40) -> np.ndarray:
    low, high = np.transpose([model.range_of(k) for k in range(3)])
    return np.random.default_rng(seed).uniform(low, high, (count, 3))


def exact_error(model: RigidBody, chain: str, position, tool):
    functions = {a: scalar(f) for a, f in zip("XYZ", model.axes, strict=True)}
    pivots = {a: np.zeros(3) for a in "XYZ"}
    return actual(chain, position, functions, pivots, tool) - position - tool


@pytest.mark.parametrize("chain", CHAINS)
def test_v5_against_exact_matrices(chain):
    worst = 0.0
    for seed in range(5):
        model = rigid(seed, chain.replace("F", ""))
        tool = np.random.default_rng(seed).uniform(-200, 200, 3)
        for position in inside(model, seed, 20):
            found = model.error(position[None], tool=tool)[0]
            worst = max(worst, np.abs(found - exact_error(model, chain, position, tool)).max())
    assert 1e-8 < worst <= 2e-5


def test_v5_the_place_of_the_frame_does_not_matter_and_the_order_does():
    one, other = rigid(3, "XYZ"), rigid(3, "YXZ")
    points = inside(one, 3)
    frames = [[exact_error(one, c, p, np.zeros(3)) for p in points] for c in CHAINS[:4]]
    assert np.ptp(frames, axis=0).max() <= 1e-12
    assert np.abs(one.error(points) - other.error(points)).max() > 1e-3


def test_without_angular_errors_it_is_the_model_of_nine_functions():
    full = rigid(5, angle=0.0)
    points = inside(full, 5)
    flat = [AxisFunction(f.position, f.values[:, :3]) for f in full.axes]
    assert np.allclose(full.error(points), AxisFunctions(tuple(flat)).error(points), 0, 1e-16)
    assert not full.needs_tool


def test_a_tool_for_each_row():
    model = rigid(7, tool=(1.0, 2.0, -100.0))
    points = inside(model, 7)
    tools = np.random.default_rng(7).uniform(-150, 150, (len(points), 3))
    each = [model.error(p[None], tool=t)[0] for p, t in zip(points, tools, strict=True)]
    assert np.allclose(model.error(points, tool=tools), each, rtol=0, atol=1e-15)
    measured = np.array([1.0, 2.0, -100.0])
    assert np.array_equal(model.error(points, tool=measured), model.error(points))
    assert reach_of(model, tools) == pytest.approx(max(np.linalg.norm(t - measured) for t in tools))


def test_where_the_other_axes_stood_at_the_measurement():
    """Measured along the line at y = 100, z = -50 the functions of X hold on that line."""
    at = ((0.0, 100.0, -50.0), (0.0, 0.0, -50.0), (0.0, 0.0, 0.0))
    model = rigid(9, at=at)
    quiet = RigidBody(
        (model.axes[0], *(AxisFunction(f.position, 0 * f.values) for f in model.axes[1:])), at=at
    )
    x = np.linspace(*quiet.range_of(0), 7)
    line = np.column_stack([x, np.full(7, 100.0), np.full(7, -50.0)])
    straight = AxisFunctions(
        (AxisFunction(model.axes[0].position, model.axes[0].values[:, :3]),) + (None,) * 2
    )
    assert np.allclose(quiet.error(line), straight.error(line), rtol=0, atol=1e-15)
    above = line + np.array([0, 0, 30])
    pitch = np.array([scalar(model.axes[0])(q)[1] for q in x])
    lever = np.cross(pitch, (0, 0, 30))
    assert np.allclose(quiet.error(above) - quiet.error(line), lever, rtol=0, atol=1e-14)


# --- the bounds -----------------------------------------------------------------------------


def lattice(seed, shape=(3, 4, 2), turns=True) -> Lattice:
    rng = np.random.default_rng(seed)
    grid = tuple(
        np.linspace(-300, 300, n) + rng.uniform(-30, 30, n) if n > 1 else np.zeros(1) for n in shape
    )
    values = rng.normal(0, 0.01, (*shape, 3))
    return Lattice(grid, values, rng.normal(0, 2e-5, (*shape, 3)) if turns else None, (0.0,) * 3)


def derivative(model, point, tool, h=1e-4):
    steps = h * np.eye(3)
    columns = [
        (model.error((point + s)[None], tool=tool) - model.error((point - s)[None], tool=tool))[0]
        for s in steps
    ]
    return np.array(columns).T / (2 * h)


MODELS = [
    *(rigid(k, order) for k, order in enumerate(ORDERS)),
    lattice(1),
    lattice(2, (2, 1, 5)),
    Sum((rigid(1), lattice(1))),
    warm(1),
    warm(2),
    Sum((rigid(1), warm(3))),
]


@pytest.mark.parametrize("model", MODELS, ids=lambda m: f"{m.kind}-{getattr(m, 'order', '')}")
@pytest.mark.parametrize("reach", [0.0, 150.0])
def test_no_derivative_is_above_the_lipschitz_bound(model, reach):
    rng = np.random.default_rng(11)
    low, high = np.transpose([np.clip(model.range_of(k), -200, 200) for k in range(3)])
    largest = 0.0
    for point in rng.uniform(low, high, (len(some(300)), 3)):
        tool = rng.normal(size=3)
        tool *= reach / np.linalg.norm(tool)
        largest = max(largest, np.linalg.norm(derivative(model, point, tool), 2))
    assert 0.05 * model.lipschitz(reach) < largest <= model.lipschitz(reach) * (1 + 1e-6)


@pytest.mark.parametrize("model", MODELS, ids=lambda m: f"{m.kind}-{getattr(m, 'order', '')}")
@pytest.mark.parametrize("reach", [0.0, 150.0])
def test_chords_inside_a_cell_sag_by_less_than_the_bound(model, reach):
    rng = np.random.default_rng(13)
    nearest = 0.0
    for _ in range(200):
        ends = np.empty((2, 3))
        for k, nodes in enumerate(model.nodes):
            inner = nodes if len(nodes) else np.array([-50.0, 50.0])
            cell = rng.integers(len(inner) - 1)
            ends[:, k] = rng.uniform(inner[cell], inner[cell + 1], 2)
        tool = rng.normal(size=3)
        tool *= reach / np.linalg.norm(tool)
        part = np.linspace(0, 1, 21)[:, None]
        field = model.error(ends[0] + part * (ends[1] - ends[0]), tool=tool)
        sag = np.linalg.norm(field - (field[0] + part * (field[-1] - field[0])), axis=1).max()
        way = np.abs(ends[1] - ends[0])
        bound = way @ model.curvature(reach) @ way / 8
        assert sag <= bound * (1 + 1e-6) + 1e-15
        nearest = max(nearest, sag / max(bound, 1e-12))
    assert nearest > 0.05


@pytest.mark.parametrize("model", MODELS, ids=lambda m: f"{m.kind}-{getattr(m, 'order', '')}")
@pytest.mark.parametrize("cells", [0.0, 1.0, 2.5])
def test_no_turn_is_above_its_bound(model, cells):
    """What a lever adds, and how that changes, found by differences of the error alone."""
    rng = np.random.default_rng(17)
    low, high = np.transpose([np.clip(model.extended(k, cells), -900, 900) for k in range(3)])
    points = np.where(rng.random((400, 3)) < 0.3, low, rng.uniform(low, high, (400, 3)))
    lever = rng.normal(size=(400, 3))
    lever /= np.linalg.norm(lever, axis=1, keepdims=True)
    near = points + rng.normal(size=(400, 3)) * 0.01

    def turned(places):
        added = model.error(places, Outside.EXTRAPOLATE, lever)
        return added - model.error(places, Outside.EXTRAPOLATE, np.zeros(3))

    angle, slope = model.turning(cells)
    largest = np.linalg.norm(turned(points), axis=1).max()
    change = np.linalg.norm(turned(near) - turned(points), axis=1)
    steepest = (change / np.linalg.norm(near - points, axis=1)).max()
    if not model.needs_tool:
        assert (angle, slope) == (0.0, 0.0)
        return
    assert 0.1 * angle < largest <= angle * (1 + 1e-9)
    assert 0.02 * slope < steepest <= slope * (1 + 1e-6)


@pytest.mark.parametrize("model", MODELS, ids=lambda m: f"{m.kind}-{getattr(m, 'order', '')}")
def test_the_command_brings_the_tip_to_its_target(model):
    targets = np.random.default_rng(5).uniform(-100, 100, (50, 3))
    tools = np.random.default_rng(6).uniform(-100, 100, (50, 3))
    command = compensate(model, targets, Outside.EXTRAPOLATE, tool=tools).position
    reached = command + model.error(command, Outside.EXTRAPOLATE, tool=tools)
    assert np.abs(reached - targets).max() < 1e-9


# --- lattices --------------------------------------------------------------------------------


def test_v6_a_lattice_of_the_nodes_is_the_rigid_body():
    model = rigid(21, tool=(0.0, 0.0, -80.0))
    grid = model.nodes
    points = np.array(list(itertools.product(*grid)))
    shape = (*(len(n) for n in grid), 3)
    turns = np.zeros(shape)
    for k, function in enumerate(model.axes):
        turns += function.values[:, 3:].reshape([-1 if j == k else 1 for j in range(3)] + [3])
    twin = Lattice(grid, model.error(points).reshape(shape), turns, model.measured)
    some = inside(model, 21, 500)
    tools = np.random.default_rng(1).uniform(-200, 200, (500, 3))
    assert np.abs(twin.error(some) - model.error(some)).max() <= 1e-12
    assert np.abs(twin.error(some, tool=tools) - model.error(some, tool=tools)).max() <= 1e-12
    coarse = Lattice(tuple(n[::2] for n in grid), twin.values[::2, ::2, ::2], None, model.measured)
    low, high = np.transpose([coarse.range_of(k) for k in range(3)])
    some = np.clip(some, low, high)
    assert np.abs(coarse.error(some) - model.error(some)).max() > 1e-3


@settings(max_examples=30)
@given(st.integers(0, 10_000), st.tuples(*[st.integers(1, 4)] * 3))
def test_a_lattice_is_trilinear(seed, shape):
    model = lattice(seed, shape, turns=False)
    low, high = np.transpose([np.clip(model.range_of(k), -400, 400) for k in range(3)])
    point = np.random.default_rng(seed).uniform(low, high)
    cells, parts = [], []
    for k, nodes in enumerate(model.grid):
        cell = int(np.clip(np.searchsorted(nodes, point[k]) - 1, 0, max(len(nodes) - 2, 0)))
        cells.append((cell, min(cell + 1, len(nodes) - 1)))
        wide = nodes[cells[k][1]] - nodes[cell]
        parts.append((point[k] - nodes[cell]) / wide if wide else 0.0)
    expected = np.zeros(3)
    for corner in itertools.product((0, 1), repeat=3):
        weight = np.prod([p if c else 1 - p for c, p in zip(corner, parts, strict=True)])
        expected += weight * model.values[tuple(cells[k][c] for k, c in enumerate(corner))]
    assert model.error(point[None])[0] == pytest.approx(expected, abs=1e-15)


@pytest.mark.parametrize("policy", Outside)
def test_policies_outside(policy):
    model = rigid(2)
    beyond = np.array([[model.range_of(0)[1] + 20, 0, 0], [0, 0, 0]], dtype=float)
    border = beyond.copy()
    border[0, 0] = model.range_of(0)[1]
    found = model.error(beyond, policy)
    assert np.array_equal(found[1], model.error(beyond)[1])
    if policy is Outside.ZERO:
        assert not found[0].any()
    elif policy is Outside.CLAMP:
        assert np.array_equal(found[0], model.error(border)[0])
    else:
        inner = border - (model.axes[0].slope.shape[0] and np.array([[1.0, 0, 0], [0, 0, 0]]))
        slope = model.error(border)[0] - model.error(inner)[0]
        assert found[0] == pytest.approx(model.error(border)[0] + 20 * slope, abs=1e-12)


def test_a_skew_is_linear_and_has_no_limits():
    matrix = np.array([[1e-5, -2e-5, 3e-5], [0, 0, -4e-5], [0, 0, 0]])
    model = Linear(matrix, np.array([1.0, 2.0, 3.0]))
    points = np.random.default_rng(1).uniform(-1e3, 1e3, (9, 3))
    assert np.allclose(model.error(points), (points - (1, 2, 3)) @ matrix.T, rtol=0, atol=1e-15)
    assert model.lipschitz() == pytest.approx(np.linalg.norm(matrix, 2))
    assert not model.outside(1e9 * points).any()


def test_a_sum_is_the_sum():
    parts = rigid(1), lattice(1), Linear(1e-5 * np.eye(3), np.zeros(3))
    points = np.random.default_rng(1).uniform(-50, 50, (9, 3))
    expected = sum(m.error(points) for m in parts)
    assert np.allclose(Sum(parts).error(points), expected, rtol=0, atol=1e-15)
    assert Sum(parts).range_of(0) == (
        max(m.range_of(0)[0] for m in parts),
        min(m.range_of(0)[1] for m in parts),
    )
