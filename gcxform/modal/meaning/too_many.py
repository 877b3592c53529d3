"""Blocks with more words, or more commands, than a control takes in one."""

from __future__ import annotations

from collections.abc import Iterator

from gcxform.dialect.dialect import Dialect
from gcxform.modal.meaning.meaning import Refusal
from gcxform.syntax.shapes import Shape


def too_many(shape: Shape, dialect: type[Dialect]) -> Iterator[Refusal]:
    """Refuse more M words, or more commands, than the control takes in a block."""
    rule = dialect.block_rule
    letters = "GMT" if dialect.tool_rule.t_changes else "GM"
    commands = [word for word in shape.block.words if word.address in letters]
    for word in commands[1:2] if rule.one_command else ():
        message = f"{dialect.name} takes one command in a block, and would not hear this one"
        yield Refusal("GX219", word.start, word.end - word.start, message, "write two blocks")
    most = rule.most_m_words
    for word in [word for word in shape.block.words if word.address == "M"][most:][:1]:
        if most:
            message = f"{dialect.name} takes {most} M words in a block"
            yield Refusal("GX219", word.start, word.end - word.start, message)
