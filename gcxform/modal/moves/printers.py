"""What printers do not hear: words without a command; and E that firmware reads in two ways."""

from __future__ import annotations

import numpy as np

from gcxform.dialect.dialect import EXTRUDER
from gcxform.modal.findings import Findings
from gcxform.modal.frames.track import Track
from gcxform.system.arrays import Flags

UNMOVED = "axis words, but no motion code is in force"
SAY_MOTION = "write G1 in this block, or G0 if the way is clear"
OPEN = "firmware differs in what G90 and G91 do to E: whether it is a distance is open"
SAY_EXTRUSION = "write M82 or M83 in a block before"


def refuse_unheard(track: Track, moving: Flags) -> None:
    """Refuse moves (lines,) whose block has no command, where each one needs it; and such E."""
    if track.dialect.block_rule.one_command:
        for line in np.flatnonzero(moving & ~track.lines.stated("motion")).tolist():
            track.findings.add(line, "GX209", UNMOVED, hint=SAY_MOTION)
    word = track.column(EXTRUDER) if EXTRUDER in track.axes else None
    if word is None:
        return
    for line in np.flatnonzero(word[1] & (track.modes.extruded < 0))[: Findings.enough].tolist():
        track.findings.add(line, "GX214", OPEN, EXTRUDER, SAY_EXTRUSION)
