"""Where a word counts from that is incremental beside words that are not: `X10I Y5`."""

from __future__ import annotations

from collections.abc import Sequence
from decimal import Decimal

import gcxform as gx
from gcxform_plugins.dialects.fagor import tables as tables

QUIET = tables.PLAIN | {*tables.CORNERS, "G4", "G6", "G60", "G80", "G90"}
QUIET |= {f"M{code}" for code in (0, 1, 3, 4, 5, 7, 8, 9)}
"""Codes over which the coordinates of an axis stay what they are."""
KINDS = {"code", "word", "incremental", "comment", "label", "colon"}


def code_of(item: gx.Item) -> str:
    """Return `G1` for `G01`, nothing for what is no code."""
    if item.kind not in ("code", "numbered"):
        return ""
    name = item.name
    return f"{name[0]}{float(name[1:]):g}"


class Places:
    """The coordinates of a program in G90, as it writes them.

    They are sums of what is written, in decimals, so that no digit is lost.
    """

    def __init__(self, translator: gx.Translator) -> None:
        self.translator = translator
        self.known: dict[str, tuple[int, Decimal]] = {}

    def of(self, items: Sequence[gx.Item]) -> dict[str, str]:
        """Return the words to which incremental ones lead, by axis; nothing where none is known."""
        found: dict[str, Decimal] = {}
        if not _quiet(self.translator.items(self.translator.line)):
            return {}
        for item in items:
            before = self._before(item)
            if before is None:
                return {}
            found[item.name] = before + Decimal(item.numbers[0])
        for axis, place in found.items():
            self.known[axis] = self.translator.line, place
        return {axis: f"{axis}{place:f}" for axis, place in found.items()}

    def _before(self, item: gx.Item) -> Decimal | None:
        """Return the coordinate of an axis before the line that is translated, None if unknown."""
        way, axis = Decimal(0), item.name
        known_at, known = self.known.get(axis, (-1, Decimal(0)))
        for line in range(self.translator.line - 1, -1, -1):
            items = self.translator.items(line)
            if line == known_at:
                return known + way
            if not _quiet(items):
                break
            for other in items:
                if other.name == axis and other.kind in ("word", "incremental"):
                    way += Decimal(other.numbers[0])
                    if other.kind == "word":
                        return way
            if any(code_of(other) == "G90" for other in items):
                break
        return None


def _quiet(items: Sequence[gx.Item]) -> bool:
    """Whether the coordinates before a line are those behind it, but for what it moves."""
    codes = {code_of(item) for item in items if item.kind == "code"}
    words = {item.name for item in items if item.kind in ("word", "incremental")}
    kinds = {item.kind for item in items if item.name.split(" ")[0] not in tables.INERT}
    return kinds <= KINDS and codes <= QUIET and words <= tables.PLAIN_WORDS | {"N"}
