"""Trees of lines that differ only in their numbers: lark parses the first of them alone.

A line that computes is looked at as a tree. Those of lines of one shape, the text with its numbers
taken out, have the same nodes: a tree is made again with other numbers, and what stands behind them
is moved. A number that is part of a name or of a text belongs to the shape, and so does whether it
has a point, for there are words that have none.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from itertools import accumulate
from typing import Any

from lark import Lark, Token, Tree
from lark.tree import Meta

SLOT = "\uffff"  # stands for a number in a shape: no program, read as bytes, has it
NUMBER = re.compile(r"([0-9]+(?:\.[0-9]*)?|\.[0-9]+)")
MOST = 4096  # shapes that are kept, and trees
ENDS_IN_ONE = frozenset(("NUMBER", "WORD", "SEQUENCE"))
"""Terminals that are a number, or end with one that may be any other."""
Maker = Callable[[Sequence[str], Sequence[int]], Any]


class TreeShapes:
    """Parses lines with a grammar; what is returned is nobody's to change."""

    def __init__(self, grammar: Lark) -> None:
        self.grammar = grammar
        self._trees: dict[str, Tree[Token]] = {}
        self._fixed: dict[str, tuple[int, ...] | None] = {}
        self._makers: dict[tuple[str, ...], tuple[Maker, list[int]]] = {}

    def parse(self, text: str) -> Tree[Token]:
        """Return the tree of a line. Raises UnexpectedInput."""
        tree = self._trees.get(text)
        if tree is None:
            if len(self._trees) >= MOST:
                self._trees.clear()
            tree = self._trees[text] = self._parse(text)
        return tree

    def key(self, text: str) -> str:
        """Return a line without its numbers, and with their forms. Raises UnexpectedInput."""
        key, _ = _key(text)
        if key not in self._fixed:
            self.parse(text)
        return key

    def fixed(self, key: str) -> tuple[int, ...] | None:
        """Return which numbers of lines of a key are part of their shape; None for no shape.

        Trees of lines of one shape have the same nodes, and texts beside the other numbers.
        """
        return self._fixed.get(key)

    def spans(self, text: str) -> list[tuple[int, int]]:
        """Return where the numbers of a line stand: columns from 0."""
        return [found.span() for found in NUMBER.finditer(text)]

    def _parse(self, text: str) -> Tree[Token]:
        key, numbers = _key(text)
        fixed = self._fixed.get(key, ())
        if fixed is None:
            return self.grammar.parse(text)
        shape = (key, *[numbers[k] for k in fixed])
        known = self._makers.get(shape)
        if known is None:
            return self._first(text, key, numbers)
        maker, lengths = known
        longer = [len(n) - length for n, length in zip(numbers, lengths, strict=True)]
        made: Tree[Token] = maker(numbers, [*accumulate(longer, initial=0)])
        return made

    def _first(self, text: str, key: str, numbers: list[str]) -> Tree[Token]:
        """Return the tree of a line, the first of its shape."""
        tree = self.grammar.parse(text)
        ends = [found.end() for found in NUMBER.finditer(text)]
        slots: set[int] = set()
        maker = _maker(tree, ends, numbers, slots)
        fixed = tuple(k for k in range(len(numbers)) if k not in slots)
        if self._fixed.setdefault(key, fixed) != fixed:
            self._fixed[key] = None  # what its numbers are is not said by where they stand
            return tree
        if len(self._makers) >= MOST:
            self._makers.clear()
        self._makers[key, *[numbers[k] for k in fixed]] = maker, [len(n) for n in numbers]
        return tree


def _key(text: str) -> tuple[str, list[str]]:
    """Return a line without its numbers, and these."""
    pieces = NUMBER.split(text)
    numbers = pieces[1::2]
    return f"{SLOT.join(pieces[::2])}{''.join(map(_form, numbers))}", numbers


def _form(number: str) -> str:
    """Return what else of a number belongs to a shape: whether, and where, it has a point."""
    return "#" if number.isdigit() else "," if number[0] == "." else "."


def _maker(node: Any, ends: list[int], numbers: Sequence[str], slots: set[int]) -> Maker:
    """Return what makes a node with other numbers; `slots` are those that it may have others of."""
    if isinstance(node, Token):
        return _token_maker(node, ends, numbers, slots)
    data, empty = node.data, node.meta.empty
    parts = [_maker(child, ends, numbers, slots) for child in node.children]
    start, end = (0, 0) if empty else (node.meta.start_pos, node.meta.end_pos)
    before, within = (sum(e <= at for e in ends) for at in (start, end))

    def made(found: Sequence[str], moved: Sequence[int]) -> Tree[Token]:
        meta = Meta()  # type: ignore[no-untyped-call]
        if not empty:
            meta.empty = False
            meta.start_pos, meta.end_pos = start + moved[before], end + moved[within]
        return Tree(data, [part(found, moved) for part in parts], meta)

    return made


def _token_maker(token: Token, ends: list[int], numbers: Sequence[str], slots: set[int]) -> Maker:
    kind, text, start = token.type, str(token), token.start_pos or 0
    inside = [k for k, end in enumerate(ends) if start < end <= start + len(text)]
    before = sum(end <= start for end in ends)
    ends_in = kind.rsplit("__", 1)[-1] in ENDS_IN_ONE and len(inside) == 1
    if not ends_in or not text.endswith(numbers[inside[0]]):
        return lambda _, moved: Token(kind, text, start + moved[before])
    slot = inside[0]
    slots.add(slot)
    head = text.removesuffix(numbers[slot])
    return lambda found, moved: Token(kind, head + found[slot], start + moved[before])
