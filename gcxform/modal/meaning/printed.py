"""What blocks print: messages of LinuxCNC with values, and what macro B sends out.

POPEN opens a line or a file, DPRNT and BPRNT send text and variables, PCLOS closes it (Fanuc, Haas;
the format of a variable is its number and its digits, `#100[53]`: NCT 99M manual p. 193). Nothing
moves by it. What is printed is compared as it stands, and so are the assignments that feed it; a
value that hangs on the unit, on modes or on where the axes stand is noted.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from gcxform.dialect.arithmetic import Arithmetic, Key
from gcxform.dialect.dialect import Dialect
from gcxform.modal.meaning.meaning import EventShape, Meaning, Refusal
from gcxform.syntax.tree import BLANKS, Block, Mark, Statement, Word

OUTPUT = "output"
"""The kind of a mark that sends something out."""
FIRST = 0
"""The order of what is printed among the events of a block."""
PRINTS = re.compile(r"\([ \t]*(?:DEBUG|PRINT|LOG)[ \t]*,", re.IGNORECASE)
NAMED = re.compile(r"#<[^<>]*>|#[0-9]")
PARAMETER = re.compile(r"#[ \t]*(<[^<>]*>|[0-9]+)?")
STRENGTH = ("", "units", "place", "motion")


def prints_values(comment: str) -> bool:
    """Return whether a comment prints the value of a parameter."""
    return PRINTS.match(comment) is not None and NAMED.search(comment) is not None


def is_output(item: object) -> bool:
    """Return whether an item of a block sends something out."""
    return isinstance(item, Mark) and item.kind == OUTPUT


def parameters_printed(text: str) -> Iterator[Key | None]:
    """Yield the parameters that a text prints; None for one that is computed."""
    for found in PARAMETER.finditer(text):
        name = (found[1] or "").translate(BLANKS)
        if name.startswith("<"):
            yield name[1:-1].lower()
        else:
            yield int(name) if name else None


def print_hangs_on(text: str, dialect: type[Dialect]) -> str:
    """Return on what a printed text depends besides parameters of the program, as `Unknown`."""
    arithmetic = dialect.flow_rule.arithmetic
    if arithmetic is None:
        return ""
    found = [_hangs_on(key, arithmetic) for key in parameters_printed(text)]
    return max(found, key=STRENGTH.index, default="")


def read_output(
    item: Mark, block: Block, dialect: type[Dialect], meaning: Meaning
) -> Iterator[Refusal]:
    """Turn what is sent out into an event; refuse it beside words."""
    others = (other for other in block.items if isinstance(other, Word | Statement))
    if not all(isinstance(other, Word) and other.address == "N" for other in others):
        message = "when this is sent out, beside other words, is not certain"
        yield Refusal("GX203", item.start, item.end - item.start, message)
    text = block.text[item.start : item.end]
    meaning.events.append(EventShape(FIRST, text))
    meaning.sends, meaning.prints = True, print_hangs_on(text, dialect)


def _hangs_on(key: Key | None, arithmetic: Arithmetic) -> str:
    return STRENGTH[-1] if key is None else arithmetic.hangs_on(key)
