"""What one line for a SINUMERIK does to another, where a hostile reading found wrong motion."""

from __future__ import annotations

import pytest

import gcxform as gx
from gcxform.plugin.registry import default_registry

SIEMENS = default_registry().dialect("siemens")
HEAD = "G710 G17 G90 G94 G54\nT1 M6\nD0\nG0 X0 Y0 Z5\nG1 F100\n"
VALUES = "DEF REAL AA=1\nR1=1 R2=2\n"
HOLE = "CYCLE81(5,0,2,-10)"
BESIDE = "is no word of it|block of its own"
TANGENT = "in which direction the element before it ends is not known"


def ends(text):
    return gx.read((HEAD + text).encode(), SIEMENS).path.end[1:].tolist()


def why_not(text):
    with pytest.raises(gx.InputError) as caught:
        ends(text)
    return caught.value


@pytest.mark.parametrize("word", ["G1", "T2", "M6", "D0", "G4 F1", "G41", "M8", "S100", "CR=5"])
@pytest.mark.parametrize("alone", ["TRANS X5", "G111 X5 Y5", "G4 F2", HOLE, "TRAFOOF"])
def test_words_beside_what_stands_alone_are_not_dropped(alone, word):
    if (alone, word) == ("G4 F2", "G4 F1"):
        word = "G91"
    assert why_not(f"{alone} {word}\nX5\n")


@pytest.mark.parametrize("behind", [HOLE, f"MCALL {HOLE}\nHOLES2(0,0,20,0,0,4)\nMCALL"])
def test_a_cycle_leaves_no_direction(behind):
    assert TANGENT in str(why_not(f"X10\n{behind}\nCT X20 Y5\n"))


def test_what_mcall_drills_leaves_no_direction():
    assert TANGENT in str(why_not(f"MCALL {HOLE}\nX10\nMCALL\nCT X20 Y5\n"))


@pytest.mark.parametrize("behind", ["SUPA Z0 D0\nX10", "T2 M6\nD0\nG1 X10 Y0"])
def test_a_line_behind_has_a_direction_again(behind):
    assert ends(f"X5 Y0\n{behind}\nX12 Y0\nCT X20 Y5\n")[-1][:2] == [20.0, 5.0]


def test_places_of_the_machine_move_all_axes_of_a_frame_that_turns():
    turned = "ROT RPL=30\nX10 Y20 Z5\nSUPA X0 D0\n"
    assert "where Y stands in it is not known" in str(why_not(turned + "X10\n"))
    told = ends(turned + "X10 Y20 Z5\n")
    assert told[-1] == told[0]
    shifted = "TRANS X30\nX10 Y20\nSUPA X0 D0\nX7\n"
    assert ends(shifted)[-1] == [37.0, 20.0, 5.0]


@pytest.mark.parametrize("by", ["R1==1 AND R2==2", "R1==1 OR R2==2", "R2==2 XOR R1==2 XOR R1==1"])
def test_comparisons_without_brackets_are_read_in_one_way_or_not(by):
    assert "comparison beside AND" in str(why_not(f"{VALUES}IF {by}\nX5\nENDIF\nX6\n"))


@pytest.mark.parametrize(
    "line",
    ["X=R1 R1=5", "R1=5 X=R01", "R[1]=5 X=R1", "R1=5 X=R[R2]", "X=R[R2] R[1]=2", "X=AA AA=3"],
)
def test_what_a_line_sets_none_of_its_words_reads(line):
    assert "set, and read" in str(why_not(f"{VALUES}{line}\n"))


@pytest.mark.parametrize(
    ("line", "x"), [("R1=5 X=R2", 2.0), ("AA=R1 X=R2", 2.0), ("X=R2 R3=5", 2.0)]
)
def test_what_a_line_sets_may_stand_beside_words_that_do_not_read_it(line, x):
    assert ends(VALUES + line + "\n")[0][0] == x


@pytest.mark.parametrize("value", ["2.4", "(0.1+0.2)*10"])
def test_a_case_is_a_whole_number(value):
    text = f"R1={value}\nCASE(R1) OF 2 GOTOF AA 3 GOTOF BB\nX1\nAA: X7\nBB: X8\n"
    assert "not whole" in str(why_not(text))


@pytest.mark.parametrize(
    "call",
    [
        "CYCLE81(5,0,2,-10,,10)",
        "CYCLE82(5,0,2,-10,,0.5,10)",
        "CYCLE82(5,0,2,-10,,0.5,0,10)",
        "CYCLE85(5,0,2,-10,,0,80,90,10)",
        "CYCLE89(5,0,2,-10,,0,0,0,0,10)",
        "CYCLE83(5,0,2,-10,,-5,,0,0,0,1,1,10,0,0,0,1)",
    ],
)
def test_seconds_are_said_in_one_place(call):
    assert "is not read" in str(why_not(call + "\n"))


@pytest.mark.parametrize("call", ["CYCLE81(5,0,2,-10,,0,0,10)", "CYCLE82(5,0,2,-10,,0.5,0,0,10)"])
def test_seconds_are_read_there(call):
    assert ends(call + "\n") == ends("CYCLE81(5,0,2,-10)\n")
