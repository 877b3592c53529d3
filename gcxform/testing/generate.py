"""Programs that a control accepts, built block by block from a source of choices.

The source of choices is any function (low, high) -> integer, both included: hypothesis drives it
in `gcxform.testing.strategies`, `random.Random(seed).randint` gives many programs quickly.
The builder tracks what the control knows (position, units, plane, modes), so that every block it
writes is valid there. Lengths in `Builder.position` are in mm, rotary positions in degrees.
"""

import math
from collections.abc import Callable, Sequence
from typing import Final, TypeVar

from gcxform.testing.layout import Layout, Words, number, write
from gcxform.values import dataclass

Pick = Callable[[int, int], int]
T = TypeVar("T")
INCH: Final = 25.4
PLANES: Final = {"G17": ("XYZ", "IJK"), "G18": ("ZXY", "KIJ"), "G19": ("YZX", "JKI")}
CLOSENESS: Final = {"linuxcnc": 0.014, "grbl": 0.0025, "fanuc": 0.005, "haas": 0.005}
"""Within how much (mm) the radii of an arc agree."""
ROTARY: Final = "ABC"
POINTED: Final = ("fanuc", "haas")  # a number without a point is another number there


@dataclass(frozen=True)
class Options:
    """What may occur in a program."""

    dialect: str = "linuxcnc"
    arcs: bool = True
    incremental: bool = True
    inches: bool = True
    rotary: bool = True
    feed_modes: bool = True
    planes: bool = True
    splines: bool = False  # G5 and G5.1, which LinuxCNC has
    max_blocks: int = 30


def program(pick: Pick, options: Options) -> bytes:
    """Return a program of at most `max_blocks` blocks, its frame and comments not counted."""
    return Builder(pick, options).build()


class Builder:
    """One program in the making."""

    def __init__(self, pick: Pick, options: Options) -> None:
        self.pick = pick
        self.options = options
        self.dialect = options.dialect
        self.layout = Layout(pick, options.dialect)
        self.rotary = options.rotary and options.dialect != "grbl"
        self.axes = "XYZABC" if self.rotary else "XYZ"
        self.position = dict.fromkeys(self.axes, 0.0)
        self.inch = self.absolute_centre = self.incremental = False
        self.plane, self.feed_mode, self.motion = "G17", "G94", ""
        self.feed_known = False
        self.in_series = False  # the move before is a G5
        self.speed = 0
        self.pending: Words = []  # modes that go into the next motion block
        self.lines: list[str] = []

    # --- choices

    def chance(self, percent: int) -> bool:
        """Return True in about that many of a hundred cases; shrinks to False."""
        return self.pick(0, 99) >= 100 - percent

    def one(self, items: Sequence[T]) -> T:
        """Return one of the items; shrinks to the first."""
        return items[self.pick(0, len(items) - 1)]

    # --- the whole

    def build(self) -> bytes:
        """Draw the program."""
        self._open()
        for _ in range(self.pick(1, max(1, self.options.max_blocks - 3))):
            self._step()
        self._emit([("M", "2" if self.dialect == "linuxcnc" else "30")], plain=True)
        framed = self.dialect in POINTED or (self.dialect == "linuxcnc" and self.chance(10))
        lines = ["%", *self.lines, "%"] if framed else self.lines
        end = "\r\n" if self.chance(15) else "\n"
        return (end.join(lines) + end).encode("latin-1")

    def _open(self) -> str:
        """Write a first block with every mode and, absolutely, every axis; return the offset."""
        if self.dialect in POINTED:
            self.lines.append(f"O{self.pick(1, 9999):04d}")
        self.inch = self.options.inches and self.chance(25)
        modes = ["G20" if self.inch else "G21", "G90", "G94", "G17"]
        if self.dialect == "linuxcnc":
            modes.append("G91.1")
        if self.chance(30):
            modes += self.one((["G40"], ["G49"], ["G80"], [f"G{self.pick(54, 59)}"]))
        self._emit([(code[0], code[1:]) for code in modes], plain=True)
        self.motion = "G0"
        words: Words = [("G", "0")]
        for axis in self.axes:
            words.append((axis, self._place(axis)))
        self._emit(words)
        return modes[-1] if modes[-1][1] == "5" else "G54"

    def _step(self) -> None:
        """Write one block, sometimes a comment or an empty line before it."""
        if self.chance(8):
            self.lines.append(self.layout.remark())
        self.one(self._kinds())()

    def _kinds(self) -> list[Callable[[], None]]:
        """Return what a block may be, as often as it shall come."""
        kinds: list[Callable[[], None]] = [self._line, self._line, self._line, self._rapid]
        if self.options.arcs:
            kinds += [self._arc] * 4
        if self.options.splines and self.plane == "G17" and self.feed_mode != "G93":
            kinds += [self._spline] * 4
        return [*kinds, self._auxiliary, self._modes, self._modes]

    def _emit(self, words: Words, *, plain: bool = False) -> None:
        """Write a block."""
        self.lines.append(write(words, self.layout, plain=plain))

    def _emit_motion(self, words: Words) -> None:
        """Write a motion block, with the modes that wait for one."""
        self._emit(self.pending + words)
        self.pending = []

    # --- coordinates

    def _decimals(self, axis: str) -> int:
        return 4 if self.inch and axis not in ROTARY else 3

    def _unit(self, axis: str) -> float:
        return INCH if self.inch and axis not in ROTARY else 1.0

    def _value(self, axis: str, reach: float) -> float:
        """Return a number on the grid within +-reach (mm or degrees), in units of the program."""
        places = self.one((0, 1, self._decimals(axis)))
        scale = float(10**places)
        steps = int(reach / self._unit(axis) * scale)
        return (self.pick(0, 2 * steps) - steps) / scale

    def _place(self, axis: str) -> str:
        """Draw a new position of one axis; return its word and move there."""
        turning = axis in ROTARY
        if self.incremental:
            return self._move_to(axis, self._value(axis, 90 if turning else 30), add=True)
        return self._move_to(axis, self._value(axis, 400 if turning else 150))

    def _move_to(self, axis: str, value: float, *, add: bool = False) -> str:
        """Take over a programmed number; return it as text."""
        text = number(value, self._decimals(axis))
        programmed = float(text) * self._unit(axis)
        self.position[axis] = programmed + (self.position[axis] if add else 0.0)
        return self.layout.number(text)

    def _towards(self, axis: str, target: float) -> str:
        """Return the word that brings one axis as near to `target` (mm) as the grid allows."""
        value = target - (self.position[axis] if self.incremental else 0.0)
        return self._move_to(axis, value / self._unit(axis), add=self.incremental)

    # --- motion

    def _head(self, code: str) -> Words:
        """Return the motion word, which a modal control may do without."""
        self.in_series = False
        if self.motion == code and self.chance(50):
            return []
        self.motion = code
        return [("G", code[1:])]

    def _rapid(self) -> None:
        self._emit_motion(self._head("G0") + self._some_axes())

    def _line(self) -> None:
        words = self._head("G1")
        words += self._some_axes()
        self._emit_motion(words + self._feed() + self._extras())

    def _some_axes(self) -> Words:
        """Draw one to all linear axes, and rotary ones at times."""
        chosen = [axis for axis in "XYZ" if self.chance(55)]
        if self.rotary and self.chance(20):
            chosen += [axis for axis in ROTARY if self.chance(50)]
        chosen = chosen or [self.one(self.axes)]
        return [(axis, self._place(axis)) for axis in chosen]

    def _feed(self) -> Words:
        """Return an F word where one is needed, and at times where not."""
        if self.feed_mode == "G93":
            return [("F", self.layout.number(number(self.pick(1, 500) / 10, 1)))]
        if self.feed_known and not self.chance(10):
            return []
        self.feed_known = True
        tenths = self.pick(1, 40) if self.feed_mode == "G95" else self.pick(10, 20000)
        places = 2 if self.feed_mode == "G95" else 1
        return [("F", self.layout.number(number(tenths / 10**places, places)))]

    def _extras(self) -> Words:
        """Return words for the spindle or the coolant on a motion block."""
        if self.pending or not self.chance(5):
            return []
        words: Words = [("M", self.one(("3", "8")))]
        if words[0][1] == "3" and self.dialect not in POINTED:
            self.speed = self.pick(1, 24000)
            words.append(("S", str(self.speed)))
        return words

    # --- arcs

    def _arc(self) -> None:
        """Write an arc, or a line if the drawn one would not be accepted."""
        code = self.one(("G2", "G3"))
        draw = self.one((self._offset_arc, self._offset_arc, self._radius_arc, self._circle))
        before = dict(self.position)
        words = draw(code == "G2")
        if words is None:
            self.position = before
            self._line()
            return
        if self.rotary and self.chance(10):
            axis = self.one(ROTARY)
            words.append((axis, self._place(axis)))
        if self.dialect == "linuxcnc" and self.chance(15):
            words.append(("P", str(self.pick(1, 4))))
        self._emit_motion(self._head(code) + words + self._feed() + self._extras())

    def _draw_centre(self) -> tuple[tuple[float, float], Words]:
        """Draw a centre 0.5 mm or more away; return it (mm, in the plane) and its words."""
        axes, letters = PLANES[self.plane]
        radius, angle = self.pick(5, 800) / 10, math.radians(self.one(range(0, 360, 15)))
        offset = (radius * math.cos(angle), radius * math.sin(angle))
        centre, words = [], Words()
        for axis, letter, value in zip(axes[:2], letters[:2], offset, strict=True):
            base = self.position[axis] if self.absolute_centre else 0.0
            text = number((value + base) / self._unit(letter), self._decimals(axis))
            start = 0.0 if self.absolute_centre else self.position[axis]
            centre.append(start + float(text) * self._unit(letter))
            if self.absolute_centre or float(text) or self.chance(50):
                words.append((letter, self.layout.number(text)))
        return (centre[0], centre[1]), words

    def _offset_arc(self, clockwise: bool) -> Words | None:
        """Return words of an arc of 5 to 355 degrees with its centre."""
        first, second, normal = tuple(PLANES[self.plane][0])
        start = (self.position[first], self.position[second])
        centre, words = self._draw_centre()
        turn = math.radians(self.pick(5, 355)) * (-1 if clockwise else 1)
        radius = math.dist(start, centre)
        angle = math.atan2(start[1] - centre[1], start[0] - centre[0]) + turn
        ends = [(first, self._towards(first, centre[0] + radius * math.cos(angle)))]
        ends += [(second, self._towards(second, centre[1] + radius * math.sin(angle)))]
        end = (self.position[first], self.position[second])
        if abs(math.dist(end, centre) - radius) > CLOSENESS[self.dialect]:
            return None
        if math.dist(start, end) < 0.01:
            return None
        return ends + self._helix(normal) + words

    def _radius_arc(self, clockwise: bool) -> Words | None:
        """Return words of an arc with a radius, short or long."""
        first, second, normal = tuple(PLANES[self.plane][0])
        start = (self.position[first], self.position[second])
        ends = [(axis, self._place(axis)) for axis in (first, second)]
        chord = math.dist(start, (self.position[first], self.position[second]))
        if chord < 1.0:
            return None
        unit, places = self._unit("R"), self._decimals("R")
        stretch = self.one((1.01, 1.1, 1.5, 3.0, 1.0 if self.dialect == "linuxcnc" else 2.0))
        short = stretch == 1.0 and not self.inch  # LinuxCNC lets it end 1.27 um early
        steps = chord / 2 * stretch / unit * 10**places
        radius = (math.floor(steps) if short else math.ceil(steps)) / 10**places
        text = number(-radius if self.chance(40) else radius, places)
        return ends + self._helix(normal) + [("R", self.layout.number(text))]

    def _circle(self, clockwise: bool) -> Words | None:
        """Return words of a full circle: without end point, or with the start repeated."""
        first, second, normal = tuple(PLANES[self.plane][0])
        _, words = self._draw_centre()
        if self.dialect != "grbl" and self.chance(50):
            if self.dialect in POINTED and self.motion in ("G2", "G3"):
                self.motion = ""  # write the G word
            return self._helix(normal) + words
        before = (self.position[first], self.position[second])
        ends = [(axis, self._towards(axis, self.position[axis])) for axis in (first, second)]
        after = (self.position[first], self.position[second])
        return ends + self._helix(normal) + words if math.dist(before, after) < 1e-9 else None

    def _helix(self, normal: str) -> Words:
        return [(normal, self._place(normal))] if self.chance(25) else []

    # --- splines

    def _spline(self) -> None:
        """Write a G5, without I and J at times in a series, or a G5.1."""
        cubic, goes_on = self.chance(70), self.in_series
        words: Words = [("G", "5" if cubic else "5.1")]
        words += [(a, self._place(a)) for a in self.one(("XY", "XY", "X", "Y"))]
        letters = "IJ" if not (cubic and goes_on and self.chance(50)) else ""
        words += [(a, self._distance_word()) for a in letters + "PQ" * cubic]
        self.in_series, self.motion = cubic, ""
        self._emit_motion(words + self._feed())

    def _distance_word(self) -> str:
        return self.layout.number(number(self._value("X", 40), self._decimals("X")))

    # --- everything else

    def _auxiliary(self) -> None:
        """Write a dwell, spindle, coolant, tool or stop block."""
        kinds = ["dwell", "speed", "coolant", "stop", "tool"]
        words: Words = []
        match self.one(kinds):
            case "dwell":
                words = [("G", "4"), self._dwell()]
            case "speed":
                self.speed = self.pick(1, 24000)
                words = [("S", str(self.speed)), ("M", self.one(("3", "4")))]
            case "coolant":
                words = [("M", self.one(("8", "9", "5")))]
            case "stop":
                words = [("M", self.one(("0", "1")))]
            case _:
                words = self._tool()
        self._emit(words)

    def _tool(self) -> Words:
        words: Words = [("T", str(self.pick(1, 20)))]
        return words if self.dialect == "grbl" else [*words, ("M", "6")]

    def _dwell(self) -> tuple[str, str]:
        tenths = self.pick(1, 30)
        if self.dialect not in POINTED:
            return ("P", number(tenths / 10, 1))
        seconds = "P" if self.dialect == "haas" else "X"
        return self.one((("P", str(tenths * 100)), (seconds, f"{tenths / 10:.1f}")))

    def _modes(self) -> None:
        """Change one mode, in a block without motion or together with the next motion."""
        kinds: list[Callable[[], Words]] = [self._cancel]
        kinds += [self._distance] if self.options.incremental else []
        kinds += [self._units] if self.options.inches else []
        kinds += [self._plane] if self.options.planes else []
        kinds += [self._feed_mode] if self.options.feed_modes else []
        kinds += [self._centres] if self.dialect == "linuxcnc" and self.options.arcs else []
        kind = self.one(kinds)
        alone = [self._cancel] if self.dialect == "linuxcnc" else [self._cancel, self._units]
        alone += [self._feed_mode] if self.dialect == "grbl" else []
        if self.pending or kind in alone or self.chance(60):
            self._emit_motion(kind() if not self.pending else [])
        else:
            self.pending = kind()

    def _cancel(self) -> Words:
        code = self.one(("40", "49", "80"))
        if code == "80":
            self.motion = ""
        return [("G", code)]

    def _distance(self) -> Words:
        self.incremental = not self.incremental
        return [("G", "91" if self.incremental else "90")]

    def _units(self) -> Words:
        """Change the units; GRBL and LinuxCNC keep the feed, a Fanuc is told again."""
        self.inch = not self.inch
        self.feed_known = self.feed_known and self.dialect not in POINTED
        return [("G", "20" if self.inch else "21")]

    def _plane(self) -> Words:
        self.plane = self.one(("G17", "G18", "G19"))
        return [("G", self.plane[1:])]

    def _feed_mode(self) -> Words:
        """Change or repeat the feed mode; the feed is to be programmed again."""
        modes = ["G94", "G93"] if self.dialect == "grbl" else ["G94", "G93", "G95"]
        self.feed_mode = self.one(modes)
        self.feed_known = False
        words: Words = [("G", self.feed_mode[1:])]
        if self.feed_mode == "G95" and not self.speed:
            self.speed = self.pick(1, 5000)
            words += [("S", str(self.speed)), ("M", "3")]
        return words

    def _centres(self) -> Words:
        self.absolute_centre = not self.absolute_centre
        return [("G", "90.1" if self.absolute_centre else "91.1")]
