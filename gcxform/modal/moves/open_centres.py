"""Arcs whose centre words a setting of the control counts from where, where nothing has said it."""

from __future__ import annotations

import numpy as np

from gcxform.modal.findings import Findings
from gcxform.modal.lines import Lines
from gcxform.modal.state import Modes
from gcxform.toolpath.path import Kind

SETTING = "arc-centres"
OPEN = "a setting of the control says from where I, J and K count, and the program does not"
SAY = f'write G91.1, or G90.1, before; or say {SETTING} = "incremental" in [control]'


def refuse_open_centres(lines: Lines, modes: Modes) -> None:
    """Refuse arcs by I, J, K before the first G90.1 or G91.1 of the program, where that is open."""
    if not lines.dialect.arc_rule.centres_open or lines.reading.control.get(SETTING):
        return
    said = np.logical_or.accumulate(lines.stated("arc-distance")[: lines.live])
    said |= bool(lines.state.memory["centres"])
    if len(said):
        lines.state.memory["centres"] = int(said[-1])
    arcs = (modes.motion >= Kind.ARC_CW) & (modes.motion <= Kind.ARC_CCW)
    for line in np.flatnonzero(arcs & lines.flag("has_centre") & ~said)[: Findings.enough].tolist():
        lines.findings.add(line, "GX214", OPEN, hint=SAY)
