"""What says how fast, how smooth, and how near to a corner: it moves nothing.

To another control it is left out. To the same one, of which all moves are written anew, it goes
along as it was programmed, in a comment of its block.
"""

from __future__ import annotations

import re

INERT = frozenset(("601", "602", "603", "290", "450", "451"))
AROUND = frozenset(("G450", "G451"))
"""Those that say what joins moves outside, under compensation."""
KONT = "KONT"
ENTRIES = frozenset((KONT, "NORM"))
"""And which way leads to the contour."""
BLENDS = frozenset(("64", "641", "642", "643", "644", "645"))
# fmt: off
QUIET = frozenset((
    "SOFT", "BRISK", "DRIVE", "FFWON", "FFWOF", "COMPON", "COMPOF", "COMPCURV", "COMPCAD",
    "COMPSURF", "UPATH", "SPATH", "FNORM", "WALIMON", "STOPRE", "DIAMOF", "NORM", "KONT", "CUT2D",
    "ORISON", "ORISOF", "RTLION", "RTLIOF", "CFC",
    "DYNNORM", "DYNPOS", "DYNROUGH", "DYNSEMIFIN", "DYNFINISH",
))
# fmt: on
"""Commands that move nothing and change no word behind them."""
TELLING = frozenset(("WORKPIECE", "GROUP_BEGIN", "GROUP_END", "GROUP_ADDEND"))
"""Calls for the screen: the blank of the simulation, and which lines belong together."""
GEARS = frozenset(range(40, 46))
"""M40 to M45: the gear of the spindle (PM 105)."""
TOLERANCES = frozenset(("ADIS", "ADISPOS", "CTOL", "OTOL", "ATOL"))
LEFT_OUT = "{} left out: how fast, how smooth, how near to a corner, and what the screen shows"
NAME = re.compile(r"%?[A-Z_]+[0-9]*", re.IGNORECASE)


def named(aside: str) -> str:
    """Return the name of what goes along."""
    found = NAME.match(aside)
    return found[0].upper() if found else aside
