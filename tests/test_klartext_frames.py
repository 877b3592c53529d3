"""Cycles 8 and 10 of a TNC, and TRANS: held to points that are turned by other means.

Cycle 10 turns about the active datum (TNC 320, 340 55x-04, p. 258); what an axis does that has not
been told since is not known.
"""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest
from gcxform_plugins.passes.absolute import Absolute
from gcxform_plugins.passes.offsets import Offsets
from heidenhain_kit import DIALECT, TOOLS, program, read

import gcxform as gx
from gcxform.modal.state import Reading
from gcxform.pipeline.pipeline import Pipeline
from gcxform.plugin.registry import default_registry

START = {"X": 0.0, "Y": 0.0, "Z": 50.0}
SHIFT = ("CYCL DEF 7.0", "CYCL DEF 7.1 X+100 Y-20")
TURN = ("CYCL DEF 10.0 ROTATION", "CYCL DEF 10.1 ROT+30")
BACK = ("CYCL DEF 10.0 DREHUNG", "CYCL DEF 10.1 ROT+0")
MIRROR = ("CYCL DEF 8.0 MIRROR IMAGE", "CYCL DEF 8.1 X")
HOLE = "CYCL DEF 240 CENTERING Q200=1 Q343=0 Q201=-2 Q344=-9 Q206=150 Q211=0 Q203=+0 Q204=20"
ROW = (
    "CYCL DEF 221 Q225=15 Q226=5 Q237=10 Q238=8 Q242=3 Q243=1 Q224=45 Q200=1 Q203=0 Q204=20 Q301=1"
)


def path_of(*lines):
    return read(program("L X+0 Y+0 Z+20 F100", *lines), start=START, tools=TOOLS)


def places(path):
    return [complex(*end) for end in path.end[:, :2]]


def turned(x, y, angle=30):
    return complex(x, y) * cmath.rect(1, math.radians(angle))


def test_words_are_turned_about_the_zero_in_force():
    found = places(path_of(*SHIFT, *TURN, "L X+10 Y+0", "L IY+5", *BACK, "L X+1 Y+2"))
    zero = 100 - 20j
    wanted = [0, zero + turned(10, 0), zero + turned(10, 5), zero + 1 + 2j]
    assert found == pytest.approx(wanted)


def test_steps_of_the_angle_add_and_a_parameter_may_say_it():
    lines = ("Q1 = 45", "CYCL DEF 10.1 ROT+Q1", "CYCL DEF 10.1 IROT+45", "L X+10 Y+0")
    assert places(path_of(*lines))[-1] == pytest.approx(10j)


def test_a_circle_is_turned_and_a_mirrored_one_turns_the_other_way():
    circle = ("L X+10 Y+5 F100", "CC X+10 Y+0", "C X+15 Y+0 DR-")
    path = path_of(*TURN, *circle)
    assert (path.kind[-1], places(path)[-1]) == (2, pytest.approx(turned(15, 0)))
    path = path_of(*MIRROR, *circle)
    assert (path.kind[-1], places(path)[-1]) == (3, -15)
    assert path.centre[-1, :2].tolist() == [-10, 0]


def test_places_of_a_pattern_are_turned_as_well():
    found = places(path_of(*TURN, HOLE, ROW))
    along = [complex(15, 5) + cmath.rect(10 * k, math.radians(45)) for k in range(3)]
    holes = [
        place for place, kind in zip(found, path_of(*TURN, HOLE, ROW).kind, strict=True) if kind
    ]
    assert holes[1:] == pytest.approx([turned(p.real, p.imag) for p in along])


def test_an_axis_that_has_not_been_told_is_not_known():
    assert np.isnan(path_of(*TURN, "L X+10").end[-1, :2]).all()
    assert np.isnan(path_of(*MIRROR, "L Y+10").end[-1, 0])
    steps = (*TURN, "L IX+10"), (*MIRROR, "L IX+10"), (*TURN, "CC X+0 Y+0", "C X+1 Y+1 DR+")
    for step in steps:
        with pytest.raises(gx.InputError, match="is not known"):
            path_of(*step)


def test_trans_is_the_same():
    lines = ("TRANS MIRROR AXIS X Y", "L X+1 Y+2", "TRANS MIRROR RESET", "L X+1 Y+2")
    more = ("TRANS ROTATION ROT+90", "L X+1 Y+2", "TRANS ROTATION RESET", "L X+1 Y+2")
    assert places(path_of(*lines, *more)) == pytest.approx([0, -1 - 2j, 1 + 2j, -2 + 1j, 1 + 2j])


@pytest.mark.parametrize(
    ("lines", "why"),
    [
        ((*TURN, *SHIFT), "in turned or mirrored"),
        ((*TURN, "TRANS DATUM AXIS X+5"), "in turned or mirrored"),
        ((*TURN, *MIRROR), "the order"),
        ((*MIRROR, *TURN), "the order"),
        ((*TURN, "M128"), "M128 in turned"),
        (("M128", *TURN), "follows the tip"),
        (("TOOL CALL 1 Z", "L X+1 Y+1 RL F9", *TURN), "radius compensation"),
        (("TOOL CALL 1 Z", *MIRROR, "L X+1 Y+1 RL F9"), "in mirrored"),
        (("TRANS MIRROR AXIS Z", HOLE, "L Z+20 FMAX", "CYCL CALL"), "along the tool"),
        (("CYCL DEF 8.1 A",), "a mirror image of A"),
        (("CYCL DEF 11.0", "CYCL DEF 11.1 SCL 0.5"), "a scale"),
        (("CYCL DEF 10.1 ROT",), "is not resolved"),
    ],
)
def test_what_controls_do_each_in_their_way_is_refused(lines, why):
    with pytest.raises(gx.InputError, match=why):
        path_of(*lines)


def test_it_is_written_back_and_for_another_control():
    text = program("L X+0 Y+0 Z+20 F100", *TURN, "L X+10 Y+0", "L IY+5", *BACK, "L X+1 Y+1")
    made = Pipeline(DIALECT, DIALECT, (Absolute(),), Reading(START)).run(text.encode())
    assert made.text.decode() == text.replace("IY+5", "Y+5")
    linuxcnc = default_registry().dialect("linuxcnc")
    made = Pipeline(DIALECT, linuxcnc, (Offsets(),), Reading(START)).run(text.encode())
    ends = gx.read(made.text, linuxcnc, start=START).path.end[:, :2]
    assert ends == pytest.approx(
        path_of(*TURN, "L X+10 Y+0", "L IY+5", *BACK, "L X+1 Y+1").end[:, :2], abs=1e-3
    )


def test_g68_about_the_zero_is_cycle_10():
    fanuc = default_registry().dialect("fanuc")
    text = b"G21 G17 G90 G94\nG0 X0. Y0. Z5.\n%s\nG1 X10. Y0. F100.\nG69\nG0 X0. Y0.\nM30\n"
    made = Pipeline(fanuc, DIALECT, (), Reading(START)).run(text % b"G68 X0. Y0. R30.")
    assert b"CYCL DEF 10.1 ROT+30" in made.text
    assert places(read(made.text.decode(), start=START))[1] == pytest.approx(turned(10, 0))
    with pytest.raises(gx.GcxformError, match="about another point"):
        Pipeline(fanuc, DIALECT, (), Reading(START)).run(text % b"G68 X1. Y0. R30.")


@pytest.mark.parametrize("turn", [TURN, ("PLANE SPATIAL SPA+0 SPB+3 SPC+0 STAY",)])
def test_a_move_in_the_machine_loses_all_that_is_turned(turn):
    moves = ("L X+5 Y+0 Z+3 R0 F100", "L X+100 FMAX M91", "L IY+5", "L IZ+1")
    text = program("L X+0 Y+0 Z+20 F100", *turn, *moves)
    made = Pipeline(DIALECT, DIALECT, (Absolute(),), Reading(START)).run(text.encode())
    assert made.text.decode() == text
