"""Text tables: rows of words with their places, numbers, and what is wrong with them.

The readers of foreign formats are built of these, so that each message shows its place.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from gcxform.config.toml_text import read_text
from gcxform.diagnostics import Diagnostic, Location, UsageError
from gcxform.errormodel.functions import Fault
from gcxform.values import dataclass

PLACES = 9  # decimals of a written mm: a millionth of a micrometre
NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?|[+-]?(?:nan|inf)", re.I)


@dataclass(frozen=True)
class TextRow:
    """One line of a text with its words, comments left out."""

    file: str
    line: int
    text: str
    words: list[re.Match[str]]

    def word(self, column: int) -> str:
        """Return a word, empty if there is none."""
        return self.words[column][0] if column < len(self.words) else ""

    def where(self, column: int | None = None) -> Location:
        """Return the place of a word, of the end of the line if the word is not there."""
        if column is None or column >= len(self.words):
            at = 1 if column is None else len(self.text.rstrip()) + 1
            return Location(self.file, self.line, at, self.text)
        word = self.words[column]
        return Location(self.file, self.line, word.start() + 1, self.text, len(word[0]))

    def refuse(
        self, code: str, message: str, column: int | None = None, hint: str = ""
    ) -> UsageError:
        """Return the error about a word of this line."""
        return UsageError.one(code, message, self.where(column), hint)

    def numbers(self, width: int) -> list[float]:
        """Return as many numbers as the line has to have. Raises UsageError at what is none."""
        if found := list(number_findings(self, width)):
            raise UsageError(tuple(found))
        return [float(word[0]) for word in self.words]

    def number(self, column: int) -> float:
        """Return one number. Raises UsageError where it is none."""
        if found := list(_word_findings(self, column)):
            raise UsageError(tuple(found))
        return float(self.words[column][0])


def text_rows(path: Path, words: str = r"\S+", comment: str = "") -> list[TextRow]:
    """Return the lines of a UTF-8 file which are not blank; `comment` begins what is left out.

    `words` is the pattern of a word. Raises UsageError for a file that cannot be read.
    """
    lines = read_text(path, "GX401", "GX419").splitlines()
    pattern = re.compile(words)
    rows = []
    for number, line in enumerate(lines, 1):
        said = line.partition(comment)[0] if comment else line
        if found := list(pattern.finditer(said)):
            rows.append(TextRow(str(path), number, line, found))
    return rows


def number_findings(row: TextRow, width: int) -> Iterator[Diagnostic]:
    """Yield what is wrong with a line which should have so many numbers and nothing else."""
    if len(row.words) != width:
        message = f"the row has {len(row.words)} of {width} columns"
        yield Diagnostic("GX418", message, row.where(min(len(row.words), width)))
    for column in range(len(row.words)):
        yield from _word_findings(row, column)


def _word_findings(row: TextRow, column: int) -> Iterator[Diagnostic]:
    word = row.word(column)
    if not NUMBER.fullmatch(word):
        hint = "decimals are set off by a point" if "," in word else ""
        yield Diagnostic("GX419", f"{word!r} is not a number", row.where(column), hint)


def placed(fault: Fault, row: TextRow, column: int) -> Diagnostic:
    """Return a defect of the numbers at its place in the file."""
    return Diagnostic(fault.code, fault.message, row.where(column))


def decimal(value: float, places: int = PLACES) -> str:
    """Return a number without exponent, rounded to so many decimals, never as -0."""
    return np.format_float_positional(round(float(value), places) + 0.0, trim="-")
