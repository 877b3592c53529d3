"""`rtcp` of axes: the tip itself, at angles that are rounded where lines are cut.

An angle that is rounded moves the tip by its lever. The axes do not show it: they stand where they
would have stood. So the oracle, matrices of scipy, compares tips, at the same part of every block.
"""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
from gcxform_plugins.passes.rtcp.forward.cutting import Cutting
from rtcp_kit import (
    ROUNDED,
    SEGMENT,
    between,
    chain_of_kind,
    machine_text,
    pipeline,
    positions,
    program,
)
from rtcp_kit import tips as tips_of
from test_rtcp import FORMS, ROOM

import gcxform as gx

TOLERANCE = 0.002
POSES = np.array([[0.0, 0, 0, 0, 0], [1, 0.2, 0.1, 0.3, 0.4], [0.1, 0.9, 0.3, 0.23, 0.11]])
REFUSED = r"GX330.*angles as they are written would take the tip"


def poses_of(reach, turn):
    """Return poses (n, 5) that go so far in X, Y and Z and turn by so many degrees."""
    poses = POSES * [reach, reach, reach, turn, turn]
    return np.vstack([poses[1:], poses[1:] * 0.6]).round(3)


def farthest(text, result, chain):
    """Return how far (mm) the tip of what is written is from that of the source."""
    letters = ("X", "Y", "Z", *chain.letters)
    old, new = positions(text, letters), positions(result.text, letters)
    owner, worst = np.array(result.source_map), 0.0
    for line in range(3, len(old) - 1):
        rows = np.flatnonzero(owner == line)
        for nth, row in enumerate(rows):
            part = (nth + np.linspace(0.0, 1.0, 33)[:, None]) / len(rows)
            wanted = tips_of(chain, old[line - 1] + part * (old[line] - old[line - 1]))
            found = between(new[row - 1], new[row])[:, :3]
            worst = max(worst, float(np.linalg.norm(found - wanted, axis=1).max()))
    return worst


def steps_of(folder, kind, chain, decimals, tolerance=TOLERANCE, **others):
    """Return the pipeline of axes to tips, with so many decimals for angles."""
    each = ", ".join(f"{letter} = {decimals}" for letter in "ABC")
    options = {"tolerance": tolerance, "use": "to-tip"} | others
    return pipeline(folder, machine_text(kind, chain), f"{{ {each} }}", **options)


def outcome(steps, text):
    """Return the result of a run, or none and why it is refused."""
    try:
        return steps.run(text, "full"), ""
    except gx.InputError as error:
        return None, re.search(REFUSED + r"(?s:.*)", str(error))[0]


@pytest.mark.parametrize("decimals", [2, 3, 4])
@pytest.mark.parametrize("length", [60.0, 600.0])
@pytest.mark.parametrize("reach", [40.0, 500.0])
@pytest.mark.parametrize("kind", FORMS)
def test_the_tip_is_within_its_tolerance(tmp_path, monkeypatch, kind, length, reach, decimals):
    """Or the program is refused, where angles of so many decimals take the tip too far."""
    monkeypatch.setattr("rtcp_kit.LENGTH", length)
    chain = chain_of_kind(kind, 5)
    text = program(poses_of(reach, 30.0), ("X", "Y", "Z", *chain.letters), feed="F2.")
    lever = (length if chain.head else 0.0) + 2.0 * reach + 400.0
    most = 2.0 * lever * np.radians(0.5 * 10.0**-decimals)
    refused = 0
    for tolerance in (TOLERANCE, float(2.0 * most)):
        result, error = outcome(steps_of(tmp_path, kind, chain, decimals, tolerance), text)
        if result is not None:
            assert farthest(text, result, chain) <= tolerance + ROUNDED + ROOM
            continue
        assert tolerance == TOLERANCE
        assert f"= {decimals + 1}" in error
        refused += 1
    assert refused <= (most > 0.7 * TOLERANCE)


@pytest.mark.parametrize("kind", FORMS)
def test_what_rounded_angles_leave_is_used(tmp_path, kind):
    """Where they take a large part of the tolerance, there are more pieces, not fewer."""
    chain = chain_of_kind(kind, 5)
    text = program(poses_of(90.0, 70.0), ("X", "Y", "Z", *chain.letters), feed="F2.")
    counts = []
    for decimals in (2, 5):
        result = steps_of(tmp_path, kind, chain, decimals, 0.04).run(text, "full")
        assert farthest(text, result, chain) <= 0.04 + ROUNDED + ROOM
        counts.append(len(result.source_map))
    assert counts[1] < counts[0] < 2 * counts[1]


@pytest.mark.parametrize("kind", FORMS)
def test_the_proof_follows_tips(tmp_path, monkeypatch, kind):
    """A cutting that forgets what angles do to the tip is found out before anything is written."""
    chain = chain_of_kind(kind, 5)
    text = program(poses_of(500.0, 31.7), ("X", "Y", "Z", *chain.letters), feed="F2.")
    steps = steps_of(tmp_path, kind, chain, 2)
    monkeypatch.setattr(Cutting, "_check_astray", lambda self, astray, row: None)
    monkeypatch.setattr(Cutting, "_apart", lambda self, one, other, row: np.zeros(len(row)))
    with pytest.raises(gx.VerificationError, match=r"GX606.*the tip is 0\.0\d+ mm off"):
        steps.run(text, "full")


@pytest.mark.parametrize("code", ["G1", "G0"])
def test_where_blocks_end(tmp_path, code):
    """An angle with more decimals than are written is rounded without being cut."""
    chain = chain_of_kind("ac-trunnion", 5)
    head = "G21 G90 G93 G17 G54\nG0 X0. Y0. A0. C0.\nG43 H1 Z0.\n"
    text = f"{head}G0 X200. Y90.\n{code} A20.0049 C0. F2.\nG1 X90. F2.\nM30\n".encode()
    with pytest.raises(gx.InputError, match=r":5:.*" + REFUSED):
        steps_of(tmp_path, "ac-trunnion", chain, 2, 0.005, rapids="ends").run(text)
    result = steps_of(tmp_path, "ac-trunnion", chain, 2, 0.05, rapids="ends").run(text, "full")
    old, new = positions(text, "XYZAC"), positions(result.text, "XYZAC")
    far = np.linalg.norm(tips_of(chain, old[-1:]) - new[-1:, :3])
    assert 0.005 < far <= 0.05


@pytest.mark.parametrize("kind", FORMS)
def test_what_is_measured_where_lines_are_cut_before(tmp_path, kind):
    """Pieces of a line that a step before has cut are compared each with its own piece."""
    chain = chain_of_kind(kind, 5)
    text = program(poses_of(90.0, 30.0), ("X", "Y", "Z", *chain.letters), feed="F2.")
    steps = steps_of(tmp_path, kind, chain, 4, before=SEGMENT + 'max-length = "7 mm"\n')
    result = steps.run(text, "full")
    assert 0.0 < result.certificate.measured["tip off, mm"] <= TOLERANCE


@pytest.mark.parametrize("decimals", [2, 3])
@pytest.mark.parametrize("kind", FORMS)
def test_a_corrected_program(tmp_path, kind, decimals):
    """The same of `repost`, whose blocks are cut where the machines differ by much."""
    chain = chain_of_kind(kind, 5)
    moved = [replace(axis, point=tuple(np.add(axis.point, 3.0))) for axis in chain.axes]
    count = len(chain.table)
    other = replace(chain, table=tuple(moved[:count]), head=tuple(moved[count:]))
    (tmp_path / "measured.toml").write_text(machine_text(kind, other))
    letters = ("X", "Y", "Z", *chain.letters)
    poses = poses_of(300.0, 60.0).round(decimals)
    text = program(poses, letters, feed="F2.")
    steps = steps_of(
        tmp_path, kind, chain, decimals, 0.004, use="repost", calibrated="measured.toml"
    )
    found, _ = outcome(steps, text)
    if found is None:
        return
    old, new, owner = positions(text, letters), positions(found.text, letters), found.source_map
    for line in range(3, len(old) - 1):
        rows = np.flatnonzero(np.array(owner) == line)
        for nth, row in enumerate(rows):
            part = (nth + np.linspace(0.0, 1.0, 33)[:, None]) / len(rows)
            wanted = tips_of(chain, old[line - 1] + part * (old[line] - old[line - 1]))
            gone = tips_of(other, between(new[row - 1], new[row]))
            far = np.linalg.norm(gone - wanted, axis=1).max()
            assert far <= 0.004 + ROUNDED + ROOM
