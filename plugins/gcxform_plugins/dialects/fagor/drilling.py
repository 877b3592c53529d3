"""G81 of a Fagor as plain moves: a hole at each place that is told, until G80.

Z is the reference plane and I the depth, both absolute in G90; behind the hole the tool is at the
initial plane (G98), or at the reference plane (G99) [55 162]. A CAM writes them so, and relies on
G0 being in force behind G80 as before [post]. A time at the depth is refused: K counts hundredths
of a second on an 8055, seconds on an 8065.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from typing import NoReturn

import gcxform as gx
from gcxform_plugins.dialects.fagor.places import code_of
from gcxform_plugins.dialects.fagor.polar import Polar

DRILL = "G81"
BACK = frozenset(("G98", "G99"))
BEGINS = BACK | {DRILL, "G0", "G90"}
ENDS = frozenset(("G80", "M2", "M30"))
OPEN = (
    "G81 is read in G17, G90 and G0, with neither compensation nor #RTCP, #MCS, nor behind a turn"
)
OTHER = "what this block does under G81 is not certain"
FIRST = "write G80 before"
BESIDE = "write G98 or G99 beside G81"


@dataclass(frozen=True, slots=True)
class Hole:
    """Where a hole begins and ends along Z, where the tool is behind it, and the code for that."""

    top: Decimal
    bottom: Decimal
    back: Decimal
    code: str


class Drilling(Polar):
    """Drills the holes of G81; in programs that are written back line by line its lines stay.

    hole   that of the cycle in force;  back   G98 or G99, or nothing where neither has been said
    """

    def __init__(self, *given: object) -> None:
        super().__init__(*given)
        self.hole: Hole | None = None
        self.back = ""

    def blocks(self, items: Sequence[gx.Item]) -> Iterable[str]:
        """Return the blocks of a line. Raises InputError."""
        if self.reading.stays:
            return super().blocks(items)
        codes = {code_of(item): item for item in items if item.kind == "code"}
        said = BACK & codes.keys()
        self.back = next(iter(said)) if said else self.back
        if DRILL in codes:
            return self._begun(items, codes)
        if self.hole is None or not [item for item in items if item.name != "N"]:
            return super().blocks(items)
        if ENDS & codes.keys():
            self.hole = None
            return super().blocks(items)
        if codes.keys() - BACK or self.back != self.hole.code:
            self._refuse(OTHER, items, FIRST)
        return self._drilled(items, self.hole, "XY")

    def _begun(self, items: Sequence[gx.Item], codes: Mapping[str, gx.Item]) -> list[str]:
        """Take G81, and drill at the place that its block tells, or where the tool stands."""
        self.places.follow()
        at = self.places.at.get("Z")
        rapid = "G0" in codes or self.places.motion == "G0"
        aside = self.comp or self.following or self.machine or self.turned or self.untold
        if codes.keys() - BEGINS or self.plane != "G17" or not rapid or self.incremental or aside:
            self._refuse(OPEN, items)
        if not self.back:
            self._refuse(
                "whether G98 or G99 is in force is not known", items, "write it beside G81"
            )
        words = self._words(items, "XYZIKF")
        if Decimal(words.get("K", "0")):
            self._refuse("a time at the depth, K: in which unit is not certain", items)
        top = Decimal(words["Z"]) if "Z" in words else at
        if top is None or at is None or "I" not in words:
            self._refuse("G81 without I, or from where Z is not known to stand", items)
        bottom = Decimal(words["I"])
        if not bottom < top <= at:
            self._refuse("its levels are not in order: depth, reference plane, tool", items)
        self.hole = Hole(top, bottom, at if self.back == "G98" else top, self.back)
        return self._drilled(items, self.hole, "XYZIKF")

    def _drilled(self, items: Sequence[gx.Item], hole: Hole, letters: str) -> list[str]:
        """Return the moves of a hole."""
        self._move(items[0])
        words = self._words(items, letters)
        self.plainly, self.polar = False, None
        self.shifted -= words.keys() | {"Z"}
        there = [gx.Item("word", (axis,), (words[axis],), (0, 0)) for axis in "XY" if axis in words]
        behind = gx.Item("word", ("Z",), (f"{hole.back:f}",), (0, 0))
        self.places.note([gx.Item("code", ("G0",), (), (0, 0)), *there, behind])
        number = f"N{words['N']} " if "N" in words else ""
        place = " ".join(f"{item.name}{item.numbers[0]}" for item in there)
        feed = f" F{words['F']}" if "F" in words else ""
        down = [f"G0 Z{hole.top:f}", f"G1 Z{hole.bottom:f}{feed}", f"G0 Z{hole.back:f}"]
        first = [f"G0 {place}"] if place else []
        return [f"{number}{block}" if not k else block for k, block in enumerate([*first, *down])]

    def _words(self, items: Sequence[gx.Item], letters: str) -> dict[str, str]:
        """Return the words of a block, each once. Raises InputError for others."""
        found: dict[str, str] = {}
        for item in items:
            if item.kind == "code":
                continue
            if item.kind != "word" or item.name not in {*letters, "N"} or item.name in found:
                self._refuse(OTHER, items, FIRST)
            found[item.name] = item.numbers[0]
        return found

    def _refuse(self, message: str, items: Sequence[gx.Item], hint: str = "") -> NoReturn:
        item = next((i for i in items if code_of(i) == DRILL), items[0])
        self.refuse(message, item, hint or "write the hole as plain moves")
