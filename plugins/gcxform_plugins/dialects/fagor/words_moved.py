"""Lines of a Fagor whose block became another one: words are changed where they stand.

`X5I` stays a step where its block is one, and else becomes the place that it leads to. X and Y
stand in the place of polar words, for which a place beside them may have none.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from decimal import Decimal
from typing import ClassVar

import gcxform as gx
from gcxform import vocabulary as v
from gcxform_plugins.dialects.fagor import tables
from gcxform_plugins.dialects.fagor.drilling import DRILL
from gcxform_plugins.dialects.fagor.spelling import HEAD
from gcxform_plugins.dialects.fagor.structure import COMMENT
from gcxform_plugins.dialects.shared.words import text_of
from gcxform_plugins.dialects.shared.words_moved import Edits, Word

VALUE = r"[-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)"
WORD = re.compile(rf"(?P<name>[A-Z])[ \t]*=?[ \t]*(?P<value>{VALUE})[ \t]*(?P<step>I)?", re.I)
COMPUTED = re.compile(r"(?P<name>[A-Z]).*?(?P<step>(?<=[0-9.\]])[ \t]*I)?", re.I | re.DOTALL)
STEP = "I"
OF_DRILLING = frozenset("ZIKF")
"""Words of a hole: its levels, and how it is cut."""
CENTRES = "G90.1"
POLAR = frozenset("RQ")


def blanked(text: str) -> str:
    """Return a line with blanks in the place of its comments."""
    return COMMENT.sub(lambda found: " " * len(found[0]), text)


def words_in(text: str, items: Sequence[gx.Item]) -> list[Word]:
    """Return the words of a line, by its items with their places."""
    found = []
    for item in items:
        part = text[slice(*item.place)]
        if item.kind in ("word", "incremental", "code") and (plain := WORD.fullmatch(part.strip())):
            found.append(_word(plain, item.place[0]))
        elif item.kind == "computed" and (word := COMPUTED.fullmatch(part.strip())):
            found.append(Word(word["name"].upper(), STEP if word["step"] else "", item.place))
    return found


def _word(found: re.Match[str], at: int) -> Word:
    place, value = (tuple(at + k for k in found.span(group)) for group in (0, "value"))
    step = STEP if found["step"] else ""
    return Word(found["name"].upper(), step, place, found["value"], value)  # type: ignore[arg-type]


def line_moved(text: str, words: Sequence[Word], change: v.Change) -> str | None:
    """Return a line for a block that became another; None where it cannot be said."""
    return _Edits(text, words, change).line()


class _Edits(Edits):
    """The changes of a line of a Fagor."""

    head = re.compile(rf"{HEAD.pattern}[ \t]*", re.IGNORECASE)
    axes = tables.AXES
    of_arcs = frozenset(("R", "I", "J", "K", "G6"))
    lengths: ClassVar[Mapping[str, str]] = {letter: letter for letter in "IJKR"}
    beside = frozenset((CENTRES,))

    def __init__(self, text: str, words: Sequence[Word], change: v.Change) -> None:
        super().__init__(text, words, change)
        names = {word.name for word in words}
        self.polar = "Q" in names or ("R" in names and not names & {*"XYZ"})
        self.straightened |= self.polar and self.was.bends
        self.drills = DRILL in self.there
        self._refuse(self.drills and not self.old.keys() & {*"XY"})

    def _edit(self, word: Word) -> None:
        if self.drills and word.name in OF_DRILLING:
            return
        if self.polar and word.name in POLAR:
            self._drop(word)
        else:
            super()._edit(word)

    def _axis(self, word: Word) -> None:
        old, new = self.old.get(word.name), self.new.get(word.name)
        self._refuse(old is None)  # another block of the line says it
        steps, stepped = self.change.steps, self.change.stepped
        if new is None:
            self._drop(word)
        elif old != new or steps != (stepped or word.way == STEP):
            way = STEP if steps and word.way else ""
            same = bool(word.number) and word.way == way
            self._put(word, text_of(new) + ("" if same else way), same)

    def _word(self, letter: str, value: Decimal) -> str:
        return letter + text_of(value) + (STEP if self._is_told() else "")

    def _is_told(self) -> bool:
        ways = [word.way for word in self.words if word.name in self.axes]
        return self.change.steps and bool(ways) and all(ways)

    def _codes(self) -> Sequence[str]:
        centred = self.straightened and self.now.bends and CENTRES in self.now.codes
        return ["G6"] if centred else []

    def _end(self, words: Sequence[str]) -> None:
        """Put words to the end of the line, or X and Y where polar words have been."""
        first = next((word for word in self.words if self.polar and word.name in POLAR), None)
        places = [each for each in words if each[0] in self.axes] if first else []
        if first is not None and places:
            self.made.append((first.place[0], first.place[0], " ".join(places) + " "))
        rest = [each for each in words if each not in places]
        if rest:
            super()._end(rest)
