"""Lines one after the other that only go somewhere, translated at once.

lark parses the first line of each shape, and says whether lines of that shape are such ones: L with
X, Y and Z as numbers, R0, F or FMAX, in that order; CC and C with X and Y. Where L follows upon L
one expression, made of the pieces of all such shapes, finds how far a run of them goes; else what
is to be done for a shape is a `Plan`. Nothing else says what a line is. A line that has no plan,
and the last one of each run, is translated by itself.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from decimal import Decimal
from itertools import accumulate
from typing import Any

import gcxform as gx
from gcxform_plugins.dialects.heidenhain.klartext import Klartext
from gcxform_plugins.dialects.heidenhain.words import LINEAR, LONGEST, exact, plain

NUMBER = "[+-]?[0-9]{1,9}(?:\\.[0-9]{0,9})?"
WORDS = re.compile("(?:N )?L(?: [XYZ]V)+(?: R0)?(?: FV| FMAX)?")
"""What words of a line have to be, each by a letter: then its block is what is left of it."""
ABOUT = re.compile("(?:N )?(?:CC XV YV|C XV YV DR[+-](?: FV)?)")
"""And those of circles, beside such lines."""
LEFT_OUT = re.compile(r"^(?:[0-9]+ )?L | R0| FMAX|\+", re.MULTILINE)
MOST_SHAPES = 32
LEAST = 2  # lines
SENSES = {"DR+": "G3", "DR-": "G2"}
CIRCLES = frozenset(SENSES.values())
CIRCLES_AT = ("X", "I"), ("Y", "J")


@dataclass(frozen=True, slots=True)
class Plan:
    """What lines of a shape do: `code` is nothing for CC, `off` whether R0 is said.

    The numbers of `axes` begin at `first`; behind them are that of R0 and that of F, if they stand.
    """

    code: str
    axes: tuple[str, ...]
    first: int
    feed: bool
    off: bool


Line = tuple[Plan, Sequence[str]]


class Runs(Klartext):
    """Translates runs of lines."""

    def __init__(self, *program: Any) -> None:
        super().__init__(*program)
        self._plans: dict[Any, Plan] = {}
        self._known: dict[bool, dict[str, None]] = {True: {}, False: {}}
        self._runs: dict[bool, re.Pattern[str]] = {}
        self._text, self._starts = "", [0]

    def routine(self, items: Sequence[gx.Item], text: str) -> bool:
        """Take a shape, of which `text` is a line; return whether such lines come in runs."""
        said = " ".join(map(_word, items))
        named = re.findall("[XYZ]", said)
        bare = " ".join("".join((*item.names, *item.numbers)) for item in items)
        circle = ABOUT.fullmatch(said) is not None
        if not (circle or WORDS.fullmatch(said)):
            return False
        if bare != text or len(set(named)) != len(named):
            return False
        rapid = said.endswith("FMAX")
        if not circle and len(self._known[rapid]) < MOST_SHAPES:
            pattern = said.replace("N ", "[0-9]{1,9} ").replace("V", f"(?>{NUMBER})")
            self._known[rapid][pattern] = None
            self._runs[rapid] = re.compile(f"(?:(?:{'|'.join(self._known[rapid])})\n)+")
        return True

    def several(self) -> list[str]:
        """Return the blocks of lines from this one on; nothing where it stands by itself."""
        rapid = self.lines[self.line].endswith("FMAX")
        if self._hangs_on_more(rapid):
            return []
        self._look_ahead()
        return self._alike(rapid) or ([] if self.feed_lost or self.untold else self._mixed())

    def _look_ahead(self) -> None:
        """Come to know the shapes of the next lines, or a run of them would begin too late."""
        for line in range(self.line + 1, min(self.line + 1 + LEAST, len(self.lines))):
            with suppress(gx.InputError):  # it is refused when it is come to
                self.shape(line)

    def _alike(self, rapid: bool) -> list[str]:
        """Return the blocks of lines that are all L, and all at the feed or all in rapid."""
        if len(self._starts) != len(self.lines) + 1:
            self._text = "".join(f"{line}\n" for line in self.lines)
            self._starts = [0, *accumulate(len(line) + 1 for line in self.lines)]
        pattern, at = self._runs.get(rapid), self._starts[self.line]
        found = pattern and pattern.match(self._text, at)
        if not found or found[0].count("\n") <= LEAST:
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

    # --- lines and circles in turn ---

    def _mixed(self) -> list[str]:
        """Return the blocks of lines of several kinds; an empty one for each CC.

        Where the last of them leads to is told by the one that is translated behind it.
        """
        found, blocks = self._gathered(), []
        for plan, numbers in found[:-1]:
            block = self._done(plan, numbers)
            if block is None:
                break
            blocks.append(block)
        return blocks

    def _done(self, plan: Plan, numbers: Sequence[str]) -> str | None:
        """Return the block of a line; None where it hangs on more than the plan says."""
        ends = {axis: plain(numbers[k]) for k, axis in enumerate(plan.axes, plan.first)}
        place = self.place
        if not plan.code:
            self.pole, self.polar = ends, None
            return ""
        about = plan.code in CIRCLES
        if (plan.off and self.side) or (
            about and not (self.pole.keys() == ends.keys() <= place.keys())
        ):
            return None
        words = "".join([f" {axis}{number}" for axis, number in ends.items()])
        if about:
            words += "".join(
                [
                    f" {letter}{exact(Decimal(self.pole[axis]) - Decimal(place[axis]))}"
                    for axis, letter in CIRCLES_AT
                ]
            )
        if plan.feed:
            words += self.feed_word(plain(numbers[-1]))
        place.update(ends)
        self.moved.update(ends)
        if "X" in ends or "Y" in ends:
            self.polar = None
        code = (
            f"{self.in_plane('G17')}{self.moving(plan.code)}" if about else self.moving(plan.code)
        )
        return f"{code.rstrip()}{words}".lstrip()

    def _gathered(self) -> list[Line]:
        """Return the lines of a run, with their numbers; the last of them moves."""
        found: list[Line] = []
        for line in range(self.line, len(self.lines)):
            try:
                shape, numbers = self.shape(line)
            except gx.InputError:
                break  # it is refused when it is come to
            plan = self._plans.get(shape)
            if plan is None and shape.routine:
                plan = self._plans[shape] = _plan(shape.items(numbers))
            if plan is None or max(map(len, numbers)) > LONGEST:
                break
            if plan.off and numbers[plan.first + len(plan.axes)] != "0":
                break
            found.append((plan, numbers))
        while found and not found[-1][0].code:
            found.pop()
        return found

    def _hangs_on_more(self, rapid: bool) -> bool:
        """Whether lines are translated by more than what they say."""
        beside = not self.begun or self.over or self.begins is not None
        return beside or ((self.feed_lost or self.untold) and not rapid)

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


def _plan(items: Sequence[gx.Item]) -> Plan:
    """Return what a line does whose words `WORDS` or `ABOUT` has found to be in order."""
    said = [item for item in items if item.kind != "seq"]
    kinds = {item.kind for item in said}
    code = "G0" if "fast" in kinds else "G1"
    if said[0].kind == "centre":
        code = ""
    elif said[0].name == "C":
        code = SENSES[next(item.name for item in said if item.kind == "dr")]
    axes = tuple(item.name for item in said if item.kind == "axis")
    return Plan(code, axes, len(items) - len(said), "feed" in kinds, "radius" in kinds)


def _word(item: gx.Item) -> str:
    """Return a word of a line with a letter for its number."""
    if item.kind == "seq":
        return "N"
    if item.kind == "radius":
        return f"{item.name}0" if item.numbers == ("0",) else "?"
    return item.name + "V" * len(item.numbers)
