"""Places where a compensation or its proof could go wrong: coincidences, borders, windows."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest
from gcxform_plugins.passes.volumetric.forward.lines import _farthest_reaching
from hypothesis import given
from hypothesis import strategies as st

import gcxform as gx
from gcxform.contract.options import ModelFile
from gcxform.errormodel.functions import AxisFunction, AxisFunctions
from gcxform.errormodel.rigid import RigidBody
from gcxform.errormodel.sum import Sum
from gcxform.plugin.registry import default_registry


def bent(travel=200.0, count=5, size=0.01, angle=0.0, seed=1) -> RigidBody | AxisFunctions:
    """Return a machine with nodes at round positions, about zero."""
    rng = np.random.default_rng(seed)
    position = np.linspace(-travel, travel, count)
    axes = []
    for _ in range(3):
        values = rng.normal(0, size, (count, 6)) * np.repeat([1.0, angle / size], 3)
        axes.append(AxisFunction(position, values if angle else values[:, :3]))
    return RigidBody(tuple(axes)) if angle else AxisFunctions(tuple(axes))


def volumetric(model, **options):
    step = default_registry().pass_("volumetric")
    options["outside"] = gx.Outside(options.get("outside", "error"))
    return step(
        model=ModelFile(Path("model.toml"), model, ""), part_origin=(0.0, 0.0, 0.0), **options
    )


def undone(step, program: str) -> gx.Toolpath:
    path = gx.read(program.encode(), "linuxcnc").path
    return step.undo(path, gx.Pipeline.parse("absolute", "linuxcnc").context)


HEAD = "G21 G90 G17 G94 G0 X100. Y0. Z0.\n"


@pytest.mark.parametrize("move", [
    "G2 X100. Y0. I-100. J0. F500.",
    "G3 X0. Y100. I-100. J0. F500.",
    "G1 X-100. Y-200. F500.",
    "G1 X-100. Y-200. Z200. F500.",
])  # fmt: skip
@pytest.mark.parametrize(("angle", "count"), [(0.0, 5), (2e-5, 5), (0.0, 11)])
def test_nodes_that_are_met_together_make_one_cut(move, angle, count):
    """A quarter of an arc is a node of one axis, and where it is divided anyway."""
    for size in np.geomspace(0.001, 0.01, 12):
        step = volumetric(bent(count=count, size=size, angle=angle), outside="extrapolate")
        path = undone(step, HEAD + move + "\n")
        assert len(path) > 2
        assert (path.sweep[path.is_arc] > 1e-6).all()
        length = np.sqrt(((path.end - path.start)[1:, :3] ** 2).sum(axis=1))
        assert (length > 1e-6).all()


# --- how far beyond the table ---


def refusal(step, program: str, back: bool = False) -> str:
    """Return why a path is refused, forward or back."""
    path = gx.read(program.encode(), "linuxcnc").path
    context = gx.Pipeline.parse("absolute", "linuxcnc").context
    with pytest.raises(gx.InputError) as caught:
        (step.undo if back else step.apply)(path, context)
    found = caught.value.diagnostics[0]
    assert found.code == "GX310"
    return f"{found.where.line}: {found.message}" if found.where else found.message


@pytest.mark.parametrize("back", [False, True])
def test_what_nobody_measured_is_refused_also_when_two_programs_are_compared(back):
    """`compare --model` and `show` go back alone: nothing was refused before."""
    said = refusal(volumetric(bent()), HEAD + "G1 X150. F500.\nY-300.\n", back)
    assert "Y -300.000 is outside the error table, which ends at -200" in said
    arc = "G1 X-100. F500.\nG2 X-100. Y0. I-60. J0.\n"  # its ends are inside
    assert "X -220.000 is outside" in refusal(volumetric(bent()), HEAD + arc, back)


def test_a_command_may_be_beyond_the_table_by_its_correction():
    path = undone(volumetric(bent()), HEAD + "G1 X200.1 F500.\n")
    assert np.isfinite(path.end).all()


@pytest.mark.parametrize("back", [False, True])
def test_a_sum_is_extrapolated_by_cells_of_each_of_its_models(back):
    """The narrow model has cells of 5 mm: 100 mm beyond it are twenty of them."""
    narrow = bent(travel=50.0, count=21)
    step = volumetric(Sum((bent(), narrow)), outside="extrapolate")
    said = refusal(step, HEAD.replace("X100.", "X40.") + "G1 X54. F500.\nX100.\n", back)
    assert "X 100.000 is outside the error table, which ends at 50, by more than 1 cell" in said


@pytest.mark.parametrize("back", [False, True])
def test_a_curved_field_is_extrapolated_by_one_cell_whatever_is_allowed(back):
    """What bounds its bending holds no farther."""
    far = HEAD + "G1 X350. F500.\n"
    straight = volumetric(bent(), outside="extrapolate", max_extrapolation=3.0)
    assert len(undone(straight, far)) > 1
    curved = volumetric(bent(angle=2e-5), outside="extrapolate", max_extrapolation=3.0)
    assert "by more than 1 cell" in refusal(curved, far, back)


# --- many nodes, unknown places ---


def test_a_line_across_a_thousand_nodes_takes_no_time_and_few_blocks():
    """Each stop was looked for from the far end: minutes for a line of a fine table."""
    rng = np.random.default_rng(1)
    position = np.linspace(-500.0, 500.0, 1001)
    function = AxisFunction(position, np.cumsum(rng.normal(0, 0.0005, (1001, 3)), axis=0))
    step = volumetric(AxisFunctions((function, None, None)), tolerance=0.0005)
    path = gx.read(b"G21 G90 G94 G0 X-400. Y0. Z0. F100\nG1 X400.\nX-400.\n", "linuxcnc").path
    begin = time.process_time()
    written = step.apply(path, gx.Pipeline.parse("absolute", "linuxcnc").context)
    assert time.process_time() - begin < 5.0
    assert 100 < len(written) < 1400


@given(st.integers(0, 10_000), st.integers(2, 40), st.floats(0.01, 1.0))
def test_pieces_reach_as_far_as_the_limit_lets_them(seed, count, limit):
    """Against looking from the far end, one place after the other."""
    rng = np.random.default_rng(seed)
    parts = np.sort(rng.uniform(0, 1, count))
    parts[[0, -1]] = 0.0, 1.0
    points = parts[:, None] * (5.0, 3.0, 0.0) + rng.normal(0, 0.2, (count, 3))

    def holds(at, to):
        share = (parts[at + 1 : to] - parts[at]) / (parts[to] - parts[at])
        way = points[at] + share[:, None] * (points[to] - points[at])
        return (np.linalg.norm(points[at + 1 : to] - way, axis=1) <= limit).all()

    expected, at = [], 0
    while at < count - 1:
        at = next(to for to in range(count - 1, at, -1) if holds(at, to))
        expected.append(at)
    assert _farthest_reaching(points, parts, limit) == expected[:-1]


def test_a_place_that_is_not_known_is_no_bug():
    path = undone(volumetric(bent(angle=2e-5)), "G21 G90 G17 G94 G0 X10. Y10.\nG1 X100. F500.\n")
    assert np.isnan(path.end[:, 2]).all()


@pytest.mark.parametrize("policy", ["extrapolate", "clamp"])
def test_v7_how_far_the_program_goes_beyond_the_tables_is_told(policy):
    """The table ends at 200 mm; an arc reaches to X -215, where none of its ends is."""
    step = volumetric(bent(), outside=policy)
    program = HEAD + "G1 X-170. F500.\nG3 X-170. Y-90. I0. J-45.\nG1 X0. Y0. Z230.5\nM2\n"
    pipeline = gx.Pipeline.parse("absolute", "linuxcnc")
    pipeline = gx.Pipeline(pipeline.source, pipeline.target, (*pipeline.passes, step))
    told = pipeline.run(program.encode()).certificate.measured
    assert told == pytest.approx(
        {
            f"X beyond the error table ({policy}), mm": 15.0,
            f"Z beyond the error table ({policy}), mm": 30.5,
        },
        abs=1e-6,
    )
    inside = pipeline.run((HEAD + "G1 X-170. F500.\nM2\n").encode())
    assert inside.certificate.measured == {}


@pytest.mark.parametrize(("seed", "tolerance"), [(7, 0.01), (10, 0.001)])
def test_nodes_that_are_met_one_after_the_other_of_a_steep_model(seed, tolerance):
    """Commands may meet two near nodes in another order than the straight way to the end does."""
    random = np.random.default_rng(seed)
    random.choice([2, 3])
    axes = []
    for _ in range(3):
        count = int(random.integers(4, 12))
        position = np.linspace(-60.0, 260.0, count)
        slope = random.uniform(-0.03, 0.03, (count - 1, 3)) / 1.7 * random.uniform(0.3, 1.0)
        values = np.vstack([np.zeros(3), np.cumsum(slope * (position[1] - position[0]), axis=0)])
        axes.append(AxisFunction(position, values - values[count // 4]))
    random.choice(5)
    points = random.uniform(0.0, 200.0, (8, 3)).round(3).tolist()
    program = "G21 G90 G17 G94\nG0 X0 Y0 Z0\nF500\n"
    program += "".join(f"G1 X{x:.3f} Y{y:.3f} Z{z:.3f}\n" for x, y, z in points) + "M2\n"
    step = volumetric(AxisFunctions(tuple(axes)), tolerance=tolerance, max_correction=20.0)
    dialect = default_registry().dialect("linuxcnc")
    result = gx.Pipeline(dialect, dialect, (step,)).run(program.encode())
    assert result.certificate.largest["deviation"] <= tolerance + 0.0001
