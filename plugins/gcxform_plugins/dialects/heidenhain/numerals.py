"""Words with their numbers, as lines of Klartext have them."""

from __future__ import annotations

from decimal import Decimal

from gcxform_plugins.dialects.heidenhain.words import exact


def coded(letter: str, text: str) -> str:
    """Return a code with its number."""
    return f"{letter}{bare(text)}"


def bare(text: str) -> str:
    """Return a number without what it does not need."""
    return exact(Decimal(text))


def signed(value: Decimal) -> str:
    """Return a number with its sign."""
    return f"{'+' if value >= 0 else '-'}{exact(abs(value))}"


def worded(ends: dict[str, Decimal], step: str = "") -> str:
    """Return the words of axes, each behind a blank."""
    return "".join(f" {step}{axis}{signed(value)}" for axis, value in ends.items())
