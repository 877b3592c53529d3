"""What a target dialect has words for, and what is left of a block in it."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from gcxform.dialect import Dialect
from gcxform.modal.meaning import FRAMING, Meaning
from gcxform.syntax.shapes import CODES
from gcxform.syntax.tree import BLANKS, Item, Mark, Number, Statement, Word
from gcxform.toolpath.path import Event


def code_of(word: Word) -> str:
    """Return the code of a G, M or O word."""
    assert isinstance(word.value, Number)
    return f"{word.address}{round(word.value.value, 6):g}"


def folded_words(meaning: Meaning, work: str) -> frozenset[str]:
    """Return codes and addresses that are not written where frames are folded into the words.

    The code of the work offset in which the program stays is written as it was.
    """
    gone: set[str] = set()
    for act in meaning.acts:
        if act.name in FRAMING and act.code != work:
            gone |= {act.code, *(address for address, _ in act.slots)}
    return frozenset(gone)


def gaps_between(text: str, words: list[Word]) -> Iterator[bool]:
    """Yield, for each two words that follow one another, whether blanks are between them."""
    for one, other in pairwise(words):
        between = text[one.end : other.start]
        if not between.strip(" \t"):
            yield bool(between)


def is_foreign(item: Item, target: type[Dialect]) -> bool:
    """Whether an item has no place in another dialect: assignments, frames that it has not."""
    if isinstance(item, Statement):
        return item.kind == "assignment"
    if not isinstance(item, Mark):
        return False
    if item.kind == "percent":
        return not target.has_percent
    return item.kind.startswith("program") and not target.has_program_number


def event_text(event: Event, target: type[Dialect], gap: bytes) -> bytes | None:
    """Return the block that does what a cycle does between its moves; None if there is none."""
    if event.what != "DWELL":
        known = event.what[0] == "M" and int(event.what[1:]) in target.m_codes
        return event.what.encode() if known else None
    seconds = event.values[0][1]
    for address, unit in target.dwell.items():
        count = seconds / unit
        whole = abs(count - round(count)) < 1e-9
        if unit != 1.0 and (not whole or (target.dwell_point_is_seconds and not whole)):
            continue
        number = f"{round(count)}" if unit != 1.0 else f"{seconds:.6f}".rstrip("0")
        return b"G4" + gap + f"{address}{number}".encode()
    return None


def nothing_left(
    items: tuple[Item, ...], meaning: Meaning, target: type[Dialect], work: str
) -> bool:
    """Whether of a block that has items nothing but its number would be written.

    That is so for parts of the program frame that the target has not, and for codes that are folded
    into the words of moves (`work`, if it is not "", is where the program then stays).
    """
    folded = folded_words(meaning, work) if work else frozenset()

    def goes(item: Item) -> bool:
        if isinstance(item, Word):
            return (
                item.address == "N"
                or (code_of(item) if item.address in CODES else item.address) in folded
            )
        return is_foreign(item, target)

    kept = [item for item in items if not (isinstance(item, Word) and item.address == "N")]
    return bool(kept) and all(goes(item) for item in items)


def same_dwell(one: type[Dialect], other: type[Dialect]) -> bool:
    """Whether a dwell of one dialect is as long in the other, however it is written."""
    return one.dwell == other.dwell and one.dwell_point_is_seconds == other.dwell_point_is_seconds


def like(text: str, code: str) -> str:
    """Return a code written like another: `g01` for G3 gives `g03`."""
    letter, digits = text[0], text[1:].translate(BLANKS)
    number = code[1:]
    if digits[:1] == "0" and len(digits.split(".")[0]) == 2 and len(number.split(".")[0]) == 1:
        number = "0" + number
    return letter + number
