"""What a language is asked for where its programs are written again, in their own lines.

`spelled` and `replaced` say what a line becomes by passes that keep positions
(`gcxform/emit/respelling.py`), `changed_line` by those that turn them into others
(`gcxform/emit/refolding.py`).
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Any, ClassVar

from gcxform.flow.block_words import DISTANCES, MOTIONS, At, BlockWords, Change, Worded
from gcxform.flow.line_shapes import LineShapes
from gcxform.flow.speller import Speller

SLASH = re.compile(r"[ \t]*(?:[N:]?[ \t]*[0-9]+[ \t]*)?/", re.IGNORECASE)


class LineWriting(LineShapes):
    """What stands in the place of lines of one program. Without more of it none is written so."""

    writes: ClassVar[bool] = False
    """Whether programs in this language can be written as such again: see `spelled`."""
    speller: ClassVar[type[Speller] | None] = None
    """What writes programs for another control in this language; None: they are only read."""
    stepped: ClassVar[tuple[re.Pattern[str], ...]] = ()
    """Of these one stands in each line that `counts`; without any all are asked. They are found
    fastest if each begins with a text."""
    against: ClassVar[Mapping[str, re.Pattern[str]]] = {}
    """What a line has that puts lengths in inches in force, by the fact METRIC, whose pass then
    cannot do what it is for; arcs by LINEAR_ONLY and XY_ARCS; cycles by NO_CYCLES and what shifts
    or turns coordinates by WORKPIECE_FRAME, if its blocks do not."""
    lasting: ClassVar[frozenset[str]] = DISTANCES | MOTIONS
    """Codes that hold for the lines behind; where each line says its own motion there are none."""
    kept: ClassVar[str] = ""
    """The code of blocks that stand for a line that is kept as it stands, whatever it does."""

    def spelled(self, line: int, blocks: Sequence[str]) -> str | None:
        """Return a line that stands for new blocks, in the manner of `line`, which counts from 0.

        None where no such line is known. What is returned is read again, and has to stand for them.
        """
        del line, blocks
        return None

    def replaced(self, line: int, said: Sequence[str]) -> str | None:
        """Return lines for what a line became, as the speller has `said` it; None without any.

        They are joined by line feeds. Nothing like the line can say it.
        """
        del line, said
        return None

    def changed_line(self, line: int, change: Change) -> str | None:
        """Return a line, which counts from 0, whose block became another, in its own form.

        None where it cannot be said so. A language without this has its programs written anew
        where positions become others.
        """
        del line, change
        return None

    def worded(self) -> Worded:
        """Return what lines are that have nothing but words, as their blocks have them."""
        return Worded()

    def hanging(self) -> Iterable[int]:
        """Return lines, from 0, that hang on more than their blocks: they change with others."""
        return ()

    def inside(self, frame: Any, named: At, before: At, steps: bool, bends: bool) -> At | None:
        """Return words of axes, by letter, as they count in a frame; None where that is not known.

        `before` is where axes stand outside of it; `bends`: they are those of an arc.
        """
        del frame, before, steps, bends
        return named

    def calls_behind(self, lines: Collection[int], block: BlockWords) -> bool:
        """Whether a block of lines is a call that one before them has said, for all that move."""
        del lines, block
        return False

    def loops(self) -> list[tuple[int, int]]:
        """Return the first and the last line, from 0, of each loop that its last line ends."""
        return []

    def stands_alone(self, line: int) -> bool:
        """Whether a line in its own form may stand, with all it sets, where it is written out."""
        del line
        return False

    def depths(self) -> list[tuple[int, int]]:
        """Return executions behind which calls of lines of this file are deeper, or less, and how.

        The first line at a depth is the one after the execution, by its number, that leads there.
        """
        return []

    def branches(self) -> list[tuple[int, ...]]:
        """Return the lines, from 0, that begin, part and end each structure that is no loop."""
        return []

    def sets(self, line: int, visit: int) -> list[str] | None:
        """Return what an execution of a line sets besides its blocks, as lines that say it.

        None where none can. `visit` is the number of the execution.
        """
        del line, visit
        return []

    def headed(self, line: int, text: str) -> str:
        """Return the first of the lines that are written out in the place of a line and others.

        It has to be found where the line was: by its number, or its label.
        """
        del line
        return text

    def margins(self) -> tuple[int, int]:
        """Return the line, from 0, in front of which stamps go, and that of the seal."""
        return 0, len(self.lines)

    def leaves(self) -> Mapping[str, object]:
        """Return what the program leaves to those behind it, or that call it, by name.

        None is what only the control knows.
        """
        return {}

    def slashed(self) -> list[int]:
        """Return the lines, from 0, on which a switch of the control decides."""
        return [k for k, text in enumerate(self.lines) if SLASH.match(text)]

    def renumbered(self, text: str) -> str:
        """Return a program in which a line became several, with its numbers anew."""
        return text

    def left_behind(self) -> range:
        """Return the lines, from 0, that are kept and have no block: nothing read them."""
        return range(0)

    def counts(self, line: str) -> bool:
        """Return whether a line has words that count from where an axis stands."""
        del line
        return False

    def uncommented(self, text: str) -> str:
        """Return lines without comments, if one may stand within what is `stepped`."""
        return text
