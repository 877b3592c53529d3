"""From a block's text to its tree, by the dialect's grammar: the only definition of a language.

Grammars are read from packages; a grammar anywhere may build on ours with an absolute `%import
iso (...)`.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache, lru_cache
from typing import Any

from lark import Lark, Token, Tree
from lark.exceptions import UnexpectedInput

from gcxform.syntax import grammar_cache as kept
from gcxform.syntax.tree import (
    Block,
    Comment,
    Expression,
    Item,
    Mark,
    Number,
    Statement,
    Word,
)
from gcxform.system.limits import how_to_raise, limits

LATELY = 8192  # blocks whose trees are kept
LONE_LETTER = re.compile(r"(?<![A-Za-z])[A-Za-z][ \t]*\Z")  # an address without its number
ABOVE = 3  # levels of a tree above the first of an expression: start, word
MARKS = frozenset(
    {
        *("block_delete", "block_end", "percent", "program_id", "program_name", "filler", "label"),
        *("output", "title", "aside"),
    }
)


class Grammar:
    """One dialect's grammar: `parse` turns the text of a block into its tree.

    A line is read by the flow, the reader and the proof: its tree, which nobody changes, is kept
    for a while.
    """

    def __init__(self, package: str, name: str) -> None:
        self.name = name
        self._lark = kept.grammar(package, name)
        self._lately = lru_cache(LATELY)(self._parsed)

    def parse(self, text: str) -> Block:
        """Return the tree of one block; what the grammar does not accept becomes `Block.error`."""
        return self._lately(text, limits().nesting)

    def _parsed(self, text: str, nesting: int) -> Block:
        """Parse a block; the limit of levels, which is in force, decides as well."""
        try:
            tree = parsed(self._lark, text)
        except UnexpectedInput as error:
            return Block(text, (), refusal_of(error, text))
        return Block(text, tuple(item for child in tree.children for item in _items(child, text)))


@cache
def load(package: str, name: str) -> Grammar:
    """Return a grammar, built once."""
    return Grammar(package, name)


class TooDeepError(UnexpectedInput):
    """A text whose tree has more levels than anybody should follow one in the other."""

    def __init__(self, node: Any) -> None:
        super().__init__("too deep")
        self.at = int(span_of(node)[0])


def parsed(grammar: Lark, text: str) -> Tree[Token]:
    """Return the tree of a text, no deeper than the limit is. Raises UnexpectedInput.

    What reads the tree later calls itself for every level: this is why it may.
    """
    tree = grammar.parse(text)
    most = limits().nesting
    if len(text) > most:  # there are no more levels than characters
        level: list[Any] = [tree]
        for _ in range(most + ABOVE):
            level = [child for node in level for child in getattr(node, "children", ())]
        if level:
            raise TooDeepError(level[0])
    return tree


def refusal_of(error: UnexpectedInput, text: str) -> tuple[int, str]:
    """Return the column and a sentence for a text that the grammar does not accept."""
    at = error.pos_in_stream
    if isinstance(error, TooDeepError):
        message = f"an expression has more than {limits().nesting} levels here"
        return error.at + 1, f"{message}; {how_to_raise('nesting')}"
    if at is None or at < 0 or at >= len(text):
        return len(text) + 1, "the block ends in the middle of a word"
    lone = LONE_LETTER.search(text, 0, at) if text[at] in ";(" else None
    if lone is not None:
        return lone.start() + 1, f"{lone[0].strip()} has no number"
    if text[at] == "(":
        return at + 1, "this comment is not closed, or has a bracket inside"
    return at + 1, f"{text[at]!r} does not fit here"


def rule_of(node: Tree[Token]) -> str:
    """Return a rule's own name: lark puts the importing grammar's name in front."""
    return str(node.data).rsplit("__", 1)[-1]


def span_of(node: Any) -> tuple[int, int]:
    """Return where a node of lark's stands in its block: columns from 0."""
    if isinstance(node, Token):
        assert node.start_pos is not None
        return node.start_pos, node.start_pos + len(node)  # a pickled token has lost its end
    return node.meta.start_pos, node.meta.end_pos


def _items(node: Any, text: str) -> Iterator[Item]:
    """Yield the items a child of the start rule stands for: comments behind a call by themselves.

    Only the grammar of a call has comments inside: between its values.
    """
    behind: list[Any] = []
    if rule_of(node) == "flow":
        while is_comment(node.children[-1]):
            behind.insert(0, node.children.pop())
    if not behind:
        yield _item(node, text)
        return
    yield Statement(span_of(node)[0], span_of(node.children[-1])[1], rule_of(node), node)
    yield from (_item(each, text) for each in behind)


def is_comment(node: Any) -> bool:
    """Whether a node is a comment."""
    return isinstance(node, Tree) and rule_of(node) == "comment"


def _item(node: Any, text: str) -> Item:
    """Return the item a child of the start rule stands for."""
    start, end = span_of(node)
    rule = rule_of(node)
    if rule == "word":
        address, value = node.children
        return Word(start, end, str(address).upper(), _value(value, text))
    if rule == "comma_word":
        address, value = node.children
        return Word(start, end, f",{address}".upper(), _value(value, text))
    if rule == "comment":
        return Comment(start, end)
    if rule in MARKS:
        return Mark(start, end, rule)
    return Statement(start, end, rule, node)


def _value(node: Any, text: str) -> Number | Expression:
    """Return a literal, also one whose sign the grammar reads by itself, or an expression."""
    start, end = span_of(node)
    if isinstance(node, Token):
        return Number(start, end, text[start:end])
    if rule_of(node) == "negated" and isinstance(node.children[1], Token):
        return Number(start, end, text[start:end])
    return Expression(start, end, node)
