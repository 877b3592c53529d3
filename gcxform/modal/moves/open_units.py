"""Lengths before G20 or G21, on a control of which a setting says in which unit programs begin.

Where their words are written as they stand it is the same program in either. Where positions are
made of them, or words for another control, it would be 25.4 times as large or as small.
"""

from __future__ import annotations

import numpy as np

from gcxform.modal.lines import LENGTHS, Lines

OPEN = "unit-open"
MESSAGE = "a length before G20 or G21: a setting of this control says whether it is in mm or inches"
HINT = 'units = "mm" in [input], or units = "in" in [input] where the setting says inches'


def refuse_open_units(lines: Lines) -> None:
    """Refuse the first length of a program whose unit nobody has said."""
    if not lines.state.memory[OPEN] or not lines.live:
        return
    said = np.flatnonzero(lines.stated("units")[: lines.live])
    before = slice(0, int(said[0]) if len(said) else lines.live)
    lines.state.memory[OPEN] = int(not len(said))
    long = np.zeros(lines.live, np.bool_)
    words = (lines.word(address, distance=False) for address in LENGTHS)
    for value, has in filter(None, words):
        long |= has[: lines.live] & (value[: lines.live] != 0)
    if found := np.flatnonzero(long[before])[:1].tolist():
        lines.state.memory[OPEN] = 0
        lines.findings.add(found[0], "GX235", MESSAGE, hint=HINT)
