"""Blocks of words as lines for a SINUMERIK: `CR=`, `TURN=`, `T1 M6 D1`, `SUPA`, `G4 F`, `; text`.

One block after the other; what the language has no words for is refused by its name. What comes out
is read again, and has to be the program that was written: so nothing here needs to be believed.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from decimal import Decimal

import gcxform as gx
from gcxform_plugins.dialects.shared.ways import NO_EDGE, OTHER_RADIUS, UNSHIFTED
from gcxform_plugins.dialects.siemens.asides import AROUND
from gcxform_plugins.dialects.siemens.cycles import HOLE
from gcxform_plugins.dialects.siemens.cycles import PATH as KEPT_PATH
from gcxform_plugins.dialects.siemens.gathering import gathered
from gcxform_plugins.dialects.siemens.offsets import FURTHER, WORK
from gcxform_plugins.dialects.siemens.place import text_of
from gcxform_plugins.dialects.siemens.swivelling import PLANE, TURN
from gcxform_plugins.dialects.siemens.tapping import CODE, Tap, lines_of, turned

OFFSETS = {name: f"G{number}" for number, name in WORK.items()}
CODES = {
    "G20": "G700",
    "G21": "G710",
    "G61": "G60",
    "G49": "D0",
    **OFFSETS,
    **dict.fromkeys(("G80", "G91.1", "G97", "G98", "G99", "G50", "G69"), ""),
}
"""Codes by another name, or by none: where nothing else is read, nothing has to be said."""
SAME = frozenset(
    (
        *(f"G{number}" for number in FURTHER),
        *("G0", "G1", "G2", "G3", "G17", "G18", "G19", "G90", "G91", "G93", "G94", "G95", "G9"),
        *("G40", "G41", "G42", "G60", "G64", *AROUND),
    )
)
LETTERS = {"R": "CR=", **{letter: letter for letter in "XYZABCIJKFSN"}}
TAP = f"G{CODE}"
BY_PLACES = "write the tap in G90 and G17, in a block of its own"
PER_MINUTE = "write G94 before the tap, with F as its pitch times S"
MOTIONS = frozenset(("G0", "G1", "G2", "G3", TAP))
STEPPED = (
    "steps of Z behind another tool length: a setting decides whether they make up for it (SD42442)"
)
CUTS = MOTIONS - {"G0", TAP}
MOVES_ZERO = frozenset(
    ("G20", "G21", "G43", "G49", "G53", "M6", "G68", "G69", *OFFSETS, *OFFSETS.values())
)
AXES = frozenset("XYZABC")
BLENDS = re.compile(r"G64[1-5]")
KEPT_CALLS = frozenset(code[1:] for code in (HOLE, KEPT_PATH))
SLASH = re.compile(r"[ \t]*(/[0-9]?)")
OWN = (17, 128, 129, 9000, 9001)
NO_LENGTH = "0"
PATH = "$PATH="
"""What tells, right behind its semicolon, the folder of a program (PM 43)."""


class Lines(gx.Speller):
    """Writes blocks as lines for a SINUMERIK.

    tool      that of the last T, and `in_spindle`
    length    the number of the one in force, "0" for none, nothing where none has been said: behind
              M6 the machine file then says which edge is in force, or nothing may move
    height    where Z stands, None where that is not known
    spindle   M3 or M4, as it turns, or nothing;  speed: the S in force
    shifted   D has been said, and no absolute Z since
    feed      the F in force;  owed: behind a tap it has to be said again
    waits     M6 or SUPA has been, and D has not yet: it is said before Z moves, or by the next code
    """

    def __init__(self, name: str, inch: bool) -> None:
        super().__init__(name, inch)
        self.tool = self.length = ""
        self.waits = self.steps = False
        self.height: Decimal | None = None
        self.spindle = self.speed = self.motion = self.feed = ""
        self.owed = self.shifted = False
        self.plane, self.feed_mode = "G17", "G94"

    def lose(self) -> None:
        """Forget where the axes stand, and whether the spindle turns."""
        self.height, self.spindle = None, ""

    def lines(self, block: str) -> list[str]:
        """Return the lines for a block. Raises UnspeakableError."""
        asides, comments, words = self.heard(block)
        if any(BLENDS.search(each) for each in asides if not each.upper().startswith("MSG")):
            words = [each for each in words if each != ("G", "64")]
        slash = SLASH.match(block)
        if dict(words).get("G") in KEPT_CALLS:
            said = [*self._kept_call(dict(words), asides)]
        elif {("G", code[1:]) for code in (PLANE, TURN)} & {*words}:
            self.lose()
            said = [*self._numbered(dict(words), asides)]
        else:
            plain = [*self._said(words)]
            said = [*asides, *plain] if plain else [*self._numbered(dict(words), asides)]
        found = [f"{slash[1]}{line}" if slash else line for line in said]
        if comments:
            lead = ";" if comments[0].startswith(PATH) else "; "
            text = lead + " ".join(comments)
            found = [f"{found[0]} {text}", *found[1:]] if found else [text]
        return found

    def gathered(self, lines: list[tuple[str, int]]) -> Iterator[tuple[str, int]]:
        """Return all lines, with cycles for the moves of holes."""
        return gathered(lines) if self.drills else iter(lines)

    def _said(self, words: list[tuple[str, str]]) -> Iterator[str]:
        if not words:
            return
        words = _of_list(words)
        names = [letter + text_of(Decimal(text)) for letter, text in words]
        values = dict(words)
        self._check_m(names)
        number = f"N{values['N']} " if "N" in values else ""
        self._modes(names, values)
        if self.motion == TAP and not values.keys().isdisjoint(AXES):
            yield from self._tap(number, values, names)
            return
        if "G4" in names:
            yield f"{number}G4 F{values.pop('P', '0')}"
            words = [each for each in words if each[0] not in "NPG"]
        elif "G53" in names:
            yield from self._in_machine(number, names, words)
            return
        else:
            yield from self._tooled(number, names, values)
            self.shifted &= "Z" not in values or self.steps
        said = [*self._words(words, values)]
        if self.owed and self.motion in CUTS and not values.keys().isdisjoint(AXES | {*"IJKR"}):
            said += [f"F{self.feed}"] if "F" not in values and self.feed else []
            self.owed = False
        if any(word[0] != "N" for word in said):
            yield " ".join(said)

    def _kept_call(self, values: dict[str, str], asides: list[str]) -> Iterator[str]:
        """Yield the call of a cycle that stays, and before it an edge, and take its end."""
        if self.waits:
            yield self._edge
        yield from self._numbered(values, asides)
        self.height = Decimal(values["Z"]) if "Z" in values else None
        self.spindle, self.owed = "", True

    def _numbered(self, values: dict[str, str], asides: list[str]) -> Iterator[str]:
        """Yield what goes along in a line of its own, if anything does."""
        if asides:
            yield f"N{values['N']} {' '.join(asides)}" if "N" in values else " ".join(asides)

    def _check_m(self, names: list[str]) -> None:
        own = [name for name in names if name[0] == "M" and name[1:] in map(str, OWN)]
        if own:
            raise gx.UnspeakableError(f"{own[0]} is a function of the machine, or of blocks")

    # --- taps ---

    def _modes(self, names: list[str], values: dict[str, str]) -> None:
        """Take what is in force for taps, and where Z then stands."""
        for name in names:
            if name in MOTIONS:
                self.motion = name
            elif name in ("G17", "G18", "G19"):
                self.plane = name
            elif name in ("G90", "G91"):
                self.steps = name == "G91"
            elif name in ("G93", "G94", "G95"):
                self.feed_mode = name
        self.spindle = turned([name for name in names if name[0] == "M"], self.spindle)
        self.speed = text_of(Decimal(values["S"])) if "S" in values else self.speed
        self.feed = text_of(Decimal(values["F"])) if "F" in values else self.feed
        if not {*names}.isdisjoint(MOVES_ZERO):
            self.height = None
        if "Z" in values and self.motion != TAP:
            here = not self.steps and {*names}.isdisjoint(("G53", "M6"))
            self.height = Decimal(values["Z"]) if here else None

    def _tap(self, number: str, values: dict[str, str], names: list[str]) -> Iterator[str]:
        """Yield the lines of a tap from where the tool stands. Raises UnspeakableError."""
        others = {name for name in names if name[0] in "GM"} - {TAP, "G90"}
        if values.keys() - {*"NGZK"} or others or self.steps or self.plane != "G17":
            raise gx.UnspeakableError(
                "a tap by steps, beside other words, or out of G17", BY_PLACES
            )
        if self.feed_mode in ("G93", "G95"):
            raise gx.UnspeakableError(f"a tap by G331 in {self.feed_mode}", PER_MINUTE)
        bottom, pitch = Decimal(values.get("Z", "0")), Decimal(values.get("K", "0"))
        if self.height is None or "Z" not in values or not bottom < self.height or not pitch > 0:
            raise gx.UnspeakableError("a tap from where it is not known, upwards, or without pitch")
        if not self.spindle or not self.speed:
            raise gx.UnspeakableError("a tap, and how the spindle turns is not said before")
        if self.waits:
            yield self._edge
        top, end, by = (text_of(each) for each in (self.height, bottom, pitch))
        first, *rest = lines_of(Tap(top, end, by, self.spindle, self.speed))
        self.owed = True
        yield number + first
        yield from rest

    # --- tools ---

    def _tooled(self, number: str, names: list[str], values: dict[str, str]) -> Iterator[str]:
        """Yield the lines of T with M6, and of D for a length. Raises UnspeakableError.

        D is said where a word counts by it, and not before: in Z, or for a radius.
        """
        if "T" in values:
            self.tool = text_of(Decimal(values["T"]))
        if "M6" in names:
            if not self.tool:
                raise gx.UnspeakableError("M6, and which tool it takes is not said before")
            self.in_spindle, self.waits = self.tool, bool(self.length)
            yield f"{number}{self._tool_word} M6" if "T" in values else f"{number}M6"
        elif "T" in values:
            yield f"{number}{self._tool_word}"
        if "G43" in names:
            self.length = text_of(Decimal(values["H"])) if "H" in values else self.in_spindle
        elif "G49" in names:
            self.length = NO_LENGTH
        if self.shifted and self.steps and "Z" in values:
            raise gx.UnspeakableError(STEPPED, gx.put_before("absolute"))
        sides = not {"G41", "G42"}.isdisjoint(names)
        if sides and self.length in ("", NO_LENGTH):
            raise gx.UnspeakableError(*NO_EDGE)
        counts = "Z" in values or sides
        if (self.waits and counts) or not {"G43", "G49"}.isdisjoint(names):
            yield self._edge

    @property
    def _tool_word(self) -> str:
        return f'T="{self.tool_name}"' if self.tool_name else f"T{self.tool}"

    @property
    def _edge(self) -> str:
        """The word for the length in force. Raises UnspeakableError."""
        if self.length not in (NO_LENGTH, self.in_spindle):
            raise self.other_length(self.length)
        self.waits, self.shifted = False, True
        return "D0" if self.length == NO_LENGTH else "D1"

    # --- words ---

    def _words(self, words: list[tuple[str, str]], values: dict[str, str]) -> Iterator[str]:
        """Yield the words of a line but those of tools. Raises UnspeakableError."""
        for letter, text in words:
            name = letter + text_of(Decimal(text))
            if letter == "G" and name not in ("G43", "G49"):
                yield from self._code(name)
            elif letter == "M" and name != "M6":
                yield name
            elif letter in LETTERS:
                yield LETTERS[letter] + (text_of(Decimal(text)) if letter != "N" else text)
            elif letter == "P" and text.isdigit() and int(text) > 1:
                yield f"TURN={int(text) - 1}"
            elif letter == "D" and text_of(Decimal(text)) != self.length:
                raise gx.UnspeakableError(*OTHER_RADIUS)
            elif letter not in "DGHMOPT":
                raise gx.UnspeakableError(f"{letter} has no words on a SINUMERIK")

    def _code(self, name: str) -> Iterator[str]:
        if name not in SAME and name not in CODES:
            raise gx.UnspeakableError(f"{name} has no words on a SINUMERIK")
        if said := CODES.get(name, name):
            yield said

    def _in_machine(
        self, number: str, names: list[str], words: list[tuple[str, str]]
    ) -> Iterator[str]:
        """Yield SUPA, which asks for D0; the length that was in force waits."""
        rest = [each for each in words if each[0] != "N" and each != ("G", "53")]
        said = " ".join(self._words(rest, dict(rest)))
        yield f"{number}SUPA {said} D0"
        self.waits = bool(self.length)


def _of_list(words: list[tuple[str, str]]) -> list[tuple[str, str]]:
    """Return words with the code of a work offset beyond the sixth. Raises UnspeakableError."""
    if ("G", "54.1") not in words:
        return words
    name = f"G54.1 P{dict(words).get('P', '')}"
    if name not in OFFSETS:
        raise gx.UnspeakableError(f"{name} has no words on a SINUMERIK", UNSHIFTED)
    said = [("G", OFFSETS[name][1:]) if each == ("G", "54.1") else each for each in words]
    return [each for each in said if each[0] != "P"]
