"""Lines of a SINUMERIK whose blocks have changed, in the manner in which they were programmed.

Words keep their order, their blanks and their `=`; a word in IC becomes an absolute one, and G91
becomes G90, as the block says. What cannot be said so is no line.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from gcxform_plugins.dialects.shared.words import COMMENT, WORD, number

CODE = re.compile(r'((?:[^";]|"[^"]*")*)(.*)', re.DOTALL)
AXES = "XYZABC"
VALUE = r"[-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)"
AXIS = re.compile(
    rf"(?<![A-Z0-9_])(?P<axis>[XYZABC])(?:(?P<blank>[ \t]*)(?P<plain>{VALUE})|"
    r"(?P<equals>[ \t]*=[ \t]*)(?P<value>(?:AC|IC)[ \t]*\([^()]*(?:\([^()]*\)[^()]*)*\)|"
    rf"{VALUE}(?![ \t]*(?:[-+*/<>=]|DIV|MOD))))(?![A-Z0-9_.])",
    re.IGNORECASE,
)
RADIUS = re.compile(rf"(?<![A-Z0-9_])CR[ \t]*=[ \t]*{VALUE}", re.IGNORECASE)
WAYS = re.compile(r"(?<![A-Z0-9_])([ABC])[ \t]*=[ \t]*(?:DC|ACP|ACN)[ \t]*\(", re.IGNORECASE)
DISTANCE = re.compile(
    r"[A-Z_]{2}[A-Z0-9_]*|(?P<steps>G[ \t]*0*91(?![0-9.]))|(?P<absolute>G[ \t]*0*90(?![0-9.]))",
    re.IGNORECASE,
)
"""G91 and G90, also behind a number without a blank, and names, which have two letters in front."""
NUMBER = re.compile(r"[ \t]*(?:/[0-9]?)?[ \t]*(?:[N:][ \t]*[0-9]+)?[ \t]*", re.IGNORECASE)


def spelled(line: str, blocks: Sequence[str]) -> str | None:
    """Return a line that stands for a block; None where that is not known."""
    if len(blocks) != 1:
        return None
    words = WORD.findall(COMMENT.sub("", blocks[0]))
    values = {letter: text for letter, text in words if letter in AXES}
    found = CODE.fullmatch(line)
    assert found is not None
    text, comment = found[1], found[2]
    said = [m["axis"].upper() for m in AXIS.finditer(text)]
    ways = {m[1].upper() for m in WAYS.finditer(text)}
    if len(set(said)) != len(said) or not set(values) <= {*said, *ways} or (said and not values):
        return None
    text = AXIS.sub(lambda m: _axis(m, values), text)
    centre = " ".join(f"{letter}{number(value)}" for letter, value in words if letter in "IJK")
    if centre:
        text = RADIUS.sub(centre, text)
    if ("G", "90") in words:
        text = DISTANCE.sub(lambda m: "G90" if m["steps"] else m[0], text)
        said_so = any(m["absolute"] for m in DISTANCE.finditer(text))
        if not said_so and "=" not in line:
            head = NUMBER.match(text)
            at = head.end() if head else 0
            text = f"{text[:at]}G90 {text[at:]}"
    return text + comment


def _axis(found: re.Match[str], values: dict[str, str]) -> str:
    """Return an axis word with its new value; one that does not move any more is left out."""
    axis = found["axis"]
    if axis.upper() not in values:
        return ""
    value = number(values[axis.upper()])
    if found["equals"] is not None:
        return f"{axis}{found['equals']}{value}"
    return f"{axis}{found['blank']}{value}"
