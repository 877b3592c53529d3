"""Programs of a TNC that come back in their own lines where positions became others."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import cached_property
from typing import ClassVar

from gcxform import vocabulary as v
from gcxform_plugins.dialects.heidenhain.contours import CORNER
from gcxform_plugins.dialects.heidenhain.programs import Programs
from gcxform_plugins.dialects.heidenhain.setting import LOCAL, STEPS, said_of
from gcxform_plugins.dialects.heidenhain.spelling import PATH, code
from gcxform_plugins.dialects.heidenhain.words import HEAD, goes_on
from gcxform_plugins.dialects.heidenhain.words_moved import OFF, Place, line_moved

BEGIN = re.compile(r"[\s\d/]*BEGIN\s+PGM(?![A-Z])", re.IGNORECASE)
END = re.compile(r"[\s\d/]*END\s+PGM(?![A-Z])", re.IGNORECASE)
CENTRE = re.compile(r"[\s\d/]*CC(?![A-Z])", re.IGNORECASE)
TIED = re.compile(r"[\s\d/]*(?:RND|CHF|CT|FLT?|FCT?|DEP|AP+R)(?![A-Z])", re.IGNORECASE)
"""Lines that hang on the ones beside them."""
POLAR = re.compile(r"[\s\d/]*LP(?![A-Z])", re.IGNORECASE)
FLOW = re.compile(
    r"[\s\d/]*(?:BEGIN|END|LBL|FN\s*(?:9|1[0-2])\s*:|CALL\s+(?:LBL|PGM|SELECTED))", re.IGNORECASE
)
PRINTED = re.compile(r"[\s\d/]*FN\s*16\s*:", re.IGNORECASE)
SIDE = re.compile(r"(?<![A-Z])R[LR](?![A-Z0-9])", re.IGNORECASE)
WHOLE = re.compile(r"(?<![A-Z])P(?P<what>[AR])(?=[ \t]*[-+.,0-9Q])", re.IGNORECASE)


LINE = (
    r"(?P<head>[ \t]*(?:[0-9]+[ \t]+)?)"
    r"(?P<words>L(?:[ \t]+(?:[XYZABCUVW{}]{}|R0|F[ \t]*MAX))+)(?=[ \t]*(?:;|\Z))"
)
NUMBER = r"[-+]?[0-9]+(?:\.[0-9]*)?"
MILLIMETRES = re.compile(LINE.format("F", NUMBER), re.IGNORECASE)
INCHES = re.compile(LINE.format("", NUMBER), re.IGNORECASE)


class InPlace(Programs):
    """Says what stands in the place of lines that became others."""

    lasting: ClassVar[frozenset[str]] = frozenset()

    def changed_line(self, line: int, change: v.Change) -> str | None:
        """Return a line whose block became another; None where that is not known."""
        text = self.lines[line]
        if goes_on(text):
            return None
        goes = PATH.match(text) is not None or TIED.match(text) is not None
        if not goes and change.was == change.now:
            return text
        hangs = self._is_tied(line) or POLAR.match(text) is not None
        if hangs and _is_still(change, text):
            return text
        bare, before = code(text).rstrip(), self._neighbour(line, -1)
        about = CENTRE.match(before) is not None and not STEPS.search(code(before).rstrip())
        place = Place(self.inch, about, counts=not CORNER.match(before))
        made = line_moved(bare, change, place)
        return None if made is None else made + text[len(bare) :]

    def replaced(self, line: int, said: Sequence[str]) -> str | None:
        """Return the lines that stand for what a line became; None for a part of a statement."""
        return None if goes_on(self.lines[line]) else super().replaced(line, said)

    def worded(self) -> v.Worded:
        """Return what lines only go somewhere; F of a program in inches is in tenths of them."""
        return v.Worded(INCHES if self.inch else MILLIMETRES, signed=True)

    def hanging(self) -> list[int]:
        """Return lines that hang on those beside them, or say a side; and of polar ones a part."""
        found = [k for k, text in enumerate(self.lines) if TIED.match(text)]
        ends = (near for k in found for near in (self._next_said(k, -1), self._next_said(k, 1)))
        beside = [k for k in ends if 0 <= k < len(self.lines) and PATH.match(self.lines[k])]
        aside = (k for k, text in enumerate(self.lines) if SIDE.search(code(text)))
        polar = (k for k, text in enumerate(self.lines) if POLAR.match(text))
        open_ = (k for k in polar if len({*_polar(self.lines[k])}) < len("AR"))
        return [*found, *beside, *aside, *open_]

    def _is_tied(self, line: int) -> bool:
        beside = self.lines[line], self._neighbour(line, -1), self._neighbour(line, 1)
        return any(TIED.match(text) for text in beside)

    def _neighbour(self, line: int, way: int) -> str:
        at = self._next_said(line, way)
        return self.lines[at] if 0 <= at < len(self.lines) else ""

    def _next_said(self, line: int, way: int) -> int:
        """Return the next line with a statement, or the one before; else one beyond all."""
        line += way
        while 0 <= line < len(self.lines) and not HEAD.sub("", code(self.lines[line])).strip():
            line += way
        return line

    def margins(self) -> tuple[int, int]:
        """Return the line behind BEGIN PGM, and that of END PGM."""
        lines = range(self.own)
        begin = next((k for k in lines if BEGIN.match(self.lines[k])), 0)
        end = next((k for k in reversed(lines) if END.match(self.lines[k])), self.own)
        return begin + 1, end

    @cached_property
    def _in_several_lines(self) -> list[tuple[int, int]]:
        found, first = list[tuple[int, int]](), 0
        for line in range(self.own):
            if not goes_on(self.lines[line]):
                found += [(first, line)] if line > first else []
                first = line + 1
        return found

    def loops(self) -> list[tuple[int, int]]:
        """Return the statements of several lines, which are written out as one."""
        return self._in_several_lines

    def stands_alone(self, line: int) -> bool:
        """Whether a line calls nothing, and is whole: QL of another program are not there."""
        text = self.lines[line]
        own = self.is_own(line) or not LOCAL.search(code(text))
        return own and FLOW.match(text) is None and not goes_on(text)

    def depths(self) -> list[tuple[int, int]]:
        """Return where labels are called, and left."""
        return self.deep

    def sets(self, line: int, visit: int) -> list[str] | None:
        """Return the lines that say what a statement sets besides its blocks."""
        last = line
        while goes_on(self.lines[last]) and last + 1 < len(self.lines):
            last += 1
        if not self.is_own(line) and PRINTED.match(self.lines[line]) and self._has_local:
            return None
        return said_of(self.lines[line : last + 1], self.is_own(line), visit in self.unsaid)

    @cached_property
    def _has_local(self) -> bool:
        """Whether anything is said of QL: what is printed by a form may be one of them."""
        return any(LOCAL.search(code(text)) for text in self.lines)

    def leaves(self) -> dict[str, object]:
        """Return Q and QR parameters: other programs may read them."""
        return {key: value for key, value in self.q.items() if key[:2] != "QL"}


def _is_still(change: v.Change, text: str) -> bool:
    """Whether nothing became another that a line hangs on, and no side that it says is gone."""
    gone = SIDE.search(code(text)) is not None and change.modes.get("side", "") in OFF
    same = change.was == change.now and change.stood == change.stands
    return same and not (change.beside or gone)


def _polar(text: str) -> list[str]:
    return [found["what"].upper() for found in WHOLE.finditer(code(text))]
