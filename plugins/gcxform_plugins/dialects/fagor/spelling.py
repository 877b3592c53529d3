"""Lines of a Fagor whose blocks have changed, in the manner in which they were programmed.

Words keep their order and their blanks; `X5I` becomes `X` with the place it leads to, and G91
becomes G90, as the block says. What cannot be said so is no line.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from decimal import Decimal

from gcxform_plugins.dialects.fagor.structure import code
from gcxform_plugins.dialects.shared.words import COMMENT, WORD, number

AXES = "XYZABCUVW"
NUMBER = r"[-+]?[ \t]*(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)"
VALUE = rf"(?:{NUMBER}|[-+]?[ \t]*(?:P[0-9]+|\[(?:[^\[\]\n]|\[[^\[\]\n]*\])*\]))"
STEP = r"I(?![ \t]*[-+.0-9=\[P])"
AXIS = re.compile(
    rf"(?<![A-Z0-9_.])(?P<axis>[{AXES}])(?P<blank>[ \t]*=?[ \t]*)(?P<value>{VALUE})"
    rf"(?P<step>{STEP})?(?![ \t]*[*/]|[-+0-9.])",
    re.IGNORECASE,
)
BEGINS = r"(?:(?<![A-Z_])|(?<=[0-9.\]]I))"
"""Where a word may begin: also behind a number, and behind the I of X5I, without a blank."""
STEPS = re.compile(rf"{BEGINS}G[ \t]*0*91(?![0-9.])", re.IGNORECASE)
ABSOLUTE = re.compile(rf"{BEGINS}G[ \t]*0*90(?![0-9.])", re.IGNORECASE)
RADIUS = re.compile(rf"(?<![A-Z0-9_])R[ \t]*=?[ \t]*{NUMBER}", re.IGNORECASE)
HEAD = re.compile(r"[ \t]*/?[ \t]*(?:N[ \t]*[0-9]+[ \t]*:?)?(?:[ \t]*\[[A-Z0-9_ ]*\])*", re.I)
COUNTS = re.compile(
    rf"{BEGINS}[{AXES}RQ][ \t]*=?[ \t]*{VALUE}{STEP}|{STEPS.pattern}", re.IGNORECASE
)
"""Words that count from where their axis stands, or G91."""
STEPPED = tuple(map(re.compile, (r"91(?![0-9.])", r"I(?<=[0-9.\]]I)", r"i(?<=[0-9.\]]i)")))
"""Of these each of them has one, which is found sooner."""


def spelled(line: str, blocks: Sequence[str]) -> str | None:
    """Return a line that stands for blocks; None where that is not known."""
    words = [each for block in blocks for each in WORD.findall(COMMENT.sub("", block))]
    values = {letter: text for letter, text in words if letter in AXES}
    moved = [letter for letter, _ in words if letter in AXES]
    text = code(line).rstrip()
    if ";" in line or "(" in line:
        text = line[: len(text)]
    behind = line[len(text) :]
    if code(text) != text or len(set(moved)) != len(moved) or ("G", "91") in words:
        return None
    said = [m["axis"].upper() for m in AXIS.finditer(text)]
    if len(set(said)) != len(said) or not set(values) <= set(said) or (said and not values):
        return None
    centre = " ".join(f"{letter}{number(value)}" for letter, value in words if letter in "IJK")
    text = AXIS.sub(lambda m: _axis(m, values), text)
    if centre:
        text = RADIUS.sub(centre, text)
    text = STEPS.sub("G90", text)
    if ("G", "90") in words and not ABSOLUTE.search(text):
        head = HEAD.match(text)
        at = head.end() if head else 0
        text = f"{text[:at]}{' ' if at else ''}G90 {text[at:].lstrip()}"
    return text + behind


def _axis(found: re.Match[str], values: dict[str, str]) -> str:
    """Return an axis word with its new value; one that does not move any more is left out."""
    axis = found["axis"]
    if axis.upper() not in values:
        return ""
    new, old = Decimal(values[axis.upper()]), found["value"].replace(" ", "").replace("\t", "")
    if not found["step"] and re.fullmatch(NUMBER, old) and Decimal(old) == new:
        return found[0]
    return f"{axis}{found['blank']}{number(values[axis.upper()])}"
