"""Holes of several lines as CYCLE81 and CYCLE82, and rows of them behind MCALL.

What is gathered are lines that were written for a SINUMERIK: down in a rapid, into the hole,
perhaps a dwell, and up. The cycle moves just so (`cycles.py`), and what comes out is read again.
Strokes of a deep hole stay moves: those of CYCLE83 hang on machine data, and other cycles on
recalled facts.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from decimal import Decimal

from gcxform_plugins.dialects.siemens.place import text_of

NUMBER = r"(?:N\d+ )?"
VALUE = r"(-?[0-9.]+)"
DOWN = re.compile(rf"{NUMBER}(?:G0 )?Z{VALUE}")
INTO = re.compile(rf"{NUMBER}G1 Z{VALUE}(?: F{VALUE})?")
DWELL = re.compile(rf"{NUMBER}G4 F{VALUE}")
UP = re.compile(rf"{NUMBER}G0 Z{VALUE}")
OVER = re.compile(rf"{NUMBER}(?:G0 )?(?=[XY])(?:X{VALUE})?(?: ?Y{VALUE})?")
CODE = re.compile(r"G(\d+)|([DM])(\d+)|SUPA")
WORDS = re.compile(r"[^;]*")
CLEAR = Decimal(1)  # mm, from where the feed begins to the surface that is told
INCH = Decimal("0.04")
CHANGE = 6
Lines = list[tuple[str, int]]


@dataclass(frozen=True, slots=True)
class Hole:
    """A hole: its cycle, the feed that it says, and how many lines it takes."""

    call: str
    feed: str
    lines: int


def gathered(lines: Lines) -> Iterator[tuple[str, int]]:
    """Yield lines, each with the line that it is for, with cycles for the moves of holes."""
    at, modes = 0, Modes()
    while at < len(lines):
        hole = hole_at(lines, at, modes.clear) if modes.drills else None
        if hole is None:
            modes.take(lines[at][0])
            yield lines[at]
            at += 1
            continue
        of = lines[at][1]
        if hole.feed:
            yield f"F{hole.feed}", of
        yield hole.call, of
        at += hole.lines
        row = [*row_of(lines, at, hole.call, modes.clear)]
        if len(row) > 1:
            yield f"MCALL {hole.call}", lines[at][1]
            for over, length in row:
                yield lines[over]
                at = over + 1 + length
            yield "MCALL", lines[at - 1][1]


class Modes:
    """Whether the moves of a hole are those of a cycle, by the modes in force.

    rapid  G0 is;  plain: G17, G90 and no compensation;  clear: as CLEAR, in the unit in force
    edge   a length counts: with D0 a cycle is an alarm (61000, Cycles 11.02)
    """

    def __init__(self) -> None:
        self.rapid, self.plain, self.edge, self.clear = False, True, False, CLEAR

    @property
    def drills(self) -> bool:
        """Whether it is so."""
        return self.rapid and self.plain and self.edge

    def take(self, line: str) -> None:
        """Take the words of a line."""
        words = WORDS.match(line)
        for found in CODE.finditer(words[0] if words else ""):
            number = int(found[1] or found[3] or 0)
            if found[1] and number in (0, 1, 2, 3):
                self.rapid = number == 0
            elif found[1] and number in (18, 19, 91, 93, 41, 42):
                self.plain = False  # for good: nothing is gathered behind them
            elif found[1] and number in (700, 710):
                self.clear = CLEAR if number == 710 else INCH
            elif found[2] == "D" or (found[2] and number == CHANGE):
                self.edge = found[2] == "D" and number != 0


def hole_at(lines: Sequence[tuple[str, int]], at: int, clear: Decimal) -> Hole | None:
    """Return the hole whose moves begin at a line; None where none does, or one stroke of it."""
    hole = stroke_at(lines, at, clear)
    before = [text for text, _ in lines[max(at - 3, 0) : at - 1] if not DWELL.fullmatch(text)]
    if hole is None or (before and INTO.fullmatch(before[-1])):
        return None
    behind = stroke_at(lines, at + hole.lines, Decimal(0))
    return hole if behind is None else None


def stroke_at(lines: Sequence[tuple[str, int]], at: int, clear: Decimal) -> Hole | None:
    """Return what goes down, into a hole, and up, from a line on; None where nothing does."""
    texts = [text for text, _ in lines[at : at + 4]]
    found = [pattern.fullmatch(text) for pattern, text in zip((DOWN, INTO), texts, strict=False)]
    if len(found) < 2 or found[0] is None or found[1] is None:
        return None
    wait = DWELL.fullmatch(texts[2]) if len(texts) > 2 else None
    last = 3 if wait else 2
    up = UP.fullmatch(texts[last]) if len(texts) > last else None
    if up is None:
        return None
    start, bottom, back = Decimal(found[0][1]), Decimal(found[1][1]), Decimal(up[1])
    if not bottom < start - clear <= start < back:
        return None
    levels = ",".join(text_of(v) for v in (back, start - clear, clear, bottom))
    call = f"CYCLE82({levels},,{wait[1]})" if wait else f"CYCLE81({levels})"
    return Hole(call, found[1][2] or "", last + 1)


def row_of(
    lines: Sequence[tuple[str, int]], at: int, call: str, clear: Decimal
) -> Iterator[tuple[int, int]]:
    """Yield the lines that lead to further holes by the same cycle, and how many lines each takes.

    A feed of another number ends the row.
    """
    while at < len(lines) and OVER.fullmatch(lines[at][0]):
        hole = hole_at(lines, at + 1, clear)
        if hole is None or hole.call != call or hole.feed:
            return
        yield at, hole.lines
        at += 1 + hole.lines
