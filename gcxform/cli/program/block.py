"""One block of a program in words: its tree, the state before it, and the move it makes."""

from __future__ import annotations

import copy
import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from types import MappingProxyType
from typing import Any

import numpy as np

from gcxform.cli.common.programs import opened
from gcxform.cli.common.request import Asked, needed_dialect
from gcxform.cli.program.tolerant import Tolerant
from gcxform.diagnostics import Diagnostic, InputError, UsageError
from gcxform.dialect.dialect import INCH, Dialect
from gcxform.flow.executed import WrittenOut
from gcxform.flow.straightened import written_out
from gcxform.flow.translated import Translated, translated_so_far
from gcxform.modal.meaning.tables import GROUPS, code_of
from gcxform.modal.reader import Tables
from gcxform.modal.state import Reading, State
from gcxform.syntax.source import Source
from gcxform.syntax.tree import Block, Comment, Mark, Number, Word
from gcxform.system.arrays import Ints
from gcxform.toolpath.circles import radius_and_angle
from gcxform.toolpath.path import Event, FeedMode, Kind, Plane, Toolpath

_MOVES = {
    Kind.RAPID: "rapid",
    Kind.LINE: "line",
    Kind.ARC_CW: "clockwise arc",
    Kind.ARC_CCW: "counter-clockwise arc",
}
_UNITS = {
    FeedMode.INVERSE_TIME: "1/min",
    FeedMode.PER_MINUTE: "mm/min",
    FeedMode.PER_TURN: "mm/turn",
}


def explained(file: str, line: int, dialect: str | None, asked: Mapping[str, Any]) -> list[str]:
    """Return a line, from 1, of a file in words. Raises UsageError if the file is shorter."""
    kind, reading = Asked(**asked).reads(needed_dialect(dialect))
    with opened(file) as source:
        if kind.translator is not None:
            return foreign(source, translated_so_far(source, kind, reading), line, kind, reading)
        if (ran := executed(source, kind, reading)) is not None:
            return as_executed(source, ran, line, kind, reading)
        tolerant = Tolerant(kind, source, reading)
        return in_words(tolerant, _up_to(tolerant, source, line), line)


def in_words(tolerant: Tolerant, text: bytes, line: int) -> list[str]:
    """Return the text of a line, from 1, in words, behind all that a reader has read before."""
    earlier = sorted(tolerant.refused)
    before = copy.deepcopy(tolerant.interpreter.state)
    _, path = tolerant.window(text)
    block = tolerant.dialect.load_grammar().parse(text.rstrip(b"\r\n").decode("latin-1"))
    lines = [f"{tolerant.source.name}:{line}  {block.text}", "", *_items(block)]
    told = _told(before, tolerant.interpreter.axes, earlier, tolerant.refused.get(line), path)
    return [*lines, *told]


def executed(source: Source, kind: type[Dialect], reading: Reading) -> WrittenOut | None:
    """Return the blocks that a program with calls or loops executes, if that is known."""
    with suppress(InputError):
        ran = written_out(source, kind, reading)
        return ran if isinstance(ran, WrittenOut) else None
    return None


def as_executed(
    source: Source,
    ran: WrittenOut,
    line: int,
    kind: type[Dialect],
    reading: Reading,
    tables: Tables | None = None,
) -> list[str]:
    """Return a line in words as it is executed first, and what stands for it: a call's blocks."""
    own = b"".join(source.windows()).splitlines()
    if not 0 < line <= len(own):
        message = f"{source.name} has {len(own)} lines and no line {line}"
        raise UsageError.one("GX731", message)
    first, last = _run_of(line - 1, np.where(ran.origin < len(own), ran.origin, -1))
    called = last == first
    if called:  # of other files, whose lines are counted on behind these
        first, last = _called(own[:line], ran.origin, len(own), kind) or (first, first)
    text = b"".join(ran.windows()).splitlines(keepends=True)
    tolerant = Tolerant(kind, ran, reading, tables)
    tolerant.window(b"".join(text[:first]))
    earlier = sorted({ran.line_of(number) for number in tolerant.refused})
    before = copy.deepcopy(tolerant.interpreter.state)
    _, path = tolerant.window(b"".join(text[first:last]))
    block = kind.load_grammar().parse(own[line - 1].decode("latin-1"))
    lines = [f"{source.name}:{line}  {block.text}", "", *_items(block)]
    for number in range(first, last if called else first):
        file, place = ran.place_of(number + 1)
        lines.append(f"  runs {file}:{place}  {text[number].decode('latin-1').strip()}")
    wrong = (found for number, found in tolerant.refused.items() if first < number <= last)
    return [*lines, *_told(before, tolerant.interpreter.axes, earlier, next(wrong, None), path)]


def foreign(
    source: Source,
    ran: tuple[Translated, InputError | None],
    line: int,
    kind: type[Dialect],
    reading: Reading,
    tables: Tables | None = None,
) -> list[str]:
    """Return a line of a program that is turned into blocks: those, and what they do."""
    blocks, error = ran
    if line > len(blocks.lines):
        message = f"{source.name} has {len(blocks.lines)} lines and no line {line}"
        raise UsageError.one("GX731", message)
    text = b"".join(blocks.windows()).splitlines(keepends=True)
    first, last = _run_of(line - 1, blocks.origin)
    tolerant = Tolerant(kind, blocks, reading, tables)
    tolerant.window(b"".join(text[:first]))
    before = copy.deepcopy(tolerant.interpreter.state)
    _, path = tolerant.window(b"".join(text[first:last]))
    refused = {blocks.line_of(number): found for number, found in tolerant.refused.items()}
    refused |= (
        {found.where.line: found for found in error.diagnostics if found.where} if error else {}
    )
    own = [f"  {block.decode('latin-1').rstrip()}" for block in text[first:last]]
    lines = [f"{source.name}:{line}  {blocks.lines[line - 1]}", "", *own]
    lines += [] if own else ["  it stands for no block"]
    earlier = sorted(number for number in refused if number < line)
    axes = tolerant.interpreter.axes
    return [*lines, *_told(before, axes, earlier, refused.get(line), path, kind.tip_rule.spelled)]


def _may_call(block: Block) -> bool:
    """Whether a block may call a program: it has a code, or an O-word's call."""
    if block.text.lstrip()[:1] in ("o", "O"):
        return "call" in block.text.lower()
    return any(isinstance(item, Word) and item.address in "GMT" for item in block.items)


def _called(
    own: Sequence[bytes], origin: Ints, size: int, kind: type[Dialect]
) -> tuple[int, int] | None:
    """Return the blocks of other files, from and to, that the last of lines runs, if that is sure.

    They follow the line that is executed before it, behind which no other line may call. A program
    has `size` lines.
    """
    line = len(own) - 1
    earlier = origin[origin < line]
    before = int(earlier.max()) if len(earlier) else -1
    parse = kind.load_grammar().parse
    calls = [_may_call(parse(text.decode("latin-1"))) for text in own[before + 1 :]]
    if calls != [False] * (line - before - 1) + [True]:
        return None
    first = _run_of(before, origin)[1] if before >= 0 else 0
    back = np.flatnonzero(origin[first:] < size)
    last = first + int(back[0]) if len(back) else len(origin)
    return (first, last) if last > first else None


def _run_of(line: int, origin: Ints) -> tuple[int, int]:
    """Return the blocks, from and to, that a line stands for when it is first executed."""
    own = origin == line
    if not own.any():
        behind = origin > line
        first = int(np.argmax(behind)) if behind.any() else len(origin)
        return first, first
    first = int(np.argmax(own))
    others = np.flatnonzero(~own[first:])
    return first, first + int(others[0]) if len(others) else len(origin)


def _told(
    before: State,
    axes: str,
    earlier: Sequence[int],
    refusal: Diagnostic | None,
    path: Toolpath | None,
    spelled: Mapping[str, str] = MappingProxyType({}),
) -> Iterator[str]:
    """Yield what was before a block, and what it does."""
    if earlier:
        yield ""
        yield f"read without {len(earlier)} refused line(s) before, first line {earlier[0]}"
    yield from ["", "before it", *_state(before, axes), ""]
    if refusal is not None:
        yield from [f"refused [{refusal.code}]: {refusal.message}", *_hint(refusal.hint)]
    elif before.ended:
        yield "the program has ended: the control does not execute this block"
    else:
        yield from ["what it does", *_doings(path, spelled)]


def _hint(hint: str) -> list[str]:
    return [f"  {hint}"] if hint else []


def _up_to(tolerant: Tolerant, source: Source, line: int) -> bytes:
    """Read all before a line; return the text of that line."""
    for text in source.windows():
        first = tolerant.reader.lines
        window = tolerant.reader.read(text)
        tolerant.reader.lines = first
        index = line - 1 - first
        if 0 <= index < len(window):
            start, end = int(window.start[index]), int(window.next[index])
            if start:
                tolerant.window(text[:start])
            return text[start:end]
        tolerant.window(text)
    message = f"{source.name} has {tolerant.reader.lines} lines and no line {line}"
    raise UsageError.one("GX731", message)


def _items(block: Block) -> Iterator[str]:
    """Yield the items of a block's tree."""
    if block.error is not None:
        yield f"  column {block.error[0]}: {block.error[1]}"
    elif not block.items:
        yield "  an empty block"
    for item in block.items:
        text = block.text[item.start : item.end]
        if isinstance(item, Word):
            kind = "number" if isinstance(item.value, Number) else "expression"
            yield f"  word {item.address}, {kind} {block.text[item.value.start : item.value.end]}"
        elif isinstance(item, Comment):
            yield f"  comment {text}"
        elif isinstance(item, Mark):
            yield f"  {item.kind.replace('_', ' ')} {text}"
        else:
            yield f"  {item.kind.replace('_', ' ')}: {text}"


def _state(state: State, axes: str) -> Iterator[str]:
    """Yield the codes in force and the position."""
    codes = [
        state.frames.work if group == "frame" else code_of(group, state.groups[group])
        for group in GROUPS
    ]
    feed = "none" if math.isnan(state.feed) else f"{state.feed:g}"
    unit = " inch" if state.feed_unit == INCH else ""
    yield f"  modal {' '.join(codes)}, F {feed}{unit if feed != 'none' else ''}"
    words = state.frames.frame().words(state.position[None, :])[0]
    yield f"  at    {_point(axes, words)}"


def _point(axes: str, position: Any) -> str:
    return " ".join(
        f"{axis}{'?' if math.isnan(value) else f'{value:.6g}'}"
        for axis, value in zip(axes, position.tolist(), strict=True)
        if axis in "XYZ" or not math.isnan(value)
    )


def _doings(path: Toolpath | None, spelled: Mapping[str, str]) -> Iterator[str]:
    """Yield moves and events."""
    if path is None or not (len(path) or path.events):
        yield "  it moves nothing and switches nothing"
        return
    events = iter(path.events)
    told = [event for event in path.events if event.row == 0]
    yield from (f"  {_event(event, spelled)}" for event in told)
    for row in range(len(path)):
        yield from _move(path, row)
    yield from (f"  {_event(event, spelled)}" for event in events if event not in told)


def _event(event: Event, spelled: Mapping[str, str]) -> str:
    values = " ".join(f"{name} {value:g}" for name, value in event.values)
    name = "dwell" if event.what == "DWELL" else spelled.get(event.what, event.what)
    return f"{name} {values}".rstrip()


def _move(path: Toolpath, row: int) -> Iterator[str]:
    """Yield a move, and the circle of an arc."""
    kind = Kind(int(path.kind[row]))
    unit = _UNITS[FeedMode(int(path.feed_mode[row]))]
    feed = "" if kind == Kind.RAPID else f" at {path.feed[row]:g} {unit}"
    spline = bool(path.is_spline[row])
    yield f"  {'spline' if spline else _MOVES[kind]}{feed}"
    yield f"    from {_point(path.axes, path.in_frames(path.start)[row])}"
    yield f"    to   {_point(path.axes, path.words[row])}"
    if spline:
        first, second = (path.local(path.control[:, k]) for k in range(2))
        yield f"    by   {_point('XYZ', first[row])}"
        yield f"    and  {_point('XYZ', second[row])}"
    if path.is_arc[row]:
        plane = Plane(int(path.plane[row]))
        u, v, _ = plane.axes
        first, _, _ = radius_and_angle(path, np.array([row]))
        middle = path.local(path.centre)[row]
        centre = f"{'XYZ'[u]}{middle[u]:.6g} {'XYZ'[v]}{middle[v]:.6g}"
        yield f"    about {centre}, radius {first[0]:.6g} mm, in the plane {plane.name}"
        yield f"    through {math.degrees(path.sweep[row]):.6g} degrees"
