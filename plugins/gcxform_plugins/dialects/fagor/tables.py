"""What the codes, words and statements of a Fagor 8065 are that are not simply words of a block."""

from __future__ import annotations

from collections.abc import Mapping

from gcxform import vocabulary as v

PLAIN_WORDS = frozenset("XYZABCUVWFSIJKR")
AXES = frozenset("XYZABCUVW")

PLAIN = frozenset({"G0", "G1", "G2", "G3", "G17", "G18", "G19", "G40", "G94", "G95", "G97"})
"""Codes that say here what they say in the tables of the dialect."""
UNSAID = frozenset({"G80", "G98", "G99", "G53"})
"""Codes about cycles: they say nothing to other blocks. Behind G53 nothing moves."""
WORK = frozenset({"G54", "G55", "G56", "G57", "G58", "G59"})
CORNERS = {"G5": "G64", "G7": "G61", "G50": "G64", "G61": "G64"}
"""How corners are taken: exactly, or rounded."""
OTHER = {**CORNERS, "G60": "G61", "G70": "G20", "G71": "G21"}
"""Codes that have another name in the tables of the dialect."""
COMP = frozenset(("G41", "G42"))
"""Codes that move the path beside the contour, by the radius of the tool whose D1 is in force."""
CODES = PLAIN | UNSAID | WORK | COMP | {*OTHER, "G4", "G6", "G90", "G91", "G159"}
M_CODES = frozenset(f"M{code}" for code in (0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 30))
OF_BLOCKS = frozenset(("M128", "M129", "M9000", "M9001"))
"""M codes that say among the blocks what a Fagor has other words for."""
ALONE = "write it in a block of its own"
TOLD = "tell the axis absolute before"
WORDS = PLAIN_WORDS | {"T", "D"}
LACKING = {
    "P": "parameters are computed by the control",
    "Q": "it is an angle: of polar coordinates, or of a cycle",
    "L": v.CALL,
    "H": "what an H does is a matter of the machine",
    "E": "a second feed",
    "O": "it names a program",
}

CYCLE = v.CYCLE
PATTERN = "it repeats a cycle over a pattern of points"
MIRROR = "it mirrors the coordinates"
BLEND = "it puts moves of its own into the contour"
POLAR = "it sets the origin of polar coordinates"
INCHES = "lengths are inches behind it; whether feeds are too is not certain"
SAY_INCHES = 'say inch-feeds = "inches" in [control], if it is so; or write G71'
OLD_LENGTH = "tool lengths of an 8065 go with D; on an 8055 it takes a length into account"

REFUSED: Mapping[str, str] = {
    "G8": "it is an arc that goes on from the move before it",
    "G9": "it is an arc through three points; how its middle is given is not certain",
    **{f"G{code}": MIRROR for code in range(10, 15)},
    "G20": "it gives the plane other axes",
    **{f"G{code}": "it is about zones that axes must not enter" for code in (120, 121, 122, 123)},
    "G31": POLAR,
    "G33": v.SYNCHRONISED,
    **{f"G{code}": BLEND for code in (36, 37, 38, 39)},
    **{f"G{code}": OLD_LENGTH for code in (43, 44, 49)},
    "G45": "it turns an axis along the path",
    **{f"G{code}": PATTERN for code in (62, 64, 65, 160, 161, 162, 163, 164, 165)},
    "G63": v.SYNCHRONISED,
    "G72": "it scales the coordinates",
    "G74": v.HOME,
    **{f"G{code}": v.PROBE for code in (75, 76, 100, 101, 102, 103, 104)},
    "G77": "it couples axes",
    "G78": "it couples axes",
    **{f"G{code}": CYCLE for code in (*range(81, 90), *range(210, 215))},
    "G92": "it gives the place where the axes stand other coordinates, or limits the spindle",
    "G93": "with it F is a time of each block; on an 8055 it sets the origin of polar coordinates",
    "G96": "the speed of the spindle depends on where the axis is",
    "G151": "words of an axis are diameters",
    "G158": "it shifts the zero on top of the work offset",
    "G201": "it superimposes moves by hand",
    "G261": "from here on centres are absolute",
}

STATEMENTS: Mapping[str, str] = {
    "#CS": "it turns and shifts the coordinates; X, Y and Z are those of an inclined plane",
    "#ACS": "it turns the coordinates back by how the part is clamped",
    "#MCS": "coordinates are those of the machine; whether a tool length is in them is not "
    "certain, so it is read as #MCS ON and #MCS OFF, behind D0 and in G90",
    "#TLC": "it corrects for a tool that is longer than the program was made for, along the tool",
    "#TOOL": "it puts the tool upright on the plane in force; where the axes go is the control's "
    "choice",
    "#CSROT": "rotary axes are programmed in the turned coordinates",
    "#DEFROT": "it says what becomes of rotary axes in turned coordinates",
    "#SELECT": "it chooses among the ways in which rotary axes can point the tool",
    "#TRAFO": "it is a word of ISG and Beckhoff, on whose controls D, G5, G8 and G9 mean other "
    "things",
    "#TIME": "how it writes its time is not certain",
    "#PATH": "it runs a program that is not in this file",
    "#SPLINE": "it draws a spline through the points",
    "#AKIMA": "it draws a spline through the points",
    "#POLY": "it cuts along polynomials",
    "#CYL": "it wraps the path around a cylinder",
    "#FACE": "it turns linear moves into those of a rotary axis",
    "#FREE": "it gives axes away",
    "#CALL": v.CALL,
    "#PCALL": v.CALL,
    "#MCALL": v.CALL,
    "#MDOFF": v.CALL,
    "#EXEC": v.CALL,
    "#EXBLK": v.CALL,
    "#RET": "it ends a subroutine",
    "#RETDSBLK": "it ends a subroutine",
    "#RPT": "it repeats blocks",
    "#INIT": "it sets other coordinates",
    "#SET": "it sets other axes",
    "#RENAME": "it gives axes other names",
    "#LINK": "it couples axes",
    "#MASTER": "it is about another spindle",
}
INERT = frozenset({"#HSC", "#ROUNDPAR", "#SLOPE", "#FLUSH", "#MSG"})
"""Statements about speed, corners and messages: no axis goes to another place for them."""
OFF = frozenset({"#CS", "#ACS", "#MCS", "#TLC", "#CSROT", "#TOOL", "#DEFROT"})
"""Statements whose ON is refused: their OFF ends what may be in force since before the program, and
goes along where that is written anew for the same control."""

KINDS: Mapping[str, str] = {
    "ambiguous": "whether this I makes the coordinate incremental, or is a centre, is not certain",
    "repeat": "it repeats blocks",
    "string": "it names something that is not in this file",
    "old": "on an 8055 this is executed, on an 8065 it is a comment",
}
"""Items that are refused for what they are."""
HINTS = {
    "ambiguous": "write X10I for an incremental coordinate, X10 I5 for a centre",
    "old": "write comments behind a semicolon; let the CAM write a program for an 8065",
}


def own_m(code: str) -> int | None:
    """Return the number of an M code that is neither of the control nor of blocks."""
    own = code[:1] == "M" and code[1:].isdigit() and code not in M_CODES | OF_BLOCKS
    return int(code[1:]) if own else None
