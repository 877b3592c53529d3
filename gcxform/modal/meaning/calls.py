"""Blocks that call a program with values, and are kept: the program is not there to be read.

All words of such a block belong to the call: G65 branches off before anything else is done (Fanuc
macro executor B-62093E-1 p. 32). Words in front of it are commands of their own, which no manual
puts in order, so that they are refused.
"""

from __future__ import annotations

from collections.abc import Iterator

from gcxform.dialect.codes import Effect
from gcxform.dialect.dialect import Dialect
from gcxform.modal.meaning.meaning import Act, EventShape, Meaning, Refusal
from gcxform.syntax.shapes import Shape
from gcxform.syntax.tree import BLANKS, CODES, Block, Expression, Mark, Number, Statement, Word
from gcxform.toolpath.path import GROUND

ORDER = 25
CALL = "call"
NUMBERED = "G65"
"""The code that calls a program by its number in P; others are calls by themselves."""


def calling(shape: Shape, dialect: type[Dialect]) -> Word | None:
    """Return the code with which a block calls a program; None for other blocks."""
    for word in shape.block.words:
        if word.address == "N":
            continue
        return word if _calls(word, dialect) else None
    return None


def _calls(word: Word, dialect: type[Dialect]) -> bool:
    if word.address not in "GM" or not isinstance(word.value, Number):
        return False
    name = _name(word)
    code = dialect.codes.get(name)
    declared = name in dialect.flow_rule.kept_codes
    return declared or (code is not None and code.effect is Effect.CALL)


def _name(word: Word) -> str:
    assert isinstance(word.value, Number)
    return f"{word.address}{round(word.value.value, 6):g}"


def read_call(
    shape: Shape, word: Word, dialect: type[Dialect], meaning: Meaning
) -> Iterator[Refusal]:
    """Fill the meaning of a call, and yield what speaks against it."""
    name = _name(word)
    yield from _others(shape)
    yield from _other_codes(shape, word, name)
    if name in dialect.codes:
        meaning.groups[dialect.codes[name].group] = name
    meaning.call, meaning.call_slots = name, _slots(shape)
    meaning.marked = any(isinstance(item, Mark) for item in shape.block.items)
    meaning.deleted = any(
        isinstance(item, Mark) and item.kind == "block_delete" for item in shape.block.items
    )
    if name == NUMBERED and all(address != "P" for address, _ in meaning.call_slots):
        message = f"{name} calls a program by a number in P, and that is not written here"
        yield Refusal("GX210", word.start, word.end - word.start, message)
    meaning.loses_position = meaning.runs_macro = True
    meaning.lost_by.add(-1)
    meaning.acts.append(Act(CALL, name, (), word.start, word.end - word.start))
    deep = dialect.codes[name].lengths if name in dialect.codes else ""
    said = tuple((GROUND if a in deep else a, slot) for a, slot in meaning.call_slots)
    meaning.events.append(EventShape(ORDER, _text(shape), said))


ELSEWHERE = "is it written for another control? `gcxform info FILE` says which ones have it"


def not_there(word: Word, name: str, dialect: type[Dialect]) -> Refusal:
    """Refuse a code that the dialect does not have, and ask whether it is the machine's own."""
    hint = f'is it one of the machine\'s own? ends = "unknown" in [control.macro.{name}]'
    asked = hint if dialect.flow_rule.macro_levels else ELSEWHERE
    message = f"{dialect.name} has no code {name}"
    return Refusal("GX201", word.start, word.end - word.start, message, asked)


def _others(shape: Shape) -> Iterator[Refusal]:
    """Refuse what is neither a word nor a comment."""
    if shape.block.error is not None:
        column, message = shape.block.error
        yield Refusal("GX101", column - 1, 1, message)
    for item in shape.block.items:
        if isinstance(item, Statement):
            width = item.end - item.start
            yield Refusal("GX206", item.start, width, "this belongs to no word of the call")


def _other_codes(shape: Shape, call: Word, name: str) -> Iterator[Refusal]:
    """Refuse G codes behind a call: no argument is called G (16i B-63684EN p. 278)."""
    for word in shape.block.words:
        if word.address == "G" and word is not call:
            message = f"whether the call of {name} or the control takes this code is not certain"
            hint = "write it in a block of its own"
            yield Refusal("GX210", word.start, word.end - word.start, message, hint)


def _slots(shape: Shape) -> tuple[tuple[str, int], ...]:
    """Return the numbers of a call with their slots; those of codes stand in its text."""
    varying = [word for word in shape.block.words if word.address not in CODES]
    return tuple(
        (word.address, slot)
        for slot, word in enumerate(varying)
        if isinstance(word.value, Number) and word.address != "N"
    )


def _text(shape: Shape) -> str:
    """Return what all calls of the shape have in common: codes as they stand, letters of others."""
    said = (_spelled(shape.block, word, word.address in CODES) for word in _named(shape.block))
    return "".join(said)


def computed_words(block: Block) -> str:
    """Return the words of a call whose values are computed, as they are compared."""
    found = (word for word in _named(block) if isinstance(word.value, Expression))
    return "".join(_spelled(block, word, True) for word in found)


def _named(block: Block) -> list[Word]:
    return [word for word in block.words if word.address != "N"]


def _spelled(block: Block, word: Word, whole: bool) -> str:
    text = block.text[word.start : word.end].translate(BLANKS).upper()
    return text if whole else word.address
