"""`rtcp` to another kind of machine, and what the eight errors of a trunnion come to."""

from __future__ import annotations

import numpy as np
import pytest
from gcxform_plugins.passes.rtcp.forward.choice import nearest
from gcxform_plugins.passes.rtcp.forward.correction_bound import bend_of_correction
from hypothesis import given
from hypothesis import strategies as st
from kinematics_kit import tool
from rtcp_kit import KINDS, between, chain_of_kind, machine_text, pipeline
from test_rtcp_repost import check_tools, leaning_poses, measured, posted

import gcxform as gx

PAIRS = [
    ("ac-trunnion", "bc-trunnion"),
    ("ac-trunnion", "ca-fork"),
    ("bc-trunnion", "c-table-b-head"),
    ("cb-fork", "ac-trunnion"),
    ("nutating-head", "bc-trunnion"),
    ("c-table-a-head", "cb-fork"),
]


def retargeted(folder, source, target, **options):
    """Return the pipeline from one kind with a chain to another."""
    (folder / "target.toml").write_text(machine_text(*target))
    options = {"tolerance": 0.01, "use": "retarget", "target": "target.toml"} | options
    options = {"before": "", "rapids": "ends", "decimals": 4} | options
    return pipeline(folder, machine_text(*source), **options)


def timed(text):
    """Return a posted program in G93."""
    return (
        text.replace(b"G94", b"G93")
        .replace(b"F600.", b"")
        .replace(b"\n", b" F2.\n")
        .replace(b"G54 F2.", b"G54")
        .replace(b"M30 F2.", b"M30")
    )


@pytest.mark.parametrize(("source", "target"), PAIRS)
@pytest.mark.parametrize("seed", [0, 5])
def test_a_program_for_another_machine(tmp_path, source, target, seed):
    """By matrices of scipy: tip and tool axis along every block, from one kind to another."""
    one, other = chain_of_kind(source, seed), chain_of_kind(target, seed + 1)
    letters = [("X", "Y", "Z", *chain.letters) for chain in (one, other)]
    poses = leaning_poses(one, np.random.default_rng(seed), 5, least=20.0, around=50.0)
    poses[1:] = (poses[:1] + 0.2 * (poses[1:] - poses[:1])).round(3)
    text = timed(posted(poses, letters[0])).replace(b"G1 X", b"G0 X", 1)
    text = text.replace(b"F2.\nX", b"F2.\nG1 X", 1)
    result = retargeted(tmp_path, (source, one), (target, other)).run(text, "full")
    dropped = set(letters[0]) - set(letters[1])
    assert not dropped & set(result.text.decode())
    lean = check_tools(text, result, (one, letters[0]), (other, letters[1]), 0.01, first=4)
    assert 1e-7 < lean <= np.radians(0.1)
    told = result.certificate.measured["tool axis off, degrees"]
    assert np.degrees(lean) <= told + 1e-9
    assert told <= 1.2 * np.degrees(lean) + 0.02 * 0.1


@given(st.integers(0, 100_000), st.sampled_from(KINDS), st.sampled_from([1.0, 10.0]))
def test_the_bound_holds_with_slips(seed, kind, size):
    """The same where the angles are corrected too, by amounts that differ at both ends."""
    rng = np.random.default_rng(seed)
    one = chain_of_kind(kind, seed)
    other = measured(one, seed + 1)
    linear = rng.uniform(-150.0, 150.0, (1, 3)) + rng.uniform(-size, size, (2, 3))
    angles = rng.uniform(-90.0, 90.0, (1, 2)) + rng.uniform(-size, size, (2, 2))
    slips = rng.uniform(-0.5, 0.5, (2, 2))
    ways = [(ends[:1], ends[1:]) for ends in (linear, angles, slips)]
    bound = bend_of_correction((one, other), *ways)[0]
    ends = other.linear(one.forward(linear, angles)[0], angles + slips)
    wanted = tool(one, between(*linear, 65), between(*angles, 65))[0]
    found = tool(other, between(*ends, 65), between(*(angles + slips), 65))[0]
    worst = np.linalg.norm(found - wanted, axis=1).max()
    assert worst <= bound + 1e-9


def eight_errors():
    """Return the trunnion of the reference, nominal and with its eight errors as lines."""
    a, c = np.array([5.0, -32.0, -95.0]), np.array([5.0, -20.0, -60.0])
    x, y, z = 0.021, -0.034, 0.046
    al, be, ga = 80e-6, -110e-6, 130e-6
    o, more, lean = c - a, -0.027, 60e-6
    moved_a = np.add(a, [0.0, y, z])
    moved_c = np.add(c, [x + be * o[2] - ga * o[1], y + more + ga * o[0] - al * o[2], 0.0])

    def axis(letter, way, point):
        unit = np.array(way) / np.linalg.norm(way)
        return gx.Rotary(letter, tuple(unit.tolist()), tuple(point.tolist()), -1)

    nominal = gx.Chain((axis("A", [1.0, 0.0, 0.0], a), axis("C", [0.0, 0.0, 1.0], c)))
    real = (axis("A", [1.0, ga, -be], moved_a), axis("C", [be + lean, -al, 1.0], moved_c))
    return nominal, gx.Chain(real)


def test_figures_of_the_eight_errors():
    """Up to 0.2 mm and 296 urad off; kept, the tip is right; corrected, the tool axis is too."""
    nominal, real = eight_errors()
    rng = np.random.default_rng(1)
    points = rng.normal(size=(2000, 3))
    points *= (150.0 * rng.uniform(size=2000) ** (1 / 3) / np.linalg.norm(points, axis=1))[:, None]
    angles = np.column_stack([rng.uniform(3, 90, 2000), rng.uniform(-180, 180, 2000)])
    angles[:, 0] *= rng.choice([-1, 1], 2000)
    linear = nominal.linear(points, angles)
    tip, axis = tool(nominal, linear, angles)
    off, lean = (f - w for f, w in zip(tool(real, linear, angles), (tip, axis), strict=True))
    far = np.linalg.norm(off, axis=1)
    assert far.max() == pytest.approx(0.198, rel=0.06)
    assert np.sqrt((far**2).mean()) == pytest.approx(0.0996, rel=0.05)
    assert np.linalg.norm(lean, axis=1).max() == pytest.approx(296e-6, rel=0.005)
    kept = tool(real, real.linear(tip, angles), angles)[0]
    assert np.linalg.norm(kept - tip, axis=1).max() <= 1e-9
    turned = nearest(real, axis, angles)
    found = tool(real, real.linear(tip, turned), turned)
    assert np.linalg.norm(found[0] - tip, axis=1).max() <= 1e-9
    assert np.linalg.norm(found[1] - axis, axis=1).max() <= 1e-9
    most = np.abs(turned - angles).max(axis=0)
    assert most[0] <= 0.0101
    assert 0.05 <= most[1] <= 0.17
