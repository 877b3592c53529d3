"""Proves a program that was written in a language of its own: it is the one that was proved.

The blocks were proved as they were written. The lines that stand for them are read anew, by the
grammar of the language, and both are interpreted: moves, modes and events have to be the same.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from gcxform.diagnostics import Diagnostic, GcxformError, Location, VerificationError
from gcxform.dialect.dialect import Dialect
from gcxform.flow.translated import translated
from gcxform.modal.interpreter import Interpreter
from gcxform.modal.reader import WindowReader
from gcxform.modal.state import Reading
from gcxform.syntax.source import Source
from gcxform.system.arrays import Floats
from gcxform.toolpath.path import Toolpath

HINT = "nothing was written; let a pass write it in another way, or write for another dialect"
NEAR = 1e-5  # mm: far below what rounding does
ANGLE = 2e-4 * np.pi / 180  # rad: what rounding the angle of a helix does
ROUND = 2e-4  # mm: so far words with four decimals may be off their circle
SAME = ("kind", "feed_mode", "form", "side", "lost")
ENDS = ("M2", "M30")
LENGTH = "tool-length"


def check_spelled_out(
    written: Source, blocks: bytes, dialect: type[Dialect], reading: Reading
) -> None:
    """Check that what was written is a program of blocks. Raises VerificationError."""
    try:
        found = translated(written, dialect, reading)
        now = _path(found.text, dialect, reading, written.name)
        wanted = _path(blocks, dialect, reading, written.name)
    except GcxformError as error:
        (first, *_) = error.diagnostics
        message = f"what was written is not read: {first.message}"
        raise VerificationError((Diagnostic("GX601", message, first.where, HINT),)) from None
    for row, what in _differences(wanted, now, dialect):
        line = found.line_of(int(now.source[row]) + 1) if row < len(now) else len(found.lines)
        text = found.lines[line - 1]
        where = Location(found.name, line, 1, text, max(1, len(text)))
        message = f"what was written is another program: {what}"
        raise VerificationError((Diagnostic("GX601", message, where, HINT),))


def _path(text: bytes, dialect: type[Dialect], reading: Reading, name: str) -> Toolpath:
    interpreter = Interpreter(dialect, reading, dialect.axes, name)
    reader = WindowReader(dialect)
    return interpreter.interpret(reader.read(text), reader.table).path


def _differences(a: Toolpath, b: Toolpath, dialect: type[Dialect]) -> Iterator[tuple[int, str]]:
    """Yield the first row of each thing that differs, and what it is."""
    if len(a) != len(b):
        yield min(len(a), len(b)), f"{len(a)} moves are {len(b)}"
        return
    for name in SAME:
        yield from _first(getattr(a, name) != getattr(b, name), name)
    yield from _first(~_same(a.feed, b.feed, 1e-6 * np.abs(a.feed)), "feed")
    near = NEAR + np.maximum.accumulate(_slack(a)) if len(a) else np.zeros(0)
    yield from _first(~_same(a.end, b.end, near[:, None]).all(axis=1), "an end")
    yield from _first(~_same(a.centre, b.centre, near[:, None]).all(axis=1), "a centre")
    yield from _first(np.abs(a.sweep - b.sweep) > ANGLE + 1e-3, "a turn")
    for one, other in zip(_events(a, dialect), _events(b, dialect), strict=False):
        if one != other:
            yield min(other[0], len(b)), f"{one[1]} is {other[1]}"
    if len(_events(a, dialect)) != len(_events(b, dialect)):
        yield len(b), "events are lost, or there are more"


def _slack(path: Toolpath) -> Floats:
    """Return by how much helices and several turns, said by their angle, may end elsewhere (n,) mm.

    A round of them starts and ends as far from its centre; what is rounded in words is not. Words
    behind it leave axes where they are, so it stays so for the rows that follow.
    """
    sizes = [np.hypot(*(at[:, :2] - path.centre[:, :2]).T) for at in (path.start, path.end)]
    helix = np.nan_to_num(path.end[:, 2] - path.start[:, 2]) != 0
    helix |= path.sweep > 2 * np.pi
    slack = sizes[0] * ANGLE + np.minimum(np.abs(sizes[0] - sizes[1]), ROUND)
    return np.where(helix, np.nan_to_num(slack), 0.0)


def _events(
    path: Toolpath, dialect: type[Dialect]
) -> list[tuple[int, str, tuple[tuple[str, float], ...]]]:
    """Return what happens between moves; the end of the file is one of the program.

    A tool length that is stated again while it is in force is nothing that happens.
    """
    found, length = [], None
    for event in path.events:
        code = dialect.codes.get(event.what)
        said = event.what, event.values
        if code is None or code.group != LENGTH or said != length:
            found.append((event.row, *said))
        length = said if code is not None and code.group == LENGTH else length
    return found[:-1] if found and found[-1][1] in ENDS else found


def _same(a: Floats, b: Floats, near: Floats) -> Any:
    return (np.isnan(a) & np.isnan(b)) | (np.abs(a - b) <= near)


def _first(wrong: Any, what: str) -> Iterator[tuple[int, str]]:
    rows = np.flatnonzero(wrong)
    if len(rows):
        yield int(rows[0]), what
