"""Blocks with more words, more commands, or more to do, than a control takes in one."""

from __future__ import annotations

from collections.abc import Iterator

from gcxform.dialect.dialect import Dialect
from gcxform.modal.meaning.meaning import Meaning, Refusal
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


def drops_move(meaning: Meaning, dialect: type[Dialect]) -> str:
    """Return a code beside which a control leaves out the move of the block, or nothing."""
    name = meaning.groups.get("non-modal", "")
    machine = name in dialect.codes and dialect.codes[name].act == "machine"
    if dialect.block_rule.one_action != "all" or machine:
        return ""
    return name if "motion" in meaning.groups or meaning.axes else ""
