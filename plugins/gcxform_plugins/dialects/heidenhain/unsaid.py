"""What Klartext has no words for, each with the pass that says it otherwise."""

from __future__ import annotations

from collections.abc import Sequence

import gcxform as gx
from gcxform_plugins.dialects.shared.ways import CENTRED, IN_LINES, UNSHIFTED

ONE_UNIT = "a TNC has one unit in a program", gx.put_before("metric")
NO_EXACT_PATH = "a TNC has no exact path", 'drop = ["G61"] in [output] leaves it out'
IN_MM = "leave `metric` out: a TNC takes programs in inches"

FROM_AN_ARC = "a contour begins and ends in lines, not in arcs", CENTRED
ASIDE_CONTOUR = "a contour out of XY has no words in Klartext", CENTRED
ASIDE_ARC = "an arc by its radius, or of many turns, out of XY", IN_LINES
ASIDE_HELIX = "a helix out of XY has no words in Klartext", IN_LINES
ASIDE_WHOLE = "a whole turn from where a helix ends, out of XY", IN_LINES
HELIX = "a helix by its radius has no words in Klartext", IN_LINES

TURNED = "G68 about another point has no words in Klartext", UNSHIFTED
SHIFTED = "G52 of fewer axes, or that changes nothing", UNSHIFTED
IN_INCHES = "P", "1"
PRESET = "CYCL DEF 247"
WORK = frozenset(("G55", "G56", "G57", "G58", "G59", "G54.1"))


def code_unsaid(code: str) -> gx.UnspeakableError:
    """Return that a code has no words; work offsets are a matter of `offsets`."""
    hint = UNSHIFTED if code in WORK else ""
    return gx.UnspeakableError(f"{code} has no words in Klartext", hint)


def beside(asides: Sequence[str], words: Sequence[tuple[str, str]]) -> list[tuple[str, str]]:
    """Return the words of a block that no line which goes along says: its inches, its preset."""
    own = {*WORK} if asides and asides[0].startswith(PRESET) else set[str]()
    own |= {"".join(IN_INCHES)} if asides else set()
    return [each for each in words if "".join(each) not in own]


def in_inches(text: str) -> gx.UnspeakableError:
    """Return the refusal of a line in inches in a program that is in mm now."""
    return gx.UnspeakableError(f"{text}: in inches, as the program is no more", IN_MM)
