"""Lines whose block became another one: words are changed where they stand.

A word keeps its place, its blanks and its `=`. Of an arc that became lines the words that make it
an arc are taken out. What a block does not say of a line stays in it, and what cannot be said is no
line.
"""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from typing import ClassVar

from gcxform import vocabulary as v
from gcxform_plugins.dialects.shared.words import text_of

ARCS = frozenset(("G2", "G3"))
MOTIONS = frozenset(("G0", "G1", "G2", "G3"))
DISTANCES = frozenset(("G90", "G91"))
OF_PATHS = frozenset("FIJKRP")


@dataclass(frozen=True)
class Word:
    """A word of a line: its name, what says from where it counts, where it stands with all that.

    `number`: that of a word that does not compute, as it is written; `value`: where that stands.
    """

    name: str
    way: str
    place: tuple[int, int]
    number: str = ""
    value: tuple[int, int] = (0, 0)

    @property
    def code(self) -> str:
        """The code of a G word."""
        return f"G{self.number.lstrip('0') or '0'}" if self.name == "G" else ""


def edited(text: str, edits: Iterable[tuple[int, int, str]]) -> str:
    """Return a text with other parts in place of some of its own, by where these begin and end."""
    for start, end, new in sorted(edits, reverse=True):
        text = text[:start] + new + text[end:]
    return text


class Edits(ABC):
    """The changes of one line without its comment: parts of its text that become others."""

    head: ClassVar[re.Pattern[str]]
    """What stands in front of the words of a line."""
    axes: ClassVar[frozenset[str]]
    of_arcs: ClassVar[frozenset[str]]
    """Names, and codes but G2 and G3, of words that only arcs have."""
    lengths: ClassVar[Mapping[str, str]]
    """How words of an arc are said, by the letters that blocks have for them."""
    beside: ClassVar[frozenset[str]] = frozenset()
    """Codes of blocks that say how an arc is told; lines have them in words of their own."""

    def __init__(self, text: str, words: Sequence[Word], change: v.Change) -> None:
        self.text, self.words = text, words
        self.was, self.now, self.change = change.was, change.now, change
        self.old, self.new = dict(change.was.words), dict(change.now.words)
        self.there = {word.code for word in words}
        self.possible = self._others(self.was) == self._others(self.now) and not self._twice()
        self.made: list[tuple[int, int, str]] = []
        self.straightened = self.was.bends and not self._same_arc()

    def _others(self, block: v.BlockWords) -> tuple[object, ...]:
        """Return what a line keeps as it says it: all but motion, distance and the path."""
        path = MOTIONS | DISTANCES | self.beside
        codes = tuple(code for code in block.codes if code not in path)
        return codes, tuple(w for w in block.words if w[0] not in self.axes | OF_PATHS)

    def _twice(self) -> bool:
        names = [word.name for word in self.words if word.name != "G"]
        return len({*names}) != len(names)

    def _same_arc(self) -> bool:
        return all(self.old.get(letter) == self.new.get(letter) for letter in "IJKRP") and (
            ARCS & {*self.was.codes} == ARCS & {*self.now.codes}
        )

    def line(self) -> str | None:
        """Return the line; None where it cannot be said."""
        if not self.possible:
            return None
        for word in self.words:
            self._edit(word)
        self._add()
        return edited(self.text, self.made).rstrip() if self.possible else None

    def _edit(self, word: Word) -> None:
        if word.name in self.axes:
            self._axis(word)
        elif word.name == "F":
            self._feed(word)
        elif self.straightened and ({word.name, word.code} & (self.of_arcs | ARCS)):
            self._drop(word)
        elif word.code == "G91" and not self.change.steps:
            self.made.append((*word.place, "G90"))
        elif word.code == "G90" and self.change.steps:
            self.possible = False

    @abstractmethod
    def _axis(self, word: Word) -> None:
        """Change the word of an axis: it stays where it says the same, and goes where none is."""

    @abstractmethod
    def _word(self, letter: str, value: Decimal) -> str:
        """Return the word of an axis that the line has not."""

    @abstractmethod
    def _is_told(self) -> bool:
        """Whether words of axes say themselves from where they count, whatever is in force."""

    def _feed(self, word: Word) -> None:
        old, new = self.old.get("F"), self.new.get("F")
        if new is not None and old != new:
            self._put(word, text_of(new), bool(word.number))

    def _put(self, word: Word, text: str, in_place: bool) -> None:
        """Write a word anew, with its letter and its `=`, or its number alone."""
        if in_place:
            self.made.append((*word.value, text))
            return
        part = self.text[slice(*word.place)]
        equals = re.match(r"[A-Z]+[ \t]*=[ \t]*", part, re.IGNORECASE)
        self.made.append((*word.place, (equals[0] if equals else part[0]) + text))
        end = word.place[1]
        if not word.number and end < len(self.text) and not self.text[end].isspace():
            self.made.append((end, end, " "))

    def _drop(self, word: Word) -> None:
        """Take a word out, with the blanks behind it."""
        start, end = word.place
        while end < len(self.text) and self.text[end] in " \t":
            end += 1
        self.made.append((start, end, ""))

    def _refuse(self, wrong: bool) -> None:
        self.possible &= not wrong

    def _add(self) -> None:
        """Put in what the line does not say: codes behind its head, words at its end."""
        codes = [code for code in self.now.codes if code in MOTIONS | DISTANCES]
        there = self.there - (ARCS if self.straightened else set())
        self._refuse(bool(there & MOTIONS - {*self.now.codes, *self.was.codes}))
        self._refuse(bool(there & MOTIONS and {*codes} & MOTIONS - there))
        had = {*self.was.codes} - (MOTIONS if self.straightened else set()) - self.change.due
        if self._is_told() or ("G91" in there and not self.change.steps):
            had |= DISTANCES
        lacking = [*self._codes(), *(code for code in codes if code not in there | had)]
        if lacking:
            head = self.head.match(self.text)
            at = head.end() if head else 0
            self.made.append((at, at, " ".join(lacking) + " "))
        if ends := [*self._lacking({word.name for word in self.words})]:
            self._end(ends)

    def _codes(self) -> Sequence[str]:
        """Return what else is said before the words of a line."""
        return ()

    def _end(self, words: Sequence[str]) -> None:
        """Put words to the end of the line, or in the place of one that was there."""
        at = len(self.text.rstrip())
        gone = (start for start, stop, new in self.made if stop == at and not new)
        blank = any(self.text[start - 1 : start].isspace() for start in gone)
        self.made.append((at, at, ("" if blank else " ") + " ".join(words)))

    def _lacking(self, said: set[str]) -> Iterator[str]:
        """Yield the words that a line has not."""
        for letter, value in self.now.words:
            if letter in self.axes and letter not in said:
                yield self._word(letter, value)
            elif (letter in self.lengths and self.straightened) or (
                letter == "F" and "F" not in said
            ):
                yield self.lengths.get(letter, letter) + text_of(value)
            self._refuse(letter in self.lengths and not self.was.bends)
        if self.straightened and self.now.bends:
            self._refuse("P" in self.new)
