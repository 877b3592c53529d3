"""Programs for LinuxCNC that shift and turn their coordinates, go home and take tool lengths.

The builder keeps a book of its own of the offsets, one number at a time, so that it knows where a
program stands in the coordinates in force:

    machine = rotation about Z @ (position + G92) + work offset + tool
"""

import math
from collections.abc import Callable
from typing import Final

from gcxform.testing.generate import ROTARY, Builder, Options, Pick
from gcxform.testing.layout import Words, number

WORK: Final = ("G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3")
Tools = Callable[[int], tuple[float, float, float]]
Point = dict[str, float]


def no_tools(number: int) -> tuple[float, float, float]:
    """Return the vector of a tool of a table in which all are 0."""
    return 0.0, 0.0, 0.0


class Book:
    """The offsets in force, in mm and degrees."""

    def __init__(self, axes: str) -> None:
        self.axes = axes
        self.work = "G54"
        self.zeros = {code: self.none() for code in WORK}
        self.angles = dict.fromkeys(WORK, 0.0)
        self.preset, self.held, self.tool = self.none(), self.none(), self.none()
        self.homes = {"G28": self.none(), "G30": self.none()}
        self.in_spindle = 0

    def none(self) -> Point:
        """Return zeros."""
        return dict.fromkeys(self.axes, 0.0)

    def machine(self, position: Point) -> Point:
        """Return where the machine is with a position of the program."""
        inner = {a: position[a] + self.preset[a] for a in self.axes}
        turned = _turned(inner, self.angles[self.work])
        return {a: turned[a] + self.zeros[self.work][a] + self.tool[a] for a in self.axes}

    def position(self, machine: Point) -> Point:
        """Return the position in the program of a point of the machine."""
        outer = {a: machine[a] - self.zeros[self.work][a] - self.tool[a] for a in self.axes}
        turned = _turned(outer, -self.angles[self.work])
        return {a: turned[a] - self.preset[a] for a in self.axes}


def _turned(point: Point, degrees: float) -> Point:
    if not degrees:
        return point
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return point | {"X": c * point["X"] - s * point["Y"], "Y": s * point["X"] + c * point["Y"]}


class ShiftingBuilder(Builder):
    """One program in the making; `tools` are the vectors (mm) of a table of 20."""

    def __init__(self, pick: Pick, options: Options, tools: Tools = no_tools) -> None:
        super().__init__(pick, options)
        self.tools = tools
        self.book = Book(self.axes)
        self.diameter = False
        self.unsettled = False

    def _kinds(self) -> list[Callable[[], None]]:
        return [*super()._kinds(), *[self._shift] * 5, self._home, self._machine]

    def _open(self) -> str:
        self.book.work = super()._open()
        return self.book.work

    def _cancel(self) -> Words:
        words = super()._cancel()
        if words == [("G", "49")]:
            self._change_tool_vector(self.book.none())
        return words

    def _units(self) -> Words:
        """Change the units, or end the tool length, which would not survive that."""
        if not any(self.book.tool.values()):
            return super()._units()
        self._change_tool_vector(self.book.none())
        return [("G", "49")]

    def _change_tool_vector(self, vector: Point) -> None:
        place = self.book.machine(self.position)
        self.book.tool = vector
        self.unsettled = True
        self.position = self.book.position(place)

    def _unit(self, axis: str) -> float:
        half = 0.5 if axis == "X" and self.diameter else 1.0
        return super()._unit(axis) * half

    def _emit_motion(self, words: Words) -> None:
        self.unsettled &= not {axis for axis, _ in words} & set(self.axes)
        super()._emit_motion(words)

    # --- shifts

    def _shift(self) -> None:
        """Write a block that changes the coordinates, or let its code wait for a motion."""
        own = [self._set_work, self._set_work, self._set_here, self._local, self._preset]
        own += [self._preset_end, self._vector, self._store_home]
        light = [self._work, self._work, self._length, self._diameter]
        draw = self.one([*own, *light])
        if self.pending:
            self._emit_motion([])
        place = self.book.machine(self.position)
        words = draw()
        self.position = self.book.position(place)
        waits = draw in light and not self.pending and ("G", "43.2") not in words
        if waits and self.chance(50):
            self.pending = words
        elif words:
            self._emit_motion(words)
        self.unsettled = True

    def _work(self) -> Words:
        self.book.work = self.one(WORK)
        return [("G", self.book.work[1:])]

    def _numbers(self, into: Point, axes: str = "") -> Words:
        """Draw words for some axes, and enter what they say."""
        chosen = [a for a in axes or self.axes if self.chance(30)] or [self.one(axes or "XYZ")]
        words: Words = []
        for axis in chosen:
            text = number(self._value(axis, 90 if axis in ROTARY else 40), self._decimals(axis))
            into[axis] = float(text) * self._unit(axis)
            words.append((axis, self.layout.number(text)))
        return words

    def _offset(self) -> tuple[str, Words]:
        """Draw the work offset that G10 sets."""
        at = self.pick(0, 9)
        code = WORK[at - 1] if at else self.book.work
        return code, [("P", str(at))]

    def _set_work(self) -> Words:
        code, words = self._offset()
        inner = self.book.preset["X"] or self.book.preset["Y"]
        if code == self.book.work and self.book.angles[code] and inner:
            return []  # what LinuxCNC makes of that no other machine would
        words += self._numbers(self.book.zeros[code])
        plain = code != self.book.work or not (self.book.preset["X"] or self.book.preset["Y"])
        if plain and self.chance(25):
            self.book.angles[code] = self.one((0, 90, 30, -45, 180, 12.5))
            words.append(("R", number(self.book.angles[code], 1)))
        return [("G", "10"), ("L", "2"), *words]

    def _set_here(self) -> Words:
        """Draw a zero from where the axes stand."""
        code, words = self._offset()
        if self.book.angles[code] or self.book.angles[self.book.work]:
            return []
        inner = {a: self.position[a] + self.book.preset[a] for a in self.axes}
        said: Point = {}
        words += self._numbers(said)
        here = self.book.zeros[self.book.work]
        zero = {a: here[a] + inner[a] - v - self.book.preset[a] for a, v in said.items()}
        self.book.zeros[code] |= zero
        return [("G", "10"), ("L", "20"), *words]

    def _local(self) -> Words:
        words = self._numbers(self.book.preset)
        self.book.held = dict(self.book.preset)
        return [("G", "52"), *words]

    def _preset(self) -> Words:
        said: Point = {}
        words = self._numbers(said)
        for axis, value in said.items():
            self.book.preset[axis] += self.position[axis] - value
        self.book.held = dict(self.book.preset)
        return [("G", "92"), *words]

    def _preset_end(self) -> Words:
        code = self.one(("92.1", "92.2", "92.3"))
        if code == "92.1":
            self.book.held = self.book.none()
        self.book.preset = dict(self.book.held) if code == "92.3" else self.book.none()
        return [("G", code)]

    # --- tools

    def _tool(self) -> Words:
        """Change the tool; rs274 by itself forgets then what a shift since the last move did."""
        if self.pending or self.unsettled:
            self._rapid()
        words = super()._tool()
        self.book.in_spindle = int(words[0][1])
        return words

    def _length(self) -> Words:
        code = self.one(("43", "43", "43.2", "49"))
        if code == "49":
            self.book.tool = self.book.none()
            return [("G", code)]
        tool = self.book.in_spindle
        words: Words = [("G", code)]
        if code == "43.2" or not tool or self.chance(70):
            tool = self.pick(1, 20)
            words.append(("H", str(tool)))
        vector = dict(zip("XYZ", self.tools(tool), strict=True))
        before = self.book.tool if code == "43.2" else self.book.none()
        self.book.tool = before | {a: before[a] + v for a, v in vector.items()}
        return words

    def _vector(self) -> Words:
        return [("G", "43.1"), *self._numbers(self.book.tool, "XYZ")]

    def _diameter(self) -> Words:
        self.diameter = not self.diameter
        return [("G", "7" if self.diameter else "8")]

    # --- moves

    def _arc(self) -> None:
        if self.book.angles[self.book.work] and self.plane != "G17":
            self._line()  # its plane is turned out of the axes
        else:
            super()._arc()

    def _store_home(self) -> Words:
        code = self.one(("G28", "G30"))
        self.book.homes[code] = self.book.machine(self.position)
        return [("G", f"{code[1:]}.1")]

    def _home(self) -> None:
        """Write a return to the reference point."""
        code = self.one(("G28", "G30"))
        before = dict(self.position)
        words = self._some_axes() if self.chance(75) else []
        turned = {"X", "Y"} & {axis for axis, _ in words}
        if self.book.angles[self.book.work] and len(turned) == 1:
            self.position, words = before, []  # one of two turned axes alone
        named = {axis for axis, _ in words} or set(self.axes)
        machine = self.book.machine(self.position)
        home = {a: self.book.homes[code][a] if a in named else machine[a] for a in self.axes}
        self.position = self.book.position(home)
        self._emit_motion([("G", code[1:]), *words])

    def _machine(self) -> None:
        """Write a move in the coordinates of the machine."""
        if self.incremental:
            return
        feed = self.chance(40)
        words = self._head("G1" if feed else "G0")
        machine = self.book.machine(self.position)
        words += self._numbers(machine)
        self.position = self.book.position(machine)
        self._emit_motion([("G", "53"), *words, *(self._feed() if feed else [])])
