"""A text split at its numbers, many lines at once: bytes are mapped and runs of them closed up.

An expression looks at each number; here a line of plain words costs half of that. Where signs,
points and digits stand together otherwise than in plain numbers the expression does it.
"""

from __future__ import annotations

import re

NUMBER = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)")
"""A number without an exponent, of any sign."""
SPLIT = re.compile(f"({NUMBER.pattern})").split
MARKS = "0123456789.+-"
BETWEEN = str.maketrans({chr(code): " " for code in range(128) if chr(code) not in MARKS})
DIGITS = str.maketrans(dict.fromkeys("123456789", "0"))
CLOSED = ("0" * 8, "0" * 4, "00", "00")
TWICE = (".0.", "..", "++", "+-", "-+", "--")
"""What plain numbers have not: two points or two signs in a row."""
PLAIN = ("0.0", "0.", ".0", "+0", "-0")
ODD = ("00", ".", "+0", "-0", "0+", "0-")
"""What is left of numbers that are not plain, once plain ones have become a 0 each."""


def split_at_numbers(text: str, slot: str) -> tuple[str, list[str]]:
    """Return a text with a slot in the place of each NUMBER, and the numbers."""
    shape = _shape(text) if text.isascii() else None
    if shape is not None:
        numbers = text.translate(BETWEEN).split()
        if len(numbers) == shape.count("0"):
            return shape.replace("0", slot), numbers
    pieces = SPLIT(text)
    return slot.join(pieces[::2]), pieces[1::2]


def _shape(text: str) -> str | None:
    """Return a text with 0 for each number; None where not all of them are plain."""
    shape = text.translate(DIGITS)
    for run in CLOSED:
        shape = shape.replace(run, "0")
    if any(odd in shape for odd in TWICE):
        return None
    for form in PLAIN:
        shape = shape.replace(form, "0")
    return None if any(odd in shape for odd in ODD) else shape
