"""Errors about lines of a window get the text of these lines."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from gcxform.diagnostics import GcxformError, Location
from gcxform.syntax.scan import Window


@contextmanager
def placing(window: Window, file: str) -> Iterator[None]:
    """Give the text of their lines to errors about lines of a window."""
    try:
        yield
    except GcxformError as error:
        raise _located(error, window, file) from None


def _located(error: GcxformError, window: Window, file: str) -> GcxformError:
    """Return an error with the text of the lines it is about."""
    found = []
    for diagnostic in error.diagnostics:
        where = diagnostic.where
        if where is not None and not where.file and where.line:
            text = window.line(where.line - 1 - window.first_line).decode("latin-1")
            start = len(text) - len(text.lstrip()) + 1
            where = Location(file, where.line, start, text, max(1, len(text.strip())))
            diagnostic = diagnostic.at(where)
        found.append(diagnostic)
    return type(error)(tuple(found))
