"""What the annotation of an option says beyond its type: see `gcxform.contract.options`."""

from __future__ import annotations

from gcxform.values import dataclass


@dataclass(frozen=True)
class Option:
    """What an option says beyond its type: help, and the range of its value in its base unit.

    `example` is a value as it is written, for the help of a command.
    """

    help: str = ""
    above: float | None = None
    at_least: float | None = None
    at_most: float | None = None
    example: str = ""

    def admits(self, value: float) -> bool:
        """Return whether a value is in the range."""
        above = self.above is None or value > self.above
        at_least = self.at_least is None or value >= self.at_least
        return above and at_least and (self.at_most is None or value <= self.at_most)

    def range_text(self, unit: str) -> str:
        """Return the range in words, each bound with its unit."""
        words = {"above": self.above, "at least": self.at_least, "at most": self.at_most}
        return " and ".join(f"{word} {b:g}{unit}" for word, b in words.items() if b is not None)
