"""`gcxform simulate balls|ballbar-rtcp`: simulate, calibrate, find the truth again."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
from cli_kit import call

from gcxform.calibrate.bundle.bundle import Poses
from gcxform.calibrate.rotary.axis import Centres
from gcxform.calibrate.rotary.ball_file import balls_csv, poses_csv, read_poses
from gcxform.machine.chain import chain_of
from gcxform.machine.file import load_machine

MACHINE = """format = 1
table = ["A", "C"]

[axis.A]
direction = {a}
point = {pa}
sign = -1
limits = [-90.0, 90.0]

[axis.C]
direction = {c}
point = {pc}
sign = -1
"""
SET = {"a": [1.0, 0.0, 0.0], "pa": [5.0, -32.0, -95.0], "c": [0.0, 0.0, 1.0]}
TRUE = {"a": [1.0, 1.3e-4, 1.1e-4], "pa": [5.0, -31.966, -95.046], "c": [-5e-5, -8e-5, 1.0]}
GAUGE = "gauge-point = [3.0, 4.0, 50.0]"
SQUARE = 'format = 1\nkind = "skew"\nscale = [0.0, 2e-5, 0.0]\n[squareness]\nC0Y = 3e-5\n'


def machine(values, pc):
    return MACHINE.format(**values, pc=pc)


@pytest.fixture
def files(tmp_path, monkeypatch):
    """Go to a folder with the machine as it is set and as it is, and plans of both kinds."""
    monkeypatch.chdir(tmp_path)
    Path("set.toml").write_text(machine(SET, [5.0, -20.0, -60.0]))
    Path("true.toml").write_text(machine(TRUE, [5.015, -20.0638, -60.0]))
    rng = np.random.default_rng(4)
    degrees = np.column_stack([rng.uniform(-90, 90, 40), rng.uniform(0, 360, 40)]).round(1)
    points = np.where(np.arange(40)[:, None] % 2, (150.0, 20.0, 40.0), (-60.0, 140.0, 90.0))
    points = chain_of(load_machine(Path("set.toml"))).linear(points, degrees)
    plan = Poses(degrees, ("a", "b") * 20, points)
    Path("plan.csv").write_text(poses_csv(plan, "AC"))
    turn = Centres(np.arange(0.0, 360.0, 45.0), np.tile((150.0, 20.0, 40.0), (8, 1)))
    Path("turn.csv").write_text(balls_csv(turn))
    return tmp_path


def simulated(*words):
    done = call("simulate", *words)
    assert done.exit_code == 0, done.output
    return done.stdout


def calibrated(verb, *words):
    done = call("calibrate", verb, "-m", "set.toml", "-o", "new.toml", "--report", "r.json", *words)
    assert done.exit_code == 0, done.output
    return json.loads(Path("r.json").read_text())


def near(letters="AC"):
    """Check that the axes written are the true ones within 4.5 of their standard deviations."""
    report = json.loads(Path("r.json").read_text())
    found, true = (chain_of(load_machine(Path(f"{name}.toml"))) for name in ("new", "true"))
    for letter in letters:
        k = found.letters.index(letter)
        said = report.get("axes", {}).get(letter, report)
        one, other = found.axes[k], true.axes[k]
        sd = 4.5 * np.array(said["direction"]["sd"])
        assert (np.abs(np.subtract(one.direction, other.direction)) <= sd + 2e-8).all()
        away = np.subtract(one.point, other.point)
        away -= (away @ other.direction) * np.array(other.direction)
        assert (np.abs(away) <= 4.5 * np.array(said["point"]["sd"]) + 3e-5).all()
        assert np.abs(away).max() > 0.0


@pytest.mark.parametrize("seed", range(3))
def test_circular_tests_there_and_back(files, seed):
    words = ("--true", "true.toml", "--noise", "1um", "--seed", str(seed), "-o", "t.csv")
    off = ("--spindle-ball", "12 um,-9 um")
    simulated("ballbar-rtcp", "-m", "set.toml", "--ball", "155,-20,20", *off, *words)
    calibrated("ballbar", *off, "t.csv")
    near()


@pytest.mark.parametrize("seed", range(3))
def test_balls_at_poses_there_and_back(files, seed):
    """With squareness and a scale of the linear axes, which come back too."""
    Path("square.toml").write_text(SQUARE)
    true = Path("true.toml").read_text().replace("format = 1", 'format = 1\nerrors = "square.toml"')
    Path("true.toml").write_text(true)
    words = ("--true", "true.toml", "--noise", "2 um", "--seed", str(seed))
    Path("p.csv").write_text(simulated("balls", *words, "plan.csv"))
    report = calibrated("bundle", "p.csv")
    near()
    for name, value in (("scale Y - X", 2e-5), ("C0Y", 3e-5), ("A0Z", 0.0)):
        one = report["linear"][name]
        assert one["value"] == pytest.approx(value, abs=4.5 * one["sd"])
    assert report["linear"]["C0Y"]["sd"] < 5e-6


def test_one_axis_there_and_back(files):
    words = ("--true", "true.toml", "--noise", "2 um", "--seed", "1", "--axis", "C")
    Path("c.csv").write_text(simulated("balls", *words, "turn.csv"))
    calibrated("rotary", "--axis", "C", "c.csv")
    near("C")


def test_the_ball_stands_where_the_first_row_says(files):
    simulated("balls", "--true", "true.toml", "-o", "p.csv", "plan.csv")
    plan, read = (read_poses(Path(name), "AC").poses for name in ("plan.csv", "p.csv"))
    away = np.linalg.norm(read.points - plan.points, axis=1)
    assert away[:2].max() < 1e-9
    assert 0.02 < away.max() < 0.3


def test_the_seed_decides(files):
    one, same, other = (
        simulated("balls", "--true", "true.toml", "--noise", "2um", "--seed", s, "plan.csv")
        for s in ("1", "1", "2")
    )
    assert (one == same, one == other) == (True, False)


@pytest.mark.parametrize(
    ("words", "code", "exit_code"),
    [
        (["balls", "--axis", "B", "turn.csv"], "GX707", 2),
        (["balls", "-o", "plan.csv", "plan.csv"], "GX727", 2),
        (["balls", "--noise", "much", "plan.csv"], "GX708", 2),
        (["balls", "--noise", "-2um", "plan.csv"], "GX706", 2),
        (["balls", "turn.csv"], "GX470", 3),
        (["ballbar-rtcp", "-m", "other.toml", "--ball", "1,2,3"], "GX707", 2),
        (["ballbar-rtcp", "-m", "set.toml", "--ball", "1,2"], "GX702", 2),
    ],
)
def test_what_does_not_fit_is_refused(files, words, code, exit_code):
    other = Path("set.toml").read_text().replace('["A", "C"]', '["C"]').split("[axis.A]")
    Path("other.toml").write_text(other[0] + "[axis.C]" + other[1].split("[axis.C]")[1])
    done = call("simulate", words[0], "--true", "true.toml", *words[1:])
    assert (done.exit_code, code in done.stderr) == (exit_code, True), done.output


@pytest.mark.parametrize("tool", [(), ("--tool", "1")])
def test_a_probe_that_is_named_is_named_to_all(files, tool):
    """Plan, readings, one axis or all: X, Y and Z are of the tip, or with --tool of the axes."""
    machine = Path("set.toml").read_text().replace("format = 1", "format = 1\n" + GAUGE)
    Path("g.toml").write_text(machine + "[tool.1]\nlength = 87.5\n")
    plan = ("calibrate", "plan", "-m", "g.toml", *tool, "--ball", "40,120,-30")
    for axis, verb in ((("--axis", "A"), "rotary"), ((), "bundle")):
        call(*plan, *axis, "--ball=-60,90,30" if not axis else "--poses=7", "-o", "gp.csv")
        simulated("balls", "--true", "g.toml", *tool, *axis, "-o", "gr.csv", "gp.csv")
        words = ("-m", "g.toml", *axis, "--report", "r.json", "-o", "gf.toml", "gr.csv")
        done = call("calibrate", verb, *tool, *words)
        assert done.exit_code == 0, done.output
        assert "from where the machine file has it" not in done.stdout
        found = load_machine(Path("gf.toml")).axes["A"]
        off = np.cross(np.subtract(found.point, [0.0, -32.0, -95.0]), found.direction)
        assert np.linalg.norm(off) < 1e-3
        if tool:
            done = call("calibrate", verb, *words)
            assert re.search("axis A is 37.71 mm from where the machine file", done.stdout)


def test_a_ballbar_needs_an_axis_in_the_table(files):
    head = Path("set.toml").read_text().replace("table", "head")
    Path("head.toml").write_text(head)
    words = ("--true", "head.toml", "-m", "head.toml", "--ball", "1,2,3")
    done = call("simulate", "ballbar-rtcp", *words)
    assert (done.exit_code, "GX707" in done.stderr) == (2, True), done.output


def test_balls_beyond_the_error_model_are_refused(files):
    model = Path(__file__).parents[1] / "examples" / "lddm" / "model.toml"  # from 0 up
    true = Path("true.toml").read_text().replace("format = 1", f'format = 1\nerrors = "{model}"')
    Path("true.toml").write_text(true)
    done = call("simulate", "balls", "--allow-outside", "--true", "true.toml", "plan.csv")
    assert (done.exit_code, "GX738" in done.stderr) == (2, True), done.output
