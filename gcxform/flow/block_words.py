"""Blocks of words that became others, as a translator is told of them."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import field
from decimal import Decimal
from functools import cached_property

from gcxform.flow.speller import ASIDE, Speller
from gcxform.values import dataclass

LINEAR = frozenset("XYZ")
AXES = LINEAR | frozenset("ABCUVW")
BENDS = frozenset("IJKR")
ARCS = frozenset(("G2", "G3"))
MOTIONS = frozenset(("G0", "G1")) | ARCS
SIDES = frozenset(("G40", "G41", "G42", "G41.1", "G42.1"))
DISTANCES = frozenset(("G90", "G91"))
SHIFTS = re.compile(
    r"G(?:5[4-9](?:\.[0-9]+)?|4[39](?:\.1)?|5[0-2](?:\.1)?|92|10|2[0-1]|68|69|28|30)|M6|M128|M129"
)
"""Codes behind which the same words lead elsewhere, or axes are where no word says."""
ELSEWHERE = re.compile(r"G(?:5[0-2](?:\.1)?|43\.1|10|68|28|30)")
"""Those whose words are no places where the axes then stand."""
VALUE = r"[-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)"
At = dict[str, Decimal]


@dataclass(frozen=True)
class BlockWords:
    """What a block says, but for its number: codes, numbers of other words by letter, comments.

    Codes and words are in the order of letters, so two blocks are equal that say the same.
    """

    codes: tuple[str, ...]
    words: tuple[tuple[str, Decimal], ...]
    comments: tuple[str, ...]

    @property
    def text(self) -> str:
        """The block, as it is said to a speller."""
        words = [f"{letter}{format(value, 'f')}" for letter, value in self.words]
        return " ".join([*self.codes, *words, *(f"({each})" for each in self.comments)])

    @cached_property
    def positions(self) -> tuple[tuple[str, Decimal], ...]:
        """The words of axes."""
        return tuple((letter, value) for letter, value in self.words if letter in AXES)

    @property
    def bends(self) -> bool:
        """Whether it has words of an arc."""
        return any(letter in BENDS for letter, _ in self.words) or not ARCS.isdisjoint(self.codes)

    @property
    def shifts(self) -> bool:
        """Whether the same words lead elsewhere behind it."""
        return any(SHIFTS.fullmatch(code) for code in self.codes)

    @property
    def moves(self) -> bool:
        """Whether its words of axes are places to which these go."""
        return not any(ELSEWHERE.fullmatch(code) for code in self.codes)

    @property
    def leads(self) -> bool:
        """Whether it goes somewhere."""
        return self.moves and bool(self.positions or self.bends)

    @property
    def in_machine(self) -> bool:
        """Whether its words are places of the machine."""
        return "G53" in self.codes

    def steps(self, before: bool) -> bool:
        """Return whether its words count from where the axes stand."""
        said = [code for code in self.codes if code in ("G90", "G91")]
        return said[-1] == "G91" if said else before

    def at(self, inside: Mapping[str, Decimal]) -> BlockWords:
        """Return the block with other words of X, Y and Z."""
        rest = [(letter, value) for letter, value in self.words if letter not in LINEAR]
        return BlockWords(self.codes, (*inside.items(), *rest), self.comments)

    def saying(self, code: str) -> BlockWords:
        """Return the block with a code."""
        return BlockWords(tuple(sorted({*self.codes, code})), self.words, self.comments)


@dataclass(frozen=True)
class Change:
    """One block that became another, both as their words count where the line stands.

    `stepped`, `steps`: whether the words of the first, and of the other, count from where the axes
    stand, which is at `stood`, and `stands`, outside of any frame. `due` are codes of the other
    that have to be said in any case. `modes` has the motion and the side that hold for the other,
    if they are known. `beside`: the block before it, or behind it, became another.
    """

    was: BlockWords
    now: BlockWords
    stepped: bool
    steps: bool
    due: frozenset[str] = frozenset()
    stood: At = field(default_factory=dict)
    stands: At = field(default_factory=dict)
    modes: Mapping[str, str] = field(default_factory=dict)
    beside: bool = False


@dataclass(frozen=True)
class Worded:
    """Lines of a language that have nothing but words, as their blocks have them.

    `line` has a group for what stands before the `words`, its `head`; `signed`: numbers of words
    have a plus, but for those that had none.
    """

    line: re.Pattern[str] = re.compile(
        rf"(?P<head>)(?P<words>(?:[ \t]*[NGXYZABCFMS]{VALUE})+)"
        r"(?=[ \t]*(?:;|(?:\([^()]*\)?[ \t]*)?\Z))",
        re.IGNORECASE,
    )
    signed: bool = False

    def number(self, letter: str, new: str, old: str | None) -> str:
        """Return a number of a block as a word has it, in place of an old one."""
        text = new.lstrip("+")
        text = text.rstrip("0").rstrip(".") if "." in text else text
        text = "0" if text in ("", "-0", "-") else text
        plus = self.signed and letter != "F" and (old is None or old[:1] in "+-")
        return f"+{text}" if plus and not text.startswith("-") else text


def block_of(text: str) -> BlockWords:
    """Return what a block says."""
    comments, words = Speller.parts(text)
    codes = [_code(letter, number) for letter, number in words if letter in "GM"]
    others = [(letter, Decimal(number)) for letter, number in words if letter not in "GMN"]
    return BlockWords(tuple(sorted(codes)), tuple(sorted(others)), tuple(comments))


def _code(letter: str, number: str) -> str:
    plain = format(Decimal(number), "f")
    return letter + (plain.rstrip("0").rstrip(".") if "." in plain else plain)


def as_text(block: BlockWords) -> bytes:
    """Return a block, as it is said to a speller, without what goes along with it."""
    bare = tuple(each for each in block.comments if not each.startswith(ASIDE))
    return BlockWords(block.codes, block.words, bare).text.encode("latin-1")
