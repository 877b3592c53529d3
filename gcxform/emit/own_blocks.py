"""What stands in a block of its own in the target, beside a motion of the source.

M codes that act on one side of the motion of their block here, and on the other side there: before
the motion what acts before it in the source, behind it what acts behind. And the length of a tool
that the source calls by a number, and the target takes as it is, or a code that lets go of one and
takes the axis words there: before the motion.
"""

from __future__ import annotations

from math import isfinite

from gcxform.diagnostics import InputError
from gcxform.dialect.codes import MCode
from gcxform.dialect.dialect import INCH
from gcxform.emit.expressible import STATED, code_of, end_of_length, like
from gcxform.emit.manner import Manner, Task
from gcxform.modal.meaning.meaning import EventShape
from gcxform.syntax.shapes import Shape
from gcxform.syntax.tree import Number, Word
from gcxform.system.arrays import Ints
from gcxform.toolpath.path import Given


def apart(manner: Manner, shape: Shape) -> tuple[list[Word], list[Word]]:
    """Return the M words of a block that have to stand by themselves before and behind its motion.

    What acts behind it on both controls goes behind it as well where another one has to: M0 in the
    block of the motion would act before the M9 of the next one.
    """
    before: list[Word] = []
    behind: list[Word] = []
    goes_behind = False
    for word in shape.block.words:
        if word.address != "M" or not isinstance(word.value, Number):
            continue
        code, other = m_codes_of(manner, int(word.value.value))
        if code is None or other is None:
            continue
        crosses = code.after != other.after
        goes_behind |= crosses and code.after
        if code.after and (crosses or not code.takes):
            behind.append(word)
        elif crosses:
            before.append(word)
    return before, behind if goes_behind else []


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
    if not (task.manner.crossing or task.manner.saying.m_codes):
        return before, behind
    said: dict[int, tuple[str, str]] = {}
    ends: dict[int, str] = {}
    first = (count.cumsum() - count).tolist()
    lengths = _lengths(task)
    for line, (number, rows) in enumerate(zip(task.shape.tolist(), count.tolist(), strict=True)):
        if number not in said:
            said[number] = _texts(task.manner, task.table.shapes.shapes[number])
            ends[number] = end_of_length(task.table.meanings[number], task.manner.saying)
        at = line + task.path.blocks.first
        if end := ends[number]:
            before.append(Given(first[line], end, at))
        opens, closes = said[number] if rows else ("", "")
        opens = " ".join(filter(None, (lengths.get(line, ""), opens)))
        if opens:
            before.append(Given(first[line], opens, at))
        if closes:
            behind.append(Given(first[line] + rows, closes, at))
    return before, behind


def _lengths(task: Task) -> dict[int, str]:
    """Return by line the codes for tool lengths that the target takes by their value."""
    found = {}
    for line, vector in task.read.lengths.items():
        meaning = task.table.meanings[int(task.shape[line])]
        for event in meaning.events:
            if task.manner.saying.lengthens(event.what):
                found[line] = _length(task, line, event, vector)
    return found


def _length(task: Task, line: int, event: EventShape, vector: tuple[float, float, float]) -> str:
    """Return the code for a tool length, in the unit of its block, which is said with it."""
    manner = task.manner
    if any(vector[:2]) or not isfinite(vector[2]):
        what = f"{manner.target.name} cannot say {event.what}"
        message = f"{what}: how long the tool is has to be known"
        hint = f"length = ... in [tool.{_number(task, line, event)}] of the machine file, which is "
        hint += "0 where work offsets are set with each tool"
        raise InputError.one("GX501", message, task.location(line), hint)
    inch = bool(task.path.blocks.inch[line])
    decimals = manner.decimals_of("Z", inch)
    value = f"{vector[2] / (INCH if inch else 1.0):.{decimals}f}"
    return f"{STATED['units'][1][inch]} {manner.saying.length_said} Z{value}"


def _number(task: Task, line: int, event: EventShape) -> str:
    """Return the number in the H word of a line, "1" as an example where there is none known."""
    slot = dict(event.slots).get("H")
    first = int(task.window.first_number[line])
    value = 0.0 if slot is None else float(task.read.value[first + slot])
    return f"{value:g}" if value >= 1 else "1"


def _texts(manner: Manner, shape: Shape) -> tuple[str, str]:
    """Return the M codes of blocks of a shape that stand by themselves before and behind it."""
    before, behind = (
        [like(shape.block.text[w.start : w.end], manner.saying.instead(code_of(w))) for w in words]
        for words in apart(manner, shape)
    )
    return " ".join(before), " ".join(behind)
