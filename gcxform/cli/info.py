"""`gcxform info`: what is in a program; the words of any file, and what they mean in a dialect."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Iterator
from typing import Any

import click
import numpy as np

from gcxform.cli import VERBS, options
from gcxform.cli.asked import Asked
from gcxform.cli.programs import opened
from gcxform.cli.tolerant import Tolerant
from gcxform.dialect import LINEAR, Dialect
from gcxform.modal.reader import WindowReader
from gcxform.registry import default_registry
from gcxform.source import Source
from gcxform.syntax.scan import Window
from gcxform.syntax.shapes import CODES, Shape
from gcxform.syntax.tree import Comment, Expression, Number, Statement
from gcxform.toolpath.circles import arc_extremes, radius_and_angle
from gcxform.toolpath.path import FeedMode, Kind, Plane, Toolpath

FIRST = 10  # lines that are shown of those that are refused
_KINDS = {
    Kind.RAPID: "rapids",
    Kind.LINE: "lines",
    Kind.ARC_CW: "arcs cw",
    Kind.ARC_CCW: "arcs ccw",
}


@click.command("info", help=VERBS["info"], short_help=VERBS["info"])
@options.FROM
@options.reading_options
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@options.FILE
def command(file: str, dialect: str | None, as_json: bool, **asked: Any) -> None:
    """Print what is in a program; without a dialect its words only."""
    reading = Asked(**asked).reading()
    kind = default_registry().dialect(dialect) if dialect else None
    with opened(file) as source:
        found = {"file": source.name, "bytes": source.size, **_words(source, kind or Dialect)}
        if kind is not None:
            found |= _meaning(Tolerant(kind, source, reading))
    click.echo(json.dumps(found, indent=2) if as_json else "\n".join(_text(found)))


def _text(found: dict[str, Any]) -> Iterator[str]:
    """Yield what was found as lines for a person."""
    for key, value in found.items():
        name = key.replace("_", " ")
        if isinstance(value, dict) and key.startswith("first_"):
            yield from (f"  line {line}: {reason}" for line, reason in value.items())
        elif key == "extents":
            yield from (f"{axis:>15}  {low:g} ... {high:g}" for axis, (low, high) in value.items())
        elif isinstance(value, dict):
            yield f"{name:>15}  {'  '.join(f'{k} {_number(n)}' for k, n in value.items()) or '-'}"
        elif isinstance(value, list):
            yield f"{name:>15}  {' '.join(value) or '-'}"
        else:
            yield f"{name:>15}  {value}"


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


def _meaning(tolerant: Tolerant) -> dict[str, Any]:
    """Return what a program does, as far as it can be read."""
    moves: Counter[str] = Counter()
    events: Counter[str] = Counter()
    modes: Counter[str] = Counter()
    tools: dict[str, None] = {}
    lengths: Counter[str] = Counter()
    extents = _Extents()
    for _, path in tolerant.windows():
        if path is None:
            continue
        kinds, numbers = np.unique(path.kind, return_counts=True)
        moves.update({_KINDS[Kind(k)]: int(n) for k, n in zip(kinds, numbers, strict=True)})
        events.update(event.what for event in path.events)
        tools.update({f"T{e.values[0][1]:g}": None for e in path.events if e.what == "T"})
        modes.update(_modes(path))
        lengths.update(_lengths(path))
        extents.add(path)
    refused = tolerant.refused
    return {
        "dialect": tolerant.dialect.name,
        "moves": dict(moves),
        "length_mm": {kind: round(length, 3) for kind, length in lengths.items()},
        "extents": extents.found,
        "modes": {name: modes[name] for name in sorted(modes)},
        "tools": list(tools),
        "events": dict(events),
        "refused": len(refused) + tolerant.unread,
        "first_refused": {
            str(line): f"{refused[line].code} {refused[line].message}"
            for line in sorted(refused)[:FIRST]
        },
    }


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


def _lengths(path: Toolpath) -> dict[str, float]:
    """Return how far rapids and feed moves go (mm), where their ends are known."""
    linear = [k for k, axis in enumerate(path.axes) if axis in LINEAR]
    way = (path.end - path.start)[:, linear]
    length = np.sqrt(np.nansum(way**2, axis=1))
    if path.has_arcs:
        arcs = np.flatnonzero(path.is_arc)
        first, last, _ = radius_and_angle(path, arcs)
        normal = np.array([plane.axes[2] for plane in Plane])[path.plane[arcs]]
        rise = np.nan_to_num(way[arcs, normal])
        length[arcs] = np.hypot((first + last) / 2 * path.sweep[arcs], rise)
    rapid = path.kind == Kind.RAPID
    return {"rapid": float(length[rapid].sum()), "feed": float(length[~rapid].sum())}


class _Extents:
    """The least and the largest position of each axis."""

    def __init__(self) -> None:
        self.found: dict[str, list[float]] = {}

    def add(self, path: Toolpath) -> None:
        """Take the ends of moves, and the sides of arcs, into account."""
        for axis, column in zip(path.axes, path.end.T, strict=True):
            self._take(axis, column)
        if path.has_arcs:
            points, _ = arc_extremes(path)
            for axis, column in zip("XYZ", points.T, strict=True):
                self._take(axis, column)

    def _take(self, axis: str, values: Any) -> None:
        known = values[np.isfinite(values)]
        if len(known):
            low, high = self.found.get(axis, [np.inf, -np.inf])
            low, high = min(low, float(known.min())), max(high, float(known.max()))
            self.found[axis] = [round(low, 6), round(high, 6)]
