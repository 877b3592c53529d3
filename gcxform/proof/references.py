"""The proof of passes that change sequence numbers: what names a line names the same line after.

Claimed, of the blocks of a program before and after: they have the same words, statements and
outputs but for sequence numbers, and the number of a jump (GOTO, P of M97, M96, M99) is that of the
same block of the same program, or of none in both.
"""

from __future__ import annotations

from collections.abc import Sequence

from lark import Token

from gcxform.modal.meaning.printed import is_output
from gcxform.syntax.grammar import span_of
from gcxform.syntax.tree import BLANKS, Block, Item, Mark, Number, Statement, Word

JUMPING_M = frozenset({96, 97, 99})
JUMPS = frozenset({"goto", "if_goto"})
PROGRAMS = frozenset({"program_id", "program_name"})
Span = tuple[int, int]


def first_other(old: Sequence[Block], new: Sequence[Block]) -> int | None:
    """Return the index of the first block that says something else; None if there is none."""
    if len(old) != len(new):
        return min(len(old), len(new))
    pairs = zip(_said(old), _said(new), strict=True)
    return next((nth for nth, (before, after) in enumerate(pairs) if before != after), None)


def _said(blocks: Sequence[Block]) -> list[list[str]]:
    """Return what each block says: texts without blanks, in which jumps name blocks."""
    programs = _programs(blocks)
    places: dict[tuple[int, str], list[int]] = {}
    for nth, block in enumerate(blocks):
        for label in _labels(block):
            places.setdefault((programs[nth], label), []).append(nth)
    found = []
    for nth, block in enumerate(blocks):
        jumps = _jumps(block)
        said = [_text(block, item, jumps) for item in block.items if _counts(item)]
        for start, end in jumps:
            number = _number(block.text[start:end])
            said.append(f"to {places.get((programs[nth], number), number)}")
        found.append(said)
    return found


def _programs(blocks: Sequence[Block]) -> list[int]:
    """Return in which program of the file each block stands."""
    found, number = [], 0
    for block in blocks:
        number += any(
            (isinstance(item, Word) and item.address == "O")
            or (isinstance(item, Mark) and item.kind in PROGRAMS)
            for item in block.items
        )
        found.append(number)
    return found


def _number(text: str) -> str:
    bare = text.translate(BLANKS).lstrip("Nn")
    return f"{float(bare):g}" if bare.replace(".", "", 1).isdecimal() else bare


def _labels(block: Block) -> list[str]:
    """Return the sequence numbers of a block."""
    return [
        _number(block.text[item.start : item.end])
        for item in block.items
        if (isinstance(item, Word) and item.address == "N") or _is_label(item)
    ]


def _is_label(item: Item) -> bool:
    return isinstance(item, Mark) and item.kind == "label"


def _jumps(block: Block) -> list[Span]:
    """Return where numbers of lines stand that a block names."""
    found = []
    for item in block.items:
        if isinstance(item, Statement) and item.kind in JUMPS:
            target = item.tree.children[-1]
            if isinstance(target, Token):
                found.append(span_of(target))
    codes = {word.value.value for word in block.words if word.address == "M"}
    if codes & JUMPING_M:
        words = (word for word in block.words if word.address == "P")
        found += [(w.value.start, w.value.end) for w in words if isinstance(w.value, Number)]
    return found


def _counts(item: Item) -> bool:
    named = isinstance(item, Word) and item.address == "N"
    return (isinstance(item, Word | Statement) and not named) or is_output(item)


def _text(block: Block, item: Item, jumps: Sequence[Span]) -> str:
    """Return an item without blanks, and without the numbers of lines that it names."""
    text, at = "", item.start
    for start, end in jumps:
        if item.start <= start and end <= item.end:
            text += block.text[at:start]
            at = end
    return (text + block.text[at : item.end]).translate(BLANKS).upper()
