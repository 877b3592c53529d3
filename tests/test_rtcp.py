"""`rtcp`: where the tip goes with what is written; K5, K6 and K7 are acceptance checks."""

from __future__ import annotations

import re
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from gcxform_plugins.passes.rtcp.proof.undoing import SHARE
from gcxform_plugins.passes.shared.tip_bound import leaving
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from kinematics_kit import leaning, tool
from rtcp_kit import (
    KINDS,
    LENGTH,
    ROUNDED,
    SEGMENT,
    aside,
    axes,
    between,
    chain_of_kind,
    machine_text,
    pipeline,
    positions,
    program,
    tips,
)
from seeds_kit import LONG

import gcxform as gx

EACH = settings(
    suppress_health_check=[HealthCheck.function_scoped_fixture],
    deadline=None,
    max_examples=6 if LONG else 3,
)
ROOM = 2e-6  # mm; the least decimals of a machine file and of the matrices
FORMS = ("ac-trunnion", "bc-trunnion", "c-table-b-head", "cb-fork", "nutating-head")


@st.composite
def programs(draw):
    """Draw poses (n, 5), some of which only turn, some only move."""
    seed = draw(st.integers(0, 10_000))
    rng = np.random.default_rng(seed)
    count = draw(st.integers(2, 6))
    poses = rng.uniform(-1.0, 1.0, (count, 5)) * [90.0, 90.0, 60.0, 70.0, 170.0]
    for row in range(1, count):
        what = draw(st.sampled_from(["both", "both", "turn", "move", "short"]))
        if what == "turn":
            poses[row, :3] = poses[row - 1, :3]
        if what == "move":
            poses[row, 3:] = poses[row - 1, 3:]
        if what == "short":
            poses[row] = poses[row - 1] + (poses[row] - poses[row - 1]) * 0.004
    return seed, poses.round(3)


def walk(text, result, letters):
    """Yield each source line with its pose before and after, and the written poses in it."""
    old, new = positions(text, letters), positions(result.text, letters)
    owner = np.array(result.source_map)
    for line in range(3, len(old) - 1):
        rows = np.flatnonzero(owner == line)
        if len(rows):
            yield old[line - 1], old[line], new[rows[0] - 1 : rows[-1] + 1]


def check_ways(text, result, chain, tolerance, model):
    """Check that `model` of what is written stays beside the lines of the source."""
    letters = ("X", "Y", "Z", *chain.letters)
    worst, count = 0.0, 0
    for start, end, poses in walk(text, result, letters):
        for one, other in pairwise(poses):
            points = model(chain, between(one, other))
            worst = max(worst, float(aside(points, start[:3], end[:3]).max()))
            count += 1
        wanted = between(start[3:], end[3:], len(poses))
        assert np.abs(poses[:, 3:] - wanted).max() <= 0.0005 + 1e-9
    assert count
    assert worst <= tolerance + ROUNDED + ROOM
    return worst


@pytest.mark.parametrize("kind", KINDS)
@EACH
@given(drawn=programs(), tolerance=st.sampled_from([0.002, 0.01, 0.05]))
def test_the_tip_stays_on_its_line(tmp_path, kind, drawn, tolerance):
    """The law, by matrices of scipy: axes in proportion, at 33 places of every block."""
    seed, poses = drawn
    chain = chain_of_kind(kind, seed)
    text = program(poses, ("X", "Y", "Z", *chain.letters))
    result = pipeline(tmp_path, machine_text(kind, chain), tolerance=tolerance).run(text, "full")
    assert result.certificate.verified
    check_ways(text, result, chain, tolerance, tips)


@pytest.mark.parametrize("kind", KINDS)
@EACH
@given(drawn=programs())
def test_axes_stay_on_theirs(tmp_path, kind, drawn):
    """The reverse: a control that follows the tip moves the axes as the source did."""
    seed, poses = drawn
    chain = chain_of_kind(kind, seed)
    text = program(poses, ("X", "Y", "Z", *chain.letters), feed="F2.")
    options = {"tolerance": 0.01, "use": "to-tip"}
    result = pipeline(tmp_path, machine_text(kind, chain), **options).run(text, "full")
    check_ways(text, result, chain, 0.01, axes)


@pytest.mark.parametrize("kind", FORMS)
def test_rounded_angles_are_made_good(tmp_path, kind):
    """K6: at the ends of blocks the tip is off by no more than X, Y and Z are rounded."""
    rng = np.random.default_rng(5)
    chain = chain_of_kind(kind, 7)
    letters = ("X", "Y", "Z", *chain.letters)
    poses = (rng.uniform(-1, 1, (40, 5)) * [90.0, 90.0, 60.0, 50.0, 90.0]).round(3)
    text = program(poses, letters)
    result = pipeline(tmp_path, machine_text(kind, chain), tolerance=0.02).run(text)
    worst = 0.0
    for start, end, written in walk(text, result, letters):
        points = tips(chain, written[1:])
        worst = max(worst, float(aside(points, start[:3], end[:3]).max()))
    assert worst <= ROUNDED + ROOM
    assert worst > 0.0003  # and all of that is used


def test_rotary_decimals_of_their_own(tmp_path):
    """Angles of one decimal: X, Y and Z suit them as they are written."""
    chain = chain_of_kind("ac-trunnion", 3)
    decimals = "{ A = 1, C = 1 }"
    text = program(np.array([[0, 0, 0, 0, 0], [80.0, 20, 5, 33, 71]]), "XYZAC")
    steps = pipeline(tmp_path, machine_text("ac-trunnion", chain), decimals, tolerance=0.02)
    result = steps.run(text)
    for start, end, written in walk(text, result, "XYZAC"):
        assert aside(tips(chain, written[1:]), start[:3], end[:3]).max() <= ROUNDED + ROOM
        assert (np.abs(written[:, 3:] * 10 - np.round(written[:, 3:] * 10)) < 1e-9).all()


def test_the_time_is_that_of_the_tip(tmp_path):
    """K7: the sum of 1/F is length / feed within 0.1 %, block by block; G94 comes back."""
    chain = chain_of_kind("cb-fork", 11)
    poses = np.array([[0.0, 0, 0, 0, 0], [50, 10, 4, 20, 30], [50, 10, 4, 40, 10], [9, 1, 4, 0, 0]])
    letters = ("X", "Y", "Z", *chain.letters)
    text = program(np.vstack([poses[1:], poses[1:] + 0.5]), letters)
    result = pipeline(tmp_path, machine_text("cb-fork", chain), tolerance=0.01).run(text)
    old, owner = positions(text, letters), np.array(result.source_map)
    lines = result.text.decode().splitlines()
    assert lines[0].startswith("G21 G90 G93")
    assert re.search(r"G94.*M30", lines[-1])
    for line in range(3, len(old) - 1):
        feeds = [
            float(re.search(r"F([\d.]+)", lines[row])[1]) for row in np.flatnonzero(owner == line)
        ]
        step = old[line] - old[line - 1]
        way = np.linalg.norm(step[:3]) or np.linalg.norm(step[3:])
        assert sum(1.0 / feed for feed in feeds) == pytest.approx(way / 600.0, rel=1e-3)


@pytest.mark.parametrize("path", ["angles", "great-circle"])
@pytest.mark.parametrize("kind", ["cb-fork", "bc-trunnion"])
def test_no_axis_is_faster_than_it_can_be(tmp_path, kind, path):
    """Near the pole C would be: then the piece takes longer, and others take what they did."""
    chain = chain_of_kind(kind, 11)
    letters = ("X", "Y", "Z", *chain.letters)
    tilt = chain.letters.index("B") + 3
    poses = np.zeros((6, 5))
    poses[:, 0] = [0, 9, 18, 24, 33, 60]
    poses[:, tilt] = [9, 5, 2, 3, 12, 50]
    poses[:, 7 - tilt] = [10, 14, 30, 85, 99, 101]
    text = program(poses, letters).replace(b"G0 X0. Y0. ", b"G0 X0. Y0. Z0. ")
    text = re.sub(rb"\nG1 (\S+) F600.\n(\S+)", rb"\nG0 \1\nG1 \2 F600.", text)
    machine = machine_text(kind, chain)
    speeds = {"X": 500.0, "Y": 5000.0, "C": 400.0}
    for letter, speed in speeds.items():
        head = f"[axis.{letter}]\n"
        machine = machine.replace(head, f"{head}max-speed = {speed}\n")
    options = {"tolerance": 0.005, "rapids": "ends", "orientation_path": path}
    before = "" if path != "angles" else SEGMENT
    result = pipeline(tmp_path, machine, before=before, **options).run(text, "full")
    old, new = positions(text, letters), positions(result.text, letters)
    lines, owner = result.text.decode().splitlines(), np.array(result.source_map)
    columns, fast = [letters.index(a) for a in speeds], np.array([*speeds.values()])
    slowest, free = 1.0, 0
    for line in range(4, len(old) - 1):
        rows = np.flatnonzero(owner == line)
        share = np.linalg.norm((old[line] - old[line - 1])[:3]) / 600.0 / len(rows)
        for row in rows:
            time = 1.0 / float(re.search(r"F([\d.]+)", lines[row])[1])
            least = (np.abs(new[row] - new[row - 1])[columns] / fast).max()
            assert time == pytest.approx(max(share, least), rel=2e-2)
            slowest, free = max(slowest, time / share), free + (least < share)
    assert slowest > 1.5
    assert free
    told = result.certificate.measured["slower than its feed, times"]
    assert told == pytest.approx(slowest, rel=2e-2)


def test_no_rotation_no_change(tmp_path):
    """With all rotary axes at 0 tip and axes are one, to the last digit."""
    chain = chain_of_kind("bc-trunnion", 2)
    text = b"G21 G90 G93 G17 G54\nG0 X1.5 Y2. B0 C0\nG43 H1 Z0.1\nG1 X7. F3.\nY9.25 F3.\nM30\n"
    steps = pipeline(tmp_path, machine_text("bc-trunnion", chain), tolerance=0.01)
    assert steps.run(text, "full").text == text


TRUNNION = gx.Chain(
    (
        gx.Rotary("A", (1.0, 0.0, 0.0), (0.0, -4.0, 45.0), -1),
        gx.Rotary("C", (0.0, 0.0, 1.0), (8.0, 2.0, 0.0), -1),
    ),
    tip=(0.0, 0.0, -120.0),
)


def great_circle(count):
    """Return tips (n, 3) and angles (n, 2) of the path of K5, in so many pieces."""
    one, other = leaning(np.array([20.0, 50.0]), np.array([40.0, 100.0]))
    part = np.linspace(0.0, 1.0, count + 1)[:, None]
    whole = np.arccos(one @ other)
    axis = (np.sin((1.0 - part) * whole) * one + np.sin(part * whole) * other) / np.sin(whole)
    angles = gx.attitudes(TRUNNION, axis).angle[:, 0]
    return (part - 0.5) * [100.0, 0.0, 0.0], np.degrees(np.unwrap(np.radians(angles), axis=0))


@pytest.mark.parametrize(("limit", "blocks"), [(0.05, 36), (0.01, 81), (0.005, 124), (0.001, 256)])
def test_blocks_of_a_great_circle(limit, blocks):
    """K5: the bound that the pass cuts by holds for 1.1 times as many equal pieces, 41 samples."""
    points, angles = great_circle(int(1.1 * blocks))
    sides = (points[:-1], points[1:]), (angles[:-1], angles[1:])
    bound = leaving(TRUNNION, *sides)
    assert bound.max() <= (1.0 - SHARE) * limit
    linear = TRUNNION.linear(points, angles)
    for k in range(len(bound)):
        ways = (between(way[k], way[k + 1], 41) for way in (linear, angles))
        far = tool(TRUNNION, *ways)[0] - between(points[k], points[k + 1], 41)
        worst = np.linalg.norm(far, axis=1).max()
        assert 0.8 * bound[k] <= worst <= bound[k]


@example(1353, "ac-trunnion", 40.0)  # 1.37 and 1.24 times the bound of the middle alone
@example(1335, "a-table-b-head", 40.0)
@given(st.integers(0, 100_000), st.sampled_from(KINDS), st.sampled_from([0.2, 3.0, 40.0]))
def test_the_bound_holds_for_any_piece(seed, kind, size):
    """The tip is nowhere farther from where it should be than the bound, nor is that far off."""
    rng = np.random.default_rng(seed)
    chain = chain_of_kind(kind, seed)
    points = rng.uniform(-100.0, 100.0, (2, 3))
    angles = rng.uniform(-90.0, 90.0, (1, 2)) + rng.uniform(-size, size, (2, 2))
    bound = leaving(chain, (points[:1], points[1:]), (angles[:1], angles[1:]))[0]
    linear = chain.linear(points, angles)
    found = tool(chain, between(*linear, 41), between(*angles, 41))[0]
    worst = np.linalg.norm(found - between(*points, 41), axis=1).max()
    assert worst <= bound + 1e-9
    if size < 1.0:
        assert bound <= 1.05 * worst + 1e-9


def test_a_smaller_tolerance_takes_more_blocks(tmp_path):
    """Twice as many for a quarter, and the tolerance is used: the bound is not far from it."""
    chain = chain_of_kind("ac-trunnion", 1)
    text = program(np.array([[0, 0, 0, 20.0, -50.0], [100, 0, 0, 50, 10]]), "XYZAC")
    machine = machine_text("ac-trunnion", chain)
    counts = []
    for tolerance in (0.05, 0.01, 0.005, 0.001):
        result = pipeline(tmp_path, machine, tolerance=tolerance).run(text)
        counts.append(result.source_map.count(4))
        worst = check_ways(text, result, chain, tolerance, tips)
        assert worst >= 0.6 * tolerance  # which is also for how far the tip is ahead
    assert counts[3] / counts[0] == pytest.approx(50**0.5, rel=0.08)
    assert gx.Pipeline.load(tmp_path / "p.toml").promised() == 0.002


def test_limits_are_those_of_the_machine(tmp_path):
    """The work offset counts: X31 of the machine is X0 of the program."""
    chain = chain_of_kind("ac-trunnion", 4)
    machine = machine_text("ac-trunnion", chain)
    text = b"G21 G90 G93 G17 G54\nG0 X1. Y2. A0 C0\nG43 H1 Z0.\nG1 X7. F3.\nM30\n"
    for high, good in ((38.5, True), (37.5, False)):
        limited = machine.replace("[axis.X]\n", f"[axis.X]\nlimits = [-500.0, {high}]\n")
        steps = pipeline(tmp_path, limited, tolerance=0.01)
        if good:
            assert steps.run(text).text == text
            continue
        with pytest.raises(gx.InputError) as caught:
            steps.run(text)
        assert [d.code for d in caught.value.diagnostics] == ["GX331"]


@pytest.mark.parametrize("use", ["rtcp", "to-tip"])
@pytest.mark.parametrize("kind", KINDS)
def test_undone_pieces_stay_beside_the_curve(tmp_path, kind, use):
    """What the proof makes of a long move in proportion, against 400 points of it by scipy."""
    chain = chain_of_kind(kind, 8)
    letters = ("X", "Y", "Z", *chain.letters)
    poses = np.array([[0.0, 0, 0, 0, 0], [60, -30, 12, 55, -80], [60, -30, 12, 20, -10]])
    text = program(poses[1:], letters, feed="F2.")
    steps = pipeline(tmp_path, machine_text(kind, chain), tolerance=0.05, use=use)
    step = next(step for step in steps.path_passes if step.name == use)
    path = gx.Program(text, steps.source, steps.machine_reading).path
    undone = step.undo(path, steps.context)
    model = tips if use == "rtcp" else axes
    assert 0.0 < undone.slack <= SHARE * 0.05
    for row in np.flatnonzero(path.kind == gx.Kind.LINE):
        mine = np.flatnonzero(undone.source == path.source[row])
        ends = undone.end[mine, :3] - [0.0, 0.0, LENGTH]
        start = undone.start[mine, :3] - [0.0, 0.0, LENGTH]
        columns = [path.axes.index(letter) for letter in letters]
        way = [side[row, columns] - [0, 0, LENGTH, 0, 0] for side in (path.start, path.end)]
        found = model(chain, between(*way, 401))
        far = [aside(found, a, b) for a, b in zip(start, ends, strict=True)]
        assert np.min(far, axis=0).max() <= undone.slack + 1e-6


@pytest.mark.parametrize(
    ("factor", "good"), [(1.0, True), (0.5, False), (0.6, False), (2.0, False)]
)
def test_a_late_move_has_to_have_a_reason(tmp_path, factor, good):
    """The proof refuses other times of pieces in which no axis is at full speed."""
    chain = chain_of_kind("bc-trunnion", 3)
    machine = machine_text("bc-trunnion", chain)
    machine = machine.replace("[axis.C]\n", "[axis.C]\nmax-speed = 400.0\n")
    poses = np.array([[0.0, 0, 0, 10, 0], [9, 0, 0, 10, 2], [18, 0, 0, 10, 70]])
    text = program(poses, "XYZBC").replace(b"Y0. ", b"Y0. Z0. ")
    steps = pipeline(tmp_path, machine, tolerance=0.02)
    step = next(step for step in steps.path_passes if step.name == "rtcp")

    class Wrong(type(step)):
        def apply(self, path, context):
            after = super().apply(path, context)
            feed = np.where(after.source == 4, factor * after.feed, after.feed)
            return after.replace(feed=feed)

    options = {"tolerance": 0.02}
    wrong = replace(steps, passes=(*steps.passes[:-1], Wrong(**options)))
    if good:
        assert wrong.run(text).certificate.verified
        return
    with pytest.raises(gx.VerificationError):
        wrong.run(text)


FAST_Y = """format = 1
kinematics = "c-table-a-head"
gauge-point = [-16.392, 1.422, -2.649]
[axis.X]
max-speed = 2470.4
[axis.Y]
max-speed = 1959.4
[axis.Z]
max-speed = 3024.8
[axis.C]
point = [-41.519, 93.241, -0.741]
direction = [-0.0144, -0.0131, 1.003]
max-speed = 4543.3
[axis.A]
point = [-99.958, 75.36, -99.572]
direction = [0.9915, -0.0053, -0.0016]
max-speed = 6215.4
[tool.1]
length = 42.0
[work-offset.G54]
X = -32.757
Y = 7.677
Z = 22.632
"""


def test_a_move_may_be_late_in_a_part_of_its_pieces(tmp_path):
    """The others have their share of the time by the way of the tip, by that of the axes more."""
    text = b"""G21 G90 G94 G17 G54
G0 C0 A0
G0 X0 Y0
G43 H1 Z100.
G1 X66.798 Y23.011 Z-28.499 C-160.819 A36.725 F1700.8
X51.381 Y62.770 Z35.050 C-166.709 A-1.283 F2525.9
M30
"""
    result = pipeline(tmp_path, FAST_Y, tolerance=0.02).run(text)
    assert result.certificate.verified
    times = [1.0 / float(f) for f in re.findall(r"A-?[\d.]+ F([\d.]+)", result.text.decode())]
    assert sum(times[-result.source_map.count(5) :]) > 1.1 * 76.53 / 2525.9


@pytest.mark.parametrize(
    ("said", "hints"),
    [
        ('direction = "to-tip"', ['write "to-tip" in the place of "rtcp"']),
        (
            'direction = "repost"\ncalibrated = "machine.toml"',
            ['write "repost" in the place of "rtcp"', 'it is an option of "repost"'],
        ),
        (
            'direction = "retarget"\ntarget = "machine.toml"',
            ['write "retarget" in the place of "rtcp"', 'it is an option of "retarget"'],
        ),
        ('direction = "to-machine"', ["leave it out"]),
    ],
)
def test_each_way_is_a_pass_of_its_own(tmp_path, said, hints):
    machine = machine_text("ac-trunnion", chain_of_kind("ac-trunnion", 3))
    pipeline(tmp_path, machine, tolerance=0.01)
    file = tmp_path / "p.toml"
    file.write_text(file.read_text().replace('use = "rtcp"\n', f'use = "rtcp"\n{said}\n'))
    with pytest.raises(gx.UsageError) as refused:
        gx.Pipeline.load(file)
    assert [(d.code, d.hint) for d in refused.value.diagnostics] == [("GX701", h) for h in hints]


def test_what_a_tool_change_loses_is_not_asked_as_a_start(tmp_path):
    """To say where axes stand before the first block would not help; to name them all does."""
    text = machine_text("ac-trunnion", chain_of_kind("ac-trunnion", 1))
    step = pipeline(tmp_path, text, tolerance=0.01, rapids="ends")
    head = "G21 G90 G94 G17 G54\nT1 M6\nG43 H1\n{}\nG1 X5. A5. C5. F100.\nM30\n"
    with pytest.raises(gx.InputError) as refused:
        step.run(head.format("G0 Z80.").encode())
    found = refused.value.diagnostics[0]
    assert found.code == "GX311"
    assert found.hint.startswith("name all axes in the first rapid behind a tool change")
    assert step.run(head.format("G0 X0. Y0. Z80. A0. C0.").encode()).certificate.verified
