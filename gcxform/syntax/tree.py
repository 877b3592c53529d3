"""The tree of one block: what was written, as nodes that hold spans into the block's text.

Nodes carry no meaning and no copies: a block prints back from its spans, byte for byte. Text is
Latin-1 decoded, so every byte is one character.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from gcxform.values import dataclass

BLANKS = str.maketrans("", "", " \t")
CODES = frozenset("GMO")
"""Addresses whose number is a code: it stays in the shape of a block."""
COMPUTED = -2
"""Stands for the decimals of a value that is computed; -1 is a number without a point."""


@dataclass(frozen=True, slots=True)
class Number:
    """A literal number; `text` as written, blanks inside included."""

    start: int
    end: int
    text: str

    @property
    def value(self) -> float:
        """The number's value."""
        return float(self.text.translate(BLANKS))

    @property
    def decimals(self) -> int:
        """How many decimals were written; -1 when there is no point."""
        text = self.text.translate(BLANKS)
        return len(text) - text.index(".") - 1 if "." in text else -1


@dataclass(frozen=True, slots=True)
class Expression:
    """A value that has to be computed: parameters, operators, functions. `tree` is lark's.

    It fills a slot as a number does; its value is not known before the program is executed.
    """

    start: int
    end: int
    tree: Any

    @property
    def value(self) -> float:
        """No value yet."""
        return float("nan")

    @property
    def decimals(self) -> int:
        """No decimals, and no missing point either."""
        return COMPUTED


@dataclass(frozen=True, slots=True)
class Word:
    """An address letter (upper case), of some words with a comma before it, and its value."""

    start: int
    end: int
    address: str
    value: Number | Expression


@dataclass(frozen=True, slots=True)
class Comment:
    """A comment with its brackets or its semicolon."""

    start: int
    end: int


@dataclass(frozen=True, slots=True)
class Mark:
    """A sign of the program frame: `block_delete`, `percent`, `program_id`, `filler` ..."""

    start: int
    end: int
    kind: str


@dataclass(frozen=True, slots=True)
class Statement:
    """An assignment, a flow word, a call: `kind` is the grammar's rule, `tree` is lark's."""

    start: int
    end: int
    kind: str
    tree: Any


Item = Word | Comment | Mark | Statement


@dataclass(frozen=True, slots=True)
class Block:
    """One block: its text without the line end, its items in order.

    `error` holds (column from 1, message) when the grammar does not accept the text; then there
    are no items, and the block can only be copied.
    """

    text: str
    items: tuple[Item, ...]
    error: tuple[int, str] | None = None

    def __hash__(self) -> int:
        """Return the hash of the text: few blocks of one text differ, and a tree is long."""
        return hash(self.text)

    @property
    def words(self) -> Iterator[Word]:
        """The address words in order."""
        return (item for item in self.items if isinstance(item, Word))


def print_block(block: Block) -> str:
    """Return the block's text, put together from the items' spans and the gaps between them."""
    parts, at = [], 0
    for item in block.items:
        parts += [block.text[at : item.start], block.text[item.start : item.end]]
        at = item.end
    return "".join(parts) + block.text[at:]
