"""Lines that go along as they stand to the same control: they move no axis of a path.

They are told by their text alone, which has plain numbers. Behind those that turn a spindle, or
lead axes to points of the machine, it is not known where these axes stand.
"""

from __future__ import annotations

import re
from typing import NamedTuple

from gcxform_plugins.dialects.siemens.place import LINEAR, ROTARY
from gcxform_plugins.dialects.siemens.structure import code

VALUE = r"[ \t]*[-+]?[0-9.]+"
IS = r"[ \t]*="
AXIS = r"[ \t]*\[[ \t]*[A-Z][A-Z0-9]*[ \t]*\]"
TELLS = re.compile(
    rf"(?:SETAL[ \t]*\((?:[^()\"]|\"[^\"]*\")*\)|SETMS(?:[ \t]*\([0-9 \t]*\))?"
    rf"|(?:START|STOP)FIFO|FIFOCTRL"
    rf"|SBLO[NF]|DISPLO[NF]|M[2-9]{IS}[ \t]*0*[345]|S[2-9]{IS}{VALUE})",
    re.IGNORECASE,
)
"""Alarms, other spindles, and what hurries or shows (PM 105, 457)."""
LIMITS = re.compile(
    rf"(?:(?:FL|ACC|FA|FGREF|VELOLIM|JERKLIM){AXIS}{IS}{VALUE}|LIMS(?:[ \t]*\[[0-9]\])?{IS}{VALUE}"
    rf"|G2[56](?:[ \t]+[XYZS]{VALUE})+)",
    re.IGNORECASE,
)
"""How fast axes and spindles may go, and how far: in the unit that is in force."""
TURNS = re.compile(
    rf"SPOSA?(?:[ \t]*\[[0-9]\])?{IS}(?:{VALUE}|[ \t]*(?:DC|AC[PN]?|IC)[ \t]*\({VALUE}[ \t]*\))",
    re.IGNORECASE,
)
"""The spindle turns to an angle: it may be one of the rotary axes."""
TO_POINTS = re.compile(
    rf"G7[45](?=.*[XYZABC])(?:[ \t]+FP{IS}[ \t]*[1-4]|[ \t]*[XYZABC](?:1?{IS})?[ \t]*0)+",
    re.IGNORECASE,
)
"""G74 and G75: axes go to reference points and fixed points of the machine (PM 683, 397)."""
NAMED = re.compile(r"[XYZABC](?=1?[ \t]*=|[ \t]*0)", re.IGNORECASE)
HEAD = re.compile(
    r"[ \t]*(?:[N:][ \t]*[0-9]+(?![0-9.]))?(?:[ \t]*[A-Z_]{2}[A-Z0-9_]*[ \t]*:(?!=))?[ \t]*",
    re.IGNORECASE,
)
UNITS = "this counts in the unit and the frame of its place"


class Along(NamedTuple):
    """What a line does that goes along: the axes that are lost behind it, and what it counts in."""

    axes: str
    counts: str = ""


def bare(line: str) -> str:
    """Return a line without its head and its comment."""
    text = code(line, True).rstrip()
    head = HEAD.match(text)
    return text[head.end() if head else 0 :]


def goes_along(text: str) -> Along | None:
    """Return what a line without its head and comment does; None for one that does not go along."""
    if TURNS.fullmatch(text):
        return Along(ROTARY)
    if TO_POINTS.fullmatch(text):
        named = {letter.upper() for letter in NAMED.findall(text[3:])}
        return Along("".join(axis for axis in LINEAR + ROTARY if axis in named), UNITS)
    if not text:
        return None  # a label that is a word of the language, which is refused for what it is
    counts = ""
    while text:
        found = TELLS.match(text) or LIMITS.match(text)
        if found is None:
            return None
        counts = UNITS if found.re is LIMITS else counts
        text = text[found.end() :].lstrip(" \t")
    return Along("", counts)
