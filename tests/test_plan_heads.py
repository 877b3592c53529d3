"""`gcxform calibrate plan` where the head turns: programs, what the probe keeps clear of, the loop.

Where tip and probe are on the workpiece is said by the matrices of scipy; LinuxCNC reads programs.
"""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from cli_kit import call
from kinematics_kit import matrices, tool
from oracles import rs274

import gcxform as gx
from gcxform.calibrate.bundle.bundle import bundle, moved
from gcxform.calibrate.bundle.clearance import clear, hangs, inside, least_height, upright
from gcxform.calibrate.bundle.plan import Wanted, planned
from gcxform.calibrate.bundle.touching import sides
from gcxform.calibrate.rotary.axis import locate
from gcxform.calibrate.rotary.ball_file import read_balls, read_poses
from gcxform.machine.chain import Chain, Rotary, chain_of
from gcxform.machine.file import load_machine
from gcxform.simulate.balls import simulate_poses

AXES = {
    "fork": 'head = ["C", "A"]',
    "b-head": 'table = ["C"]\nhead = ["B"]',
    "a-table-b-head": 'table = ["A"]\nhead = ["B"]',
    "nutating": 'head = ["C", "B"]',
    "tail": 'head = ["B"]',
}
MACHINE = """format = 1
{sides}
[axis.X]
limits = [-420.0, 430.0]
[axis.Y]
limits = [-410.0, 400.0]
[axis.Z]
limits = [-400.0, 300.0]
{axes}
[tool.1]
length = 120.0
x = 0.4
"""
AXIS = """[axis.{letter}]
direction = {direction}
point = {point}
sign = {sign}
limits = {limits}
"""
POINTS = {"A": [3.0, -8.0, 150.0], "B": [-6.0, 4.0, 150.0], "C": [2.0, -5.0, -60.0]}
WAYS = {"A": [1.0, 0.0, 0.0], "B": [0.0, 1.0, 0.0], "C": [0.0, 0.0, 1.0]}
LEANING = [0.0, 0.7071067811865475, 0.7071067811865476]
BALLS = ((80.0, 60.0, -220.0), (-90.0, -70.0, -190.0))
BALL = [word for x, y, z in BALLS for word in ("--ball", f"{x},{y},{z}")]
RADIUS, CLEARANCE = 14.25, 4.0
OUTSIDE = RADIUS + CLEARANCE
SIZES = ("--radius", str(RADIUS), "--clearance", str(CLEARANCE))
LOW, HIGH = np.array([[-420.0, 430.0], [-410.0, 400.0], [-400.0, 300.0]]).T
PROBES = {"linuxcnc": "G38.2", "fanuc": "G31"}
STEPS = np.array([[0.031, -0.024, 9e-5, -1.3e-4], [-0.027, 0.035, -1.1e-4, 8e-5]])
"""How far the true axes are shifted (2, mm) and tilted (2, rad) from those of the machine file."""


def machine_text(kind):
    parts = []
    turning = re.findall('"([ABC])"', AXES[kind])
    for letter in turning:
        in_table = (kind, letter) in (("a-table-b-head", "A"), ("b-head", "C"))
        limits = {"A": [-70.0, 75.0], "B": [-95.0, 100.0], "C": [-180.0, 180.0]}[letter]
        nutating = kind == "nutating" and letter == "B"
        point = [5.0, -30.0, -250.0] if in_table and letter == "A" else POINTS[letter]
        parts.append(
            AXIS.format(
                letter=letter,
                direction=LEANING if nutating else WAYS[letter],
                point=point,
                sign=-1 if in_table else 1,
                limits=[-165.0, 170.0] if nutating else limits,
            )
        )
    return MACHINE.format(sides=AXES[kind], axes="".join(parts))


@pytest.fixture(params=["fork", "b-head", "a-table-b-head", "nutating"])
def kind(request, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("m.toml").write_text(machine_text(request.param))
    return request.param


def chain(file="m.toml"):
    machine = load_machine(Path(file))
    return chain_of(machine, machine.tools[1])


def true_chain():
    believed = chain()
    axes = [moved(a, step) for a, step in zip(believed.axes, STEPS, strict=False)]
    count = len(believed.table)
    return replace(believed, table=tuple(axes[:count]), head=tuple(axes[count:]))


def plan(*words, balls=BALL):
    done = call("calibrate", "plan", "-m", "m.toml", "--tool", "1", *balls, *SIZES, *words)
    assert done.exit_code == 0, done.output
    return done.stdout


def blocks(text):
    """Yield each block that moves: its code, the axes before and behind it, the pose (from 0)."""
    here, pose = {}, -1
    for line in text.splitlines():
        pose += line.startswith("(POSE ")
        code = line.partition(" ")[0]
        if code not in ("G0", "G1", *PROBES.values()):
            continue
        before = dict(here)
        here |= {a: float(v) for a, v in re.findall(r"([XYZABC])(-?[\d.]+)", line)}
        yield code, before, dict(here), pose
        if code in PROBES.values():  # it stops before: whatever moved is not known
            here = {a: v for a, v in here.items() if before[a] == v}


def standing(state, letters):
    return np.array([state[a] for a in "XYZ"]), np.array([state[a] for a in letters])


def touched(text, truth, places, names, noise=0.0, seed=4):
    """Return the touches (n, 6): where probing moves of a true machine meet spheres about balls."""
    rng, found = np.random.default_rng(seed), []
    for code, before, after, _ in blocks(text):
        if code not in PROBES.values():
            continue
        start, angles = standing(before, truth.letters)
        end, same = standing(after, truth.letters)
        assert np.array_equal(angles, same)
        tips = tool(truth, np.array([start, end]), np.array([angles, angles]))[0]
        way = (tips[1] - tips[0]) / np.linalg.norm(tips[1] - tips[0])
        to = places[names[len(found) // 5]] - tips[0]
        along = to @ way
        share = (along - np.sqrt(RADIUS**2 - to @ to + along**2)) / np.linalg.norm(
            tips[1] - tips[0]
        )
        assert 0.0 < share < 1.0
        place = start + share * (end - start) + noise * rng.standard_normal(3)
        found.append([*place, *(after.get(a, 0.0) for a in "ABC")])
    return np.array(found)


def true_places(truth, poses):
    """Return where each ball is on the true workpiece: where its first pose finds it."""
    tips = tool(truth, poses.points, poses.degrees)[0]
    return {name: tips[poses.ball.index(name)] for name in poses.balls}


def write_touches(touches):
    Path("t.txt").write_text("\n".join(" ".join(f"{v:.7f}" for v in row) for row in touches))


# --- the loop ---


@pytest.mark.parametrize("dialect", PROBES)
def test_from_the_plan_to_the_true_axes(kind, dialect):
    """Plan, program, touches of the true machine, centres, bundle: within its uncertainty."""
    plan("--poses", "45", "-o", "p.csv", "--program", "probe.nc", "--to", dialect)
    poses, truth = read_poses(Path("p.csv"), chain().letters).poses, true_chain()
    places = true_places(truth, poses)
    text = Path("probe.nc").read_text()
    assert text.count(f"\n{PROBES[dialect]} ") == 5 * 45
    write_touches(touched(text, truth, places, poses.ball, noise=0.002))
    words = ("-m", "m.toml", "--plan", "p.csv", "--radius", str(RADIUS), "-o", "c.csv", "t.txt")
    done = call("calibrate", "centres", *words)
    assert done.exit_code == 0, done.output
    words = ("-m", "m.toml", "--tool", "1", "--noise", "2 um", "-o", "found.toml", "c.csv")
    done = call("calibrate", "bundle", *words)
    assert done.exit_code == 0, done.output
    found = bundle(chain(), read_poses(Path("c.csv"), chain().letters).poses, 0.002)
    sd = np.sqrt(np.diag(found.covariance)[:8]) / found.scatter.factor
    assert np.abs((found.unknowns[:8] - STEPS.ravel()) / sd).max() < 4.0
    assert np.abs(STEPS.ravel() / sd).min() > 5.0  # none of them is taken for nothing
    for written, axis in zip(chain("found.toml").axes, found.chain.axes, strict=True):
        assert written.direction == pytest.approx(axis.direction, abs=2e-7)
        apart = np.cross(np.subtract(written.point, axis.point), axis.direction)
        assert np.linalg.norm(apart) < 2e-4


def test_touches_are_where_the_simulation_has_the_centres(kind):
    """Without noise: two ways to the same centres, one of them through every block."""
    plan("--poses", "24", "-o", "p.csv", "--program", "probe.ngc")
    poses, truth = read_poses(Path("p.csv"), chain().letters).poses, true_chain()
    text = Path("probe.ngc").read_text()
    write_touches(touched(text, truth, true_places(truth, poses), poses.ball))
    words = ("-m", "m.toml", "--plan", "p.csv", "--radius", str(RADIUS), "-o", "c.csv", "t.txt")
    assert call("calibrate", "centres", *words).exit_code == 0
    found = read_poses(Path("c.csv"), chain().letters).poses
    assert np.abs(found.points - simulate_poses(truth, poses).points).max() < 1e-4
    assert np.abs(found.points - poses.points).max() > 0.02


@pytest.mark.parametrize("tilt", ["80", "45"])
def test_one_axis_of_a_head_by_a_circle(tmp_path, monkeypatch, tilt):
    """The same for `calibrate rotary`."""
    monkeypatch.chdir(tmp_path)
    Path("m.toml").write_text(machine_text("tail"))
    words = ("-o", "c.csv", "--program", "probe.nc", "--axis", "B", "--tilt", tilt, "--poses", "11")
    said = plan(*words, balls=BALL[:2])
    planned_ones, truth = read_balls(Path("c.csv")).centres, true_chain()
    assert np.ptp(planned_ones.degrees) == pytest.approx(2 * float(tilt), abs=2.0)
    place = tool(truth, planned_ones.points[:1], planned_ones.degrees[:1, None])[0][0]
    text = Path("probe.nc").read_text()
    write_touches(touched(text, truth, {"1": place}, ["1"] * 11, noise=0.001))
    words = ("-m", "m.toml", "--axis", "B", "--plan", "c.csv", "--radius", str(RADIUS))
    assert call("calibrate", "centres", *words, "-o", "d.csv", "t.txt").exit_code == 0
    words = ("-m", "m.toml", "--axis", "B", "--tool", "1", "--noise", "1 um", "-o", "found.toml")
    done = call("calibrate", "rotary", *words, "d.csv")
    assert done.exit_code == 0, done.output
    found = locate(read_balls(Path("d.csv")).centres, 0.001, chain().tip)
    axis = truth.axes[0]
    sd = np.sqrt(np.diag(found.covariance).clip(0.0))
    assert (np.abs(found.direction - axis.direction) <= 4.0 * sd[3:] + 1e-9).all()
    apart = np.cross(found.point - axis.point, axis.direction)
    assert np.linalg.norm(apart) < 4.0 * np.linalg.norm(sd[:3])
    assert np.linalg.norm(np.subtract(axis.point, chain().axes[0].point)) > 0.03
    assert "axis B: 11 centres" in said


# --- what the probe keeps clear of ---


def gaps(tip, axis, ball):
    """Return how far the probe (n, tips and axes) is from a ball's centre, and from its post."""
    behind = np.arange(0.0, 300.0, 3.0)
    probe = tip[:, None] + behind[:, None] * axis[:, None]
    to = probe - ball
    down = to + np.clip(-to[..., 2:], 0.0, None) * (0.0, 0.0, 1.0)
    return np.linalg.norm(to, axis=2).min(axis=1), np.linalg.norm(down, axis=2).min(axis=1)


def test_the_probe_keeps_clear_of_balls_and_posts(kind):
    """At 40 places of each move on the workpiece; only a probing move goes nearer, from outside."""
    plan("--poses", "24", "-o", "p.csv", "--program", "probe.ngc", "--tilt", "75")
    poses, believed = read_poses(Path("p.csv"), chain().letters).poses, chain()
    places, count, nearest = np.array(BALLS), 0, []
    for code, before, after, pose in blocks(Path("probe.ngc").read_text()):
        if len(before) < 5 or any(before.get(a) != after[a] for a in believed.letters):
            continue
        known = {**after, **before}
        start, angles = standing(known, believed.letters)
        end, _ = standing(after, believed.letters)
        shares = np.linspace(0.0, 1.0, 40)[:, None]
        probing = code in PROBES.values()
        own = int(poses.ball[pose]) - 1
        count += probing
        if probing:  # to where it touches
            shares *= CLEARANCE / np.linalg.norm(end - start)
        tip, axis = tool(believed, start + shares * (end - start), np.tile(angles, (40, 1)))
        for k, place in enumerate(places):
            ball, post = gaps(tip, axis, place)
            if probing and k == own:
                assert ball[0] == pytest.approx(OUTSIDE, abs=2e-3)
                assert ball.min() > RADIUS - 2e-3
                nearest.append(post.min())
            else:
                assert ball.min() > OUTSIDE - 2e-3
                assert post.min() > OUTSIDE * (np.sqrt(0.5) if k == own else 1.0) - 2e-3
    assert count == 5 * 24
    assert min(nearest) > RADIUS * np.sqrt(0.5)


def test_turning_is_above_all_balls(kind):
    """Every axis at its own angle between those of two poses: the tip has the room of a touch."""
    plan("--poses", "45", "-o", "p.csv", "--program", "probe.ngc")
    believed, rng, turns = chain(), np.random.default_rng(3), 0
    assert "(THE HEAD TURNS: START WITH ALL ROTARY AXES AT 0)" in Path("probe.ngc").read_text()
    now = dict.fromkeys(believed.letters, 0.0)
    for code, before, after, _ in blocks(Path("probe.ngc").read_text()):
        if all(before.get(a) == after.get(a) for a in believed.letters):
            continue
        turns += 1
        assert (code, before["Z"], after["Z"]) == ("G0", 300.0, 300.0)
        low, high = (np.array([one[a] for a in believed.letters]) for one in (now, after))
        now = after
        angles = low + rng.uniform(size=(300, len(low))) * (high - low)
        arm = np.array([*believed.tip, 1.0])
        for k, axis in reversed([*enumerate(believed.head, len(believed.table))]):
            arm = (matrices(axis, angles[:, k]) @ np.broadcast_to(arm, (300, 4))[..., None])[..., 0]
        for ball in BALLS:
            place = np.array([*ball, 1.0])
            for k, axis in reversed([*enumerate(believed.table)]):
                turned = matrices(axis, angles[:, k]) @ np.broadcast_to(place, (300, 4))[..., None]
                place = turned[..., 0]
            assert (after["Z"] + arm[..., 2] - place[..., 2]).min() > OUTSIDE
    assert turns >= 40


def test_all_poses_are_inside_the_limits_and_lean_little(kind):
    """By gcxform's reader: every position; and table, probe and Z lean by the tilt at most."""
    plan("--poses", "50", "--tilt", "60", "-o", "p.csv", "--program", "probe.nc", "--to", "fanuc")
    path = gx.read(Path("probe.nc"), "fanuc").path
    known = path.end[np.isfinite(path.end).all(axis=1)]
    assert len(known) > 50 * 20
    assert (known[:, :3] >= LOW).all()
    assert (known[:, :3] <= HIGH).all()
    believed = chain()
    for axis in believed.axes:
        angles = known[:, path.axes.index(axis.letter)]
        assert axis.limits[0] <= angles.min() < angles.max() <= axis.limits[1]
    assert call("check", "-f", "fanuc", "-m", "m.toml", "probe.nc").exit_code == 0
    poses = read_poses(Path("p.csv"), believed.letters).poses
    tips, axis = tool(believed, poses.points, poses.degrees)
    assert np.abs(tips - np.array([BALLS[int(b) - 1] for b in poses.ball])).max() < 9e-4
    leaning = np.degrees(np.arccos(axis[:, 2]))
    assert 45.0 < leaning.max() <= 60.0 + 1e-9
    for ways in (believed.spindle(poses.degrees), believed.upwards(poses.degrees)):
        assert np.degrees(np.arccos(ways[:, 2].clip(-1.0, 1.0))).max() <= 60.0 + 1e-9


@pytest.mark.skipif(not rs274.available(), reason="rs274 is not installed")
def test_linuxcnc_reads_the_program_as_we_do(kind):
    """It reports the target of a probing move as what was found, so ends are those of the text."""
    plan("--poses", "20", "-o", "p.csv", "--program", "probe.ngc")
    poses, believed = read_poses(Path("p.csv"), chain().letters).poses, chain()
    probes = [m for m in rs274.run(Path("probe.ngc").read_bytes()).moves if m.kind == "PROBE"]
    assert len(probes) == 100
    for k, move in enumerate(probes):
        (start, angles), (end, _) = (standing(s, believed.letters) for s in (move.start, move.end))
        assert angles == pytest.approx(poses.degrees[k // 5], abs=1e-3)
        _, axis = tool(believed, start[None], angles[None])
        tips = tool(believed, np.array([start, end]), np.array([angles, angles]))[0]
        away = tips - BALLS[int(poses.ball[k // 5]) - 1]
        sizes = np.linalg.norm(away, axis=1)
        assert sizes == pytest.approx([OUTSIDE, RADIUS - CLEARANCE], abs=4e-3)
        along = away[0] @ axis[0] / sizes[0]
        assert along == pytest.approx(1.0 if k % 5 == 0 else 0.0, abs=2e-4)


def test_sides_are_across_the_probe_and_half_way_from_the_post(kind):
    believed = chain()
    for degrees in np.random.default_rng(1).uniform(-70.0, 70.0, (20, 2)):
        ways, along = sides(believed, degrees), believed.spindle(degrees[None])[0]
        up = believed.upwards(degrees[None])[0]
        level = np.linalg.norm(np.cross(along, up))
        assert np.abs(ways @ along).max() < 1e-12
        assert np.abs(ways @ up) == pytest.approx(np.full(4, level * np.sqrt(0.5)), abs=1e-12)
        assert ways[0] + ways[1] == pytest.approx(np.zeros(3), abs=1e-12)
        assert ways[2] + ways[3] == pytest.approx(np.zeros(3), abs=1e-12)
        assert ways[0] @ ways[2] == pytest.approx(0.0, abs=1e-12)


def test_the_way_to_a_ball_is_clear_of_others(kind):
    """The exact gap of the half-lines against points of the probe, its way and the post."""
    believed, rng = chain(), np.random.default_rng(8)
    lengths = np.stack(np.meshgrid(*3 * [np.linspace(0.0, 400.0, 41)]), axis=-1).reshape(-1, 3)
    seen = set()
    for degrees in rng.uniform(-70.0, 70.0, (25, 2)):
        other = tuple(np.array(BALLS[0]) + rng.normal(size=3) * 60.0)
        balls = (BALLS[0], other)
        here = believed.onto_machine(np.array(balls), np.tile(degrees, (2, 1)))
        ways = [
            believed.spindle(degrees[None])[0],
            np.eye(3)[2],
            believed.upwards(degrees[None])[0],
        ]
        nearest = np.linalg.norm(lengths @ np.array(ways) - (here[1] - here[0]), axis=1).min()
        assert clear(believed, balls, 0, degrees[None], nearest + 1e-9)[0] == False  # noqa: E712
        good = clear(believed, balls, 0, degrees[None], nearest - 9.0)[0]
        assert good or nearest < 9.0
        seen.add(bool(clear(believed, balls, 0, degrees[None], 36.5)[0]))
        for gap in (20.0, 36.5, 60.0):
            one, same = (balls, 0), (balls[::-1], 1)
            assert clear(believed, *one, degrees[None], gap) == clear(
                believed, *same, degrees[None], gap
            )
    assert seen == {True, False}


def test_limits_have_room_for_all_ways_about_a_ball(kind):
    """As little as all directions across the probe need, and what is before the ball."""
    believed, turns = chain(), np.radians(np.arange(0.0, 360.0, 0.5))[:, None]
    for degrees in np.random.default_rng(6).uniform(-70.0, 70.0, (20, 1, 2)):
        along, stand = believed.spindle(degrees)[0], np.array([[20.0, -30.0, -40.0]])
        across = np.linalg.svd(along[None])[2][1:]
        ways = np.cos(turns) * across[0] + np.sin(turns) * across[1]
        every = stand + OUTSIDE * np.concatenate([ways, ways + along])
        for axis in range(3):
            for side, away in ((0, -1.0), (1, 1.0)):
                border = away * (away * every[:, axis]).max()
                for more, fits in ((0.01, True), (-0.01, False)):
                    travel = [[-1e3, 1e3] for _ in "XYZ"]
                    travel[axis][side] = border + away * more
                    small = replace(believed, travel=tuple(map(tuple, travel)))
                    assert inside(small, stand, degrees, OUTSIDE)[0] == fits


def test_table_and_probe_lean_from_z_too():
    """A cradle and a head that turn alike: they stand as at 0 to each other, and not to Z."""
    alike = Chain((CRADLE,), (replace(CRADLE, letter="B"),))
    degrees = np.array([[70.0, 70.0], [70.0, -70.0], [70.0, 0.0], [0.0, 70.0], [50.0, 50.0]])
    assert upright(alike, degrees, 75.0).tolist() == [True, False, True, True, True]
    assert upright(alike, degrees, 60.0).tolist() == [False, False, False, False, True]


def test_a_ball_behind_another_is_not_probed_through_it(kind):
    """Balls at a distance that is no more than their room: there is no pose; farther there is."""
    wanted = Wanted(12, OUTSIDE, 80.0, "none")
    near = (BALLS[0], (BALLS[0][0] + 36.0, *BALLS[0][1:]))
    with pytest.raises(gx.UsageError, match="clear of other balls"):
        planned(chain(), near, wanted, 0.002)
    planned(chain(), (BALLS[0], (BALLS[0][0] + 60.0, *BALLS[0][1:])), wanted, 0.002)


# --- what cannot be made safe ---


@pytest.mark.parametrize(
    ("change", "words", "said"),
    [
        (("-400.0, 300.0", "-400.0, -60.0"), [], "to be above the balls"),
        (("[-165.0, 170.0]", "[-190.0, 200.0]"), ["--tilt", "90"], ""),
    ],
)
def test_turning_that_is_not_above_the_balls_is_refused(tmp_path, monkeypatch, change, words, said):
    """Where the upright probe does not get over the balls: the poses may be there, but no way."""
    monkeypatch.chdir(tmp_path)
    text = machine_text("nutating")
    assert change[0] in text
    Path("m.toml").write_text(text.replace(*change))
    ball = ("--ball", "80,60,-190", "--ball=-90,-70,-185")
    command = ("calibrate", "plan", "-m", "m.toml", "--tool", "1", *ball, *SIZES, *words)
    assert call(*command, "-o", "p.csv").exit_code == 0
    done = call(*command, "-o", "p.csv", "--program", "x.ngc")
    if said:
        assert (done.exit_code, "GX491" in done.stderr, said in done.stderr) == (2, True, True)
        assert not Path("x.ngc").exists()
    else:
        assert done.exit_code == 0, done.output


def test_a_head_that_may_pass_the_horizontal_is_refused(tmp_path, monkeypatch):
    """A nutating head of 60 degrees without limits goes the other way around, and hangs."""
    monkeypatch.chdir(tmp_path)
    text = machine_text("nutating").replace("limits = [-165.0, 170.0]\n", "")
    steep = [0.0, np.sqrt(0.75), 0.5]
    Path("m.toml").write_text(text.replace(str(LEANING), str([float(v) for v in steep])))
    command = ("calibrate", "plan", "-m", "m.toml", "--tool", "1", *BALL, *SIZES, "-o", "p.csv")
    assert call(*command).exit_code == 0
    done = call(*command, "--program", "x.ngc")
    assert (done.exit_code, "past the horizontal" in done.stderr) == (2, True)
    assert hangs(chain(), np.array([[0.0, 0.0], [0.0, 10.0]]))


SWIVEL = Rotary("B", (0.0, 1.0, 0.0), (0.0, 0.0, 150.0), 1, (-90.0, 90.0))
CRADLE = Rotary("A", (1.0, 0.0, 0.0), (0.0, 0.0, -230.0), -1, (-90.0, 90.0))
TWO = np.array([[10.0, 20.0, -200.0], [0.0, 0.0, -230.0]])


@pytest.mark.parametrize(("one", "other"), [(-60.3, 60.4), (30.0, 60.0), (-60.0, -20.0)])
def test_the_least_height_is_that_of_the_lowest_tip_between(one, other):
    """A head that passes 0, or starts there: the tip is lowest upright."""
    head = Chain((), (SWIVEL,), (0.0, 0.0, -120.0))
    height, exact = least_height(head, TWO, np.array([[one], [other]]), 18.0), -200.0 + 18.0 + 120.0
    assert exact <= height < exact + 0.05


def test_the_least_height_is_that_of_the_highest_ball_between():
    """The first ball goes round on a cradle, and is highest on the way."""
    both = Chain((CRADLE,), (SWIVEL,), (0.0, 0.0, -120.0))
    exact = -230.0 + np.hypot(20.0, 30.0) + 18.0 + 120.0
    height = least_height(both, TWO, np.array([[-89.7, 0.0], [89.6, 0.0]]), 18.0)
    assert exact <= height < exact + 0.1


@pytest.mark.parametrize(
    ("change", "lowest"), [({"limits": None}, 180.0), ({"wrap": 360.0}, 180.0), ({}, 100.0)]
)
def test_an_axis_without_an_end_may_go_the_other_way_round(change, lowest):
    """From 10 to 100 degrees, or over 180, where the tip of this one is lowest."""
    below = Rotary("B", (0.0, 1.0, 0.0), (0.0, 0.0, -150.0), 1, (0.0, 300.0))
    head = Chain((), (replace(below, **change),), (0.0, 0.0, -120.0))
    height = least_height(head, TWO, np.array([[10.0], [100.0]]), 18.0)
    tip = -150.0 + 30.0 * np.cos(np.radians(lowest))
    assert height == pytest.approx(-200.0 + 18.0 - tip, abs=0.05)
