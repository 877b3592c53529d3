"""What only the machine knows: which words may have such a value, and what texts stand for it.

A value that is not known is nan. It makes lost what it goes into and nothing else: an axis until it
is programmed again, the feed until the next F. The block stays as it stands, and the proof compares
the text of what it could not compute.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from lark import Token, Tree

from gcxform.dialect.arithmetic import NoValueError
from gcxform.modal.expressions.value import Evaluator
from gcxform.modal.line_notes import Unknown
from gcxform.modal.lines import Lines
from gcxform.modal.meaning.meaning import Meaning
from gcxform.syntax.grammar import rule_of
from gcxform.syntax.tree import BLANKS

FREE = "FST"
"""Words that no move needs to be known of, besides axes."""
LENGTHS = frozenset({"length", "length-negative", "length-add"})
SETS_ZERO = "set-work"
STRENGTH = ("", "units", "place", "motion")


def bare_text(text: str) -> str:
    """Return a piece of a block as it is compared: without blanks, in capitals."""
    return text.translate(BLANKS).upper()


def may_be_unknown(address: str, meaning: Meaning) -> bool:
    """Whether a word of a block may have a value that is not known, and the block still be read.

    The words of arcs, cycles and shifts may not: what they do would depend on it.
    """
    if address in meaning.axes or (address in FREE and address in meaning.slots):
        return True
    waits = [event.slots for event in meaning.events if event.what == "DWELL"]
    if any(address == taken for slots in waits for taken, _ in slots):
        return True
    if address == "H" and any(act.name in LENGTHS for act in meaning.acts):
        return True
    return address != "L" and is_set(address, meaning)


def is_set(address: str, meaning: Meaning) -> bool:
    """Whether a word says what a G10 of a block sets, or in what place."""
    acts = (act for act in meaning.acts if act.name == SETS_ZERO)
    return any(address == taken for act in acts for taken, _ in act.slots)


def note_prints(lines: Lines) -> None:
    """Note what is printed of the machine: passes may change what it is worth."""
    for line in np.flatnonzero(lines.flag("prints")).tolist():
        text = lines.window.line(line).decode("latin-1")
        hangs = lines.table.meanings[int(lines.shape[line])].prints
        lines.unknown.append(Unknown(line, bare_text(text), hangs))


def hangs_on(node: Any, evaluator: Evaluator) -> str:
    """Return on what of a program an expression depends besides its parameters.

    "": on nothing; "units": on the unit in force; "place": on where the axes stand, or on modes;
    "motion": on the code of motion in force, or the canned cycle, as well.
    """
    found = [_of_parameter(each, evaluator) for each in _parameters(node)]
    return max(found, key=STRENGTH.index, default="")


def _parameters(node: Any) -> Iterator[Tree[Token]]:
    if isinstance(node, Tree):
        if rule_of(node) == "parameter":
            yield node
        for child in node.children:
            yield from _parameters(child)


def _of_parameter(node: Tree[Token], evaluator: Evaluator) -> str:
    try:
        return evaluator.arithmetic.hangs_on(evaluator.key(node))
    except NoValueError:
        return STRENGTH[-1]  # which parameter it is only the machine knows
