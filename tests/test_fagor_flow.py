"""Parameters, structures and calls of a Fagor, and programs that are written for it again."""

from __future__ import annotations

import pytest
from gcxform_plugins.passes.absolute import Absolute
from gcxform_plugins.passes.segment import Segment

import gcxform as gx
from gcxform.modal.state import Reading
from gcxform.pipeline.pipeline import Pipeline
from gcxform.plugin.registry import default_registry

FAGOR = default_registry().dialect("fagor")
START = {"X": 0.0, "Y": 0.0, "Z": 50.0}
CONTROL = {"for-end": "included", "subroutine-locals": "shared"}
HEAD = "G71 G90 G17 G94 G54\nG0 X0 Y0 Z5 F100\n"


def ends(*lines, letter="X", head=HEAD, **told):
    text = head + "\n".join(lines) + "\nM30\n"
    path = gx.read(text.encode("latin-1"), FAGOR, start=START, **told).path
    return path.end[1:, path.axes.index(letter)].tolist()


def written(text, step=None, **told):
    """Return what becomes of a program by a pass, and what was taken to be so."""
    made = Pipeline(FAGOR, FAGOR, (step or Absolute(),), Reading(START, **told))
    result = made.run(text.encode("latin-1"))
    assert result.certificate.verified
    return result.text.decode("latin-1"), result.certificate.assumed


@pytest.mark.parametrize(
    ("said", "value"),
    [
        ("2+3*4", 14.0),
        ("SIN[30]+COS[60]*4", 2.5),
        ("2*[3-5]/4", -1.0),
        ("ARG[-1,-2]", 243.4349),
        ("ATAN[1]", 45.0),
        ("12-2-3", 7.0),
        ("2**3*2", 16.0),
        ("SQRT[16]+ABS[-2]", 6.0),
        ("INT[3.7]+FRACT[2.25]+FUP[1.1]+ROUND[2.6]", 8.25),
        ("7 MOD 4", 3.0),
        ("2*-3", -6.0),
    ],
)
def test_expressions_are_worth_what_the_manuals_say(said, value):
    assert ends(f"P1={said}", "XP1") == pytest.approx([value], abs=1e-4)
    assert ends(f"X=[{said}]") == pytest.approx([value], abs=1e-4)


@pytest.mark.parametrize(
    "said",
    ["-2**2", "INT[-3.5]", "ROUND[2.5]", "-5 MOD 3", "EXP[1]", "1/0", "P7", "V.A.X", "1==1"],
)
def test_what_no_page_says_has_no_value(said):
    with pytest.raises(gx.InputError, match="GX2"):
        ends(f"X=[{said}]")


@pytest.mark.parametrize(
    "line",
    ["P1=3 P1=4", "P1=3 P2=P1", "P1=5 XP1", "V.A.ORGT=5", "$IF P1", "$GOTO N99", "$BREAK", "#RET"],
)
def test_what_is_not_certain_is_refused(line):
    with pytest.raises(gx.InputError, match="GX2"):
        ends("P1=1", line, "$ENDIF" if line[:3] == "$IF" else "X1")


def test_loops_are_left_and_continued():
    lines = ["P1=0", "$WHILE P1 < 9", "P1+=1", "$IF P1==2", "$CONTINUE", "$ENDIF"]
    lines += ["$IF P1 > 3", "$BREAK", "$ENDIF", "XP1", "$ENDWHILE", "X99"]
    assert ends(*lines) == [1.0, 3.0, 99.0]
    assert ends("P1=0", "$DO", "P1+=1", "XP1", "$ENDDO P1<3") == [1.0, 2.0, 3.0]


@pytest.mark.parametrize(("end", "runs"), [("included", 3), ("excluded", 2)])
def test_for_runs_for_its_last_value_as_the_machine_file_says(end, runs):
    lines = ["$FOR P1=10,0,-5", "XP1", "$ENDFOR"]
    assert ends(*lines, control={"for-end": end}) == [10.0, 5.0, 0.0][:runs]
    assert ends("$FOR P1=0,7,4", "XP1", "$ENDFOR") == [0.0, 4.0]
    with pytest.raises(gx.InputError, match="only the control knows P1"):
        ends("$FOR P1=0,7,4", "$ENDFOR", "XP1")


def test_cases_and_branches():
    lines = ["P1=4", "$SWITCH P1", "$CASE 3", "X3", "$BREAK", "$CASE 4", "X4", "$BREAK"]
    lines += ["$DEFAULT", "X5", "$BREAK", "$ENDSWITCH", "$IF P1<3", "X7", "$ELSEIF P1<5", "X8"]
    assert ends(*lines, "$ELSE", "X9", "$ENDIF") == [4.0, 8.0]


SUB = "%L STEP\nXP1\nP1=7\nP100=P1\n#RET\n%MAIN\n"


def test_a_subroutine_has_parameters_of_its_own_or_those_of_the_caller():
    lines = ["P1=5", "#PCALL STEP P1=3", "XP1", "XP100"]
    assert ends(*lines, head=SUB + HEAD) == [3.0, 5.0, 7.0]
    lines[1] = "LL STEP"
    assert ends(*lines, head=SUB + HEAD, control=CONTROL) == [5.0, 7.0, 7.0]
    with pytest.raises(gx.InputError, match="P1 of its own"):
        ends(*lines, head=SUB + HEAD)
    quiet = SUB.replace("XP1\n", "")
    assert ends("LL STEP", "XP100", head=quiet + HEAD) == [7.0]
    with pytest.raises(gx.InputError, match="GX220"):
        ends("P1=5", "LL STEP", "XP1", head=quiet + HEAD)


def test_a_subroutine_stands_in_a_file_beside_the_program(tmp_path):
    (tmp_path / "Part.nc").write_text("G91\nX5\nG90\nM29\n")
    said = ["L C:\\CNC\\PART.NC", "X5I Y1"]
    assert ends(*said, subprograms=(tmp_path,)) == [5.0, 10.0]
    with pytest.raises(gx.InputError, match="no subroutine PART"):
        ends(*said)
    (tmp_path / "Part.nc").write_text("X5\n")
    with pytest.raises(gx.InputError, match="does not end with #RET"):
        ends(*said, subprograms=(tmp_path,))


KEPT = """G71 G90 G17 G94 G54\r
G1 X1 Y0 F100\r
  X5I Y2 ; a step\r
G11\r
X5 Y2\r
G91 X1 Y2\r
G90\r
X5I\r
G36 I5\r
X2\r
X3I\r
P1=V.A.X\r
G0 XP1 Y3 Z1\r
X0\r
Y5I\r
$IF P1 > 5\r
X3I\r
$ENDIF\r
LL SUB\r
X3I\r
G1 G90 X2\r
X3I\r
M30\r
"""


def test_it_is_written_back_with_positions_for_steps():
    text, assumed = written(KEPT)
    before, after = KEPT.split("\r\n"), text.split("\r\n")
    changed = {k: b for k, (a, b) in enumerate(zip(before, after, strict=True), 1) if a != b}
    assert changed == {3: "  X6 Y2 ; a step", 6: "G90 X6 Y4", 22: "X5"}
    assert assumed[0].startswith("lines 4, 8, 9, 10, 11, 13, 15, 16 and more (")


@pytest.mark.parametrize(
    "lines",
    [
        ("X5I", "$GOTO NP9", "X1"),
        ("P2=0", "$WHILE P2 < 5", "X5I", "P2=V.A.Y", "$ENDWHILE"),
        ("N5 X5I", "$IF V.A.X > 3", "$GOTO N5", "$ENDIF"),
    ],
)
def test_a_line_that_may_be_executed_again_is_not_changed(lines):
    text = HEAD + "\n".join(lines) + "\nM30\n"
    assert written(text)[0] == text
    with pytest.raises(gx.InputError, match="GX501"):
        written(text.replace("X5I", "G1 X5I"), Segment(max_length=1.0, chord_error=0.1))


def test_behind_a_loop_that_was_executed_before_nothing_is_changed():
    lines = ["P2=0", "$WHILE P2 < 5", "P2=V.A.Y", "$ENDWHILE", "G90 G0 X1", "X2I"]
    text = HEAD + "\n".join([*lines, "M30"]) + "\n"
    assert written(text)[0] == text
    assert "X3" in written(text.replace("P2=V.A.Y", "P2=7"))[0]


def test_cycles_and_compensation_keep_the_moves_behind_them():
    lines = ["G81 Z5 I-5", "X5", "X5I", "G80", "X3", "X3I", "G41 X5", "X5I", "G40 X6", "X2I"]
    text, _ = written(HEAD + "\n".join(lines) + "\nM30\n")
    assert text.splitlines()[2:-1] == [*lines[:5], "X6", *lines[6:9], "X8"]


def test_a_subroutine_is_executed_behind_a_structure_that_is_kept():
    sub = SUB.replace("XP1\n", "G0 G90 XP1\n")
    lines = ["P9=V.A.X", "$IF P9 > 2", "X1", "$ENDIF", "#PCALL STEP P1=3", "G0 G90 X1"]
    text, _ = written(sub + HEAD + "\n".join([*lines, "X2I", "M30"]) + "\n")
    assert text.splitlines()[-2:] == ["X3", "M30"]


def test_lines_of_a_subroutine_that_may_be_called_once_more_are_not_changed():
    sub = "%L STEP\nG1 X3I\n#RET\n%MAIN\n"
    lines = ["G1 G90 X1 Y1", "LL STEP", "$IF V.A.X > 5", "[A] LL STEP", "$ENDIF"]
    text = sub + HEAD + "\n".join([*lines, "M30"]) + "\n"
    assert written(text)[0] == text
    assert "G1 X4" in written(sub + HEAD + "\n".join([*lines[:2], "M30"]) + "\n")[0]


def test_behind_a_call_that_is_kept_the_modes_are_said_before_anything_changes():
    lines = ["LL NOWHERE", "X5 Y5 Z5", "X2I", "G1 G90 X2 Y2 Z2", "X2I"]
    text, _ = written(HEAD + "\n".join([*lines, "M30"]) + "\n")
    assert text.splitlines()[2:-1] == [*lines[:4], "X4"]


@pytest.mark.parametrize("work", ["G54", "G159=1"])
def test_steps_behind_a_work_offset_stay(work):
    text = f"G71 G17 G90 G94 G54\nG1 X1 Y1 F100\nG92 X5\nX5 Y5\n{work}\nX1I\nX3\nX1I\n"
    made, _ = written(text)
    assert made == text.removesuffix("X1I\n") + "X4\n"
