"""SAVE behind PROC: what was in force before a call is in force again behind it.

Modal G functions and the programmable frame come back (K2 2-108), F, S, T, D and M do not. Motion,
G90 and the frame are put back here; a subprogram that leaves another plane, zero, unit, feed mode
or compensation behind is refused, and one in which anything else is modal.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from operator import attrgetter
from typing import Any

from gcxform_plugins.dialects.siemens.asides import QUIET
from gcxform_plugins.dialects.siemens.structure import code

PUT_BACK = ("motion", "steps", "frame")
ALIKE = ("plane", "work", "unit", "comp", "feed_mode", "following", "orientation", "drilling")
put_back, alike = attrgetter(*PUT_BACK), attrgetter(*ALIKE)
FOLLOWED = frozenset((
    "0", "1", "2", "3", "4", "9", "17", "18", "19", "40", "41", "42", "53", "54", "55", "56", "57",
    "71", "90", "91", "93", "94", "95", "110", "111", "112", "153", "700", "710",
    *(f"{number}" for number in range(505, 600)),
))  # fmt: skip
"""G codes of which it is known here what is in force behind them."""
CODE = re.compile(r"(?<![A-Z0-9_])G[ \t]*0*([0-9]+)(?![0-9.])", re.IGNORECASE)
NAME = re.compile(r"[A-Z_]{2}[A-Z0-9_]*", re.IGNORECASE)


def other_mode(lines: Iterable[str]) -> str:
    """Return what lines of a subprogram say that is modal, and not followed; nothing for none."""
    for text in map(code, lines):
        for number in CODE.findall(text):
            if number not in FOLLOWED:
                return f"G{number}"
        for name in NAME.findall(text):
            if name.upper() in QUIET - {"STOPRE"} or name.upper().startswith(("ORI", "CYCLE832")):
                return str(name)
    return ""


def saved(state: Any) -> tuple[Any, Any]:
    """Return what SAVE keeps of a state."""
    return put_back(state), alike(state)
