"""What is written before the end of a subprogram, so that who called it finds what it expects."""

from __future__ import annotations

from gcxform.emit.emitter import Emitted
from gcxform.modal.meaning.tables import MeaningTable
from gcxform.syntax.scan import Window
from gcxform.values import dataclass


@dataclass(frozen=True, slots=True)
class Leaving:
    """Codes that restate modes, and blocks that go back, which are not of the path that is proved.

    codes  written in one block
    back   a block each
    last   the line before which they stand, from 0, where no block ends the program; else -1
    """

    codes: tuple[str, ...] = ()
    back: tuple[str, ...] = ()
    last: int = -1

    def with_codes(
        self, emitted: Emitted, window: Window, table: MeaningTable, live: int
    ) -> Emitted:
        """Return the text of a window with the codes before its end."""
        if not self.codes:
            return emitted
        return emitted.leaving(self.codes, window, table, live, self.last)

    def with_back(
        self, emitted: Emitted, window: Window, table: MeaningTable, live: int
    ) -> Emitted:
        """Return the text of a window with the blocks that go back before its end."""
        for block in self.back:
            emitted = emitted.leaving((block,), window, table, live, self.last)
        return emitted


NOTHING = Leaving()
