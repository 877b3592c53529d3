"""`renumber`: sequence numbers are given anew, and what jumps to them names the new ones.

A program with jumps is seen as a whole. GOTO and the P of M97 name a line of their own program by
its number, which is rewritten. What is computed is refused, and so is M99 P, which may lead into
the program that calls, a call of a program of another file that may come back so, and what reads
the number that is executed (#4014, #4114). Two lines of one number are refused where one is named.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import accumulate
from typing import Annotated, Any

import gcxform as gx

CALLS = frozenset({("M", 98), ("M", 198)})
LEAVES = frozenset({("M", 96), ("M", 99)})
OWN_LINES = ("M", 97)
WITH_VALUES = frozenset({("G", 65), ("G", 66), ("G", 66.1)})
CONTOURS = {("G", number) for number in (70, 71, 72, 73, 150)}
"""Cycles that cut the blocks between two sequence numbers: P and Q."""
JUMPS = frozenset({"goto", "if_goto"})
PACKED = 10_000
EXECUTED_NUMBER = ("4014", "4114")
Span = tuple[int, int]


@dataclass(frozen=True)
class Renumber(gx.TextPass):
    """Give every block that has words a new sequence number, also where jumps name it.

    A program that may jump to a number that is computed is refused.
    """

    name = "renumber"
    start: Annotated[int, gx.Option("first number", at_least=1, at_most=99_999)] = 10
    step: Annotated[int, gx.Option("distance of numbers", at_least=1, at_most=1_000)] = 10
    last: Annotated[int, gx.Option("largest number; then it begins again", at_least=1)] = 99_999

    def refuse(self, block: gx.Block) -> str:
        """Return why the program's numbers cannot be changed where only a part of it is seen."""
        if _reads_number(block):
            return "this reads the number of a block"
        for item in block.items:
            if hasattr(item, "tree") and getattr(item, "kind", "") != "assignment":
                return "blocks may be jumped to by their numbers"
            if isinstance(item, gx.Word) and _may_jump(item, block):
                return f"{block.text[item.start : item.end]} may refer to sequence numbers"
        return ""

    def asks(self, block: gx.Block) -> bool:
        """Ask for the whole of a program in which numbers may be named."""
        return bool(self.refuse(block))

    def counts(self, block: gx.Block) -> bool:
        """Count the blocks that get a number: not the program's own."""
        words = [item.address for item in block.items if isinstance(item, gx.Word)]
        return (bool(words) or _label(block) is not None) and "O" not in words

    def edit(self, block: gx.Block, number: int) -> str | None:
        """Return the block with its new number."""
        return self._numbered(block, number) if self.counts(block) else block.text

    def _numbered(self, block: gx.Block, number: int) -> str:
        label = _label(block)
        new = f"N{self._new(number)}"
        if label is not None:
            return block.text[: label.start] + new + block.text[label.end :]
        words = [item for item in block.items if isinstance(item, gx.Word)]
        gap = " " if len(words) > 1 and words[1].start > words[0].end else ""
        # Before comments and assignments: LinuxCNC takes it only at the head of a block.
        head = next(item for item in block.items if _begins(item)).start
        return block.text[:head] + new + gap + block.text[head:]

    def _new(self, number: int) -> int:
        count = (self.last - self.start) // self.step + 1
        return self.start + self.step * (number % count)

    # --- whole programs ---

    def refused(
        self, blocks: Sequence[gx.Block], dialect: type[gx.Dialect]
    ) -> tuple[int, str] | None:
        """Return a block whose numbers cannot be followed, and why."""
        if not _names_lines(dialect):
            return None
        there = _Lines(blocks)
        for nth, block in enumerate(blocks):
            if why := _not_followed(block, dialect, there):
                return nth, why
            for start, end in _named(block, dialect):
                found = there.of(nth, _value(block.text[start:end]))
                if len(found) != 1:
                    how = "no line" if not found else "more than one line"
                    return nth, f"{how} of this program has the number {block.text[start:end]}"
        counted = sum(map(self.counts, blocks))
        named = any(any(_named(block, dialect)) for block in blocks)
        if named and counted > (self.last - self.start) // self.step + 1:
            return 0, f"there are {counted} blocks, and not so many numbers"
        return None

    def rewritten(self, blocks: Sequence[gx.Block], dialect: type[gx.Dialect]) -> list[str]:
        """Return the blocks with new numbers, in jumps as well."""
        there, found = _Lines(blocks), []
        before = list(accumulate(map(self.counts, blocks), initial=0))
        for nth, block in enumerate(blocks):
            text = block.text
            names = list(_named(block, dialect)) if _names_lines(dialect) else []
            for start, end in sorted(names, reverse=True):
                (line,) = there.of(nth, _value(block.text[start:end]))
                text = f"{text[:start]}{self._new(before[line])}{text[end:]}"
            if self.counts(block):
                text = self._numbered(_with(block, text), before[nth])
            found.append(text)
        return found


class _Lines:
    """The lines of a file by program and sequence number."""

    def __init__(self, blocks: Sequence[gx.Block]) -> None:
        self.program: list[int] = []
        self.numbers: set[int] = set()
        self.labels: dict[tuple[int, float], list[int]] = {}
        for nth, block in enumerate(blocks):
            begins = [w for w in _words(block) if w.address == "O"]
            self.numbers |= {int(w.value.value) for w in begins if isinstance(w.value, gx.Number)}
            marked = any(str(getattr(i, "kind", "")).startswith("program") for i in block.items)
            more = bool(begins) or marked
            self.program.append((self.program[-1] if self.program else 0) + more)
            label = _label(block)
            if label is not None:
                number = _value(block.text[label.start + 1 : label.end])
                self.labels.setdefault((self.program[-1], number), []).append(nth)

    def of(self, nth: int, number: float) -> list[int]:
        """Return the lines of the program of a line that have a number."""
        return self.labels.get((self.program[nth], number), [])


def _value(text: str) -> float:
    """Return a number that may have blanks inside."""
    return float("".join(text.split()))


def _names_lines(dialect: type[gx.Dialect]) -> bool:
    """Whether programs name lines by their sequence numbers: O-words do not."""
    return dialect.flow_rule.language != "o-words"


def _words(block: gx.Block) -> list[gx.Word]:
    return [item for item in block.items if isinstance(item, gx.Word)]


def _begins(item: Any) -> bool:
    """Whether an item is the head of what a block says."""
    return isinstance(item, gx.Word | gx.Comment) or getattr(item, "kind", "") == "assignment"


def _label(block: gx.Block) -> Any:
    """Return the item with the sequence number of a block, None if it has none."""
    for item in block.items:
        if isinstance(item, gx.Word):
            return item if item.address == "N" else None
        if getattr(item, "kind", "") == "label":
            return item
    return None


def _codes(block: gx.Block) -> set[tuple[str, float]]:
    known = (w for w in _words(block) if w.address in "GM" and isinstance(w.value, gx.Number))
    return {(word.address, word.value.value) for word in known}


def _named(block: gx.Block, dialect: type[gx.Dialect]) -> Iterator[Span]:
    """Yield where a block names a line by its number, as it is written."""
    for item in block.items:
        if getattr(item, "kind", "") in JUMPS:
            target = item.tree.children[-1]  # type: ignore[union-attr]  # it is a statement
            if isinstance(target, str):
                yield target.start_pos, target.start_pos + len(target)  # type: ignore[attr-defined]
    if OWN_LINES in _codes(block) and dialect.flow_rule.calls_own_lines:
        for word in _words(block):
            if word.address == "P" and isinstance(word.value, gx.Number):
                yield word.value.start, word.value.end


def _not_followed(block: gx.Block, dialect: type[gx.Dialect], there: _Lines) -> str:
    """Return why what a block names cannot be followed, nothing where it can."""
    codes, letters = _codes(block), {word.address for word in _words(block)}
    for item in block.items:
        if getattr(item, "kind", "") in JUMPS and not isinstance(
            item.tree.children[-1],  # type: ignore[union-attr]  # it is a statement
            str,
        ):
            return "this jumps to a number that is computed"
    if _reads_number(block):
        return "this reads the number of a block"
    if any(w.address in "GM" and not isinstance(w.value, gx.Number) for w in _words(block)):
        return "which code this is, is computed: it may refer to sequence numbers"
    if codes & LEAVES and letters & {"P", "Q"}:
        return "this may lead to a number of another program"
    if codes & CALLS and there.labels and not _is_here(block, there):
        return "a program of another file may come back to a number (M99 P)"
    if OWN_LINES in codes and not any(_named(block, dialect)):
        return "which line this calls is computed"
    drills = ("G", 73) in codes and not {"P", "Q"} <= letters
    if codes & CONTOURS and letters & {"P", "Q"} and not drills and not codes & WITH_VALUES:
        return "this may refer to sequence numbers"
    return ""


def _reads_number(block: gx.Block) -> bool:
    """Whether a block reads the number of the block that is executed."""
    bare = "".join(block.text.split())
    return any(f"#{number}" in bare for number in EXECUTED_NUMBER)


def _is_here(block: gx.Block, there: _Lines) -> bool:
    """Whether a call names a program of this file."""
    values = [w.value for w in _words(block) if w.address == "P"]
    numbers = [int(value.value) for value in values if isinstance(value, gx.Number)]
    return len(numbers) == len(values) == 1 and (
        numbers[0] in there.numbers or numbers[0] % PACKED in there.numbers
    )


def _with(block: gx.Block, text: str) -> gx.Block:
    """Return a block of another text: only what stands behind its number is another."""
    return gx.Block(text, block.items, block.error)


def _may_jump(word: gx.Word, block: gx.Block) -> bool:
    if not isinstance(word.value, gx.Number):
        return False
    code, letters = (word.address, word.value.value), {w.address for w in block.words}
    drills = code == ("G", 73) and not {"P", "Q"} <= letters
    jumps = CALLS | LEAVES | {OWN_LINES}
    return code in jumps or (code in CONTOURS and bool(letters & {"P", "Q"}) and not drills)
