"""Words behind a comma: what is put into the corner at the end of a straight move.

A piece that the control puts in by itself stands between two blocks, and when codes of these act
would have to be told for each of them. So they may say how they move, and nothing else.
"""

from __future__ import annotations

from collections.abc import Iterator

from gcxform.dialect.dialect import Dialect
from gcxform.modal.meaning.meaning import Meaning, Refusal
from gcxform.syntax.shapes import Shape
from gcxform.syntax.tree import Word

ANGLE = ",A"
OUT = "write the corner as blocks of its own"
PLAIN = frozenset({"motion", "distance", "units", "feed-mode", "cutter-comp", "path", "spindle"})
"""Groups of the codes that may stand in a block before or behind a corner."""


def corner_word(shape: Shape, dialect: type[Dialect], meaning: Meaning) -> Iterator[Refusal]:
    """Note the word of a corner, and refuse what may not stand beside it."""
    words = [word for word in shape.block.words if word.address.startswith(",")]
    for word in words:
        if word.address == ANGLE:
            message = f"{ANGLE}, a line by its angle, is not followed"
            yield _refused(word, message, "program the point at which the line ends")
    if not words:
        return
    if words[1:]:
        yield _refused(words[1], "a corner takes one word behind a comma")
    meaning.corner = words[0].address
    late = next((event.what for event in meaning.events if event.after), "")
    if more := does_more(meaning):
        message = f"{more} beside {meaning.corner} is not followed"
        yield _refused(words[0], message, f"write {more} in a block of its own before")
    elif late:
        message = f"whether {late} acts before {meaning.corner} or behind it is not certain"
        yield _refused(words[0], message, f"write {late} in a block of its own, behind the next")


def does_more(meaning: Meaning) -> str:
    """Return what a block does beside a plain move, or nothing."""
    codes = [code for group, code in meaning.groups.items() if group not in PLAIN]
    codes += [act.code for act in meaning.acts]
    codes += [f"M{number}" for number in sorted(meaning.lost_by)]
    return "".join(codes[:1])


def _refused(word: Word, message: str, hint: str = OUT) -> Refusal:
    return Refusal("GX213", word.start, word.end - word.start, message, hint)
