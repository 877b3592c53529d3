"""What a dialect has chosen among the meanings that a block can have, in sentences.

A manual says what most blocks do for certain; what hangs on a parameter of the machine, or on its
builder, is taken as custom has it. The sentences are made once for each shape.

They go into `State.assumed`, once, and from there into the certificate.
"""

from __future__ import annotations

from gcxform.dialect.dialect import Dialect
from gcxform.modal.meaning.meaning import Meaning
from gcxform.syntax.shapes import Shape
from gcxform.syntax.tree import Number


def choices_of(shape: Shape, dialect: type[Dialect], meaning: Meaning) -> tuple[str, ...]:
    """Return what was chosen for the blocks of a shape, nothing where all is certain."""
    if not (dialect.chosen or dialect.block_rule.m_order_chosen):
        return ()
    found = []
    for word in shape.block.words:
        name = word.address
        if name in "GM" and isinstance(word.value, Number):
            name += f"{round(word.value.value, 6):g}"
        if name in dialect.chosen:
            found.append(dialect.chosen[name])
        if (
            word.address == "M"
            and dialect.block_rule.m_order_chosen
            and any(axis in meaning.slots for axis in dialect.axes)
        ):
            found += _order(name, dialect)
    return tuple(found)


def _order(name: str, dialect: type[Dialect]) -> list[str]:
    """Return when an M code beside a move acts, but for stops, which act behind it everywhere."""
    code = dialect.m_codes.get(int(float(name[1:] or -1)))
    if code is None or code.group in ("stop", "along") or code.ends:
        return []
    return [f"{name} beside a move acts {'after' if code.after else 'before'} it"]
