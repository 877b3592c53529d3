"""Real programs mean to gcxform what LinuxCNC says they do; and a difference would be noticed."""

from __future__ import annotations

import importlib.util
import sys
from collections import Counter
from dataclasses import replace
from pathlib import Path

import pytest
from oracles import rs274
from oracles.canon import parsed
from oracles.toolpaths import difference, read

BENCHMARK = Path(__file__).parents[1] / "benchmarks" / "agreement.py"
AGREEING = (16, 12, 15, 15, 14, 13, 13, 14, 13, 12, 9, 13, 14, 14, 19, 13)
"""Programs that agree in each part of the corpus: fewer would mean that less can be read."""
PARTS = len(AGREEING)
PROGRAM = b"""G21 G90 G17 G94 F100
T1 M6
M3 S500
G0 X1 Y2 Z3
G1 X4
G4 P1.5
G2 X6 I1
G20
G1 X1 F10
M5
M2
"""
PRINTED = """
    6 N..... ON_RESET()
    7 N..... USE_LENGTH_UNITS(CANON_UNITS_MM)
    8 N..... SET_FEED_RATE(100.0000)
    9 N..... SELECT_TOOL(1)
   10 N..... START_CHANGE()
   11 N..... STOP_SPINDLE_TURNING(0)
   12 N..... CHANGE_TOOL(1)
   13 N..... SET_SPINDLE_SPEED(0, 500.0000)
   14 N..... START_SPINDLE_CLOCKWISE(0)
   15 N..... STRAIGHT_TRAVERSE(1.0000, 2.0000, 3.0000, 0.0000, 0.0000, 0.0000)
   16 N..... STRAIGHT_TRAVERSE(1.0000, 2.0000, 3.0000, 0.0000, 0.0000, 0.0000)
   17 N..... STRAIGHT_FEED(4.0000, 2.0000, 3.0000, 0.0000, 0.0000, 0.0000)
   18 N..... DWELL(1.5000)
   19 N..... ARC_FEED(6.0000, 2.0000, 5.0000, 2.0000, -1, 3.0000, 0.0000, 0.0000, 0.0000)
   20 N..... USE_LENGTH_UNITS(CANON_UNITS_INCHES)
   21 N..... SET_FEED_RATE(10.0000)
   22 N..... STRAIGHT_FEED(1.0000, 0.0787, 0.1181, 0.0000, 0.0000, 0.0000)
   23 N..... STOP_SPINDLE_TURNING(0)
   24 N..... SET_FEED_MODE(0, 0)
   25 N..... STOP_SPINDLE_TURNING(0)
   26 N..... SET_SPINDLE_MODE(0 0.0000)
   27 N..... PROGRAM_END()
"""
CHANGES = {
    "an end": ("FEED(4.0000", "FEED(4.0002"),
    "an end in inches": ("FEED(1.0000", "FEED(1.0002"),
    "a centre": ("5.0000, 2.0000, -1", "5.0002, 2.0000, -1"),
    "a sense": ("2.0000, -1", "2.0000, 1"),
    "turns": ("2.0000, -1", "2.0000, -2"),
    "a kind": ("STRAIGHT_TRAVERSE(1", "STRAIGHT_FEED(1"),
    "a feed": ("RATE(100.", "RATE(101."),
    "a dwell": ("DWELL(1.5", "DWELL(1.6"),
    "a dwell that is missing": ("   18 N..... DWELL(1.5000)\n", ""),
    "a tool": ("SELECT_TOOL(1)", "SELECT_TOOL(2)"),
    "a speed": ("500.", "400."),
    "a stop elsewhere": (
        "   22 N..... STRAIGHT_FEED",
        "   22 N..... STOP_SPINDLE_TURNING(0)\n 1 N STRAIGHT_FEED",
    ),
    "a move more": ("   23", "   23 N STRAIGHT_FEED(2, 0, 0, 0, 0, 0)\n   23"),
    "a move less": (
        "   17 N..... STRAIGHT_FEED(4.0000, 2.0000, 3.0000, 0.0000, 0.0000, 0.0000)\n",
        "",
    ),
    "a probe": ("STRAIGHT_FEED(4", "STRAIGHT_PROBE(4"),
}


def agreement():
    """Return the benchmark as a module."""
    spec = importlib.util.spec_from_file_location("agreement", BENCHMARK)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["agreement"] = module
    spec.loader.exec_module(module)
    return module


@pytest.mark.by_turns
@pytest.mark.parametrize("first", range(PARTS))
def test_nothing_real_is_read_otherwise_than_by_linuxcnc(first, shared):
    module = agreement()
    found = module.outcomes(shared / "corpus", slice(first, None, PARTS))
    assert [one for one in found if one.kind == module.DISAGREE] == []
    kinds = Counter(one.kind for one in found)
    assert kinds[module.AGREE] >= AGREEING[first], kinds


def test_a_program_agrees_with_what_linuxcnc_printed():
    assert difference(read(PROGRAM), parsed(PRINTED)) == ""


@pytest.mark.parametrize("change", CHANGES)
def test_every_difference_is_noticed(change):
    before, after = CHANGES[change]
    assert before in PRINTED
    assert difference(read(PROGRAM), parsed(PRINTED.replace(before, after, 1)))


def test_a_move_that_only_gcxform_has_is_noticed():
    path = read(PROGRAM.replace(b"M5\n", b"M5\nX2\n"))
    assert "no such move" in difference(path, parsed(PRINTED))


SHIFTED = b"""G21 G90
G10 L2 P1 X10 Y-4 Z1 R30
G92 X3
G0 X5 Y5
G43.1 Z7
G55
G91 G0 X0
G92.1
G0 X0
G54 G20
G0 X0
M2
"""


@pytest.mark.skipif(not rs274.available(), reason="rs274 is not installed")
def test_an_offset_moves_the_numbers_and_not_the_tool():
    """G91 X0 stands where it stood, so LinuxCNC prints the place that an offset left behind."""
    moves = [move for move in rs274.run(SHIFTED).moves if move.line > 4]
    assert len(moves) == 3
    for move in moves:
        near = 3e-4 * move.unit
        assert move.start == pytest.approx(move.end, abs=near), replace(move, feed=None)
