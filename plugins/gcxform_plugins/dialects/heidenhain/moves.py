"""Path functions of a TNC: lines, circles and polar coordinates as G0 to G3."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from decimal import ROUND_FLOOR, Decimal
from math import nan

import gcxform as gx
from gcxform_plugins.dialects.heidenhain.positioning import Said, Saying
from gcxform_plugins.dialects.heidenhain.words import MM, ROTARY, Element, exact, written

PLANES = {"XY": "G17", "ZX": "G18", "YZ": "G19"}
CENTRES = dict(zip("XYZ", "IJK", strict=True))
ABOUT_POLE = ("C", "CP")
SIDES = {"RL": "G41", "RR": "G42"}


END_OF_TRAVEL = "Z = ... in [home.M140] of the machine file says where, in its coordinates"


def retracts(items: Sequence[gx.Item]) -> bool:
    """Whether a block is M140 MB MAX and nothing else."""
    said = [item.name.split() for item in items]
    return said == [["M"], ["MB", "MAX"]] and items[0].numbers == ("140",)


class Moves(Saying):
    """Turns positioning blocks into moves."""

    def straight(self, items: Sequence[gx.Item]) -> list[str]:
        """L: a line to coordinates, or to a place of the machine."""
        if retracts(items[1:]):
            return self.retracted(items[1])
        said = self.said(items[1:])
        if said.machine:
            return self._all(said, self._in_machine(said, said.machine))
        words, ends = "", {}
        for item in said.axes:
            axis, number = self.reached(item)
            if axis in ends or axis[0] == "P":
                raise self.refusal("GX203", f"{item.name} does not fit into an L block", item)
            ends[axis] = number
            words += f" {axis}{number}"
        return self._all(said, self._straight(said, ends, words))

    def _straight(self, said: Said, ends: dict[str, str], words: str) -> str:
        """Return the block of a line to the ends of axes."""
        if not ends:
            self.keep_side(said)
            return said.feed.strip()
        if not ends.keys().isdisjoint(ROTARY):
            self._check_turning(said, ends)
        if said.radius or said.sense:
            raise self.refusal("GX203", "R and DR belong to circles")
        self.check_one_axis([*ends])
        if (turning := self.turned_in_tilt(said, ends)) is not None:
            return turning
        code = "G0" if said.rapid else "G1"
        if code == "G1":
            self._check_feed()
        beside = self._beside(said, ends)
        block = f"{self.moving(code)}{words}{said.feed}".lstrip()
        self.last = self._element(code, ends) if code == "G1" else None
        self.place.update(ends)
        self.moved.update(ends)
        if not {"X", "Y"}.isdisjoint(ends):
            self.polar = None
        return f"{beside} {block}" if beside else block

    def turned_in_tilt(self, said: Said, ends: dict[str, str]) -> str | None:
        """Return the block of a line that turns axes onto a plane; None without one that waits."""
        raise NotImplementedError

    def check_one_axis(self, ends: Sequence[str]) -> None:
        """Let go of axes that hang on others which a line does not name."""
        raise NotImplementedError

    def _element(
        self, code: str, ends: Iterable[str], pole: dict[str, str] | None = None
    ) -> Element | None:
        """Return what begins where the axes stand, if it goes along in X and Y alone."""
        if not ({"X", "Y"} >= {*ends} and {"X", "Y"} <= self.place.keys()):
            return None
        start = float(self.place["X"]), float(self.place["Y"])
        return code, start, None if pole is None else (float(pole["X"]), float(pole["Y"]))

    def _beside(self, said: Said, ends: dict[str, str]) -> str:
        """Return the code with which radius compensation begins or ends in a line."""
        if said.side is None:
            return ""
        side = SIDES.get(said.side.name, "")
        if side == self.side:
            return ""
        if {"X", "Y"}.isdisjoint(ends) or said.machine or (side and self.side):
            name = said.side.name
            self.refuse(f"{name} here: the side changes in lines in X and Y, by R0", said.side)
        if self.following or self.in_spindle in ("", "0"):
            self.refuse("radius compensation without a tool, or under M128", said.side)
        if side and self.mirrored:
            self.refuse("radius compensation in mirrored coordinates", said.side)
        self.side = side
        return f"{self.in_plane('G17')}{self.beside(side, said.side)}" if side else "G40"

    def beside(self, side: str, item: gx.Item) -> str:
        """Return the code of a side with the tool, or with its diameter where DR changes it."""
        if not self.deltas.get("DR"):
            return f"{side} D{self.in_spindle}"
        return f"{side}.1 D{written(2 * self.tool_radius(item))}"

    def tool_radius(self, item: gx.Item) -> float:
        """Return the radius of the tool with its DR. Raises InputError where it is not known."""
        known = self.reading.tools.get(int(self.in_spindle or 0))
        radius = nan if known is None else known.radius / (MM if self.inch else 1.0)
        radius += float(self.deltas.get("DR", 0))
        if not radius >= 0:
            number = self.in_spindle or "*"
            hint = f"give a machine file with the tool: radius = ... in [tool.{number}]"
            self.refuse(f"{item.name} with a tool whose radius is not known", item, hint)
        return radius

    def keep_side(self, said: Said) -> None:
        """Refuse a change of sides in a block that is no line in X and Y. Raises InputError."""
        if said.side is not None and SIDES.get(said.side.name, "") != self.side:
            name = said.side.name
            self.refuse(f"{name} here: the side changes in lines in X and Y, by R0", said.side)

    def check_spindle(self) -> None:
        """Refuse to cut behind a tap before it is said that the spindle turns, or stands."""
        if self.untold:
            message = "behind a tap it is not certain whether the spindle turns"
            raise self.refusal("GX215", message, None, "write M3, M4 or M5 before")

    def _check_feed(self) -> None:
        self.check_spindle()
        if self.feed_lost:
            message = "behind a cycle it is not certain which feed is in force"
            raise self.refusal("GX204", message, None, "give F in this block")

    def _check_turning(self, said: Said, ends: dict[str, str]) -> None:
        """Refuse turns of which it is not certain how far they go, or how fast."""
        if any(Decimal(ends[axis]) for axis in ROTARY if axis in ends):
            self._check_untilted()
        if self.shortest:
            for axis in ROTARY:
                before, after = self.place.get(axis), ends.get(axis)
                if after and before is None and not said.rapid:
                    message = f"M126: the shorter way of {axis} from where it is not known to stand"
                    self.refuse(
                        message, None, f"turn {axis} in a rapid before, with the tool clear"
                    )
                if after and before and abs(Decimal(after) - Decimal(before)) >= 180:
                    message = f"M126: {axis} goes the shorter way where it shows less than 360"
                    self.refuse(message, None, "let the CAM write turns below 180 degrees")
        alone = all(axis in ROTARY for axis in ends)
        if self.inch and alone and not said.rapid:
            self.refuse("a feed in degrees in a program in inches", None)

    def _check_untilted(self) -> None:
        """Refuse to turn an axis out of 0 in a plane, which words behind it would be led into."""
        if self.untilted and not (self.following or self.reading.stays):
            message = "a rotary axis turns under PLANE SPATIAL, which words then allow for"
            self.refuse(message, None, "write PLANE RESET STAY before, if they are not to")

    def _in_machine(self, said: Said, code: gx.Item) -> str:
        """M91: the coordinates of the machine, which leave the tool out."""
        if self.following:
            self.refuse("M91 while the control follows the tip", code, "write M129 before")
        self.keep_side(said)
        if said.radius or said.sense:
            raise self.refusal("GX203", "R and DR belong to circles")
        words = ""
        for item in said.axes:
            if item.name[0] in "IP":
                self.refuse(f"{item.name} counts from the last block with M91", item)
            words += f" {item.name}{self._from_point(said, item)}"
            self.lose(item.name)
            if item.name in ROTARY:
                self._check_untilted()
            self.moved |= {item.name} & set(ROTARY)
        if self.turn != 0 or self.mirrored is None:
            self.lose("XYZ")  # an axis of the machine is none of theirs
        if not said.rapid:
            self._check_feed()
        if not words:
            return said.feed.strip()
        self.motion = "G0" if said.rapid else "G1"
        return f"G53 {self.motion}{words}{said.feed}"

    def _from_point(self, said: Said, item: gx.Item) -> str:
        """Return where in the machine a coordinate is, that may count from the point of M92."""
        number = self.number_of(item)
        if said.counts_from is None:
            return number
        point = said.counts_from.get(item.name)
        if point is None:
            hint = f"{item.name} = ... in [home.M92] of the machine file says it"
            self.refuse(f"M92: from where {item.name} counts is not known", item, hint)
        if self.inch and item.name not in ROTARY:
            point /= MM
        return written(Decimal(number) + Decimal(repr(point)))

    def retracted(self, item: gx.Item) -> list[str]:
        """M140 MB MAX: to the end of travel along the tool axis, where the machine file says it."""
        place = self.reading.homes.get("M140", {}).get("Z")
        if place is None or self.reading.stays:
            self.refuse("M140 leads to where only the machine knows", item, END_OF_TRAVEL)
        self.refuse_beside("M140", item)
        if self.following:
            self.refuse("M140 while the control follows the tip", item, "write M129 before")
        self.lose("XYZ" if self.turn != 0 or self.mirrored != "" else "Z")
        self.motion = "G0"
        return [f"G53 G0 Z{self._within(Decimal(repr(place)))}"]

    def _within(self, place: Decimal) -> str:
        """Return an upper end of travel (mm) in the unit of the program, and not beyond it."""
        numbers = self.dialect.numbers
        decimals, unit = (numbers.inch, MM) if self.inch else (numbers.mm, 1.0)
        end = place / Decimal(str(unit))
        return exact(end.quantize(Decimal(1).scaleb(-decimals), ROUND_FLOOR))

    def _all(self, said: Said, block: str) -> list[str]:
        """Return a block with those of M functions before and behind it."""
        if said.leaves:
            self.switch(False)
        blocks = [*said.before, *([block] if block else ()), *said.after]
        if said.changes:
            self.lose()
        if said.calls:
            blocks += self.called(said.calls)
        if said.end:
            self.over = True
            blocks.append(said.end)
        return blocks

    def called(self, item: gx.Item) -> list[str]:
        """Return the blocks of the cycle that is called."""
        raise NotImplementedError

    # --- circles ---

    def centre(self, items: Sequence[gx.Item]) -> list[str]:
        """CC: the centre of circles, and the pole of polar coordinates."""
        pole: dict[str, str] = {}
        for item in items[1:]:
            axis, number = self.reached(item)
            if axis not in "XYZ" or axis in pole or len(pole) == 2:
                self.refuse(f"CC with {item.name}: it takes two of X, Y and Z", item)
            pole[axis] = number
        if not pole:
            pole = {axis: exact(self.stands_at(axis, items[0])) for axis in "XY"}
        if len(pole) < 2:
            self.refuse("CC with one coordinate", items[0], "write both")
        self.pole, self.polar = pole, None
        return []

    def circle(self, items: Sequence[gx.Item]) -> list[str]:
        """C: a circle about CC; it ends where it starts if no end is given."""
        said = self.said(items[1:])
        axes = self._plane_of(items[0])
        ends = self._ends(said, axes)
        if axes != "XY" and len(ends) < 2:
            self.refuse("a circle out of XY with one coordinate", items[0])
        self._check_plane(axes, items[0])
        return self._all(said, self._arc(said, items[0], ends))

    def _check_plane(self, axes: str, path: gx.Item) -> None:
        """Refuse a circle out of XY where more hangs on it. Raises InputError."""
        if axes != "XY" and (self.side or self.following):
            self.refuse("a circle out of XY beside a contour, or under M128", path)

    def _plane_of(self, path: gx.Item) -> str:
        """Return the axes of the plane in which CC and the circle about it are."""
        named = self._pole(path).keys()
        return next(axes for axes in PLANES if named == {*axes})

    def by_radius(self, items: Sequence[gx.Item]) -> list[str]:
        """CR: a circle by its radius; below 0 it is the longer way."""
        said = self.said(items[1:])
        if not said.radius:
            raise self.refusal("GX303", "CR without a radius", items[0])
        ends = self._ends(said, "XY")
        if not ends:
            raise self.refusal("GX302", "CR cannot end where it starts", items[0])
        words = f" R{said.radius}"
        said.radius = ""
        block = self._arc(said, items[0], ends, words)
        self.pole = {}  # whether CR is a CC as well is not known
        return self._all(said, block)

    def _ends(self, said: Said, allowed: str) -> dict[str, str]:
        ends: dict[str, str] = {}
        for item in said.axes:
            axis, number = self.reached(item)
            if axis in ends or axis not in allowed:
                message = f"{item.name} in a circle in {' and '.join(allowed)}"
                self.refuse(message, item)
            ends[axis] = number
        return ends

    def _arc(self, said: Said, path: gx.Item, ends: dict[str, str], words: str = "") -> str:
        """Return the block of an arc; `words` say what it is like, or it is about the pole."""
        if not said.sense:
            raise self.refusal("GX213", f"{path.name} without DR+ or DR-", path)
        self.keep_side(said)
        if said.rapid or said.machine or said.radius:
            raise self.refusal("GX213", f"{path.name} with FMAX, M91 or R", path)
        self._check_feed()
        plane = self._plane_of(path) if path.name in ABOUT_POLE else "XY"
        start = {axis: self.stands_at(axis, path) for axis in plane}
        by_size = " R" in words or path.name == "CT"
        if not words:
            pole = self._pole(path)
            words = "".join(
                f" {CENTRES[axis]}{exact(Decimal(pole[axis]) - start[axis])}"
                for axis in sorted(plane)
            )
        self.last = self._element(said.sense, ends, None if by_size else self._pole(path))
        self.last = None if by_size else self.last
        self.place.update(ends)
        self.moved.update(plane, ends)
        self.polar = None
        axes = (*sorted(plane), *ends.keys() - {*plane})
        to = "".join(f" {axis}{self.place[axis]}" for axis in axes)
        code = f"{self.in_plane(PLANES[plane])}{self.moving(said.sense)}"
        return f"{code.rstrip()}{to}{words}{said.feed}".lstrip()

    def _pole(self, path: gx.Item) -> dict[str, str]:
        if not self.pole:
            raise self.refusal("GX213", f"{path.name} needs a CC before it", path)
        if path.name not in ABOUT_POLE and "Z" in self.pole:
            self.refuse(f"{path.name} about a CC out of XY", path)
        return self.pole
