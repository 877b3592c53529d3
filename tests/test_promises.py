"""What steps promise counts: in the budget, in `largest`, and in what `check` says."""

from __future__ import annotations

import pytest
from rtcp_kit import chain_of_kind, machine_text, pipeline, program
from test_rtcp_tips import farthest, poses_of, steps_of

import gcxform as gx
from gcxform.cli.check import chain as chain_in_words
from gcxform.diagnostics import UsageError

TOLERANCE = 0.05
KIND = "ac-trunnion"
GREAT = {"tolerance": TOLERANCE, "orientation_path": "great-circle", "axis_tolerance": 5.0}


def great(folder, **others):
    return pipeline(
        folder, machine_text(KIND, chain_of_kind(KIND, 3)), 3, "", **{**GREAT, **others}
    )


TEXT = b"""G21 G90 G94 G17 G54
G0 X0. Y0. A0. C0.
G43 H1 Z0.
G1 A45. F900.
G1 C60. F900.
M30
"""


def test_a_tip_that_is_proved_by_itself_counts_in_largest(tmp_path):
    steps = great(tmp_path)
    found = steps.run(TEXT).certificate
    tip, axis = found.measured["tip off, mm"], found.measured["tool axis off, degrees"]
    assert tip > 0.005
    assert tip <= found.largest["deviation"] <= found.budget["deviation"]
    assert found.budget["deviation"] == pytest.approx(TOLERANCE + steps.rounding())
    assert found.budget["steps"] == TOLERANCE
    assert axis <= found.largest["angle"] <= found.budget["angle"]
    assert any("50 um, proved by itself" in line for line in chain_in_words(steps))


def test_a_budget_binds_what_proves_itself(tmp_path):
    made = great(tmp_path)
    with pytest.raises(UsageError, match="GX724"):
        gx.Pipeline(made.source, made.target, made.passes, made.reading, made.machine, budget=0.001)


def test_what_is_written_has_no_more_room_than_before(tmp_path):
    steps = great(tmp_path)
    assert steps.limit_of_written(False, False, False) == pytest.approx(steps.rounding())
    rotary = steps.angle_limits(written=True)["C"]
    assert rotary == pytest.approx(1.01e-3)
    assert steps.angle_limits()["C"] == pytest.approx(rotary + 5.0)


def test_the_tip_of_axes_that_become_tips_counts(tmp_path):
    chain = chain_of_kind(KIND, 3)
    steps = steps_of(tmp_path, KIND, chain, 4, TOLERANCE)
    text = program(poses_of(10.0, 20.0), ("X", "Y", "Z", *chain.letters), "F60.")
    result = steps.run(text)
    off = farthest(text, result, chain)
    assert off > 0.002
    assert off <= result.certificate.largest["deviation"] + 0.002


@pytest.mark.parametrize(
    ("program_text", "arcs"), [("G1 X50. F100\n", False), ("G2 X50. I25. F100\n", True)]
)
def test_room_for_arcs_is_only_where_there_are_arcs(program_text, arcs):
    steps = gx.Pipeline.parse("absolute", "fanuc")
    found = steps.run(f"G21 G17 G90 G94\nG0 X0 Y0 Z0\n{program_text}M2\n".encode()).certificate
    assert found.budget["deviation"] == steps.limit(arcs=arcs)
    assert steps.limit() - steps.limit(arcs=False) == pytest.approx(0.002)
    assert chain_in_words(steps)[-1].startswith("budget    0.866 um (2.866 um if there are arcs)")
