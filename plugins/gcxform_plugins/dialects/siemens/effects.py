"""What a line does that is not executed here: whether it moves anything, by its words alone.

A line that may be executed, or that sets what only the control has, stays as it stands. Where it
moves nothing all is known behind it but what it sets.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

from lark import Token, Tree
from lark.exceptions import UnexpectedInput

from gcxform_plugins.dialects.siemens.asides import TELLING
from gcxform_plugins.dialects.siemens.nodes import Node, rule_of
from gcxform_plugins.dialects.siemens.place import LINEAR, ROTARY

QUIET_CALLS = frozenset(("SETAL", "SETMS", "MSG", "FGROUP", *TELLING))
"""Calls that tell, or say of which spindle and axes S and F are (PM 105, 457)."""
QUIET_NAMES = frozenset(("STOPRE", "SETMS", "MSG", "DISPLOF", "SBLOF", "SBLON"))
SPEEDS = frozenset(("ACC", "FA", "FL", "FGREF", "VELOLIM", "JERKLIM"))
"""How fast axes go, by their names in brackets."""
# fmt: off
OTHERS = frozenset((
    "POS", "POSA", "POSP", "AX", "MOV", "SPOS", "SPOSA", "AP", "RP", "CR", "AR", "TURN", "RND",
    "RNDM", "CHF", "CHR", "ANG", "LEAD", "TILT", "THETA", "PW", "SD", "PL", "PO", "DISR", "DISCL",
    "OFFN", "ADIS", "ADISPOS", "FRC", "FRCM", "TOFF", "TOFFL", "TOFFR",
    "DL", "TCARR", "CUTMOD",
))
# fmt: on
"""Words of the language that move axes, or say how: they are set by nobody."""
OSCILLATION = re.compile(r"OS[A-Z0-9]*")
OF_THE_PLC = re.compile(r"\$(?:A_[A-Z]+|AC_(?:MARKER|PARAM|TIMER))")
OF_TOOLS = re.compile(r"\$TC_[A-Z]+[0-9]*")
OF_ZEROS = re.compile(r"\$P_(?:UIFR|PFRAME|IFRAME|CHBFR|UBFR)")
LETTER = re.compile(r"[A-Z][0-9]*")
PARAMETER = re.compile(r"R[0-9]*")
DECIDING = frozenset((
    "if", "else", "endif", "while", "endwhile", "for", "endfor", "loop", "endloop", "repeat",
    "until", "case", "jump", "def", "extern", "return",
))  # fmt: skip
"""What decides, or defines: it moves nothing itself."""
ASIDE = frozenset(("label", "sequence"))
STILL = re.compile(
    r"S[ \t]*[0-9.]+|M[ \t]*0*(?:[0-57-9]|17|30|4[0-5])|G[ \t]*0*(?:4|9|60|64[1-5]?|60[1-3])",
    re.IGNORECASE,
)
"""Words of the spindle, of coolant, of stops, ends and corners."""
CODE = r'(?i)^(?:[^;"]|"[^"]*")*?(?<![A-Z0-9_])'
ARCS = re.compile(
    rf"{CODE}(?:G[ \t]*0*[23](?![0-9.])|(?:CIP|CT|INVC?CW|[ABC]SPLINE|POLY|RNDM?)(?![A-Z0-9_]))"
)
AGAINST = {
    "METRIC": re.compile(rf"{CODE}G[ \t]*0*700?(?![0-9.])"),
    "LINEAR_ONLY": ARCS,
    "XY_ARCS": ARCS,
    "NO_CYCLES": re.compile(rf"{CODE}(?:CYCLE8[1-9]|HOLES[12])(?![A-Z0-9_])"),
    "WORKPIECE_FRAME": re.compile(
        rf"{CODE}(?:A?(?:TRANS|ROTS?|SCALE|MIRROR)[ \t]+[A-Z]|CYCLE800[ \t]*\([ \t]*[^) \t])"
    ),
}
"""Where these stand in a line that stays, a pass cannot do what it is for."""


def effect_of(parse: Callable[[str], Node], text: str, known: Callable[[str], bool]) -> str | None:
    """Return the axes that are not where they were behind a line; None where it may do anything.

    `parse` makes the tree of a line that computes, `known` tells names of variables. A name that
    nothing defines and that a line sets, and does nothing else, is taken for a variable of the
    control, or for an axis beside X, Y, Z, A, B and C.
    """
    try:
        tree = parse(text)
    except UnexpectedInput:
        return None
    found = [_of_node(node, known) for node in tree.children]
    if any(each is None for each in found):
        return None
    return "".join(dict.fromkeys("".join(each or "" for each in found)))


def _of_node(node: Any, known: Callable[[str], bool]) -> str | None:
    if isinstance(node, Token):
        return ""
    rule = rule_of(node)
    if rule in DECIDING or rule in ASIDE:
        return ""
    if rule == "assignment":
        return _of_target(node.children[0], known)
    if rule == "word":
        text = str(node.children[0])
        return "" if STILL.fullmatch(text) else "F" if text[0] in "Ff" else None
    if rule in ("call", "bare"):
        names = QUIET_CALLS if rule == "call" else QUIET_NAMES
        return "" if str(node.children[0]).upper() in names else None
    return None


def _of_target(target: Tree[Token], known: Callable[[str], bool]) -> str | None:
    """Return the axes that are lost where something is set."""
    name, indexed = str(target.children[0]).upper(), len(target.children) > 1
    if known(name) or PARAMETER.fullmatch(name):
        return ""
    if name.startswith("$"):
        if OF_ZEROS.fullmatch(name):
            return LINEAR + ROTARY
        return LINEAR if OF_TOOLS.fullmatch(name) else "" if OF_THE_PLC.fullmatch(name) else None
    if name in ("S", "F"):
        return name.replace("S", "")
    if name == "SPOS" and indexed:
        return ROTARY
    if LETTER.fullmatch(name) or name in OTHERS or OSCILLATION.fullmatch(name):
        return None
    return "" if indexed or name in SPEEDS or len(name) > 1 else None
