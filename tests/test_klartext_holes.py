"""Cycles 201, 203, 240, 220, 221 and PATTERN DEF of a TNC as moves, as the manuals have them.

Cycle 220: TNC 640, cycles (34059x-01), p. 162; cycle 221: TNC 410, ISO, p. 257.
"""

from __future__ import annotations

import numpy as np
import pytest
from gcxform_plugins.passes.absolute import Absolute
from heidenhain_kit import DIALECT, TOOLS, program, read

import gcxform as gx
from gcxform.modal.state import Reading
from gcxform.pipeline.pipeline import Pipeline

START = {"X": 0.0, "Y": 0.0, "Z": 50.0}

REAM = "CYCL DEF 201 REAMING Q200=2 Q201=-15 Q206=100 Q211=0.5 Q208=250 Q203=+0 Q204=20"
CENTRE = "CYCL DEF 240 CENTERING Q200=1 Q343=0 Q201=-2 Q344=-9 Q206=150 Q211=0 Q203=+0 Q204=20"
ROUND = "CYCL DEF 220 POLAR Q216=50 Q217=50 Q244=80 Q245={} Q246={} Q247={} Q241={} {}"
ROW = "CYCL DEF 221 LINES Q225=15 Q226=15 Q237=10 Q238=8 Q242=6 Q243={} Q224={} {}"
COMMON = "Q200=2 Q203=0 Q204=20 Q301=1"


def moves(*lines):
    path = read(program("L X+1 Y+2 Z+20 FMAX", *lines), tools=TOOLS)
    return path, np.round(path.end[:, :3], 4).tolist()


def holes(pattern):
    path, ends = moves(CENTRE, pattern)
    return [end[:2] for end, kind in zip(ends, path.kind, strict=True) if kind == 1]


@pytest.mark.parametrize(("out", "feed"), [("250", 250), ("0", 100)])
def test_a_reamer_leaves_at_a_feed(out, feed):
    path, ends = moves(REAM.replace("Q208=250", f"Q208={out}"), "CYCL CALL")
    assert [end[2] for end in ends] == [20, 2, -15, 2, 20]
    assert path.kind.tolist() == [0, 0, 1, 1, 0]
    assert path.feed[2:4].tolist() == [100, feed]


def test_a_hole_is_centred_by_its_depth():
    path, ends = moves(CENTRE, "L X+5 FMAX M99")
    assert [end[2] for end in ends] == [20, 20, 1, -2, 20]
    assert path.kind.tolist() == [0, 0, 0, 1, 0]


def test_holes_around_begin_at_the_first_angle_and_do_not_meet_it_again():
    places = holes(ROUND.format(0, 360, 0, 8, COMMON))
    assert len(places) == 8
    assert places[:3] == [[90, 50], pytest.approx([78.2843, 78.2843]), [50, 90]]


def test_holes_along_an_arc_end_at_the_last_angle():
    assert holes(ROUND.format(0, 180, 0, 3, COMMON)) == [[90, 50], [50, 90], [10, 50]]
    assert holes(ROUND.format(90, 0, -90, 2, COMMON)) == [[50, 90], [90, 50]]


def test_holes_in_a_row_are_turned_about_the_first_one():
    assert holes(ROW.format(1, 90, COMMON)) == [[15, y] for y in (15, 25, 35, 45, 55, 65)]


def test_the_surface_is_that_of_the_pattern():
    _, ends = moves(CENTRE, ROW.format(1, 0, "Q200=3 Q203=-10 Q204=30 Q301=1"))
    assert [end[2] for end in ends[1:5]] == [20, -7, -12, 20]


def test_a_cycle_may_be_run_by_two_patterns():
    row = ROW.format(1, 0, COMMON)
    path, _ = moves(CENTRE, row, row)
    assert (path.kind == 1).sum() == 12


PECKS = "Q200=2 Q201=-15 Q206=100 Q202=6 Q203=+0 Q204=20 Q211=0.5"
DRILL = f"CYCL DEF 200 DRILLING {PECKS} Q210=0.2"
DEEP = f"CYCL DEF 205 PECKING {PECKS} Q212={{}} Q205={{}} Q258={{}} Q259={{}} Q257=0 Q256=0.2"


def levels(cycle, **control):
    text = program("L X+1 Y+2 Z+20 FMAX", cycle, "CYCL CALL")
    path = read(text, tools=TOOLS, control=control)
    waits = [event.row for event in path.events if event.what == "DWELL"]
    return list(zip(path.kind.tolist()[1:], path.end[1:, 2].tolist(), strict=True)), waits


def test_strokes_go_down_to_over_the_ground():
    found, waits = levels(DRILL, **{"peck-clearance": 0.5})
    down = [(0, 2), (1, -6), (0, 2), (0, -5.5), (1, -12), (0, 2), (0, -11.5), (1, -15), (0, 20)]
    assert found == down
    assert waits == [4, 7, 9]
    same = [(kind, round(z, 9)) for kind, z in levels(DEEP.format(0, 0, 0.5, 0.5))[0]]
    assert same == down


def test_strokes_become_shorter():
    found, _ = levels(DEEP.format(2, 3, 0.5, 0.5))
    assert [z for kind, z in found if kind] == [-6, -10, -13, -15]


@pytest.mark.parametrize(
    ("cycle", "why"),
    [
        (DRILL, "feeds again is not certain"),
        (DEEP.format(0, 0, 0.5, 0.2), "feeds again is not certain"),
        (DEEP.format(0, 0, 9, 9), "feeds again is not certain"),
        (DEEP.format(6, 0, 0.5, 0.5), "several strokes, upwards"),
        (DEEP.format(0, 0, 0.5, 0.5).replace("Q257=0", "Q257=2"), "chips that are broken"),
        ("CYCL DEF 202 BORING Q200=2", "a boring bar"),
        ("CYCL DEF 206 TAPPING NEU Q200=2", "tied to the spindle"),
        ("CYCL DEF 208 BORE MILLING Q200=2", "no manual tells"),
        ("CYCL DEF 262 THREAD MILLING Q335=5", "no manual tells"),
        ("CYCL DEF 257 CIRCULAR STUD Q223=50", "a stud"),
        ("CYCL DEF 14.0 CONTOUR", "a contour"),
        ("CYCL DEF 299 OURS Q1=3", "a cycle of the control"),
    ],
)
def test_what_the_control_does_in_its_way_is_refused_by_name(cycle, why):
    with pytest.raises(gx.InputError, match=why):
        levels(cycle)


UNIVERSAL = (
    "CYCL DEF 203 UNIVERSAL DRILLING ~",
    "Q200=2 ~",
    "Q201=-5 ~",
    "Q206=150 ~",
    "Q202=5 ~",
    "Q210=0 ~",
    "Q203=+10 ~",
    "Q204=20 ~",
    "Q212=0 ~",
    "Q213=3 ~",
    "Q205=1 ~",
    "Q211=0.5 ~",
    "Q208=500 ~",
    "Q256=0.2",
)
POINTS = (
    "PATTERN DEF ~",
    "POS1( X+3 Y+4 Z+0 ) ~ ; the first",
    "POS2 (X-5,5 Y+6 Z+0)",
    "L X+0 Y+0 Z+30 FMAX",
)


def test_a_hole_of_one_stroke_leaves_at_its_own_feed():
    path = read(program(*UNIVERSAL, "L X+1 Y+2 Z+30 FMAX", "CYCL CALL M3"), start=START)
    assert path.end[1:, 2].tolist() == [12, 5, 12, 30]
    assert path.feed[2:4].tolist() == [150, 500]
    assert [event.what for event in path.events if event.row == 1][:1] == ["M3"]


def test_a_cycle_is_called_at_each_place_in_order():
    path = read(program(*UNIVERSAL, *POINTS, "CYCL CALL PAT FMAX M8"), start=START)
    there = path.end[[1, 6], :2].tolist()
    assert there == [[3, 4], [-5.5, 6]]
    assert path.end[[1, 6], 2].tolist() == [30, 30]
    assert path.end[-1].tolist()[:3] == [-5.5, 6, 30]


@pytest.mark.parametrize(
    ("lines", "why"),
    [
        (("PATTERN DEF ~", "POS1( X+3 Y+4 Z+1 )"), "another Z"),
        (("PATTERN DEF ROW1 (X+3 Y+4 D+5 NUM3 ROT+0 Z+0)",), "other than POS"),
        ((*POINTS, "L Z+40 FMAX", "CYCL CALL PAT FMAX"), "from elsewhere"),
        ((*POINTS, "CYCL CALL PAT F500"), "is not resolved"),
        ((*POINTS, "CYCL CALL POS X+1 Y+1 Z+0 FMAX"), "is not resolved"),
        (("L Z+30 FMAX", "CYCL CALL PAT FMAX"), "no cycle and places"),
        ((*POINTS, "CYCL CALL M9"), "at the end of a call"),
    ],
)
def test_places_that_are_not_certain_are_refused(lines, why):
    with pytest.raises(gx.InputError, match=why):
        read(program(*UNIVERSAL, *lines), start=START)


def test_places_that_are_kept_are_not_those_before():
    row = "PATTERN DEF ROW1 (X+3 Y+4 D+5 NUM3 ROT+0 Z+0)"
    points = (*POINTS, row, POINTS[-1], "CYCL CALL PAT FMAX")
    text = program(*UNIVERSAL, *points, "L IX+5 FMAX")
    result = Pipeline(DIALECT, DIALECT, (Absolute(),), Reading(START)).run(text.encode())
    assert result.text.decode() == text


@pytest.mark.parametrize(
    ("lines", "why"),
    [
        ((CENTRE.replace("Q343=0", "Q343=1"), "CYCL CALL"), "by the diameter"),
        ((CENTRE + " Q395=1", "CYCL CALL"), "not known"),
        ((REAM.replace("Q208=250", ""), "CYCL CALL"), "lacks"),
        ((CENTRE, ROW.format(2, 0, COMMON)), "order"),
        ((CENTRE, ROUND.format(0, 0, 0, 8, COMMON)), "order"),
        ((CENTRE, ROUND.format(0, 360, 0, 8, COMMON.replace("Q301=1", "Q301=0"))), "where it ends"),
        ((CENTRE, ROUND.format(0, 360, 0, 8, f"{COMMON} Q365=1")), "where it ends"),
        ((CENTRE, "L Z+50 FMAX", ROW.format(1, 0, COMMON)), "from elsewhere"),
        ((ROW.format(1, 0, COMMON),), "no cycle"),
        ((CENTRE, "Q201 = -5", "CYCL CALL"), "behind its definition"),
        ((CENTRE, ROW.format(1, 0, COMMON), "CYCL CALL"), "lacks"),
    ],
)
def test_what_is_not_certain_is_refused(lines, why):
    with pytest.raises(gx.InputError, match=why):
        moves(*lines)
