"""What the tests share that look through the syntax trees of every file."""

from __future__ import annotations

import ast
from collections.abc import Iterator


def walk(tree: ast.AST) -> Iterator[ast.AST]:
    """Yield what `ast.walk` yields, in its order and three times as fast."""
    waiting = [tree]
    for node in waiting:  # it grows
        yield node
        for value in vars(node).values():
            if isinstance(value, list):
                waiting += [each for each in value if isinstance(each, ast.AST)]
            elif isinstance(value, ast.AST):
                waiting.append(value)


def statements(tree: ast.AST) -> Iterator[ast.AST]:
    """Yield a tree and the statements within it, without what these are made of."""
    waiting = [tree]
    for node in waiting:
        yield node
        for name in ("body", "orelse", "finalbody", "handlers", "cases"):
            waiting += getattr(node, name, ())
