"""What the proof of tool vectors sees, and what else refuses programs that have them."""

from __future__ import annotations

import numpy as np
import pytest
from gcxform_plugins.passes.rtcp.forward.vectors import InProportion
from rtcp_kit import (
    LENGTH,
    axes,
    chain_of_kind,
    tips,
)
from vectors_kit import (
    MODES,
    pointed,
    several,
    whole,
    winding,
)

import gcxform as gx
from gcxform.contract.tip_codes import with_vectors


def proved(folder, change, mode="angles"):
    """Let the proof look at a path that was changed after it was made."""
    chain = chain_of_kind("ac-trunnion", 3)
    step = pointed(folder, "ac-trunnion", chain, mode)
    rtcp = next(one for one in step.path_passes if one.name == "rtcp")
    text = several(chain, 1).replace(b"G43.5", b"G43")
    source = gx.Program(text, with_vectors(step.source), step.machine_reading).path
    after = rtcp.apply(source, step.context)
    rtcp.prove(source, after, step.context)
    rtcp.prove(source, change(after), step.context)


def turned(column, rows, by):
    """Return a change of one axis in some rows."""

    def change(path):
        end = path.end.copy()
        end[rows, column] += by
        return path.replace(end=end)

    return change


def as_it_is(path):
    return path


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize(
    ("column", "rows", "by"),
    [(4, -20, 0.002), (3, slice(3, None), 0.002), (2, -20, 0.02), (0, -1, 0.001), (3, 30, 0.002)],
)
def test_the_proof_sees_it(tmp_path, mode, column, rows, by):
    with pytest.raises(gx.VerificationError):
        proved(tmp_path, turned(column, rows, by), mode)


@pytest.mark.parametrize(("factor", "by"), [(1.0, -360.0), (1.0, 360.0), (-1.0, 180.0)])
def test_the_proof_sees_ways_round_about(tmp_path, monkeypatch, factor, by):
    """Tips, and tool axes at the ends of blocks, are right; the axes take another way there."""
    choose = InProportion._choose

    def wrong(self):
        choose(self)
        cut = np.flatnonzero(self.cuts)[4]
        self.said[cut:, 0] *= factor
        self.said[cut:, 1] += by

    monkeypatch.setattr(InProportion, "_choose", wrong)
    with pytest.raises(gx.VerificationError, match="round about"):
        proved(tmp_path, as_it_is)


def test_the_proof_sees_what_is_out_of_proportion(tmp_path):
    """The tip is where it was, the tool axis nearly so."""
    chain = chain_of_kind("ac-trunnion", 3)
    tipped = [0, 1, 2, 3, 4]

    def change(path):
        row = int(np.flatnonzero(path.kind == gx.Kind.LINE)[2])
        end = path.end.copy()
        length = np.array([0.0, 0.0, LENGTH, 0.0, 0.0])
        words = end[row : row + 1, tipped] - length
        moved = words + np.array([0.0, 0.0, 0.0, 0.0, 0.001])
        moved[:, :3] = axes(chain, np.hstack([tips(chain, words), moved[:, 3:]]))
        end[row, tipped] = moved[0] + length
        return path.replace(end=end)

    with pytest.raises(gx.VerificationError, match="proportion"):
        proved(tmp_path, change)


def test_the_proof_sees_an_axis_that_should_have_stayed(tmp_path):
    """After G49 C is where it was: a turn of it is none of the source."""

    def change(path):
        first = int(np.flatnonzero(path.form == gx.Form.MACHINE)[0])
        return turned(4, first, 1.0)(path)

    with pytest.raises(gx.VerificationError, match="outside"):
        proved(tmp_path, change)


def test_the_proof_sees_a_missing_turn(tmp_path):
    """In G93 the last block may turn the tool about its tip; without it nothing else changes."""
    chain = chain_of_kind("ac-trunnion", 3)
    blocks = ["G0 X0. Y0. Z0. J-1. K1.", "G1 I1. J0. K1. F9."]
    text = whole(blocks, chain, "G93").replace(b"G43.5", b"G43")
    step = pointed(tmp_path, "ac-trunnion", chain)
    rtcp = next(one for one in step.path_passes if one.name == "rtcp")
    source = gx.Program(text, with_vectors(step.source), step.machine_reading).path
    after = rtcp.apply(source, step.context)
    rtcp.prove(source, after, step.context)
    kept = np.flatnonzero(after.kind != gx.Kind.LINE)
    end = after.end[kept].copy()
    end[3, :2] = end[2, :2]  # after G49 they stay where they are then
    told = after.take(kept).replace(end=end, events=())
    with pytest.raises(gx.VerificationError, match="missing"):
        rtcp.prove(source.replace(events=()), told, step.context)


# --- what stays as it is ---


def test_other_chains_refuse_it():
    """Whatever asks for positions refuses G43.5 by name; what edits text copies it."""
    text = whole(winding(0.2), chain_of_kind("ac-trunnion", 3))
    for chain in ("absolute", "metric", "feed mode=inverse-time", "offsets | absolute"):
        with pytest.raises(gx.InputError) as error:
            gx.Pipeline.parse(chain, "fanuc").run(text)
        assert {d.code for d in error.value.diagnostics} == {"GX210"}
    edited = gx.Pipeline.parse("renumber", "fanuc").run(text).text
    assert edited.count(b"I0.") == text.count(b"I0.")
    with pytest.raises(gx.InputError, match=r"G43\.5"):
        gx.read(text, "fanuc").path  # noqa: B018


def test_angles_are_not_read_as_vectors(tmp_path):
    chain = chain_of_kind("ac-trunnion", 3)
    step = pointed(tmp_path, "ac-trunnion", chain)
    for code in ("G43.4", "G43"):
        text = f"G21 G90 G94 G17 G54\nG0 X0. Y0. A0. C0.\n{code} H1 Z9.\nG1 X3. A3. F9.\nM30\n"
        with pytest.raises(gx.InputError) as error:
            step.run(text.encode())
        assert {d.code for d in error.value.diagnostics} <= {"GX210", "GX330"}
    with pytest.raises(gx.InputError, match="positions of axes"):
        step.run(whole(["G43 H1"], chain))


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"rapids": "refuse"}, 'rapids = "ends"'),
        ({"use": "to-tip"}, "unknown key 'tip-codes'"),
        ({"use": "retarget", "target": "machine.toml"}, "unknown key 'tip-codes'"),
        ({"retract": "5 mm", "retract_feed": 500.0}, "retract"),
    ],
)
def test_options_that_do_not_fit(tmp_path, options, message):
    chain = chain_of_kind("ac-trunnion", 3)
    with pytest.raises(gx.UsageError, match=message):
        pointed(tmp_path, "ac-trunnion", chain, **options)
