"""A document of an editor: its lines, and places in the units that the protocol counts.

Those are UTF-16 units, if the editor does not prefer bytes or characters.
A line ends with LF, CRLF or CR, for an editor as for our reader. The program is read as UTF-8, as
it would be saved; columns of diagnostics are bytes then.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from functools import cached_property
from typing import Final, NamedTuple

from gcxform.values import dataclass

_END: Final = re.compile(r"\r\n|\n|\r")
UNITS: Final = {"utf-8": ("utf-8", 1), "utf-16": ("utf-16-le", 2), "utf-32": ("utf-32-le", 4)}
"""How a text is encoded to count its units, and the bytes of one."""


class Place(NamedTuple):
    """A place: a line and a column in units, both from 0."""

    line: int
    column: int


class Span(NamedTuple):
    """From one place up to another."""

    start: Place
    end: Place


class Edit(NamedTuple):
    """A text in the place of a span."""

    span: Span
    text: str


@dataclass(frozen=True)
class Text:
    """The text of a document, a value: a change gives another one."""

    text: str
    counts: str = "utf-16"

    @cached_property
    def starts(self) -> list[int]:
        """Where lines start, as offsets; the last line may be empty."""
        return [0, *(found.end() for found in _END.finditer(self.text))]

    @cached_property
    def data(self) -> bytes:
        """The bytes of the program."""
        return self.text.encode("utf-8", "surrogatepass")

    def __len__(self) -> int:
        return len(self.starts)

    def line(self, number: int) -> str:
        """Return a line, from 0, without its end; "" for one that is not there."""
        if not 0 <= number < len(self.starts):
            return ""
        start = self.starts[number]
        found = _END.search(self.text, start)
        return self.text[start : found.start() if found else len(self.text)]

    def offset(self, place: Place) -> int:
        """Return the offset of a place; beyond a line it is its end, beyond the text the end."""
        if place.line < 0:
            return 0
        if place.line >= len(self.starts):
            return len(self.text)
        line = self.line(place.line)
        return self.starts[place.line] + self._characters(line, max(place.column, 0))

    def place(self, offset: int) -> Place:
        """Return the place of an offset."""
        number = bisect_right(self.starts, offset) - 1
        return Place(number, self._units(self.text[self.starts[number] : offset]))

    def of_bytes(self, number: int, column: int) -> Place:
        """Return the place of a byte of a line, both from 0."""
        line = self.line(number)
        if line.isascii():
            return Place(number, min(column, len(line)))
        head = line.encode("utf-8", "surrogatepass")[:column]
        return Place(number, self._units(head.decode("utf-8", "ignore")))

    def changed(self, edit: Edit) -> Text:
        """Return the text with a change."""
        start, end = sorted((self.offset(edit.span.start), self.offset(edit.span.end)))
        return self.of(self.text[:start] + edit.text + self.text[end:])

    def with_all(self, edits: list[Edit]) -> Text:
        """Return the text with changes of it that do not overlap."""
        found = self.text
        for edit in sorted(edits, key=lambda each: self.offset(each.span.start), reverse=True):
            span = edit.span
            found = found[: self.offset(span.start)] + edit.text + found[self.offset(span.end) :]
        return self.of(found)

    def of(self, text: str) -> Text:
        """Return another text that is counted in the same units."""
        return Text(text, self.counts)

    def _units(self, text: str) -> int:
        """Return how many units a text has."""
        codec, size = UNITS[self.counts]
        return len(text) if text.isascii() else len(text.encode(codec, "surrogatepass")) // size

    def _characters(self, line: str, count: int) -> int:
        """Return how many characters of a line so many units are; half of one is none."""
        if line.isascii():
            return min(count, len(line))
        codec, size = UNITS[self.counts]
        head = line.encode(codec, "surrogatepass")[: size * count]
        return len(head.decode(codec, "ignore"))
