"""What a percent sign in a block is to a control, and the words behind it."""

from __future__ import annotations

from collections.abc import Iterator

from gcxform.dialect.dialect import Dialect
from gcxform.modal.meaning.meaning import Refusal
from gcxform.syntax.shapes import Shape
from gcxform.syntax.tree import Comment, Mark, Statement, Word


def is_dropped(shape: Shape, dialect: type[Dialect]) -> bool:
    """Whether a percent sign does nothing, because it stands in a line of its own."""
    alone = all(isinstance(item, Mark | Comment) for item in shape.block.items)
    return alone and dialect.program_rule.drops_percent


def behind_percent(item: Mark, shape: Shape, dialect: type[Dialect]) -> Iterator[Refusal]:
    """Refuse words in the line of a percent sign: some controls read them, and some do not."""
    for other in shape.block.items:
        reads = isinstance(other, Word | Statement) or (
            isinstance(other, Mark) and other.kind == "title" and not dialect.program_rule.has_title
        )
        if reads and other.start > item.start:
            message = f"{dialect.name} may read or not what stands behind a % sign in its line"
            yield Refusal("GX203", other.start, other.end - other.start, message)
            return
