"""What a line of a SINUMERIK sets besides its blocks: it is said again where these are written out.

R parameters and frames are those of all programs; the variables of one that is called are not.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

import gcxform as gx
from gcxform_plugins.dialects.siemens.line import FRAMES
from gcxform_plugins.dialects.siemens.variables import WORDS

NAME = re.compile(r"[A-Z_][A-Z0-9_]*", re.IGNORECASE)
FUNCTIONS = frozenset(("SIN", "COS", "TAN", "ASIN", "ACOS", "ATAN2", "SQRT", "ABS", "POT"))
OF_ALL = re.compile(r"[RXYZ][0-9]*|RPL[0-9]*")
OF_R = re.compile(r"R[0-9]|R[ \t]*\[", re.IGNORECASE)
DEFINES = re.compile(r"(?:DEF|PROC|EXTERN)(?![A-Z0-9_])")
FOR = re.compile(
    r"(?<![A-Z0-9_])FOR[ \t]+(?P<name>[A-Z_][A-Z0-9_]*)[ \t]*=(?P<first>.*?)"
    r"(?<![A-Z_])TO(?![A-Z0-9_])",
    re.IGNORECASE,
)
SETTING = frozenset(("expression", "indexed", "named", "array"))


def said_of(text: str, items: Sequence[gx.Item], own: bool) -> list[str] | None:
    """Return what a line without its comment sets; None where only its own program can say it.

    `items` are those of a line that computes; `own`: it is one of the program that is written.
    """
    if any(item.kind == "command" and item.name in FRAMES for item in items):
        start = min(item.place[0] for item in items if item.name in FRAMES)
        frame = text[start:].strip()
        return [frame] if own or of_all(frame) else None
    said = [text[slice(*item.place)].strip() for item in items if _sets(item)]
    if not own:
        said = [each for each in said if re.match(OF_R, each)]
        if not all(map(of_all, said)):
            return None
    return [" ".join(said)] if said else []


def counted(head: str, begins: bool, own: bool) -> list[str] | None:
    """Return how a loop counts, by its FOR: where it `begins`, or at its end.

    None where only the program of the loop can say it. What is counted in a variable of that, when
    it is no longer there, nobody reads.
    """
    found = FOR.search(head)
    if found is None:
        return None
    name, first = found["name"], found["first"].strip()
    if not (own or OF_R.match(name)):
        return []
    if not (own or of_all(first)):
        return None
    return [f"{name}={first}" if begins else f"{name}={name}+1"]


def of_all(text: str) -> bool:
    """Whether a text names nothing but what all programs have."""
    names = {name.upper() for name in NAME.findall(text)} - FUNCTIONS - FRAMES
    return all(OF_ALL.fullmatch(name) for name in names)


def _sets(item: gx.Item) -> bool:
    if item.kind == "indexed":
        return item.name == "R"
    return item.kind in SETTING and not (item.kind != "array" and WORDS.fullmatch(item.name))
