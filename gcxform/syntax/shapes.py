"""The shapes met so far, each with the tree of its first line.

A shape is what a line looks like when its numbers are taken out (see `scan`). Its tree has slots
in place of the numbers: the k-th number word that is not a code is slot k. A line with comments or
expressions has the shape of its outline, and more slots (`layout.py`). A line that lark read by
itself is a shape of its own, whose numbers come from the tree.

A number that is a code stays in the shape: `M6` and `M8` are different lines to the table of
meanings, as they are to the control.
"""

from __future__ import annotations

from dataclasses import field, replace
from itertools import repeat

import numpy as np

from gcxform.syntax.grammar import Grammar
from gcxform.syntax.layout import Layout, layout_of
from gcxform.syntax.outlines import Comments, Outlines
from gcxform.syntax.tree import CODES, Block, Expression, Number, Word
from gcxform.system.arrays import Floats, Ints
from gcxform.values import dataclass

NumberColumns = tuple[Ints, Floats, Ints, Ints, Ints]

OWN = b"\0"  # first byte of the key of a line read by itself: no plain line has it


def slots_of(block: Block) -> list[Number | Expression]:
    """Return the values of a block that vary within its shape, in order."""
    return [word.value for word in block.words if word.address not in CODES]


@dataclass(frozen=True, slots=True)
class Shape:
    """A tree and the values in its slots; `own`: it stands for one text only.

    `layout` is that of an outline: its slots begin with these. Shapes of equal trees are equal.
    """

    block: Block
    slots: tuple[Number | Expression, ...] = field(compare=False)
    own: bool = field(compare=False)
    layout: Layout | None = field(default=None, compare=False)


class ShapeTable:
    """Shapes by key; an index, once given, stays. Shape 0 is that of an empty line.

    `comments` says which comments are no more than text; without it no line has an outline.
    """

    def __init__(self, grammar: Grammar, comments: Comments | None = None) -> None:
        self.grammar = grammar
        self.comments = comments
        self.shapes: list[Shape] = []
        self._index: dict[bytes, int] = {}
        self._numbers: list[int] = []
        self._slot_counts: Ints = np.empty(0, np.int64)
        self._add(b"", b"")

    def __len__(self) -> int:
        return len(self.shapes)

    def look_up(self, keys: list[bytes], text: bytes, start: Ints, end: Ints) -> Ints:
        """Return the shape of each line; `keys` are the reduced lines, new ones are parsed."""
        known = self._index
        shape = np.fromiter(map(known.get, keys, repeat(-1)), np.int64, len(keys))
        for line in np.flatnonzero(shape < 0).tolist():
            key = keys[line]
            if key not in known:
                self._add(key, text[int(start[line]) : int(end[line])])
            shape[line] = known[key]
        return shape

    def outlined(self, found: Outlines, text: bytes, start: Ints, end: Ints) -> Ints:
        """Return the shape of lines that have an outline, -1 for those that lark has to read."""
        known = self._index
        shape = np.fromiter(map(known.get, found.keys, repeat(-2)), np.int64, len(found.keys))
        for nth in np.flatnonzero(shape == -2).tolist():
            key, line = found.keys[nth], int(found.lines[nth])
            if key not in known:
                here = text[int(start[line]) : int(end[line])]
                known[key] = self._define(found, nth, here, int(start[line]))
            shape[nth] = known[key]
        return shape

    def _define(self, found: Outlines, nth: int, text: bytes, begin: int) -> int:
        """Return the new shape of an outline, of which this is the first line; -1: it is none."""
        block = self.grammar.parse(text.decode("latin-1"))
        marks = slice(int(found.first[nth]), int(found.first[nth] + found.count[nth]))
        spans = zip(found.start[marks], found.end[marks], found.comment[marks], strict=True)
        layout = layout_of(block, [(int(a) - begin, int(b) - begin, bool(c)) for a, b, c in spans])
        if layout is None:
            return -1
        self.shapes.append(Shape(block, tuple(slots_of(block)), False, layout))
        self._numbers.append(len(layout))
        return len(self.shapes) - 1

    def take_over(self, shapes: list[Shape]) -> None:
        """Add the shapes that another table has met next; lines cannot be looked up here then."""
        self.shapes += shapes

    def slot_counts(self) -> Ints:
        """Return how many numbers the lines of each shape have, also of those not understood."""
        if len(self._slot_counts) < len(self.shapes):
            self._slot_counts = np.array(self._numbers, np.int64)
        return self._slot_counts

    def _add(self, key: bytes, text: bytes) -> int:
        block = self.grammar.parse(text.decode("latin-1"))
        shape = Shape(block, tuple(slots_of(block)), key.startswith(OWN))
        self.shapes.append(shape)
        self._numbers.append(len(shape.slots) if shape.own else key.count(b"#"))
        self._index[key] = len(self.shapes) - 1
        return len(self.shapes) - 1

    def append_own(
        self, shape: Ints, own: Ints, columns: NumberColumns, start: Ints
    ) -> NumberColumns:
        """Return the number columns with those of the lines read by themselves at the end."""
        first, value, decimals, number_start, number_end = columns
        more: list[tuple[float, int, int, int]] = []
        for line in own.tolist():
            first[line] = len(value) + len(more)
            base = int(start[line])
            more += [
                (n.value, n.decimals, base + n.start, base + n.end)
                for n in self.shapes[int(shape[line])].slots
            ]
        if not more:
            return columns
        extra = list(zip(*more, strict=True))
        return (
            first,
            np.append(value, np.array(extra[0], np.float64)),
            np.append(decimals, np.array(extra[1], np.int64)),
            np.append(number_start, np.array(extra[2], np.int64)),
            np.append(number_end, np.array(extra[3], np.int64)),
        )

    def append_outlined(
        self, shape: Ints, found: Outlines, columns: NumberColumns, start: Ints
    ) -> NumberColumns:
        """Return the number columns with those of the lines of outlines at the end.

        `shape` (n,) are those of the lines found, -1 for those that lark has read.
        """
        first, *numbers = columns
        parts: list[list[np.ndarray]] = [[column] for column in numbers]
        size = len(numbers[0])
        order = np.argsort(shape, kind="stable")
        order = order[shape[order] >= 0]
        edges = np.flatnonzero(np.diff(shape[order])) + 1
        for which in np.split(order, edges) if len(order) else ():
            layout = self.shapes[int(shape[which[0]])].layout
            assert layout is not None
            lines = found.lines[which]
            first[lines] = size + np.arange(len(which)) * len(layout)
            size += len(which) * len(layout)
            for part, column in zip(parts, layout.columns(found, which, start[lines]), strict=True):
                part.append(column.ravel())
        value, decimals, begin, end = (np.concatenate(part) for part in parts)
        return first, value, decimals, begin, end


def instantiate(shape: Shape, text: str, spans: list[tuple[int, int]]) -> Block:
    """Return the tree of a line of this shape; `spans` are its slots' offsets in the line."""
    if shape.own:
        return shape.block
    edges = [(0, 0)]
    for slot, (start, end) in zip(shape.slots, spans, strict=True):
        edges += [(slot.start, start), (slot.end, end)]

    def moved(at: int) -> int:
        before = max(edge for edge in edges if edge[0] <= at)
        return at - before[0] + before[1]

    values = {
        slot: Number(start, end, text[start:end])
        for slot, (start, end) in zip(shape.slots, spans, strict=True)
    }
    items = []
    for item in shape.block.items:
        item = replace(item, start=moved(item.start), end=moved(item.end))
        if isinstance(item, Word) and isinstance(item.value, Number):
            old = item.value
            new = values.get(old) or replace(old, start=moved(old.start), end=moved(old.end))
            item = replace(item, value=new)
        items.append(item)
    error = shape.block.error
    moved_error = (moved(error[0] - 1) + 1, error[1]) if error else None
    return Block(text, tuple(items), moved_error)
