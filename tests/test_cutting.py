"""Where `volumetric` cuts lines for a tolerance: for what is aside of the path, in few blocks."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path

import numpy as np
import pytest
from seeds_kit import LONG

import gcxform as gx

BENCHMARKS = Path(__file__).parents[1] / "benchmarks"
NODES = "[0.0, 4.0, 8.0]"
FLAT = "[0.0, 0.0, 0.0]"


def model(x: str = FLAT, y: str = FLAT, of: str = "X") -> str:
    """Return a model in which axis `of` has errors in X and Y."""
    lines = ["format = 1", 'kind = "axis-functions"', 'values = "error"']
    lines += ['convention = "relative"', 'order = "XYZ"']
    for axis in "XYZ":
        ex, ey = (x, y) if axis == of else (FLAT, FLAT)
        lines += [f"[{axis}]", f"position = {NODES}"]
        lines += [f"EX{axis} = {ex}", f"EY{axis} = {ey}", f"EZ{axis} = {FLAT}"]
    return "\n".join(lines)


def run(folder: Path, text: str, program: bytes, options: str = "") -> gx.Result:
    """Return what a run writes."""
    (folder / "model.toml").write_text(text)
    (folder / "p.toml").write_text(
        f"""\
format = 1
[input]
dialect = "linuxcnc"
start = {{ X = 0.0, Y = 0.0, Z = 0.0, A = 0.0 }}
[[pass]]
use = "volumetric"
model = "model.toml"
part-origin = [0.0, 0.0, 0.0]
{options}
[output]
decimals = 6
"""
    )
    return gx.Pipeline.load(folder / "p.toml").run(program)


def blocks(result: gx.Result) -> int:
    return len(gx.read(result.text, "linuxcnc").path)


PITCH = model(x="[0.0, 0.001, 0.0]")
MICROMETRE = 'tolerance = "0.3 um"'


@pytest.mark.parametrize(
    ("move", "options", "wanted"),
    [
        ("X8", MICROMETRE, 1),  # ahead of time in the middle, on the line
        ("X8", "", 2),  # without a tolerance lines are exact in their time
        ("X8 Y4", MICROMETRE, 2),  # now it is aside
        ("X8 A90", MICROMETRE, 2),  # the angle belongs to a place
    ],
)
def test_what_is_ahead_on_the_line_is_not_aside(
    tmp_path: Path, move: str, options: str, wanted: int
) -> None:
    program = f"G21 G90\nG1 {move} F100\nM2\n".encode()
    assert blocks(run(tmp_path, PITCH, program, options)) == wanted


def test_what_is_ahead_meets_another_error(tmp_path: Path) -> None:
    """The exact commands are on one line, but one that is ahead of them goes where Y is wrong.

    That is so where EYX = a (x + EXX): then y = -a t at the time t = x + EXX. With the middle node
    left out the machine is 0.02 x 0.04 mm = 0.8 um aside.
    """
    both = model(x="[0.0, 0.04, 0.0]", y="[0.0, 0.0808, 0.16]")
    program = b"G21 G90\nG1 X7.9 F100\nM2\n"
    result = run(tmp_path, both, program, MICROMETRE)
    assert blocks(result) == 2
    assert result.certificate.largest["deviation"] <= 0.0003


def test_a_flat_arc_under_a_steep_error_has_one_radius(tmp_path: Path) -> None:
    """Its ends are moved aside of the chord, so its centre cannot stay where it was."""
    steep = model(y="[0.0, 0.012, 0.024]")
    program = b"G21 G17 G90\nG0 X1 Y0\nG2 X6 Y0 I2.5 J-60 F100\nM2\n"
    result = run(tmp_path, steep, program, 'tolerance = "10 um"')
    path = gx.read(result.text, "linuxcnc").path
    rows = np.flatnonzero(path.is_arc)
    assert len(rows) == 1
    first, last, _ = gx.radius_and_angle(path, rows)
    assert abs(last - first)[0] < 3e-6
    plain = gx.read(program, "linuxcnc").path
    moved = (path.end[rows] - path.start[rows]) - (plain.end[rows] - plain.start[rows])
    assert abs(moved[0, 1]) > 0.01


def test_the_centre_of_a_flat_arc_of_two_radii_stays(tmp_path: Path) -> None:
    """The ends of a fine arc are rounded: a centre as far from both would be far away."""
    slight = model(y="[0.0, 0.00001, 0.00002]")
    program = b"G21 G17 G90\nG0 X1 Y0\nG2 X1.1 Y0.001 I0.05 J-60 F100\nM2\n"
    result = run(tmp_path, slight, program, 'tolerance = "1 um"')
    path = gx.read(result.text, "linuxcnc").path
    assert path.centre[-1, :2].tolist() == pytest.approx([1.05, -60.0], abs=1e-4)


@pytest.fixture(scope="module")
def cutting():
    """Load benchmarks/cutting.py."""
    sys.path.insert(0, str(BENCHMARKS))
    try:
        yield importlib.import_module("cutting")
    finally:
        sys.path.remove(str(BENCHMARKS))


def test_a_third_of_the_blocks_of_equal_pieces(cutting, tmp_path: Path) -> None:
    """On the linear example of LDDM and on real programs, at the residual of pieces of 10 mm."""
    cases = [case for case in cutting.cases() if case.checked]
    assert cases[0].name == "LDDM linear"
    for case in cases:
        many, off = cutting.fixed(case, tmp_path, 10.0)
        few, left = cutting.adaptive(case, tmp_path, off)
        assert left <= off + 1e-3, case.name
        assert 3 * few <= many, case.name
    if len(cases) < 4:
        pytest.skip("the real programs are not here")


@pytest.mark.parametrize("seed", range(4 if LONG else 2))
@pytest.mark.parametrize("tolerance", [0.2, 1.0, 5.0])
def test_the_fewest_blocks_are_not_more_than_are_written(
    cutting, tmp_path: Path, seed: int, tolerance: float
) -> None:
    """Pieces from one exact point to another are about twice those that may begin anywhere."""
    rng = np.random.default_rng(seed)
    ends = rng.uniform([-400, -300, -400], [400, 300, -50], (12, 3)).round(3)
    moves = "".join(f"X{x} Y{y} Z{z}\n" for x, y, z in ends.tolist())
    program = f"G21 G90 G0 X0 Y0 Z-100\nG1 F900\n{moves}M2\n".encode()
    case = cutting.Case("made up", program, "linuxcnc", cutting.RIGID, (0.0, 0.0, 0.0), True)
    written, off = cutting.adaptive(case, tmp_path, tolerance)
    path = gx.read(program, "linuxcnc").path
    least = cutting.fewest(path, cutting.load_model(case.model), np.zeros(3), tolerance / 1000)
    assert off <= tolerance + 1e-3
    assert least <= written <= 2.2 * least
