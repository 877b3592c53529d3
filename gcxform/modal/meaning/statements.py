"""Assignments among the items of a block, and when they act.

Of a Fanuc it is not known whether one acts before the rest of its block. Assignments to variables
of the program that stand among themselves, and of which none reads what another sets, come to the
same in any order.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from gcxform.dialect.arithmetic import Arithmetic
from gcxform.dialect.dialect import Dialect
from gcxform.modal.meaning.meaning import Refusal
from gcxform.syntax.shapes import Shape
from gcxform.syntax.tree import Comment, Mark, Statement, Word

VARIABLE = re.compile(r"#[ \t]*([0-9]*)")


def read_statement(item: Statement, shape: Shape, dialect: type[Dialect]) -> Iterator[Refusal]:
    """Refuse what is not an assignment, and one that takes effect at an uncertain time."""
    arithmetic, message = dialect.flow_rule.arithmetic, ""
    hint = "let the CAM write plain blocks, or use passes that keep positions"
    if arithmetic is None or item.kind != "assignment":
        message = f"{item.kind.replace('_', ' ')} is code that would have to be run"
    elif not (
        arithmetic.beside_words or stands_alone(item, shape) or _in_any_order(shape, arithmetic)
    ):
        message = "whether this assignment acts before the rest of its block is not certain"
        hint = "write it into a block of its own"
    if message:
        yield Refusal("GX206", item.start, item.end - item.start, message, hint)


def stands_alone(item: Statement | Mark, shape: Shape) -> bool:
    """Whether a statement is all that its block does."""
    others = (other for other in shape.block.items if other is not item)
    return all(
        isinstance(other, Comment | Mark) or (isinstance(other, Word) and other.address == "N")
        for other in others
    )


def _in_any_order(shape: Shape, arithmetic: Arithmetic) -> bool:
    """Whether a block is assignments, and does the same in whatever order they act."""
    made = [item for item in shape.block.items if isinstance(item, Statement)]
    rest = [item for item in shape.block.items if not isinstance(item, Statement | Comment)]
    found = [VARIABLE.findall(shape.block.text[item.start : item.end]) for item in made]
    if any(item.kind != "assignment" for item in made) or any("" in names for names in found):
        return False  # it is computed which one
    keys = [[arithmetic.cell(int(name)) for name in names] for names in found]
    sets, reads = [first for first, *_ in keys], {key for _, *more in keys for key in more}
    return (
        len({*sets}) == len(sets)
        and all(map(arithmetic.owns, sets))
        and reads.isdisjoint(sets)
        and all(
            (isinstance(item, Word) and item.address == "N")
            or (isinstance(item, Mark) and item.kind == "block_delete")
            for item in rest
        )
    )
