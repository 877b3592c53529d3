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
BESIDE = frozenset((202, 204))
ALONE = "let the CAM write the hole as plain moves"
IN_PLACE = "this calls a cycle as it stands"
CALLED = "called as they stand, from places corrected for the height of the tool there: cycles {}"


class KeptCycles(Datums):
    """Calls cycles as they stand where all is written in the lines of the program.

    calls_kept   the numbers of those that are
    """

    calls_kept: frozenset[int] = frozenset()

    def keeps(self, number: int) -> bool:
        """Whether a cycle may be called as it stands."""
        tied = number == RIGID and not self.reading.compensates  # it is read, and stays a tap
        return self.reading.asides and number in KEPT and not tied

    def kept_hole(self, item: gx.Item, number: int, told: Mapping[int, Decimal]) -> list[str]:
        """Return the block of a cycle that is called as it stands. Raises InputError."""
        if lacks := sorted({*LEVELS} - told.keys()):
            message = f"cycle {number} lacks Q{lacks[0]}, or a number for it"
            hint = f"define it with Q{lacks[0]} = a number"
            raise self.refusal("GX215", message, item, hint)
        clear, surface, high = (told[n] for n in LEVELS)
        if clear < 0 or high < 0 or self.inch or self.mirrored != "":
            message = f"cycle {number} in inches or a mirror image, or with Q200 or Q204 below 0"
            raise self.refusal("GX215", message, item, ALONE)
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
