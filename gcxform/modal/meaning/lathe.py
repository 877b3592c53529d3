"""Blocks that say that a program is for a lathe, where mills of the same control are read.

On a lathe X is a diameter, U and W are steps, and G90, G92 and G94 may be cycles: what is read as a
program of a mill would mean something else. So it is refused by one message.
"""

from __future__ import annotations

from collections.abc import Iterator

from gcxform.dialect.dialect import Dialect
from gcxform.modal.meaning.meaning import Refusal
from gcxform.modal.meaning.numbered import code_of
from gcxform.syntax.shapes import Shape
from gcxform.syntax.tree import CODES, Number, Word

TURNING = frozenset(f"G{number}" for number in range(70, 77))
"""Cycles that repeat a contour, from P to Q, with what U and W leave for finishing."""
CONTOURS = frozenset(("G70", "G71", "G72", "G75"))
"""Those of them that no mill has, or none that takes P and Q."""
STEPS = frozenset("UW")
OF_MILLS = frozenset("YV")
"""What stands beside U and W where they are axes of their own."""
LATHE = "GX234"


def lathe_signs(shape: Shape, dialect: type[Dialect]) -> Iterator[Refusal]:
    """Refuse what only lathes have, where the dialect says so."""
    if not dialect.block_rule.mill or shape.block.error is not None:
        return
    words = {word.address: word for word in shape.block.words if word.address not in CODES}
    plain = [w for w in shape.block.words if w.address in CODES and isinstance(w.value, Number)]
    for word in plain:
        what = _sign(code_of(word), words, dialect)
        if what:
            yield _refusal(word, what)
    taken = {letter for word in plain for letter in _taken(code_of(word), dialect)}
    steps = STEPS & words.keys() - taken
    for address in sorted(steps - {*dialect.axes}):
        yield _refusal(words[address], f"{address}, a step of a lathe's axis")
    if steps == STEPS <= {*dialect.axes} and words.keys().isdisjoint(OF_MILLS):
        yield _refusal(words["U"], "U and W, the steps of a lathe's axes, in a block without Y")


def _sign(code: str, words: dict[str, Word], dialect: type[Dialect]) -> str:
    """Return what a code beside some words says of the machine, nothing if it fits a mill."""
    if code in ("G50", "G92") and "S" in words and words.keys().isdisjoint(dialect.axes):
        return f"{code} with S, the highest speed of a lathe's spindle"
    contour = code in CONTOURS and {"P", "Q"} <= words.keys()
    if contour or (code in TURNING and STEPS & words.keys()):
        return f"{code}, which repeats a contour on a lathe"
    if code == "G96" and code not in dialect.codes:
        return "G96, a constant cutting speed"
    return ""


def _taken(code: str, dialect: type[Dialect]) -> str:
    """Return the words that are parameters to a code."""
    if code[0] == "G":
        known = dialect.codes.get(code)
        return known.takes if known else ""
    number = int(float(code[1:]))
    m_code = dialect.m_codes.get(number)
    return m_code.takes if m_code else ""


def _refusal(word: Word, what: str) -> Refusal:
    message = f"this is a program for a lathe: it has {what}"
    hint = "programs of lathes are not read: X is a diameter there, and G90 may be a cycle"
    return Refusal(LATHE, word.start, word.end - word.start, message, hint)
