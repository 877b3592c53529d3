"""Lines one after the other that only go somewhere, translated at once.

lark parses the first line of each shape, and says whether lines of that shape are such ones: L with
X, Y and Z as numbers, R0, F or FMAX, in that order; CC and C with X and Y. Where L follows upon L
one expression, made of the pieces of all such shapes, finds how far a run of them goes; else what
is to be done for a shape is a `Plan`. Nothing else says what a line is. A line that has no plan,
and the last one of each run, is translated by itself.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
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
LEFT_OUT = (" R0", " FMAX", "+")
MOST_SHAPES = 32
LEAST = 2  # lines
SENSES = {"DR+": "G3", "DR-": "G2"}
CIRCLES = frozenset(SENSES.values())
NOT_SHOWN = "%.0s"


@dataclass(frozen=True, slots=True)
class Plan:
    """What lines of a shape do: `code` is nothing for CC, `off` whether R0 is said.

    The numbers of `axes` begin at `first`, and `behind` them are that of R0 and that of F, if they
    stand; `count` is how many all are. `text` is the block without its code, with a place for each
    number, and for I and J.
    """

    code: str
    axes: tuple[str, ...]
    first: int
    behind: int
    feed: bool
    off: bool
    count: int
    text: str


class _Ends:
    """Where lines have `led`, as their numbers stand, with the pole and the feed in force."""

    def __init__(self, pole: dict[str, str], place: dict[str, str]) -> None:
        self.pole, self.place = pole, place
        self.led: dict[str, str] = {}
        self.feed = ""

    def take(self, plan: Plan, numbers: Sequence[str], at: int) -> None:
        """Take what a line says, whose numbers begin `at` a place."""
        said = zip(plan.axes, numbers[at + plan.first : at + plan.behind], strict=True)
        if plan.code:
            self.led.update(said)
        else:
            self.pole = dict(said)
        if plan.feed:
            self.feed = numbers[at + plan.count - 1]

    def about(self) -> list[str]:
        """Return I and J of a circle that begins here; nothing if a place is not known."""
        known = self.place.keys() | self.led.keys()
        if self.pole.keys() != {*"XY"} or not self.pole.keys() <= known:
            return []
        place = {axis: self.led.get(axis) or self.place[axis] for axis in "XY"}
        return [exact(Decimal(plain(self.pole[a])) - Decimal(plain(place[a]))) for a in "XY"]


class Runs(Klartext):
    """Translates runs of lines."""

    def __init__(self, *program: Any) -> None:
        super().__init__(*program)
        self._plans: dict[str, Plan] = {}
        self._known: dict[bool, dict[str, None]] = {True: {}, False: {}}
        self._runs: dict[bool, re.Pattern[str]] = {}
        self._spans = {True: (0, 0), False: (0, 0)}
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
        at = self._starts[self.line]
        end = self._end_of_run(rapid, at)
        for word, hangs in ((" F", self.inch and not rapid), (" R", self.side)):
            if hangs and (place := self._text.find(word, at, end)) >= 0:
                end = max(self._text.rfind("\n", at, place) + 1, at)
        if self._text.count("\n", at, end) <= LEAST:
            return []
        said = self._text[at : self._text.rindex("\n", at, end - 1)]
        for each in LEFT_OUT:
            said = said.replace(each, "")
        blocks = [line.partition("L ")[2] for line in said.split("\n")]
        blocks[0] = f"{self.moving('G0' if rapid else 'G1')} {blocks[0]}".lstrip()
        self._take(said)
        return blocks

    def _end_of_run(self, rapid: bool, at: int) -> int:
        """Return where in the text a run ends that goes on at a place; the place if none does.

        What is left of a run is one: who takes a line of it alone need not look through it again.
        """
        begun, end = self._spans[rapid]
        if not begun <= at < end:
            pattern = self._runs.get(rapid)
            found = pattern and pattern.match(self._text, at)
            end = found.end() if found else at
            self._spans[rapid] = at, end
        return end

    # --- lines and circles in turn ---

    def _mixed(self) -> list[str]:
        """Return the blocks of lines of several kinds; an empty one for each CC.

        Where the last of them leads to is told by the one that is translated behind it.
        """
        plans, numbers = self._gathered()
        templates, given, shown, at = list[str](), list[str](), 0, 0
        ends = _Ends(self.pole, self.place)
        for plan in plans[:-1]:
            if plan.code in CIRCLES:
                about = ends.about()
                if not about:
                    break
                given += (*numbers[shown : at + plan.behind], *about)
                shown = at + plan.behind
            bare = not plan.code or (plan.code == self.motion and plan.code not in CIRCLES)
            templates.append(plan.text if bare else self._begun(plan))
            ends.take(plan, numbers, at)
            at += plan.count
        if not templates:
            return []
        self._take_ends(ends)
        given += numbers[shown:at]
        return plain(("\n".join(templates) % (*given,)).replace("+", "")).split("\n")

    def _begun(self, plan: Plan) -> str:
        """Return the block of a line, to be filled in with its numbers, and take its codes."""
        plane = self.in_plane("G17") if plan.code in CIRCLES else ""
        codes = f"{plane}{self.moving(plan.code)}".rstrip()
        return f"{codes} {plan.text}".lstrip()

    def _take_ends(self, ends: _Ends) -> None:
        """Take note of where lines have led, and how fast, and of the pole of the last CC."""
        if ends.pole is not self.pole or not ends.led.keys().isdisjoint("XY"):
            self.polar = None
        if ends.pole is not self.pole:
            self.pole = {axis: plain(number) for axis, number in ends.pole.items()}
        self.place |= {axis: plain(number) for axis, number in ends.led.items()}
        self.moved |= ends.led.keys()
        if ends.feed:
            self.feed_word(plain(ends.feed))

    def _gathered(self) -> tuple[list[Plan], list[str]]:
        """Return the plans of a run of lines, and all their numbers; the last line moves."""
        plans, numbers, line = list[Plan](), list[str](), self.line
        with suppress(gx.InputError):  # a line is refused when it is come to
            while line < len(self.lines):
                ahead, k = self._split_ahead(line)
                known = [*self._known_plans(line, ahead.keys[k:])]
                plans += known
                numbers += ahead.numbers[ahead.starts[k] : ahead.starts[k + len(known)]]
                line += len(known)
                if k + len(known) < len(ahead.keys):
                    break
        del plans[self._said_in_full(plans, numbers) :]
        while plans and not plans[-1].code:
            plans.pop()
        return plans, numbers

    def _known_plans(self, first: int, keys: Sequence[str]) -> Iterator[Plan]:
        """Yield the plans of lines up to the first without one, or that hangs on more."""
        for line, key in enumerate(keys, first):
            plan = self._plans.get(key)
            if plan is None:
                shape, numbers = self.shape(line)
                if not shape.routine:
                    return
                plan = self._plans[key] = _plan(shape.items(numbers))
            if (plan.feed and self.inch) or (plan.off and self.side):
                return
            yield plan

    def _said_in_full(self, plans: Sequence[Plan], numbers: Sequence[str]) -> int:
        """Return how many lines there are before one of which the plan does not say all."""
        at, long = 0, max(map(len, numbers), default=0) > LONGEST
        for k, plan in enumerate(plans):
            if plan.off and numbers[at + plan.behind] != "0":
                return k
            if long and max(map(len, numbers[at : at + plan.count])) > LONGEST:
                return k
            at += plan.count
        return len(plans)

    def _hangs_on_more(self, rapid: bool) -> bool:
        """Whether lines are translated by more than what they say."""
        beside = not self.begun or self.over or self.begins is not None or self.in_tilt()
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
    first, feed, off = len(items) - len(said), "feed" in kinds, "radius" in kinds
    letters = (*axes, *("IJ" if code in CIRCLES else ""))
    words = " ".join(f"{letter}%s" for letter in letters) + NOT_SHOWN * off + " F%s" * feed
    text = NOT_SHOWN * first + (words if code else NOT_SHOWN * len(axes))
    behind = first + len(axes)
    return Plan(code, axes, first, behind, feed, off, behind + off + feed, text)


def _word(item: gx.Item) -> str:
    """Return a word of a line with a letter for its number."""
    if item.kind == "seq":
        return "N"
    if item.kind == "radius":
        return f"{item.name}0" if item.numbers == ("0",) else "?"
    return item.name + "V" * len(item.numbers)
