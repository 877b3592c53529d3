"""What stands in a block of its own in what is written, beside a motion of the source.

M codes that act on one side of the motion of their block here, and on the other side there: before
the motion what acts before it in the source, behind it what acts behind. And the length of a tool
that the source calls by a number, and the target takes as it is, or a code that lets go of one and
takes the axis words there: before the motion. And, also on the same control, M codes of a cycle
that is written out, where they act over the hole: behind the move that goes there.
"""

from __future__ import annotations

from math import isfinite

from gcxform.catalogue.remedies import put_before
from gcxform.diagnostics import InputError
from gcxform.dialect.codes import MCode
from gcxform.dialect.dialect import INCH, Dialect
from gcxform.emit.expressible import STATED, code_of, end_of_length, like
from gcxform.emit.manner import Manner, Task
from gcxform.modal.meaning.meaning import EventShape
from gcxform.modal.state import CYCLE_OFF
from gcxform.syntax.shapes import Shape
from gcxform.syntax.tree import Number, Word
from gcxform.system.arrays import Flags, Ints
from gcxform.toolpath.path import Event, Given


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


def over_hole(source: type[Dialect], shape: Shape) -> list[Word]:
    """Return the M words of a block that act over the hole, if it calls a cycle."""
    names = _over_hole_codes(source)
    words = [w for w in shape.block.words if w.address == "M" and isinstance(w.value, Number)]
    return [word for word in words if code_of(word) in names]


def m_codes_of(manner: Manner, number: int) -> tuple[MCode | None, MCode | None]:
    """Return what an M code is in the source, and what the one that stands for it is."""
    said = manner.saying.instead(f"M{number}")
    rules = manner.source.block_rule, manner.target.block_rule
    other = manner.target.m_codes.get(int(said[1:]), rules[1].unknown_m) if said else None
    return manner.source.m_codes.get(number, rules[0].unknown_m), other


def over_holes(task: Task, expanded: Flags) -> list[Given]:
    """Return M codes that act over holes, between the moves of calls of cycles, by themselves.

    `expanded` (live,) are the calls that are written out. Raises InputError where one stays that
    the target takes otherwise.
    """
    manner, cycle = task.manner, task.read.modes.cycle != CYCLE_OFF
    names = [_over_hole_codes(each) for each in (manner.source, manner.target)]
    if not cycle.any() or not (names[0] or names[1]):
        return []
    found: dict[tuple[int, int], list[str]] = {}
    moving = {*task.path.block.tolist()}
    for event in task.path.events:
        line = event.line - task.path.blocks.first
        over, there = (event.what in some for some in names)
        if event.within or not (over or there) or not cycle[line] or line not in moving:
            continue
        if over and expanded[line]:
            found.setdefault((event.row, event.line), []).append(_as_written(task, line, event))
        elif over != there and not expanded[line]:
            ways = ("over", "behind") if over else ("behind", "over")
            message = f"{event.what} of a cycle acts {ways[0]} the hole"
            message += f", and in {manner.target.name} {ways[1]} it"
            raise InputError.one("GX501", message, task.location(line), put_before("cycles"))
    return [Given(row, " ".join(texts), line) for (row, line), texts in found.items()]


def _over_hole_codes(dialect: type[Dialect]) -> frozenset[str]:
    """Return the M codes that act over the hole that their block drills."""
    return dialect.motion_rule.over_hole(dialect.m_codes)


def _as_written(task: Task, line: int, event: Event) -> str:
    """Return the code of an event as its line has it, or the one that stands for it."""
    shape = task.table.shapes.shapes[int(task.shape[line])]
    words = over_hole(task.manner.source, shape)
    word = next(word for word in words if code_of(word) == event.what)
    return like(shape.block.text[word.start : word.end], task.manner.saying.instead(event.what))


def own_blocks(task: Task, count: Ints, expanded: Flags) -> tuple[list[Given], list[Given]]:
    """Return what stands before and behind the moves of the lines of a window, by itself.

    `count` (live,) is how many rows lines have, `expanded` which are calls that are written out.
    """
    before: list[Given] = []
    behind: list[Given] = []
    if not (task.manner.crossing or task.manner.saying.m_codes):
        return before, behind
    said: dict[tuple[int, bool], tuple[str, str]] = {}
    ends: dict[int, str] = {}
    first = (count.cumsum() - count).tolist()
    lengths = _lengths(task)
    columns = task.shape.tolist(), count.tolist(), expanded.tolist()
    for line, (number, rows, out) in enumerate(zip(*columns, strict=True)):
        if (number, out) not in said:
            said[number, out] = _texts(task.manner, task.table.shapes.shapes[number], out)
            ends[number] = end_of_length(task.table.meanings[number], task.manner.saying)
        at = line + task.path.blocks.first
        if end := ends[number]:
            before.append(Given(first[line], end, at))
        opens, closes = said[number, out] if rows else ("", "")
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


def _texts(manner: Manner, shape: Shape, expanded: bool) -> tuple[str, str]:
    """Return the M codes of blocks of a shape that stand by themselves before and behind it."""
    between = over_hole(manner.source, shape) if expanded else []
    before, behind = (
        [
            like(shape.block.text[w.start : w.end], manner.saying.instead(code_of(w)))
            for w in words
            if w not in between
        ]
        for words in apart(manner, shape)
    )
    return " ".join(before), " ".join(behind)
