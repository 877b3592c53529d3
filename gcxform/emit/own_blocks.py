"""M codes that act on one side of the motion of their block here, and on the other side there.

In the target they stand in a block of their own: before the motion what acts before it in the
source, behind it what acts behind.
"""

from __future__ import annotations

from gcxform.dialect.codes import MCode
from gcxform.emit.expressible import code_of, like
from gcxform.emit.manner import Manner, Task
from gcxform.syntax.shapes import Shape
from gcxform.syntax.tree import Number
from gcxform.system.arrays import Ints
from gcxform.toolpath.path import Given


def apart(manner: Manner, number: int) -> MCode | None:
    """Return an M code that has to stand by itself beside a motion; None for another."""
    code, other = m_codes_of(manner, number)
    return code if code is not None and other is not None and code.after != other.after else None


def m_codes_of(manner: Manner, number: int) -> tuple[MCode | None, MCode | None]:
    """Return what an M code is in the source, and what the one that stands for it is."""
    said = manner.saying.instead(f"M{number}")
    rules = manner.source.block_rule, manner.target.block_rule
    other = manner.target.m_codes.get(int(said[1:]), rules[1].unknown_m) if said else None
    return manner.source.m_codes.get(number, rules[0].unknown_m), other


def own_blocks(task: Task, count: Ints) -> tuple[list[Given], list[Given]]:
    """Return what stands before and behind the moves of the lines of a window, by itself.

    `count` (live,) is how many rows lines have.
    """
    before: list[Given] = []
    behind: list[Given] = []
    if not task.manner.crossing:
        return before, behind
    said: dict[int, tuple[str, str]] = {}
    first = (count.cumsum() - count).tolist()
    for line, (number, rows) in enumerate(zip(task.shape.tolist(), count.tolist(), strict=True)):
        if number not in said:
            said[number] = _texts(task.manner, task.table.shapes.shapes[number])
        at = line + task.path.blocks.first
        for text, row, found in zip(
            said[number], (first[line], first[line] + rows), (before, behind), strict=True
        ):
            if rows and text:
                found.append(Given(row, text, at))
    return before, behind


def _texts(manner: Manner, shape: Shape) -> tuple[str, str]:
    """Return the M codes of blocks of a shape that stand by themselves before and behind it."""
    texts: tuple[list[str], list[str]] = [], []
    for word in shape.block.words:
        if word.address != "M" or not isinstance(word.value, Number):
            continue
        code = apart(manner, int(word.value.value))
        if code is not None:
            text = shape.block.text[word.start : word.end]
            texts[code.after].append(like(text, manner.saying.instead(code_of(word))))
    return " ".join(texts[False]), " ".join(texts[True])
