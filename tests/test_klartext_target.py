"""What Klartext says otherwise than words do, on the way there and back.

Cycle 32 is Klartext's tolerance of the path (TNC 620, cycles, p. 276; klartext-portal.com: without
a value the builder's own holds again). TOOL CALL takes the length of its tool at once.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
from heidenhain_kit import DIALECT, TOOLS, program, read
from seeds_kit import LONG

import gcxform as gx
from gcxform.modal.state import Reading
from gcxform.pipeline.pipeline import Pipeline
from gcxform.plugin.registry import default_registry
from gcxform.proof.spelled_out import _lost as lost
from gcxform.proof.spelled_out import _same_side as same_side

DIALECTS = default_registry().dialects
START = {"X": 0.0, "Y": 0.0, "Z": 50.0}
HEAD = "G21 G17 G90 G94\nG0 X0. Y0. Z5.\n"


def said(blocks, source="linuxcnc", **options):
    """Return the lines of Klartext behind the head, and what is said of codes."""
    made = Pipeline(DIALECTS[source], DIALECT, (), Reading(START, tools=TOOLS), **options)
    result = made.run(f"{HEAD}{blocks}\nM2\n".encode())
    lines = [line.split(" ", 1)[1] for line in result.text.decode().splitlines()]
    return lines[2:-1], [each for each in result.certificate.assumed if "left out" in each]


def words(*lines, target="linuxcnc"):
    """Return what becomes of lines of Klartext in words."""
    text = "".join(f"{n} {line}\n" for n, line in enumerate(("BEGIN PGM A MM", *lines)))
    made = Pipeline(DIALECT, DIALECTS[target], (), Reading(START, tools=TOOLS))
    return made.run(f"{text}99 END PGM A MM\n".encode()).text.decode().splitlines()[1:-1]


def test_a_tolerance_is_cycle_32_and_back():
    lines, told = said("G64 P0.05\nG1 X1. F100.")
    assert lines == ["CYCL DEF 32.0 TOLERANCE", "CYCL DEF 32.1 T0.05", "L X+1 F100"]
    assert not told
    assert words(*lines) == ["G64 P0.05", "G1 X1. F100"]


def test_no_tolerance_is_left_out_and_told():
    lines, told = said("G64\nG1 X1. F100.\nG64 P0\nX2.")
    assert lines == ["L X+1 F100", "L X+2"]
    assert told == ["G64 is left out for heidenhain: 2"]
    with pytest.raises(gx.GcxformError, match="behind one with P"):
        said("G64 P0.1\nG1 X1. F100.\nG64\nX2.")


@pytest.mark.parametrize("end", ["CYCL DEF 32.1", "CYCL DEF 32.1 T0"])
def test_the_tolerance_of_the_builder_is_none_at_all_elsewhere(end):
    lines = ("CYCL DEF 32.1 T0.05", "L X+1 F100", end, "L X+2")
    assert words(*lines) == ["G64 P0.05", "G1 X1. F100", "G61", "X2."]
    assert words("CYCL DEF 32.0 TOLERANCE", "CYCL DEF 32.1", "L X+1 F100") == ["G1 X1. F100"]


def test_an_exact_path_is_left_out_where_the_user_says_so():
    with pytest.raises(gx.GcxformError, match="no exact path"):
        said("G61\nG1 X1. F100.")
    lines, told = said("G61\nG1 X1. F100.", drop=frozenset({"G61"}))
    assert (lines, told) == (["L X+1 F100"], ["G61 is left out for heidenhain: 1"])


@pytest.mark.parametrize(
    ("arc", "lines"),
    [
        ("G18 G3 X-10. Z5. I-10. K0.", ["CC Z+5 X+0", "C Z+5 X-10 DR+"]),
        ("G18 G2 X0. Z15. R10.", ["CC Z+5 X+0", "C Z+15 X+0 DR-"]),
        ("G18 G2 X0. Z15. R-10.", ["CC Z+15 X+10", "C Z+15 X+0 DR-"]),
        ("G19 G3 Y0. Z5. J4. K3.", ["CC Y+4 Z+8", "C Y+0 Z+5 DR+"]),
    ],
)
def test_arcs_of_other_planes_are_circles_about_a_centre_there(arc, lines):
    begin = "G1 X10. F100."
    found, _ = said(f"{begin}\n{arc}\nG17 G1 X3.")
    assert found == ["L X+10 F100", *lines, "L X+3"]
    made, _ = said(f"{begin}\n{arc}")
    back = gx.Program("\n".join(words(*LEADING, *made)).encode(), DIALECTS["linuxcnc"])
    there = gx.Program(f"{HEAD}{begin}\n{arc}\n".encode(), DIALECTS["linuxcnc"])
    assert gx.compare(there, back, 1e-3).deviation < 1e-3


LEADING = ("L X+0 Y+0 Z+5 FMAX",)


def test_an_arc_of_another_plane_has_no_words_where_it_is_a_helix():
    with pytest.raises(gx.GcxformError, match="out of XY has no words"):
        said("G18 G2 X5. Y1. Z5. I2.5 K0. F100.")


def test_a_tool_change_may_leave_the_axes_where_they_are():
    blocks = "T1 M6\nG43 H1\nG1 X5. F100.\nG2 X7. I1. J0."
    with pytest.raises(gx.GcxformError, match="GX208"):
        said(blocks)
    lines, _ = said(blocks, inert=frozenset(("M6",)))
    assert lines == ["TOOL CALL 1 Z", "L X+5 F100", "CC X+6 Y+0", "C X+7 DR-"]


def test_a_side_that_is_said_alone_is_that_of_the_next_line():
    tool = "T1 M6\nG43 H1\nG0 X0. Y0. Z5.\n"
    lines, _ = said(f"{tool}G41\nG1 X5. F100.\nY9.\nG40\nG1 X9.")
    assert lines[2:] == ["L X+5 RL F100", "L Y+9", "L X+9 R0"]
    with pytest.raises(gx.GcxformError, match="without X and Y"):
        said(f"{tool}G41 G1 X5. F100.\nG40\nG1 Z9.")


def test_a_side_is_compared_by_its_code():
    one, other = ((3, code, ()) for code in ("G41", "G42"))
    assert same_side(one, (3, "G41", (("D", 1.0),)), DIALECT)
    assert not same_side(one, other, DIALECT)


def test_another_unit_is_what_the_hint_makes_of_it():
    with pytest.raises(gx.GcxformError, match="one unit") as found:
        said("G20\nG1 X1. F10.")
    assert 'pass "metric"' in found.value.diagnostics[0].hint


def test_a_length_that_comes_later_is_refused_where_it_would_count():
    tool = "T2 M6\nG0 X1. Y2. Z3.\n"
    with pytest.raises(gx.GcxformError, match="length of a tool"):
        said(f"{tool}G43 H2 Z9.")
    assert said("T2 M6\nG43 H2\nG0 X1. Y2. Z3.")[0] == ["TOOL CALL 2 Z", "L X+1 Y+2 Z+3 R0 FMAX"]


@pytest.mark.skipif(not LONG, reason="takes a minute")
def test_real_programs_go_there_and_back():
    sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
    import round_trips

    if not round_trips.BESIDE.exists():
        pytest.skip("the corpus is not beside the checkout")
    jobs = [job for job in round_trips.counted(round_trips.BESIDE, round_trips.SOURCES)]
    found = [round_trips.round_trip(job, "heidenhain") for job in jobs if round_trips.counts(job)]
    assert not {"CRASH", "DIFFERS", "GX601"} & {one.code for one in found}
    assert sum(not one.code for one in found) >= 20


def test_a_datum_is_shifted_by_words_of_one_line():
    move = "L X+1 Y+1 FMAX"
    shifts = ("TRANS DATUM AXIS X+5 Y-2", move, "TRANS DATUM AXIS IX+2", move, "TRANS DATUM RESET")
    path = read(program(*shifts, move), start=START)
    assert path.end[:, :2].tolist() == [[6, -1], [8, -1], [1, 1]]


@pytest.mark.parametrize(
    "shifts",
    [
        ("CYCL DEF 7.1 X+5", "TRANS DATUM AXIS X+2"),
        ("TRANS DATUM AXIS X+2", "CYCL DEF 7.1 X+5"),
        ("CYCL DEF 7.1 X+5", "TRANS DATUM RESET"),
        ("TRANS DATUM TABLE TABLINE 3",),
    ],
)
def test_two_ways_to_shift_a_datum_are_not_mixed(shifts):
    with pytest.raises(gx.GcxformError, match="TRANS DATUM"):
        words(*shifts, "L X+1 FMAX")


def test_an_axis_that_is_lost_in_one_program_alone_is_seen():
    """But Z where a length that nobody has said begins to count, or ends to."""
    text = b"G21 G17 G90 G94\nG0 X0 Y0 Z5\nG49\nG53 G0 Z50\nG43 H1\nG0 X1 Y1\nG0 Z7\nM2\n"
    path = gx.read(text, DIALECTS["linuxcnc"], start=START).path
    assert not lost(path, path).any()
    before = np.vstack([path.entry, path.end[:-1]])
    count = 0
    for row in range(len(path)):
        for axis in range(3):
            other = path.lost.copy()
            other[row] ^= 1 << axis
            seen = lost(path, path.replace(lost=other))
            begins = np.isnan([path.frames[path.frame[k]].tool[2] for k in (max(row - 1, 0), row)])
            known = not np.isnan(before[row, axis])  # where it stood nowhere known none is lost
            differs = known and not (axis == 2 and begins[0] != begins[1])
            assert seen.tolist() == [k == row and differs for k in range(len(path))]
            count += differs
    assert count > len(path)
