"""What is refused of Klartext, by its name and with its place."""

from __future__ import annotations

import numpy as np
import pytest
from heidenhain_kit import SWITCHED, TOOLS, program, read

import gcxform as gx

ARM = ["TOOL CALL 1 Z S1000 F500", "L X+0 Y+0 Z+0 R0 FMAX"]
REFUSED = {
    "a block of another language": (["G1 X5"], "GX101"),
    "ISO of a TNC": (["%A G71 *"], "GX101"),
    "a parameter that nobody has set": (["L X+Q1"], "GX220"),
    "a parameter of the control": (["Q108 = 5", "L X+Q109"], "GX220"),
    "what the control reads": (["FN 18: SYSREAD Q1 = ID270 NR1 IDX1", "L X+Q1"], "GX220"),
    "what comes of that": (["FN 18: SYSREAD Q1 = ID20", "Q2 = Q1 + 1", "L X+Q2"], "GX220"),
    "what a text is worth": (['QS1 = "5"', "Q1 = TONUMB(SRC_QS1)", "L X+Q1"], "GX220"),
    "the parameter of a caller": (["QL1 = 5", "L X+QL2"], "GX220"),
    "a decision of the control": (
        ["FN 18: SYSREAD Q1 = ID20", "FN 9: IF +Q1 EQU +1 GOTO LBL 1", "LBL 1"],
        "GX220",
    ),
    "nearly equal": (
        ["Q1 = 0.1 + 0.2", "FN 9: IF +Q1 EQU +0.3 GOTO LBL 1", "LBL 1"],
        "GX221",
    ),
    "a sign before a power": (["Q1 = -3 ^ 2"], "GX221"),
    "a sign of nothing": (["Q1 = SGN 0"], "GX221"),
    "what is left below zero": (["Q2 = -5", "Q1 = Q2 % 3"], "GX221"),
    "a division by zero": (["FN 4: Q1 = +5 DIV +0"], "GX221"),
    "another operator": (["FN 1: Q1 = +5 * +2"], "GX101"),
    "a decision of another number": (["FN 9: IF +1 GT +0 GOTO LBL 1", "LBL 1"], "GX101"),
    "no formula": (["Q1 = 5 +"], "GX101"),
    "an error": (["FN 14: ERROR = 1000"], "GX210"),
    "what the control computes with": (["FN 17: SYSWRITE ID50 NR1 IDX1 = +Q1"], "GX210"),
    "a jump to nowhere": (["FN 9: IF +0 EQU +0 GOTO LBL 7"], "GX223"),
    "a jump out of a subprogram": (
        ["CALL LBL 1", "M30", "LBL 1", "FN 9: IF +0 EQU +0 GOTO LBL 2", "LBL 0", "LBL 2"],
        "GX210",
    ),
    "a jump out of a repeat": (
        [
            *("Q1 = 0", "LBL 3", "LBL 1", "Q1 = Q1 + 1"),
            *("FN 9: IF +Q1 EQU +2 GOTO LBL 2", "CALL LBL 1 REP 5"),
            *("LBL 2", "FN 12: IF +Q1 LT +4 GOTO LBL 3"),
        ],
        "GX210",
    ),
    "a place for a number": (["L X#"], "GX101"),
    "a misspelt word": (["L X+5 FAMX"], "GX101"),
    "a word twice": (["L X+5 X+6"], "GX203"),
    "F and FMAX": (["L X+5 F5 FMAX"], "GX202"),
    "a feed of nothing": (["L X+5 F0"], "GX204"),
    "a feed per tooth": (["L X+5 FZ0.1"], "GX210"),
    "compensation in Z": (["L Z+5 RL"], "GX210"),
    "compensation in a circle": (["CC X+5 Y+0", "C X+10 Y+0 DR+ RL"], "GX210"),
    "no compensation in a circle": (["L X+5 RR", "CC X+7 Y+0", "C X+9 Y+0 DR+ R0"], "GX210"),
    "the other side": (["L X+5 RL", "L X+6 RR"], "GX210"),
    "compensation, then a tool": (["L X+5 RL", "TOOL CALL 2 Z"], "GX210"),
    "compensation, then M91": (["L X+5 RL", "L Z+5 M91"], "GX210"),
    "compensation, then M128": (["L X+5 RL", "L Z+5 M128"], "GX210"),
    "compensation, then a shift": (["L X+5 RL", "CYCL DEF 7.0", "CYCL DEF 7.1 X+5"], "GX210"),
    "compensation, then a cycle": (["L X+5 RL", "L X+6 M99"], "GX210"),
    "compensation, then TCPM": (["L X+5 RL", "FUNCTION RESET TCPM"], "GX210"),
    "compensation of no tool": (["TOOL CALL 0 Z", "L X+5 Y+5 RL"], "GX210"),
    "radius in a line": (["L X+5 R5"], "GX203"),
    "rounding": (["L X+9 F100", "RND R5", "CC X+1 Y+1"], "GX210"),
    "a chamfer": (["L X+9 F100", "CHF 2", "L X+19"], "GX210"),
    "an approach": (["APPR LT X+5 Y+5 LEN5 RL"], "GX210"),
    "a departure": (["DEP LT LEN5"], "GX210"),
    "a centre from before CR": (
        ["CC X+5 Y+0", "L X+5 F100", "CR X+9 Y+4 R5 DR+", "C X+1 Y+4 DR+"],
        "GX213",
    ),
    "a tangent circle": (["CT X+5 Y+5"], "GX210"),
    "free contours": (["FC DR- R5"], "GX210"),
    "vectors": (["LN X+5 TX+0 TY+0 TZ+1"], "GX210"),
    "a plane": (["PLANE SPATIAL SPA+5 SPB+0 SPC+0 STAY"], "GX210"),
    "another program": (["CALL PGM A"], "GX210"),
    "a label that is not there": (["CALL LBL 4"], "GX223"),
    "a label twice": (["LBL 1", "LBL 1", "CALL LBL 1 REP 2"], "GX223"),
    "a repeat ahead": (["CALL LBL 1 REP 2", "LBL 1"], "GX223"),
    "a repeat half done": (["LBL 1", "CALL LBL 1 REP 10/3"], "GX210"),
    "no repeat": (["LBL 1", "CALL LBL 1 REP 0"], "GX223"),
    "calls without end": (["M30", "LBL 1", "CALL LBL 1", "LBL 0"], None),
    "calls into themselves": (["CALL LBL 1", "M30", "LBL 1", "CALL LBL 1", "LBL 0"], "GX223"),
    "an open subprogram": (["CALL LBL 1", "M30", "LBL 1", "L X+5"], "GX223"),
    "a circle without a centre": (["C X+5 Y+5 DR+"], "GX213"),
    "a circle without a sense": (["CC X+5 Y+0", "C X+0 Y+0"], "GX213"),
    "a circle off its end": (["CC X+5 Y+0", "C X+10.017 Y+0 DR+"], "GX301"),
    "a circle within its end": (["CC X+5 Y+0", "C X+10.015 Y+0 DR+"], None),
    "a circle upwards": (["CC X+5 Y+0", "C X+10 Y+0 Z+5 DR+"], "GX210"),
    "a circle in rapid": (["CC X+5 Y+0", "C X+10 Y+0 DR+ FMAX"], "GX213"),
    "a centre in ZX, and a helix there": (["CC X+0 Z+0", "C X+0 Y+1 Z+0 DR+ F1"], "GX210"),
    "half a centre": (["CC X+5"], "GX210"),
    "a radius too short": (["CR X+10 Y+0 R+4 DR+"], "GX302"),
    "no radius": (["CR X+10 Y+0 R0 DR+"], "GX303"),
    "no way by a radius": (["CR R+5 DR+"], "GX302"),
    "polar without a pole": (["LP PR+5 PA+5"], "GX213"),
    "polar without a radius": (["CC X+5 Y+5", "LP PA+5"], "GX213"),
    "polar twice": (["CC X+5 Y+5", "LP PR+5 PA+5 IPA+5"], "GX203"),
    "polar from the pole": (["CC", "CP IPA+5 DR+"], "GX213"),
    "a turn against its sense": (["CC X+5 Y+5", "CP IPA-50 DR+"], "GX210"),
    "a turn of nothing": (["CC X+5 Y+5", "CP IPA+0 DR+"], "GX210"),
    "a turn to where it is": (["CC X+5 Y+0", "CP PA+180 DR+"], "GX210"),
    "nearly a turn": (["CC X+5 Y+0", "CP IPA+360.00001 DR+"], "GX210"),
    "polar words in a line": (["L PR+5"], "GX203"),
    "steps from nowhere": (["TOOL CALL 2 Z", "L IX+5"], "GX207"),
    "a named tool": (['TOOL CALL "MILL" Z'], "GX210"),
    "a tool along Y": (["TOOL CALL 2 Y S500"], "GX210"),
    "a tool of no known length, longer": (["TOOL CALL 9 Z DL+0.1"], "GX210"),
    "the radius of a ball": (["TOOL CALL 2 Z DR2+0.1"], "GX210"),
    "deltas without a tool": (["TOOL CALL 2 Z DR+1", "TOOL CALL Z S500"], "GX210"),
    "a delta twice": (["TOOL CALL 2 Z DR+1 DR+2"], "GX203"),
    "less than no radius": (["TOOL CALL 2 Z DR-1.5", "L X+5 Y+5 RL F100"], "GX210"),
    "a tool of a parameter": (["TOOL CALL Q5 Z"], "GX220"),
    "another length": (["TOOL DEF 2 L+20.5 R+1"], "GX210"),
    "the same length": (["TOOL DEF 2 L+20.0 R+1"], None),
    "another radius": (["TOOL DEF 2 L+20 R+1.5"], "GX210"),
    "no feed of a tool": (["TOOL CALL 2 Z S5", "L X+5 FAUTO"], "GX204"),
    "an M function of the builder": (["M25"], "GX210"),
    "feeds of rotary axes": (["L C+5 M116"], "GX210"),
    "a retraction": (["L M140 MB50"], "GX210"),
    "fewer angles": (["L M94 C"], "GX210"),
    "the point of the builder": (["L Z+5 FMAX M92"], "GX210"),
    "steps in the machine": (["L IZ+5 FMAX M91"], "GX210"),
    "the machine under M128": (["M128", "L Z+5 FMAX M91"], "GX210"),
    "a tool under M128": (["M128", "TOOL CALL 2 Z"], "GX210"),
    "a shift under M128": (["M128", "CYCL DEF 7.0", "CYCL DEF 7.1 X+5"], "GX210"),
    "feed of the contour": (["FUNCTION TCPM F CONT AXIS POS PATHCTRL AXIS"], "GX210"),
    "angles of space": (["FUNCTION TCPM F TCP AXIS SPAT PATHCTRL AXIS"], "GX210"),
    "the axis in a plane": (["FUNCTION TCPM F TCP AXIS POS PATHCTRL VECTOR"], "GX210"),
    "another point": (["FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS REFPNT TIP-TIP"], "GX210"),
    "the shorter way": (["L C+0 FMAX", "L C+180 M126"], "GX210"),
    "no shorter way": (["L C+0 FMAX", "L C+179.9 M126", "L C+0"], None),
    "as it is said": (["L C+0 FMAX M126", "L C+200 M127"], None),
    "a shift from a table": (["CYCL DEF 7.0", "CYCL DEF 7.1 #5"], "GX210"),
    "a shift twice": (["CYCL DEF 7.0", "CYCL DEF 7.1 X+5", "CYCL DEF 7.2 X+5"], "GX203"),
    "a shift of an angle": (["CYCL DEF 7.0", "CYCL DEF 7.1 C+5"], "GX210"),
    "another preset": (["CYCL DEF 247 DATUM SETTING Q339=+1"], "GX210"),
    "a preset behind moves": (["CYCL DEF 247 DATUM SETTING Q339=+0"], "GX210"),
    "a step in turned coordinates": (["CYCL DEF 10.1 ROT+5", "L IX+5 FMAX"], "GX207"),
    "no rotation": (["CYCL DEF 10.0 ROTATION", "CYCL DEF 10.1 ROT+0", "L X+1 FMAX"], None),
    "no plane": (["PLANE RESET STAY", "L X+1 FMAX"], None),
    "a way out of a plane": (["PLANE RESET TURN FMAX"], "GX210"),
    "a step of a mirrored axis": (["CYCL DEF 8.1 X", "L IX+5 FMAX"], "GX207"),
    "a scale": (["CYCL DEF 11.0 SCALING", "CYCL DEF 11.1 SCL 0.5"], "GX210"),
    "what is set behind a cycle": (
        ["CYCL DEF 200 DRILLING ~", "Q200=2 ~", "Q201=-5 ;DEPTH", "Q203=+7", "M99"],
        "GX215",
    ),
    "a pocket": (["CYCL DEF 251 RECTANGULAR POCKET"], "GX210"),
    "a pattern": (["CYCL CALL PAT F500"], "GX210"),
    "no cycle": (["L X+5 FMAX M99"], "GX215"),
    "a dwell of nothing": (["CYCL DEF 9.1 F MAX"], "GX210"),
    "a long number": (["L X+" + "1" * 400], "GX219"),
    "two programs": (["BEGIN PGM B MM"], "GX101"),
    "another unit": (["END PGM A INCH"], "GX101"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_it_is_refused_by_name(name):
    lines, code = REFUSED[name]
    text = program(*ARM, *lines).encode()
    if code is None:
        assert len(gx.read(text, SWITCHED, tools=TOOLS).path)
        return
    with pytest.raises(gx.InputError) as error:
        gx.read(text, SWITCHED, tools=TOOLS).path  # noqa: B018
    found = error.value.diagnostics[0]
    assert found.code == code
    assert 3 < found.where.line <= 4 + len(lines)
    assert found.where.text == text.decode().splitlines()[found.where.line - 1]
    assert found.where.column <= len(found.where.text)


def test_where_it_is_refused_is_shown():
    text = program(*ARM, "L X+5 FMAX", "12 L   X+5 FZ5 F5")
    with pytest.raises(gx.InputError) as error:
        read(text)
    where = error.value.diagnostics[0].where
    assert (where.line, where.column, where.width) == (5, 12, 3)


@pytest.mark.parametrize(
    "lines",
    [["L X+5"], ["BEGIN PGM A MM", "L X+5 FMAX"], ["BEGIN PGM A"], ["BEGIN PGM A MM", "L X+"]],
)
def test_what_breaks_off_is_refused(lines):
    with pytest.raises(gx.InputError, match=r"GX101|GX222"):
        read("\n".join(lines))


PIECES = [
    *(["L", "C", "CC", "CP", "LP", "CR", "X", "Y-5", "IZ+2", "PR", "IPA+900", "DR+", "DR", "R0"]),
    *(["RL", "F", "F500", "FMAX", "M", "M3", "M128", "M91", "M99", "BEGIN PGM A MM", "END PGM"]),
    *(["CALL LBL 1 REP 2", "LBL 1", "LBL 0", "CYCL DEF 7.1 X+5", "CYCL DEF 1.3 Q", "Q1=", "#"]),
    *(["TOOL CALL 5 Z", "TOOL DEF 1 L", "STOP", ";", "*", "/", "12", "+", "~", '"', "(", "\xb2"]),
    *(["CYCL DEF 200 Q200=1 ~", "Q201=-5", "CYCL CALL", "\x00", "\x0b", "\xff", "FUNCTION TCPM"]),
]


def problems(text):
    """Return what is wrong with a program."""
    try:
        gx.read(text, SWITCHED, tools=TOOLS).path  # noqa: B018
    except gx.InputError as error:
        return error.diagnostics
    return ()


@pytest.mark.parametrize("seed", range(60))
def test_noise_is_read_or_refused_with_a_place(seed):
    rng = np.random.default_rng(seed)
    lines = [" ".join(rng.choice(PIECES, int(rng.integers(0, 5)))) for _ in range(8)]
    text = program(*ARM, *lines) if seed % 3 else "\n".join(lines)
    whole = bytes(rng.integers(0, 256, 80, np.uint8)) if seed % 10 == 0 else text.encode("latin-1")
    for cut in (len(whole), int(rng.integers(0, len(whole) + 1))):
        assert all(found.where is not None for found in problems(whole[:cut]))
