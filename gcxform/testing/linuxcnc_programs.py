"""Programs for LinuxCNC over all that it executes.

Beside shifts, cycles and contours there are splines, probes, threads, loops, subroutines,
assignments, and comments and M codes that do something. What LinuxCNC draws of a spline it does not
print, so the builder keeps a book of them.
"""

import math
from collections.abc import Callable
from dataclasses import field
from typing import Final

from gcxform.testing.generate import Options, Pick
from gcxform.testing.layout import Words, number
from gcxform.testing.linuxcnc_language import WholeBuilder
from gcxform.testing.shifts import Tools, no_tools
from gcxform.values import dataclass

Point = tuple[float, ...]
TALK: Final = ("(MSG,here)", "(DEBUG,at #<deep>)", "(LOG,done)", "(DEBUG,#101 and #<deep>)")
SET: Final = (
    ("M", "48"),
    ("M", "49"),
    ("G", "61"),
    ("G", "64"),
    ("M", "51"),
    ("M", "50"),
)
OUTPUTS: Final = ("M62 P1", "M63 P1", "M64 P2", "M65 P2", "M67 E1 Q2.5", "M68 E0 Q1", "M19 R45")


@dataclass(frozen=True)
class Drawn:
    """A program, and the control points (machine coordinates, mm) of its splines by line."""

    text: bytes
    curves: dict[int, tuple[Point, ...]] = field(default_factory=dict)


@dataclass(frozen=True)
class Wishes:
    """What may occur: splines, loops and subroutines, lengths of the tools of the table."""

    splines: bool = True
    flow: bool = True
    lengths: bool = True


EVERYTHING: Final = Wishes()


def everything(
    pick: Pick, blocks: int = 14, tools: Tools = no_tools, wishes: Wishes = EVERYTHING
) -> Drawn:
    """Return a program of some `blocks` blocks that LinuxCNC mostly accepts."""
    builder = EverythingBuilder(pick, Options(max_blocks=blocks), tools, wishes)
    text = builder.build()
    ahead = text.startswith(b"%")
    return Drawn(text, {line + ahead: points for line, points in builder.curves.items()})


class EverythingBuilder(WholeBuilder):
    """One program in the making."""

    def __init__(self, pick: Pick, options: Options, tools: Tools, wishes: Wishes) -> None:
        super().__init__(pick, options, tools)
        self.wishes = wishes
        self.curves: dict[int, tuple[Point, ...]] = {}
        self.handles: Point = (0.0, 0.0)
        self.named = 0
        self.topics = self._topics()

    def _topics(self) -> list[Callable[[], None]]:
        """Choose what a program is about, so that each has enough of something."""
        some: list[Callable[[], None]] = [self._profile, self._profile, self._probe, self._thread]
        some += [self._spline] if self.wishes.splines else []
        some += [self._loop, self._call] if self.wishes.flow else []
        some += [self._assign, self._talk, self._output, self._deleted]
        return [topic for topic in some if self.chance(25)]

    def _kinds(self) -> list[Callable[[], None]]:
        plain = [kind for kind in super()._kinds() if kind != self._spline]
        return [*plain, *self.topics * 4]

    def _open(self) -> str:
        work = super()._open()
        self.lines += ["#<deep> = 7", "#101 = 1.5"]
        return work

    def _free(self) -> bool:
        """Tell whether a block may come that wants plain modes."""
        return not (self.pending or self.diameter or self.feed_mode != "G94")

    def _length(self) -> Words:
        return super()._length() if self.wishes.lengths else self._vector()

    # --- splines

    def _spline(self) -> None:
        if not self._free() or self.plane != "G17" or self.layout.sequence:
            self._line()
            return
        start, goes_on = dict(self.position), self.in_series
        cubic = self.chance(70)
        out: Point
        back: Point
        words: Words = [("G", "5" if cubic else "5.1")]
        words += [(a, self._place(a)) for a in self.one(("XY", "XY", "X", "Y"))]
        out, back = self.handles, (0.0, 0.0)
        if not (cubic and goes_on and self.chance(50)):
            out = self._handle(words, "IJ")
        else:
            out = (-out[0], -out[1])
        if cubic:
            back = self._handle(words, "PQ")
        self.in_series, self.motion, self.handles = cubic, "", back
        self._emit_motion(words + self._feed())
        self._note(start, out, back if cubic else None)

    def _handle(self, words: Words, letters: str) -> Point:
        """Draw the distance of a control point, mm; add its words."""
        values = []
        for letter in letters:
            text = number(self._value("X", 40), self._decimals("X"))
            values.append(float(text) * self._unit("R"))
            words.append((letter, self.layout.number(text)))
        return values[0], values[1]

    def _note(self, start: dict[str, float], out: Point, back: Point | None) -> None:
        """Enter a spline; a quadratic one has a single point between."""
        end = self.position
        points = [start, start | {"X": start["X"] + out[0], "Y": start["Y"] + out[1]}]
        if back is not None:
            points.append(end | {"X": end["X"] + back[0], "Y": end["Y"] + back[1]})
        places = [self.book.machine(point) for point in [*points, end]]
        self.curves[len(self.lines)] = tuple(
            tuple(place.get(axis, 0.0) for axis in "XYZABC") for place in places
        )

    # --- contours of every shape

    def _profile(self) -> None:
        """Write a contour of lines and arcs under cutter compensation, reachable or not."""
        if not self._free() or self.plane == "G19":
            self._line()
            return
        radius = self.pick(2, 40) / 10
        heading = math.radians(self.pick(0, 359))
        diameter = number(2 * radius / self._unit("R"), self._decimals("X"))
        on: Words = [("G", self.one(("41.1", "42.1"))), ("D", diameter)]
        if self.chance(50):
            self._emit(on)
            on = []
        self._cut(heading, radius + self.pick(2, 200) / 10, on)
        for _ in range(self.pick(1, 6)):
            heading += math.radians(self.one((0, 0, 30, -30, 90, -90, 45, -2, 120, -120)))
            length = self.pick(1, 400) / 10
            if self.chance(45):
                heading = self._bend(heading, length)
            else:
                self._cut(heading, length, [])
            self._between()
        self._emit([("G", "40")])
        self._cut(heading + self.one((0.0, 0.5, 1.6)), radius + self.pick(2, 200) / 10, [])
        self.unsettled = False

    def _pair(self) -> tuple[str, str]:
        return ("Z", "X") if self.plane == "G18" else ("X", "Y")

    def _cut(self, heading: float, length: float, more: Words) -> None:
        a, b = self._pair()
        ends = (
            (a, self.position[a] + length * math.cos(heading)),
            (b, self.position[b] + length * math.sin(heading)),
        )
        words = [(axis, self._towards(axis, value)) for axis, value in ends]
        if self.chance(8) and not more:
            third = ({"X", "Y", "Z"} - {a, b}).pop()
            words.append((third, self._place(third)))
        self._emit([*self._head("G1"), *more, *words, *self._feed()])

    def _bend(self, heading: float, radius: float) -> float:
        """Write an arc that goes on in a heading; return the heading at its end."""
        a, b = self._pair()
        sense = self.one((1, -1))
        sweep = math.radians(self.one((90, 180, 30, 5, 270, 45, 135)))
        offset = (-sense * radius * math.sin(heading), sense * radius * math.cos(heading))
        start = (self.position[a], self.position[b])
        centre: list[float] = []
        words: Words = []
        for letter, value, base in zip("KI" if a == "Z" else "IJ", offset, start, strict=True):
            counted = base if self.absolute_centre else 0.0
            text = number((value + counted) / self._unit("R"), self._decimals("X"))
            centre.append(float(text) * self._unit("R") + base - counted)
            words.append((letter, self.layout.number(text)))
        size = math.dist(start, centre)
        angle = math.atan2(start[1] - centre[1], start[0] - centre[0]) + sense * sweep
        target = (centre[0] + size * math.cos(angle), centre[1] + size * math.sin(angle))
        ends = [(axis, self._towards(axis, v)) for axis, v in zip((a, b), target, strict=True)]
        code = "G3" if sense > 0 else "G2"
        self._emit([*self._head(code), *ends, *words, *self._feed()])
        return angle + sense * math.pi / 2

    def _between(self) -> None:
        """Write now and then what does not move in the plane."""
        if self.chance(8):
            self._emit([("G", "4"), self._dwell()])
        elif self.chance(8):
            self._emit([("M", self.one(("8", "9", "7")))])
        elif self.chance(5):
            self._emit([("G", "91" if not self.incremental else "90")])
            self.incremental = not self.incremental

    # --- probes and threads

    def _probe(self) -> None:
        """Write a probe, and a rapid to a place that does not depend on what it found."""
        if not self._free() or self.incremental:
            self._line()
            return
        axes = [a for a in "XYZ" if self.chance(50)] or ["Z"]
        words = [(axis, self._place(axis)) for axis in axes]
        self.motion, self.in_series = "", False
        self._emit([("G", self.one(("38.2", "38.3", "38.4", "38.5"))), *words, *self._feed()])
        place = [(axis, self._place(axis)) for axis in self.axes]
        self._emit([*self._head("G0"), *place])

    def _thread(self) -> None:
        if not self._free():
            self._line()
            return
        self.speed = self.pick(10, 3000)
        self._emit([("S", str(self.speed)), ("M", "3")])
        pitch = number(self.pick(5, 30) / 10 / self._unit("R"), self._decimals("X"))
        self.motion, self.in_series = "", False
        if self.chance(40):
            axis = "Z"
            before = dict(self.position)
            self._emit([("G", "33.1"), (axis, self._place(axis)), ("K", pitch)])
            self.position = before
        else:
            words = [(a, self._place(a)) for a in self.one(("Z", "XZ", "XYZ"))]
            self._emit([("G", "33"), *words, ("K", pitch)])

    # --- what is computed

    def _label(self) -> str:
        self.named += 1
        return f"o{100 + self.named}"

    def _loop(self) -> None:
        """Write a loop over a few moves in G91, with a parameter that counts."""
        if not self._free() or self.layout.numbered or self.book.angles[self.book.work]:
            self._line()
            return
        label, count = self._label(), self.pick(1, 3)
        steps = [self.pick(-50, 50) / 10 for _ in range(2)]
        was = self.incremental
        self.motion, self.in_series = "", False
        feed = self.pick(10, 900)
        body = [f"G1 X{steps[0]:g} Z[{steps[1]:g} * 1] F{feed}"]
        if self.chance(60):
            body.append("#101 = [#101 + 0.5]")
        if self.chance(30):
            body.append("(DEBUG,in the loop #101)")
        if self.chance(40):
            body.append("G0 Y[#101]")
        head = f"{label} repeat [{count}]"
        tail = f"{label} endrepeat"
        self.lines += ["G91", head, *body, tail, "G90"]
        self.incremental, self.feed_known = False, True
        self._emit([("G", "0"), *[(axis, self._place(axis)) for axis in "XYZ"]])
        if was:
            self.lines.append("G91")
            self.incremental = True

    def _call(self) -> None:
        """Write a subroutine and call it, at times twice."""
        if not self._free() or self.layout.numbered:
            self._line()
            return
        label, values = self._label(), [self.pick(-400, 400) / 10 for _ in range(3)]
        was = self.incremental
        self.motion, self.in_series = "", False
        body = [f"G90 G1 X#1 Y[#2 + #3] F{self.pick(10, 900)}"]
        if self.chance(40):
            body.append("(DEBUG,called with #1 #2)")
        if self.chance(40):
            body += ["#<_sum> = [#1 + #2]", "G0 Z#<_sum>"]
        if self.chance(30):
            body += [f"{label}1 if [#1 GT 0]", "M8", f"{label}1 else", "M9", f"{label}1 endif"]
        self.lines += [f"{label} sub", *body, f"{label} endsub"]
        for _ in range(self.pick(1, 2)):
            self.lines.append(f"{label} call " + " ".join(f"[{v:g}]" for v in values))
            values = [v + 1 for v in values]
        self.incremental, self.feed_known = False, True
        self._emit([("G", "0"), *[(axis, self._place(axis)) for axis in "XYZ"]])
        if was:
            self.lines.append("G91")
            self.incremental = True

    def _assign(self) -> None:
        """Write an assignment, or a move by what was assigned."""
        if not self._free() or self.layout.numbered:
            self._line()
            return
        value = self.pick(-300, 300) / 10
        if self.chance(50):
            self.lines.append(f"#<deep> = {value:g}")
            return
        axis = self.one("XYZ")
        at = value * self._unit(axis)
        self.position[axis] = at + (self.position[axis] if self.incremental else 0.0)
        self.motion, self.in_series = "G0", False
        self.lines += [f"#<deep> = [{value:g} * 2]", f"G0 {axis}[#<deep> / 2]"]

    def _talk(self) -> None:
        self.lines.append(self.one(TALK))

    def _output(self) -> None:
        if self.pending:
            self._line()
        elif self.chance(50):
            self._emit([self.one(SET)])
        else:
            self.lines.append(self.one(OUTPUTS))

    def _deleted(self) -> None:
        """Write a line, with the slash of block delete before it."""
        if self.pending:
            self._line()
            return
        before = len(self.lines)
        self._line()
        self.lines[before] = "/" + self.lines[before]
