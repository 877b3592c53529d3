"""Whether a program ends as its control asks for: with M2 or M30, or between two percent signs.

This is asked of whole files only (`gcxform check`): a piece of a program may well be read. What is
written for another control gets what its end lacks: percent signs around it. They end the file and
reset nothing, so they do nothing that the program does not.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TypeVar

import numpy as np

from gcxform.diagnostics import Diagnostic, InputError, Location
from gcxform.dialect.dialect import Dialect
from gcxform.modal.meaning.tables import MeaningTable
from gcxform.modal.reader import WindowReader
from gcxform.syntax.scan import Window
from gcxform.syntax.source import Source, lines_in
from gcxform.values import dataclass

Some = TypeVar("Some")
SIGN = re.compile(rb"%|[Mm][ \t0]*(?:2|3[ \t]*0)")
"""What every line has that may end a program; most windows of a long program have none."""


@dataclass(frozen=True, slots=True)
class Frame:
    """The percent signs that a program lacks for another control: before it, and behind it."""

    before: bool = False
    behind: bool = False

    def put(self, text: bytes, first: bool, last: bool) -> tuple[bytes, int, int]:
        """Return a text with its signs, and how many lines are new before and behind it."""
        end = b"\r\n" if b"\r\n" in text else b"\n"
        before, behind = self.before and first, self.behind and last
        if before:
            text = b"%" + end + text
        if behind and text and not text.endswith((b"\n", b"\r")):
            text += end
        return text + (b"%" + end) * behind, int(before), int(behind)


def frame_for(
    source: Source, dialect: type[Dialect], target: type[Dialect], executes: bool = False
) -> Frame:
    """Return what a program of one control lacks at its ends for another.

    `executes`: blocks with a slash are executed, so that one of them may end the program; what is
    written then ends there too, with a block that the other control may skip.
    Raises InputError where a percent sign in the middle would end it there.
    """
    if dialect.name == target.name or not target.program_rule.needs_end:
        return Frame()
    ending, reader = Ending(target, source.name), WindowReader(dialect)
    for text in source.windows():
        if SIGN.search(text) is None:
            ending.pass_over(text)
            reader.lines += lines_in(text)
            continue
        window = reader.read(text)
        reader.table.update()
        ends = executes & reader.table.flag("ends", window.shape)
        ends = ends & reader.table.flag("deleted", window.shape)
        ending.look(window, reader.table, int(np.argmax(ends)) + 1 if ends.any() else None)
        if ends.any() and not ending.ended:
            break
    if not ending.wrong:
        return Frame()
    if not ending.ended:
        return Frame(before=not ending.framed, behind=True)
    if ending.goes_on:
        where = ending.wrong[0].where
        message = f"{target.name} would end the program at this % sign"
        raise InputError.one(
            "GX222", message, where, "take out what stands before it, or behind it"
        )
    return Frame(before=True)


def with_ends(windows: Iterator[Some], looks: bool) -> Iterator[tuple[Some, bool, bool]]:
    """Yield windows with whether they are the first and the last one, if that is looked for."""
    first = True
    before: Some | None = None
    for window in windows:
        if not looks:
            yield window, first, False
            first = False
            continue
        if before is not None:
            yield before, first, False
            first = False
        before = window
    if before is not None:
        yield before, first, True


class Ending:
    """Is shown the windows of a program in order, and says what is wrong with its end so far.

    `goes_on`: something stands behind a percent sign that closes what none has opened.
    """

    def __init__(self, dialect: type[Dialect], file: str = "-") -> None:
        self.dialect = dialect
        self.file = file
        self.ended = not dialect.program_rule.needs_end
        self.framed = False
        self.blank = True
        self.lines = 0
        self.goes_on = False
        self._lone: Diagnostic | None = None

    def look(self, window: Window, table: MeaningTable, lines: int | None = None) -> None:
        """Look for the end in a window, or its first lines; the table has what they mean."""
        self.lines += len(window)
        percent = table.flag("percent", window.shape)
        ends = table.flag("ends", window.shape) & ~table.flag("deleted", window.shape)
        seen = 0
        for line in np.flatnonzero((percent | ends)[:lines]).tolist():
            if self.ended:
                self.goes_on |= self._lone is not None
                return
            self.blank = self.blank and not any(window.line(k).strip() for k in range(seen, line))
            seen = line
            self._sign(window, line, bool(percent[line]))
            after = range(line + 1, len(window))
            self.goes_on = self._lone is not None and any(window.line(k).strip() for k in after)
        self.blank = self.blank and not any(window.line(k).strip() for k in range(len(window)))

    def _sign(self, window: Window, line: int, percent: bool) -> None:
        """Take a percent sign or the end of the program."""
        if percent and self.blank:
            self.framed, self.blank = True, False
            return
        self.ended = True
        if percent and not self.framed:
            text = window.line(line).decode("latin-1")
            where = Location(self.file, window.first_line + line + 1, 1, text, 1)
            message = f"{self.dialect.name} refuses a % sign that closes what no % sign has opened"
            self._lone = Diagnostic("GX222", message, where, "write M2 in its place")

    def pass_over(self, text: bytes) -> None:
        """Take note of a text in which nothing can end a program."""
        self.lines += lines_in(text)
        self.blank = self.blank and not text.strip()
        self.goes_on |= self._lone is not None and bool(text.strip())

    @property
    def wrong(self) -> tuple[Diagnostic, ...]:
        """What the control would refuse if the program were over here; nothing if it takes it."""
        if self._lone is not None:
            return (self._lone,)
        if self.ended:
            return ()
        message = f"{self.dialect.name} refuses a program that has no end"
        hint = "close it with M2" + (", or with a % sign" if self.framed else "")
        return (Diagnostic("GX222", message, Location(self.file, self.lines), hint),)
