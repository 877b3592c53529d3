"""What hangs on the direction of the element before it: RND and CHF at a corner, CT.

A corner is rounded before anything is offset: the element before it is cut back, and the one behind
it begins where the rounding ends. So a line is looked at with the two that follow it. Incremental
words count from the corner, which is the place that was programmed.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from math import acos, hypot, tan

import gcxform as gx
from gcxform_plugins.dialects.heidenhain.polar import Polar
from gcxform_plugins.dialects.heidenhain.positioning import Said
from gcxform_plugins.dialects.heidenhain.words import Point, written

CORNER = re.compile(r"[\s\d]*(?:RND|CHF)(?![A-Z])", re.IGNORECASE)
BARE = re.compile(r"[\s\d]*(?:;.*)?")
LAST_M = 30  # M functions above may change what words mean
STRAIGHT = 1e-6  # rad: an angle between elements below it is none


@dataclass(frozen=True, slots=True)
class Corner:
    """A corner between two lines: where the first ends, the second begins, the centre between.

    `code` is that of the move between them; a chamfer has no centre.
    """

    first: Point
    second: Point
    centre: Point | None
    code: str


class Contours(Polar):
    """Rounds corners, and finds the arcs that go on where an element ends."""

    corner: Corner | None = None
    begins: Point | None = None
    """Where the axes stand behind a rounding; `place` is the corner that was programmed."""

    def straight(self, items: Sequence[gx.Item]) -> list[str]:
        """L: a line; up to the rounding where a corner follows."""
        if self.begins is None and not self._turns():
            return super().straight(items)
        said = self.said(items[1:])
        start, ends = self.begins or self._stands(items[0]), self._plane(said, items[0])
        self._check_feed()
        if said.side is not None:
            self.keep_side(said)
        self.last = "G1", start, None
        self.place.update(ends)
        self.moved.update("XY")
        self.polar, self.begins = None, None
        x, y = self.place["X"], self.place["Y"]
        if self._turns():
            if said.after or said.calls or said.end:
                self.refuse("an M function at the end of a line that a corner cuts", items[0])
            self.corner = self._corner(start, items[0])
            x, y = map(written, self.corner.first)
        return self._all(said, f"{self.moving('G1')} X{x} Y{y}{said.feed}".lstrip())

    def rounded(self, items: Sequence[gx.Item]) -> list[str]:
        """RND and CHF: the way around the corner that was seen before; F is for this block only."""
        corner, self.corner = self.corner, None
        if corner is None or self.reading.stays:
            self.refuse(f"{items[0].name} behind anything but a line in X and Y", items[0])
        sizes = [item for item in items[1:] if item.kind in ("radius", "number")]
        others = [item for item in items[1:] if item.kind not in ("feed", "m")]
        if len(sizes) > 1 or others != sizes:
            self.refuse(f"{items[0].name} takes its size, and F", items[0])
        old, lost = self.feed, self.feed_lost
        said = self.said([item for item in items[1:] if item.kind in ("feed", "m")])
        if said.feed and (not old or lost):
            self.refuse("F for a corner where the feed behind it is not known", items[0])
        if said.before or said.after or said.calls or said.end or said.machine:
            self.refuse("an M function at a corner", items[0])
        words = f" X{written(corner.second[0])} Y{written(corner.second[1])}"
        if corner.centre is not None:
            by = (c - f for c, f in zip(corner.centre, corner.first, strict=True))
            words += "".join(f" {a}{written(d)}" for a, d in zip("IJ", by, strict=True))
        self.begins, self.pole = corner.second, {}
        if corner.centre is not None:
            words = f"{self.in_plane('G17')}{self.moving(corner.code)}{words}"
        else:
            words = f"{self.moving(corner.code)}{words}"
        block = f"{words}{said.feed}".lstrip()
        if not said.feed:
            return [block]
        self.feed = old
        return [block, f"F{old}"]

    def tangential(self, items: Sequence[gx.Item]) -> list[str]:
        """CT: the arc to a place that begins where the element before it points to."""
        path = items[0]
        if self.reading.stays or self._turns() or self.last is None:
            self.refuse("CT beside what has no direction in X and Y", path)
        said = self.said(items[1:])
        ends, start, along = self._ends(said, "XY"), self._stands(path), self._along(path)
        if said.sense:
            raise self.refusal("GX213", "CT with DR", path)
        end = (float(ends.get("X", self.place["X"])), float(ends.get("Y", self.place["Y"])))
        by = end[0] - start[0], end[1] - start[1]
        side = by[1] * along[0] - by[0] * along[1]
        if abs(side) <= STRAIGHT * hypot(*by):
            self.refuse("CT to a place straight on", path)
        radius = (by[0] ** 2 + by[1] ** 2) / (2 * side)
        said.sense = "G3" if radius > 0 else "G2"
        words = f" I{written(-radius * along[1])} J{written(radius * along[0])}"
        block = self._arc(said, path, ends, words)
        self.last = said.sense, start, (start[0] - radius * along[1], start[1] + radius * along[0])
        self.pole = {}
        return self._all(said, block)

    # --- geometry ---

    def _turns(self) -> bool:
        """Whether the next line of the program is a corner."""
        at = self.at
        while at < len(self.lines) and BARE.fullmatch(self.lines[at]):
            at += 1
        return at < len(self.lines) and CORNER.match(self.lines[at]) is not None

    def _stands(self, item: gx.Item) -> Point:
        x, y = (float(self.stands_at(axis, item)) for axis in "XY")
        return x, y

    def _plane(self, said: Said, item: gx.Item) -> dict[str, str]:
        """Return the end of a line beside a corner. Raises InputError for other lines."""
        if said.machine or said.rapid or said.radius or said.sense or self.shortest:
            self.refuse("a corner beside other than a line at the feed", item)
        return self._ends(said, "XY")

    def _corner(self, start: Point, item: gx.Item) -> Corner:
        """Return the corner behind a line that has been taken, from what the next two lines say."""
        corner, line = self._ahead(item)
        ends = self._plane(self._peeked(line), item)
        at = self._stands(item)
        end = (float(ends.get("X", at[0])), float(ends.get("Y", at[1])))
        sizes = [hypot(p[0] - at[0], p[1] - at[1]) for p in (start, end)]
        if not all(sizes):
            self.refuse("a corner at a line of no length", item)
        u, v = (
            ((p[0] - at[0]) / size, (p[1] - at[1]) / size)
            for p, size in zip((start, end), sizes, strict=True)
        )
        angle = acos(max(-1.0, min(1.0, u[0] * v[0] + u[1] * v[1])))
        if not STRAIGHT < angle < acos(-1.0) - STRAIGHT:
            self.refuse("a corner between lines that do not turn, or turn back", item)
        said = next((i for i in corner if i.kind in ("radius", "number")), None)
        name, size = corner[0].name, 0.0 if said is None else float(self.number_of(said))
        back = size if name == "CHF" else size / tan(angle / 2)
        if size <= 0 or back > min(sizes) + 1e-9:
            self.refuse(f"{name} longer than a line beside it", item)
        first, second = ((at[0] + back * w[0], at[1] + back * w[1]) for w in (u, v))
        if name == "CHF":
            return Corner(first, second, None, "G1")
        turn = v[0] * u[1] - v[1] * u[0]
        left = 1.0 if turn > 0 else -1.0
        centre = first[0] + left * size * u[1], first[1] - left * size * u[0]
        return Corner(first, second, centre, "G3" if left > 0 else "G2")

    def _ahead(self, item: gx.Item) -> tuple[tuple[gx.Item, ...], tuple[gx.Item, ...]]:
        """Return the items of the corner ahead, and of the line behind it."""
        found: list[tuple[gx.Item, ...]] = []
        at = self.at
        while at < len(self.lines) and len(found) < 2:
            if not BARE.fullmatch(self.lines[at]):
                found.append(tuple(i for i in self.items(at) if i.kind not in ("seq", "comment")))
            at += 1
        if len(found) < 2 or not found[1] or (found[1][0].kind, found[1][0].name) != ("path", "L"):
            self.refuse("a corner before anything but a line", item)
        return found[0], found[1]

    def _peeked(self, items: Sequence[gx.Item]) -> Said:
        """Return what a line ahead says, and take nothing from it."""
        before = self.feed, self.feed_lost
        wrong = next((i for i in items if i.kind == "m" and float(i.numbers[0]) > LAST_M), None)
        if wrong is not None:
            self.refuse(f"M{wrong.numbers[0]} behind a corner", items[0])
        said = self.said(items[1:])
        self.feed, self.feed_lost = before
        self.keep_side(said)
        return said

    def _along(self, item: gx.Item) -> Point:
        """Return the direction in which the last element ends."""
        assert self.last is not None
        code, start, centre = self.last
        end = self._stands(item)
        if centre is None:
            by = end[0] - start[0], end[1] - start[1]
        else:
            left = 1.0 if code == "G3" else -1.0
            by = -left * (end[1] - centre[1]), left * (end[0] - centre[0])
        size = hypot(*by)
        if not size:
            self.refuse("CT behind a move that does not leave its place", item)
        return by[0] / size, by[1] / size
