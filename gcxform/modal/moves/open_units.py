"""Lengths before G20 or G21, on a control of which a setting says in which unit programs begin.

Where their words are written as they stand it is the same program in either. For another control,
or with G21 at its head, the part would be 25.4 times as large or as small: refused. Where an error
is taken off its positions, or moves are cut, that alone would be so, and a warning says it.
"""

from __future__ import annotations

import numpy as np

from gcxform.diagnostics import Diagnostic, Severity
from gcxform.modal.lines import LENGTHS, Lines
from gcxform.system.arrays import Flags

OPEN = "unit-open"
CODE = "GX235"
MESSAGE = "a length before G20 or G21, in mm or inches as a setting of this control has it"
HINT = 'units = "mm" in [input], or units = "in" in [input] where the setting says inches'


def refuse_open_units(lines: Lines) -> None:
    """Refuse the first length of a program whose unit nobody has said, or warn of it."""
    if not lines.state.memory[OPEN] or not lines.live:
        return
    said = np.flatnonzero(lines.stated("units")[: lines.live])
    before = slice(0, int(said[0]) if len(said) else lines.live)
    lines.state.memory[OPEN] = int(not len(said))
    long = np.zeros(lines.live, np.bool_)
    words = (lines.word(address, distance=False) for address in LENGTHS)
    for value, has in filter(None, words):
        long |= has[: lines.live] & (value[: lines.live] != 0)
    long |= _taken(lines)
    if found := np.flatnonzero(long[before])[:1].tolist():
        lines.state.memory[OPEN] = 0
        if lines.reading.unit_open == "refused":
            lines.findings.add(found[0], CODE, MESSAGE, hint=HINT)
            return
        where = lines.findings.location(found[0], 1, 1)
        taken = "in inches" if lines.state.groups["units"] else "in mm"
        message = f"{MESSAGE}: taken to be {taken}"
        warning = Diagnostic(CODE, message, where, HINT, severity=Severity.WARNING)
        lines.state.assumed[message] = warning


def _taken(lines: Lines) -> Flags:
    """Return the lines (live,) with a length, not 0, that a code takes for itself, as G52 does."""
    found = lines.flag("takes_lengths")
    for line in np.flatnonzero(found).tolist():
        slots = [slot for *_, slot in lines.table.meanings[int(lines.shape[line])].lengths]
        found[line] = lines.window.value[lines.first[line] + slots].any()
    return found
