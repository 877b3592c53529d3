"""Lines of a SINUMERIK whose block became another one: words are changed where they stand.

A word that counts from where its axis stands becomes absolute, in AC, where the block is so.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from decimal import Decimal
from typing import ClassVar

import gcxform as gx
from gcxform import vocabulary as v
from gcxform_plugins.dialects.shared.words import text_of
from gcxform_plugins.dialects.shared.words_moved import Edits, Word
from gcxform_plugins.dialects.siemens.going_along import HEAD

VALUE = r"[-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)"
WORD = re.compile(
    r"(?<![A-Z0-9_$\"])(?:(?P<name>CR|AR|TURN|[IJK]1|[XYZABCIJKFG])(?P<equals>[ \t]*=)?[ \t]*"
    rf"(?:(?P<way>AC[PN]?|IC|DC)[ \t]*\([ \t]*(?P<in>{VALUE})[ \t]*\)|(?P<value>{VALUE}))"
    r"|(?P<command>CIP))(?![A-Z0-9_.])",
    re.IGNORECASE,
)
TEXT = re.compile(r'"[^"]*"')
COMPUTED = re.compile(r"(?P<name>[A-Z][A-Z0-9]*)[ \t]*=[ \t]*(?P<way>AC[PN]?|IC|DC)?", re.I)
PLAIN = frozenset(("word", "value", "function", "command"))
"""Kinds of items that may be words which do not compute."""


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
    return _Edits(text, words, change).line()


class _Edits(Edits):
    """The changes of a line of a SINUMERIK."""

    head = HEAD
    axes = frozenset("XYZABC")
    of_arcs = frozenset(("CR", "AR", "TURN", "I1", "J1", "K1", "CIP", "I", "J", "K"))
    lengths: ClassVar[Mapping[str, str]] = {"I": "I", "J": "J", "K": "K", "R": "CR="}

    @property
    def _ways(self) -> list[str]:
        return [word.way for word in self.words if word.name in self.axes]

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
        number, same = text_of(new), bool(word.number) and word.way == way
        self._put(word, f"{way}({number})" if way and not same else number, same)

    def _is_told(self) -> bool:
        return bool(self._ways) and all(self._ways)

    def _word(self, letter: str, value: Decimal) -> str:
        """Return a word; beside AC and IC it may be either that counts."""
        way = ("IC" if self.change.steps else "AC") if {"AC", "IC"} & {*self._ways} else ""
        return f"{letter}={way}({text_of(value)})" if way else letter + text_of(value)
