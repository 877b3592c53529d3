"""Null: what a variable of macro B is worth that has no value.

It counts as 0 where it is computed with or compared by size, it makes the word vanish whose value
it is, and it is copied as it is (Mitsubishi M700V manual pp. 308 to 331, NCT 99M manual p. 173,
which are of the same language). Where no manual says whether null stays null, it is `MAYBE`: 0 or
null, which is refused as soon as that makes a difference.
"""

from __future__ import annotations

from typing import Final


class Null(float):
    """Null, which computes as 0; `certain`: it is no 0."""

    __slots__ = ("certain",)

    def __new__(cls, certain: bool) -> Null:
        """Return one of the two that there are."""
        found = super().__new__(cls, 0.0)
        found.certain = certain
        return found

    certain: bool


NULL: Final = Null(True)
MAYBE: Final = Null(False)
"""Either 0 or null."""


def as_argument(value: float) -> float:
    """Return what a value is worth behind brackets, or as the argument of a call."""
    return MAYBE if isinstance(value, Null) else value
