"""Numbers as the executed blocks write them."""

from __future__ import annotations

EXACT_DECIMALS, MOST_DECIMALS = 8, 15


def decimal(value: float) -> str:
    """Return a number with a point and the decimals that it needs, never an exponent."""
    text = f"{value:.{EXACT_DECIMALS}f}"
    if float(text) != value:
        text = f"{value:.{MOST_DECIMALS}f}"
    text = text.rstrip("0")
    return text[1:] if text.startswith("-") and not text.strip("-0.") else text
