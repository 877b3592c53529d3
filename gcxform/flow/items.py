"""The items of a line in a language of its own, as its grammar takes them apart."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

from lark import Token, Tree

from gcxform.syntax.grammar import rule_of, span_of
from gcxform.values import dataclass

NUMBER = "NUMBER"
"""The terminal of a grammar that stands for numbers."""


class Item(NamedTuple):
    """A part of a statement, as the grammar names it.

    `kind` is the rule, `names` are its terminals but for numbers, in capitals, `numbers` the
    numbers as written, without blanks; `place` are columns of its line, from 0.
    """

    kind: str
    names: tuple[str, ...]
    numbers: tuple[str, ...]
    place: tuple[int, int]

    @property
    def name(self) -> str:
        """The first name; nothing where there is none."""
        return self.names[0] if self.names else ""

    @property
    def value(self) -> float:
        """The only number. Raises ValueError where there is none, or more than one."""
        (number,) = self.numbers
        return float(number)


new_item = tuple.__new__
"""Makes an item as its class would, which takes twice as long."""


@dataclass(frozen=True, slots=True)
class Part:
    """An item of a shape: its numbers are slots."""

    kind: str
    names: tuple[str, ...]
    slots: tuple[int, ...]
    place: tuple[int, int]

    def item(self, numbers: Sequence[str]) -> Item:
        """Return the item with its numbers; most have one, and there are many lines."""
        slots = self.slots
        if not slots:
            own: tuple[str, ...] = ()
        elif len(slots) == 1:
            own = (numbers[slots[0]],)
        else:
            own = tuple([numbers[slot] for slot in slots])
        return new_item(Item, (self.kind, self.names, own, self.place))


def part_of(node: Any, numbers: list[Token]) -> Part:
    """Return a child of the start rule; its numbers are put behind those there are."""
    tokens = [node] if isinstance(node, Token) else [*_tokens(node)]
    names, slots = [], []
    for token in tokens:
        if token.type.rsplit("__", 1)[-1] == NUMBER:
            slots.append(len(numbers))
            numbers.append(token)
        else:
            names.append(str(token).upper())
    kind = node.type.lower() if isinstance(node, Token) else rule_of(node)
    return Part(kind, tuple(names), tuple(slots), span_of(node))


def _tokens(tree: Tree[Token]) -> Iterator[Token]:
    """Yield the terminals below a node, in order."""
    for child in tree.children:
        if isinstance(child, Token):
            yield child
        else:
            yield from _tokens(child)
