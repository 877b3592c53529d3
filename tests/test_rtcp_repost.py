"""`rtcp` from one machine to another: R5, R6 and R7 are acceptance checks."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
from gcxform_plugins.passes.rtcp.conversion import Conversion
from gcxform_plugins.passes.rtcp.forward.correction_bound import bend_of_correction
from gcxform_plugins.passes.rtcp.proof.undoing import SHARE
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from kinematics_kit import tool
from rtcp_kit import (
    KINDS,
    LENGTH,
    ROUNDED,
    ZERO,
    aside,
    between,
    chain_of_kind,
    machine_text,
    pipeline,
    positions,
    tips,
)
from seeds_kit import LONG

import gcxform as gx

EACH = settings(
    suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=4
)
ROOM = 2e-6  # mm; the least decimals of a machine file and of the matrices
OFF, LEAN = 0.05, 1.5e-4  # mm and rad; errors of a good machine
FINE = "{ A = 5, B = 5, C = 5 }"  # of angles, for levers of some 300 mm
TOLERANCE = 0.002
POSES = 300 if LONG else 100


def measured(chain, seed, size=1.0):
    """Return a chain as it might be measured: every axis a little elsewhere."""
    rng = np.random.default_rng(seed)

    def moved(axis):
        way = np.array(axis.direction) + size * LEAN * rng.uniform(-1, 1, 3)
        point = np.array(axis.point) + size * OFF * rng.uniform(-1, 1, 3)
        way = (way / np.linalg.norm(way)).tolist()
        return replace(axis, direction=tuple(way), point=tuple(point.tolist()))

    return replace(
        chain,
        table=tuple(moved(axis) for axis in chain.table),
        head=tuple(moved(axis) for axis in chain.head),
    )


def measured_text(kind, chain):
    """Return the machine file of a chain whose axes point where they were measured."""
    text = machine_text(kind, chain)
    for axis in chain.axes:
        way = [*map(float, axis.direction)]
        text = text.replace(f"[axis.{axis.letter}]\n", f"[axis.{axis.letter}]\ndirection = {way}\n")
    return text


def reposted(folder, kind, nominal, real, **options):
    """Return the pipeline that corrects programs for a nominal machine."""
    (folder / "real.toml").write_text(measured_text(kind, real))
    options = {"tolerance": TOLERANCE, "use": "repost", "calibrated": "real.toml"} | options
    options = {"decimals": FINE} | options
    return pipeline(folder, machine_text(kind, nominal), **options)


def posted(poses, letters):
    """Return a program in axes, in G94, which `repost` leaves alone."""
    words = ["".join(f"{a}{v:.3f}" for a, v in zip(letters, pose, strict=True)) for pose in poses]
    turned = " ".join(f"{letter}0." for letter in letters[3:])
    head = f"G21 G90 G94 G17 G54\nG0 X0. Y0. {turned}\nG43 H1 Z0.\nG1 {words[0]} F600.\n"
    return (head + "".join(f"{block}\n" for block in words[1:]) + "M30\n").encode()


def step_of(steps):
    """Return the pass."""
    return next(step for step in steps.path_passes if isinstance(step, Conversion))


def poses_of(path, letters):
    """Return the words (n, 5) of the ends of a path, before they are rounded."""
    columns = [path.axes.index(letter) for letter in letters]
    return path.end[:, columns] - [0.0, 0.0, LENGTH, 0.0, 0.0]


@st.composite
def walks(draw):
    """Draw poses (n, 5): blocks of any size, some that only turn, some that only move."""
    seed = draw(st.integers(0, 10_000))
    rng = np.random.default_rng(seed)
    poses = rng.uniform(-1.0, 1.0, (6, 5)) * [90.0, 90.0, 60.0, 70.0, 170.0]
    part = draw(st.sampled_from([0.01, 0.1, 1.0]))
    poses[1:] = poses[:1] + part * (poses[1:] - poses[:1])
    poses[2, :3] = poses[1, :3]
    poses[4, 3:] = poses[3, 3:]
    return seed, poses.round(3)


@pytest.mark.parametrize("kind", KINDS)
@EACH
@given(drawn=walks())
def test_the_tip_goes_where_it_was_meant_to(tmp_path, kind, drawn):
    """By matrices of scipy: the real machine beside the nominal one, at 33 places of each block."""
    seed, poses = drawn
    nominal = chain_of_kind(kind, seed)
    real = measured(nominal, seed)
    letters = ("X", "Y", "Z", *nominal.letters)
    text = posted(poses, letters)
    result = reposted(tmp_path, kind, nominal, real).run(text, "full")
    old, new = positions(text, letters), positions(result.text, letters)
    owner = np.array(result.source_map)
    worst, before = 0.0, 0.0
    for line in range(3, len(old) - 1):
        rows = np.flatnonzero(owner == line)
        for nth, row in enumerate(rows):
            part = (nth + np.linspace(0.0, 1.0, 33)[:, None]) / len(rows)
            wanted = tips(nominal, old[line - 1] + part * (old[line] - old[line - 1]))
            found = tips(real, between(new[row - 1], new[row]))
            worst = max(worst, float(np.linalg.norm(found - wanted, axis=1).max()))
            before = max(
                before,
                float(
                    np.linalg.norm(tips(real, old[line:]) - tips(nominal, old[line:]), axis=1).max()
                ),
            )
    assert worst <= TOLERANCE + 2 * ROUNDED + ROOM
    assert before > 3.0 * worst or before < 0.01


@pytest.mark.parametrize("kind", KINDS)
def test_reposted_before_rounding(tmp_path, kind):
    """R5: with angles kept the tip is within 1e-9 mm on the calibrated machine; angles stay."""
    rng = np.random.default_rng(8)
    nominal = chain_of_kind(kind, 5)
    real = measured(nominal, 6)
    letters = ("X", "Y", "Z", *nominal.letters)
    poses = (rng.uniform(-1, 1, (POSES, 5)) * [150.0, 150.0, 150.0, 90.0, 170.0]).round(3)
    steps = reposted(tmp_path, kind, nominal, real)
    path = gx.Program(posted(poses, letters), steps.source, steps.machine_reading).path
    step = step_of(steps)
    after = step.apply(path, steps.context)
    last = np.flatnonzero(np.append(np.diff(after.source) > 0, True))
    old, new = (poses_of(p, letters)[3:] for p in (path, after.take(last)))
    loaded = gx.chain_of(step.calibrated.machine)
    real = replace(real, table=loaded.table, head=loaded.head)
    wanted, found = tips(nominal, old), tips(real, new)
    assert np.linalg.norm(found - wanted, axis=1).max() <= 1e-9
    assert (old[:, 3:] == new[:, 3:]).all()
    assert np.linalg.norm(tips(real, old) - wanted, axis=1).max() > 0.02
    told = step.measure(path, after, steps.context)
    every = poses_of(after, letters)[3:]
    lean = [tool(c, every[:, :3], every[:, 3:])[1] for c in (nominal, real)]
    off = np.linalg.norm(lean[0] - lean[1], axis=1).max()
    assert told["tool axis off, degrees"] == pytest.approx(np.degrees(off), rel=1e-6)
    assert told["tool axis off by tool length, mm"] == pytest.approx(off * LENGTH, rel=1e-6)


@pytest.mark.parametrize("kind", ["ac-trunnion", "nutating-head"])
def test_the_same_machine_changes_nothing(tmp_path, kind):
    """R7: where the calibrated machine is the nominal one, every byte stays."""
    rng = np.random.default_rng(2)
    chain = chain_of_kind(kind, 5)
    poses = rng.uniform(-1, 1, (50, 5)) * [150.0, 150.0, 150.0, 90.0, 170.0]
    text = posted(poses, ("X", "Y", "Z", *chain.letters)).replace(b"0\n", b"0 (as it is)\n")
    steps = reposted(tmp_path, kind, chain, chain)
    assert steps.run(text, "full").text == text


def test_at_zero_both_machines_agree(tmp_path):
    """The work offset is taken with all rotary axes at 0: what is cut there stays as it is."""
    nominal = chain_of_kind("bc-trunnion", 2)
    real = measured(nominal, 3, size=20.0)
    text = b"G21 G90 G94 G17 G54\nG0 X1.5 Y2. B0 C0\nG43 H1 Z0.1\nG1 X7. F300.\nY9.25\nM30\n"
    assert reposted(tmp_path, "bc-trunnion", nominal, real).run(text, "full").text == text


@given(st.integers(0, 100_000), st.sampled_from(KINDS), st.sampled_from([0.5, 5.0, 60.0]))
def test_the_bound_of_corrections_holds(seed, kind, size):
    """Nowhere is the tip farther off than the bound, which is of the size of the errors."""
    rng = np.random.default_rng(seed)
    one = chain_of_kind(kind, seed)
    other = measured(one, seed + 1)
    linear = rng.uniform(-150.0, 150.0, (1, 3)) + rng.uniform(-size, size, (2, 3))
    angles = rng.uniform(-90.0, 90.0, (1, 2)) + rng.uniform(-size, size, (2, 2))
    way = (linear[:1], linear[1:]), (angles[:1], angles[1:])
    bound = bend_of_correction((one, other), *way)[0]
    ends = other.linear(one.forward(linear, angles)[0], angles)
    turned = between(*angles, 65)
    wanted = tool(one, between(*linear, 65), turned)[0]
    found = tool(other, between(*ends, 65), turned)[0]
    worst = np.linalg.norm(found - wanted, axis=1).max()
    assert worst <= bound + 1e-9
    radians = np.radians(np.abs(angles[1] - angles[0])).sum()
    assert bound <= 0.3 * (radians**2 + radians * 2.0 * size / 150.0)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("column", [0, 1])
def test_the_bound_of_an_axis_that_leans(kind, column):
    """One axis turns, X, Y and Z stand still, and the lines of both machines meet."""
    one = chain_of_kind(kind, 3)
    other = measured(one, 4)
    pairs = zip(one.axes, other.axes, strict=True)
    leaning = [replace(b, point=a.point) for a, b in pairs]
    other = replace(
        other, table=tuple(leaning[: len(one.table)]), head=tuple(leaning[len(one.table) :])
    )
    linear = np.full((2, 3), 120.0)
    angles = np.zeros((2, 2))
    angles[1, column] = 40.0
    bound = bend_of_correction((one, other), (linear[:1], linear[1:]), (angles[:1], angles[1:]))
    ends = other.linear(one.forward(linear, angles)[0], angles)
    turned = between(*angles, 65)
    found = tool(other, between(*ends, 65), turned)[0] - tool(one, between(*linear, 65), turned)[0]
    worst = np.linalg.norm(found, axis=1).max()
    assert 0.0 < worst <= bound[0] <= 40.0 * worst


@pytest.mark.parametrize("kind", KINDS)
def test_undone_pieces_stay_beside_the_curve(tmp_path, kind):
    """What the proof makes of a long move, against 400 points of it by scipy."""
    nominal = chain_of_kind(kind, 8)
    real = measured(nominal, 9, size=30.0)
    letters = ("X", "Y", "Z", *nominal.letters)
    poses = np.array([[60, -30, 12, 55, -80], [60, -30, 12, 20, -10.0]])
    steps = reposted(tmp_path, kind, nominal, real, tolerance=0.05)
    path = gx.Program(posted(poses, letters), steps.source, steps.machine_reading).path
    undone = step_of(steps).undo(path, steps.context)
    assert 0.0 < undone.slack <= SHARE * 0.05
    for row in np.flatnonzero(path.kind == gx.Kind.LINE):
        mine = np.flatnonzero(undone.source == path.source[row])
        ends = undone.end[mine, :3] - [0.0, 0.0, LENGTH]
        start = undone.start[mine, :3] - [0.0, 0.0, LENGTH]
        columns = [path.axes.index(letter) for letter in letters]
        way = [side[row, columns] - [0, 0, LENGTH, 0, 0] for side in (path.start, path.end)]
        poses = between(*way, 401)
        points = tips(real, poses) + ZERO + np.array(nominal.tip) + [0.0, 0.0, LENGTH]
        found = nominal.linear(points, poses[:, 3:]) - ZERO - [0.0, 0.0, LENGTH]
        far = [aside(found, a, b) for a, b in zip(start, ends, strict=True)]
        assert np.min(far, axis=0).max() <= undone.slack + 1e-6


def test_the_certificate_tells_what_stays(tmp_path):
    """The tool axis that is off, and how much that is at the other end of the tool."""
    nominal = chain_of_kind("ac-trunnion", 4)
    poses = np.array([[10.0, 0, 0, 20, 30], [20, 5, 0, 60, 90]])
    steps = reposted(tmp_path, "ac-trunnion", nominal, measured(nominal, 7))
    certificate = steps.run(posted(poses, "XYZAC")).certificate
    told = certificate.measured
    assert 0.001 < told["tool axis off, degrees"] < 0.05
    assert re.search(r'"calibrated": \{\s*"file": "real.toml",\s*"sha256"', certificate.to_json())


# --- angles are corrected too ---


def corrected(folder, kind, nominal, real, **options):
    """Return the pipeline that corrects angles as well."""
    options = {"before": "", "orientation": "correct", "decimals": 4} | options
    return reposted(folder, kind, nominal, real, **options)


def both(path, after, step, nominal, letters):
    """Return the poses at the ends of lines as posted, as corrected, and the real chain."""
    last = np.flatnonzero(np.append(np.diff(after.source) > 0, True))
    old, new = (poses_of(p, letters)[3:] for p in (path, after.take(last)))
    return old, new, replace(nominal, **sides_of(gx.chain_of(step.calibrated.machine)))


def sides_of(chain):
    """Return table and head of a chain."""
    return {"table": chain.table, "head": chain.head}


def leaning_poses(chain, rng, count, least=15.0, around=60.0):
    """Return poses (n, 5) that are away from the pole, and from the end of what is reached."""
    poses = rng.uniform(-1.0, 1.0, (count, 5)) * [150.0, 150.0, 150.0, 0.0, around]
    poses[:, 3] = rng.uniform(least, 60.0, count)
    return (poses[:, [0, 1, 2, 4, 3]] if chain.letters[0] == "C" else poses).round(3)


@pytest.mark.parametrize("kind", KINDS)
def test_corrected_before_rounding(tmp_path, kind):
    """R5: with angles corrected the tip is within 1e-9 mm, and the tool axis within 1e-9."""
    nominal = chain_of_kind(kind, 5)
    real = measured(nominal, 6)
    letters = ("X", "Y", "Z", *nominal.letters)
    poses = leaning_poses(nominal, np.random.default_rng(8), 60)
    steps = corrected(tmp_path, kind, nominal, real, decimals=6, largest_turn=5.0, tolerance=0.05)
    path = gx.Program(posted(poses, letters), steps.source, steps.machine_reading).path
    step = step_of(steps)
    exact = replace(steps.context, numbers=replace(steps.context.numbers, angle=14))
    after = step.apply(path, exact)
    old, new, real = both(path, after, step, nominal, letters)
    wanted, found = (
        tool(c, p[:, :3] + ZERO + [0, 0, LENGTH], p[:, 3:])
        for c, p in ((nominal, old), (real, new))
    )
    assert np.linalg.norm(found[0] - wanted[0], axis=1).max() <= 1e-9
    assert np.linalg.norm(found[1] - wanted[1], axis=1).max() <= 1e-9
    assert 0.001 < np.abs(new[:, 3:] - old[:, 3:]).max() < 5.0


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", [0, 5])
def test_corrected_programs_keep_the_tool(tmp_path, kind, seed):
    """By matrices of scipy, at 33 places of each block as written: tip and tool axis."""
    nominal = chain_of_kind(kind, seed)
    real = measured(nominal, seed)
    letters = ("X", "Y", "Z", *nominal.letters)
    poses = leaning_poses(nominal, np.random.default_rng(seed), 6)
    poses[1:] = (poses[:1] + 0.2 * (poses[1:] - poses[:1])).round(3)
    steps = corrected(tmp_path, kind, nominal, real, largest_turn=5.0)
    text = posted(poses, letters)
    result = steps.run(text, "full")
    lean = check_tools(text, result, (nominal, letters), (real, letters), TOLERANCE)
    assert lean <= 2e-5  # of 3e-4 that were


def check_tools(text, result, source, target, tolerance, first=3):
    """Check tips of what is written beside those of the source; return how far axes lean, rad."""
    (one, old_letters), (other, new_letters) = source, target
    old, new = positions(text, old_letters), positions(result.text, new_letters)
    owner = np.array(result.source_map)
    worst, lean = 0.0, 0.0
    for line in range(first, len(old) - 1):
        rows = np.flatnonzero(owner == line)
        for nth, row in enumerate(rows):
            part = (nth + np.linspace(0.0, 1.0, 9)[:, None]) / len(rows)
            posed = old[line - 1] + part * (old[line] - old[line - 1])
            found = between(new[row - 1], new[row], 9)
            off = tips(one, posed) - tips(other, found)
            worst = max(worst, float(np.linalg.norm(off, axis=1).max()))
            axis = tool(one, posed[:, :3], posed[:, 3:])[1]
            axis = axis - tool(other, found[:, :3], found[:, 3:])[1]
            lean = max(lean, float(np.linalg.norm(axis, axis=1).max()))
    assert worst <= tolerance + ROUNDED + ROOM
    return lean


@pytest.mark.parametrize("largest", [0.05, 0.5, 3.0])
def test_no_angle_is_corrected_by_more_than_asked(tmp_path, largest):
    """R6: the pole rule, on a path that winds around the pole and through it."""
    nominal = chain_of_kind("ac-trunnion", 3)
    real = measured(nominal, 4)
    turn = np.linspace(0.0, 1.0, 120)
    poses = np.zeros((120, 5))
    poses[:, 0] = 40.0 * turn
    poses[:, 3] = 12.0 * np.abs(turn - 0.5) * (turn - 0.3)
    poses[:, 4] = 160.0 * turn
    options = {"orientation": "correct-if-tilt", "largest_turn": largest}
    steps = corrected(tmp_path, "ac-trunnion", nominal, real, **options)
    text = posted(poses.round(4), "XYZAC")
    result = steps.run(text, "full")
    told = result.certificate.measured["angles corrected by, degrees"]
    assert 0.01 < told <= largest + 0.0001
    check_tools(text, result, (nominal, "XYZAC"), (real, "XYZAC"), TOLERANCE)
    with pytest.raises(gx.InputError) as caught:
        corrected(tmp_path, "ac-trunnion", nominal, real, largest_turn=largest).run(text)
    assert {d.code for d in caught.value.diagnostics} == {"GX333"}


@pytest.mark.parametrize("orientation", ["correct", "correct-if-tilt"])
def test_the_same_machine_changes_no_angle(tmp_path, orientation):
    """R7, where angles might be corrected."""
    chain = chain_of_kind("cb-fork", 5)
    text = posted(np.random.default_rng(2).uniform(-60, 60, (50, 5)), "XYZCB")
    steps = corrected(tmp_path, "cb-fork", chain, chain, orientation=orientation)
    assert steps.run(text, "full").text == text
