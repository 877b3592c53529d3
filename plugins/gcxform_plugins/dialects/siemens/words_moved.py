"""Lines of a SINUMERIK whose block became another one: words are changed where they stand.

A word keeps its place, its blanks and its `=`; one that counts from where its axis stands becomes
absolute, in AC, where the block is so. Of an arc that became lines the words that make it an arc
are taken out. What a block does not say of a line stays in it, and what cannot be said is no line.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from decimal import Decimal

import gcxform as gx
from gcxform import vocabulary as v
from gcxform_plugins.dialects.siemens.going_along import HEAD
from gcxform_plugins.dialects.siemens.place import text_of

VALUE = r"[-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)"
WORD = re.compile(
    r"(?<![A-Z0-9_$\"])(?:(?P<name>CR|AR|TURN|[IJK]1|[XYZABCIJKFG])(?P<equals>[ \t]*=)?[ \t]*"
    rf"(?:(?P<way>AC[PN]?|IC|DC)[ \t]*\([ \t]*(?P<in>{VALUE})[ \t]*\)|(?P<value>{VALUE}))"
    r"|(?P<command>CIP))(?![A-Z0-9_.])",
    re.IGNORECASE,
)
TEXT = re.compile(r'"[^"]*"')
COMPUTED = re.compile(r"(?P<name>[A-Z][A-Z0-9]*)[ \t]*=[ \t]*(?P<way>AC[PN]?|IC|DC)?", re.I)
AXES = frozenset("XYZABC")
LENGTHS = {"I": "I", "J": "J", "K": "K", "R": "CR="}
OF_ARCS = frozenset(("CR", "AR", "TURN", "I1", "J1", "K1", "CIP", "I", "J", "K"))
ARCS = frozenset(("G2", "G3"))
PLAIN = frozenset(("word", "value", "function", "command"))
"""Kinds of items that may be words which do not compute."""
MOTIONS = frozenset(("G0", "G1", "G2", "G3"))
DISTANCES = frozenset(("G90", "G91"))


@dataclass(frozen=True)
class Word:
    """A word of a line: its name, AC or its like, where it stands, and `=` with its blanks.

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


def words_in(text: str, computed: Sequence[gx.Item] = ()) -> list[Word]:
    """Return the words of a line without its comment.

    `computed` are the items of one that computes, or in which words stand without blanks.
    """
    found = []
    if computed:
        for item in computed:
            part = text[slice(*item.place)]
            word = COMPUTED.match(part)
            if item.kind == "expression" and word is not None:
                found.append(Word(word["name"].upper(), (word["way"] or "").upper(), item.place))
            elif item.kind in PLAIN and (plain := WORD.fullmatch(part.rstrip())):
                found.append(_word(plain, item.place[0]))
        return found
    bare = TEXT.sub(lambda m: '"' * len(m[0]), text)
    return [_word(each, 0) for each in WORD.finditer(bare)]


def _word(found: re.Match[str], at: int) -> Word:
    place = at + found.start(), at + found.end()
    if found["command"]:
        return Word("CIP", "", place)
    group = "in" if found["in"] else "value"
    value = at + found.start(group), at + found.end(group)
    return Word(found["name"].upper(), (found["way"] or "").upper(), place, found[group], value)


def line_moved(text: str, words: Sequence[Word], change: v.Change) -> str | None:
    """Return a line without its comment for a block that became another; None without one."""
    if _others(change.was) != _others(change.now) or _twice(words):
        return None
    edits = _Edits(text, words, change)
    return edits.line() if edits.possible else None


def _others(block: v.BlockWords) -> tuple[object, ...]:
    """Return what a line keeps as it says it: all but motion, distance and words of the path."""
    codes = tuple(code for code in block.codes if code not in MOTIONS | DISTANCES)
    return codes, tuple(w for w in block.words if w[0] not in AXES | {*"FIJKRP"})


def _twice(words: Sequence[Word]) -> bool:
    names = [word.name for word in words if word.name != "G"]
    return len({*names}) != len(names)


class _Edits:
    """The changes of one line: parts of its text that become others."""

    def __init__(self, text: str, words: Sequence[Word], change: v.Change) -> None:
        self.text, self.words = text, words
        self.was, self.now, self.change = change.was, change.now, change
        self.old, self.new = dict(change.was.words), dict(change.now.words)
        self.possible = True
        self.made: list[tuple[int, int, str]] = []
        self.straightened = self.was.bends and not self._same_arc()

    def _same_arc(self) -> bool:
        return all(self.old.get(letter) == self.new.get(letter) for letter in "IJKRP") and (
            ARCS & {*self.was.codes} == ARCS & {*self.now.codes}
        )

    def line(self) -> str | None:
        """Return the line; None where it cannot be said."""
        for word in self.words:
            self._edit(word)
        self._add()
        text = self.text
        for start, end, new in sorted(self.made, reverse=True):
            text = text[:start] + new + text[end:]
        return text.rstrip() if self.possible else None

    def _edit(self, word: Word) -> None:
        if word.name in AXES:
            self._axis(word)
        elif word.name == "F":
            self._feed(word)
        elif self.straightened and (word.name in OF_ARCS or word.code in ARCS):
            self._drop(word)
        elif word.code == "G91" and not self.change.steps:
            self.made.append((*word.place, "G90"))
        elif word.code == "G90" and self.change.steps:
            self.possible = False

    def _axis(self, word: Word) -> None:
        """Change the word of an axis: it stays where it says the same, and goes where none is."""
        old, new = self.old.get(word.name), self.new.get(word.name)
        stepped = word.way == "IC" or (not word.way and self.change.stepped)
        if new is None:
            self._drop(word)
        elif word.way in ("DC", "ACP", "ACN") or self.change.steps != self.change.stepped:
            self._written(word, new) if word.way in ("", "AC", "IC") else self._refuse(old != new)
        elif old != new or (stepped and not self.change.steps):
            self._written(word, new)

    def _written(self, word: Word, new: Decimal) -> None:
        """Write a word with another number, and in its form."""
        if self.change.steps:
            self._number(word, new, "IC" if word.way == "IC" else "")
            self._refuse(word.way == "AC")
        else:
            self._number(word, new, "AC" if word.way else "")

    def _number(self, word: Word, new: Decimal, way: str) -> None:
        number = text_of(new)
        if word.number and word.way == way:
            self.made.append((*word.value, number))
            return
        equals = re.match(r"[A-Z]+[ \t]*=[ \t]*", self.text[slice(*word.place)], re.IGNORECASE)
        start = equals[0] if equals else self.text[word.place[0]]
        self.made.append((*word.place, f"{start}{way}({number})" if way else f"{start}{number}"))
        end = word.place[1]
        if not word.number and end < len(self.text) and not self.text[end].isspace():
            self.made.append((end, end, " "))

    def _feed(self, word: Word) -> None:
        old, new = self.old.get("F"), self.new.get("F")
        if new is not None and old != new:
            self._number(word, new, "")

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
        there = {word.code for word in self.words} - (ARCS if self.straightened else set())
        self._refuse(bool(there & MOTIONS - {*self.now.codes, *self.was.codes}))
        self._refuse(bool(there & MOTIONS and {*codes} & MOTIONS - there))
        had = {*self.was.codes} - (MOTIONS if self.straightened else set()) - self.change.due
        ways = [word.way for word in self.words if word.name in AXES]
        if (ways and all(ways)) or ("G91" in there and not self.change.steps):
            had |= DISTANCES
        lacking = [code for code in codes if code not in there | had]
        if lacking:
            head = HEAD.match(self.text)
            at = head.end() if head else 0
            self.made.append((at, at, " ".join(lacking) + " "))
        said = {word.name for word in self.words}
        ends = [*self._lacking(said)]
        if ends:
            at = len(self.text.rstrip())
            self.made.append((at, at, "".join(f" {each}" for each in ends)))

    def _lacking(self, said: set[str]) -> Iterator[str]:
        """Yield the words that a line has not; beside AC and IC it may be either that counts."""
        ways = {"AC", "IC"} & {word.way for word in self.words if word.name in AXES}
        way = ("IC" if self.change.steps else "AC") if ways else ""
        for letter, value in self.now.words:
            if letter in AXES and letter not in said:
                yield f"{letter}={way}({text_of(value)})" if way else letter + text_of(value)
            elif (letter in LENGTHS and self.straightened) or (letter == "F" and "F" not in said):
                yield LENGTHS.get(letter, letter) + text_of(value)
            self._refuse(letter in LENGTHS and not self.was.bends)
        if self.straightened and self.now.bends:
            self._refuse("P" in self.new)
