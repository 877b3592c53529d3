"""What lines of nothing but words become, by others of their form that were spelled before.

A line, its block, and the one that this became, each without its numbers, say together which words
go where: of all lines of one form the first is spelled word by word, and of the rest only the
numbers. What comes out is read again with all else (`gcxform/proof/refolded.py`).
"""

from __future__ import annotations

import re
from decimal import Decimal

from gcxform.flow.block_words import AXES, DISTANCES, VALUE, At, BlockWords, Worded, block_of
from gcxform.flow.speller import COMMENT, WORD
from gcxform.values import dataclass

NUMBERS = re.compile(rf"(?<![GMgm0-9.]){VALUE}")
"""Numbers of all words but codes."""
STAYING = frozenset("NS")
Key = tuple[str, str, str]
Numbers = dict[str, str]


@dataclass(frozen=True)
class Form:
    """A format for the words of a line, and the letters of those whose numbers it takes."""

    text: str
    words: str


class AlikeLines:
    """The forms of lines that were spelled, and where the axes stand behind those that are alike.

    `worded` says what lines are that have nothing but words, as their blocks have them. `was` has
    the last words of blocks as they were read, by letter, `now` of what those became.
    """

    def __init__(self, worded: Worded) -> None:
        self.worded = worded
        self.forms: dict[Key, Form | None] = {}
        self.free: dict[str, bool] = {}
        self.was: Numbers = {}
        self.now: Numbers = {}

    def spelled(self, raw: str, was: str, now: str) -> str | None:
        """Return the line for a block that became another; None where its form is new."""
        form = self.forms.get(_key(raw, was, now))
        if form is None:
            return None
        before, behind = _words(was), _words(now)
        self.was |= before
        self.now |= behind
        head, words, rest = self._parts(raw)
        return head + self._filled(form, _words(words.upper()), before, behind) + rest

    def passes(self, block: str) -> bool:
        """Go on behind a block that stays; whether its words lead where they did before it."""
        form = NUMBERS.sub("%", block)
        free = self.free.get(form)
        if free is None:
            free = self.free[form] = _free(block_of(block))
        if free:
            words = _words(block)
            self.was |= words
            self.now |= words
        return free

    def learn(self, raw: str, was: str, now: str, found: str) -> None:
        """Take note of a line that was spelled."""
        key = _key(raw, was, now)
        if key in self.forms:
            return
        self.forms[key] = None
        head, words, rest = self._parts(raw)
        plain = words and _free(block_of(was)) and _free(block_of(now))
        if not plain or not found.endswith(rest):
            return
        form = _form_of(found[len(head) : len(found) - len(rest)])
        if head + self._filled(form, _words(words.upper()), _words(was), _words(now)) + rest == (
            found
        ):
            self.forms[key] = form

    def _parts(self, raw: str) -> tuple[str, str, str]:
        """Return what stands before the words of a line, these, and blanks with a comment."""
        found = self.worded.line.match(raw)
        if found is None:
            return "", "", raw
        return found["head"], found["words"], raw[found.end() :]

    def _filled(self, form: Form, said: Numbers, before: Numbers, behind: Numbers) -> str:
        """Return the words of a form: what their block says as before stands as it did."""
        numbers = []
        for letter in form.words:
            old, new = said.get(letter), behind.get(letter)
            same = old is not None and new is not None and _same(before.get(letter), new)
            if letter in STAYING or new is None or same:
                numbers.append(old or "")
            else:
                numbers.append(self.worded.number(letter, new, old))
        return form.text % tuple(numbers)

    def settle(self, before: At, behind: At) -> None:
        """Tell where the axes stand behind all lines so far, as they were read and as written."""
        for at, words in ((before, self.was), (behind, self.now)):
            at |= {axis: Decimal(words[axis]) for axis in AXES & words.keys()}
            words.clear()


def _key(raw: str, was: str, now: str) -> Key:
    return NUMBERS.sub("%", raw), NUMBERS.sub("%", was), NUMBERS.sub("%", now)


def _words(block: str) -> Numbers:
    return dict(WORD.findall(COMMENT.sub("", block)))


def _free(block: BlockWords) -> bool:
    """Whether the words of a block are places, and those behind it lead where they did before."""
    return not (block.shifts or block.in_machine or block.bends or DISTANCES & {*block.codes})


def _form_of(text: str) -> Form:
    letters = "".join(text[m.start() - 1].upper() for m in NUMBERS.finditer(text))
    return Form(NUMBERS.sub("%s", text.replace("%", "%%")), letters)


def _same(one: str | None, other: str) -> bool:
    return one == other or (one is not None and Decimal(one) == Decimal(other))
