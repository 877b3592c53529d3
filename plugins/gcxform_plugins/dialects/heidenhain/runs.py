"""Lines one after the other that only go somewhere, translated at once.

lark parses the first line of each shape, and says whether lines of that shape are such ones: L with
X, Y and Z as numbers, R0, F or FMAX, in that order; CC and C with X and Y. Where L follows upon L
one expression, made of the pieces of all such shapes, finds how far a run of them goes; else what
is to be done for a shape is a `Plan`. Nothing else says what a line is. A line that has no plan,
and the last one of each run, is translated by itself.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
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

    Its numbers of axes begin at `first`, and `behind` them are that of R0 and that of F, if they
    stand; `count` is how many all are. `ends` says which are those of the axes that move, and of F.
    `text` is the block without its code, with a place for each number, and for I and J.
    """

    code: str
    first: int
    behind: int
    feed: bool
    off: bool
    count: int
    ends: Mapping[str, int]
    text: str


class _Way:
    """Lines one after the other, with all their numbers: those of each begin at `starts`."""

    def __init__(self, plans: list[Plan], numbers: Sequence[str]) -> None:
        self.plans, self.numbers = plans, numbers
        self.starts = [*accumulate([plan.count for plan in plans], initial=0)]

    def last(self, letter: str, stop: int) -> str | None:
        """Return the number of an axis, or of F, in the last line that has it before one."""
        for k in range(stop - 1, -1, -1):
            slot = self.plans[k].ends.get(letter)
            if slot is not None:
                return self.numbers[self.starts[k] + slot]
        return None

    def pole(self, k: int) -> dict[str, str]:
        """Return the coordinates of a CC."""
        first = self.starts[k] + self.plans[k].first
        return {"X": self.numbers[first], "Y": self.numbers[first + 1]}


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
        way, pole = self._gathered(), self.pole
        numbers, templates, given, shown = way.numbers, list[str](), list[str](), 0
        for k, plan in enumerate(way.plans[:-1]):
            if not plan.code:
                pole = way.pole(k)
            elif plan.code in CIRCLES:
                about = self._about(way, k, pole)
                if not about:
                    break
                behind = way.starts[k] + plan.behind
                given += (*numbers[shown:behind], *about)
                shown = behind
            templates.append(self._begun(plan))
        if not templates:
            return []
        self._take_ends(way, len(templates), pole)
        given += numbers[shown : way.starts[len(templates)]]
        return plain(("\n".join(templates) % (*given,)).replace("+", "")).split("\n")

    def _about(self, way: _Way, k: int, pole: dict[str, str]) -> list[str]:
        """Return I and J of a circle; nothing if a place is not known.

        A circle names both axes, so those of the next are found between the two.
        """
        place = {axis: way.last(axis, k) or self.place.get(axis, "") for axis in "XY"}
        if pole.keys() != place.keys() or "" in place.values():
            return []
        return [exact(Decimal(plain(pole[a])) - Decimal(plain(place[a]))) for a in "XY"]

    def _begun(self, plan: Plan) -> str:
        """Return the block of a line, to be filled in with its numbers, and take its codes."""
        plane = self.in_plane("G17") if plan.code in CIRCLES else ""
        if not plan.code or plan.code == self.motion:
            return plane + plan.text
        self.motion = plan.code
        return f"{plane}{plan.code} {plan.text}"

    def _take_ends(self, way: _Way, stop: int, pole: dict[str, str]) -> None:
        """Take note of where lines have led, and how fast, and of the pole of the last CC."""
        found = {axis: way.last(axis, stop) for axis in (*LINEAR, "F")}
        feed = found.pop("F")
        led = {axis: plain(number) for axis, number in found.items() if number}
        if pole is not self.pole or not led.keys().isdisjoint("XY"):
            self.polar = None
        if pole is not self.pole:
            self.pole = {axis: plain(number) for axis, number in pole.items()}
        self.place |= led
        self.moved |= led.keys()
        if feed:
            self.feed_word(plain(feed))

    def _gathered(self) -> _Way:
        """Return a run of lines of which there are plans; the last line moves."""
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
        way = _Way(plans, numbers)
        del plans[_said_in_full(way) :]
        while plans and not plans[-1].code:
            plans.pop()
        return way

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


def _said_in_full(way: _Way) -> int:
    """Return how many lines there are before one of which the plan does not say all."""
    numbers, long = way.numbers, max(map(len, way.numbers), default=0) > LONGEST
    for k, (plan, at) in enumerate(zip(way.plans, way.starts, strict=False)):
        if plan.off and numbers[at + plan.behind] != "0":
            return k
        if long and max(map(len, numbers[at : at + plan.count])) > LONGEST:
            return k
    return len(way.plans)


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
    count = behind + off + feed
    ends = {axis: slot for slot, axis in enumerate(axes, first)} if code else {}
    ends |= {"F": count - 1} if feed else {}
    return Plan(code, first, behind, feed, off, count, ends, text)


def _word(item: gx.Item) -> str:
    """Return a word of a line with a letter for its number."""
    if item.kind == "seq":
        return "N"
    if item.kind == "radius":
        return f"{item.name}0" if item.numbers == ("0",) else "?"
    return item.name + "V" * len(item.numbers)
