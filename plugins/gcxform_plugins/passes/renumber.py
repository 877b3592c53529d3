"""`renumber`: sequence numbers are given anew."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import gcxform as gx

JUMPS = {("M", number) for number in (96, 97, 98, 99, 198)} | {
    ("G", number) for number in (65, 66, 66.1)
}
CONTOURS = {("G", number) for number in (70, 71, 72, 73, 150)}
"""Cycles that cut the blocks between two sequence numbers: P and Q."""


@dataclass(frozen=True)
class Renumber(gx.TextPass):
    """Give every block that has words a new sequence number.

    A program that may jump to a sequence number is refused.
    """

    name = "renumber"
    start: Annotated[int, gx.Option("first number", at_least=1, at_most=99_999)] = 10
    step: Annotated[int, gx.Option("distance of numbers", at_least=1, at_most=1_000)] = 10
    last: Annotated[int, gx.Option("largest number; then it begins again", at_least=1)] = 99_999

    def refuse(self, block: gx.Block) -> str:
        """Return why the program's numbers cannot be changed."""
        for item in block.items:
            if not isinstance(item, gx.Word | gx.Comment) and hasattr(item, "tree"):
                return "blocks may be jumped to by their numbers"
            if isinstance(item, gx.Word) and _may_jump(item, block):
                return f"{block.text[item.start : item.end]} may refer to sequence numbers"
        return ""

    def counts(self, block: gx.Block) -> bool:
        """Count the blocks that get a number: not the program's own."""
        words = [item.address for item in block.items if isinstance(item, gx.Word)]
        return bool(words) and "O" not in words

    def edit(self, block: gx.Block, number: int) -> str | None:
        """Return the block with its new number."""
        if not self.counts(block):
            return block.text
        words = [item for item in block.items if isinstance(item, gx.Word)]
        first = words[0]
        count = (self.last - self.start) // self.step + 1
        new = f"N{self.start + self.step * (number % count)}"
        if first.address == "N":
            return block.text[: first.start] + new + block.text[first.end :]
        gap = " " if len(words) > 1 and words[1].start > words[0].end else ""
        # Before a comment too: LinuxCNC takes a sequence number only at the head of a block.
        head = next(i for i in block.items if isinstance(i, gx.Word | gx.Comment)).start
        return block.text[:head] + new + gap + block.text[head:]


def _may_jump(word: gx.Word, block: gx.Block) -> bool:
    if not isinstance(word.value, gx.Number):
        return False
    code, letters = (word.address, word.value.value), {w.address for w in block.words}
    drills = code == ("G", 73) and not {"P", "Q"} <= letters
    return code in JUMPS or (code in CONTOURS and bool(letters & {"P", "Q"}) and not drills)
