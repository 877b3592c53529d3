"""Where the zero of a TNC is, and how coordinates are turned about it: cycles 7, 8 and 10.

TRANS DATUM, ROTATION and MIRROR are the same. A rotation and a mirror image count from the zero in
force, which is not moved under them; both at once are refused, for controls differ in their order.
Where an axis is that has not been told since is not known: some act on it at once, some then.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from decimal import Decimal
from itertools import islice
from typing import Any

import gcxform as gx
from gcxform_plugins.dialects.heidenhain.parameters import Parameters
from gcxform_plugins.dialects.heidenhain.words import LINEAR, exact, plain

VALUE = r"[+-]?(?:\d{1,9}(?:[.,]\d{0,9})?|[.,]\d{1,9})"
SHIFT_LINE = re.compile(r"[\s\d/]*CYCLE?\s+DEF\s*7\.[1-9]", re.IGNORECASE)
SHIFTED = re.compile(rf"(I?)([XYZABCUVW])\s*(?:({VALUE})|([+-]?\s*Q[LR]?\d+))\s*")
DATUM = re.compile(r"TRANS\s+DATUM\s+(?:AXIS\s+(.*?)|RESET)\s*")
NUMBER = rf"(?:({VALUE})|([+-]?\s*Q[LR]?\d+))"
ROTATION = re.compile(rf"(I?)ROT\s*{NUMBER}\s*")
TURNS = re.compile(r"TRANS\s+(ROTATION|MIRROR)\s+(?:(RESET)|AXIS\s+(.*?)|(I?ROT.*?))\s*")
SCALE = re.compile(rf"SCL\s*({VALUE})")
UNTURNED = "end the rotation or the mirror image before"
PLACE = (
    "say presets = [{}] in [control], if the place of G54 in the machine file is that of this "
    "preset, and it is not turned; a second number is that of G55"
)
PRESET = "preset {} of cycle 247 is where the program counts from, and {} stands for it"
NOT_FOLDED = "its place would go into words that count from it where the cycle stands"
PRESETS = 6  # work offsets that stand for some: G54 to G59


class Datums(Parameters):
    """Follows where the zero is.

    shift     that of each axis; one that is not here is not known;  new_shift: that being told
    by_cycle  whether it is that of cycle 7, and not of TRANS DATUM
    """

    def __init__(self, *program: Any) -> None:
        super().__init__(*program)
        self.shift = dict.fromkeys(LINEAR, "0")
        self.new_shift: dict[str, str] = {}
        self.by_cycle = True

    def cycle_7(self, item: gx.Item, part: int, text: str) -> list[str]:
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
        blocks = self._shifted(item, self.new_shift)
        axes = enumerate(self._unshifted(self.new_shift, blocks), 1)
        ends = [f"CYCL DEF 7.{number} {axis}+0" for number, axis in axes]
        return [*blocks, *(self.all_along("CYCL DEF 7.0 DATUM SHIFT", *ends) if ends else ())]

    def _shifts(self, item: gx.Item, text: str) -> Iterator[tuple[str, str]]:
        """Yield axes with their shifts; `IX` adds to the one in force."""
        at = 0
        while at < len(text):
            match = SHIFTED.match(text, at)
            if match is None:
                self.refuse(f"a datum shift by {text}: a table", item)
            step, axis, number, parameter = match.groups()
            at = match.end()
            value = plain(number) if number else self.parameter(parameter, item)
            if step and axis not in self.shift:
                self.refuse(f"a shift of {axis} by a step, and the one in force is not known", item)
            if step:
                value = exact(Decimal(value) + Decimal(self.shift[axis]))
            yield axis, value

    def parameter(self, name: str, item: gx.Item) -> str:
        """Return the number of a parameter in a cycle. Raises InputError."""
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
        self._check_still("a datum shift", item)
        if self.turn or self.mirrored:
            self.refuse("a datum shift in turned or mirrored coordinates", item, UNTURNED)
        for axis in self.place.keys() & set(LINEAR):
            if axis in by:
                self.place[axis] = exact(Decimal(self.place[axis]) - by[axis])
            else:
                self.lose(axis)
        self.shift, self.pole, self.polar, self.last = new, {}, None, None
        ends = self.shifted_in_tilt(item, new)
        return [*ends, "G52 " + " ".join(f"{axis}{number}" for axis, number in new.items())]

    def shifted_in_tilt(self, item: gx.Item, shift: dict[str, str]) -> list[str]:
        """Return the blocks that end what a shift is said in. Raises InputError."""
        raise NotImplementedError

    def _unshifted(self, given: dict[str, str], blocks: list[str]) -> list[str]:
        """Return the axes whose shift ends by what no block says: one from before the program."""
        shifted = blocks or any(map(float, self.shift.values()))
        return [axis for axis in given if axis not in LINEAR or not shifted]

    def _check_still(self, what: str, item: gx.Item) -> None:
        """Refuse to change the frame where more hangs on it. Raises InputError."""
        self.refuse_beside(what, item)
        if self.following or self.begins is not None:
            self.refuse(f"{what} while the control follows the tip, or behind a corner", item)
        if self.turn is None or self.mirrored is None:
            self.refuse(f"{what}, and how coordinates are turned is not known", item)

    # --- turned coordinates ---

    def cycle_10(self, item: gx.Item, part: int, text: str) -> list[str]:
        """Cycle 10: X and Y are turned about the zero; `IROT` adds to the angle in force."""
        if part != 1:
            return []
        found = ROTATION.fullmatch(text)
        if found is None:
            self.refuse(f"{item.name.strip()[:40]} is not resolved", item)
        angle = Decimal(plain(found[2]) if found[2] else self.parameter(found[3], item))
        if found[1] and self.turn is not None:
            angle += self.turn
        if angle == self.turn:
            return [] if angle else self._unturned(item, "CYCL DEF 10.0 ROTATION", "10.1 ROT+0")
        self._check_still("a rotation", item)
        if self.mirrored:
            self.refuse("a rotation of mirrored coordinates: controls differ in the order", item)
        blocks = ["G69"] if self.turn else []
        if angle:
            blocks.append(f"{self.in_plane('G17')}G68 X0 Y0 R{exact(angle)}")
        self.turn = angle
        self._lose_frame("XY")
        return blocks

    def cycle_8(self, item: gx.Item, part: int, text: str) -> list[str]:
        """Cycle 8: axes are mirrored at the zero, those that are not named no more."""
        if part != 1:
            return []
        axes = "".join(sorted(text.split()))
        if not set(axes) <= set(LINEAR) or len(set(axes)) != len(axes):
            self.refuse(f"a mirror image of {text}", item)
        if axes == self.mirrored:
            return [] if axes else self._unturned(item, "CYCL DEF 8.0 MIRROR IMAGE", "8.1")
        self._check_still("a mirror image", item)
        if self.turn:
            self.refuse("a mirror image in turned coordinates: controls differ in the order", item)
        before, self.mirrored = self.mirrored or "", axes
        self._lose_frame("".join(sorted({*before, *axes})))
        ends = ["G50.1" + "".join(f" {axis}0" for axis in before)] if before else []
        return [*ends, "G51.1" + "".join(f" {axis}0" for axis in axes)] if axes else ends

    def cycle_11(self, item: gx.Item, part: int, text: str) -> list[str]:
        """Cycle 11: a scale of 1 is none. Raises InputError for others."""
        found = SCALE.fullmatch(text)
        if part == 1 and (found is None or float(plain(found[1])) != 1.0):
            self.refuse("a scale: whether it is of all axes is a parameter of the machine", item)
        self.ends("a scale of 1", item)
        return self.along()

    def _unturned(self, item: gx.Item, first: str, last: str) -> list[str]:
        """Return what ends no rotation or mirror image of this program, but may one before it."""
        found = TURNS.fullmatch(item.name)
        if found is not None:
            return self.along(f"TRANS {found[1]} RESET")
        return self.all_along(first, f"CYCL DEF {last}")

    def _lose_frame(self, axes: str) -> None:
        self.lose(axes)
        self.pole, self.polar, self.last = {}, None, None

    def transformed(self, item: gx.Item) -> list[str]:
        """TRANS: DATUM, ROTATION, MIRROR. Raises InputError."""
        found = TURNS.fullmatch(item.name)
        if found is None:
            return self.datum(item)
        name, reset, axes, angle = found.groups()
        if name == "ROTATION" and axes is None:
            return self.cycle_10(item, 1, "ROT+0" if reset else angle)
        if name == "MIRROR" and angle is None:
            return self.cycle_8(item, 1, "" if reset else axes)
        self.refuse(f"{item.name.strip()[:40]} is not resolved", item)

    def datum(self, item: gx.Item) -> list[str]:
        """TRANS DATUM AXIS and RESET: as cycle 7, where that shifts nothing (TNC7, datum shift).

        Which of the two holds where both shift is not known.
        """
        match = DATUM.fullmatch(item.name)
        if match is None or (self.by_cycle and any(map(float, self.shift.values()))):
            self.refuse(f"{item.name.strip()[:40]} is not resolved", item)
        self.by_cycle = False
        if match[1] is None:
            return [*self._shifted(item, dict.fromkeys(LINEAR, "0")), *self.along()]
        given: dict[str, str] = {}
        for axis, number in self._shifts(item, match[1]):
            if axis in given:
                raise self.refusal("GX203", f"{axis} stands in this shift twice", item)
            given[axis] = number
        blocks = self._shifted(item, given)
        ends = "".join(f" {axis}+0" for axis in self._unshifted(given, blocks))
        return [*blocks, *(self.along(f"TRANS DATUM AXIS{ends}") if ends else ())]

    def preset(self, item: gx.Item, given: dict[int, Decimal]) -> list[str]:
        """Cycle 247: the preset that the program counts from. Raises InputError.

        Another one than before is read where the machine file has a work offset for each.
        """
        number = given.get(339)
        if number is None or len(given) > 1:
            self.refuse("a preset without its number", item)
        work, before = self._work_of(number), self._work_of(self.counts_from)
        self._check_preset(item, number, work, before)
        self.counts_from = number
        if number:
            self.assumed[PRESET.format(exact(number), work or "G54")] = None
        stays = work == (before or "G54")
        self.lose(LINEAR if work and stays else None)
        blocks = self.along("CYCL DEF 247 DATUM SETTING ~")
        if work and not stays:
            blocks = [" ".join([work, *blocks])]
        return [*blocks, *self.along(f" Q339=+{exact(number)}")]

    def _check_preset(self, item: gx.Item, number: Decimal, work: str, before: str) -> None:
        """Refuse a preset of which nobody knows where it is, or that would stand beside its place.

        `work` and `before` are the work offsets that stand for it, and for the one in force.
        """
        another = number != self.counts_from and (self.moved or self.counts_from is not None)
        open_ = another and not (work and before)
        turned = self.turn != 0 or self.mirrored != ""
        if open_ or turned or any(float(n) for n in self.shift.values()):
            self.refuse("another preset in the middle of a program", item)
        if number and not (work or self.reading.stays) and "G54" in self.reading.work_offsets:
            name = exact(number)
            self.refuse(f"{name} of the presets, each at its own place", item, PLACE.format(name))
        if work not in ("", "G54") and self.reading.turns_plainly and self.reading.asides:
            self.refuse(f"preset {exact(number)}: {NOT_FOLDED}", item)

    def _work_of(self, number: Decimal | None) -> str:
        """Return the work offset that stands for a preset, if the machine file says one."""
        place = None if number is None else self.reading.control.get(f"presets {exact(number)}")
        return f"G{54 + int(place)}" if place is not None and int(place) < PRESETS else ""
