"""Numbers as the executed blocks write them."""

from __future__ import annotations

DECIMALS = 8
"""Of mm or inch: far below what any control resolves, and what is read as fast as any number."""


def decimal(value: float) -> str:
    """Return a number with a point and the decimals that it needs, never an exponent."""
    text = f"{value:.{DECIMALS}f}".rstrip("0")
    return text[1:] if text.startswith("-") and not text.strip("-0.") else text
