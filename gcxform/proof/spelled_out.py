"""Proves a program that was written in a language of its own: it is the one that was proved.

The blocks were proved as they were written. The lines that stand for them are read anew, by the
grammar of the language, and both are interpreted: moves, modes and events have to be the same.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from decimal import Decimal
from typing import Any

import numpy as np

from gcxform.diagnostics import Diagnostic, GcxformError, InputError, Location, VerificationError
from gcxform.dialect.dialect import Dialect
from gcxform.flow.speller import ASIDE, Speller
from gcxform.flow.translated import Translated, translated
from gcxform.modal.interpreter import Interpreter
from gcxform.modal.reader import WindowReader
from gcxform.modal.state import Reading
from gcxform.syntax.source import Source
from gcxform.system.arrays import Floats
from gcxform.toolpath.frames import Frame
from gcxform.toolpath.path import Event, Form, Kind, Plane, Toolpath

HINT = "nothing was written; let a pass write it in another way, or write for another dialect"
LENGTH = "the length of a tool counts from its change on, and here it should not"
LOST = "what is known of where axes stand"
LATE = "a work offset is named behind moves, and which one these count from is not known"
NAMED = "name it in front of the first move, if it is the one that they count from"
CALLED = "call it by G43 H in the block behind the change; or say in the machine file that it is 0"
OPEN = {LENGTH: CALLED, LATE: NAMED}
"""What a language cannot say, and no fault: with the way out."""
NEAR = 1e-5  # mm: far below what rounding does
ANGLE = 2e-4 * np.pi / 180  # rad: what rounding the angle of a helix does
ROUND = 4e-4  # mm: so far a centre with the decimals of the control may lead beside an end
SHORT = 8  # times, of a chord that is not shorter than an eighth of the radius
SAME = ("kind", "feed_mode", "form", "side")
ENDS = ("M2", "M30")
OFFSETS = "frame"
COUNTS = ("tool-length", OFFSETS)
"""Groups of codes that say how words count. Between two moves it does not matter when they do, or
how often they are stated, and a move in coordinates of the machine does without them."""
MACHINE = "machine"
"""The act of codes for a move in coordinates of the machine."""
ALONG = 2
"""The axis of tool lengths: Z."""
ASIDES = re.compile(rb"\(%b([^()]*)\)" % ASIDE.encode())
Values = tuple[tuple[str, float], ...]


def check_spelled_out(
    written: Source, blocks: bytes, dialect: type[Dialect], reading: Reading
) -> Translated:
    """Check that what was written is a program of blocks, and return it. Raises GcxformError."""
    try:
        found = translated(written, dialect, reading)
        now = _path(found.text, dialect, reading, written.name)
        wanted = _path(blocks, dialect, reading, written.name)
    except GcxformError as error:
        (first, *_) = error.diagnostics
        message = f"{dialect.name} would not read what is written: {first.message}"
        raise InputError((Diagnostic("GX501", message, first.where, first.hint),)) from None
    told = blocks.splitlines(), found.text.splitlines()
    if reading.asides and ASIDES.findall(blocks) != ASIDES.findall(found.text):
        message = "what was written is another program: what goes along does not"
        raise VerificationError.one("GX601", message, Location(written.name))
    wrong = (*_differences(wanted, now, dialect, *told), *_places(wanted, now, dialect, *told))
    for row, what in wrong:
        line = found.line_of(int(now.source[row]) + 1) if row < len(now) else len(found.lines)
        text = found.lines[line - 1]
        where = Location(found.name, line, 1, text, max(1, len(text)))
        if what in OPEN:
            raise InputError((Diagnostic("GX501", what, where, OPEN[what]),))
        message = f"what was written is another program: {what}"
        raise VerificationError((Diagnostic("GX601", message, where, HINT),))
    return found


def _path(text: bytes, dialect: type[Dialect], reading: Reading, name: str) -> Toolpath:
    interpreter = Interpreter(dialect, reading, dialect.axes, name)
    reader = WindowReader(dialect)
    return interpreter.interpret(reader.read(text), reader.table).path


def _differences(
    a: Toolpath, b: Toolpath, dialect: type[Dialect], one: list[bytes], other: list[bytes]
) -> Iterator[tuple[int, str]]:
    """Yield the first row of each thing that differs, and what it is."""
    if len(a) != len(b):
        yield min(len(a), len(b)), f"{len(a)} moves are {len(b)}"
        return
    was, is_ = (np.array([f.tool for f in path.frames])[path.frame] for path in (a, b))
    frames = _frames(a, dialect), _frames(b, dialect)
    counts = (frames[0] == "") != (frames[1] == "")
    rows = np.flatnonzero((frames[0] != frames[1]) & ~counts)
    counts[rows] = [_counts(row, a, b, one, other) for row in rows.tolist()]
    yield from _first(counts & ~_same(was, is_, 0.0).all(axis=1), LENGTH)
    for name in SAME:
        yield from _first(getattr(a, name) != getattr(b, name), name)
    alone = (frames[0] != frames[1]) & ~counts  # no word of these rows is along the tool
    alone[_led_by_the_machine(a, b, dialect, one, other)] = True
    lost = np.flatnonzero(_lost(a, b, alone))[:1]
    late = {e.row for e in a.events if _group(e, dialect) == OFFSETS and e.row}
    yield from ((row, LATE if row in late else LOST) for row in lost.tolist())
    cuts = a.kind != Kind.RAPID
    yield from _first(cuts & ~_same(a.feed, b.feed, 1e-6 * np.abs(a.feed)), "feed")
    near = NEAR + np.maximum.accumulate(_slack(a)) if len(a) else np.zeros(0)
    same = _same(a.end, b.end, near[:, None])
    same[alone, ALONG] = True
    yield from _first(~same.all(axis=1), "an end")
    beside = near + np.minimum(_off(a) * _way(a), dialect.arc_rule.absolute)
    about = _same(a.centre, b.centre, beside[:, None])
    about[alone & (a.plane == Plane.XY) & (b.plane == Plane.XY), ALONG] = True
    yield from _first(~about.all(axis=1), "a centre")
    yield from _first((a.side != 0) & ~_same(a.radius, b.radius, 0.0), "the radius of a tool")
    yield from _first(np.abs(a.sweep - b.sweep) > ANGLE + 1e-3, "a turn")
    yield from _first(counts, "a work offset, or a length")
    acts = _acts(a, dialect), _acts(b, dialect)
    for act, there in zip(*acts, strict=False):
        if act != there and not _same_side(act, there, dialect):
            yield min(there[0], len(b)), f"{act[1]} is {there[1]}"
    if len(acts[0]) != len(acts[1]):
        yield len(b), "events are lost, or there are more"


def _lost(a: Toolpath, b: Toolpath, alone: Any = False) -> Any:
    """Return before which moves it is known in one path alone where an axis stands (n,).

    Along a tool whose length nobody has said, one is where that begins to count or ends to, or
    another does: by G49 and G43 about a move in the machine, which is said without them where it
    counts all along; or by the change of the tool and not by G43 behind it. `alone` (n,) are moves
    behind which it may be known in one path alone where the tool stands along itself.
    """
    differ = np.isnan(a.start) != np.isnan(b.start)
    differ[1:, ALONG] &= ~np.broadcast_to(alone, len(differ))[:-1]
    for path in (a, b):
        open_ = [f.origin[ALONG] if np.isnan(f.tool[ALONG]) else "" for f in path.frames]
        counts = np.array([open_.index(name) for name in open_], np.int64)[path.frame]
        begins = np.diff(counts, prepend=counts[:1]) != 0
        differ[begins, ALONG] = False
    return differ.any(axis=1)


def _same_side(
    one: tuple[int, str, Values], other: tuple[int, str, Values], dialect: type[Dialect]
) -> bool:
    """Whether acts are a side of the contour, once with the tool in the spindle for want of D.

    Radii are compared move by move.
    """
    code = dialect.codes.get(one[1])
    side = code is not None and code.group == "cutter-comp"
    return side and not one[2] and one[:2] == other[:2]


def _counts(row: int, a: Toolpath, b: Toolpath, one: list[bytes], other: list[bytes]) -> bool:
    """Whether words of a row, whose frames differ, count otherwise.

    A tool length that is along an axis which a plain block does not name counts in none of them.
    """
    words = {*_words(one[a.source[row]]), *_words(other[b.source[row]])}
    named = [k for k, axis in enumerate(a.axes) if axis in words]
    frames = a.frames[a.frame[row]], b.frames[b.frame[row]]
    return a.form[row] != Form.PLAIN or len({_of(each, named) for each in frames}) > 1


def _of(frame: Frame, axes: list[int]) -> str:
    """Return what of a frame counts in a block that names some axes; all of it where it turns."""
    if frame.matrix is not None or frame.following or frame.polar:
        return repr(frame)
    tool = [frame.tool[k] for k in axes if k < len(frame.tool)]
    of = [(frame.shift[k], frame.origin[k]) for k in axes]
    called = frame.called and ALONG in axes
    return repr((frame.work, frame.diameter, frame.following, tool, of, called))


def _places(
    a: Toolpath, b: Toolpath, dialect: type[Dialect], one: list[bytes], other: list[bytes]
) -> Iterator[tuple[int, str]]:
    """Yield the first move in the machine that goes elsewhere: where that is, no column says."""
    for (row, line), (_, there) in zip(_machine(a, dialect), _machine(b, dialect), strict=False):
        if _words(one[line]) != _words(other[there]):
            yield row, "a place in the machine"
            return


def _led_by_the_machine(
    a: Toolpath, b: Toolpath, dialect: type[Dialect], one: list[bytes], other: list[bytes]
) -> list[int]:
    """Return the rows in which one path alone knows where the tool stands along itself.

    A move in the machine has led there in both (`_places` compares them), under a length that
    nobody has said in one of them alone; or it names other axes, and the tool stands where it stood
    in both. It stands there until a block names that axis again.
    """
    found: list[int] = []
    open_ = np.isnan(a.end[:, ALONG]) != np.isnan(b.end[:, ALONG])
    both = {row for row, _ in _machine(a, dialect)} & {row for row, _ in _machine(b, dialect)}
    for row in sorted(both) if open_.any() else ():
        led, left = row, False
        while led < len(a) and open_[led] and not left:
            found.append(led)
            led += 1
            words = (one[a.source[led]], other[b.source[led]]) if led < len(a) else ()
            left = any(a.axes[ALONG] in _words(each) for each in words)
    return found


def _machine(path: Toolpath, dialect: type[Dialect]) -> list[tuple[int, int]]:
    """Return the moves in coordinates of the machine, with the lines of their blocks from 0.

    A block of one that names no axis, as the axes stand there already, has no row.
    """
    found = [e for e in path.events if _act(e, dialect) == MACHINE and _moves(e, path)]
    return [(e.row, e.line) for e in found]


def _moves(event: Event, path: Toolpath) -> bool:
    """Whether the block of an event moves something."""
    return event.row < len(path) and int(path.source[event.row]) == event.line


def _words(block: bytes) -> dict[str, Decimal]:
    words = Speller.parts(block.decode("latin-1"))[1]
    return {letter: Decimal(text) for letter, text in words if letter not in "GMNFST"}


def _slack(path: Toolpath) -> Floats:
    """Return by how much helices and several turns, said by their angle, may end elsewhere (n,) mm.

    A round of them starts and ends as far from its centre; what is rounded in words is not. Words
    behind it leave axes where they are, so it stays so for the rows that follow.
    """
    sizes = np.hypot(*(path.start[:, :2] - path.centre[:, :2]).T)
    off = _off(path)
    slack = sizes * ANGLE + np.where(off > NEAR, ROUND, off)
    return np.where(_wound(path), np.nan_to_num(slack), 0.0)


def _wound(path: Toolpath) -> Any:
    """Return which rows are helices, or several turns (n,)."""
    helix = np.nan_to_num(path.end[:, 2] - path.start[:, 2]) != 0
    return helix | (path.sweep > 2 * np.pi)


def _way(path: Toolpath) -> Any:
    """Return how many times as far as an end is off its circle the centre may be moved (n,).

    Along the chord of half a turn or less that moves no place of the arc further than its end.
    """
    return np.where(path.sweep <= np.pi + ANGLE, SHORT, 1)


def _off(path: Toolpath) -> Floats:
    """Return by how much the end of a helix is off the circle about its centre (n,) mm.

    The centre may be said as far beside, where the circle then goes through both ends.
    """
    sizes = [np.hypot(*(at[:, :2] - path.centre[:, :2]).T) for at in (path.start, path.end)]
    return np.where(_wound(path), np.nan_to_num(np.abs(sizes[0] - sizes[1])), 0.0)


def _acts(path: Toolpath, dialect: type[Dialect]) -> list[tuple[int, str, Values]]:
    """Return what happens between moves, but for what only says how words count: see `_frames`.

    The end of the file is one of the program, and no tolerance of the path is what there is before
    the first one, or the first exact stop.
    """
    found = [
        (e.row, e.what, e.values)
        for e in path.events
        if _group(e, dialect) not in COUNTS and (_act(e, dialect) != MACHINE or _moves(e, path))
    ]
    bound = [k for k, each in enumerate(found) if _is_bound(each, dialect)]
    loose = min(bound, default=len(found))
    found = [each for k, each in enumerate(found) if k >= loose or each[1] != "G64"]
    found = [*_named_once(found)]
    return found[:-1] if found and found[-1][1] in ENDS else found


def _is_bound(act: tuple[int, str, Values], dialect: type[Dialect]) -> bool:
    """Whether corners are no longer rounded however the control has it: stops, or a tolerance."""
    exact = dialect.codes.get(act[1])
    stops = exact is not None and exact.group == "path" and exact.act.startswith("exact")
    return stops or (act[1] == "G64" and any(value for _, value in act[2]))


def _named_once(acts: list[tuple[int, str, Values]]) -> Iterator[tuple[int, str, Values]]:
    """Yield acts without a T of the tool that is named already: M6 by itself says none there."""
    named: Values | None = None
    for act in acts:
        if act[1] == "T" and act[2] == named:
            continue
        named = {"T": act[2], "M6": None}.get(act[1], named)
        yield act


def _frames(path: Toolpath, dialect: type[Dialect]) -> Any:
    """Return by which frame the words of each move count (n,): by none in that of the machine.

    Whether a length of nothing was called does not matter to them.
    """
    frames = (
        repr(replace(frame, called=False, valued=False, instead=False)) for frame in path.frames
    )
    found = np.array(["", *frames])[path.frame + 1]
    found[[row for row, _ in _machine(path, dialect)]] = ""
    return found


def _group(event: Event, dialect: type[Dialect]) -> str:
    code = dialect.codes.get(event.what)
    return "" if code is None else code.group


def _act(event: Event, dialect: type[Dialect]) -> str:
    code = dialect.codes.get(event.what)
    return "" if code is None else code.act


def _same(a: Floats, b: Floats, near: Any) -> Any:
    return (np.isnan(a) & np.isnan(b)) | (np.abs(a - b) <= near)


def _first(wrong: Any, what: str) -> Iterator[tuple[int, str]]:
    rows = np.flatnonzero(wrong)
    if len(rows):
        yield int(rows[0]), what
