"""Lines of a TNC whose blocks have changed, in the manner in which they were programmed.

Words keep their order, their blanks and their signs; a word with I becomes one without, which says
where its axis goes. What cannot be said so is no line.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from decimal import Decimal

from gcxform_plugins.dialects.shared.words import COMMENT, WORD

AXES = "XYZABCUVW"
VALUE = r"[-+]?[ \t]*(?:[0-9]+(?:[.,][0-9]*)?|[.,][0-9]+)"
AXIS = re.compile(
    rf"(?<![A-Z0-9])(?P<step>I?)(?P<axis>[XYZABCUVW])(?P<blank>[ \t]*)"
    rf"(?:(?P<value>{VALUE})|(?P<q>[-+]?[ \t]*Q[LR]?[0-9]+))",
    re.IGNORECASE,
)
POLAR = re.compile(
    rf"(?<![A-Z0-9])IP(?P<what>[AR])(?P<blank>[ \t]*)(?:{VALUE}|[-+]?[ \t]*Q[LR]?[0-9]+)",
    re.IGNORECASE,
)
PATH = re.compile(r"[ \t]*(?:/[ \t]*)?(?:[0-9]+[ \t]+)?(?:/[ \t]*)?(LP|CP|CR|L|C)(?![A-Z])", re.I)
STEPPED = re.compile(
    r"(?<![A-Z0-9])I[XYZABCUVW](?=[ \t]*[-+.,0-9Q])|"
    r"LP(?![A-Z]).*(?<![A-Z0-9])IP[AR]",
    re.IGNORECASE,
)
"""Words that count from where an axis stands. IPA of CP is no such word: it may be many turns."""
STEPPED_AT = tuple(
    re.compile(rf"{letter}(?:[XYZABCUVWxyzabcuvw][ \t]*[-+.,0-9Qq]|[Pp][ARar])") for letter in "Ii"
)
"""Of these each of them has one, which is found sooner."""


def code(text: str) -> str:
    """Return a line without its comment."""
    return text.partition(";")[0]


def spelled(line: str, blocks: Sequence[str], polar: tuple[str, str] | None) -> str | None:
    """Return a line that stands for blocks; None where that is not known.

    `polar` are PR and PA of a line that leads to them by steps.
    """
    words = [each for block in blocks for each in WORD.findall(COMMENT.sub("", block))]
    values = {letter: text for letter, text in words if letter in AXES}
    said = [letter for letter, _ in words if letter in AXES]
    path = PATH.match(line)
    if path is None or len(set(said)) != len(said):
        return None
    text, behind = line[: len(code(line))], line[len(code(line)) :]
    if path[1].upper() in ("C", "CR", "CP") and not {letter for letter, _ in words} & set("IJKR"):
        return None
    named = [found["axis"].upper() for found in AXIS.finditer(text)]
    circle = path[1].upper() in ("C", "CR", "CP", "LP")
    if len(set(named)) != len(named) or not (circle or values.keys() <= set(named)):
        return None
    text = AXIS.sub(lambda found: _axis(found, values), text)
    if path[1].upper() == "LP" and POLAR.search(text):
        if polar is None:
            return None
        text = POLAR.sub(lambda found: _polar(found, *polar), text)
    return text + behind


def _axis(found: re.Match[str], values: dict[str, str]) -> str:
    """Return an axis word with its new value; one that does not move any more is left out."""
    axis = found["axis"]
    if axis.upper() not in values:
        return ""
    new = Decimal(values[axis.upper()])
    old = found["value"]
    if old is not None and not found["step"] and _number(old) == new:
        return found[0]
    signed = found["step"] or found["q"] or old.lstrip()[:1] == "+"
    plus = "+" if signed and new >= 0 else ""
    text = format(new.normalize(), "f")
    if old is not None and "," in old:
        text = text.replace(".", ",")
    return f"{axis}{found['blank']}{plus}{text}"


def _polar(found: re.Match[str], radius: str, angle: str) -> str:
    number = radius if found["what"].upper() == "R" else angle
    plus = "" if number.startswith("-") else "+"
    return f"P{found['what']}{found['blank']}{plus}{number}"


def _number(text: str) -> Decimal:
    return Decimal(text.replace(",", ".").replace(" ", "").replace("\t", ""))
