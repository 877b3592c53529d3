"""What hangs on the direction of another element: RND, RNDM, CHR and CHF at a corner, and CT.

A corner is cut where the line that leads to it says so, in the plane: the line ends before the
corner, the next one begins behind it, and a chamfer or an arc leads from one to the other
(Fundamentals 11/2006 p. 194). So a line is looked at with the next that moves. Steps count from the
corner, which is the place that was programmed. CT is the arc that begins in the direction in which
the element before it ends (NC programming 12/2019 p. 201).
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from decimal import Decimal
from typing import Any

import gcxform as gx
from gcxform_plugins.dialects.siemens.angles import Angles
from gcxform_plugins.dialects.siemens.arcs import CENTRES, START, decimals
from gcxform_plugins.dialects.siemens.framing import rounded
from gcxform_plugins.dialects.siemens.line import ABSOLUTE, CORNERS, STEP, Line
from gcxform_plugins.dialects.siemens.place import PlaceError, text_of

TANGENT = re.compile(r"(?<![A-Z0-9_])CT(?![A-Z0-9_])", re.IGNORECASE)
STRAIGHT = 1e-6  # rad: an angle between elements below it is none
NONE = 1e-9  # mm
ASIDE = ("comment", "label", "main_number")
PLAINLY = "write the chamfer or the rounding as a block of its own"
Point = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Corner:
    """A corner between two lines: where the first ends, the second begins, the centre between.

    `code` is that of the move between them; a chamfer has no centre.
    """

    first: Point
    second: Point
    centre: Point | None
    code: str


class Contours(Angles):
    """Cuts corners, and finds the arcs that go on where an element ends.

    has_tangents  CT stands in lines that may be executed
    rounding  RNDM, the radius at every corner
    begins    where the axes stand behind a corner, and the line that goes on from it; `place` is
              the corner that was programmed
    along     the direction in which the last element ends, where that is known
    arc       the code and the words of the last arc, as they are inside of the frame
    """

    feed_mode = "94"
    has_tangents = False
    rounding = ""
    begins: tuple[Point, int] | None = None
    along: Point | None = None
    arc: tuple[str, Sequence[str]] = "", ()

    def __init__(self, lines: list[str], file: str, dialect: Any, reading: Any) -> None:
        super().__init__(lines, file, dialect, reading)
        self.look_for_tangents(lines)

    def lose_pole(self) -> None:
        """Forget the pole and the direction: the plane, the unit or the zero may be another."""
        super().lose_pole()
        self.along = None

    def look_for_tangents(self, lines: Iterable[str]) -> None:
        """Note whether lines have CT, which hangs on the line before it."""
        text = "\n".join(lines)
        self.has_tangents |= "CT" in text.upper() and TANGENT.search(text) is not None

    def take_corner(self, line: Line) -> None:
        """Take what a line says of corners. Raises InputError where it leads to none."""
        item = next((item for _, item in line.corner.values()), None)
        if "RNDM" in line.corner:
            number = line.corner["RNDM"][0]
            self.rounding = number if Decimal(number) else ""
        other = (line.alone, line.pole, line.dwell, line.act, line.cycle, line.machine)
        if any(what is not None for what in other) or not (line.axes or {*line.corner} <= {"RNDM"}):
            self.refuse("a corner at a line that leads to none", item, PLAINLY)

    def _moving(self, line: Line) -> str:
        if "ANG" in line.named:
            self.by_angle(line)
        corner = self._corner(line) if self._cuts(line) else None
        start = self._seen() if self.has_tangents else None
        if corner is None:
            block = self._going_on(line)
            self.along = self._direction(line, start) if self.has_tangents else None
            return block
        item = self.any_of(line)
        self.begins = None
        at = self._programmed(line)
        block = super()._moving(_to(line, self.plane, corner.first, item))
        line.behind = [*self._cut(line, corner)]
        for axis, value in zip(self.plane, at, strict=True):
            self.place.absolute(axis, _text(value))
        self.begins, self.along = (corner.second, self._following_line(item)[0]), None
        return block

    def _going_on(self, line: Line) -> str:
        """Return the block of a line that is cut at its start, or nowhere."""
        if self.begins is None:
            return super()._moving(line)
        if self.line != self.begins[1]:
            self.refuse("a corner that is not followed by the line behind it", self.any_of(line))
        self.begins = None
        ends = {axis: line.axes[axis] for axis in line.axes}
        for axis, (way, number, item) in ends.items():
            if self._steps(way):
                line.axes[axis] = ABSOLUTE, self.place.stepped(axis, number), item
        return super()._moving(line)

    # --- corners ---

    def _cuts(self, line: Line) -> bool:
        """Whether a line leads to a corner that is cut. Raises InputError."""
        said = [name for name in line.corner if name in ("RND", "CHR", "CHF")]
        if not line.axes or (not said and not self.rounding):
            return False
        if len(said) > 1 or (said and self.rounding):
            self.refuse("two words for one corner", line.corner[said[0]][1], PLAINLY)
        return True

    def _corner(self, line: Line) -> Corner:
        """Return the corner to which a line leads. Raises InputError and PlaceError."""
        item = self.any_of(line)
        others = line.centres or line.named or line.middles or line.others
        if self.motion != "1" or others or line.axes.keys() - {*self.plane}:
            self.refuse("a corner behind anything but a line in the plane", item, PLAINLY)
        if self.drilling is not None or self.following or self.feed_mode == "93":
            self.refuse("a corner under MCALL, TRAORI or G93", item, PLAINLY)
        number, end = self._following_line(item)
        start = self.begins[0] if self.begins is not None else self._stands()
        at = self._programmed(line)
        if self._speeds(number) and "FRC" not in line.corner:
            message = "which feed a corner has, that before it or that behind, is a setting"
            self.refuse(message, item, "write FRC= for the corner")
        name = next((n for n in line.corner if n in ("RND", "CHR", "CHF")), "RND")
        size = float(line.corner[name][0] if name in line.corner else self.rounding)
        found = cut(start, at, self._ends_of(end, at), name, size)
        if isinstance(found, str):
            self.refuse(found, item, PLAINLY)
        return found

    def _programmed(self, line: Line) -> Point:
        """Return where a line leads to in the plane. Raises PlaceError."""
        ends, stands = self._ends(line), self._stands()
        a, b = (ends.get(axis, at) for axis, at in zip(self.plane, stands, strict=True))
        return a, b

    def _following_line(self, item: gx.Item | None) -> tuple[int, list[gx.Item]]:
        """Return the line behind a corner, and its items. Raises InputError if it is none."""
        file = self.place_of(self.line)[0]
        for at in range(self.line + 1, len(self.lines)):
            if self.place_of(at)[0] != file:
                break
            items = [i for i in self.items(at) if i.kind not in ASIDE and i.name != "N"]
            if not items:
                continue
            if all(map(self._is_plain, items)) and any(i.names[0] in self.plane for i in items):
                return at, items
            break
        self.refuse(
            "a corner before anything but a line of plain words in the plane", item, PLAINLY
        )

    def _is_plain(self, item: gx.Item) -> bool:
        """Whether a word of the line behind a corner says no more than where it goes."""
        name = item.names[0] if item.names else ""
        if item.kind == "function":
            return name in self.plane and item.names[1] in (ABSOLUTE, STEP)
        if item.kind == "named":
            return name in CORNERS
        if item.kind not in ("word", "value"):
            return False
        return name in self.plane or name == "F" or (name == "G" and item.numbers[0] in ("1", "01"))

    def _speeds(self, line: int) -> bool:
        return any(i.kind in ("word", "value") and i.name == "F" for i in self.items(line))

    def _ends_of(self, items: Sequence[gx.Item], at: Point) -> Point:
        """Return where the line behind a corner leads to."""
        ends = [*at]
        for item in (i for i in items if i.kind != "named" and i.names[0] in self.plane):
            k = self.plane.index(item.names[0])
            steps = self._steps(item.names[1] if item.kind == "function" else "")
            ends[k] = float(item.numbers[0]) + (at[k] if steps else 0.0)
        return ends[0], ends[1]

    def _cut(self, line: Line, corner: Corner) -> Iterator[str]:
        """Yield the block of the move about a corner, and the feed that is in force behind it."""
        for axis, value in zip(self.plane, corner.second, strict=True):
            self.place.absolute(axis, _text(value))
        words = [a + _text(v) for a, v in zip(self.plane, corner.second, strict=True)]
        words, motion, arc = self.outside(False, words), corner.code, list[str]()
        if corner.centre is not None:
            by = (c - f for c, f in zip(corner.centre, corner.first, strict=True))
            centre = dict(zip((CENTRES[a] for a in self.plane), by, strict=True))
            motion, arc = self.arc_outside(motion, [*self._centred(False), *decimals(centre)])
        feed = line.corner["FRC"][0] if "FRC" in line.corner else ""
        if feed and not line.feed:
            message = "FRC=, and which feed is in force behind it is not said in this line"
            self.refuse(message, line.corner["FRC"][1], "write F beside FRC=")
        own = [f"F{feed}"] if feed else []
        yield " ".join([*self.motion_code(Line(), motion), *words, *arc, *own])
        if feed:
            yield f"F{line.feed}"

    # --- tangents ---

    def _seen(self) -> Point | None:
        a, b = (self.place.known(axis) for axis in self.plane)
        return None if a is None or b is None else (float(a), float(b))

    def _direction(self, line: Line, start: Point | None) -> Point | None:
        """Return the direction in which a line ends; None where that is not known."""
        end, motion = self._seen(), self.motion
        if start is None or end is None or motion == "0" or line.axes.keys() - {*self.plane}:
            return None
        if motion == "1" or self.arc[0] == "1":
            by = end[0] - start[0], end[1] - start[1]
        else:
            centre = _centre(start, end, self.plane, *self.arc)
            if centre is None:
                return None
            left = 1.0 if self.arc[0] == "3" else -1.0
            by = -left * (end[1] - centre[1]), left * (end[0] - centre[0])
        size = math.hypot(*by)
        return (by[0] / size, by[1] / size) if size > NONE else None

    def _arc(self, line: Line) -> tuple[str, dict[str, float], list[str]]:
        made = self._tangential(line) if self.motion == "CT" else super()._arc(line)
        if self.has_tangents:
            self.arc = made[0], made[2]
        return made

    def _tangential(self, line: Line) -> tuple[str, dict[str, float], list[str]]:
        """Return the arc that goes on where the element before it ends. Raises PlaceError.

        Its centre is on the normal there, as far from its start as from its end.
        """
        item = self.any_of(line)
        if line.centres or line.named or line.middles or line.axes.keys() - {*self.plane}:
            self.refuse("CT takes its end in the plane, and no other words", item)
        if self.along is None:
            message = "CT, and in which direction the element before it ends is not known"
            raise PlaceError("GX210", message, f"write the element before it; {START}")
        start, end = self._stands(), self._programmed(line)
        by = end[0] - start[0], end[1] - start[1]
        side = by[1] * self.along[0] - by[0] * self.along[1]
        if abs(side) <= STRAIGHT * math.hypot(*by):
            if by[0] * self.along[0] + by[1] * self.along[1] <= NONE:
                self.refuse("CT to where it comes from, or to where it stands", item)
            return "1", {}, []
        radius = (by[0] ** 2 + by[1] ** 2) / (2 * side)
        words = {CENTRES[self.plane[0]]: -radius * self.along[1]}
        words[CENTRES[self.plane[1]]] = radius * self.along[0]
        return ("3" if radius > 0 else "2"), {}, [*self._centred(False), *decimals(words)]


def cut(start: Point, at: Point, end: Point, name: str, size: float) -> Corner | str:
    """Return how a corner between two lines is cut; or why it is not.

    CHR is along both lines, CHF the length of the chamfer: it cuts CHF / (2 sin(angle / 2)) from
    each; the arc of RND touches both, RND / tan(angle / 2) from the corner (Fundamentals p. 194).
    """
    sizes = math.dist(start, at), math.dist(end, at)
    if min(sizes) <= NONE:
        return "a corner at a line of no length"
    u, v = (
        ((p[0] - at[0]) / length, (p[1] - at[1]) / length)
        for p, length in zip((start, end), sizes, strict=True)
    )
    turn = v[0] * u[1] - v[1] * u[0]
    angle = math.atan2(abs(turn), u[0] * v[0] + u[1] * v[1])
    if not STRAIGHT < angle < math.pi - STRAIGHT:
        return "a corner between lines that do not turn, or turn back"
    shares = {"CHR": 1.0, "CHF": 0.5 / math.sin(angle / 2), "RND": 1 / math.tan(angle / 2)}
    back = size * shares[name]
    if size <= 0 or back > min(sizes) + NONE:
        return f"{name} of 0, or longer than a line beside it"
    first, second = ((at[0] + back * w[0], at[1] + back * w[1]) for w in (u, v))
    if name != "RND":
        return Corner(first, second, None, "1")
    left = 1.0 if turn > 0 else -1.0
    centre = first[0] + left * size * u[1], first[1] - left * size * u[0]
    return Corner(first, second, centre, "3" if left > 0 else "2")


def _centre(start: Point, end: Point, plane: str, code: str, words: Sequence[str]) -> Point | None:
    """Return the centre of an arc in the plane, by its words; None where they do not say it."""
    values = {word[0]: float(word[1:]) for word in words if word[0] in "IJKR"}
    if "G90.1" in words or code not in ("2", "3"):
        return None
    if "R" not in values:
        i, j = (values.get(CENTRES[axis], 0.0) for axis in plane)
        return start[0] + i, start[1] + j
    radius, chord = values["R"], math.dist(start, end)
    if chord <= NONE:
        return None
    high = math.sqrt(max(0.0, radius * radius - chord * chord / 4))
    left = 1.0 if (radius > 0) == (code == "3") else -1.0
    x, y = end[0] - start[0], end[1] - start[1]
    return start[0] + x / 2 - left * high * y / chord, start[1] + y / 2 + left * high * x / chord


def _text(value: float) -> str:
    return text_of(rounded(Decimal(repr(value))))


def _to(line: Line, plane: str, at: Point, item: gx.Item | None) -> Line:
    """Return a line that leads to a point of the plane."""
    assert item is not None
    line.axes = {
        axis: (ABSOLUTE, _text(value), item) for axis, value in zip(plane, at, strict=True)
    }
    return line
