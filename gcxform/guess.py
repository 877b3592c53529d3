"""Which of the known dialects a program may be written in, and what speaks for it.

Every dialect reads the program with its own grammar and tables. What counts most is what it does
not know; the rest is custom: points, program numbers, the unit of dwells, names in comments. The
scores order the dialects and are no probabilities. Dialects that nothing tells apart are named
together; of a control and those of its kin (`Dialect.kin`) the control alone, so that a program is
not called uncertain by every control that reads a little more.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Set
from dataclasses import field
from itertools import islice
from pathlib import Path

import numpy as np

from gcxform.catalogue.unread import unread
from gcxform.dialect.dialect import EXTRUDER, LINEAR, Dialect
from gcxform.flow.signs import foreign_lines, has_signs
from gcxform.modal.meaning.meaning import Meaning
from gcxform.modal.reader import WindowReader
from gcxform.plugin.registry import default_registry
from gcxform.syntax.scan import Window
from gcxform.syntax.shapes import Shape
from gcxform.syntax.source import Source
from gcxform.syntax.tree import Comment, Number, Word
from gcxform.values import dataclass

FOREIGN = frozenset({"GX101", "GX201", "GX202", "GX203"})  # blocks the control itself refuses
WINDOWS = 2  # of the program that are looked at
HOPELESS = 0.25  # the share of foreign lines from which on no dialect fits
ALIKE = 0.5  # scores that differ by less say the same
DISTANCES = LINEAR.replace(EXTRUDER, "") + "IJK"
SHOWN = 3  # words that are named of those a dialect does not have


@dataclass(frozen=True)
class Evidence:
    """Something in a program that speaks for a dialect (weight above 0) or against it."""

    what: str
    weight: float


@dataclass(frozen=True)
class Guess:
    """The dialects a program may be in, the best guess first; none if no known dialect fits.

    `evidence` by dialect, of all that were tried; `unread` names a control that is not read and
    looks like some of them.
    """

    dialects: tuple[str, ...]
    evidence: Mapping[str, tuple[Evidence, ...]]
    unread: str = ""

    def score(self, dialect: str) -> float:
        """Return the sum of the weights of a dialect."""
        return sum(item.weight for item in self.evidence[dialect])

    def __str__(self) -> str:
        """Return the guess in words, with what speaks for it."""
        if self.unread:
            return f"none of the known dialects: it is for {self.unread}, which is not read"
        if not self.dialects:
            return "none of the known dialects"
        reasons = [e.what for e in self.evidence[self.dialects[0]] if e.weight > 0]
        return f"{' or '.join(self.dialects)} ({', '.join(reasons) or 'nothing speaks against it'})"


@dataclass
class _Seen:
    """What one dialect sees in a program."""

    lines: int = 0
    foreign: int = 0
    strange: Counter[str] = field(default_factory=Counter)
    small: bool = False
    whole_with_point: int = 0
    whole_without: int = 0
    dwells: list[tuple[str, float, int]] = field(default_factory=list)
    numbers: set[int] = field(default_factory=set)
    comments: set[str] = field(default_factory=set)


def guess_dialect(
    program: bytes | Path | Source, dialects: Mapping[str, type[Dialect]] | None = None
) -> Guess:
    """Return which dialects a program, or the file of that name, may be in.

    Two megabytes from its start are looked at. `dialects` are those to choose from, by name; all
    that are installed if not given; of several, those without a sign of their language are left
    out. Raises FileError.
    """
    if isinstance(program, Path):
        source = Source.open(program)
        with source.stream:
            return guess_dialect(source, dialects)
    source = Source.of_bytes(program) if isinstance(program, bytes) else program
    known = default_registry().dialects if dialects is None else dialects
    head = b"".join(islice(source.windows(), WINDOWS))
    choice = len(known) > 1
    tried = {name: kind for name, kind in known.items() if not choice or has_signs(head, kind)}
    kin = {name for name in tried if tried[name].kin in known}
    look = _Looks(source, head, tried)
    look.at(tried.keys() - kin)
    named = {name for name in kin if name.encode() in head.lower()}
    fits = (look.scores().keys() or known.keys()) if look.anything_against() else ()
    look.at(named | {name for name in kin if tried[name].kin in fits})
    scores = look.scores()
    others = max((score for name, score in scores.items() if name not in kin), default=-np.inf)
    near = [n for n in scores if n not in kin or scores[n] >= others + ALIKE]
    best = max((scores[name] for name in near), default=0.0)
    chosen = [name for name in near if scores[name] > best - ALIKE]
    if choice and (other := unread(head)):
        return Guess((), look.found, other)
    return Guess(tuple(sorted(chosen, key=lambda name: (-scores[name], name))), look.found)


class _Looks:
    """What dialects see in a program, and what that is evidence of, by name."""

    def __init__(self, source: Source, head: bytes, tried: Mapping[str, type[Dialect]]) -> None:
        self.source, self.head, self.tried = source, head, tried
        self.seen: dict[str, _Seen] = {}
        self.found: dict[str, tuple[Evidence, ...]] = {}

    def at(self, names: Set[str]) -> None:
        """Let dialects see the program."""
        for name in sorted(names):
            self.seen[name] = _seen(self.source, self.head, self.tried[name])
            self.found[name] = tuple(_evidence(self.tried[name], self.seen[name]))

    def scores(self) -> dict[str, float]:
        """Return the scores of the dialects that fit; none where they see nothing."""
        fits = [n for n, one in self.seen.items() if one.foreign <= HOPELESS * max(one.lines, 1)]
        if not any(self.seen[name].lines for name in fits):
            return {}
        return {name: sum(item.weight for item in self.found[name]) for name in fits}

    def anything_against(self) -> bool:
        """Whether something speaks against each dialect that fits best, or none fits."""
        scores = self.scores()
        best = [n for n in scores if scores[n] == max(scores.values())]
        return not any(all(item.weight > 0 for item in self.found[name]) for name in best)


# --- what a dialect sees ---


def _seen(source: Source, head: bytes, dialect: type[Dialect]) -> _Seen:
    seen = _Seen()
    if dialect.translator is not None:
        seen.lines, seen.foreign = foreign_lines(head, dialect)
        return seen
    reader = WindowReader(dialect)
    for text in islice(source.windows(), WINDOWS):
        window = reader.read(text)
        reader.table.update()
        numbers, counts = np.unique(window.shape, return_counts=True)
        for number, count in zip(numbers.tolist(), counts.tolist(), strict=True):
            shape = reader.shapes.shapes[number]
            if shape.block.items or shape.block.error:
                meaning = reader.table.meanings[number]
                _look(seen, shape, meaning, count)
                _numbers(seen, window, meaning, np.flatnonzero(window.shape == number))
    return seen


def _look(seen: _Seen, shape: Shape, meaning: Meaning, count: int) -> None:
    """Take the lines of one shape into account, without their numbers."""
    block = shape.block
    seen.lines += count
    if meaning.refusal is not None and meaning.refusal.code in FOREIGN:
        at = meaning.refusal.column
        seen.foreign += count
        seen.strange[block.text[at : at + meaning.refusal.width].strip()[:12] or "?"] += count
    for item in block.items:
        if isinstance(item, Word):
            seen.small |= block.text[item.start].islower()
            if item.address == "O" and isinstance(item.value, Number):
                seen.numbers.add(item.value.end - item.value.start)
        elif isinstance(item, Comment):
            seen.comments.add(block.text[item.start : item.end].lower())


def _numbers(seen: _Seen, window: Window, meaning: Meaning, lines: np.ndarray) -> None:
    """Take the numbers of the lines of one shape into account."""
    first = window.first_number[lines]
    for address, slot in meaning.slots.items():
        if address in DISTANCES:
            value, decimals = window.value[first + slot], window.decimals[first + slot]
            whole = (value % 1 == 0) & (value != 0) & (decimals <= 0)
            seen.whole_with_point += int((whole & (decimals == 0)).sum())
            seen.whole_without += int((whole & (decimals < 0)).sum())
    for event in meaning.events:
        if event.what == "DWELL":
            for address, slot in event.slots:
                at = int(first[0]) + slot
                value, decimals = float(window.value[at]), int(window.decimals[at])
                seen.dwells.append((address, value, decimals))


# --- what it means ---


def _evidence(dialect: type[Dialect], seen: _Seen) -> Iterator[Evidence]:
    """Yield what speaks for a dialect and against it."""
    if seen.foreign:
        words = " ".join(word for word, _ in seen.strange.most_common(SHOWN))
        what = f"{seen.foreign} of {seen.lines} lines it does not have: {words}"
        yield Evidence(what, -3.0 - 20.0 * seen.foreign / seen.lines)
    if seen.small and not dialect.text_rule.lower_case:
        yield Evidence("small letters", -4.0)
    yield from _points(dialect, seen)
    if seen.numbers and dialect.point_rule.required:
        yield Evidence("a program number", 1.5)
    if dialect.program_rule.number_digits in seen.numbers:
        yield Evidence(f"a program number of {dialect.program_rule.number_digits} digits", 1.0)
    if any(dialect.name in comment for comment in seen.comments):
        yield Evidence("its name in a comment", 3.0)
    for address, value, decimals in seen.dwells[:1]:
        yield from _dwell(dialect, address, value, decimals)


def _points(dialect: type[Dialect], seen: _Seen) -> Iterator[Evidence]:
    """Yield what the points of whole numbers say."""
    if dialect.point_rule.required and seen.whole_without:
        yield Evidence("distances without a point", -1.5)
    elif dialect.point_rule.required and seen.whole_with_point:
        yield Evidence("a point in every distance", 2.0)


def _dwell(dialect: type[Dialect], address: str, value: float, decimals: int) -> Iterator[Evidence]:
    """Yield what the number of a dwell says of its unit: hardly anybody waits for minutes."""
    if address not in dialect.point_rule.dwell:
        return
    seconds = value * dialect.point_rule.seconds(address, decimals >= 0)
    if 0.04 <= seconds < 100:
        yield Evidence(f"a dwell of {seconds:g} s", 1.0)
    else:
        yield Evidence(f"a dwell of {seconds:g} s", -1.0)
