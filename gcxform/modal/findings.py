"""What speaks against a window, collected and raised together, each with its place and context."""

from __future__ import annotations

from gcxform.diagnostics import Diagnostic, InputError, Location
from gcxform.modal.meaning.meaning import Refusal
from gcxform.modal.meaning.sorting import meaning_of
from gcxform.modal.meaning.tables import MeaningTable
from gcxform.syntax.scan import Window
from gcxform.syntax.shapes import Shape, slots_of


class Findings:
    """Diagnostics about lines of one window.

    `only` are the codes that are asked for, None for all; that there were others is not forgotten.
    """

    enough = 50
    only: frozenset[str] | None = None

    def __init__(self, file: str, window: Window, table: MeaningTable) -> None:
        self.file = file
        self.window = window
        self.table = table
        self.found: list[tuple[int, Diagnostic]] = []
        self._others = False

    def add(
        self,
        line: int,
        code: str,
        message: str,
        address: str = "",
        hint: str = "",
        context: str = "",
    ) -> None:
        """Add a finding about a line, pointing at the word with an address if one is given."""
        if not self._wanted(code):
            return
        column, width = self._word_at(line, address)
        where = self.location(line, column, width)
        self.found.append((line, Diagnostic(code, message, where, hint, context)))

    def add_at(self, line: int, place: tuple[int, int], diagnostic: Diagnostic) -> None:
        """Add a finding about a piece of a line: its first column, from 0, and its end."""
        where = self.location(line, place[0] + 1, place[1] - place[0])
        self.found.append((line, diagnostic.at(where)))

    def add_refusal(self, line: int) -> None:
        """Add what is wrong with the shape of a line."""
        refusal = self._refusal(line)
        where = self.location(line, refusal.column + 1, refusal.width)
        self.found.append((line, Diagnostic(refusal.code, refusal.message, where, refusal.hint)))

    def _refusal(self, line: int) -> Refusal:
        """Return what is wrong with a line, at its place there: other lines have other numbers."""
        shape = self.table.shapes.shapes[int(self.window.shape[line])]
        if not shape.own:
            block = self.table.shapes.grammar.parse(self.window.line(line).decode("latin-1"))
            alone = Shape(block, tuple(slots_of(block)), True)
            if (refusal := meaning_of(alone, self.table.dialect).refusal) is not None:
                return refusal
        refusal = self.table.meanings[int(self.window.shape[line])].refusal
        assert refusal is not None
        return refusal

    def location(self, line: int, column: int, width: int) -> Location:
        """Return a place in a line of the window."""
        text = self.window.line(line).decode("latin-1")
        return Location(self.file, self.window.first_line + line + 1, column, text, width)

    def _word_at(self, line: int, address: str) -> tuple[int, int]:
        """Return column (from 1) and width of a word; of the whole text if there is none."""
        text = self.window.line(line)
        slot = self.table.meanings[int(self.window.shape[line])].slots.get(address, -1)
        if slot < 0:
            blanks = len(text) - len(text.lstrip())
            return blanks + 1, max(1, len(text.strip()))
        number = int(self.window.first_number[line]) + slot
        start = int(self.window.start[line])
        begin = int(self.window.number_start[number]) - start
        end = int(self.window.number_end[number]) - start
        first = address[0]  # the comma of an address that has one, which a blank may follow
        letter = max(
            text.rfind(first.encode(), 0, begin), text.rfind(first.lower().encode(), 0, begin)
        )
        return letter + 1, end - letter

    def _wanted(self, code: str) -> bool:
        wanted = self.only is None or code in self.only
        self._others |= not wanted
        return wanted

    def raise_if_any(self) -> None:
        """Raise InputError with what was found and is asked for, by line."""
        if self.found or self._others:
            self.found.sort(key=lambda entry: entry[0])
            raise InputError(tuple(diagnostic for _, diagnostic in self.found))
