"""Blocks of words as lines for a Fagor: `G71`, `G5`, `T1 M6`, `D1`, `G4 K2`, `; text`.

One block after the other; what the language has no words for is refused by its name. What comes out
is read again, and has to be the program that was written: so nothing here needs to be believed.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from decimal import Decimal

import gcxform as gx
from gcxform_plugins.dialects.fagor import tables
from gcxform_plugins.dialects.shared.ways import NO_EDGE, OTHER_RADIUS

CODES = {
    "G20": "G70",
    "G21": "G71",
    "G61": "G7",
    "G64": "G5",
    **dict.fromkeys(("G80", "G90.1", "G91.1", "G98", "G99", "G43", "G49", "G4"), ""),
}
"""Codes by another name, or by none: where nothing else is read, nothing has to be said."""
SAME = tables.PLAIN | tables.WORK | tables.COMP | {"G90", "G91"}
CORNERS = frozenset(("G61", "G64"))
"""How corners are taken, without how far (P, Q): the control has it elsewhere."""
SEMI_ROUNDED = "G50"
LONGEST = 14  # characters of the name of a program [Q 45]
ENDS = ("M2", "M30")
ONE_CENTRE = "a centre from the work zero by one word, and what the other one is there"
STEPPED = "steps of Z behind another tool length: whether they make up for it is not certain"


class Lines(gx.Speller):
    """Writes blocks as lines for a Fagor.

    tool    that of the last T, and `in_spindle`;  chosen: T has been since M6
    length  that of which tool is in force, "0" for none
    waits   M6 or a place of the machine has been, and D has not yet: it is said before a move
    bare    D0 was said last;  shifted: D was, and no absolute Z since;  steps: G91 is in force
    over    the program has ended;  headed: its name was heard
    placed  centres of arcs count from the work zero, and not from where an arc starts
    """

    def __init__(self, name: str, inch: bool) -> None:
        bare = re.sub(r"[^A-Z0-9_]", "", name.upper()) or "PART"
        bare = f"P{bare}" if bare.startswith("L") else bare
        super().__init__(bare[:LONGEST], inch)
        self.tool = self.in_spindle = self.length = "0"
        self.waits = self.over = self.bare = self.chosen = self.steps = self.shifted = False
        self.headed = self.placed = False

    def opening(self) -> list[str]:
        """Return the first line; one of this control may have had none."""
        return [f"%{self.name}"] if self.headed or not self.asides else []

    def lines(self, block: str) -> list[str]:
        """Return the lines for a block. Raises UnspeakableError."""
        asides, comments, words = self.heard(block)
        if asides and asides[0].startswith("%"):
            self.name, self.headed = asides.pop(0)[1:], True
        if SEMI_ROUNDED in asides:
            words = [each for each in words if each != ("G", "64")]
        found = [*asides, *self._said(words)]
        if comments:
            text = "; " + " ".join(comments)
            found = [f"{found[0]} {text}", *found[1:]] if found else [text]
        return found

    def _said(self, words: list[tuple[str, str]]) -> Iterator[str]:
        names = [letter + _plain(text) for letter, text in words]
        if self.over and any(name[0] != "N" for name in names):
            raise gx.UnspeakableError("something stands behind the end of the program")
        values = dict(words)
        if "G53" in names:
            yield from self._in_machine(words)
            return
        self.steps = "G91" in names or (self.steps and "G90" not in names)
        yield from self._tooled(names, values)
        if self.length == "0" and not {"G41", "G42"}.isdisjoint(names):
            raise gx.UnspeakableError(*NO_EDGE)
        if self.shifted and self.steps and "Z" in values:
            raise gx.UnspeakableError(STEPPED, gx.put_before("absolute"))
        self.shifted &= "Z" not in values
        if "G68" in names or "G69" in names:
            yield self._turned(names, values)
            return
        if "G4" in names:
            yield f"G4 K{_plain(values.pop('P', '0'))}"
        said = [*self._words(words, "G4" in names)]
        if self._is_placed(names, values):
            said.insert(said[0][0] == "N", "G6")
        if any(word[0] != "N" for word in said):
            yield " ".join(said)
        self.over |= not {*ENDS}.isdisjoint(names)

    def _turned(self, names: list[str], values: dict[str, str]) -> str:
        """Return the line of a turn about a point, or of none. Raises UnspeakableError."""
        on = "G68" in names
        if values.keys() - {*"GN"} != {*("XYR" if on else "")} or len(names) > len(values):
            raise gx.UnspeakableError("a turn beside other words, or about no point")
        about = (f" {word}{_plain(values[of])}" for word, of in zip("QIJ", "RXY", strict=True))
        return f"G73{''.join(about)}" if on else "G73"

    def _is_placed(self, names: list[str], values: dict[str, str]) -> bool:
        """Whether a block has a centre from the work zero: the code for that is for one block.

        Raises UnspeakableError.
        """
        self.placed = "G90.1" in names or (self.placed and "G91.1" not in names)
        given = values.keys() & {*"IJK"}
        if self.placed and len(given) == 1:
            raise gx.UnspeakableError(ONE_CENTRE)
        return self.placed and bool(given)

    def _tooled(self, names: list[str], values: dict[str, str]) -> Iterator[str]:
        """Yield the lines of T with M6, and of D for a length. Raises UnspeakableError."""
        if "T" in values:
            self.tool = _plain(values["T"])
        if "M6" in names and not (self.chosen or "T" in values):
            raise gx.UnspeakableError("M6, and which tool it takes is not said before")
        if "M6" in names:
            self.in_spindle, self.waits, self.bare = self.tool, True, False
            yield f"T{self.tool} M6"
            self.chosen = False
        elif "T" in values:
            self.chosen = True
            yield f"T{self.tool}"
        before = self.length
        if "G43" in names:
            self.length = _plain(values["H"]) if "H" in values else self.in_spindle
        elif "G49" in names:
            self.length = "0"
        moves = self.waits and not values.keys().isdisjoint("XYZABCUVWIJKR")
        if moves and "Z" not in values and self._beside(names):
            self.bare, self.shifted = False, True
            yield "D1"
        elif moves or before != self.length or not {"G43", "G49"}.isdisjoint(names):
            if self.length not in ("0", self.in_spindle):
                raise self.other_length(self.length)
            self.waits, self.bare, self.shifted = False, self.length == "0", True
            yield "D0" if self.bare else "D1"

    def _beside(self, names: list[str]) -> bool:
        """Whether the length in force is another tool's, and no code here says one.

        It waits for Z to move; D1 is said for moves that have no use for it.
        """
        codes = {"G43", "G49", "G18", "G19", "G68", "G41", "G42"}
        other = self.length not in ("0", self.in_spindle) and self.in_spindle != "0"
        return other and codes.isdisjoint(names)

    def _in_machine(self, words: list[tuple[str, str]]) -> Iterator[str]:
        """Yield the lines of a move to a place of the machine; the length in force waits.

        A G90 of it goes ahead, for the machine's coordinates are read in G90 alone.
        """
        if not self.bare:
            yield "D0"
        if ("G", "90") in words:
            yield "G90"
        self.bare, self.waits, self.shifted = True, self.length != "0", True
        yield "#MCS ON"
        ahead = {("G", "53"), ("G", "90")}
        yield " ".join(self._words([each for each in words if each not in ahead], False))
        yield "#MCS OFF"

    def _words(self, words: list[tuple[str, str]], waits: bool) -> Iterator[str]:
        """Yield the words of a line but those of tools. Raises UnspeakableError."""
        corners = any(letter + _plain(text) in CORNERS for letter, text in words)
        for letter, text in words:
            name = letter + _plain(text)
            if letter == "D" and _plain(text) != self.length:
                raise gx.UnspeakableError(*OTHER_RADIUS)
            if letter in "GM":
                yield from self._code(name)
            elif letter in tables.PLAIN_WORDS or letter == "N":
                yield letter + (_plain(text) if letter != "N" else text)
            elif letter not in "DTHO" and not (letter in "PQ" and (waits or corners)):
                raise gx.UnspeakableError(f"{letter} has no words on a Fagor")

    def _code(self, name: str) -> Iterator[str]:
        """Yield the word for a code, if it has one. Raises UnspeakableError."""
        if name[0] == "M" and name in tables.OF_BLOCKS:
            raise gx.UnspeakableError(f"{name} is of blocks, and no function of a Fagor")
        if name[0] == "G" and name not in SAME and name not in CODES:
            raise gx.UnspeakableError(f"{name} has no words on a Fagor")
        if name != "M6" and (said := CODES.get(name, name)):
            yield said


def _plain(text: str) -> str:
    """Return a number without a plus, and without zeros that say nothing."""
    number = format(Decimal(text), "f")
    number = number.rstrip("0").rstrip(".") if "." in number else number
    return "0" if number in ("-0", "") else number
