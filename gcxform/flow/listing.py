"""A whole program as lines that can be executed in any order: texts, trees and where they stand.

Behind its own lines stand those of the files that it calls, each with an empty line before it, a
seam: who comes to a seam has left a file at its end.
"""

from __future__ import annotations

from bisect import bisect_right

import numpy as np

from gcxform.diagnostics import Diagnostic, InputError, Location
from gcxform.dialect.dialect import Dialect
from gcxform.flow.executed import CalledFile
from gcxform.flow.lookup import Folders, Found
from gcxform.modal.meaning.meaning import Meaning
from gcxform.modal.meaning.printed import is_output, prints_values
from gcxform.modal.meaning.tables import NUMBER
from gcxform.modal.reader import WindowReader
from gcxform.syntax.tree import Block, Comment, Expression, Mark, Number, Statement, Word
from gcxform.system.distinct import union
from gcxform.values import dataclass

CODES_OF_CALLS = frozenset({97, 98, 99, 198})
CALLS_WITH_VALUES = frozenset({65, 66, 66.1, 67})
"""G codes that call programs with values, and the end of that."""
STORED_MODES = frozenset({70, 71, 72, 73})


@dataclass(frozen=True, slots=True)
class Definition:
    """A subprogram as it stands in the file: what calls it by, its first and its last line."""

    name: str
    first: int
    last: int

    @property
    def lines(self) -> slice:
        """Its lines behind the first, which names it and is not executed by a call."""
        return slice(self.first + 1, self.last + 1)


class Listing:
    """The lines of a program; numbers of lines count from 0.

    `special` (m,) are the lines, ascending, that may do more than be executed once as they stand:
    those with expressions, statements, calls, labels, or an end, and both sides of a seam. `units`
    (n,) is 1 where a line has G20, 0 where it has G21, -1 where it has neither. `own` is how many
    lines are those of the program itself, `files` are those behind them, found in `folders`.
    """

    def __init__(
        self,
        text: bytes,
        dialect: type[Dialect],
        file: str,
        folders: Folders,
        files: tuple[CalledFile, ...] = (),
    ) -> None:
        reader = WindowReader(dialect)
        self.dialect = dialect
        self.file = file
        self.folders = folders
        self.files = files
        self.window = reader.read(text)
        self.own = files[0].first - 1 if files else len(self.window)
        self.seams = frozenset(each.first - 1 for each in files)
        self.table = reader.table
        self.table.update()
        shapes = reader.shapes.shapes
        odd = [self._is_special(n, shape.block) for n, shape in enumerate(shapes)]
        special = np.array(odd, np.bool_)[self.window.shape]
        for seam in self.seams:
            special[seam - 1 : seam + 1] = True
        self.special = np.flatnonzero(special)
        self.codes: frozenset[str] = frozenset()
        self._blocks: dict[int, Block] = {}
        number = {code: NUMBER[code] for code in ("G20", "G21", "G70", "G71")}
        said = [number.get(m.groups.get("units", ""), -1) for m in self.table.meanings]
        self.units = np.array(said, np.int8)[self.window.shape]

    def __len__(self) -> int:
        return len(self.window)

    def with_file(self, found: Found) -> Listing:
        """Return the listing with one more file behind it; the lines before stay where they are."""
        text = self.window.text
        end = b"" if text.endswith(b"\n") else b"\n"
        joined = b"".join((text, end, b"\n", found.text))
        files = (*self.files, CalledFile(found.name, len(self) + 1, found.text))
        more = Listing(joined, self.dialect, self.file, self.folders, files)
        more.take_for_calls(self.codes)
        return more

    def take_for_calls(self, codes: frozenset[str]) -> None:
        """Take codes, "G100", for calls: what their lines do is not what they say."""
        self.codes = codes
        if not codes:
            return
        names = [{code_name(word) for word in s.block.words} for s in self.table.shapes.shapes]
        calls = np.array([not codes.isdisjoint(each) for each in names], np.bool_)
        self.special = union(self.special, np.flatnonzero(calls[self.window.shape]))

    def part(self, line: int) -> tuple[int, int]:
        """Return the first line of the file in which a line stands, and the line behind its last.

        That behind the last is a seam, or the end of everything.
        """
        number = bisect_right(self.files, line, key=lambda each: each.first)
        ends = [each.first - 1 for each in self.files] + [len(self)]
        return (self.files[number - 1].first if number else 0), ends[number]

    def place(self, line: int) -> tuple[str, int]:
        """Return the file in which a line stands, and which of its lines that is, from 1."""
        number = bisect_right(self.files, line, key=lambda each: each.first)
        if not number:
            return self.file, line + 1
        file = self.files[number - 1]
        return file.name, line - file.first + 1

    def _is_special(self, shape: int, block: Block) -> bool:
        meaning = self.table.meanings[shape]
        if meaning.ends or meaning.percent or meaning.runs_macro:
            return True
        for item in block.items:
            if is_output(item):
                return True
            if isinstance(item, Statement) or (
                isinstance(item, Mark) and item.kind in ("program_id", "program_name")
            ):
                return True
            if isinstance(item, Comment) and prints_values(block.text[item.start : item.end]):
                return True
            if isinstance(item, Word) and (isinstance(item.value, Expression) or decides(item)):
                return True
        return False

    def meaning(self, line: int) -> Meaning:
        """Return what the block of a line does."""
        return self.table.meanings[int(self.window.shape[line])]

    def block(self, line: int) -> Block:
        """Return the tree of a line."""
        if line not in self._blocks:
            text = self.window.line(line).decode("latin-1")
            self._blocks[line] = self.dialect.load_grammar().parse(text)
        return self._blocks[line]

    def last_of(self, first: int, after: int | None) -> int:
        """Return the last line of a part that ends before another, or with the program.

        Empty lines at its end, and the last percent sign, are no part of it.
        """
        last = (self.own if after is None else after) - 1
        while last > first and (not self.window.line(last).strip() or self.meaning(last).percent):
            last -= 1
        return last

    def raw(self, first: int, last: int) -> bytes:
        """Return the text of lines up to one, with their line ends."""
        return (
            self.window.text[int(self.window.start[first]) : int(self.window.start[last])]
            if (last < len(self))
            else self.window.text[int(self.window.start[first]) :]
        )

    def line_end(self, line: int) -> bytes:
        """Return how a line ends; LF for the last one of a file that has no end."""
        end, after = int(self.window.end[line]), int(self.window.next[line])
        return self.window.text[end:after] or b"\n"

    def refusal(
        self,
        line: int,
        code: str,
        message: str,
        hint: str = "",
        place: tuple[int, int] | None = None,
    ) -> InputError:
        """Return the error about a line, at columns from 0; about all of it without a place."""
        text = self.window.line(line).decode("latin-1")
        start, end = place or (len(text) - len(text.lstrip()), len(text.rstrip()))
        where = Location(*self.place(line), start + 1, text, max(1, end - start))
        return InputError((Diagnostic(code, message, where, hint),))


def code_name(word: Word) -> str:
    """Return a G or M code as it is called, "T" for a T word; "" for others and computed ones."""
    if word.address == "T":
        return "T"
    named = word.address in "GM" and isinstance(word.value, Number)
    return f"{word.address}{word.value.value:g}" if named else ""


def decides(word: Word) -> bool:
    """Whether a word is a code that calls, returns, or stores modes, or is not of all controls."""
    if word.address in "O@^":
        return True
    value = word.value.value if isinstance(word.value, Number) else -1.0
    if word.address == "G":
        return value in CALLS_WITH_VALUES
    return word.address == "M" and (value in CODES_OF_CALLS or value in STORED_MODES)


def bare(block: Block) -> list[Word | Statement]:
    """Return what a block does: its items but for comments, marks and its sequence number."""
    return [
        item
        for item in block.items
        if not isinstance(item, Comment | Mark)
        and not (isinstance(item, Word) and item.address == "N")
    ]
