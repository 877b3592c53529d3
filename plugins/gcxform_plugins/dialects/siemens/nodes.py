"""Nodes of the trees of lines that compute: `siemens_computed.lark`."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from lark import Token, Tree

Node = Tree[Token]


def type_of(node: Node) -> str:
    """Return the type that a definition names."""
    tokens = (child for child in node.children if isinstance(child, Token))
    return next(str(token).upper() for token in tokens if token.type.endswith("TYPE"))


def rule_of(node: Any) -> str:
    """Return the rule of a node; nothing for a terminal."""
    return str(node.data).rsplit("__", 1)[-1] if isinstance(node, Tree) else ""


def span_of(node: Node) -> tuple[int, int]:
    """Return where a node stands in its line: columns from 0."""
    return node.meta.start_pos, node.meta.end_pos


def names_in(node: Any) -> Iterator[str]:
    """Yield the names of variables in an expression, in capitals."""
    if isinstance(node, Tree):
        if rule_of(node) == "variable":
            yield str(node.children[0]).upper()
        for child in node.children:
            yield from names_in(child)
