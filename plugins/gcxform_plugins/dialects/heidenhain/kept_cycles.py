"""Cycles along the tool that are called as they stand: their lines stay, on the control of them.

Behind one the tool is over the place of the hole, as high as Q203 with the larger of Q200 and Q204,
as behind those that are read (`holes.py`); which feed is in force is not known. Of cycles that go
beside the hole it is not certain that they come back over it.
"""

from __future__ import annotations

from collections.abc import Mapping
from decimal import Decimal

import gcxform as gx
from gcxform_plugins.dialects.heidenhain.datums import Datums
from gcxform_plugins.dialects.heidenhain.words import exact

HOLE = "G65.1"
"""The code of the block that stands for such a cycle."""
KEPT = frozenset((202, 204, 206, 207, 209, 241))
"""Those of which the moves are not read, or are tied to the spindle."""
RIGID = 207
LEVELS = 200, 203, 204
DEPTH = 201
BACK_BORING, DEPTHS = 204, (250, 252, 200)
"""What bores from below goes down through the part, by its edge, and as far clear of it."""
CENTRING, BY_DIAMETER = 240, 343
BESIDE = frozenset((202, 204))
ALONE = "let the CAM write the hole as plain moves"
IN_PLACE = "this calls a cycle as it stands"
CALLED = "called as they stand, from places corrected for the height of the tool there: cycles {}"


class KeptCycles(Datums):
    """Calls cycles as they stand where all is written in the lines of the program.

    calls_kept   the numbers of those that are
    """

    calls_kept: frozenset[int] = frozenset()
    cycle: int

    def keeps(self, number: int) -> bool:
        """Whether a cycle may be called as it stands."""
        tied = number == RIGID and not self.reading.compensates  # it is read, and stays a tap
        return self.reading.asides and number in KEPT and not tied

    def levels(self) -> tuple[int, ...]:
        """Return the parameters of the cycle in force that its blocks hang on."""
        deep = DEPTHS if self.cycle == BACK_BORING else (DEPTH,)
        return (*LEVELS, *deep) if self.reading.compensates else LEVELS

    def _depth(self, item: gx.Item, number: int, told: Mapping[int, Decimal]) -> Decimal:
        """Return how far below Q203 a cycle goes. Raises InputError."""
        if number == CENTRING and told.get(BY_DIAMETER):
            message = "cycle 240 with Q343, a depth by the diameter, is not known to be so deep"
            raise self.refusal("GX215", message, item, ALONE)
        return sum((told[n] for n in DEPTHS), Decimal(0)) if number == BACK_BORING else -told[DEPTH]

    def kept_hole(self, item: gx.Item, number: int, told: Mapping[int, Decimal]) -> list[str]:
        """Return the block of a cycle that is called as it stands. Raises InputError."""
        if lacks := sorted({*self.levels()} - told.keys()):
            message = f"cycle {number} lacks Q{lacks[0]}, or a number for it"
            hint = f"define it with Q{lacks[0]} = a number"
            raise self.refusal("GX215", message, item, hint)
        clear, surface, high = (told[n] for n in LEVELS)
        if clear < 0 or high < 0 or self.inch or self.mirrored != "":
            message = f"cycle {number} in inches or a mirror image, or with Q200 or Q204 below 0"
            raise self.refusal("GX215", message, item, ALONE)
        deep = self._depth(item, number, told) if self.reading.compensates else Decimal(0)
        self.in_place[self.line] = IN_PLACE
        self.calls_kept |= {number}
        level = exact(surface + max(clear, high))
        said = " ".join(f"Q{n}={exact(value)}" for n, value in sorted(told.items()))
        end = level if "." in level else f"{level}."  # else increments, perhaps
        self.place["Z"], self.polar, self.last = level, None, None
        self.feed_lost = True
        self.moved.add("Z")
        if number in BESIDE:
            self.loses_behind[self.visit] = "XY"
            self.lost |= dict.fromkeys("XY", self.line + 1)
            self.place = {axis: at for axis, at in self.place.items() if axis not in "XY"}
        if self.reading.compensates:
            end += f" K{exact(Decimal(level) - surface + deep)}"
        return [f"{HOLE} Z{end} {gx.Speller.aside(f'CYCL DEF {number} {said}')}"]


class CallsKept(gx.Speller):
    """Calls cycles as they stand: what they are told was said where they are defined."""

    place: dict[str, Decimal]

    def heard(self, block: str) -> tuple[list[str], list[str], list[tuple[str, str]]]:
        """Return what goes along, the other comments, and the words."""
        asides, comments, words = super().heard(block)
        if words[:1] != [(HOLE[0], HOLE[1:])]:
            return asides, comments, words
        self.place["Z"] = Decimal(dict(words)["Z"])
        return ["CYCL CALL"], comments, []
