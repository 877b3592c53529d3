"""Which language of its own a program may be written in."""

from __future__ import annotations

from gcxform.diagnostics import InputError
from gcxform.dialect.dialect import Dialect
from gcxform.flow.annexed import lines_of
from gcxform.flow.translation import Translator, translator_of
from gcxform.modal.state import Reading


def has_signs(text: bytes, dialect: type[Dialect]) -> bool:
    """Whether a text may be a program of a dialect: always, where that is one of words."""
    return dialect.translator is None or dialect.translator.signs.search(text) is not None


def foreign_lines(text: bytes, dialect: type[Dialect]) -> tuple[int, int]:
    """Return how many lines a text has, empty ones left out, and how many the grammar refuses."""
    kind = translator_of(dialect)
    lines = [line for line in lines_of(text) if line.strip()]
    reader = kind(lines, "", dialect, Reading())
    return len(lines), sum(not _accepted(reader, line) for line in range(len(lines)))


def _accepted(reader: Translator, line: int) -> bool:
    try:
        reader.items(line)
    except InputError:
        return False
    return True
