"""What stands behind a slash within a block: `Z5. /M8`.

With the switch on the control skips what is behind the slash, and executes the words before it.
Only coolant is read there, as shops write it: it moves nothing, and no other block hangs on it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from gcxform.dialect.dialect import Dialect
from gcxform.modal.meaning.meaning import EventShape, Meaning, Refusal
from gcxform.syntax.shapes import Shape
from gcxform.syntax.tree import BLANKS, Mark

ASIDE = "aside"
"""The kind of a mark that has such codes."""
OWN_BLOCK = "write what is behind the slash into a block of its own, with the slash"
ORDER = 41
"""The order of coolant among the events of a block."""
CODE = re.compile(r"M[ \t]*[0-9]+", re.IGNORECASE)


def codes_in(text: str) -> Iterator[tuple[int, int, int]]:
    """Yield the number of each M code behind a slash, where it begins and how long it is."""
    for found in CODE.finditer(text):
        yield int(found[0][1:].translate(BLANKS)), found.start(), len(found[0])


def read_aside(
    item: Mark, shape: Shape, dialect: type[Dialect], meaning: Meaning
) -> Iterator[Refusal]:
    """Turn the codes behind a slash into events; refuse those on which more would hang."""
    if not dialect.text_rule.asides:
        message = f"this is not {dialect.name} G-code: '/' does not fit here"
        yield Refusal("GX101", item.start, 1, message)
    for number, at, width in codes_in(shape.block.text[item.start : item.end]):
        code = dialect.m_codes.get(number)
        if code is None or code.group != "coolant":
            message = f"a switch decides on M{number}, and not on what stands before it"
            yield Refusal("GX203", item.start + at, width, message, OWN_BLOCK)
            return
        meaning.events.append(EventShape(ORDER, f"M{number}", (), code.after, aside=True))
