"""Lines of a TNC whose block became another one: words are changed where they stand.

A word keeps its place, its blanks and its sign. One with I stays a step where what it counts from
is known, and says how far it goes from where the axis stands now. An arc that became lines is an L,
and so is what polar coordinates lead to. What a block does not say of a line stays in it; what
cannot be said is no line.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal

from gcxform import vocabulary as v
from gcxform_plugins.dialects.heidenhain.numerals import signed
from gcxform_plugins.dialects.heidenhain.spelling import PATH
from gcxform_plugins.dialects.heidenhain.words import exact
from gcxform_plugins.dialects.shared.words_moved import edited

WORD = re.compile(
    r"(?P<plain>F[ \t]*(?:MAX|AUTO)(?![A-Z])|DR[ \t]*[-+](?![0-9.,])|R[LR](?![A-Z0-9]))"
    r"|(?P<name>I?P[AR]|I?[XYZABCUVW]|[RFM])(?P<blank>[ \t]*)"
    r"(?:(?P<value>[-+]?(?:[0-9]+(?:[.,][0-9]*)?|[.,][0-9]+))|(?P<q>[-+]?Q[LR]?[0-9]+))"
    r"|(?P<bare>[RFM])(?=[ \t]|$)",
    re.IGNORECASE,
)
BLANKS = re.compile(r"[ \t]*")
ORDER = "XYZABCUVW"
AXES = frozenset(ORDER)
STEPPED = frozenset(f"I{axis}" for axis in AXES)
POLAR = frozenset(("PR", "PA", "IPR", "IPA"))
CENTRES = {"I": "X", "J": "Y", "K": "Z"}
OF_PATH = frozenset("FIJKRPD") | AXES
SENSES = {"G3": "DR+", "G2": "DR-"}
OFF = frozenset(("", "G40"))
SIDES = frozenset(("G40", "G41", "G42", "G41.1", "G42.1"))
PLANES = frozenset(("G17", "G18", "G19"))
MOTIONS = frozenset(("G0", "G1", "G2", "G3"))
RAPID, AUTO = "FMAX", "FAUTO"
LIMITS = "M128"
"""Behind it F is that of other moves."""


@dataclass(frozen=True)
class Word:
    """A word of a line: its name, where it stands, its number, or the parameter that stands for it.

    `head` is what stands before the number.
    """

    name: str
    place: tuple[int, int]
    head: str = ""
    number: str = ""
    parameter: str = ""

    @property
    def value(self) -> Decimal | None:
        """The number, where the line says it."""
        return Decimal(self.number.replace(",", ".")) if self.number else None

    def saying(self, new: Decimal, name: str = "") -> str:
        """Return the word with another number, and perhaps as another one."""
        bare = self.number[:1] not in ("+", "-", "") and name in ("", self.name)
        text = exact(new) if bare else signed(new)
        text = text.replace(".", ",") if "," in self.number else text
        return f"{name or self.head[: len(self.name)]}{self.head[len(self.name) :]}{text}"


def words_in(text: str) -> list[Word] | None:
    """Return the words of a line without its comment, path function first; None for another one."""
    path = PATH.match(text)
    if path is None:
        return None
    found, at = [Word(path[1].upper(), path.span(1))], path.end()
    while at := BLANKS.match(text, at).end():  # type: ignore[union-attr]
        if at == len(text):
            return found
        word = WORD.match(text, at)
        if word is None:
            return None
        found.append(_word(word, found[-1]))
        at = word.end()
    return None


def _word(found: re.Match[str], before: Word) -> Word:
    place = found.span()
    if found["plain"] or found["bare"]:
        return Word(re.sub(r"[ \t]", "", found[0]).upper(), place)
    name = found["name"].upper()
    if name == "F" and f"{before.name}{before.number.lstrip('0')}" == LIMITS:
        name = "limit"
    head, number = found["name"] + found["blank"], found["value"] or ""
    return Word(name, place, head, number, found["q"] or "")


@dataclass(frozen=True)
class Place:
    """Where a line stands: its unit, whether the CC before it says where, and whether it cannot.

    `about`: the line before is CC with both its coordinates; `counts`: steps are from where the
    axes stand, and not from a corner that is rounded.
    """

    inch: bool = False
    about: bool = False
    counts: bool = True


def line_moved(text: str, change: v.Change, place: Place) -> str | None:
    """Return a line without its comment for a block that became another; None without one."""
    words = words_in(text)
    if words is None or _others(change.was) != _others(change.now):
        return None
    edits = _Edits(text, words, change, place)
    return edits.line() if edits.possible else None


def _others(block: v.BlockWords) -> tuple[object, ...]:
    """Return what a line keeps as it says it: all but motion, plane, side and path."""
    codes = tuple(c for c in block.codes if c not in MOTIONS | SIDES | PLANES)
    return codes, tuple(w for w in block.words if w[0] not in OF_PATH)


class _Edits:
    """The changes of one line: parts of its text that become others."""

    def __init__(self, text: str, words: Sequence[Word], change: v.Change, place: Place) -> None:
        self.text, self.change, self.place = text, change, place
        self.path, self.words = words[0], words[1:]
        self.old, self.new = dict(change.was.words), dict(change.now.words)
        self.made: list[tuple[int, int, str]] = []
        self.names = {word.name for word in self.words}
        self.straight = not change.now.bends
        self.possible = self._is_sayable()

    def _is_sayable(self) -> bool:
        """Whether the line may go where its block does, and as fast."""
        named = [word.name.lstrip("I") for word in self.words if word.name in AXES | STEPPED]
        motion = self.change.modes.get("motion", "")
        rapid = RAPID in self.names
        moves = bool(self.change.now.positions)
        if len(named) != len({*named}) or (moves and motion and rapid != (motion == "G0")):
            return False
        if (SIDES - OFF & {*self.change.now.codes}) and not self._has_side():
            return False
        return self.straight or (self.change.was.bends and self._bends_alike(motion))

    def _has_side(self) -> bool:
        same = SIDES & {*self.change.was.codes} >= SIDES & {*self.change.now.codes}
        return same and self.old.get("D") == self.new.get("D")

    def _bends_alike(self, motion: str) -> bool:
        """Whether C or CR says an arc as it says the one before, with other ends."""
        if SENSES.get(motion, "") not in self.names or self.names & POLAR or "P" in self.new:
            return False
        if self.path.name == "CR":
            return "R" in self.new
        if self.path.name != "C" or "R" in self.new or not self.place.about:
            return False
        return all(self._stays(letter, axis) for letter, axis in CENTRES.items())

    def _stays(self, letter: str, axis: str) -> bool:
        """Whether a coordinate of the centre is what it was."""
        if letter not in self.old and letter not in self.new:
            return True
        stood, stands = self.change.stood.get(axis), self.change.stands.get(axis)
        if stood is None or stands is None:
            return False
        zero = Decimal(0)
        return stood + self.old.get(letter, zero) == stands + self.new.get(letter, zero)

    def line(self) -> str | None:
        """Return the line; None where it cannot be said."""
        if self.path.name != "L" and self.straight and not self._is_polar_still():
            self._straighten()
        for word in self.words:
            self._edit(word)
        self._add()
        return edited(self.text, self.made).rstrip() if self.possible else None

    def _is_polar_still(self) -> bool:
        """Whether polar coordinates say all, and lead where they did."""
        return (
            self.path.name == "LP"
            and POLAR & self.names == {"PR", "PA"}
            and self.change.was == self.change.now
        )

    def _straighten(self) -> None:
        """Make an L of the line: its polar words, its radius and its sense go."""
        self.made.append((*self.path.place, "L"))
        for word in self.words:
            if word.name in POLAR or word.name[:2] == "DR" or self._is_size(word):
                self._drop(word)

    def _is_size(self, word: Word) -> bool:
        return word.name == "R" and self.path.name == "CR" and word.value != 0

    def _edit(self, word: Word) -> None:
        if word.name in AXES:
            self._axis(word, word.name)
        elif word.name in STEPPED:
            self._step(word, word.name[1:])
        elif word.name in ("RL", "RR") and self.change.modes.get("side", "") in OFF:
            self._drop(word)
        elif word.name in ("F", AUTO):
            self._feed(word)
        elif not self.straight and self._is_size(word) and self.old.get("R") != self.new["R"]:
            self.made.append((*word.place, word.saying(self.new["R"])))

    def _axis(self, word: Word, axis: str) -> None:
        """Change the word of an axis that says its place; it goes where the block has none."""
        new = self.new.get(axis)
        if new is None:
            self._drop(word)
        elif (word.value if word.number else self.old.get(axis)) != new:
            self.made.append((*word.place, word.saying(new)))

    def _step(self, word: Word, axis: str) -> None:
        """Change a step: where that is not from where the axis stands, it becomes a place."""
        new, stands = self.new.get(axis), self.change.stands.get(axis)
        stood = self.change.stood.get(axis)
        if new is None:
            self._drop(word)
            return
        if stands is None or not self.place.counts:
            self.made.append((*word.place, word.saying(new, word.head[1 : len(word.name)])))
            return
        said = word.value
        if not word.number and stood is not None and axis in self.old:
            said = self.old[axis] - stood
        if said != new - stands:
            self.made.append((*word.place, word.saying(new - stands)))

    def _feed(self, word: Word) -> None:
        """Change F: of a program in inches it is in tenths of them."""
        new = self.new.get("F")
        if new is None:
            return
        said = None if word.value is None else self._fed(word.value, down=True)
        if (said if word.number else self.old.get("F")) != new:
            head = word.head or "F"
            self.made.append((*word.place, f"{head}{exact(self._fed(new))}"))

    def _fed(self, value: Decimal, down: bool = False) -> Decimal:
        return value.scaleb(-1 if down else 1) if self.place.inch else value

    def _drop(self, word: Word) -> None:
        """Take a word out, with the blanks behind it."""
        start, end = word.place
        self.made.append((start, BLANKS.match(self.text, end).end(), ""))  # type: ignore[union-attr]

    def _add(self) -> None:
        """Put in what the line does not say: axes in their order, F before M functions."""
        said = {word.name.lstrip("I") for word in self.words}
        named = [word for word in self.words if word.name in AXES | STEPPED]
        at = max((word.place[1] for word in named), default=self.path.place[1])
        lacking = [axis for axis in ORDER if axis in self.new and axis not in said]
        moving = [axis for axis in lacking if not self._is_there(axis)]
        for axis in moving if moving or named else lacking:
            new = self.new[axis]
            later = (w.place[0] for w in named if ORDER.index(w.name[-1]) > ORDER.index(axis))
            before = next(later, None)
            text = f"{axis}{signed(new)}"
            self._put(*((at, f" {text}") if before is None else (before, f"{text} ")))
        if "F" in self.new and not {"F", AUTO} & self.names:
            self.possible &= RAPID not in self.names
            self._put(self._behind(at), f" F{exact(self._fed(self.new['F']))}")

    def _is_there(self, axis: str) -> bool:
        """Whether an axis that the line never said stands where its block leads."""
        return axis in self.old and self.change.stands.get(axis) == self.new[axis]

    def _behind(self, at: int) -> int:
        """Return where F goes: behind what stands before M functions."""
        words = [word for word in self.words if word.name not in ("M", "limit", "F")]
        return max([at, *(word.place[1] for word in words)])

    def _put(self, at: int, text: str) -> None:
        """Put words behind others at a place; those that go there too stand before them."""
        if text:
            there = [k for k, (start, end, _) in enumerate(self.made) if start == end == at]
            text = "".join([*(self.made.pop(k)[2] for k in there), text])
            self.made.append((at, at, text))
