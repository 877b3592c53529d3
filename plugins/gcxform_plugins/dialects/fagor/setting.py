"""What a line of a Fagor sets besides its blocks: it is said again where these are written out.

Parameters from P100 on, and variables, are those of all programs; a subroutine may have P0 to P99
of its own.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

from lark import Tree

import gcxform as gx
from gcxform_plugins.dialects.fagor.computing import LOCALS, rule_of, written
from gcxform_plugins.dialects.fagor.places import code_of
from gcxform_plugins.dialects.fagor.spelling import HEAD
from gcxform_plugins.dialects.fagor.structure import code

PARAMETER = re.compile(r"(?<![A-Z0-9_.])P[ \t]*([0-9]*)", re.IGNORECASE)
SIGNED = re.compile(r"([-+]?)[ \t]*([0-9]+(?:\.[0-9]*)?|\.[0-9]+)")
STAND = frozenset(("G30", "G98", "G99"))
"""Codes of which no block says anything, and that lines behind them hang on."""
Made = Mapping[str, float | None]


def said_of(
    items: Sequence[gx.Item], nodes: Sequence[Any], text: str, made: Made | None
) -> list[str] | None:
    """Return what a line sets, as lines; None where it cannot be said.

    `nodes` are those of a line that computes. `made` is what it sets where only a subroutine can
    say that by its parameters.
    """
    codes = {code_of(item) for item in items} & STAND
    said = [_part(text, node) for node in nodes if rule_of(node) == "assignment"]
    if "G30" in codes:
        alone = not said and not (made is not None and is_local(code(text)))
        return [_without_head(code(text))] if alone else None
    if made is not None and any(map(is_local, said)):
        found = [(name, _short(value)) for name, value in made.items() if not is_local(name)]
        if not all(short for _, short in found):
            return None
        said = [f"{name}={short}" for name, short in found]
    return [*sorted(codes), *([" ".join(said)] if said else [])]


def counted(head: Any, text: str, begins: bool, shared: bool) -> list[str] | None:
    """Return how $FOR counts, where it `begins` or at its end.

    None where only a subroutine can say it; what it counts in for itself nobody else reads.
    """
    _, target, _, first, _, step = head.children
    name, by = _part(text, target), _part(text, first if begins else step)
    if not shared and is_local(name):
        return []
    if not shared and is_local(by):
        return None
    if begins:
        return [f"{name}={by}"]
    number = SIGNED.fullmatch(by)
    return [f"{name}={name}{number[1] or '+'}{number[2]}" if number else f"{name}={name}+[{by}]"]


def is_local(text: str) -> bool:
    """Whether a text names, or may name, what a subroutine may have of its own."""
    numbers = (found[1] for found in PARAMETER.finditer(text))
    return any(not number or int(number) in LOCALS for number in numbers)


def _without_head(text: str) -> str:
    head = HEAD.match(text)
    return text[head.end() if head else 0 :].strip()


def _short(value: float | None) -> str:
    """Return a value as a number; nothing where that would be another one, or is not known."""
    text = "" if value is None else written(value)
    return text if text and float(text) == value else ""


def _part(text: str, node: Any) -> str:
    if not isinstance(node, Tree):
        return str(node)
    return code(text[node.meta.start_pos : node.meta.end_pos]).strip()
