"""Reading as much of a program as can be read: what is refused is left out, and remembered."""

from __future__ import annotations

import copy
from collections.abc import Iterator
from dataclasses import field

from gcxform.diagnostics import Diagnostic, InputError
from gcxform.dialect.dialect import Dialect
from gcxform.modal.interpreter import Interpreter
from gcxform.modal.reader import Tables, WindowReader
from gcxform.modal.state import Reading
from gcxform.syntax.scan import Window
from gcxform.syntax.source import Source
from gcxform.toolpath.path import Toolpath
from gcxform.values import dataclass

ATTEMPTS = 30  # in which a window's refused lines are found and left out


@dataclass
class Tolerant:
    """Reads programs without refusing them; `refused` holds the first finding of each line."""

    dialect: type[Dialect]
    source: Source
    reading: Reading
    tables: Tables | None = None
    refused: dict[int, Diagnostic] = field(default_factory=dict)
    unread: int = 0

    def __post_init__(self) -> None:
        axes = self.reading.axes_of(self.source, self.dialect)
        self.reader = WindowReader(self.dialect, self.tables)
        self.interpreter = Interpreter(self.dialect, self.reading, axes, self.source.name)
        self.interpreter.undecided = self.source.undecided

    def windows(self) -> Iterator[tuple[Window, Toolpath | None]]:
        """Yield the windows with their paths; None for one of which nothing can be made."""
        for text in self.source.windows():
            yield self.window(text)

    def window(self, text: bytes) -> tuple[Window, Toolpath | None]:
        """Return the next window as it is, and its path without the lines that are refused."""
        first = self.reader.lines
        window = as_written = self.reader.read(text)
        for _ in range(ATTEMPTS):
            before = copy.deepcopy(self.interpreter.state)
            try:
                return as_written, self.interpreter.interpret(window, self.reader.table).path
            except InputError as error:
                self.interpreter.state = before
                window = self._without(error, window, first)
        read = sum(first < line <= self.reader.lines for line in self.refused)
        self.unread += len(as_written) - read
        return as_written, None

    def _without(self, error: InputError, window: Window, first: int) -> Window:
        """Return a window whose refused lines are empty."""
        text = bytearray(window.text)
        for diagnostic in error.diagnostics:
            line = diagnostic.where.line if diagnostic.where else first + 1
            self.refused.setdefault(line, diagnostic)
            index = line - 1 - first
            start, end = int(window.start[index]), int(window.end[index])
            text[start:end] = b" " * (end - start)
            if text[end : int(window.next[index])] == b"\r":
                text[end] = ord("\n")
        self.reader.lines = first
        return self.reader.read(bytes(text))
