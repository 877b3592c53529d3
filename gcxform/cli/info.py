"""`gcxform info`: what is in a program; the words of any file, and what they mean in a dialect."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from typing import Any

import click
import numpy as np

from gcxform.cli import VERBS
from gcxform.cli.common import options
from gcxform.cli.common.answer import answer
from gcxform.cli.common.programs import opened
from gcxform.cli.common.request import Asked
from gcxform.cli.program.features import by_code, by_path
from gcxform.cli.program.times import Times, lengths
from gcxform.cli.program.tolerant import Tolerant
from gcxform.cli.program.tools import Extents, Tools
from gcxform.diagnostics import InputError
from gcxform.dialect.dialect import Dialect
from gcxform.flow.straightened import written_out
from gcxform.flow.translated import Translated, translated_so_far
from gcxform.guess import Guess, guess_dialect
from gcxform.machine.machine import Machine
from gcxform.modal.reader import WindowReader
from gcxform.modal.state import Reading
from gcxform.plugin.registry import default_registry
from gcxform.stamps.chain import told
from gcxform.stamps.comment import stamps_in
from gcxform.syntax.scan import Window
from gcxform.syntax.shapes import Shape
from gcxform.syntax.source import Source
from gcxform.syntax.tree import CODES, Comment, Expression, Number, Statement
from gcxform.toolpath.path import FeedMode, Kind, Plane, Toolpath

FIRST = 10  # lines that are shown of those that are refused
NOT_READ = "; what stands behind it is not read"
_KINDS = {
    Kind.RAPID: "rapids",
    Kind.LINE: "lines",
    Kind.ARC_CW: "arcs cw",
    Kind.ARC_CCW: "arcs ccw",
}


@click.command("info", help=VERBS["info"], short_help=VERBS["info"])
@options.FROM
@options.reading_options
@options.FILE
def command(file: str, dialect: str | None, **asked: Any) -> None:
    """Print what is in a program; without a dialect its words, and which dialect it may be in."""
    what = Asked(**asked)
    speeds = _speeds(what.loaded_machine)
    kind, reading = what.reads(dialect) if dialect else (None, what.reading())
    with opened(file) as source:
        found: dict[str, Any] = {"file": source.name, "bytes": source.size}
        found |= {"stamps": said} if (said := told(stamps_in(source))) else {}
        if kind is None:
            guess = guess_dialect(source)
            found |= _guessed_words(source, guess, reading) | _guess(guess)
        elif kind.translator is not None:
            found |= _foreign(source, kind, reading, speeds)
        else:
            found |= _words(source, kind)
            tolerant = Tolerant(kind, _executed(source, kind, reading), reading)
            found |= _meaning(tolerant, found["codes"], speeds)
    answer(found, _text(found))


def _executed(source: Source, dialect: type[Dialect], reading: Reading) -> Source:
    """Return the blocks that a program executes; the program itself where that is not known."""
    try:
        return written_out(source, dialect, reading)
    except InputError:
        return source


def _foreign(
    source: Source, dialect: type[Dialect], reading: Reading, speeds: dict[str, float]
) -> dict[str, Any]:
    """Return what is in a program that is turned into blocks, up to what is refused of it."""
    blocks, error = translated_so_far(source, dialect, reading)
    found = _foreign_words(source, blocks, dialect)
    found |= _meaning(Tolerant(dialect, blocks, reading), found["codes"], speeds)
    for part in ("codes", "events"):
        spelled = dialect.tip_rule.spelled
        found[part] = {spelled.get(name, name): n for name, n in found[part].items()}
    for diagnostic in error.diagnostics if error else ():
        line = str(diagnostic.where.line if diagnostic.where else 0)
        found["refused"] += 1
        found["first_refused"][line] = f"{diagnostic.code} {diagnostic.message}{NOT_READ}"
    return found


def _foreign_words(source: Source, blocks: Translated, dialect: type[Dialect]) -> dict[str, Any]:
    """Return the words of a program that is turned into blocks."""
    said = _words(blocks, dialect)
    ends: Counter[str] = Counter()
    for text in source.windows():
        ends.update(_line_ends(text))
    found = {"lines": len(blocks.lines), "line_ends": dict(ends), "blocks": said["lines"]}
    return found | {name: said[name] for name in ("comments", "codes", "letters")}


def _speeds(machine: Machine | None) -> dict[str, float]:
    """Return the top speeds of the axes of a machine, as far as they are known."""
    axes = machine.axes if machine else {}
    return {name: axis.max_speed for name, axis in axes.items() if axis.max_speed is not None}


def _guessed_words(source: Source, guess: Guess, reading: Reading) -> dict[str, Any]:
    """Return the words of a program as the likeliest dialect spells them."""
    if not guess.dialects:
        return _words(source, Dialect)
    dialect = default_registry().dialects[guess.dialects[0]]
    if dialect.translator is None:
        return _words(source, dialect)
    blocks, _ = translated_so_far(source, dialect, reading)
    return _foreign_words(source, blocks, dialect)


def _guess(guess: Guess) -> dict[str, Any]:
    """Return which dialect a program may be in, with what speaks for each and against it."""
    evidence = {
        name: [f"{item.weight:+.1f} {item.what}" for item in items]
        for name, items in guess.evidence.items()
    }
    return {"guess": str(guess), "guessed": list(guess.dialects), "evidence": evidence}


def _text(found: dict[str, Any]) -> Iterator[str]:
    """Yield what was found as lines for a person."""
    for key, value in found.items():
        name = key.replace("_", " ")
        if isinstance(value, dict) and key.startswith("first_"):
            yield from (f"  line {line}: {reason}" for line, reason in value.items())
        elif key == "guessed":
            continue
        elif key == "extents":
            yield from (f"{axis:>15}  {low:g} ... {high:g}" for axis, (low, high) in value.items())
        elif key == "evidence":
            yield from (f"{name:>15}  {'; '.join(items) or '-'}" for name, items in value.items())
        elif key == "tools":
            yield from (f"{name:>15}  {_tool(use)}" for name, use in value.items())
        elif key == "features":
            yield f"{name:>15}  {', '.join(value) or '-'}"
        elif isinstance(value, dict):
            yield f"{name:>15}  {'  '.join(f'{k} {_number(n)}' for k, n in value.items()) or '-'}"
        elif isinstance(value, list):
            yield f"{name:>15}  {('; ' if key == 'stamps' else ' ').join(value) or '-'}"
        else:
            yield f"{name:>15}  {value}"


def _tool(use: dict[str, Any]) -> str:
    """Return what a tool does in a line."""
    parts = [f"{use['moves']} moves, {use['seconds']:g} s"]
    if "feed" in use:
        parts.append(f"F {use['feed'][0]:g} ... {use['feed'][1]:g}")
    if "speed" in use:
        parts.append(f"S {use['speed'][0]:g} ... {use['speed'][1]:g}")
    parts += [
        f"{axis} {low:g} ... {high:g}" for axis, (low, high) in use.get("extents", {}).items()
    ]
    return ", ".join(parts)


def _number(value: Any) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)


# --- words ---


def _words(source: Source, dialect: type[Dialect]) -> dict[str, Any]:
    """Return what can be seen without knowing what codes mean."""
    counts: Counter[str] = Counter()
    words: Counter[str] = Counter()
    ends: Counter[str] = Counter()
    odd: dict[int, str] = {}
    reader = WindowReader(dialect)
    for text in source.windows():
        window = reader.read(text)
        counts["lines"] += len(window)
        ends.update(_line_ends(text))
        for shape, number in _used(window, reader):
            _count(shape, number, counts, words)
        _note_odd(window, reader, odd)
    codes = {word: n for word, n in words.items() if word[0] in CODES and len(word) > 1}
    return {
        "lines": counts.pop("lines", 0),
        "line_ends": dict(ends),
        **{name: counts[name] for name in ("comments", "empty", "code", "not_read")},
        "codes": {code: codes[code] for code in sorted(codes, key=_by_number)},
        "letters": {word: words[word] for word in sorted(words) if len(word) == 1},
        "first_not_read": {str(line): reason for line, reason in odd.items()},
    }


def _line_ends(text: bytes) -> Counter[str]:
    both = text.count(b"\r\n")
    found = {"CRLF": both, "LF": text.count(b"\n") - both, "CR": text.count(b"\r") - both}
    return Counter({name: n for name, n in found.items() if n})


def _used(window: Window, reader: WindowReader) -> Iterator[tuple[Shape, int]]:
    """Yield the shapes of a window, and how many lines have each."""
    numbers, counts = np.unique(window.shape, return_counts=True)
    for number, count in zip(numbers.tolist(), counts.tolist(), strict=True):
        yield reader.shapes.shapes[number], count


def _count(shape: Shape, number: int, counts: Counter[str], words: Counter[str]) -> None:
    """Count what the lines of one shape hold; `code` is what would have to be run."""
    block = shape.block
    counts["not_read"] += number * (block.error is not None)
    counts["empty"] += number * (not block.text.strip())
    counts["comments"] += number * any(isinstance(item, Comment) for item in block.items)
    counts["code"] += number * any(isinstance(item, Statement) for item in block.items)
    for word in block.words:
        words[word.address] += number
        counts["code"] += number * isinstance(word.value, Expression)
        if word.address in CODES and isinstance(word.value, Number):
            words[f"{word.address}{round(word.value.value, 6):g}"] += number


def _note_odd(window: Window, reader: WindowReader, odd: dict[int, str]) -> None:
    """Note the first lines that the grammar does not accept."""
    if len(odd) >= FIRST:
        return
    wrong = [k for k, shape in enumerate(reader.shapes.shapes) if shape.block.error]
    for line in np.flatnonzero(np.isin(window.shape, wrong)).tolist()[: FIRST - len(odd)]:
        error = reader.shapes.shapes[int(window.shape[line])].block.error
        odd[window.first_line + line + 1] = f"column {error[0]}: {error[1]}" if error else ""


def _by_number(code: str) -> tuple[str, float]:
    return code[0], float(code[1:])


# --- meaning ---


def _meaning(tolerant: Tolerant, codes: dict[str, int], speeds: dict[str, float]) -> dict[str, Any]:
    """Return what a program does, as far as it can be read."""
    moves: Counter[str] = Counter()
    events: Counter[str] = Counter()
    modes: Counter[str] = Counter()
    length = {"rapid": 0.0, "feed": 0.0}
    shown: set[str] = set()
    times, extents = Times(speeds), Extents()
    tools = Tools(tolerant.dialect, set(codes))
    for _, path in tolerant.windows():
        if path is None:
            continue
        moves.update(_moves(path))
        events.update(event.what for event in path.events)
        modes.update(_modes(path))
        rapid = path.kind == Kind.RAPID
        way = lengths(path)
        length["rapid"] += float(way[rapid].sum())
        length["feed"] += float(way[~rapid].sum())
        tools.add(path, times.add(path))
        extents.add(path, np.ones(len(path), np.bool_))
        shown |= by_path(path)
    refused = tolerant.refused
    return {
        "dialect": tolerant.dialect.name,
        "moves": dict(moves),
        "length_mm": {kind: round(value, 3) for kind, value in length.items()},
        "time_s": times.report(),
        "time_without": dict(times.left_out),
        "extents": extents.found,
        "modes": {name: modes[name] for name in sorted(modes)},
        "features": sorted(shown) + by_code(codes, tolerant.dialect),
        "tools": tools.report(),
        "events": dict(events),
        "refused": len(refused) + tolerant.unread,
        "first_refused": {
            str(tolerant.source.line_of(line)): f"{refused[line].code} {refused[line].message}"
            for line in sorted(refused)[:FIRST]
        },
    }


def _moves(path: Toolpath) -> Counter[str]:
    """Count the moves of each kind."""
    kinds, numbers = np.unique(path.kind[~path.is_spline], return_counts=True)
    found = Counter({_KINDS[Kind(k)]: int(n) for k, n in zip(kinds, numbers, strict=True)})
    splines = int(path.is_spline.sum())
    return found + Counter({"splines": splines})


def _modes(path: Toolpath) -> Counter[str]:
    """Count the moves made under each of the modes that matter to a reader."""
    blocks, block = path.blocks, path.block
    pairs = (("G20", "G21", blocks.inch), ("G91", "G90", blocks.incremental))
    found: Counter[str] = Counter()
    for yes, no, flags in pairs:
        count = int(flags[block].sum())
        found.update({yes: count, no: len(path) - count})
    tables: tuple[tuple[Any, Callable[[int], str]], ...] = (
        (path.frame, lambda frame: path.frames[frame].work),
        (path.feed_mode[path.kind != Kind.RAPID], lambda mode: f"G{FeedMode(mode):d}"),
        (path.plane[path.is_arc], lambda plane: f"G{17 + Plane(plane):d}"),
    )
    for column, name in tables:
        numbers, counts = np.unique(column, return_counts=True)
        found.update({name(int(k)): int(n) for k, n in zip(numbers, counts, strict=True)})
    return Counter({name: n for name, n in found.items() if n})
