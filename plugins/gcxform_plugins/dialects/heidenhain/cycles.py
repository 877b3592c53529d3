"""Cycles of a TNC that are certain: datum shift, dwell, tolerance, and holes in plain strokes."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from decimal import Decimal
from itertools import islice
from typing import Any

import gcxform as gx
from gcxform_plugins.dialects.heidenhain.holes import HOLES, PATTERNS, round_places, row_places
from gcxform_plugins.dialects.heidenhain.parameters import Parameters
from gcxform_plugins.dialects.heidenhain.words import LINEAR, exact, plain, written

VALUE = r"[+-]?(?:\d{1,9}(?:[.,]\d{0,9})?|[.,]\d{1,9})"
DEFINED = re.compile(r"CYCLE?\s+DEF\s*(\d{1,4})(?:\.(\d{1,2}))?(?![\d.])\s*(.*?)\s*~?\s*")
SHIFT_LINE = re.compile(r"[\s\d/]*CYCLE?\s+DEF\s*7\.[1-9]", re.IGNORECASE)
SHIFTED = re.compile(rf"(I?)([XYZABCUVW])\s*(?:({VALUE})|([+-]?\s*Q[LR]?\d+))\s*")
DATUM = re.compile(r"TRANS\s+DATUM\s+(?:AXIS\s+(.*?)|RESET)\s*")
CALLED = re.compile(r"CYCL\s+CALL(\s+PAT\s+F\s*MAX)?((?:\s*M\s*\d{1,4})*)\s*")
PLACE = re.compile(rf"\s*POS[1-9]\s*\(\s*X\s*({VALUE})\s*Y\s*({VALUE})\s*Z\s*({VALUE})\s*\)\s*")
LAST_VALUE = re.compile(rf"(?:[A-Z][A-Z. -]*?)?\s*({VALUE})")
PARAMETER = re.compile(rf"Q(\d{{1,4}})\s*=\s*({VALUE})(?![\w.,])")
PARAMETER_LINE = re.compile(r"[\s\d]*Q[2-4]\d\d\s*=")
PECKS = ("DIST", "DEPTH", "PECKING DEPTH", "DWELL", "F")
CANCELS = {
    **{"8.0": ("MIRROR IMAGE", "SPIEGELN"), "8.1": ("",)},
    **{"10.0": ("ROTATION", "DREHUNG"), "10.1": ("ROT+0", "ROT +0", "ROT+0.000")},
    **{"11.0": ("SCALING", "MASSFAKTOR"), "11.1": ("SCL 1", "SCL1", "SCL 1.000000")},
}
"""Lines of cycles that turn, mirror and scale, where they say that nothing is."""
LEAVE = "if all of the program counts from it, leave this block out: G54 stands for it then"
ALONE = "let the CAM write the hole as plain moves"


class Cycles(Parameters):
    """Reads cycles, and writes those that are called as moves."""

    def __init__(self, *program: Any) -> None:
        super().__init__(*program)
        self.shift = dict.fromkeys(LINEAR, "0")
        self.new_shift: dict[str, str] = {}
        self.hole: dict[int, Decimal] = {}
        self.pecks: dict[int, Decimal] = {}
        self.cycle = 0
        self.bounded = False
        self.places: list[tuple[str, str]] = []
        self.by_cycle = True

    def define(self, item: gx.Item) -> list[str]:
        """CYCL DEF: what a cycle is told. Raises InputError for those that are not resolved."""
        match = DEFINED.fullmatch(item.name)
        if match is None:
            return self._call(item)
        number, part, text = int(match[1]), int(match[2] or 0), match[3]
        if number == 7:
            return self._shift(item, part, text)
        if number == 9:
            return self._dwell(item, part, text)
        if number == 32:
            return self._tolerance(item, part, text)
        if text in CANCELS.get(f"{number}.{part}", ()):
            return []
        if number == 247:
            return self._preset(item, self._parameters(text))
        if number in HOLES:
            self.hole, self.cycle = self._parameters(text), number
            self.given(self.hole.items())
            return []
        if number in PATTERNS:
            return self._pattern(item, number, self._parameters(text))
        if number == 1:
            return self._peck(item, part, text)
        self.refuse(f"CYCL DEF {number} {text}".rstrip() + " is a cycle of the control", item)

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
        while self.lines[self.at - 1].partition(";")[0].rstrip().endswith("~"):
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
        self.refuse_beside("a cycle", item)
        if self.cycle not in HOLES or self.following or not self.places:
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
        hole = HOLES.get(self.cycle)
        if hole is not None and key[1:].isdigit() and int(key[1:]) in hole.needs:
            self.cycle = 0

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
        found = re.fullmatch(rf"T\s*(?:({VALUE})|([+-]?\s*Q[LR]?\d+))", text)
        if part != 1 or (found is None and not self.bounded):
            return []
        bound = "0"
        if found is not None:
            bound = plain(found[1]) if found[1] else self._parameter(found[2], item)
        self.bounded = found is not None
        return [f"G64 P{bound}" if Decimal(bound) > 0 else "G61"]

    # --- where the zero is ---

    def _shift(self, item: gx.Item, part: int, text: str) -> list[str]:
        """Cycle 7: the zero is elsewhere, behind the last line of the cycle."""
        if part == 0:
            self.new_shift = {}
            return []
        for axis, number in self._shifts(item, text):
            if axis in self.new_shift:
                raise self.refusal("GX203", f"{axis} stands in this shift twice", item)
            self.new_shift[axis] = number
        rest = islice(self.lines, self.at, None)
        ahead = next((text for text in rest if text.strip()), "")
        if SHIFT_LINE.match(ahead):
            return []
        if not self.by_cycle and any(map(float, self.shift.values())):
            self.refuse("a datum shift by cycle 7 beside one by TRANS DATUM", item)
        self.by_cycle = True
        return self._shifted(item, self.new_shift)

    def _shifts(self, item: gx.Item, text: str) -> Iterator[tuple[str, str]]:
        """Yield axes with their shifts; `IX` adds to the one in force."""
        at = 0
        while at < len(text):
            match = SHIFTED.match(text, at)
            if match is None:
                self.refuse(f"a datum shift by {text}: a table", item)
            step, axis, number, parameter = match.groups()
            at = match.end()
            value = plain(number) if number else self._parameter(parameter, item)
            if step and axis not in self.shift:
                self.refuse(f"a shift of {axis} by a step, and the one in force is not known", item)
            if step:
                value = exact(Decimal(value) + Decimal(self.shift[axis]))
            yield axis, value

    def _parameter(self, name: str, item: gx.Item) -> str:
        self.computes = True
        return self.value_of(name, item)

    def _shifted(self, item: gx.Item, given: dict[str, str]) -> list[str]:
        """Return the block of a shift, if it is another one than that in force.

        An axis that is not named keeps its shift (simulators of TNC 426 and 640).
        """
        if any(float(n) for axis, n in given.items() if axis not in LINEAR):
            self.refuse("a datum shift of other axes than X, Y and Z", item)
        old, known = self.shift, {**self.shift, **given}
        if not known.keys() >= set(LINEAR):
            self.refuse("a datum shift that leaves out an axis whose shift is not known", item)
        new = {axis: known[axis] for axis in LINEAR}
        by = {a: Decimal(new[a]) - Decimal(old[a]) for a in LINEAR if a in old}
        if len(by) == len(LINEAR) and not any(by.values()):
            return []
        self.refuse_beside("a datum shift", item)
        if self.following:
            self.refuse("a datum shift while the control follows the tip", item)
        for axis in self.place.keys() & set(LINEAR):
            if axis in by:
                self.place[axis] = exact(Decimal(self.place[axis]) - by[axis])
            else:
                self.lose(axis)
        self.shift, self.pole, self.polar, self.last = new, {}, None, None
        return ["G52 " + " ".join(f"{axis}{number}" for axis, number in new.items())]

    def datum(self, item: gx.Item) -> list[str]:
        """TRANS DATUM AXIS and RESET: as cycle 7, where that shifts nothing (TNC7, datum shift).

        Which of the two holds where both shift is not known.
        """
        match = DATUM.fullmatch(item.name)
        if match is None or (self.by_cycle and any(map(float, self.shift.values()))):
            self.refuse(f"{item.name.strip()[:40]} is not resolved", item)
        self.by_cycle = False
        if match[1] is None:
            return self._shifted(item, dict.fromkeys(LINEAR, "0"))
        given: dict[str, str] = {}
        for axis, number in self._shifts(item, match[1]):
            if axis in given:
                raise self.refusal("GX203", f"{axis} stands in this shift twice", item)
            given[axis] = number
        return self._shifted(item, given)

    def _preset(self, item: gx.Item, told: dict[int, Decimal]) -> list[str]:
        """Cycle 247: the preset; the one set by hand, if all of the program counts from it."""
        if told.get(339) != 0 or len(told) > 1:
            self.refuse("a preset of the table: only 0, which is set by hand, is read", item, LEAVE)
        if self.moved or any(float(n) for n in self.shift.values()):
            self.refuse("another preset in the middle of a program", item)
        self.lose()
        return []

    def _parameters(self, text: str) -> dict[int, Decimal]:
        """Return the parameters of a cycle, from this line or from those behind it."""
        parts = [text]
        while self.lines[self.at - 1].rstrip().endswith("~") and self.at < len(self.lines):
            if not PARAMETER_LINE.match(self.lines[self.at].upper()):
                break
            parts.append(self.lines[self.at].upper().partition(";")[0])
            self.at += 1
        found = " ".join(parts)
        return {int(m[1]): Decimal(plain(m[2])) for m in PARAMETER.finditer(found)}

    # --- holes ---

    def called(self, item: gx.Item) -> list[str]:
        """M99 and CYCL CALL: the hole where the tool stands."""
        self.refuse_beside("a cycle", item)
        if self.following:
            self.refuse("a cycle while the control follows the tip", item)
        if self.cycle in HOLES:
            return self._hole(item, self.hole)
        if self.cycle == 1:
            return self._pecked(item)
        raise self.refusal("GX215", "no cycle that is known here has been defined", item)

    def _hole(self, item: gx.Item, told: dict[int, Decimal]) -> list[str]:
        """Return the blocks of a hole in one stroke: out in rapid, or at Q208."""
        hole, name = HOLES[self.cycle], f"cycle {self.cycle}"
        if not told.keys() >= {*hole.needs}:
            raise self.refusal("GX215", f"{name} lacks a parameter", item)
        for number, why in hole.zero.items():
            if told.get(number):
                raise self.refusal("GX215", f"{name} with Q{number}, {why}", item, ALONE)
        if told.keys() - {*hole.needs, *hole.zero, *hole.idle}:
            raise self.refusal("GX215", f"{name} with parameters that are not known", item)
        clear, depth, feed, surface, high = (told[n] for n in (200, 201, 206, 203, 204))
        if depth >= 0 or told.get(202, -depth) < -depth or self.inch:
            message = f"{name} in several strokes, upwards, or in inches"
            raise self.refusal("GX215", message, item, ALONE)
        if clear < 0 or 0 < high < clear:
            raise self.refusal("GX215", f"{name} with Q204 below Q200", item, ALONE)
        up = exact(surface + clear)
        down = [] if self.place.get("Z") == up else [f"G0 Z{up}"]
        blocks = [*down, *self._stroke(surface + depth, feed, told[211])]
        if 208 in hole.needs:
            blocks.append(f"Z{up}{self.feed_word(exact(told[208] or feed))}")
        return self._out(blocks, exact(surface + high) if high else up)

    def _pattern(self, item: gx.Item, number: int, told: dict[int, Decimal]) -> list[str]:
        """Cycles 220 and 221: the cycle defined last at once, over and over."""
        self.refuse_beside("a cycle", item)
        if self.cycle not in HOLES or self.following:
            raise self.refusal("GX215", "no cycle that is known here has been defined", item)
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
        self.given(told.items())  # whether they count for a cycle that is called next is not known
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
