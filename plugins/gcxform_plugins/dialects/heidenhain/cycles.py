"""Cycles of a TNC that are certain: dwell, tolerance, and holes in plain strokes."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from decimal import Decimal
from typing import Any

import gcxform as gx
from gcxform_plugins.dialects.heidenhain import builders
from gcxform_plugins.dialects.heidenhain.datums import VALUE
from gcxform_plugins.dialects.heidenhain.holes import (
    HOLES,
    OTHERS,
    PATTERNS,
    TAP,
    TAPPED,
    round_places,
    row_places,
    strokes_of,
)
from gcxform_plugins.dialects.heidenhain.kept_cycles import ALONE, KeptCycles
from gcxform_plugins.dialects.heidenhain.parameters import NAMED, key_of
from gcxform_plugins.dialects.heidenhain.words import exact, goes_on, plain, written

DEFINED = re.compile(r"CYCLE?\s+DEF\s*(\d{1,4})(?:\.(\d{1,2}))?(?![\d.])\s*(.*?)\s*~?\s*")
CALLED = re.compile(r"CYCL\s+CALL(\s+PAT\s+F\s*MAX)?((?:\s*M\s*\d{1,4})*)(?:\s*M)?\s*")
PLACE = re.compile(rf"\s*POS[1-9]\s*\(\s*X\s*({VALUE})\s*Y\s*({VALUE})\s*Z\s*({VALUE})\s*\)\s*")
QUANTITY = re.compile(r"\bQ\d+\s*=")
LAST_VALUE = re.compile(rf"(?:[A-Z][A-Z. -]*?)?\s*({VALUE})")
PARAMETER = re.compile(
    rf"Q(\d{{1,4}})\s*=\s*"
    rf"(?:({VALUE})(?![\w.,])|([+-]?\s*Q[LR]?\d{{1,4}})(?=[\s~]|$)|F?\s*(AUTO|MAX)(?=[\s~]|$)|\S*)"
)
PARAMETER_LINE = re.compile(r"[\s\d]*Q[2-4]\d\d\s*=")
PECKS = ("DIST", "DEPTH", "PECKING DEPTH", "DWELL", "F")
BACK = 208
FEEDS = 206, BACK
RAPID = Decimal("Infinity")
"""What MAX is worth as the feed back."""
AUTO = "AUTO"
STROKES = 200, 205
SLOWLY = 201, 203
"""Cycles that are read in several strokes, and those that leave at a feed."""


class Cycles(KeptCycles):
    """Reads cycles, and writes those that are called as moves."""

    def __init__(self, *program: Any) -> None:
        super().__init__(*program)
        self.hole: dict[int, Decimal] = {}
        self.pecks: dict[int, Decimal] = {}
        self.cycle = 0
        self.bounded = False
        self.refers: set[tuple[int, str]] = set()
        """Parameters of the hole, each with the one that its value has been taken from."""
        self.places: list[tuple[str, str]] = []

    def define(self, item: gx.Item) -> list[str]:
        """CYCL DEF: what a cycle is told. Raises InputError for those that are not resolved."""
        match = DEFINED.fullmatch(item.name)
        if match is None:
            return self._call(item)
        number, part, text = int(match[1]), int(match[2] or 0), match[3]
        frames = {7: self.cycle_7, 8: self.cycle_8, 10: self.cycle_10, 11: self.cycle_11}
        if number in frames:
            return frames[number](item, part, text)
        if number == 9:
            return self._dwell(item, part, text)
        if number == 32:
            return self._tolerance(item, part, text)
        if number == 247:
            return self.preset(item, self._parameters(item, text))
        read = number in HOLES or (number == TAP and not self.reading.stays)
        if read or self.keeps(number):
            self.refers = set()
            self.hole, self.cycle = self._parameters(item, text), number
            return []
        if number in PATTERNS:
            return self._pattern(item, number, self._parameters(item, text))
        if number == 1:
            return self._peck(item, part, text)
        if builders.said_inert(number, self.reading.control):
            first, self.cycle = self.line, 0
            self._parameters(item, text)
            return self.all_along(*builders.said_again(self.lines[first : self.at]))
        why = OTHERS.get(number, builders.whose(number))
        what = f"CYCL DEF {number} {QUANTITY.split(text)[0].strip()}".rstrip()
        self.refuse(f"{what} is {why}", item, *builders.ways_out(number))

    def _call(self, item: gx.Item) -> list[str]:
        """CYCL CALL: the cycle where the tool stands, or at the places of PATTERN DEF."""
        match = CALLED.fullmatch(item.name)
        if match is None:
            self.refuse(f"{item.name.strip()[:40]} is not resolved", item)
        numbers = re.findall(r"\d+", match[2])
        said = self.said([gx.Item("m", ("M",), (number,), item.place) for number in numbers])
        if said.after or said.calls or said.end or said.machine:
            self.refuse("an M function at the end of a call", item)
        return [*said.before, *(self._at_places(item) if match[1] else self.called(item))]

    def pattern(self, item: gx.Item) -> list[str]:
        """PATTERN DEF: the places of holes, one by one."""
        self.places = []
        parts = [item.name.partition("DEF")[2]]
        while goes_on(self.lines[self.at - 1]) and self.at < len(self.lines):
            parts.append(self.lines[self.at].upper().partition(";")[0])
            self.at += 1
        found = PLACE.sub(self._placed, " ".join(parts).replace("~", " "))
        if found.strip() or not self.places:
            self.refuse("PATTERN DEF with other than POS, or with another Z than 0", item)
        return []

    def _placed(self, found: re.Match[str]) -> str:
        x, y, z = (plain(number) for number in found.groups())
        if float(z):
            return found[0]
        self.places.append((x, y))
        return ""

    def _at_places(self, item: gx.Item) -> list[str]:
        """CYCL CALL PAT: the cycle at each place, in rapid at the second set-up clearance.

        Whether the tool goes from hole to hole there, or where it was, is only then the same.
        """
        self._check_cycle(item)
        if self.cycle not in HOLES or not self.places:
            raise self.refusal("GX215", "no cycle and places that are known here", item)
        height = self.hole.get(203, Decimal(0)) + self.hole.get(204, Decimal(0))
        if not self.hole.get(204) or self.stands_at("Z", item, "CYCL CALL PAT") != height:
            message = "CYCL CALL PAT from elsewhere than Q203 + Q204: how high it then goes is open"
            raise self.refusal("GX215", message, item, "go up there in a line before")
        return self._holes(item, self.places, self.hole)

    def _holes(
        self, item: gx.Item, places: Sequence[tuple[str, str]], hole: dict[int, Decimal]
    ) -> list[str]:
        """Return the blocks of a hole at each place, from one to the next in rapid."""
        blocks = []
        for x, y in places:
            self.place |= {"X": x, "Y": y}
            blocks += [f"G0 X{x} Y{y}", *self._hole(item, hole)]
        self.moved |= {"X", "Y"}
        return blocks

    def assigned(self, key: str) -> None:
        """Forget a cycle of which a parameter is set: whether it then counts is not known."""
        counts = self._counting()
        if any(key == f"Q{n}" or (n, key) in self.refers for n in counts):
            self.cycle = 0

    def _counting(self) -> Iterable[int]:
        """Return the parameters that blocks of the cycle in force hang on."""
        if self.keeps(self.cycle):
            return self.levels()
        if self.cycle == TAP:
            return TAPPED.needs
        hole = HOLES.get(self.cycle)
        return () if hole is None else (*hole.needs, *hole.zero, *hole.idle)

    def _value(self, item: gx.Item, text: str) -> str:
        match = LAST_VALUE.fullmatch(text)
        if match is None:
            self.refuse(f"{item.name.strip()} does not say a number", item)
        return plain(match[1])

    def _dwell(self, item: gx.Item, part: int, text: str) -> list[str]:
        """Cycle 9: seconds."""
        return [f"G4 P{self._value(item, text)}"] if part == 1 else []

    def _tolerance(self, item: gx.Item, part: int, text: str) -> list[str]:
        """Cycle 32: how far the path may be off; without T the machine's own holds again.

        No code of words has the builder's tolerance; G64 P0 would be none at all.
        """
        if self.reading.asides:
            if NAMED.search(text):
                self.check_along("cycle 32 by a parameter", item)
            return self.along()
        found = re.fullmatch(rf"T\s*(?:({VALUE})|([+-]?\s*Q[LR]?\d+))", text)
        if part != 1 or (found is None and not self.bounded):
            return []
        bound = "0"
        if found is not None:
            bound = plain(found[1]) if found[1] else self.parameter(found[2], item)
        self.bounded = found is not None
        return [f"G64 P{bound}" if Decimal(bound) > 0 else "G61"]

    def _parameters(self, item: gx.Item, text: str) -> dict[int, Decimal]:
        """Return the parameters of a cycle, from this line or from those behind it.

        They are those of the program as well. What is said by another word than a number, a
        parameter, or AUTO for the feed of the tool, is not known.
        """
        told: dict[int, Decimal] = {}
        for found in PARAMETER.finditer(" ".join([text, *self.told_lines()])):
            number, value, parameter = int(found[1]), found[2], found[3]
            if parameter:
                value = self.parameter(parameter, item)
                self.refers.add((number, key_of(parameter.lstrip("+- "))))
            if value:
                told[number] = Decimal(plain(value))
            self.q[f"Q{number}"] = float(told[number]) if value else None
            if found[4] == "MAX" and number == BACK:
                told[number] = RAPID
            elif found[4] == AUTO and number in FEEDS and self.tool_feed:
                told[number] = Decimal(self.tool_feed)
                self.refers.add((number, AUTO))
        return told

    def told_lines(self) -> Iterator[str]:
        """Yield the lines that go on with the statement of this line, and pass them."""
        while goes_on(self.lines[self.at - 1]) and self.at < len(self.lines):
            if not PARAMETER_LINE.match(self.lines[self.at].upper()):
                break
            self.at += 1
            yield self.lines[self.at - 1].upper().partition(";")[0]

    # --- holes ---

    def _check_cycle(self, item: gx.Item) -> None:
        """Refuse a cycle where it would go another way. Raises InputError."""
        self.refuse_beside("a cycle", item)
        if self.following:
            self.refuse("a cycle while the control follows the tip", item)
        if self.cycle != TAP:
            self.check_spindle()
        if "Z" in (self.mirrored or ""):
            self.refuse("a cycle in a mirror image along the tool", item)

    def called(self, item: gx.Item) -> list[str]:
        """M99 and CYCL CALL: the hole where the tool stands."""
        self._check_cycle(item)
        if self.keeps(self.cycle):
            return self.kept_hole(item, self.cycle, self.hole)
        if self.cycle in HOLES:
            return self._hole_or_kept(item)
        if self.cycle == TAP:
            return self._tapped(item, self.hole)
        if self.cycle == 1:
            return self._pecked(item)
        raise self._no_cycle(item)

    def _no_cycle(self, item: gx.Item) -> gx.InputError:
        """Return the refusal of a call without a cycle, or one that is not certain now."""
        if self.cycle or not self.hole:
            return self.refusal("GX215", "no cycle that is known here has been defined", item)
        message = "a parameter of the cycle was set behind its definition: it may count, or not"
        return self.refusal("GX215", message, item, "define the cycle again before it is called")

    def _hole_or_kept(self, item: gx.Item) -> list[str]:
        """Return the blocks of a hole; the one of its cycle where that is not certain."""
        try:
            return self._hole(item, self.hole)
        except gx.InputError:
            if not self.reading.asides:
                raise
            return self.kept_hole(item, self.cycle, self.hole)

    def _hole(self, item: gx.Item, told: dict[int, Decimal]) -> list[str]:
        """Return the blocks of a hole in one stroke: out in rapid, or at Q208."""
        hole, name = HOLES[self.cycle], f"cycle {self.cycle}"
        if lacks := sorted({*hole.needs} - told.keys()):
            message = f"{name} lacks Q{lacks[0]}, or a number for it"
            raise self.refusal("GX215", message, item, f"define it with Q{lacks[0]} = a number")
        for number, why in hole.zero.items():
            if told.get(number):
                raise self.refusal("GX215", f"{name} with Q{number}, {why}", item, ALONE)
        if told.keys() - {*hole.needs, *hole.zero, *hole.idle}:
            raise self.refusal("GX215", f"{name} with parameters that are not known", item)
        clear, depth, feed, surface, high = (told[n] for n in (200, 201, 206, 203, 204))
        deep = strokes_of(self.cycle, told) if depth < 0 else []
        if not deep or self.inch or (len(deep) > 1 and self.cycle not in STROKES):
            message = f"{name} in several strokes, upwards, or in inches"
            raise self.refusal("GX215", message, item, ALONE)
        if clear < 0 or 0 < high < clear or (len(deep) == 1 and told.get(210)):
            message = f"{name} with Q204 below Q200, or Q210 in one stroke"
            raise self.refusal("GX215", message, item, ALONE)
        up = surface + clear
        blocks = [] if self.place.get("Z") == exact(up) else [f"G0 Z{exact(up)}"]
        for before, at in zip([Decimal(0), *deep], deep, strict=False):
            if before:
                near = surface - before + self._above(item, told, clear + before)
                blocks += [f"G0 Z{exact(up)}", *_waits(told.get(210)), f"Z{exact(near)}"]
            blocks.append(f"G1 Z{exact(surface - at)}{self.feed_word(exact(feed))}")
        blocks += _waits(told[211])
        if self.cycle in SLOWLY and told[BACK] != RAPID:
            blocks.append(f"Z{exact(up)}{self.feed_word(exact(told[BACK] or feed))}")
        return self._out(blocks, exact(surface + high) if high else exact(up))

    def _tapped(self, item: gx.Item, told: Mapping[int, Decimal]) -> list[str]:
        """Return the blocks of a tap in step with the spindle: to the ground, and back.

        Whether the spindle turns again behind it is not certain: to be said before anything cuts.
        """
        if told.keys() != {*TAPPED.needs} or self.inch or self.mirrored != "":
            message = "cycle 207 in inches or a mirror image, with fewer parameters, or with more"
            raise self.refusal("GX215", message, item, ALONE)
        clear, depth, pitch, surface, high = (told[n] for n in TAPPED.needs)
        if clear < 0 or 0 < high < clear or depth >= 0 or not pitch:
            message = "cycle 207 upwards, without a pitch, or with Q204 below Q200"
            raise self.refusal("GX215", message, item, ALONE)
        sense = "M3" if pitch > 0 else "M4"
        behind = self.lines[self.at] if self.at < len(self.lines) else ""
        again = re.fullmatch(rf"\s*(?:\d+\s+)?{sense}\s*", behind)
        if self.spindle != sense:
            message = f"cycle 207, and {sense} was not before it"
            raise self.refusal("GX215", message, item, f"write {sense} there")
        self.at, self.untold = self.at + (again is not None), again is None
        up = exact(surface + clear)
        over = [] if self.place.get("Z") == up else [f"G0 Z{up}"]
        tap = f"{self.in_plane('G17')}G33.1 Z{exact(surface + depth)} K{exact(abs(pitch))}"
        blocks = [*over, tap]
        out = self._out(blocks, exact(surface + high) if high else up)
        if high > clear:
            return out
        self.motion = "G33.1"
        return blocks

    def _above(self, item: gx.Item, told: Mapping[int, Decimal], room: Decimal) -> Decimal:
        """Return how far over the ground a stroke begins to feed. Raises InputError."""
        hint, above = ALONE, told.get(258)
        if self.cycle == 200:
            said = self.reading.control.get("peck-clearance")
            above = Decimal(repr(said)) if isinstance(said, float) else None
            hint = "peck-clearance in [control] of the machine file says how far over the ground"
        if above is None or told.get(259, above) != above or not 0 < above <= room:
            message = f"cycle {self.cycle}: from where a stroke feeds again is not certain"
            raise self.refusal("GX215", message, item, hint)
        return above

    def _pattern(self, item: gx.Item, number: int, told: dict[int, Decimal]) -> list[str]:
        """Cycles 220 and 221: the cycle defined last at once, over and over."""
        self._check_cycle(item)
        if self.cycle not in HOLES:
            raise self._no_cycle(item)
        if told.keys() - {365} != {*PATTERNS[number]}:
            raise self.refusal("GX215", f"cycle {number} lacks a parameter, or has more", item)
        if told[301] != 1 or told.get(365) or told[204] < told[200] or not told[204]:
            message = "a pattern at the set-up clearance: where it ends is not certain"
            raise self.refusal("GX215", message, item, ALONE)
        places = round_places(told) if number == 220 else row_places(told)
        if not places:
            raise self.refusal("GX215", "a pattern whose order is not certain", item, ALONE)
        hole = {**self.hole, **{n: told[n] for n in (200, 203, 204)}}
        if self.stands_at("Z", item, f"cycle {number}") != told[203] + told[204]:
            message = "a pattern whose first hole is reached from elsewhere than Q203 + Q204"
            raise self.refusal("GX215", message, item, "go up there in a line before")
        blocks = self._holes(item, places, hole)
        # whether they count for a cycle that is called next is not known
        self.hole = {n: v for n, v in self.hole.items() if told.get(n, v) == v}
        return blocks

    def _stroke(self, bottom: Decimal, feed: Decimal, dwell: Decimal) -> list[str]:
        down = f"G1 Z{exact(bottom)}{self.feed_word(exact(feed))}"
        return [down, f"G4 P{exact(dwell)}"] if dwell else [down]

    def _out(self, blocks: list[str], height: str) -> list[str]:
        """Return blocks with the way out; which feed is in force behind a cycle is not certain."""
        self.place["Z"], self.polar, self.last = height, None, None
        self.motion, self.feed_lost = "G0", True
        self.moved.add("Z")
        return [*blocks, f"G0 Z{height}"]

    def _peck(self, item: gx.Item, part: int, text: str) -> list[str]:
        """Cycle 1: what it is told, one number in a line."""
        if part == 0:
            self.pecks, self.cycle = {}, 1
        elif part <= len(PECKS):
            self.pecks[part] = Decimal(self._value(item, text))
        else:
            self.refuse(f"CYCL DEF 1.{part}", item)
        return []

    def _pecked(self, item: gx.Item) -> list[str]:
        """Cycle 1: strokes from where the tool stands, out in rapid behind each of them."""
        if len(self.pecks) < len(PECKS):
            raise self.refusal("GX215", "cycle 1 lacks a line", item)
        clear, depth, peck, dwell, feed = (self.pecks[n] for n in range(1, 6))
        if depth >= 0 or not peck or self.inch:
            raise self.refusal("GX215", "cycle 1 upwards, without strokes, or in inches", item)
        top = self.stands_at("Z", item, "cycle 1")
        surface, total, peck = top - abs(clear), -depth, abs(peck)
        before = min(Decimal("0.6") if total <= 30 else total / 50, Decimal(7))
        reached, blocks = Decimal(0), []
        while reached < total:
            if reached:
                near = surface - reached + before
                if near > top:
                    raise self.refusal("GX215", "cycle 1 stops above where it starts", item)
                blocks += [f"G0 Z{exact(top)}", f"Z{written(near)}"]
            reached = min(reached + peck, total)
            blocks += self._stroke(surface - reached, feed, dwell if reached == total else top * 0)
        return self._out(blocks, exact(top))


def _waits(seconds: Decimal | None) -> list[str]:
    return [f"G4 P{exact(seconds)}"] if seconds else []
