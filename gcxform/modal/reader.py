"""Texts of whole lines become windows, with the shapes and the meanings that they need.

A table of shapes that has grown large is begun anew, so that a program of comments does not fill
the memory.
"""

from __future__ import annotations

from collections.abc import Iterator

from gcxform.dialect.dialect import Dialect
from gcxform.modal.meaning.tables import MeaningTable
from gcxform.syntax.outlines import Comments
from gcxform.syntax.scan import Window, scan
from gcxform.syntax.shapes import Shape, ShapeTable
from gcxform.syntax.source import Source

Apart = tuple[Window, int, list[Shape]]  # a window, how many shapes were known, those that are new
SHAPES_AT_MOST = 20_000  # a table of shapes that grows beyond is begun anew


class WindowReader:
    """Turns texts of whole lines into windows, with the shapes and meanings they need."""

    def __init__(self, dialect: type[Dialect], tables: Tables | None = None) -> None:
        self.dialect = dialect
        self.lines = 0
        self.table = new_table(dialect) if tables is None else tables.of(dialect)

    @property
    def shapes(self) -> ShapeTable:
        """The shapes met so far."""
        return self.table.shapes

    def read(self, text: bytes) -> Window:
        """Return the next window."""
        if len(self.shapes) > SHAPES_AT_MOST:
            self.table = new_table(self.dialect)
        window = scan(text, self.lines, self.shapes)
        self.lines += len(window)
        return window

    def read_apart(self, text: bytes) -> Apart:
        """Return the next window for a reader in another process, and what its table needs."""
        before, known = self.shapes, len(self.shapes)
        window = self.read(text)
        known = known if self.shapes is before else 0
        return window, known, self.shapes.shapes[known:]

    def take_over(self, apart: Apart) -> Window:
        """Return a window that another reader has read, with the shapes it needs in this table."""
        window, known, shapes = apart
        if not known:
            self.table = new_table(self.dialect)
        self.shapes.take_over(shapes if known else shapes[1:])  # every table begins with the first
        self.lines += len(window)
        return window


def new_table(dialect: type[Dialect]) -> MeaningTable:
    """Return the table of the meanings of shapes of which none is known yet."""
    rule = dialect.text_rule
    comments = Comments(rule.comments, rule.active_comments, rule.semicolon_ends)
    return MeaningTable(ShapeTable(dialect.load_grammar(), comments), dialect)


class Tables:
    """Tables of shapes that stay from one reading of a program to the next, by dialect."""

    def __init__(self) -> None:
        self._kept: dict[type[Dialect], MeaningTable] = {}

    def of(self, dialect: type[Dialect]) -> MeaningTable:
        """Return the table of a dialect, a new one where it has grown large."""
        if dialect not in self._kept or len(self._kept[dialect].shapes) > SHAPES_AT_MOST:
            self._kept[dialect] = new_table(dialect)
        return self._kept[dialect]


def windows_of(
    source: Source, dialect: type[Dialect], tables: Tables | None = None
) -> Iterator[tuple[Window, WindowReader]]:
    """Yield the windows of a program with the reader that knows their shapes."""
    reader = WindowReader(dialect, tables)
    for text in source.windows():
        yield reader.read(text), reader
