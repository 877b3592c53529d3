"""Lines of a SINUMERIK that are told by their angle: ANG= beside one coordinate, or over two lines.

The angle is that of the line from the first axis of the plane towards the second. `X20 ANG=30` ends
where the line comes to X20; of `ANG=45` and `X30 Y10 ANG=-30` behind it the first ends where both
lines meet (NC programming 12/2019 p. 220). A line that would have to go the other way is refused.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from decimal import Decimal

import gcxform as gx
from gcxform_plugins.dialects.siemens.framing import FINEST, Framing
from gcxform_plugins.dialects.siemens.line import ABSOLUTE, Line
from gcxform_plugins.dialects.siemens.place import text_of

ALIKE = 1e-6  # rad, or its sine: lines that hardly cross
ENDS = "write both coordinates of the end"
Point = tuple[float, float]


class Angles(Framing):
    """Finds where lines end that are told by an angle.

    met   where the last one ended and its second line, if that is still to come: then the angle of
          that line says no more than where it began
    """

    met: int = -1

    def by_angle(self, line: Line) -> None:
        """Put the end of a line in the place of ANG=. Raises InputError and PlaceError."""
        number, item = line.named.pop("ANG")
        along = direction(number)
        others = line.centres or line.named or line.middles
        motion = line.motion or self.motion
        if motion not in ("0", "1") or others or self.following or self.comp:
            self.refuse("ANG= beside words of arcs, under TRAORI or compensation", item, ENDS)
        start = self._stands()
        given = [axis for axis in self.plane if axis in line.axes]
        if len(given) == len(self.plane):
            if self.met != self.line:
                self.refuse("ANG= beside both coordinates of an end", item, ENDS)
            return
        end = self._at(line, given[0], start, along, item) if given else self._meets(start, along)
        if end is None:
            self.refuse("ANG= leads to no place, or away from it", item, ENDS)
        for axis, value in zip(self.plane, end, strict=True):
            line.axes[axis] = ABSOLUTE, text_of(Decimal(repr(value)).quantize(FINEST)), item

    def _at(self, line: Line, axis: str, start: Point, along: Point, item: gx.Item) -> Point | None:
        """Return where a line comes to a coordinate; None where it leads away from it."""
        k = self.plane.index(axis)
        way = self._ends(line)[axis] - start[k]
        if abs(along[k]) < ALIKE or way * along[k] <= 0:
            return None
        far = way / along[k]
        return start[0] + far * along[0], start[1] + far * along[1]

    def _meets(self, start: Point, along: Point) -> Point | None:
        """Return where a line meets the next one, which has its end and its angle."""
        at, items = self._next_line()
        told = {item.names[0]: item for item in items}
        if not {*self.plane, "ANG"} <= told.keys() or not all(map(_is_plain, items)) or self.steps:
            return None
        to = [float(told[axis].numbers[0]) for axis in self.plane]
        other = direction(told["ANG"].numbers[0])
        bend = along[0] * other[1] - along[1] * other[0]
        if abs(bend) < ALIKE:
            return None
        a, b = to[0] - start[0], to[1] - start[1]
        far, rest = (a * other[1] - b * other[0]) / bend, (along[0] * b - along[1] * a) / bend
        if far <= 0 or rest <= 0:
            return None
        self.met = at
        return start[0] + far * along[0], start[1] + far * along[1]

    def _next_line(self) -> tuple[int, Sequence[gx.Item]]:
        """Return the next line of this file that says something, and its items."""
        file = self.place_of(self.line)[0]
        for at in range(self.line + 1, len(self.lines)):
            items = [i for i in self.items(at) if i.kind != "comment" and i.name != "N"]
            if items or self.place_of(at)[0] != file:
                return at, items if self.place_of(at)[0] == file else ()
        return -1, ()


def direction(degrees: str) -> Point:
    """Return the direction of an angle, in the axes of the plane."""
    angle = math.radians(float(degrees))
    return math.cos(angle), math.sin(angle)


def _is_plain(item: gx.Item) -> bool:
    """Whether a word of the second line says where it goes, absolute, and nothing else."""
    if item.kind == "named":
        return item.names == ("ANG",)
    return item.kind in ("word", "value") and (
        item.name in "XYZF" or (item.name == "G" and item.numbers[0] in ("1", "01"))
    )
