"""Programs for LinuxCNC over the whole language: shifts, and in them cycles and contours.

Every canned cycle and every contour under cutter compensation is one that the control accepts, so
that what is drawn can be compared move by move.
"""

from collections.abc import Callable
from typing import Final

from gcxform.testing.generate import PLANES
from gcxform.testing.layout import Words, number
from gcxform.testing.shifts import ShiftingBuilder

DWELLING: Final = ("82", "86", "89")
PECKING: Final = ("73", "83")


class WholeBuilder(ShiftingBuilder):
    """One program in the making."""

    retract = "99"

    def _kinds(self) -> list[Callable[[], None]]:
        return [*super()._kinds(), self._cycle, self._cycle, self._contour]

    # --- canned cycles

    def _cycle(self) -> None:
        """Write a series of holes and leave the cycle; the tool ends over the last one."""
        if self.pending or self.diameter or self.feed_mode != "G94":
            self._line()
            return
        self.speed = self.pick(1, 5000)
        self._emit([("S", str(self.speed)), ("M", "3")])
        axes = PLANES[self.plane][0]
        plane, normal = [axes[0], axes[1]], axes[2]
        code = self.one(("81", "82", "83", "73", "85", "86", "89"))
        initial = self.position[normal]
        words, clearance = self._levels(normal, code)
        if self.chance(40):
            self.retract = self.one(("98", "99"))
            words = [("G", self.retract), *words]
        self.feed_known = True
        words += [("F", self.layout.number(number(self.pick(50, 5000) / 10, 1)))]
        self._emit([("G", code), *self._hole(plane), *words])
        for _ in range(self.pick(0, 3)):
            self._emit(self._hole(plane))
        self.position[normal] = max(initial, clearance) if self.retract == "98" else clearance
        self._emit([("G", "80")])
        self.motion, self.unsettled = "", False

    def _levels(self, normal: str, code: str) -> tuple[Words, float]:
        """Draw R, the bottom, and what else the cycle wants; return the words, and R in mm."""
        unit, places = self._unit(normal), self._decimals(normal)
        start = self.position[normal]
        clearance, r_word = self._level(start, start + self.pick(-200, 200) / 10, unit, places)
        depth = self.pick(5, 250) / 10
        _, bottom_word = self._level(clearance, clearance - depth, unit, places)
        words: Words = [(normal, bottom_word), ("R", r_word)]
        if code in DWELLING:
            words.append(("P", number(self.pick(0, 20) / 10, 1)))
        if code in PECKING:  # no whole number of pecks: there the last bit of a level decides
            words.append(("Q", self.layout.number(number(max(depth / unit / 3.7, 0.13), places))))
        return words, clearance

    def _level(self, base: float, wanted: float, unit: float, places: int) -> tuple[float, str]:
        """Return a level on the grid (mm) near the wanted one, and its word."""
        base = base if self.incremental else 0.0
        text = number((wanted - base) / unit, places)
        return base + float(text) * unit, self.layout.number(text)

    def _hole(self, plane: list[str]) -> Words:
        """Draw the words of a hole, at times a row of them."""
        chosen = [axis for axis in plane if self.chance(60)] or [self.one(plane)]
        before = dict(self.position)
        words: Words = [(axis, self._place(axis)) for axis in chosen]
        if self.chance(15):
            count = self.pick(2, 4)
            words.append(("L", str(count)))
            for axis in chosen if self.incremental else ():
                self.position[axis] += (count - 1) * (self.position[axis] - before[axis])
        return words

    # --- contours

    def _contour(self) -> None:
        """Write a rectangle under cutter compensation, with a way in and a way out."""
        if self.pending or self.diameter or self.plane != "G17" or self.feed_mode != "G94":
            self._line()
            return
        left = self.chance(50)
        radius = self.pick(2, 30) / 10
        width, height = self.pick(150, 600) / 10, self.pick(150, 600) / 10
        x, y = self.position["X"], self.position["Y"]
        corners = [(x + width, y), (x + width, y + height), (x, y + height), (x, y)]
        if self.chance(50):
            corners = [(x, y + height), (x + width, y + height), (x + width, y), (x, y)]
        first = (x + 2 * (x - corners[0][0]) / 3, y + 2 * (y - corners[0][1]) / 3)
        self._emit([*self._head("G0"), *self._point(first)])
        diameter = number(2 * radius / self._unit("Y"), self._decimals("Y"))
        on: Words = [("G", "41.1" if left else "42.1"), ("D", diameter)]
        self._emit([*self._head("G1"), *on, *self._point((x, y)), *self._feed()])
        for corner in corners[: self.pick(1, 4)]:
            self._emit([*self._head("G1"), *self._point(corner)])
        self._emit([("G", "40")])
        away = (self.position["X"] + 40.0, self.position["Y"] + 35.0)
        self._emit([*self._head("G1"), *self._point(away)])
        self.unsettled = False

    def _point(self, point: tuple[float, float]) -> Words:
        return [(axis, self._towards(axis, place)) for axis, place in zip("XY", point, strict=True)]
