"""Where axes stand in the words of a Fagor program: what `X10I Y5` and polar words count from."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from decimal import Decimal

import gcxform as gx
from gcxform_plugins.dialects.fagor import tables as tables

QUIET = tables.PLAIN | {*tables.CORNERS, "G4", "G6", "G30", "G60", "G80", "G90", "G91"}
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
    """The coordinates of a program, as it writes them.

    They are sums of what is written, in decimals, so that no digit is lost. `at` has those that are
    known behind what was followed; `passed` are blocks behind that, as ranges of plain lines or as
    items; `motion` is the code in force.
    """

    def __init__(self, translator: gx.Translator) -> None:
        self.translator = translator
        self.at: dict[str, Decimal] = {}
        self.steps, self.motion = False, ""
        self.passed: list[range | Sequence[gx.Item]] = []
        self.next = 0

    def arrive(self) -> None:
        """Note the plain lines before the one that is translated."""
        line = self.translator.line
        if line > self.next:
            self.passed.append(range(self.next, line))
        self.next = line + 1

    def jumped(self) -> None:
        """Note that the line behind this one is another."""
        self.next = self.translator.at

    def note(self, items: Sequence[gx.Item]) -> None:
        """Note a block that was executed."""
        self.passed.append(items)

    def lose(self) -> None:
        """Forget all that is known."""
        self.follow()
        self.at, self.motion = {}, ""

    def of(self, items: Sequence[gx.Item], block: Sequence[gx.Item]) -> dict[str, str]:
        """Return the words to which incremental ones lead, by axis; nothing where one is unknown.

        `block` are all items of the block.
        """
        self.follow()
        if not quiet(block) or not {item.name for item in items} <= self.at.keys():
            return {}
        found = {item.name: self.at[item.name] + Decimal(item.numbers[0]) for item in items}
        return {axis: f"{axis}{place:f}" for axis, place in found.items()}

    def follow(self) -> None:
        """Follow what was executed since."""
        for passed in self.passed:
            for items in self._blocks(passed):
                self._take(items)
        self.passed = []

    def _blocks(self, passed: range | Sequence[gx.Item]) -> Iterator[Sequence[gx.Item]]:
        if isinstance(passed, range):
            yield from (self.translator.items(line) for line in passed)
        else:
            yield passed

    def _take(self, items: Sequence[gx.Item]) -> None:
        codes = {code_of(item) for item in items if item.kind == "code"}
        if codes & {"G90", "G91"}:
            self.steps = "G91" in codes
        moves = [code for code in ("G0", "G1", "G2", "G3") if code in codes]
        self.motion = moves[0] if moves else self.motion
        told = set()
        for item in items:
            if item.kind not in ("word", "incremental") or item.name not in tables.AXES:
                continue
            value = Decimal(item.numbers[0])
            if item.kind == "word" and not self.steps:
                self.at[item.name] = value
                told.add(item.name)
            elif item.name in self.at:
                self.at[item.name] += value
        if not quiet(items):
            others = [item for item in items if code_of(item) not in tables.WORK]
            stays = told if quiet(others) else set()
            self.at = {axis: self.at[axis] for axis in self.at.keys() & stays}


def quiet(items: Sequence[gx.Item]) -> bool:
    """Whether the coordinates before a line are those behind it, but for what it moves."""
    codes = {code_of(item) for item in items if item.kind == "code"}
    words = {item.name for item in items if item.kind in ("word", "incremental")}
    kinds = {item.kind for item in items if item.name.split(" ")[0] not in tables.INERT}
    return kinds <= KINDS and codes <= QUIET and words <= tables.PLAIN_WORDS | {"N"}
