"""Klartext computes and jumps as its manuals say, and is written back with its bytes."""

from __future__ import annotations

import numpy as np
import pytest
from gcxform_plugins.dialects.heidenhain.lines import Lines
from gcxform_plugins.passes.absolute import Absolute
from gcxform_plugins.passes.segment import Segment
from heidenhain_kit import DIALECT, program, read

import gcxform as gx
from gcxform.flow.translated import translated
from gcxform.modal.state import Reading
from gcxform.pipeline.pipeline import Pipeline
from gcxform.plugin.registry import default_registry
from gcxform.syntax.source import Source

START = {"X": 0.0, "Y": 0.0, "Z": 50.0}


def ends(*lines, letter="X"):
    path = read(program(*lines), start=START)
    return path.end[:, path.axes.index(letter)].tolist()


def written(text, step=None, **told):
    """Return what becomes of a program by a pass, and what was taken to be so."""
    made = Pipeline(DIALECT, DIALECT, (step or Absolute(),), Reading(START, **told))
    result = made.run(text.encode("latin-1"))
    assert result.certificate.verified
    return result.text.decode("latin-1"), result.certificate.assumed


@pytest.mark.parametrize(
    ("begins", "last"),
    [
        ("PLANE SPATIAL SPA+0 SPB+30 SPC+0 STAY", "PLANE RESET STAY"),
        ("CYCL DEF 11.1 SCL 0.5", "CYCL DEF 11.1 SCL 1"),
        ("M144", "M145"),
        ("M114", "M115"),
    ],
)
def test_steps_behind_what_ends_a_kept_function_stay(begins, last):
    head = (begins, "L X+10 Y+0 Z+3 F100", last)
    text = program(*head, "L IX+1 F100")
    assert written(text)[0] == text
    text = program(*head, "L X+5 Y+0 Z+3 F100", "L IX+1")
    assert written(text)[0] == text.replace("L IX+1", "L X+6")


@pytest.mark.parametrize("last", ["PLANE RESET STAY", "CYCL DEF 11.1 SCL 1", "M145"])
def test_what_ends_nothing_changes_nothing(last):
    text = program("L X+10 Y+0 Z+3 F100", last, "L IX+1")
    assert written(text)[0] == text.replace("L IX+1", "L X+11")


@pytest.mark.parametrize(
    ("formula", "value"),
    [
        ("5*3+2*10", 35.0),
        ("SQ 10 - 3^3", 73.0),
        ("2^3^2", 512.0),
        ("(-3)^2", 9.0),
        ("2 * -3 - -1", -5.0),
        ("SIN 30 + COS (2 * 30) * 4", 2.5),
        ("SIN -30 ^ 2", 0.25),
        ("ATAN TAN 45", 45.0),
        ("INT -3,7 + FRAC 2.25", -2.75),
        ("400 % 360", 40.0),
        ("ABS NEG SGN -4", 1.0),
        ("LOG 100 + LN EXP 1", 3.0),
        ("PI / PI", 1.0),
        ("12 - 2 - 3", 7.0),
        ("ASIN 0.5 + ACOS 0.5", 90.0),
    ],
)
def test_formulas_are_worth_what_the_manual_says(formula, value):
    assert ends(f"Q1 = {formula}", "L X+Q1 FMAX") == pytest.approx([value], abs=1e-8)


@pytest.mark.parametrize(
    ("said", "value"),
    [
        ("FN 0: Q1 = -5,5", -5.5),
        ("FN1: Q1 = -Q2 + -5", -15.0),
        ("FN 2 : Q1 = +Q2 - -5", 15.0),
        ("FN 3: Q1 = +Q2 * +3", 30.0),
        ("FN 4: Q1 = +Q2 DIV +4", 2.5),
        ("FN 5: Q1 = SQRT 16", 4.0),
        ("FN 6: Q1 = SIN -30", -0.5),
        ("FN 7: Q1 = COS +60", 0.5),
        ("FN 8: Q1 = +3 LEN +4", 5.0),
        ("FN 13: Q1 = +25 ANG -50", 153.43494882),
        ("QL7 = Q2 / 4", 10.0),
    ],
)
def test_functions_with_numbers(said, value):
    assert ends("Q2 = 10", "Q1 = Q2", said, "L X+Q1 FMAX") == pytest.approx([value], abs=1e-8)


def test_a_loop_counts_by_jumps_and_a_subprogram_has_the_parameters():
    found = ends(
        *("Q1 = 0", "LBL 1", "CALL LBL 9", "Q1 = Q1 + 1", "FN 12: IF +Q1 LT +3 GOTO LBL 1"),
        *("FN 9: IF +0 EQU +0 GOTO LBL 2", "L X+99 FMAX", "LBL 2", "L X-Q2 FMAX", "M30"),
        *("LBL 9", "Q2 = Q1 * 2", "L X+Q2 FMAX", "LBL 0"),
    )
    assert found == [0.0, 2.0, 4.0, -4.0]


def test_repeats_may_be_a_parameter_and_a_jump_inside_of_one_keeps_its_count():
    found = ends(
        *("Q3 = 2", "Q1 = 0", "LBL 1", "Q1 = Q1 + 1", "FN 9: IF +Q1 EQU +2 GOTO LBL 5"),
        *("L X+Q1 FMAX", "LBL 5", "CALL LBL 1 REP Q3"),
    )
    assert found == [1.0, 3.0]


def test_a_program_beside_it_is_called(tmp_path):
    (tmp_path / "part.h").write_text(
        program("LBL 1", "Q1 = Q1 + 1", "L X+Q1 FMAX", "CALL LBL 1 REP 1", "QL1 = 7")
    )
    main = program(
        *("LBL 1", "Q1 = 5", "QL1 = 50", "CALL PGM TNC:\\parts\\PART.H", "L X+QL1 FMAX"),
        *('SEL PGM "part"', "CALL SELECTED PGM", "L Y+1 FMAX"),
    )
    path = gx.read(main.encode(), DIALECT, start=START, subprograms=(tmp_path,)).path
    assert path.end[:, 0].tolist() == [6.0, 7.0, 50.0, 8.0, 9.0, 9.0]


def test_a_shift_adds_and_leaves_other_axes():
    shift = ["CYCL DEF 7.0", "CYCL DEF 7.1 X+5 Y+1", "CYCL DEF 7.0", "CYCL DEF 7.1 IX+2"]
    more = ["L X+1 Y+1 FMAX", "CYCL DEF 7.0", "CYCL DEF 7.1 Z+Q1", "L Z+0 FMAX"]
    path = read(program("Q1 = 4", *shift, *more), start=START)
    assert path.end[-1, :3].tolist() == [8.0, 2.0, 4.0]


SOURCE = """; made by hand\r
0  BEGIN PGM A MM\r
1  TOOL CALL 5 Z S1000 F250 DL+0.1 ; a tool\r
2  L  Z+50  R0 FMAX M91\r
3  L X+10 Y-5,50 FMAX M3\r
4  L IX+5 F500 ; a step\r
5  L Z-2 IY-0.25\r
6  CC X+15 Y+0\r
7  C IX+0 Y+5.75 DR+\r
8  LP PR+30 PA+0\r
9  LP IPA+60 M8\r
10 CP IPA-90 IZ+1 DR-\r
11 RND R2\r
12 L X+50\r
13 PLANE SPATIAL SPA+0 SPB+30 SPC+0 STAY\r
14 L IX+5\r
15 FN 18: SYSREAD Q1 = ID270 NR1 IDX1\r
16 L X+Q1 Y+1\r
17 L IY+1\r
18 END PGM A MM\r
"""


def test_it_is_written_back_with_positions_for_steps():
    text, assumed = written(SOURCE)
    before, after = SOURCE.splitlines(), text.splitlines()
    changed = {a.split()[0]: b for a, b in zip(before, after, strict=True) if a != b}
    assert changed == {
        "4": "4  L X+15 F500 ; a step",
        "5": "5  L Z-2 Y-5.75",
        "7": "7  C X+15 Y+5.75 DR+",
        "9": "9  LP PA+60 M8",
    }
    assert "\r\n" in text
    assert assumed[0].startswith("lines 12, 13, 15, 16, 18, 19 (6) are kept as they stand: line 12")


def test_what_only_the_control_decides_is_kept_with_all_behind_it():
    lines = ["L X+0 FMAX", "Q1 = 5", "FN 18: SYSREAD Q1 = ID20"]
    lines += ["FN 9: IF +Q1 EQU +6 GOTO LBL 1", "L IX+5 FMAX", "LBL 1"]
    assert written(program(*lines))[0] == program(*lines)


def test_a_line_that_may_be_executed_again_is_not_changed():
    lines = ["LBL 1", "L IX+5 F100", "FN 18: SYSREAD Q1 = ID20", "FN 9: IF +Q1 EQU +5 GOTO LBL 1"]
    assert written(program(*lines))[0] == program(*lines)
    with pytest.raises(gx.InputError, match="cannot be said") as error:
        written(program(*lines), Segment(max_length=1.0, chord_error=0.1))
    assert error.value.diagnostics[0].where.line == 3


def test_cycles_that_call_themselves_keep_what_follows():
    lines = ["CYCL DEF 202 BORING", "L X+5 Y+5 FMAX M89", "L IX+5", "L IY+5 M99"]
    lines += ["L X+1 FMAX", "L IX+1 FMAX"]
    changed = [*lines[:-1], "L X+2 FMAX"]
    assert written(program(*lines))[0] == program(*changed)
    lines[1:3] = ["L X+5 R0 F100 M89", "L X+7 Y+7 Z+5 R0 F100", "L IX+5 F100"]
    assert "IX+5" in written(program(*lines))[0]


POCKET = "CYCL DEF 251 RECT ~", "Q215=0 ~ ;PLAN", "Q201=-20", "L IX+5 FMAX"
DRILL = "CYCL DEF 200 D Q200=2 Q201=-Q5 Q206=9 Q202=5 Q210=0 Q203=+0 Q204=50 Q211=0"


@pytest.mark.parametrize(
    "lines",
    [
        ("CYCL DEF 251 RECT Q215=0 Q201=-20",),
        POCKET[:3],
        ("CYCL DEF 200 DRILLING Q200=2 Q201=-Q9",),
        ("CYCL DEF 200 DRILLING Q200=2 Q201=MAX",),
        ("Q9 = 3", "CYCL DEF 200 DRILLING Q200=2 Q201=+Q9+3"),
        ("TCH PROBE 0.0 REF PLANE Q201 X-",),
    ],
)
def test_what_a_cycle_is_told_is_no_more_what_was_known(lines):
    text = program("Q201 = -5", *lines, "L Z+10 FMAX", "L IZ+Q201 FMAX")
    assert written(text)[0] == text


def test_what_a_probe_finds_is_not_known():
    text = program("Q150 = -5", "TCH PROBE 414 A ~", "Q263=+37", "L Z+10 FMAX", "L IZ+Q150 FMAX")
    assert written(text)[0] == text


def test_a_pocket_of_several_lines_is_kept_whole():
    text = program("L X+1 Y+1 Z+50 R0 FMAX", *POCKET, "CYCL CALL", "L IX+5 FMAX", "L X+1 FMAX")
    said = written(text)
    assert said[0] == text
    assert "lines 3, 4, 5, 6, 7, 8, 9 (7) are kept" in said[1][0]


def test_parameters_of_a_cycle_are_those_of_the_program():
    lines = ("Q5 = 5", DRILL, "L X+1 FMAX M99", "L IX+5 FMAX", "L IZ+Q201 FMAX")
    there = [line.replace("IX+5", "X+6").replace("IZ+Q201", "Z+45") for line in lines]
    assert written(program(*lines))[0] == program(*there)
    behind = (*lines[:2], "Q5 = 7", "L X+1 FMAX M99", "L IX+5 FMAX")
    assert written(program(*behind))[0] == program(*behind)


ARCS = """0 BEGIN PGM A MM
1 L X+0 Y+0 Z+5 R0 FMAX M3
2 CC X+5 Y+0
3 C X+5 Y+5 DR- F200 M8 ; arc
4 CYCL DEF 200 DRILLING ~
Q200=2
5 C X+5,100 Y+4,999 DR-
6 FN 18: SYSREAD Q1 = ID20 NR1
7 END PGM A MM
"""


def test_a_circle_becomes_lines_and_block_numbers_are_renewed():
    text, _ = written(ARCS, Segment(chord_error=0.2))
    assert (
        text
        == """0 BEGIN PGM A MM
1 L X+0 Y+0 Z+5 R0 FMAX M3
2 CC X+5 Y+0
3 M8 ; arc
4 L X+0.6699 Y+2.5 F200
5 L X+2.5 Y+4.3301
6 L X+5 Y+5
7 CYCL DEF 200 DRILLING ~
Q200=2
8 L X+5.1 Y+4.999
9 FN 18: SYSREAD Q1 = ID20 NR1
10 END PGM A MM
"""
    )


@pytest.mark.parametrize("line", ["CR X+20 Y+5 R+20 DR+", "RND R2", "CT X+9", "APPR LCT X+9 R2 RL"])
def test_an_arc_that_stays_is_not_made_of_lines(line):
    """Its neighbour hangs on it, or it ends nowhere that is known."""
    text = program("L X+0 Y+0 Z+5 R0 FMAX", "L X+5 F200", line, "RND R2", "L Y+50 R0")
    with pytest.raises(gx.InputError, match="along an arc"):
        written(text, Segment(chord_error=0.2))


ISO = b"""%
O1 (PART)
G21 G17 G90 G94
T3 M6 (drill)
g0 g43 h3 x10. y5.5 z50.
M3 S1000 F80.
G1 Z-1. F100.
G91 X10.5
G90 G2 X30.5 Y5.5 I5. J0. F250.
G3 X30.5 Y5.5 I5. J0.
G2 X20.5 Y5.5 Z-2. I-5. P2
G2 X25.5 Y10.5 R5.
G4 P1.5
G53 G0 Z0.
M0
G0 A30.
M5
M30
%
"""
TNC = """0 BEGIN PGM A MM
1 ; PART
2 TOOL CALL 3 Z ; drill
3 L X+10 Y+5.5 Z+50 R0 FMAX
4 TOOL CALL Z S1000
5 M3
6 L F80
7 L Z-1 F100
8 L IX+10.5
9 CC X+25.5 Y+5.5
10 C X+30.5 Y+5.5 DR- F250
11 CC X+35.5 Y+5.5
12 C X+30.5 Y+5.5 DR+
13 CC X+25.5 Y+5.5
14 CP IPA-540 Z-2 DR-
15 CC X+25.5 Y+5.5
16 C X+25.5 Y+10.5 DR-
17 CYCL DEF 9.0 DWELL TIME
18 CYCL DEF 9.1 DWELL 1.5
19 L Z+0 R0 FMAX M91
20 STOP
21 L A+30 FMAX
22 M5
23 M30
24 END PGM A MM
"""


def test_words_become_klartext_in_its_idiom_and_words_again():
    linuxcnc = default_registry().dialect("linuxcnc")
    made = Pipeline(linuxcnc, DIALECT, (), Reading(START)).run(ISO)
    assert made.certificate.verified
    assert made.text.decode() == TNC
    one = gx.read(ISO, linuxcnc, start=START)
    two = gx.read(made.text, DIALECT, start=START)
    assert gx.compare(one, two).deviation < 1e-4
    back = Pipeline(DIALECT, linuxcnc, (Absolute(),), Reading(START)).run(made.text)
    assert gx.compare(two, gx.read(back.text, linuxcnc, start=START)).same


@pytest.mark.parametrize(
    ("block", "why"),
    [
        ("G18 G2 X5. Y1. Z5. I5. K0.", "out of XY"),
        ("G20 G0 X5.", "one unit"),
        ("G43 H2 Z5.", "which tool is in the spindle"),
        ("T1 M6\nG0 X0. Y0. Z0.\nG43 H2 Z5.", "another tool"),
        ("G93 G1 X5. F2.", "G93"),
        ("G92 X5.", "G92"),
        ("G55 G0 X5.", "G55"),
    ],
)
def test_what_klartext_has_no_words_for_is_refused(block, why):
    linuxcnc = default_registry().dialect("linuxcnc")
    text = f"G21 G17 G90 G94\nG0 X0. Y0. Z0.\nF100.\n{block}\nM2\n".encode()
    with pytest.raises(gx.GcxformError, match=why):
        Pipeline(linuxcnc, DIALECT, (), Reading(START)).run(text)


def test_what_is_written_for_a_tnc_is_read_and_compared(monkeypatch):
    linuxcnc = default_registry().dialect("linuxcnc")
    said = Lines.lines
    monkeypatch.setattr(
        Lines, "lines", lambda self, block: [t.replace("X+2", "X+3") for t in said(self, block)]
    )
    text = b"G21 G17 G90 G94\nG0 X1. Y0. Z0.\nX2.\nM2\n"
    with pytest.raises(gx.VerificationError, match="another program: an end") as error:
        Pipeline(linuxcnc, DIALECT, (), Reading(START)).run(text)
    assert error.value.diagnostics[0].where.text == "2 L X+3 R0 FMAX"


def test_a_circle_in_a_scale_is_kept():
    scale = ["CYCL DEF 11.0 SCALING", "CYCL DEF 11.1 SCL 2"]
    lines = ["L X+0 Y+0 F100", *scale, "L X+1 Y+1", "CC X+2 Y+1", "C IX+2 Y+1 DR+"]
    assert written(program(*lines))[0] == program(*lines)


def test_blocks_are_the_same_whatever_is_kept():
    source = Source.of_bytes(SOURCE.encode("latin-1"), "a.h")
    found = translated(source, DIALECT, Reading(START, stays=True))
    kept = {found.line_of(k + 1) for k, b in enumerate(found.text.splitlines()) if b"M9000" in b}
    assert kept == {12, 13, 15, 16, 18, 19}
    assert np.all(np.diff(found.visits) >= 0)
