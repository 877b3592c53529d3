"""Polar coordinates of a SINUMERIK: G110 to G112 set a pole, AP= and RP= lead to a place about it.

The pole is a point of the plane, in the coordinates of the program; without one it is their zero
(Fundamentals 11/2006 p. 118). A place is the pole + RP (cos AP, sin AP), from the first axis of the
plane towards the second; in arcs the pole is the centre (Programming 808D 01/2014 p. 55).
"""

from __future__ import annotations

import math
from decimal import Decimal

import gcxform as gx
from gcxform_plugins.dialects.siemens.arcs import CENTRES, NEAR, START
from gcxform_plugins.dialects.siemens.line import ABSOLUTE, Line
from gcxform_plugins.dialects.siemens.moves import Moves
from gcxform_plugins.dialects.siemens.place import PlaceError, text_of

POLES = {"110": "from where the tool stands", "111": "from zero", "112": "from the pole"}
WAY = "write X and Y, or let the CAM write them"
FINEST = Decimal("1e-9")
Point = tuple[float, float]


class Polar(Moves):
    """Follows the pole.

    pole    in the axes of the plane; None where it is not known
    polar   RP and AP that are in force about it
    """

    pole: Point | None = (0.0, 0.0)
    polar: tuple[str, str] = ("", "")

    def lose_pole(self) -> None:
        """Forget the pole: the plane, the unit or the zero is another one, or may be."""
        self.pole, self.polar = None, ("", "")

    def set_pole(self, line: Line) -> None:
        """Take a pole; nothing moves. Raises InputError and PlaceError."""
        assert line.pole is not None
        code, item = line.pole
        if line.axes.keys() - {*self.plane} or line.named.keys() - {"AP", "RP"}:
            self.refuse(f"G{code} beside what is no word of it", item, "give it its own line")
        if any(way not in ("", ABSOLUTE) for way, _, _ in line.axes.values()):
            self.refuse(f"G{code} in steps", item, WAY)
        if line.onwards:
            self.refuse(f"G{code} beside AP=IC(...)", item, WAY)
        base = self._origin(code, item)
        if line.named:
            if len(line.named) < 2 or line.axes:
                self.refuse(f"G{code} takes two axes, or RP and AP", item, WAY)
            by = _point(*(line.named[name][0] for name in ("RP", "AP")))
        else:
            a, b = (float(line.axes[x][1]) if x in line.axes else 0.0 for x in self.plane)
            by = a, b
        self.pole, self.polar = (base[0] + by[0], base[1] + by[1]), ("", "")

    def _origin(self, code: str, item: gx.Item) -> Point:
        """Return the point from which a pole counts. Raises InputError and PlaceError."""
        if code == "111":
            return 0.0, 0.0
        if code == "112":
            return self._pole(item)
        return self._stands()

    def _pole(self, item: gx.Item) -> Point:
        if self.pole is None:
            message = "where the pole is, is not known behind another plane, unit or zero"
            self.refuse(message, item, "write G111 with the pole")
        return self.pole

    def _stands(self) -> Point:
        a, b = (self.place.known(axis) for axis in self.plane)
        if a is None or b is None:
            raise PlaceError("GX208", "it counts from where the tool stands, which is open", START)
        return float(a), float(b)

    def _moving(self, line: Line) -> str:
        if not line.named.keys().isdisjoint(("AP", "RP")):
            self._resolve(line)
        return super()._moving(line)

    def _resolve(self, line: Line) -> None:
        """Put the axes of the plane in the place of AP and RP. Raises InputError and PlaceError."""
        item = next(line.named[name][1] for name in ("AP", "RP") if name in line.named)
        if line.axes.keys() & {*self.plane} or self.steps or line.named.keys() & {"CR", "AR"}:
            self.refuse("AP= or RP= beside words of the plane, of arcs, or in G91", item, WAY)
        if line.onwards:
            self._turn_on(line)
        self.polar = tuple(  # type: ignore[assignment]
            line.named.pop(name)[0] if name in line.named else before
            for name, before in zip(("RP", "AP"), self.polar, strict=True)
        )
        radius, angle = self.polar
        if not radius or not angle or Decimal(radius) < 0:
            self.refuse("AP= and RP= are both needed behind a pole, RP= not below 0", item, WAY)
        centre, by = self._pole(item), _point(radius, angle)
        if self.motion in ("2", "3"):
            self._arc_about(line, centre, float(radius), item)
        elif self.motion not in ("0", "1"):
            self.refuse("AP= and RP= in a path that is no line and no arc", item, WAY)
        for axis, at, d in zip(self.plane, centre, by, strict=True):
            line.axes[axis] = ABSOLUTE, text_of(Decimal(repr(at + d)).quantize(FINEST)), item

    def _turn_on(self, line: Line) -> None:
        """Put the angle to which AP=IC() turns in its place. Raises InputError."""
        by, item = line.named["AP"]
        if not self.polar[1]:
            self.refuse("AP=IC(...) turns on from an angle that is not known", item, WAY)
        line.named["AP"] = text_of(Decimal(self.polar[1]) + Decimal(by)), item

    def _arc_about(self, line: Line, centre: Point, radius: float, item: gx.Item) -> None:
        """Put the centre of an arc about the pole into a line. Raises InputError and PlaceError."""
        start = self._stands()
        if line.centres or abs(math.dist(start, centre) - radius) > NEAR:
            self.refuse("an arc about the pole that does not begin at RP= from it", item, WAY)
        for axis, at, of in zip(self.plane, start, centre, strict=True):
            value = Decimal(repr(of - at)).quantize(FINEST)
            line.centres[CENTRES[axis]] = "", text_of(value), item


def _point(radius: str, angle: str) -> Point:
    at = math.radians(float(angle))
    return float(radius) * math.cos(at), float(radius) * math.sin(at)
