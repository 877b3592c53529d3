"""Texts of whole lines become windows, with the shapes and the meanings that they need."""

from __future__ import annotations

from collections.abc import Iterator

from gcxform.dialect import Dialect
from gcxform.modal.tables import MeaningTable
from gcxform.source import Source
from gcxform.syntax.scan import Window, scan
from gcxform.syntax.shapes import ShapeTable

SHAPES_AT_MOST = 20_000  # a table of shapes that grows beyond is begun anew


class WindowReader:
    """Turns texts of whole lines into windows, with the shapes and meanings they need."""

    def __init__(self, dialect: type[Dialect]) -> None:
        self.dialect = dialect
        self.lines = 0
        self._begin()

    def _begin(self) -> None:
        self.shapes = ShapeTable(self.dialect.load_grammar())
        self.table = MeaningTable(self.shapes, self.dialect)

    def read(self, text: bytes) -> Window:
        """Return the next window."""
        if len(self.shapes) > SHAPES_AT_MOST:
            self._begin()
        window = scan(text, self.lines, self.shapes)
        self.lines += len(window)
        return window


def windows_of(source: Source, dialect: type[Dialect]) -> Iterator[tuple[Window, WindowReader]]:
    """Yield the windows of a program with the reader that knows their shapes."""
    reader = WindowReader(dialect)
    for text in source.windows():
        yield reader.read(text), reader
