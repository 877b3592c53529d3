"""APPR and DEP: the ways on to a contour and off it, as lines and arcs that lengthen it.

The manual says them of the tool's centre, beside the first and the last contour point. An arc is
said as one of the contour, whose radius is larger by that of the tool, or smaller: the centre then
goes where the manual has it, for it begins perpendicular to its start (620 ISO, p. 146).

| block | path of the centre | said |
|---|---|---|
| APPR LT, LEN | to a point LEN before the contour, on along its first element | TNC7, APPR |
| APPR LN, LEN | to a point LEN beside it, and square on | TNC7, APPR |
| APPR CT, CCA, R | an arc into the first element; R below 0: from the other side | TNC7, APPR |
| APPR LCT, R | a line that goes on into that arc | TNC 410, p. 72 |
| DEP LT, LN, CT, LCT | the same the other way round, and then R0 | TNC7, DEP |
| APPR PLT, PLN, PCT, PLCT, DEP PLCT | the point by PR and PA about CC | TNC7, APPR |
| the way to the first point | as the move before; in LCT at F of the block | iTNC 530, p. 230 |
| Z in APPR LN | behind the way to its first point; at another feed: refused | 640, p. 213 |
| Z in the others, R0 in APPR, steps behind DEP but LCT | refused: not certain, or not the same | |
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import acos, atan2, degrees, hypot

import gcxform as gx
from gcxform_plugins.dialects.heidenhain.contours import BARE, STRAIGHT, Contours
from gcxform_plugins.dialects.heidenhain.moves import SIDES
from gcxform_plugins.dialects.heidenhain.polar import LEAST_ANGLE, TURN, around
from gcxform_plugins.dialects.heidenhain.positioning import Said
from gcxform_plugins.dialects.heidenhain.words import Point, exact, written

SIZES = {"len": "LEN", "cca": "CCA"}
NEEDS = {"LT": ("LEN",), "LN": ("LEN",), "CT": ("CCA", "R"), "LCT": ("R",)}
SQUARE = (
    "APPR and DEP are where the manual has them if compensation begins and ends square to the "
    "contour, as it does in cutter-comp: a control that is left to do it has its own way"
)
CODES = {1.0: "G3", -1.0: "G2"}


@dataclass(frozen=True, slots=True)
class Arc:
    """An arc that lengthens a contour at a point of it.

    `radius` is that of the tool's centre, `size` that of the contour; `left` is 1 if it turns left.
    """

    touches: Point
    centre: Point
    radius: float
    size: float
    left: float

    @property
    def angle(self) -> float:
        """The direction (degrees) in which the contour is from the centre."""
        return _angle(self.centre, self.touches)

    def at(self, angle: float, size: float) -> Point:
        """Return the point so far from the centre in a direction (degrees)."""
        along, aside = around(angle)
        return self.centre[0] + size * along, self.centre[1] + size * aside

    def tangent(self, point: Point, way: float) -> float | None:
        """Return where a line from a point (1), or to it (-1), touches the path of the centre.

        An angle (degrees); None where no line does.
        """
        away = hypot(point[0] - self.centre[0], point[1] - self.centre[1])
        if away <= self.radius * (1 + STRAIGHT):
            return None
        return _angle(self.centre, point) + way * self.left * degrees(acos(self.radius / away))


class Approaches(Contours):
    """Goes on to a contour, and off it again."""

    def along_contour(self, items: Sequence[gx.Item]) -> list[str]:
        """APPR and DEP. Raises InputError."""
        path, before = items[0], (self.feed, self.feed_lost)
        way, kind = path.name.split()
        aside = self.begins is not None or self.following or self.shortest or self.mirrored
        if self.reading.stays or aside:
            self.refuse(f"{path.name} is not resolved here", path)
        sizes = {SIZES[i.kind]: float(self.number_of(i)) for i in items[1:] if i.kind in SIZES}
        said = self.said([item for item in items[1:] if item.kind not in SIZES])
        sizes |= {"R": float(said.radius)} if said.radius else {}
        shape = kind.removeprefix("P")
        if {*sizes} != {*NEEDS[shape]} or said.sense or said.rapid or said.machine:
            needs = " and ".join(NEEDS[shape])
            raise self.refusal("GX213", f"{path.name} takes {needs}, and no more", path)
        if any(size <= 0 for name, size in sizes.items() if name != "R" or shape == "LCT"):
            raise self.refusal("GX213", f"{path.name} with a size of 0 or below", path)
        if sizes.get("CCA", 1.0) > TURN or said.after or said.calls or said.end:
            self.refuse(f"{path.name} with a larger CCA, or an M function at its end", path)
        self._check_feed()
        self.assumed.setdefault(SQUARE)
        if way == "APPR":
            return [*said.before, *self._on(path, said, shape, sizes, before)]
        return [*said.before, *self._off(path, said, shape, sizes)]

    def _on(
        self,
        path: gx.Item,
        said: Said,
        shape: str,
        sizes: dict[str, float],
        before: tuple[str, bool],
    ) -> list[str]:
        """Return the blocks of APPR; `before` is the feed in force, and whether it is lost."""
        side = SIDES.get(said.side.name, "") if said.side else ""
        if not side or self.side or not self.motion:
            self.refuse(f"{path.name} without RL or RR, under them, or first of all moves", path)
        radius, rapid = self.tool_radius(path), self.motion == "G0" and shape != "LCT"
        if shape != "LCT" and not rapid and (before[1] or not before[0]):
            raise self.refusal("GX204", f"{path.name}: no feed is in force before it", path)
        start = self._stands(path) if shape == "LCT" else (0.0, 0.0)
        point, down = self._goes_to(path, said)
        if down and (shape != "LN" or rapid or before[0] != self.feed):
            self.refuse(f"{path.name} with another Z: how fast it goes there is not certain", path)
        self.side, self.last, self.polar = side, None, None
        self.place |= {"X": written(point[0]), "Y": written(point[1])}
        self.moved |= {"X", "Y"}
        along, left = self._leads(path, point), 1.0 if side == "G41" else -1.0
        aside = -along[1] * left, along[0] * left
        begins = f"{self.in_plane('G17')}{self.beside(side, path)}"
        code, feed = ("G0" if rapid else "G1"), said.feed
        if shape == "LT":
            ahead = _away(point, along, -sizes["LEN"])
            return [self._go(code, ahead, begins), self._go("G1", point, rest=feed)]
        if shape == "LN":
            ahead = _away(point, aside, radius + sizes["LEN"])
            return [self._go(code, ahead), *down, self._go("G1", point, begins, feed)]
        arc = self._arc_at(path, point, aside, left, radius, sizes["R"])
        if shape == "LCT":
            angle = self._checked(path, arc, arc.tangent(start, 1.0), 1.0)
            return [self._go("G1", arc.at(angle, arc.size), begins, feed), self._turn(arc, angle)]
        angle = arc.angle - arc.left * sizes["CCA"]
        return [self._go(code, arc.at(angle, arc.size), begins), self._turn(arc, angle, rest=feed)]

    def _off(self, path: gx.Item, said: Said, shape: str, sizes: dict[str, float]) -> list[str]:
        """Return the blocks of DEP."""
        if not self.side or said.side or self.last is None:
            self.refuse(f"{path.name} behind no element of a contour in RL or RR", path)
        radius, point, along = self.tool_radius(path), self._stands(path), self._along(path)
        left = 1.0 if self.side == "G41" else -1.0
        aside = -along[1] * left, along[0] * left
        end, feed = point, said.feed
        if shape == "LCT":
            end, down = self._goes_to(path, said)
        elif said.axes:
            raise self.refusal("GX213", f"{path.name} takes no coordinates", path)
        if shape == "LCT" and down:
            self.refuse(f"{path.name} with another Z: controls differ in when they go there", path)
        self.side, self.last, self.polar = "", None, None
        if shape == "LT":
            end = _away(_away(point, along, sizes["LEN"]), aside, radius)
        elif shape == "LN":
            end = _away(point, aside, radius + sizes["LEN"])
        blocks = []
        if shape in ("CT", "LCT"):
            arc = self._arc_at(path, point, aside, left, radius, sizes["R"])
            angle = arc.angle + arc.left * sizes.get("CCA", 0.0)
            if shape == "LCT":
                angle = self._checked(path, arc, arc.tangent(end, -1.0), -1.0)
            else:
                end = arc.at(angle, arc.radius)
            blocks, feed = [self._turn(arc, angle, to=angle, rest=feed)], ""
        self.place |= {"X": written(end[0]), "Y": written(end[1])}
        blocks.append(self._go("G1", end, "G40", feed))
        if shape != "LCT":
            self.lose("XY")  # from where steps count then, controls do not agree
        return blocks

    # --- geometry ---

    def _goes_to(self, path: gx.Item, said: Said) -> tuple[Point, list[str]]:
        """Return the point of a block, and the move along Z, where that is another one."""
        if path.name.split()[1].startswith("P"):
            pole, (given, ends) = self._pole(path), self._polar_words(said)
            if given.keys() != {"PR", "PA"}:
                raise self.refusal("GX213", f"{path.name} takes PR and PA", path)
            ends |= self._at(pole, given["PR"], given["PA"])
        else:
            ends = self._ends(said, "XYZ")
        x, y = (float(ends[a]) if a in ends else float(self.stands_at(a, path)) for a in "XY")
        if "Z" not in ends or ends["Z"] == exact(self.stands_at("Z", path)):
            return (x, y), []
        self.place["Z"] = ends["Z"]
        return (x, y), [f"Z{ends['Z']}"]

    def _leads(self, path: gx.Item, point: Point) -> Point:
        """Return the direction in which the next element goes. Raises InputError."""
        at = self.at
        while at < len(self.lines) and BARE.fullmatch(self.lines[at]):
            at += 1
        line = self.items(at) if at < len(self.lines) else ()
        items = [item for item in line if item.kind not in ("seq", "comment")]
        name = items[0].name if items and items[0].kind == "path" else ""
        if name not in ("L", "C"):
            self.refuse(f"{path.name} before anything but L or C", path)
        said = self._peeked(items)
        if name == "C":
            pole = self._pole(path)
            left = 1.0 if said.sense == "G3" else -1.0
            by = left * (float(pole["Y"]) - point[1]), left * (point[0] - float(pole["X"]))
        else:
            ends = self._plane(said, path)
            x, y = (float(ends.get(axis, self.place[axis])) for axis in "XY")
            by = x - point[0], y - point[1]
        size = hypot(*by)
        if not size:
            self.refuse(f"{path.name} before an element that goes nowhere", path)
        return by[0] / size, by[1] / size

    def _arc_at(
        self, path: gx.Item, point: Point, aside: Point, left: float, tool: float, radius: float
    ) -> Arc:
        """Return the arc that touches the contour; a radius below 0 is on its other side."""
        size = tool + radius
        if size * radius <= 0:
            self.refuse(f"{path.name} with R within the radius of the tool", path)
        turns = left if radius > 0 else -left
        return Arc(point, _away(point, aside, size), abs(radius), abs(size), turns)

    def _checked(self, path: gx.Item, arc: Arc, angle: float | None, way: float) -> float:
        """Return the angle of a tangent that leaves an arc between. Raises InputError."""
        if angle is None:
            raise self.refusal("GX213", f"{path.name}: no line there goes into its arc", path)
        turn = (arc.angle - angle) * arc.left * way % TURN
        if min(turn, TURN - turn) < LEAST_ANGLE:
            self.refuse(f"{path.name} along the contour, with no arc", path)
        return angle

    def _turn(self, arc: Arc, begin: float, to: float | None = None, rest: str = "") -> str:
        """Return the block of an arc that ends at the contour, or begins there and ends at `to`."""
        first = arc.at(begin, arc.size) if to is None else arc.touches
        end = arc.touches if to is None else arc.at(to, arc.size)
        by = arc.centre[0] - first[0], arc.centre[1] - first[1]
        words = f" I{written(by[0])} J{written(by[1])}{rest}"
        return self._go(CODES[arc.left], end, rest=words)

    def _go(self, code: str, place: Point, before: str = "", rest: str = "") -> str:
        words = f"X{written(place[0])} Y{written(place[1])}{rest}"
        return " ".join(filter(None, (before, self.moving(code), words)))


def _away(point: Point, along: Point, size: float) -> Point:
    return point[0] + size * along[0], point[1] + size * along[1]


def _angle(centre: Point, point: Point) -> float:
    return degrees(atan2(point[1] - centre[1], point[0] - centre[0]))
