"""Lines one after the other that only go somewhere, translated at once.

lark parses the first line of each shape, and says whether lines of that shape are such ones: L with
X, Y and Z as numbers, R0, F or FMAX, in that order. From then on one expression, made of the pieces
of all such shapes, finds how far a run of them goes; nothing else says what a line is. A line that
the expression does not know, and the last one of each run, is translated by itself.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import accumulate
from typing import Any

import gcxform as gx
from gcxform_plugins.dialects.heidenhain.klartext import Klartext
from gcxform_plugins.dialects.heidenhain.words import LINEAR

NUMBER = "[+-]?[0-9]{1,9}(?:\\.[0-9]{0,9})?"
WORDS = re.compile("(?:N )?L(?: [XYZ]V)+(?: R0)?(?: FV| FMAX)?")
"""What words of a line have to be, each by a letter: then its block is what is left of it."""
LEFT_OUT = re.compile(r"^(?:[0-9]+ )?L | R0| FMAX|\+", re.MULTILINE)
MOST_SHAPES = 32
LEAST = 2  # lines


class Runs(Klartext):
    """Translates runs of lines."""

    def __init__(self, *program: Any) -> None:
        super().__init__(*program)
        self._known: dict[bool, dict[str, None]] = {True: {}, False: {}}
        self._runs: dict[bool, re.Pattern[str]] = {}
        self._text, self._starts = "", [0]

    def routine(self, items: Sequence[gx.Item], text: str) -> bool:
        """Take a shape, of which `text` is a line; return whether such lines come in runs."""
        said = " ".join(map(_word, items))
        named = re.findall("[XYZ]", said)
        plain = " ".join("".join((*item.names, *item.numbers)) for item in items)
        if not WORDS.fullmatch(said) or plain != text or len(set(named)) != len(named):
            return False
        rapid = said.endswith("FMAX")
        if len(self._known[rapid]) < MOST_SHAPES:
            pattern = said.replace("N ", "[0-9]{1,9} ").replace("V", f"(?>{NUMBER})")
            self._known[rapid][pattern] = None
            self._runs[rapid] = re.compile(f"(?:(?:{'|'.join(self._known[rapid])})\n)+")
        return True

    def several(self) -> list[str]:
        """Return the blocks of lines from this one on; nothing where it stands by itself."""
        rapid = self.lines[self.line].endswith("FMAX")
        if self._hangs_on_more(rapid):
            return []
        if len(self._starts) != len(self.lines) + 1:
            self._text = "".join(f"{line}\n" for line in self.lines)
            self._starts = [0, *accumulate(len(line) + 1 for line in self.lines)]
        found = self._runs[rapid].match(self._text, self._starts[self.line])
        if found is None or found[0].count("\n") <= LEAST:
            return []
        text = found[0][: found[0].rindex("\n", 0, -1)]
        if " F" in text and not rapid and self.inch:
            return []
        if " R" in text and self.side:
            return []
        blocks = LEFT_OUT.sub("", text)
        code = self.moving("G0" if rapid else "G1")
        self._take(blocks)
        return f"{code}{' ' if code else ''}{blocks}".split("\n")

    def _hangs_on_more(self, rapid: bool) -> bool:
        """Whether lines are translated by more than what they say."""
        beside = not self.begun or self.over or self.begins is not None
        return beside or (self.feed_lost and not rapid)

    def _take(self, blocks: str) -> None:
        """Take note of where blocks lead, and how fast."""
        for letter in (*LINEAR, "F"):
            at = blocks.rfind(letter)
            if at < 0:
                continue
            number = blocks[at + 1 :].partition(" ")[0].partition("\n")[0]
            if letter == "F":
                self.feed_word(number)
                continue
            self.place[letter] = number
            self.moved.add(letter)
            if letter != "Z":
                self.polar = None


def _word(item: gx.Item) -> str:
    """Return a word of a line with a letter for its number."""
    if item.kind == "seq":
        return "N"
    if item.kind == "radius":
        return f"{item.name}0" if item.numbers == ("0",) else "?"
    return item.name + "V" * len(item.numbers)
