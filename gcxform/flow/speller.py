"""Languages of controls that are written: blocks of words become lines of the language."""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections import Counter
from collections.abc import Iterable
from typing import ClassVar

COMMENT = re.compile(r"\(([^()]*)\)")
WORD = re.compile(r"([A-Z])([-+]?[0-9.]+)")
BLANKS = str.maketrans("", "", " \t")
ASIDE = "\x01"
"""What a comment begins with that is none, but goes along as it was programmed, to a speller that
hears `asides`: a translator of the same language says them, and takes the sign out of comments."""
ALONG = "M9001"
"""The code of a block with asides: it makes them an event, which moves keep their place by."""
NAMED = "\x04"
"""What an aside begins with that is the name of the tool which T of its block is."""
TOLD = "\x05"
"""What an aside begins with that is told of that tool where it is called."""
HIDDEN, SHOWN = str.maketrans("()", "\x02\x03"), str.maketrans("\x02\x03", "()")


class UnspeakableError(Exception):
    """A block for which a language has no words; the sentence says why, the hint what to do."""

    def __init__(self, why: str, hint: str = "") -> None:
        super().__init__(why)
        self.hint = hint


class Speller(ABC):
    """Says the blocks of one program in another language, one after the other.

    Whatever comes out is read again by the grammar of the language, and has to be the same program.

    `inert` are M codes that leave the axes where they stand; `tool_name` is that of the T in the
    block that was heard last, if its program called it so, `tool_told` what is told of it there.
    `asides`: what goes along as it was
    programmed stands in comments, which nobody else than a translator can have written.
    `drills`: moves of holes may be said as cycles. `in_spindle` is the number of the tool there,
    which is known before the first block where the user has said it.
    `names_planes`: an arc names the axes of its plane by those of its centre, and none is in force.
    """

    names_planes: ClassVar[bool] = False
    inert: frozenset[str] = frozenset()
    asides: bool = False
    drills: bool = True
    in_spindle: str = ""
    tool_name: str = ""
    tool_told: str = ""

    def __init__(self, name: str, inch: bool) -> None:
        self.name = name
        self.inch = inch
        self.left_out: Counter[str] = Counter()
        """Codes for which there are no words and no need; the certificate lists them."""

    @staticmethod
    def parts(block: str) -> tuple[list[str], list[tuple[str, str]]]:
        """Return the comments of a block, and its words: letters and numbers."""
        comments = [each.strip(" \t") for each in COMMENT.findall(block)]
        bare = COMMENT.sub("", block).partition(";")[0]
        return comments, WORD.findall(bare.translate(BLANKS).upper())

    @staticmethod
    def aside(text: str) -> str:
        """Return what goes along as it was programmed, in a block."""
        return f"({ASIDE}{text.translate(HIDDEN)})"

    @classmethod
    def along(cls, text: str) -> str:
        """Return what goes along as it was programmed, in a block whose moves keep their place."""
        return f"{ALONG} {cls.aside(text)}"

    @classmethod
    def told(cls, text: str) -> str:
        """Return what is told of the tool of a block, as it goes along."""
        return cls.aside(f"{TOLD}{text}")

    def heard(self, block: str) -> tuple[list[str], list[str], list[tuple[str, str]]]:
        """Return what goes along as it was programmed, the other comments, and the words."""
        comments, words = self.parts(block)
        if not self.asides:
            return [], comments, words
        asides = [each[1:].translate(SHOWN) for each in comments if each.startswith(ASIDE)]
        self.tool_name = next((each[1:] for each in asides if each.startswith(NAMED)), "")
        self.tool_told = next((each[1:] for each in asides if each.startswith(TOLD)), "")
        asides = [each for each in asides if not each.startswith((NAMED, TOLD))]
        words = [each for each in words if not asides or each != (ALONG[0], ALONG[1:])]
        others = [each.translate(SHOWN) for each in comments if not each.startswith(ASIDE)]
        return asides, others, words

    def other_length(self, number: str) -> UnspeakableError:
        """Return why the length of a tool has no words that is not the one in the spindle."""
        if self.in_spindle not in ("", "0"):
            message = "the length of another tool than the one in the spindle"
            hint = f"lengths are of the tools there: write H{self.in_spindle}, if its own is meant"
            return UnspeakableError(message, hint)
        hint = f"write T and M6 before; or say tool = {number} in [input], if it is in the spindle"
        return UnspeakableError("a length, and which tool is in the spindle is not known", hint)

    @abstractmethod
    def lines(self, block: str) -> list[str]:
        """Return the lines that stand for a block. Raises UnspeakableError."""

    def lose(self) -> None:  # noqa: B027
        """Forget where the axes stand: something was executed that is not said here."""

    def opening(self) -> list[str]:
        """Return the lines before the first block, when all blocks have been said."""
        return []

    def closing(self) -> list[str]:
        """Return the lines behind the last block."""
        return []

    def gathered(self, lines: list[tuple[str, int]]) -> Iterable[tuple[str, int]]:
        """Return all lines, each with the line that it is for, where several are said in one."""
        return lines

    def numbered(self, lines: list[str]) -> list[str]:
        """Return all lines with the numbers that they have in the language."""
        return lines
