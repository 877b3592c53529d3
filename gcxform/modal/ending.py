"""Whether a program ends as its control asks for: with M2 or M30, or between two percent signs.

This is asked of whole files only (`gcxform check`): a piece of a program may well be read.
"""

from __future__ import annotations

import numpy as np

from gcxform.diagnostics import Diagnostic, Location
from gcxform.dialect import Dialect
from gcxform.modal.tables import MeaningTable
from gcxform.syntax.scan import Window


class Ending:
    """Is shown the windows of a program in order; `finding` is then what is wrong with its end."""

    def __init__(self, dialect: type[Dialect], file: str = "-") -> None:
        self.dialect = dialect
        self.file = file
        self.ended = not dialect.needs_end
        self.framed = False
        self.blank = True
        self.lines = 0
        self.finding: Diagnostic | None = None

    def look(self, window: Window, table: MeaningTable) -> None:
        """Look for the end in a window; the table has the meanings of its lines."""
        self.lines += len(window)
        percent = table.flag("percent", window.shape)
        ends = table.flag("ends", window.shape) & ~table.flag("deleted", window.shape)
        seen = 0
        for line in np.flatnonzero(percent | ends).tolist():
            if self.ended:
                return
            self.blank = self.blank and not any(window.line(k).strip() for k in range(seen, line))
            seen = line
            self._sign(window, line, bool(percent[line]))
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
            self.finding = Diagnostic("GX222", message, where, "write M2 in its place")

    def close(self) -> None:
        """Say what is missing, now that the program is over."""
        if not self.ended:
            message = f"{self.dialect.name} refuses a program that has no end"
            hint = "close it with M2" + (", or with a % sign" if self.framed else "")
            self.finding = Diagnostic("GX222", message, Location(self.file, self.lines), hint)
