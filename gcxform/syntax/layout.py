"""Where the marks of an outline stand in its tree: what the lines of an outline have in columns.

The tree of the first line of an outline (`outlines.py`) is the tree of all of them, if every number
and every comment of it is a mark of the outline, and nothing else is. A layout says so, and which
piece of a line is which slot:

- the values of words that are no codes, in order, as in any shape: numbers, or expressions, whose
  value is not known before they are computed;
- the comments, as pieces of text;
- the numbers inside expressions: the operands;
- the assignments, as pieces of text.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import field
from itertools import accumulate
from typing import Any

import numpy as np
from lark import Token

from gcxform.syntax.grammar import rule_of, span_of
from gcxform.syntax.outlines import Outlines
from gcxform.syntax.tree import (
    BLANKS,
    CODES,
    COMPUTED,
    Block,
    Comment,
    Expression,
    Number,
    Statement,
    Word,
)
from gcxform.system.arrays import Floats, Ints
from gcxform.values import dataclass

Span = tuple[int, int]


@dataclass(frozen=True)
class Layout:
    """Slots of an outline; `edges` (slots, 4): for begin and end of each a mark and an offset.

    The mark is the last one that ends before, as an index from 1, and the offset counts from its
    end; mark 0 is the beginning of the line. `marks` (slots,) is the mark whose number the slot
    has, from 0, or -1, and `signs` (slots,) its sign. `slot_of` finds the slot of a piece of the
    block that has the tree. `operands` are the slots of the first numbers inside its expressions,
    those of words and then of assignments; the others follow in the order of the text.
    """

    edges: Ints
    marks: Ints
    signs: Floats
    slot_of: dict[Span, int] = field(hash=False)
    operands: tuple[int, ...]

    def __len__(self) -> int:
        return len(self.marks)

    def columns(self, found: Outlines, which: Ints, begin: Ints) -> tuple[Floats, Ints, Ints, Ints]:
        """Return value, decimals, start and end of the slots of lines of one outline, (n, slots).

        `which` (n,) are indices into `found`, `begin` (n,) the offsets of the lines.
        """
        count = int(found.count[which[0]])
        marks = found.first[which][:, None] + np.arange(count)
        ends = np.concatenate([begin[:, None], found.end[marks]], axis=1)
        start = ends[:, self.edges[:, 0]] + self.edges[:, 1]
        end = ends[:, self.edges[:, 2]] + self.edges[:, 3]
        value = np.full(start.shape, np.nan)
        decimals = np.full(start.shape, COMPUTED)
        has = np.flatnonzero(self.marks >= 0)
        if len(has):
            at = marks[:, self.marks[has]]
            value[:, has] = found.value[at] * self.signs[has]
            decimals[:, has] = found.decimals[at]
        return value, decimals, start, end


def layout_of(block: Block, marks: list[tuple[int, int, bool]]) -> Layout | None:
    """Return the layout of a block with marks (start, end, whether a comment); None: it has none.

    Offsets count from the beginning of the block.
    """
    if block.error is not None or not all(_is_plain(item) for item in block.items):
        return None
    words = [word.value for word in block.words if word.address not in CODES]
    comments = [item for item in block.items if isinstance(item, Comment)]
    statements = [item for item in block.items if isinstance(item, Statement)]
    trees = [value.tree for value in words if isinstance(value, Expression)]
    trees += [item.tree for item in statements]
    inside = [[span_of(token) for token in _numbers(tree)] for tree in trees]
    operands = [span for spans in inside for span in spans]
    if not _all_marked(block, marks, operands):
        return None
    spans = [(piece.start, piece.end) for piece in (*words, *comments)]
    spans += [*operands, *((item.start, item.end) for item in statements)]
    ends = [0, *(end for _, end, _ in marks)]
    edges = [(*_edge(ends, start), *_edge(ends, end)) for start, end in spans]
    number = {end: nth for nth, (_, end, comment) in enumerate(marks) if not comment}
    numbers = {(v.start, v.end) for v in words if isinstance(v, Number)} | set(operands)
    return Layout(
        np.array(edges, np.int64).reshape(-1, 4),
        np.array([number[s[1]] if s in numbers else -1 for s in spans], np.int64),
        np.array([-1.0 if block.text[s[0] : s[1]].startswith("-") else 1.0 for s in spans]),
        {span: slot for slot, span in enumerate(spans)},
        tuple(accumulate(map(len, inside[:-1]), initial=len(words) + len(comments))),
    )


def _is_plain(item: Any) -> bool:
    """Whether an item is nothing that a control would have to run, and no code that is computed."""
    if isinstance(item, Word) and item.address in CODES:
        return isinstance(item.value, Number)
    return not isinstance(item, Statement) or item.kind == "assignment"


def _numbers(node: Any) -> Iterator[Token]:
    """Yield the numbers of an expression that are not the name of a parameter."""
    if isinstance(node, Token):
        if node.type.rsplit("__", 1)[-1] == "NUMBER":
            yield node
        return
    children = node.children
    if rule_of(node) == "parameter" and isinstance(children[0], Token):
        return
    for child in children:
        yield from _numbers(child)


def _all_marked(block: Block, marks: list[tuple[int, int, bool]], operands: list[Span]) -> bool:
    """Whether the marks are the numbers and the comments of a block, all of them, and no more."""
    numbers = set(operands)
    for word in block.words:
        if isinstance(word.value, Number) and word.address not in CODES:
            text = word.value.text
            if text.translate(BLANKS) != text:
                return False
            signed = text[0] in "+-"
            numbers.add((word.value.start + signed, word.value.end))
    comments = {(item.start, item.end) for item in block.items if isinstance(item, Comment)}
    return numbers == {(a, b) for a, b, comment in marks if not comment} and comments == {
        (a, b) for a, b, comment in marks if comment
    }


def _edge(ends: list[int], at: int) -> Span:
    """Return the last mark that ends at or before a column, and how far behind it that is."""
    nth = max(n for n, end in enumerate(ends) if end <= at)
    return nth, at - ends[nth]
