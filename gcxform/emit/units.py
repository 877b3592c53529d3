"""What of a program can be written out by itself: a loop, a subprogram, a line."""

from __future__ import annotations

from gcxform.values import dataclass


@dataclass(frozen=True, slots=True)
class Unit:
    """What can be written out by itself: first and last line, and the name of a subprogram."""

    first: int
    last: int
    name: str = ""

    @property
    def lines(self) -> range:
        """Its lines."""
        return range(self.first, self.last + 1)

    def has(self, line: int) -> bool:
        """Whether a line stands in it."""
        return self.first <= line <= self.last
