"""`gcxform calibrate plan` and `centres`: the conditioning promised, the limits, the programs."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from cli_kit import call
from oracles import rs274

import gcxform as gx
from gcxform.calibrate.bundle.bundle import Layout, bundle
from gcxform.calibrate.bundle.plan import Wanted, planned
from gcxform.calibrate.bundle.touching import sides
from gcxform.calibrate.rotary.axis import locate
from gcxform.calibrate.rotary.ball_file import read_balls, read_poses
from gcxform.machine.chain import chain_of
from gcxform.machine.file import load_machine

MACHINE = """format = 1
table = ["A", "C"]
[axis.X]
limits = [-105.0, 110.0]
[axis.Y]
limits = [-250.0, 250.0]
[axis.Z]
limits = [-250.0, 170.0]
[axis.A]
direction = [1.0, 0.0, 0.0]
point = [5.0, -32.0, -95.0]
sign = -1
limits = [-30.0, 110.0]
[axis.C]
direction = [0.0, 0.0, 1.0]
point = [5.0, -20.0, -60.0]
sign = -1
[tool.1]
length = 120.0
"""
BALLS = ((80.0, 60.0, -20.0), (-70.0, -60.0, 40.0))
BALL = [word for x, y, z in BALLS for word in ("--ball", f"{x},{y},{z}")]
RADIUS, CLEARANCE = 14.25, 4.0
SIZES = ("--radius", str(RADIUS), "--clearance", str(CLEARANCE))
LOW, HIGH = np.array([[-105.0, 110.0], [-250.0, 250.0], [-250.0, 170.0]]).T
PROBES = {"linuxcnc": "G38.2", "fanuc": "G31"}


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("m.toml").write_text(MACHINE)
    return tmp_path


def chain():
    machine = load_machine(Path("m.toml"))
    return chain_of(machine, machine.tools[1])


def plan(*words):
    done = call("calibrate", "plan", "-m", "m.toml", "--tool", "1", *BALL, *SIZES, *words)
    assert done.exit_code == 0, done.output
    return done.stdout


@pytest.mark.parametrize(
    ("count", "linear"), [(30, "differences"), (60, "differences"), (12, "none")]
)
def test_the_conditioning_is_as_promised(here, count, linear):
    """Of the readings that are then measured, on another machine and with noise."""
    said = plan("--poses", str(count), "--linear", linear, "--noise", "5 um", "-o", "p.csv")
    true = MACHINE.replace("[1.0, 0.0, 0.0]", "[1.0, 8e-5, -1.1e-4]").replace("-95.0", "-95.04")
    Path("true.toml").write_text(true)
    words = ("--true", "true.toml", "--tool", "1", "--noise", "5 um", "--seed", "3")
    assert call("simulate", "balls", *words, "-o", "read.csv", "p.csv").exit_code == 0
    found = bundle(chain(), read_poses(Path("read.csv"), "AC").poses, 0.005, linear)
    promised = float(re.search(r"condition ([\d.]+);", said)[1])
    assert promised < 12.0
    assert found.condition == pytest.approx(promised, rel=0.02, abs=0.06)
    for k, letter in enumerate("AC"):
        um, urad = map(float, re.search(rf"axis {letter}: \+- (\S+) um, (\S+) urad", said).groups())
        sd = np.sqrt(np.diag(found.covariance))[4 * k : 4 * k + 4] / found.scatter.factor
        assert um == pytest.approx(1e3 * sd[:2].max(), rel=0.06)
        assert urad == pytest.approx(1e6 * sd[2:].max(), rel=0.06)
    names = found.layout.names
    assert ("C0Y: +- " in said) == ("C0Y" in names)


def test_no_random_choice_is_as_good(here):
    """The determinant that is made large: above all of 100 choices out of the same candidates."""
    wanted = Wanted(20, 18.25, 80.0)
    best = planned(chain(), BALLS, wanted, 0.002)
    rng = np.random.default_rng(5)

    def worth(poses):
        design = Layout(best.layout.chain, poses, 5).design(best.unknowns)
        return np.linalg.slogdet(design.T @ design)[1]

    every = planned(chain(), BALLS, Wanted(200, 18.25, 80.0), 0.002).layout.poses
    poses = zip(every.ball, map(tuple, every.degrees.tolist()), strict=True)
    assert len(set(poses)) == 200
    others = []
    for _ in range(100):
        rows = rng.permutation(200)[:20]
        ball = tuple(every.ball[k] for k in rows)
        if len(set(ball)) == 2 and every.balls[0] == ball[0]:
            others.append(worth(type(every)(every.degrees[rows], ball, every.points[rows])))
    assert len(others) > 20
    assert worth(best.layout.poses) > max(others)


def test_all_poses_are_where_the_balls_are(here):
    """Forward, every position is at its ball; and the table is tilted no farther than asked."""
    plan("--poses", "50", "--tilt", "60", "-o", "p.csv")
    poses = read_poses(Path("p.csv"), "AC").poses
    tips, axis = chain().forward(poses.points, poses.degrees)
    places = np.array([BALLS[int(name) - 1] for name in poses.ball])
    assert np.abs(tips - places).max() < 9e-4
    assert np.degrees(np.arccos(axis[:, 2])).max() <= 60.0 + 1e-9
    assert np.degrees(np.arccos(axis[:, 2])).max() > 50.0
    assert poses.degrees[:, 0].min() >= -30.0
    assert set(poses.ball) == {"1", "2"}


@pytest.mark.parametrize("dialect", PROBES)
def test_the_program_stays_inside_the_limits_and_is_read(here, dialect):
    """By gcxform: every position of X, Y, Z, A and C; five touches a pose, from outside inwards."""
    plan("--poses", "40", "-o", "p.csv", "--program", "probe.nc", "--to", dialect)
    path = gx.read(Path("probe.nc"), dialect).path
    known = path.end[np.isfinite(path.end).all(axis=1)]
    assert len(known) > 40 * 20
    assert (known[:, :3] >= LOW).all()
    assert (known[:, :3] <= HIGH).all()
    tilts = known[:, path.axes.index("A")]
    assert -30.0 <= tilts.min() <= tilts.max() <= 110.0
    text = Path("probe.nc").read_text()
    assert text.count(f"\n{PROBES[dialect]} ") == 5 * 40
    assert call("check", "-f", dialect, "-m", "m.toml", "probe.nc").exit_code == 0


@pytest.mark.skipif(not rs274.available(), reason="rs274 is not installed")
def test_linuxcnc_reads_the_program_as_we_do(here):
    plan("--poses", "10", "-o", "p.csv", "--program", "probe.ngc")
    text = Path("probe.ngc").read_bytes()
    theirs = rs274.run(text).moves
    probes = [move for move in theirs if move.kind == "PROBE"]
    assert len(probes) == 50
    poses = read_poses(Path("p.csv"), "AC").poses
    for k, move in enumerate(probes):
        place = np.array([move.end[a] for a in "XYZ"])
        centre = poses.points[k // 5]
        assert np.linalg.norm(place - centre) == pytest.approx(RADIUS - CLEARANCE, abs=2e-3)
        start = np.array([move.start[a] for a in "XYZ"])
        assert np.linalg.norm(start - centre) == pytest.approx(RADIUS + CLEARANCE, abs=2e-3)
        assert [move.end["A"], move.end["C"]] == pytest.approx(poses.degrees[k // 5], abs=1e-3)


@pytest.mark.parametrize(("high", "said"), [("170.0", True), ("250.0", False)])
def test_a_table_that_lifts_balls_above_the_tip_is_said(here, high, said):
    """The first ball is 119 mm from A, and on the other side of C farther: above 170 on the way."""
    Path("m.toml").write_text(MACHINE.replace("170.0", high))
    plan("--poses", "12", "-o", "p.csv", "--program", "probe.ngc")
    assert ("(THE TABLE LIFTS BALLS" in Path("probe.ngc").read_text()) == said


def touched(text, probe, true):
    """Return the touches (n, 3): where each probing move meets the sphere about a true centre."""
    here, found = {}, []
    for line in text.splitlines():
        words = {a: float(v) for a, v in re.findall(r"([XYZ])(-?[\d.]+)", line.partition("(")[0])}
        start = np.array([here.get(a, 0.0) for a in "XYZ"])
        here |= words
        if not line.startswith(probe):
            continue
        end = np.array([here[a] for a in "XYZ"])
        way = (end - start) / np.linalg.norm(end - start)
        to = true[len(found) // 5] - start
        along = to @ way
        found.append(start + (along - np.sqrt(RADIUS**2 - to @ to + along**2)) * way)
        here |= dict(zip("XYZ", found[-1], strict=True))
    return np.array(found)


@pytest.mark.parametrize(("way", "room"), [("[1.0, 0.0, 0.0]", 2e-6), ("[0.96, 0.28, 0.0]", 1e-4)])
def test_touches_become_centres(here, way, room):
    """Balls that are 0.3 mm from where they were planned, and spheres exactly met.

    Rounded ends turn ways that are not at 45 degrees by 1e-4, and so touch 0.03 um beside.
    """
    Path("m.toml").write_text(MACHINE.replace("[1.0, 0.0, 0.0]", way))
    plan("--poses", "15", "-o", "p.csv", "--program", "probe.ngc")
    poses = read_poses(Path("p.csv"), "AC").poses
    true = poses.points + np.random.default_rng(2).uniform(-0.3, 0.3, (15, 3))
    touches = touched(Path("probe.ngc").read_text(), "G38.2", true)
    angles = np.repeat(poses.degrees, 5, axis=0)
    whole = [[*t, a, 0.0, c, 0.0, 0.0, 0.0] for t, (a, c) in zip(touches, angles, strict=True)]
    Path("t.txt").write_text("\n".join(" ".join(f"{v:.7f}" for v in row) for row in whole))
    words = ("-m", "m.toml", "--plan", "p.csv", "--radius", str(RADIUS), "-o", "c.csv", "t.txt")
    done = call("calibrate", "centres", *words)
    assert done.exit_code == 0, done.output
    found = read_poses(Path("c.csv"), "AC").poses
    assert np.abs(found.points - true).max() < room
    assert np.array_equal(found.degrees, poses.degrees)
    short = "\n".join(",".join(f"{v:.7f}" for v in row[:3]) for row in whole)
    Path("t.txt").write_text(short)
    assert call("calibrate", "centres", *words).exit_code == 0
    assert np.abs(read_poses(Path("c.csv"), "AC").poses.points - true).max() < room


def test_the_stylus_keeps_clear_of_the_post(here):
    """Sides half a right angle from where the table points; opposite ones beside each other."""
    for degrees in ([70.0, 0.0], [-25.0, 130.0], [0.0, 0.0]):
        ways = sides(chain(), np.array(degrees))
        post = np.radians(degrees[0])  # A turns the table left-handed about X
        level = np.array([0.0, np.sin(post), 0.0])
        assert np.abs(ways @ level) == pytest.approx(abs(np.sin(post)) * np.sqrt(0.5), abs=1e-12)
        assert ways[0] + ways[1] == pytest.approx(np.zeros(3), abs=1e-12)
        assert ways[0] @ ways[2] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda rows: rows[:-1], "74 touches are not 5 at each of 15 poses"),
        (lambda rows: [*rows[:7], rows[7].replace(" ", " x", 1), *rows[8:]], "the line is not X"),
        (lambda rows: [*rows[:7], rows[7] + " 1", *rows[8:]], "the line is not X"),
        (lambda rows: [*rows[5:], *rows[:5]], "stood at"),
        (lambda rows: rows, "the ball of pose "),
    ],
)
def test_touches_of_another_plan_are_refused(here, change, said):
    """GX492, by their number, their form and their angles."""
    plan("--poses", "15", "-o", "p.csv", "--program", "probe.ngc")
    poses = read_poses(Path("p.csv"), "AC").poses
    rows = [f"1 2 3 {a} 0 {c}" for a, c in np.repeat(poses.degrees, 5, axis=0)]
    Path("t.txt").write_text("\n".join(change(rows)))
    words = ("-m", "m.toml", "--plan", "p.csv", "--radius", "15")
    done = call("calibrate", "centres", *words, "t.txt")
    assert (done.exit_code, "GX492" in done.stderr, said in done.stderr) == (3, True, True)


@pytest.mark.parametrize(
    ("letter", "ball", "arc", "closed"),
    [
        ("C", (60.0, 40.0, -20.0), 360.0, True),
        ("C", (-70.0, -60.0, -20.0), 360.0, True),
        ("A", (20.0, 60.0, -20.0), 90.0, False),
        ("C", (100.0, 20.0, -20.0), None, False),
        ("C", (-84.0, -20.0, -20.0), None, False),  # all but what is about 180 degrees
    ],
)
def test_a_circle_of_one_axis(here, letter, ball, arc, closed):
    """Equal steps along all the arc that limits and tilt leave; as good as promised."""
    said = call(
        *("calibrate", "plan", "-m", "m.toml", "--tool", "1", "--axis", letter, *SIZES),
        *("--poses", "9", "--tilt", "60", "--ball", ",".join(map(str, ball)), "-o", "c.csv"),
    ).stdout
    centres = read_balls(Path("c.csv")).centres
    steps = np.diff(centres.degrees)
    assert steps == pytest.approx(np.full(8, steps[0]), abs=2e-3)
    if arc is not None:
        assert steps[0] * (9 if closed else 8) == pytest.approx(arc, abs=0.02)
    room = RADIUS + CLEARANCE
    assert (centres.points[:, :2] >= (LOW + room)[:2] - 1e-3).all()
    assert (centres.points <= HIGH - room + 1e-3).all()
    if arc is None:  # the largest arc: two more degrees on either side would not do
        turned = np.zeros((2, 2))
        turned[:, 1] = centres.degrees[[0, -1]] + (-1.1, 1.1)
        beyond = chain().linear(np.tile(ball, (2, 1)), turned)
        assert (beyond[:, 0] > 110.0 - room).all() or (beyond[:, 0] < -105.0 + room).any()
        assert steps[0] * 8 > (100.0 if ball[0] > 0.0 else 300.0)
    words = ("--true", "m.toml", "--tool", "1", "--axis", letter, "--noise", "2 um")
    assert call("simulate", "balls", *words, "-o", "r.csv", "c.csv").exit_code == 0
    found = locate(read_balls(Path("r.csv")).centres, 0.002)
    um, urad = map(float, re.search(r"\+- (\S+) um, (\S+) urad", said).groups())
    sd = np.sqrt(np.diag(found.covariance).clip(0.0))
    assert um == pytest.approx(1e3 * sd[:3].max(), rel=0.06)
    assert urad == pytest.approx(1e6 * sd[3:].max(), rel=0.06)
    assert f"condition {found.condition:.1f};" in said


def test_touches_of_a_circle_become_centres(here):
    words = ("-m", "m.toml", "--axis", "C")
    ball = ("--tool", "1", "--ball", "60,40,-20", *SIZES, "--poses", "8")
    made = ("-o", "c.csv", "--program", "probe.ngc")
    assert call("calibrate", "plan", *words, *ball, *made).exit_code == 0
    plan_of = read_balls(Path("c.csv")).centres
    true = plan_of.points + np.random.default_rng(2).uniform(-0.3, 0.3, (8, 3))
    touches = touched(Path("probe.ngc").read_text(), "G38.2", true)
    Path("t.txt").write_text("\n".join(" ".join(f"{v:.7f}" for v in row) for row in touches))
    more = ("--plan", "c.csv", "--radius", str(RADIUS), "-o", "d.csv", "t.txt")
    done = call("calibrate", "centres", *words, *more)
    assert done.exit_code == 0, done.output
    found = read_balls(Path("d.csv")).centres
    assert np.abs(found.points - true).max() < 2e-6
    assert np.array_equal(found.degrees, plan_of.degrees)


def test_each_touch_is_stored_where_that_is_asked_for(here):
    plan("-o", "p.csv", "--program", "a.nc", "--to", "fanuc", "--poses", "8", "--linear", "none")
    assert Path("a.nc").read_text().count("\nM0 (NOTE THE SKIP POSITION") == 40
    words = ("--after-touch", "M98 P9001", "--linear", "none")
    plan("-o", "p.csv", "--program", "a.nc", "--to", "fanuc", "--poses", "8", *words)
    assert Path("a.nc").read_text().count("\nM98 P9001\n") == 40


@pytest.mark.parametrize(
    ("change", "words", "code", "exit_code"),
    [
        (("-250.0, 170.0]", "-250.0, -60.0]"), [], "GX491", 2),
        (("[-105.0, ", "[30.0, "), ["--poses", "900"], "GX491", 2),
        (("", ""), ["--poses", "4"], "GX489", 3),
        (("", ""), ["--ball", "1,2"], "GX702", 2),
        (("", ""), ["-o", "m.toml"], "GX727", 2),
        (("", ""), ["--tool", "7"], "GX707", 2),
        (("", ""), ["--axis", "B"], "GX707", 2),
        (("", ""), ["--axis", "C"], "GX728", 2),
        (('["A", "C"]', '["C"]\nhead = ["A"]'), ["--program", "x.ngc"], "GX491", 2),
        (('["A", "C"]', "[]"), [], "GX452", 2),
    ],
)
def test_what_cannot_be_planned_is_refused(here, change, words, code, exit_code):
    Path("m.toml").write_text(MACHINE.replace(*change) if change[0] else MACHINE)
    done = call("calibrate", "plan", "-m", "m.toml", "--tool", "1", *BALL, *words)
    assert (done.exit_code, code in done.stderr) == (exit_code, True), done.output


def test_a_poor_plan_says_so(here):
    Path("m.toml").write_text(
        MACHINE.replace("[-30.0, 110.0]", "[-3.0, 3.0]").replace("170.0", "250.0")
    )
    said = plan("--poses", "20", "-o", "p.csv")
    assert "warning: badly conditioned (above 20 is poor)" in said
    Path("m.toml").write_text(MACHINE)
    assert "warning" not in plan("--poses", "20", "-o", "p.csv")
