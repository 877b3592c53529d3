"""Programs of shops drawn for a control, and what LinuxCNC does as `reference.shop` has it."""

from __future__ import annotations

import cmath
import random

from oracles import rs274
from reference.shop import HOME, OFFSETS, Move, moving, swept

PLANES = {"XY": 17, "ZX": 18, "YZ": 19}
CODES = {"RAPID": 0, "LINE": 1, "ARC_CW": 2, "ARC_CCW": 3}
LANGUAGES = {"siemens": ("G700", "G710"), "fagor": ("", "G71")}
BEFORE = "".join(f"G10 L2 P{n} X{x} Y{y} Z{z}\n" for n, (x, y, z) in OFFSETS.items())
BEFORE += f"G21 G90 G53 G0 X{HOME[0]} Y{HOME[1]} Z{HOME[2]}\nG28.1\nG53 G0 X0 Y0 Z0\nG80\n"
SINGLE = ("tinyg", "g2core")
"""Controls whose arcs in XZ are refused."""
PER_TURN = ("fanuc", "haas", "linuxcnc")
TIMED = ("fanuc", "linuxcnc")
"""Controls of which feeds per turn, and by times, are drawn."""
THERE = 2
"""Moves of what stands before a program."""


class Drawn:
    """Draws a program of holes, lines and arcs that is right on its control."""

    def __init__(self, seed: int, control: str) -> None:
        self.random = random.Random(f"{control} {seed}")
        self.control, self.inch, self.steps, self.plane = control, False, False, 17
        self.drills = control in ("fanuc", "haas", "linuxcnc")

    def text(self) -> str:
        """Return the program."""
        self.inch = self.control != "fagor" and self.chance(0.2)
        off = " G49 G80" if self.drills or self.control == "mach3" else ""
        lines = [f"{self.unit()} G17 G90 G94 G40{off}", "G54", "S800 M3"]
        lines += [f"G0 {self.words('XY', 0, 20)}", self.word("Z", 10, 30)]
        lines.append(f"G1 F{self.number(50, 300)} {self.word('X', 0, 20)}")
        for _ in range(self.random.randint(3, 10)):
            lines += self.some()
        return "\n".join([*lines, "G0 G90" if not self.drills else "G80", "M30", ""])

    def chance(self, share: float) -> bool:
        return self.random.random() < share

    def unit(self) -> str:
        inch, metric = LANGUAGES.get(self.control, ("G20", "G21"))
        return inch if self.inch else metric

    def number(self, low: float, high: float) -> str:
        scale = self.random.choice([1, 2, 10, 1000])
        value = self.random.randint(int(low * scale), int(high * scale)) / scale
        text = f"{round(value / 25, 4) if self.inch else value:.4f}".rstrip("0")
        return "0." if text == "-0." else text

    def word(self, axis: str, low: float, high: float) -> str:
        return axis + self.number(low, high)

    def words(self, axes: str, low: float, high: float) -> str:
        return " ".join(self.word(axis, low, high) for axis in axes)

    def everywhere(self) -> str:
        return f"G0 {self.words('XYZ', 5, 20)}"

    def some(self) -> list[str]:
        """Return a few lines."""
        ways = [self.straight, self.arc, self.dwell, self.distances, self.work, self.units]
        ways += [self.turn, self.told, self.feeds]
        ways += [self.hole] * 8 if self.drills else []
        ways += [self.local] if self.control in ("fanuc", "haas") else []
        ways += [self.length, self.home] if self.drills or self.control == "mach3" else []
        return self.random.choice(ways)()

    def straight(self) -> list[str]:
        axes = self.random.sample("XYZ", self.random.randint(1, 3))
        low, high = (-5, 5) if self.steps else (-5, 25)
        beside = self.random.choice([" M8", " M9", " M5", " M3"]) if self.chance(0.15) else ""
        return [f"G{self.random.choice('01')} {self.words(''.join(axes), low, high)}{beside}"]

    def feeds(self) -> list[str]:
        """Return lines at a feed per turn, or by times, and a feed per minute again."""
        if self.control not in PER_TURN:
            return self.dwell()
        low, high = (1, 5) if self.steps else (-5, 25)
        lines = [f"G95 G1 F0.{self.random.randint(1, 9)} {self.words('XY', low, high)}"]
        lines += [f"{self.words('Z', low, high)}"] if self.chance(0.5) else []
        if self.control in TIMED and self.chance(0.5):
            times = self.random.sample(range(30, 60), 3)  # LinuxCNC knows no speed below 0.1 a min
            way = [f"{self.word(a, low, high)} F{n}." for a, n in zip("XYZ", times, strict=True)]
            lines = [f"G93 G1 {way[0]}", *way[1:]]
        return ["G80", *lines, f"G94 F{self.number(60, 300)}"]

    def local(self) -> list[str]:
        """Return a shift of all work offsets, moves, and its end."""
        moves = [*self.straight(), *self.hole()] if self.chance(0.5) else self.straight()
        begin = [*("G80", self.absolute()), f"G52 {self.words('XYZ', -5, 5)}", self.everywhere()]
        return [*begin, *moves, "G80", self.absolute(), "G52 X0. Y0. Z0.", self.everywhere()]

    def arc(self) -> list[str]:
        first, second = {17: "XY", 18: "XZ", 19: "YZ"}[self.plane]
        code, size = self.random.choice("23"), self.number(2, 9)
        centre = {"X": "I", "Y": "J", "Z": "K"}[first]
        if self.steps:
            return [f"G{code} {first}{size} {second}{size} {centre}{size}"]
        a, b = self.number(0, 9), self.number(0, 9)
        ends = [f"{axis}{float(at) + float(size):.4f}" for axis, at in ((first, a), (second, b))]
        radius = "CR=" if self.control == "siemens" else "R"
        way = [f"{' '.join(ends)} {centre}{size}", f"{centre}{size}"]
        if self.control != "tinyg":
            way.append(f"{' '.join(ends)} {radius}{self.random.choice(['', '-'])}{size}")
        return [f"G1 {first}{a} {second}{b}", f"G{code} {self.random.choice(way)}"]

    def dwell(self) -> list[str]:
        seconds = self.random.choice([0.25, 0.5, 1.0, 2.0])
        if self.control in ("fanuc", "haas") and self.chance(0.5):
            return [f"G4 P{seconds * 1000:.0f}"]
        letter = {"fanuc": "X", "siemens": "F", "fagor": "K"}.get(self.control, "P")
        return [f"G4 {letter}{seconds}"] if self.control != "mach3" else []

    def distances(self) -> list[str]:
        self.steps = not self.steps
        return ["G91" if self.steps else "G90"]

    def absolute(self) -> str:
        self.steps = False
        return "G90"

    def work(self) -> list[str]:
        return [self.absolute(), f"G{self.random.randint(54, 56)}", self.everywhere()]

    def units(self) -> list[str]:
        self.inch = self.control != "fagor" and not self.inch  # of G70 it is not known what F is
        return [self.unit(), f"G1 F{self.number(60, 300)}"]

    def turn(self) -> list[str]:
        self.plane = self.random.choice([17, 19] if self.control in SINGLE else [17, 18, 19])
        return [*(["G80"] if self.drills else []), f"G{self.plane}"]

    def told(self) -> list[str]:
        return [self.random.choice(["M8", "M9", "M4", "M1", "M0", "M3"])]

    def home(self) -> list[str]:
        """Return a way home or in the machine, a zero that is set, or a shift for some moves."""
        ways = [["G91 G28 Z0.", "G90"], ["G90 G53 G0 Z0."]]
        number, axes = self.random.randint(1, 3), self.words("XZ", -9, 9)
        ways.append(["G90", f"G10 L2 P{number} {axes}", f"G{53 + number}"])
        by_way = self.random.choice(["G90 G28 Z20.", "G91 G28 Z2. X1.", "G90 G28 X5. Y5."])
        ways[2:2] = [["G80", by_way, "G90"]]
        self.steps = False
        return [*self.random.choice(ways[: 4 if self.drills else 2]), self.everywhere()]

    def length(self) -> list[str]:
        number = self.random.choice([1, 2, 5, 7])
        change = [f"T{number} M6"] if self.chance(0.5) else []
        begin = ["G80", *change, self.absolute(), f"G0 {self.words('XY', 0, 9)}"]
        return [
            *begin,
            f"{'G49 G0' if self.chance(0.2) else f'G43 H{number}'} Z{self.number(10, 30)}",
        ]

    def hole(self) -> list[str]:
        """Return a cycle with a few holes."""
        normal = {17: "Z", 18: "Y", 19: "X"}[self.plane]
        sides = "XYZ".replace(normal, "")
        code = self.random.choice([73, 81, 82, 83, 85, 89])
        lines = [f"G0 {self.word(normal, 1, 5) if self.steps else self.word(normal, 10, 25)}"]
        down, top = (-6, -1) if self.steps else (-12, -1), (1, 9)
        if self.steps and self.control != "linuxcnc":
            top = (-9, -1)
        begin = f"G{code} {self.word(normal, *down)} {self.word('R', *top)}"
        begin += {73: " Q", 83: " Q"}.get(code, "") and f" Q{0.1 if self.inch else 2.5}"
        if code in (82, 89):
            begin += " P500" if self.control != "linuxcnc" else " P0.5"
        for nth in range(self.random.randint(1, 4)):
            place = self.words(sides, -5, 5) if self.steps else self.words(sides, 0, 20)
            back = self.random.choice(["", "", " G98", " G99"])
            deeper = f" {self.word(normal, *down)}" if nth and self.chance(0.3) else ""
            count = "K" if self.control == "fanuc" else "L"
            again = f" {count}{self.random.randint(1, 3)}" if self.chance(0.15) else ""
            lines.append(f"{'' if nth else begin} {place}{deeper}{back}{again}".strip())
        return [*lines, "G80"] if self.chance(0.6) else lines


def by_linuxcnc(text: str) -> list[Move | str]:
    """Return what LinuxCNC does. Raises `rs274.Rejected`."""
    program = rs274.run((BEFORE + text).encode())
    out: list[Move | str] = []
    events, tool, speed = list(program.events), "0", 0.0
    for n in range(len(program.moves) + 1):
        while events and events[0][0] <= n:
            said = events.pop(0)[1]
            tool = said[1:] if said[0] == "T" else tool
            if said == "M6":
                out.append(f"T{tool}")
            elif said[0] == "S" and float(said[1:]) != speed:
                speed = float(said[1:])
                out.append(f"S{speed:g}")
            elif said[0] == "D":
                out.append(f"dwell {float(said[6:]):.6g}")
            elif said[0] == "M" and said not in ("M2", "M30"):
                out.append(said)
        if THERE <= n < len(program.moves):
            out.append(_move(program.moves[n]))
    return moving(out)


def _move(move: rs274.CanonMove) -> Move:
    start, end, *centre = (tuple(at[axis] for axis in "XYZ") for at in move.machine)
    code, feed = CODES[move.kind], (int(move.feed_mode[1:]), move.feed[0] if move.feed else 0.0)
    if not centre:
        return Move(code, start, end, feed if code else None)
    i, j = ("XYZ".index(axis) for axis in move.plane)
    z, e, c = (complex(at[i], at[j]) for at in (start, end, *centre))
    turn = swept(z, e, c, 1 if code == 3 else -1)
    assert cmath.isfinite(c)
    return Move(code, start, end, feed, (PLANES[move.plane], c, turn))
