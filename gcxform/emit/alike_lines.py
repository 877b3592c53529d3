"""What lines of nothing but words become, by others of their form that were spelled before.

A line, its block, and the one that this became, each without its numbers, say together which words
go where: of all lines of one form the first is spelled word by word, and of the rest only the
numbers. What comes out is read again with all else (`gcxform/proof/refolded.py`).
"""

from __future__ import annotations

import re
from decimal import Decimal

from gcxform.flow.block_words import AXES, DISTANCES, At, BlockWords, block_of
from gcxform.flow.speller import COMMENT, WORD
from gcxform.values import dataclass

VALUE = r"[-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)"
NUMBERS = re.compile(rf"(?<![GMgm0-9.]){VALUE}")
"""Numbers of all words but codes."""
PLAIN = re.compile(rf"(?:[ \t]*[NGXYZABCFMS]{VALUE})+(?=[ \t]*(?:;|\Z))", re.IGNORECASE)
"""Words that a line has as its block has them."""
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

    `was` has the last words of blocks as they were read, by letter, `now` of what those became.
    """

    def __init__(self) -> None:
        self.forms: dict[Key, Form | None] = {}
        self.free: dict[str, bool] = {}
        self.was: Numbers = {}
        self.now: Numbers = {}

    def spelled(self, raw: str, was: str, now: str) -> str | None:
        """Return the line for a block that became another; None where its form is new."""
        form = self.forms.get(_key(raw, was, now))
        if form is None:
            return None
        said, before, behind = _said(raw), _words(was), _words(now)
        self.was |= before
        self.now |= behind
        return _filled(form, said, before, behind) + _rest(raw)

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
        rest = _rest(raw)
        plain = PLAIN.match(raw) and _free(block_of(was)) and _free(block_of(now))
        if not plain or not found.endswith(rest):
            return
        form = _form_of(found[: len(found) - len(rest)])
        if _filled(form, _said(raw), _words(was), _words(now)) + rest == found:
            self.forms[key] = form

    def settle(self, before: At, behind: At) -> None:
        """Tell where the axes stand behind all lines so far, as they were read and as written."""
        for at, words in ((before, self.was), (behind, self.now)):
            at |= {axis: Decimal(words[axis]) for axis in AXES & words.keys()}
            words.clear()


def _key(raw: str, was: str, now: str) -> Key:
    return NUMBERS.sub("%", raw), NUMBERS.sub("%", was), NUMBERS.sub("%", now)


def _words(block: str) -> Numbers:
    return dict(WORD.findall(COMMENT.sub("", block)))


def _said(raw: str) -> Numbers:
    """Return the words of a line; those in its comment are none."""
    words = PLAIN.match(raw)
    return _words(words[0].upper()) if words else {}


def _free(block: BlockWords) -> bool:
    """Whether the words of a block are places, and those behind it lead where they did before."""
    return not (block.shifts or block.in_machine or block.bends or DISTANCES & {*block.codes})


def _rest(raw: str) -> str:
    """Return what stands behind the words of a line: blanks, and a comment."""
    words = PLAIN.match(raw)
    return raw[words.end() :] if words else ""


def _form_of(text: str) -> Form:
    letters = "".join(text[m.start() - 1].upper() for m in NUMBERS.finditer(text))
    return Form(NUMBERS.sub("%s", text.replace("%", "%%")), letters)


def _filled(form: Form, said: Numbers, before: Numbers, behind: Numbers) -> str:
    """Return the words of a form: what their block says as before stands as it did."""
    numbers = []
    for letter in form.words:
        new = behind.get(letter)
        if letter in STAYING or new is None or (letter in said and _same(before.get(letter), new)):
            numbers.append(said.get(letter, ""))
        else:
            numbers.append(_plain(new))
    return form.text % tuple(numbers)


def _same(one: str | None, other: str) -> bool:
    return one == other or (one is not None and Decimal(one) == Decimal(other))


def _plain(number: str) -> str:
    number = number.lstrip("+")
    number = number.rstrip("0").rstrip(".") if "." in number else number
    return "0" if number in ("", "-0", "-") else number
