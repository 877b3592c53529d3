"""What is left of an expression that only the machine can compute: its text with all that is known.

Parameters whose values are known become numbers, because the blocks that set them need not be
written. Those that are not known stay, and then what may set them has to stand in the text too.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import field
from typing import Any

from lark import Tree

from gcxform.dialect.arithmetic import Key, NoValueError
from gcxform.flow.text import number
from gcxform.modal.expressions.value import Evaluator, written
from gcxform.syntax.grammar import rule_of, span_of
from gcxform.values import dataclass

Edit = tuple[int, int, str]
"""Columns of a block, from 0, and what stands there instead."""


@dataclass(slots=True)
class Residual:
    """The edits that put what is known into an expression; `reads` are the parameters that stay.

    `anywhere`: which parameter is read only the machine knows.
    """

    edits: list[Edit] = field(default_factory=list)
    reads: set[Key] = field(default_factory=set)
    anywhere: bool = False


def residual(node: Any, evaluator: Evaluator) -> Residual:
    """Return what is left of an expression, a condition, or an assignment."""
    found = Residual()
    for child in [node] if rule_of(node) == "parameter" else node.children:
        if isinstance(child, Tree) and rule_of(child) == "assignment":
            _assignment(child, evaluator, found)
        elif rule_of(node) == "assignment":
            _assignment(node, evaluator, found)
            break
        else:
            for parameter in _outermost(child):
                _one(parameter, evaluator, found)
    return found


def _assignment(node: Tree[Any], evaluator: Evaluator, found: Residual) -> None:
    target, value = node.children
    if isinstance(target.children[0], Tree):
        found.edits.append((*span_of(target), written(evaluator.key(target))))
    for parameter in _outermost(value):
        _one(parameter, evaluator, found)


def _one(node: Tree[Any], evaluator: Evaluator, found: Residual) -> None:
    """Put what a parameter is worth in its place, or note that it stays.

    Raises NoValueError for one that has no value on the machine either.
    """
    try:
        text = number(evaluator.value(node), evaluator.arithmetic)
        found.edits.append((*span_of(node), f"[{text}]" if text.startswith("-") else text))
        return
    except NoValueError as why:
        if not why.lost:
            raise
    if rule_of(node) != "parameter":
        return
    try:
        key = evaluator.key(node)
    except NoValueError:
        found.anywhere = True
        for child in _outermost(node.children[0]):
            _one(child, evaluator, found)
        return
    found.reads.add(key)
    if isinstance(node.children[0], Tree):
        found.edits.append((*span_of(node), written(key)))


def _outermost(node: Any) -> Iterator[Tree[Any]]:
    """Yield the parameters of an expression that are in no other one, and what asks for them."""
    if not isinstance(node, Tree):
        return
    if rule_of(node) == "parameter" or _asks(node):
        yield node
        return
    for child in node.children:
        yield from _outermost(child)


def _asks(node: Tree[Any]) -> bool:
    """Whether a node is EXISTS of a parameter: that has no number in its place."""
    return rule_of(node) == "call" and str(node.children[0]).upper() == "EXISTS"


def edited(text: str, start: int, end: int, edits: list[Edit]) -> str:
    """Return a piece of a block with its edits done."""
    piece = text[start:end]
    for first, last, new in sorted(edits, reverse=True):
        piece = piece[: first - start] + new + piece[last - start :]
    return piece
