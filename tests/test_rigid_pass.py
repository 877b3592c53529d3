"""`volumetric` with angular errors: the tip of a machine of exact matrices goes where it should.

The machine here is the chain of rigid bodies of `htm.py`: no code of the package, and no first
order. It walks along every command in small steps.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from htm import actual
from test_rigid import inside, lattice, rigid, scalar

import gcxform as gx
from gcxform.errormodel.model_file import load_model
from gcxform.errormodel.model_text import to_toml

OFFSET = np.array([-20.0, 30.0, -60.0])
LENGTH = 120.0
MACHINE = f"""\
format = 1
name = "mill"
[axis.X]
[axis.Y]
[axis.Z]
[work-offset.G54]
X = {OFFSET[0]}
Y = {OFFSET[1]}
Z = {OFFSET[2]}
[tool.1]
length = {LENGTH}
"""
PROGRAM = b"""\
G21 G17 G90 G94 G54
T1 M6
G43 H1
G0 X0. Y0. Z50.
G1 Z0. F500.
X210. Y-130. Z40.
X-180. Y160. Z-35.
G2 X-80. Y160. I50. J0.
G1 X150. Y-20. Z80.
M2
"""
SECOND_ORDER = 3e-5  # mm; what the model of first order leaves of the exact machine
STEPS = 60
AT = ((0.0, 1.0, 2.0), (3.0, 0.0, 4.0), (5.0, 6.0, 0.0))


def pipeline(folder: Path, model, options: str) -> gx.Pipeline:
    (folder / "model.toml").write_text(to_toml(model))
    (folder / "mill.toml").write_text(MACHINE)
    text = f"""\
format = 1
[input]
dialect = "linuxcnc"
[machine]
file = "mill.toml"
[[pass]]
use = "volumetric"
model = "model.toml"
{options}
[output]
dialect = "linuxcnc"
decimals = 5
"""
    (folder / "p.toml").write_text(text)
    return gx.Pipeline.load(folder / "p.toml")


def farthest(model, program: bytes, text: bytes, source_map) -> float:
    """Return how far (mm) the tip of the exact machine is from the program, anywhere."""
    functions = {a: scalar(f) for a, f in zip("XYZ", model.axes, strict=True)}
    pivots = {a: np.zeros(3) for a in "XYZ"}
    tool = np.array([0.0, 0.0, -LENGTH])
    wanted, told = gx.read(program, "linuxcnc").path, gx.read(text, "linuxcnc").path
    owner = np.array([source_map[line] for line in told.source])
    worst = 0.0
    for row in range(1, len(told)):
        of = np.flatnonzero(wanted.source == owner[row])[-1]
        for part in np.linspace(0, 1, STEPS):
            tip = point(told, row, part) + OFFSET
            gauge = tip - tool
            machine = actual("XYFZ", gauge, functions, pivots, tool)
            worst = max(worst, away(wanted, of, machine - OFFSET))
    return worst


def point(path, row, part):
    start, end = path.start[row, :3], path.end[row, :3]
    if path.kind[row] <= gx.Kind.LINE:
        return start + part * (end - start)
    return gx.points_on_arcs(path, np.array([row]), np.array([part]))[0]


def away(path, row, machine) -> float:
    start, end = path.start[row, :3], path.end[row, :3]
    if path.kind[row] > gx.Kind.LINE:
        centre = path.centre[row, :2]
        radius = math.dist(start[:2], centre)
        return math.hypot(math.dist(machine[:2], centre) - radius, machine[2] - end[2])
    if path.kind[row] == gx.Kind.RAPID or np.isnan(start).any():
        return 0.0
    way = end - start
    along = np.clip((machine - start) @ way / (way @ way), 0, 1)
    return math.dist(machine, start + along * way)


@pytest.mark.parametrize("tolerance", [None, 0.0005, 0.002, 0.01])
@pytest.mark.parametrize("seed", [1, 2])
def test_the_tip_of_the_exact_machine_stays_on_the_program(tmp_path, tolerance, seed):
    model = rigid(seed, size=0.004, angle=60e-6, tool=(0.0, 0.0, -30.0))
    functions = [f.values[:, 3:] for f in model.axes]
    assert max(np.abs(f).max() for f in functions) > 5e-5
    options = "" if tolerance is None else f"tolerance = {tolerance}"
    shifted = type(model)(model.axes, "XYZ", model.at, (0.0, 0.0, 0.0))
    result = pipeline(tmp_path, shifted, options).run(PROGRAM)
    found = farthest(shifted, PROGRAM, result.text, result.source_map)
    rounding = 0.5e-5 * math.sqrt(3)
    assert found <= (tolerance or 0.001) + rounding + SECOND_ORDER
    assert farthest(shifted, PROGRAM, PROGRAM, {k: k for k in range(20)}) > 0.01


def test_larger_tolerances_need_fewer_blocks(tmp_path):
    model = rigid(1, size=0.004, angle=60e-6)
    counts = []
    for tolerance in (0.0002, 0.001, 0.005):
        result = pipeline(tmp_path, model, f"tolerance = {tolerance}").run(PROGRAM)
        counts.append(len(result.text.splitlines()))
    assert counts == sorted(counts, reverse=True)
    assert counts[0] > counts[2]


@pytest.mark.parametrize("tolerance", [None, 0.001, 0.01])
def test_a_lattice_is_compensated_and_proved(tmp_path, tolerance):
    model = lattice(4, (6, 5, 4), turns=True)
    options = 'outside = "extrapolate"\n' + (f"tolerance = {tolerance}" if tolerance else "")
    result = pipeline(tmp_path, model, options).run(PROGRAM)
    assert result.certificate.largest["deviation"] <= (tolerance or 0.001) + 1e-4


def test_pieces_of_an_arc_are_as_far_from_their_centre_at_both_ends(tmp_path):
    """Also short ones, of which three points say little about the centre."""
    model = rigid(1, size=0.02, angle=100e-6)
    program = b"G21 G17 G90 G94 G54\nT1 M6\nG43 H1\nG0 X0 Y0 Z0\nF500\nG2 X0 Y0 I40\nM2\n"
    result = pipeline(tmp_path, model, "tolerance = 0.0002").run(program)
    path = gx.read(result.text, "linuxcnc").path
    rows = np.flatnonzero(path.is_arc)
    first, last, _ = gx.radius_and_angle(path, rows)
    assert (first * (1 - np.cos(path.sweep[rows] / 2)) < 0.1).any()
    assert np.abs(last - first).max() < 3e-5


def test_what_is_written_reads_back(tmp_path):
    for model in (rigid(3, "ZXY", AT, (1.0, 2.0, -90.0)), lattice(2)):
        path = tmp_path / "model.toml"
        path.write_text(to_toml(model))
        again = load_model(path)
        assert to_toml(again) == to_toml(model)
        points = inside(model, 1)
        tool = np.array([1.0, 2.0, 3.0])
        assert np.array_equal(again.error(points, tool=tool), model.error(points, tool=tool))


def test_carriages_that_move_the_workpiece(tmp_path):
    """A table that goes right by d carries the workpiece to the right: the tool is at the left."""
    text = """\
format = 1
kind = "axis-functions"
values = "error"
convention = "{}"
order = "{}"
tool = [0, 0, 0]
[X]
position = [0.0, 100.0]
EXX = [0.0, 0.01]
EYX = [0.0, 0.0]
EZX = [0.0, 0.0]
ECX = [0.0, 1e-4]
[Y]
position = [0.0, 100.0]
EXY = [0.0, 0.0]
EYY = [0.0, 0.0]
EZY = [0.0, 0.0]
[Z]
position = [0.0, 100.0]
EXZ = [0.0, 0.0]
EYZ = [0.0, 0.0]
EZZ = [0.0, 0.0]
"""
    found = {}
    for convention, order in (("relative", "XFYZ"), ("carriage", "XFYZ"), ("carriage", "FXYZ")):
        path = tmp_path / "model.toml"
        path.write_text(text.format(convention, order))
        found[convention, order] = load_model(path).error(np.array([[100.0, 50.0, 0.0]]))[0]
    # relative: the tool goes 10 um right and turns by 100 urad left over a lever of 50 mm in Y
    assert found["relative", "XFYZ"] == pytest.approx((0.01 - 1e-4 * 50, 0, 0))
    assert found["carriage", "FXYZ"] == pytest.approx((0.01 - 1e-4 * 50, 0, 0))
    # a table turned left under the tool, which is 100 mm to the right of its pivot and 50 mm up
    assert found["carriage", "XFYZ"] == pytest.approx((-0.01 + 1e-4 * 50, -1e-4 * 100, 0))
