"""`gcxform compare --model`: every kind of model, with and without a machine file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from cli_kit import call, workplace
from test_rigid import lattice, rigid
from test_rigid_pass import MACHINE, PROGRAM

from gcxform.errormodel.functions import AxisFunction, AxisFunctions
from gcxform.errormodel.linear import Linear
from gcxform.errormodel.model_text import to_toml

RIGID = rigid(1, size=0.01, angle=60e-6, tool=(0.0, 0.0, -30.0))
STRAIGHT = AxisFunctions(tuple(AxisFunction(f.position, f.values[:, :3]) for f in RIGID.axes))
SKEW = Linear(np.array([[1e-4, 2e-4, 0.0], [0.0, -1e-4, 1e-4], [0.0, 0.0, 3e-5]]), np.zeros(3))
SUM = 'format = 1\nkind = "sum"\nmodels = ["straight.toml", "skew.toml", "bed.toml"]\n'
BED = """\
format = 1
kind = "height-map"
X = [-400.0, 0.0, 400.0]
Y = [-400.0, 50.0, 400.0]
height = [[0.0, 0.03, -0.02], [0.01, 0.04, 0.02], [0.03, -0.03, 0.01]]
"""
SECOND = PROGRAM.replace(
    b"M2\n", b"G0 Z60.\nT2 M6\nG43 H2\nG55 G0 X0. Y0. Z60.\nG1 X40. Y-90. Z3. F500.\nX0.\nM2\n"
)
MILL = f"{MACHINE}[tool.2]\nlength = 40.0\n[work-offset.G55]\nX = -70.0\nY = 80.0\nZ = 20.0\n"
KINDS = ["rigid", "straight", "skew", "lattice", "bed", "sum"]


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    workplace(tmp_path, monkeypatch)
    models = {"rigid": RIGID, "straight": STRAIGHT, "skew": SKEW, "lattice": lattice(4, (6, 5, 4))}
    for name, model in models.items():
        (tmp_path / f"{name}.toml").write_text(to_toml(model))
    (tmp_path / "sum.toml").write_text(SUM)
    (tmp_path / "bed.toml").write_text(BED)
    (tmp_path / "mill.toml").write_text(MILL)
    (tmp_path / "part.nc").write_bytes(SECOND)
    return tmp_path


def compensated(model: str, *words: str) -> None:
    chain = f"volumetric model={model} outside=extrapolate"
    run = call("run", "-x", chain, "-f", "linuxcnc", "-m", "mill.toml", "-o", "out.nc", *words)
    assert run.exit_code == 0, run.stderr


def compared(model: str, *words: str) -> int:
    start = ("compare", "-f", "linuxcnc", "--tolerance", "2 um", "--model", model)
    found = call(*start, "--outside", "extrapolate", *words, "part.nc", "out.nc")
    assert found.exit_code in (0, 1), found.output + found.stderr
    assert ("SAME" in found.stdout) is (found.exit_code == 0)
    return found.exit_code


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_with_a_machine_file(here: Path, kind: str) -> None:
    """Two work offsets and two tools reach the model; another machine or model does not do."""
    compensated(f"{kind}.toml", "part.nc")
    assert compared(f"{kind}.toml", "-m", "mill.toml") == 0
    other = "skew" if kind != "skew" else "straight"
    assert compared(f"{other}.toml", "-m", "mill.toml") == 1
    moved = MILL.replace("X = -70.0", "X = 170.0")
    (here / "moved.toml").write_text(moved)
    assert compared(f"{kind}.toml", "-m", "moved.toml") == 1


def test_tool_lengths_reach_the_model(here: Path) -> None:
    compensated("rigid.toml", "part.nc")
    (here / "short.toml").write_text(MILL.replace("length = 40.0", "length = 240.0"))
    assert compared("rigid.toml", "-m", "short.toml") == 1


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_with_an_origin(here: Path, kind: str) -> None:
    lines = SECOND.replace(b"G43 H1\n", b"").partition(b"G0 Z60.")[0] + b"M2\n"
    (here / "part.nc").write_bytes(lines.replace(b"G54", b""))
    origin = "-20,30,-60"
    chain = f"volumetric model={kind}.toml outside=extrapolate part-origin={origin}"
    run = call("run", "-x", chain, "-f", "linuxcnc", "-o", "out.nc", "part.nc")
    assert run.exit_code == 0, run.stderr
    assert compared(f"{kind}.toml", "--part-origin", origin) == 0
    assert compared(f"{kind}.toml", "--part-origin", "60,30,-60") == 1


def test_without_an_origin_it_is_refused(here: Path) -> None:
    words = ("compare", "-f", "linuxcnc", "--model", "rigid.toml", "part.nc", "part.nc")
    found = call(*words)
    assert found.exit_code == 2
    assert "GX721" in found.stderr


PITCH = """\
format = 1
kind = "pitch"
values = "error"
[X]
position = [0.0, 100.0]
forward = [0.0, 0.01]
"""
LINE = b"G21 G90 G17 G94\nG1 X0. Y0. Z0. F100.\nG1 X%s.\nM2\n"


def run_and_compare(tmp_path, chain, *words):
    (tmp_path / "table.toml").write_text(PITCH + ("reverse = [0.002, 0.006]\n" * ("mean" in words)))
    run = call(
        "run", "-f", "grbl", "-x", f"volumetric model=table.toml {chain}", "-o", "o.nc", "l.nc"
    )
    assert run.exit_code == 0, run.stderr
    start = ("compare", "-f", "grbl", "--model", "table.toml", "--part-origin", "0,0,0")
    return call(*start, *words, "l.nc", "o.nc")


def test_backlash_is_compared_as_it_was_compensated(here, tmp_path):
    (tmp_path / "l.nc").write_bytes(LINE % b"80")
    found = run_and_compare(tmp_path, "part-origin=0,0,0 backlash=mean", "--backlash", "mean")
    assert (found.exit_code, "SAME" in found.stdout) == (0, True)


def test_far_beyond_the_table_is_compared_as_it_was_compensated(here, tmp_path):
    (tmp_path / "l.nc").write_bytes(LINE % b"240")
    chain = "part-origin=0,0,0 outside=extrapolate max-extrapolation=2"
    words = ("--outside", "extrapolate")
    found = run_and_compare(tmp_path, chain, *words, "--max-extrapolation", "2")
    assert (found.exit_code, "SAME" in found.stdout) == (0, True)
    found = run_and_compare(tmp_path, chain, *words)
    assert found.exit_code == 3
    assert found.stderr.startswith("o.nc:4:1: error[GX310]")
    assert "4 | G1 X239.976" in found.stderr


EVERYWHERE = """\
format = 1
kind = "axis-functions"
values = "error"
convention = "relative"
order = "XYZ"
[Y]
position = [-500.0, 500.0]
EXY = [0.0, 0.0]
EYY = [0.05, 0.05]
EZY = [0.0, 0.0]
"""
OWN = "G21 G17 G90 G94\nG0 X0 Y{} Z5\nG53 G0 X10 Y20\nG0 X30 Y{}\nG1 X90 F100\nM2\n"
FROM_OWN = "G21 G17 G90 G94\nG0 X0 Y{} Z5\nG53 G0 X10 Y20\nG1 X90 Y{} F100\nM2\n"


@pytest.mark.parametrize(
    ("source", "written", "same"),
    [
        (OWN.format(0, 20), OWN.format(-0.05, 19.95), True),
        (OWN.format(0, 20), OWN.format(-0.05, 20), False),
        (OWN.format(0, 20), OWN.format(-0.05, 19.95).replace("X10 Y20", "X10 Y19.95"), False),
        (FROM_OWN.format(0, 20), FROM_OWN.format(-0.05, 19.95), False),
    ],
)
def test_what_is_left_to_the_machine(here, source, written, same):
    """Points of the machine are compared by what is told, and feed moves by where they begin."""
    (here / "model.toml").write_text(EVERYWHERE)
    mill = "format = 1\n[work-offset.G54]\nX = 0.0\nY = 0.0\nZ = 0.0\n"
    (here / "mill.toml").write_text(mill)
    (here / "part.nc").write_text(source)
    (here / "out.nc").write_text(written)
    words = ("--model", "model.toml", "--part-origin", "0,0,0", "-m", "mill.toml")
    found = call("compare", "-f", "linuxcnc", *words, "part.nc", "out.nc")
    assert found.exit_code == int(not same), found.output
    assert "1 rapid of B left to the machine: off by up to 0.0500 mm" in found.stdout
