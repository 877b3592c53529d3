"""Numbers and assignments as the executed blocks write them."""

from __future__ import annotations

from decimal import Decimal

from gcxform.dialect.arithmetic import Arithmetic, Key
from gcxform.dialect.null import Null
from gcxform.modal.expressions.value import key_set, written
from gcxform.syntax.tree import Statement

DECIMALS = 8
"""Of mm or inch: far below what any control resolves, and what is read as fast as any number."""


def decimal(value: float) -> str:
    """Return a number with a point and the decimals that it needs, never an exponent."""
    text = f"{value:.{DECIMALS}f}".rstrip("0")
    return text[1:] if text.startswith("-") and not text.strip("-0.") else text


def assignment(key: Key, value: float, arithmetic: Arithmetic) -> str:
    """Return an assignment of a number."""
    return f"{written(key)}={number(value, arithmetic)}"


def number(value: float, arithmetic: Arithmetic) -> str:
    """Return a number in all the digits that the control takes, or null."""
    if isinstance(value, Null):
        return "#0"
    digits = repr(value) if arithmetic.digits >= 17 else f"{value:.{arithmetic.digits}g}"
    text = f"{Decimal(digits):f}"
    whole, _, rest = text.partition(".")
    return f"{whole}.{rest.rstrip('0')}"


def as_named(statement: Statement, key: Key, text: str) -> str:
    """Return an assignment to a parameter by the name that the statement has for it."""
    name = key_set(statement)
    known = name in (None, key) or not text.startswith(written(key))
    return text if known or name is None else written(name) + text.removeprefix(written(key))
