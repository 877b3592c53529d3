"""What a line of a TNC sets besides its blocks: it is said again where these are written out.

Q parameters, cycles and their places, the pole: they hold for lines behind, in whichever program.
QL parameters of a program that is called are not those of who calls it.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from gcxform_plugins.dialects.heidenhain.cycles import DEFINED, PARAMETER
from gcxform_plugins.dialects.heidenhain.holes import HOLES, PATTERNS, TAP
from gcxform_plugins.dialects.heidenhain.kept_cycles import KEPT
from gcxform_plugins.dialects.heidenhain.parameters import FN, PRINTS, SETS, STANDS, WRITES
from gcxform_plugins.dialects.heidenhain.words import HEAD

SAID = re.compile(r"(?:PATTERN|SEL\s+PGM|FPOL|TRANS|QS?(?=[0-9]))(?![A-Z])", re.IGNORECASE)
"""What sets by itself what its text says."""
LOCAL = re.compile(r"QL[0-9]", re.IGNORECASE)
CENTRE = re.compile(r"CC(?![A-Z])", re.IGNORECASE)
READS = frozenset((18, 28))
IN_LINES = frozenset((1, 7, 8, 9, 10))
"""Cycles that are told in several statements, of which the last may have a block."""
TARGET = re.compile(r"(?:FN\s*\d+\s*:(?:\s*SYSREAD|\s*TABREAD)?\s*)?(Q[LRS]?)\s*\d", re.IGNORECASE)
STEPS = re.compile(r"CC[ \t]*$|(?<![A-Z])I[XYZ]", re.IGNORECASE)


def said_of(lines: Sequence[str], own: bool, unsaid: bool = False) -> list[str] | None:
    """Return what a statement sets, given its lines; None where only its own program can say it.

    `own`: it is one of the program that is written; `unsaid`: it sets what outlives the program,
    and no block says so.
    """
    first, *more = lines
    bare = first.partition(";")[0] if ";" in first else first
    goes_on = " ~" if more and "~" not in bare else ""
    text = HEAD.sub("", bare, 1).rstrip() + goes_on
    said = _kept(text.rstrip("~ "), [text, *more], unsaid)
    if not own and _tells(text) and LOCAL.search(text):
        return None
    if own or not said or not any(LOCAL.search(each) for each in said):
        return said
    target = TARGET.match(text)
    stays = (target and target[1].upper() == "QL") or CENTRE.match(text)
    return [] if stays else None


def _kept(text: str, lines: list[str], unsaid: bool) -> list[str]:
    """Return the lines that say again what a statement sets."""
    function, cycle = FN.fullmatch(text), DEFINED.fullmatch(text.upper())
    if unsaid:
        return lines
    if function is not None:
        return lines if int(function[1]) in {*SETS, *READS} and not _outlives(text) else []
    if cycle is not None and int(cycle[1]) in PATTERNS:
        found = PARAMETER.finditer(" ".join(lines).upper())
        return [f"Q{each[1]} = {each[2] or each[3]}" for each in found if each[2] or each[3]]
    if cycle is not None:
        return lines if int(cycle[1]) in {*HOLES, TAP, *KEPT, *IN_LINES} else []
    if re.match(r"QL[0-9]", text, re.IGNORECASE) or SAID.match(text):
        return lines
    return lines if CENTRE.match(text) and not STEPS.search(text) else []


def _tells(text: str) -> bool:
    """Whether a statement hands parameters on to others, as they are in its program."""
    function = FN.fullmatch(text)
    return function is not None and int(function[1]) in {*PRINTS, *STANDS, WRITES}


def _outlives(text: str) -> bool:
    """Whether a statement sets a QR parameter, which its block says."""
    target = TARGET.match(text)
    return target is not None and target[1].upper() == "QR"
