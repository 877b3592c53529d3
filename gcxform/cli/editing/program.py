"""A program in an editor: what is wrong with it, what a block does, what is where.

A program is read whole after a change; ten thousand blocks take some hundredths of a second, for
the shapes of lines that were met before are kept. So an answer is always that of a fresh reading,
and nothing has to be mended. What a block does is asked with all before it read; readings of what
has not changed are kept for that, one for every two thousand lines.
"""

from __future__ import annotations

import copy
import re
from collections.abc import Iterator
from dataclasses import field
from functools import cached_property
from pathlib import Path
from threading import Lock
from typing import Final, NamedTuple

from gcxform.cli.check import (
    ENOUGH,
    speaks_against,
    speaks_against_blocks,
    speaks_against_reading,
)
from gcxform.cli.editing.mentions import Mention, Mentions, Symbol, outline
from gcxform.cli.editing.shop import Found, Shop
from gcxform.cli.editing.text import Text
from gcxform.cli.program.block import as_executed, executed, foreign, in_words
from gcxform.cli.program.tolerant import Tolerant
from gcxform.diagnostics import Diagnostic, GcxformError, InputError
from gcxform.flow.executed import WrittenOut
from gcxform.flow.translated import Translated, translated_so_far
from gcxform.modal.reader import Tables
from gcxform.modal.state import State
from gcxform.pipeline.pipeline import Pipeline
from gcxform.syntax.source import WINDOW, Source
from gcxform.values import dataclass

STRIDE: Final = 2000  # lines between two states that are kept
_END: Final = re.compile(rb"\r\n|\n|\r")


class Stop(NamedTuple):
    """A reading that has come so far: lines, bytes, the state there, and what was refused."""

    lines: int
    at: int
    state: State
    refused: dict[int, Diagnostic]


@dataclass
class Kept:
    """What stays of a program from one version to the next; the lock is for who reads with it."""

    tables: Tables = field(default_factory=Tables)
    mentions: Mentions = field(default_factory=Mentions)
    stops: list[Stop] = field(default_factory=list)
    text: bytes = b""
    read_as: object = None
    lock: Lock = field(default_factory=Lock)


@dataclass
class Program:
    """One version of a program, in the file `path`; `kept` goes on to the next."""

    path: str
    text: Text
    shop: Shop
    kept: Kept = field(default_factory=Kept)

    def changed(self, text: Text) -> Program:
        """Return the next version."""
        return Program(self.path, text, self.shop, self.kept)

    @property
    def found(self) -> Found:
        """The pipeline by which it is read, or why there is none."""
        return self.shop.pipeline(self.path, self.text.data)

    @cached_property
    def lines(self) -> list[bytes]:
        """The lines, without their ends."""
        return lines_of(self.text.data)

    def source(self) -> Source:
        """Return the program as a source, which lies where its file does."""
        found = Source.of_bytes(self.text.data, self.path)
        found.folder, found.suffix = Path(self.path).parent, Path(self.path).suffix
        return found

    # --- what is wrong ---

    def findings(self) -> list[Diagnostic]:
        """Return what speaks against reading the program."""
        pipeline, wrong = self.found[:2]
        if pipeline is None or not self.text.data.strip():
            return list(wrong)
        try:
            with self.kept.lock:
                found = self._against(pipeline)
                return [each for _, each in zip(range(ENOUGH), found, strict=False)]
        except GcxformError as error:
            return list(error.diagnostics)

    def _against(self, pipeline: Pipeline) -> Iterator[Diagnostic]:
        if pipeline.read_as.translator is None:
            yield from speaks_against_reading(pipeline, self.source(), [], self.kept.tables)
            return
        blocks, error = self._translated
        found = speaks_against_blocks(pipeline, blocks, [], self.kept.tables)
        yield from found if error is None else error.diagnostics

    def checked(self) -> list[Diagnostic] | None:
        """Return what `check` finds, with the passes and the writing; None for a long program."""
        pipeline, wrong = self.found[:2]
        if pipeline is None or len(self.text.data) > WINDOW or not self.text.data.strip():
            return list(wrong) if pipeline is None else None
        try:
            return speaks_against(pipeline, self.source())
        except GcxformError as error:
            return list(error.diagnostics)

    # --- what a block does ---

    @cached_property
    def _translated(self) -> tuple[Translated, InputError | None]:
        """The blocks of a program in a language of its own, and why there are no more."""
        pipeline = self.found.pipeline
        assert pipeline is not None
        return translated_so_far(self.source(), pipeline.read_as, pipeline.machine_reading)

    @cached_property
    def _executed(self) -> WrittenOut | None:
        """The blocks that a program with calls or loops executes."""
        pipeline = self.found.pipeline
        assert pipeline is not None
        return executed(self.source(), pipeline.read_as, pipeline.machine_reading)

    def explained(self, number: int) -> list[str]:
        """Return what a line, from 0, does, in words; nothing for one that is not there."""
        pipeline = self.found.pipeline
        if pipeline is None or not (0 <= number < len(self.lines) and self.lines[number].strip()):
            return []
        asked = number + 1, pipeline.read_as, pipeline.machine_reading, self.kept.tables
        try:
            with self.kept.lock:
                if pipeline.read_as.translator is not None:
                    return foreign(self.source(), self._translated, *asked)
                if (ran := self._executed) is not None:
                    return as_executed(self.source(), ran, *asked)
                return self._plain(pipeline, number)
        except GcxformError as error:
            return [each.message for each in error.diagnostics]

    def _plain(self, pipeline: Pipeline, number: int) -> list[str]:
        """Return what a line of a program without calls does: all before it has been read."""
        source = self.source()
        tolerant = Tolerant(pipeline.read_as, source, pipeline.machine_reading, self.kept.tables)
        first = self._stop_before(tolerant, pipeline, number)
        data, starts = self.text.data, self._starts
        for line in range(first.lines, number, STRIDE):
            end = min(line + STRIDE, number)
            tolerant.window(data[starts[line] : starts[end]])
            if end % STRIDE == 0:
                self.kept.stops.append(_stop(tolerant, starts[end]))
        return in_words(tolerant, data[starts[number] : starts[number + 1]], number + 1)

    @cached_property
    def _starts(self) -> list[int]:
        """Where lines start, in bytes, and the end."""
        ends = (found.end() for found in _END.finditer(self.text.data))
        return [0, *ends, len(self.text.data)]

    def _stop_before(self, tolerant: Tolerant, pipeline: Pipeline, number: int) -> Stop:
        """Set a reader to the last state before a line that is that of this text, and return it."""
        kept, data = self.kept, self.text.data
        read_as = (pipeline.read_as, pipeline.machine_reading, tolerant.interpreter.axes)
        if kept.read_as != read_as:
            kept.stops, kept.read_as = [], read_as
        while kept.stops and data[: kept.stops[-1].at] != kept.text[: kept.stops[-1].at]:
            kept.stops.pop()
        kept.text = data
        first = Stop(0, 0, tolerant.interpreter.state, {})
        before = [stop for stop in kept.stops if stop.lines <= number] or [first]
        last = before[-1]
        tolerant.interpreter.state = copy.deepcopy(last.state)
        tolerant.reader.lines = last.lines
        tolerant.refused.update(last.refused)
        return last

    # --- what is where ---

    @cached_property
    def mentions(self) -> list[tuple[int, Mention]]:
        """What its lines define and name."""
        return self.kept.mentions.of(self.lines)

    def symbols(self) -> list[Symbol]:
        """Return its parts."""
        return outline(self.mentions, len(self.lines))


def lines_of(data: bytes) -> list[bytes]:
    """Return the lines of a program without their ends."""
    return _END.split(data)


def _stop(tolerant: Tolerant, at: int) -> Stop:
    state = copy.deepcopy(tolerant.interpreter.state)
    return Stop(tolerant.reader.lines, at, state, dict(tolerant.refused))
