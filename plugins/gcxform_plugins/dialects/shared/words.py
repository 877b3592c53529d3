"""What a block of words looks like to who writes it in a language."""

from __future__ import annotations

import re
from decimal import Decimal

COMMENT = re.compile(r"\([^()]*\)")
WORD = re.compile(r"([A-Z])([-+]?[0-9.]+)")


def number(text: str) -> str:
    """Return a number as it is written by hand: without zeros in front or behind."""
    return format(Decimal(text).normalize(), "f")


def text_of(value: Decimal) -> str:
    """Return a number as blocks have it: no exponent."""
    text = format(value, "f")
    text = text.rstrip("0").rstrip(".") if "." in text else text
    return "0" if text in ("-0", "") else text
