"""Holes of several lines as CYCL DEF 200, called by M99 behind the move to their place.

What is gathered are lines that were written for a TNC: down in a rapid, into the hole, perhaps a
dwell, and up. The cycle moves just so (`holes.py`), and what comes out is read again. Strokes of a
deep hole stay moves: how far above the ground the cycle begins to feed again is not certain.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal

from gcxform_plugins.dialects.heidenhain.words import exact

VALUE = r"([-+][0-9.]+)"
DOWN = re.compile(rf"L Z{VALUE} FMAX")
INTO = re.compile(rf"L Z{VALUE}(?: F([0-9.]+))?")
DWELL = "CYCL DEF 9.0 DWELL TIME"
WAITS = re.compile(r"CYCL DEF 9\.1 DWELL ([0-9.]+)")
OVER = re.compile(rf"L(?= [XY])(?: X{VALUE})?(?: Y{VALUE})?(?: R0)? FMAX")
HEIGHT = re.compile(rf"\bZ{VALUE}")
FEED = re.compile(r" F([0-9.]+)")
CUTS = re.compile(r"(?:L|C|CP|CR) (?!F\d)(?!.*(?:FMAX|M91))[^;]*")
KEEPS = re.compile(r"(?:L|C|CP|CR|CC) (?!.*(?:M91|IZ))|CYCL DEF (?:9|32)|M[345789]\b|TOOL CALL Z|;")
"""Lines behind which Z stands where words have said."""
CLEAR = Decimal(1)  # mm, from where the feed begins to the surface that is told
NAMES = {
    200: "SET-UP CLEARANCE",
    201: "DEPTH",
    206: "FEED RATE FOR PLNGNG",
    202: "PLUNGING DEPTH",
    210: "DWELL TIME AT TOP",
    203: "SURFACE COORDINATE",
    204: "2ND SET-UP CLEARANCE",
    211: "DWELL TIME AT DEPTH",
}
TAP_NAMES = {
    200: "SET-UP CLEARANCE",
    201: "DEPTH OF THREAD",
    239: "THREAD PITCH",
    203: "SURFACE COORDINATE",
    204: "2ND SET-UP CLEARANCE",
}
Line = tuple[str, int]


@dataclass(frozen=True, slots=True)
class Hole:
    """A hole: what cycle 200 is told of it, and how many lines it takes."""

    told: tuple[str, ...]
    feed: str
    lines: int


class Drilling:
    """Goes through lines, with what is in force at each.

    height  where Z stands, None where that is not known;  feed: the one in force
    owed    the feed that has to be said again behind a cycle;  told: what cycle 200 has been told
    """

    def __init__(self, lines: Sequence[Line]) -> None:
        self.lines = lines
        self.height: Decimal | None = None
        self.feed = self.owed = ""
        self.told: tuple[str, ...] = ()
        self.beside = False

    def gathered(self) -> Iterator[Line]:
        """Yield lines with cycle 200 for the moves of holes."""
        at = 0
        while at < len(self.lines):
            over = OVER.fullmatch(self.lines[at][0]) is not None
            hole = self._hole(at + over, self.height if over else None)
            if hole is None:
                yield self._plain(*self.lines[at])
                at += 1
                continue
            of = self.lines[at + over][1]
            if hole.told != self.told:
                self.told = hole.told
                yield from ((text, of) for text in defined(hole.told))
            yield (f"{self.lines[at][0]} M99", self.lines[at][1]) if over else ("CYCL CALL", of)
            self.feed = self.owed = hole.feed
            at += over + hole.lines
            self.height = _height(self.lines[at - 1][0])

    def _plain(self, text: str, of: int) -> Line:
        """Return a line that stays, with the feed that a cycle has left uncertain."""
        bare = text.partition(";")[0]
        if not KEEPS.match(bare):
            self.height = None
        found = HEIGHT.search(bare)
        if found and "M91" not in bare:
            self.height = Decimal(found[1])
        if " RL" in bare or " RR" in bare or " R0" in bare:
            self.beside = " R0" not in bare
        feed = FEED.search(bare)
        if feed:
            self.feed, self.owed = feed[1], ""
        elif self.owed and CUTS.match(bare):
            head, mark, rest = text.partition(" ;")
            text, self.owed = f"{head} F{self.owed}{mark}{rest}", ""
        if bare.startswith("CYCL DEF 2"):
            self.told = ()
        if bare.startswith("CYCL DEF 207"):
            self.owed = self.feed
        return text, of

    def _hole(self, at: int, height: Decimal | None) -> Hole | None:
        """Return the hole whose moves begin at a line; None where none does, or one of strokes."""
        before = [text for text, _ in self.lines[max(at - 2, 0) : at]]
        while before and DOWN.fullmatch(before[-1]):
            before.pop()
        if self.beside or (before and (INTO.fullmatch(before[-1]) or WAITS.fullmatch(before[-1]))):
            return None
        hole = self._stroke(at, height)
        behind = hole and self._stroke(at + hole.lines, None)
        return hole if hole and hole.feed and not behind else None

    def _stroke(self, at: int, height: Decimal | None) -> Hole | None:
        """Return what goes down, into a hole, and up, from a line on."""
        texts = [text for text, _ in self.lines[at : at + 5]]
        down = DOWN.fullmatch(texts[0]) if texts else None
        top = Decimal(down[1]) if down else height
        rest = texts[1:] if down else texts
        into = INTO.fullmatch(rest[0]) if rest else None
        if into is None or top is None:
            return None
        wait = WAITS.fullmatch(rest[2]) if len(rest) > 2 and rest[1] == DWELL else None
        last = 3 if wait else 1
        up = DOWN.fullmatch(rest[last]) if len(rest) > last else None
        feed, bottom = into[2] or self.feed, Decimal(into[1])
        if up is None or not bottom < top <= Decimal(up[1]):
            return None
        told = _told(top, bottom, Decimal(up[1]), feed or "0", wait[1] if wait else "0")
        return Hole(told, feed, last + 1 + (down is not None))


def _told(top: Decimal, bottom: Decimal, back: Decimal, feed: str, wait: str) -> tuple[str, ...]:
    """Return the parameters of cycle 200, in the order of its names."""
    clear = min(CLEAR, (top - bottom) / 2)
    surface = top - clear
    levels = clear, bottom - surface, Decimal(feed), surface - bottom, Decimal(0)
    values = *levels, surface, back - surface, Decimal(wait)
    return tuple(exact(each) for each in values)


def _height(text: str) -> Decimal | None:
    found = HEIGHT.search(text)
    return None if found is None else Decimal(found[1])


def tapped(start: Decimal, bottom: Decimal, pitch: Decimal) -> Iterator[str]:
    """Yield the lines of a tap in step with the spindle, from where the tool stands and back."""
    clear = min(CLEAR, (start - bottom) / 2)
    surface = start - clear
    values = clear, bottom - surface, pitch, surface, clear
    yield from _defined("207 RIGID TAPPING NEW", TAP_NAMES, [exact(each) for each in values])
    yield "CYCL CALL"
    yield "M3" if pitch > 0 else "M4"


def defined(told: Sequence[str]) -> Iterator[str]:
    """Yield the lines that define cycle 200."""
    return _defined("200 DRILLING", NAMES, told)


def _defined(cycle: str, names: Mapping[int, str], told: Sequence[str]) -> Iterator[str]:
    """Yield the lines that define a cycle."""
    yield f"CYCL DEF {cycle} ~"
    for (number, name), value in zip(names.items(), told, strict=True):
        sign = "" if value.startswith("-") else "+"
        yield f"  Q{number}={sign}{value} ;{name}{'' if name == [*names.values()][-1] else ' ~'}"
