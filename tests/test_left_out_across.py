"""What may be left out for another control, numbers with points, ways home of all axes."""

from __future__ import annotations

from functools import partial

import across_kit
import pytest

from gcxform.modal.state import Reading

HOMES = {"G28": {"X": 10.0, "Y": 20.0, "Z": 450.0}}
OFFSETS = {"G54": {"X": 1.0, "Y": 2.0, "Z": 100.0}}
START = Reading({"X": 0.0, "Y": 0.0, "Z": 0.0}, homes=HOMES, work_offsets=OFFSETS)
said, refused = partial(across_kit.said, START), partial(across_kit.refused, START)


OPTIONS = [
    ("#45=3", "#", ["G0 X1."]),
    ("(PROBEOPEN a.txt)", "()", ["(PROBEOPEN a.txt)", "G0 X1."]),
]


@pytest.mark.parametrize(("block", "name", "expected"), OPTIONS)
def test_what_is_no_code_and_may_be_left_out(block, name, expected):
    blocks = f"{block}\nG0 X1."
    found = refused("linuxcnc", "fanuc", blocks)
    assert f'drop = ["{name}"] in [output]' in found.hint
    assert said("linuxcnc", "fanuc", blocks, drop=frozenset({name})) == expected


CODES = [
    ("linuxcnc", "fanuc", "M19 R90", "M19"),
    ("linuxcnc", "grbl", "M61 Q3", "M61"),
    ("haas", "fanuc", "#10000=2", "#"),
]


@pytest.mark.parametrize(("source", "target", "block", "name"), CODES)
def test_what_moves_nothing_may_be_left_out(source, target, block, name):
    blocks = f"{block}\nG0 X1."
    assert f'drop = ["{name}"] in [output]' in refused(source, target, blocks).hint
    assert said(source, target, blocks, drop=frozenset({name})) == ["G0 X1."]


@pytest.mark.parametrize("target", ["linuxcnc", "fanuc"])
def test_an_end_behind_the_end_says_nothing(target):
    assert said("grbl", target, "G0 X1.\nM2\n\nN9 M30") == ["G0 X1.", "M2", "", "N9 M30"]
    for more in ("M5\nM2", "G0 X2.", "M5 M2"):
        assert "goes on here" in refused("grbl", target, f"G0 X1.\nM2\n{more}").message


def test_names_of_programs_are_spelled_as_the_control_has_them():
    named = "O<Part>\nG0 X1."
    assert said("linuxcnc", "fanuc", named) == ["<Part>", "G0 X1."]
    assert said("fanuc", "linuxcnc", "<Part>\nG0 X1.") == named.split("\n")
    assert said("linuxcnc", "grbl", named) == ["G0 X1."]


def test_a_comment_that_ends_the_program_stays():
    found = refused("linuxcnc", "fanuc", "(ABORT, X)\nG0 X1.", drop=frozenset({"()"}))
    assert (found.code, found.hint) == ("GX501", "")


def test_an_assignment_that_does_something_stays():
    found = refused("haas", "fanuc", "#3006=1\nG0 X1.", drop=frozenset({"#"}))
    assert found.code == "GX501"


POINTS = [
    ("grbl", "haas", "G90 G53 G0 Z-8", "G90 G53 G0 Z-8."),
    ("linuxcnc", "fanuc", "G92 X1 Y2.50", "G92 X1. Y2.5"),
    ("linuxcnc", "grbl", "G92 X1 Y2.50", "G92 X1 Y2.50"),
]


@pytest.mark.parametrize(("source", "target", "block", "expected"), POINTS)
def test_numbers_that_stand_have_points_where_they_count_steps_without(
    source, target, block, expected
):
    assert said(source, target, f"{block}\nG0 X5. Y5.")[0] == expected


BARE = [
    ("fanuc", "G0 G28 M8", "G0 M8 G53 X10. Y20. Z450."),
    ("fanuc", "G0 G28 G91 Z0.", "G0 G28 G91 Z0."),
    ("linuxcnc", "G0 G28", "G0 G53 X10. Y20. Z450."),
]


@pytest.mark.parametrize(("target", "block", "expected"), BARE)
def test_a_way_home_of_all_axes_names_them_where_it_has_to(target, block, expected):
    assert said("haas", target, block)[0] == expected


MODALS = [
    ("G41 G1 X1. F100.", "grbl", 'put the pass "cutter-comp" before'),
    ("G10 L2 P2 X1. R30.", "grbl", 'put the pass "offsets" before'),
    ("G96 S100 D1000", "grbl", 'drop = ["G96"]'),
]


@pytest.mark.parametrize(("block", "target", "way"), MODALS)
def test_a_refusal_says_what_leads_out(block, target, way):
    assert way in refused("linuxcnc", target, f"G1 X0.5 F100.\n{block}").hint
