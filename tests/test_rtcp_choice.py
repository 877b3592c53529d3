"""Attitudes and turns along a cut, and the proof of programs for other machines."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from gcxform_plugins.passes.rtcp.forward.choice import Choice, NoWayError, Trouble, nearest
from gcxform_plugins.passes.rtcp.proof.proof import Proof
from hypothesis import given
from hypothesis import strategies as st
from kinematics_kit import leaning, tool
from rtcp_kit import (
    KINDS,
    LENGTH,
    ROUNDED,
    ZERO,
    between,
    chain_of_kind,
    machine_text,
    pipeline,
    positions,
    tips,
)
from scipy.spatial.transform import Rotation
from test_rtcp_repost import leaning_poses, posted, step_of
from test_rtcp_retarget import retargeted, timed

import gcxform as gx
from gcxform.pipeline.whole_cuts import whole_cuts


def trunnion(a=(-30.0, 110.0), c=(-270.0, 270.0)):
    """Return the machine of K4."""
    return gx.Chain(
        (
            gx.Rotary("A", (1.0, 0.0, 0.0), (0.0, 0.0, 0.0), -1, a),
            gx.Rotary("C", (0.0, 0.0, 1.0), (0.0, 0.0, 0.0), -1, c),
        )
    )


def in_a_cut(count):
    """Return which of so many points are reached in a cut: all but the first."""
    return np.arange(count) > 0


def travel(angles, start):
    """Return how far all axes turn together, degrees."""
    return np.abs(np.diff(np.vstack([start, angles]), axis=0)).sum()


def test_a_tilt_that_grows_begins_with_the_right_attitude():
    """K4: the nearest attitude begins at A-20, has to flip, and turns 300 degrees; this one 240."""
    axis = leaning(np.linspace(20.0, 60.0, 41), np.full(41, 90.0))
    start = np.zeros(2)
    angles = Choice(trunnion(), axis, in_a_cut(41)).run(start)
    assert angles[0, 0] == pytest.approx(20.0)
    assert abs(angles[0, 1]) == pytest.approx(180.0)
    assert travel(angles, start) == pytest.approx(240.0)
    assert np.abs(np.diff(angles, axis=0)).max() < 2.0  # no reorientation
    first = np.array([[-20.0, 0.0]])
    assert nearest(trunnion(), axis[:1], np.zeros((1, 2))) == pytest.approx(first)


def test_a_long_sweep_begins_at_the_right_turn():
    """K4: 400 degrees of azimuth go from C-270 to C130 without unwinding, 670 degrees in all."""
    axis = leaning(np.full(401, 40.0), np.linspace(0.0, 400.0, 401))
    start = np.array([40.0, 0.0])
    angles = Choice(trunnion(), axis, in_a_cut(401)).run(start)
    assert angles[0, 1] == pytest.approx(-270.0)
    assert angles[-1, 1] == pytest.approx(130.0)
    assert travel(angles, start) == pytest.approx(670.0)
    with pytest.raises(NoWayError) as caught:
        Choice(trunnion(c=(-190.0, 190.0)), axis, in_a_cut(401)).run(start)
    assert caught.value.trouble is Trouble.FLIP
    assert caught.value.at == 101  # C190


def test_the_pole_is_passed_with_one_axis():
    """Through the pole A goes on to the other side; where it cannot, C would have to leap."""
    tilt = np.linspace(-10.0, 10.0, 21)
    axis = leaning(np.abs(tilt), np.where(tilt < 0.0, -90.0, 90.0))
    angles = Choice(trunnion(), axis, in_a_cut(21)).run(np.zeros(2))
    assert np.ptp(angles[:, 1]) < 1e-9
    assert np.abs(np.diff(angles[:, 0])) == pytest.approx(1.0)
    with pytest.raises(NoWayError) as caught:
        Choice(trunnion(a=(0.0, 110.0)), axis, in_a_cut(21)).run(np.zeros(2))
    assert caught.value.trouble is Trouble.POLE
    assert caught.value.at == 11


def test_before_a_cut_the_free_axis_is_where_the_cut_needs_it():
    """At the pole, before the tool leans, C is turned already; upright it stays as it was."""
    axis = leaning(np.array([0.0, 0.0, 5.0, 10.0, 5.0, 0.0, 0.0]), np.full(7, -50.0))
    cut = np.array([False, True, True, True, True, True, True])
    angles = Choice(trunnion(), axis, cut).run(np.zeros(2))
    assert np.ptp(angles[:, 1]) < 1e-9
    assert angles[0, 1] == pytest.approx(40.0)


def test_what_cannot_be_reached_is_told_apart():
    """K3: an axis out of reach, and angles beyond limits, with the number of the point."""
    nutating = chain_of_kind("nutating-head", 1)
    up = leaning(np.array([10.0, 120.0]), np.zeros(2))
    for chain, trouble in ((nutating, Trouble.UNREACHABLE), (trunnion(), Trouble.LIMITS)):
        with pytest.raises(NoWayError) as caught:
            Choice(chain, up, in_a_cut(2)).run(np.zeros(2))
        assert (caught.value.trouble, caught.value.at) == (trouble, 1)


@given(st.integers(0, 100_000), st.sampled_from(KINDS))
def test_no_way_is_cheaper(seed, kind):
    """Against all ways through the candidates of a few points."""
    rng = np.random.default_rng(seed)
    chain = chain_of_kind(kind, seed)
    limits = [(-200.0, 200.0), (-380.0, 120.0)]
    axes = [replace(axis, limits=limits[k]) for k, axis in enumerate(chain.axes)]
    chain = replace(
        chain, table=tuple(axes[: len(chain.table)]), head=tuple(axes[len(chain.table) :])
    )
    posed = leaning_poses(chain, rng, 4, least=20.0)[:, 3:]
    axis = chain.tool_axis(posed)
    found = Choice(chain, axis, np.zeros(4, np.bool_)).run(np.zeros(2))
    assert np.abs(chain.tool_axis(found) - axis).max() < 1e-9
    angle, allowed = gx.turns(chain, gx.attitudes(chain, axis).angle)
    ways = [(0.0, np.zeros(2))]
    for at in range(4):
        ends = angle[at][allowed[at]]
        ways = [
            min(((c + np.abs(e - b).sum(), e) for c, b in ways), key=lambda w: w[0]) for e in ends
        ]
    assert travel(found, np.zeros(2)) == pytest.approx(min(cost for cost, _ in ways))


def test_windows_divide_no_cut():
    """They end before the first rapid after a feed; a comment is none."""
    parts = [b"G0 X1\nG0 Y1\nG1 X2\n", b"X3 (G0 here)\nX4\n", b"G0 Z9\nX0\nG1 X", b"5\nG00X7\n"]
    found = [*whole_cuts(iter(parts))]
    assert b"".join(found) == b"".join(parts)
    assert found == [b"G0 X1\nG0 Y1\nG1 X2\nX3 (G0 here)\nX4\n", b"G0 Z9\nX0\nG1 X5\n", b"G00X7\n"]


# --- the proof ---


def test_the_proof_sees_what_is_wrong(tmp_path):
    """A tip, a tool axis or a time that is another: GX606."""
    one, other = chain_of_kind("ac-trunnion", 1), chain_of_kind("cb-fork", 2)
    poses = leaning_poses(one, np.random.default_rng(3), 3, least=30.0, around=20.0)
    text = timed(posted(poses, "XYZAC")).replace(b"G1 X", b"G0 X", 1)
    text = text.replace(b"F2.\nX", b"F2.\nG1 X", 1)
    steps = retargeted(tmp_path, ("ac-trunnion", one), ("cb-fork", other))
    program = gx.Program(text, steps.source, steps.machine_reading)
    path = with_axis(program.path, "B")
    step = step_of(steps)
    after = step.apply(path, steps.context)
    step.prove(path, after, steps.context)
    for column, size in ((0, 0.02), (2, -0.02), (after.axes.index("B"), 0.2)):
        end = after.end.copy()
        end[-2, column] += size
        with pytest.raises(gx.VerificationError, match="GX606"):
            step.prove(path, after.replace(end=end), steps.context)
    feed = after.feed.copy()
    feed[-1] *= 1.01
    with pytest.raises(gx.VerificationError, match="time of a move"):
        step.prove(path, after.replace(feed=feed), steps.context)
    assert isinstance(step.proof(path, after, steps.context), Proof)


def with_axis(path, letter):
    """Return a path with one more axis, where nothing is known of."""
    unknown = np.full((len(path), 1), np.nan)
    return path.replace(
        axes=path.axes + letter,
        end=np.hstack([path.end, unknown]),
        entry=np.append(path.entry, np.nan),
    )


# --- great circles ---


@pytest.mark.parametrize(("limit", "blocks"), [(0.05, 36), (0.01, 81), (0.005, 124), (0.001, 256)])
def test_blocks_of_a_great_circle(tmp_path, limit, blocks):
    """K5: the example of tip and tool axis takes 1.1 times as many blocks at most."""
    chain = gx.Chain(
        (
            gx.Rotary("A", (1.0, 0.0, 0.0), (0.0, -4.0, 45.0), -1),
            gx.Rotary("C", (0.0, 0.0, 1.0), (8.0, 2.0, 0.0), -1),
        ),
        tip=(4.0, -3.0, 20.0 - LENGTH),
    )
    ends = np.hstack([-ZERO[None, :] - [4.0, -3.0, 20.0], [[20.0, 130.0]]]).repeat(2, axis=0)
    ends[:, 0] += [-50.0, 50.0]
    ends[1, 3:] = [50.0, 190.0]
    text = (
        posted(ends.round(3), "XYZAC")
        .replace(b"G1 X", b"G0 X", 1)
        .replace(b"F600.\nX", b"\nG1 F600. X")
    )
    options = {"tolerance": limit, "orientation_path": "great-circle", "rapids": "ends"}
    steps = pipeline(tmp_path, machine_text("ac-trunnion", chain), before="", **options)
    result = steps.run(text, "full")
    count = result.source_map.count(4)
    assert 0.9 * blocks <= count <= 1.1 * blocks
    told = result.certificate.measured
    assert told["tip off, mm"] <= limit
    assert told["tool axis off, degrees"] <= {36: 0.014, 81: 0.005}.get(blocks, 0.003)
    new = positions(result.text, "XYZAC")
    owner = np.array(result.source_map)
    rows = np.flatnonzero(owner == 4)
    axes = gx.Chain.tool_axis(chain, ends[:, 3:])
    for nth, row in enumerate(rows):
        part = (nth + np.linspace(0.0, 1.0, 41)) / len(rows)
        found = between(new[row - 1], new[row], 41)
        wanted = ends[0, :3] + part[:, None] * (ends[1, :3] - ends[0, :3])
        assert np.linalg.norm(tips(chain, found) - wanted, axis=1).max() <= limit + ROUNDED + 2e-6
        off = tool(chain, found[:, :3], found[:, 3:])[1] - on_a_circle(*axes, part)
        assert (
            np.degrees(np.linalg.norm(off, axis=1)).max() <= told["tool axis off, degrees"] + 1e-4
        )


def on_a_circle(one, other, part):
    """Return unit vectors between two, by a rotation of scipy."""
    pole = np.cross(one, other)
    whole = np.arcsin(np.linalg.norm(pole))
    turns = part[:, None] * whole * pole / np.linalg.norm(pole)
    return Rotation.from_rotvec(turns).apply(one)


@pytest.mark.parametrize("kind", KINDS)
def test_great_circles_of_any_machine(tmp_path, kind):
    """Tip on its line and tool axis on its circle, along blocks as they are written."""
    chain = chain_of_kind(kind, 4)
    letters = ("X", "Y", "Z", *chain.letters)
    poses = leaning_poses(chain, np.random.default_rng(5), 4, least=25.0, around=40.0)
    poses[:, :3] = (0.1 * poses[:, :3]).round(3)
    text = posted(poses, letters).replace(b"G1 X", b"G0 X", 1).replace(b"F600.\nX", b"\nG1 F600. X")
    options = {"tolerance": 0.01, "orientation_path": "great-circle", "rapids": "ends"}
    result = pipeline(tmp_path, machine_text(kind, chain), before="", **options).run(text, "full")
    old, new = positions(text, letters), positions(result.text, letters)
    owner = np.array(result.source_map)
    for line in range(4, len(old) - 1):
        rows = np.flatnonzero(owner == line)
        axes = chain.tool_axis(old[line - 1 : line + 1, 3:])
        for nth, row in enumerate(rows):
            part = (nth + np.linspace(0.0, 1.0, 9)) / len(rows)
            found = between(new[row - 1], new[row], 9)
            wanted = old[line - 1, :3] + part[:, None] * (old[line, :3] - old[line - 1, :3])
            off = np.linalg.norm(tips(chain, found) - wanted, axis=1).max()
            assert off <= 0.01 + ROUNDED + 2e-6
            off = tool(chain, found[:, :3], found[:, 3:])[1] - on_a_circle(*axes, part)
            assert np.degrees(np.linalg.norm(off, axis=1)).max() <= 0.1
        assert new[rows[-1], 3:] == pytest.approx(old[line, 3:])
