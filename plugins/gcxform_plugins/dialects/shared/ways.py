"""What languages of controls have no words for alike, and passes that say it otherwise."""

from __future__ import annotations

import gcxform as gx

CENTRED = gx.put_before("cutter-comp")
IN_LINES = gx.put_before("segment", options="chord-error=2um")
UNSHIFTED = gx.put_before("offsets")
IN_SPINDLE = "write T and M6 before; or say tool = 1 in [input], if it is tool 1"

OTHER_RADIUS = "the radius of another tool than the one in the spindle", CENTRED
NO_EDGE = "compensation, and no tool length is in force: the edge has both", CENTRED
