"""Which axes a line moves that stays as it stands, by the kinds of its words alone.

Such a line has words whose values only the control knows, or which move in a way that no block of
words says. It is executed as it was; what it names is somewhere else behind it, and nothing more.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import Any

import gcxform as gx
from gcxform_plugins.dialects.siemens.nodes import rule_of, span_of
from gcxform_plugins.dialects.siemens.place import LINEAR, ROTARY

ALL = LINEAR + ROTARY
WORD = re.compile(r"([A-Z])[ \t]*([-+]?[0-9.]+)")
CODES = frozenset((
    "0", "1", "2", "3", "4", "9", "17", "18", "19", "40", "41", "42", "54", "55", "56", "57", "60",
    "64", "71", "90", "91", "93", "94", "95", "110", "111", "112", "450", "451", "601", "602",
    "603", "641", "642", "643", "644", "645", "710",
))  # fmt: skip
"""G codes that move nothing but the axes that are named, and modes that are read."""
ZEROS = frozenset(("53", "58", "59", "153", "500", *(str(n) for n in range(505, 600))))
"""Those that change zeros (K2 741), for a block or longer."""
FRAMES = re.compile(r"A?(?:TRANS|ROTS?|SCALE|MIRROR)|SUP[AD]|TRAORI|TRAFOOF|DIAMON|DIAM90")
"""What says in which coordinates, or in which measure, the words behind it are."""
PATHS = frozenset(("CT", "CIP", "ASPLINE", "BSPLINE", "CSPLINE", "POLY", "INVCW", "INVCCW"))
"""Motions, in force until another one is (PM 1262)."""
ENDS_OF_SPLINES = frozenset(("BAUTO", "BNAT", "BTAN", "EAUTO", "ENAT", "ETAN"))
OTHER = "other"
"""A motion that is none of the blocks'."""
POLAR = frozenset(("AP", "RP", "ANG", "AR"))
"""What says by angles where X, Y and Z go, with no word of an axis."""
LENGTHS = frozenset(("TOFF", "TOFFL", "DL", "TCARR", "CUTMOD"))
"""What changes the length of the tool: a step behind it adds that, or not (SD42442)."""
MOVING = frozenset(("POS", "POSA", "POSP", "SPOSA", "LEAD", "TILT", "THETA"))


SWIVELS = re.compile(r"(?:CYCLE800|TRAORI)[ \t]*\(", re.IGNORECASE)
DRILLING = re.compile(r"(?:CYCLE(?:8[1-9]|840|801)|HOLES[12])[ \t]*\(", re.IGNORECASE)
"""Cycles that move along the axis of the tool, or on to holes; they return modes and frames."""
MILLING = re.compile(
    r"(?:CYCLE(?:6[0-4]|7[0126-9]|802|899)|POCKET[1-4]|SLOT[12]|LONGHOLE)[ \t]*\(", re.IGNORECASE
)
"""Those that mill, on paths that no manual tells: kept whole, and in feeds of their own."""


def words_of(tree: Any, text: str) -> Iterator[gx.Item]:
    """Yield the items of a line that computes: to the grammar of words its rest is one item."""
    for node in tree.children:
        rule, place = rule_of(node), span_of(node)
        whole = text[slice(*place)].strip().upper()
        found = WORD.fullmatch(whole)
        if rule == "word" and found:
            yield gx.Item("word", (found[1],), (found[2],), place)
        elif rule == "assignment":
            target = node.children[0]
            name = str(target.children[0]).upper()
            numbered = len(name) > 1 and name[1:].isdigit()
            kind = "array" if len(target.children) > 1 else "indexed" if numbered else "expression"
            yield gx.Item(kind, (name[0] if kind == "indexed" else name,), (), place)
        elif rule == "bare":
            yield gx.Item("command", (whole,), (), place)
        else:
            yield gx.Item("label" if rule in ("label", "sequence") else "call", (whole,), (), place)


def axes_of(items: Sequence[gx.Item], quiet: frozenset[str], m_codes: frozenset[int]) -> str | None:
    """Return the axes that are elsewhere behind a line, T for a tool; None where it may do more."""
    found = [_of_item(item, quiet, m_codes) for item in items]
    if [item.name for item in items][:1] == ["MCALL"] and found[1:] == [LINEAR]:
        return ""  # it drills behind the blocks that follow
    if any(each is None for each in found):
        return None
    return "".join(dict.fromkeys("".join(each or "" for each in found)))


def _of_item(item: gx.Item, quiet: frozenset[str], m_codes: frozenset[int]) -> str | None:
    name, kind = item.name, item.kind
    if kind in ("label", "main_number"):
        return ""
    if kind in ("word", "value", "function") or (kind == "expression" and len(name) == 1):
        return _of_word(item, m_codes)
    if kind in ("named", "expression"):
        if name == "SPOS":  # the spindle turns to an angle: it may be one of the rotary axes
            return ROTARY
        return None if name in MOVING else LINEAR if name in POLAR | LENGTHS else ""
    if kind == "indexed":
        return "" if name in "IJKMRS" else ALL
    if kind == "tool_name":
        return ALL + "T"
    if kind == "command":
        known = name in quiet or name in PATHS or name in ENDS_OF_SPLINES or name == "MCALL"
        return ALL if FRAMES.fullmatch(name) else "" if known else None
    return _of_call(name) if kind == "call" else None


def _of_call(name: str) -> str | None:
    """Return the axes of a cycle that is known to move no others; None for other calls."""
    kinds = (SWIVELS, ALL), (DRILLING, LINEAR), (MILLING, LINEAR + "F")
    return next((axes for pattern, axes in kinds if pattern.match(name)), None)


def _of_word(item: gx.Item, m_codes: frozenset[int]) -> str | None:
    """Return the axes of a word of one letter."""
    letter, number = item.name, item.numbers[0] if item.numbers else ""
    if letter in ALL:
        return letter
    if letter == "G":
        code = number.lstrip("0") or "0"
        return "" if code in CODES else ALL if code in ZEROS else None
    if letter == "M":
        known = number.isdigit() and int(number) in m_codes
        return None if not known else ALL + "T" if int(number) == 6 else ""
    if letter in "TD":
        return ALL + "T"
    if letter == "F" and item.kind == "expression":
        return "F"
    return None if letter in "LPHR" else ""
