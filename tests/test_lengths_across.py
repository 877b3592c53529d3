"""Tool lengths, tool changes and cutter compensation on the way to another control."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import across_kit
import pytest

import gcxform as gx
from gcxform.machine.machine import Tool
from gcxform.modal.state import Reading

DIALECTS = across_kit.DIALECTS
TOOLS = {1: Tool(length=50.0, radius=3.0), 2: Tool(length=25.4)}
START = Reading({"X": 0.0, "Y": 0.0, "Z": 0.0}, tools=TOOLS)
said, refused = partial(across_kit.said, START), partial(across_kit.refused, START)


LENGTHS = [
    ("G43 H1\nG0 Z5.", ["G21 G43.1 Z50.000", "G0 Z5."]),
    ("G43 H1 G0 Z5. M8", ["G21 G43.1 Z50.000", "G0 Z5. M8"]),
    ("M8 G43 H1\nG0 Z5.\nG49\nG0 Z60.", ["G21 G43.1 Z50.000", "M8", "G0 Z5.", "G49", "G0 Z60."]),
    ("G20\nG43 H2\nG0 Z5.", ["G20", "G20 G43.1 Z1.0000", "G0 Z5."]),
    ("G44 H1 G0 Z5.", ["G21 G43.1 Z-50.000", "G0 Z5."]),
    ("(LONG) G43 H1 (TOOL)\nG0 Z5.", ["G21 G43.1 Z50.000", "(LONG) (TOOL)", "G0 Z5."]),
]


@pytest.mark.parametrize(("blocks", "expected"), LENGTHS)
def test_a_length_is_said_by_its_value_where_numbers_are_not_taken(blocks, expected):
    assert said("haas", "grbl", blocks) == expected


def test_a_length_that_is_not_known_is_asked_for():
    found = refused("haas", "grbl", "G43 H7 G0 Z5.")
    assert (found.code, found.where.line) == ("GX501", 2)
    assert "[tool.7]" in found.hint


HOME = replace(
    START, homes={"G28": {"Z": 400.0}}, work_offsets={"G54": {"X": 0.0, "Y": 0.0, "Z": 100.0}}
)


def test_a_length_that_the_source_may_have_let_go_of_is_said_again():
    blocks = "G43 H1 G0 Z5.\nG91 G28 Z0.\nG90 {}G0 Z20."
    found = across_kit.refused(HOME, "haas", "fanuc", blocks.format(""))
    assert (found.code, found.where.line) == ("GX509", 4)
    again = blocks.format("G43 H1 ")
    assert across_kit.said(HOME, "haas", "fanuc", again) == again.split("\n")


CHANGE = "G0 X1. Y2. Z5.\nT1 M6\nG0 X5.\nG1 Z1. F100."


def test_a_tool_change_of_the_target_may_be_said_to_move_nothing():
    found = refused("linuxcnc", "fanuc", CHANGE)
    assert (found.code, 'inert = ["M6"] in [output]' in found.hint) == ("GX509", True)
    assert said("linuxcnc", "fanuc", CHANGE, inert=frozenset({"M6"})) == CHANGE.split("\n")


def test_what_is_inert_on_one_machine_is_not_said_of_another():
    reading = Reading({"X": 0.0, "Y": 0.0, "Z": 0.0}, inert_m=frozenset({59, 60}))
    codes = {"M59": "M60"}
    pipeline = gx.Pipeline(DIALECTS["haas"], DIALECTS["fanuc"], (), reading, m_codes=codes)
    with pytest.raises(gx.GcxformError) as error:
        pipeline.run(f"{across_kit.HEAD}G0 X1. Y2. Z5.\nM59\nG0 X5.\nM30\n".encode())
    assert error.value.diagnostics[0].code == "GX509"


@pytest.mark.parametrize("code", ["M98", "M77", "G4"])
def test_what_cannot_be_inert(code):
    with pytest.raises(gx.UsageError, match="inert"):
        gx.Pipeline(DIALECTS["linuxcnc"], DIALECTS["fanuc"], (), START, inert=frozenset({code}))


WITHOUT_H = [("fanuc", "linuxcnc", "the last H"), ("linuxcnc", "fanuc", "the tool in the spindle")]


@pytest.mark.parametrize(("source", "target", "which"), WITHOUT_H)
def test_a_length_without_h_is_told_whose_it_is(source, target, which):
    found = refused(source, target, "G43 H1 G0 Z5.\nG43 G0 Z6.")
    assert (found.code, found.where.line) == ("GX501", 3)
    assert which in found.hint


CONTOUR = "G0 X0. Y0. Z5.\n{} G1 X10. F100.\nY20.\nG40 X30."
WITHOUT_D = [("linuxcnc", "fanuc"), ("linuxcnc", "haas")]


@pytest.mark.parametrize(("source", "target"), WITHOUT_D)
def test_a_side_without_d_is_another_tool_on_another_control(source, target):
    begun = "T1 M6\n" + CONTOUR.format("G41")
    found = refused(source, target, begun, inert=frozenset({"M6"}))
    assert (found.code, found.message) == ("GX501", f"{target} cannot say G41 without D")
    assert said(source, target, CONTOUR.format("G41 D1")) == CONTOUR.format("G41 D1").split("\n")


def test_a_d_that_stays_in_force_is_no_tool_in_the_spindle():
    once = CONTOUR.format("G41 D1") + "\n" + CONTOUR.format("G41")
    found = refused("fanuc", "linuxcnc", once)
    assert found.message == "linuxcnc cannot say G41 without D"


def test_lengths_between_controls_are_seen_in_positions():
    """SUPA D0 lets go of the length for one move, M91 does without: no axis goes elsewhere."""
    klartext = b"0 BEGIN PGM A MM\n1 TOOL CALL 1 Z S900\n2 L X+1 Y+2 Z+3 R0 FMAX\n"
    klartext += b"3 L Z+300 R0 FMAX M91\n4 L X+5 Y+6 R0 FMAX\n5 L Z+9 FMAX\n6 M30\n7 END PGM A MM\n"
    words = b"G21 G90 G17 G94 G40\nT1 M6\nG43 H1\nS900\nG0 X1 Y2 Z3\n{}G0 X5 Y6\nG0 Z9\nM30\n"
    ends = words.replace(b"{}", b"G49\nG53 G0 Z300\nG43 H1\n")
    start, tools = {"X": 0.0, "Y": 0.0, "Z": 0.0}, {1: Tool(length=10.0, radius=1.0)}
    there = gx.read(klartext, DIALECTS["heidenhain"], start=start, tools=tools)
    here, other = (
        gx.read(text, DIALECTS["linuxcnc"], start=start, tools=tools)
        for text in (ends, words.replace(b"{}", b"G53 G0 Z300\n"))
    )
    assert gx.compare(there, here).same
    assert not gx.compare(here, other).same
