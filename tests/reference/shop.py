"""A scalar reader of programs of shops for eight controls: cycles, frames, lengths, dwells.

It shares no code with the package, knows only programs that are right, and says where the spindle
goes in coordinates of the machine: zeros of work offsets, lengths and home are those below. What a
block does is taken from the manuals' words: R and Z of a cycle under G91 count from where it began
and from R, G98 goes back to where it began, P of a Fanuc counts ms.
"""

from __future__ import annotations

import cmath
import math
import re
from dataclasses import dataclass, field

OFFSETS = {1: (10.0, 20.0, -30.0), 2: (-7.0, 3.0, -11.0), 3: (1.0, -2.0, -40.0)}
LENGTHS = {0: 0.0, 1: 1.27, 2: 2.54, 5: 6.35, 7: 8.89}
HOME = (0.0, 0.0, 100.0)
BREAK, CLEAR = 0.5, 0.8
"""mm; how far G73 goes up between pecks, and how far above the last depth G83 begins."""
AXES = {17: "XYZ", 18: "ZXY", 19: "YZX"}
CENTRES = {"X": "I", "Y": "J", "Z": "K"}
WORD = re.compile(r"([A-Z])\s*=?\s*([-+]?(?:\d+\.?\d*|\.\d+))")
UNITS = {20: 25.4, 21: 1.0}
OWN_UNITS = {**UNITS, 70: 25.4, 71: 1.0, 700: 25.4, 710: 1.0}
FANUCS, LANGUAGES = ("fanuc", "haas"), ("siemens", "fagor")
CYCLES = (73, 81, 82, 83, 85, 89)
HOLE = re.compile(r"(MCALL\s*)?CYCLE8[12]\(([^)]*)\)|MCALL")
Point = tuple[float, ...]
Arc = tuple[int, complex, float]


@dataclass(frozen=True)
class Move:
    """A move by its code; `feed` is its mode and its value; `arc` plane, centre and angle."""

    code: int
    start: Point
    end: Point
    feed: tuple[int, float] | None = None
    arc: Arc | None = None


@dataclass
class Control:
    """What a control keeps; `out` are its moves, and in words what else it did."""

    name: str
    out: list[Move | str] = field(default_factory=list)
    at: list[float] = field(default_factory=lambda: [0.0, 0.0, 0.0])
    unit: float = 1.0
    plane: int = 17
    steps: bool = False
    motion: int = 80
    back: int = 98
    feed: float = 0.0
    mode: int = 94
    work: int = 1
    length: float = 0.0
    spindle: float = 0.0
    tools: tuple[int, int] = (0, 0)
    local: list[float] = field(default_factory=lambda: [0.0, 0.0, 0.0])
    zeros: dict[int, list[float]] = field(
        default_factory=lambda: {n: list(at) for n, at in OFFSETS.items()}
    )
    hole: dict[str, float] = field(default_factory=dict)
    called: tuple[float, ...] = ()
    machine: bool = False
    over: bool = False

    def zero(self, k: int) -> float:
        return self.zeros[self.work][k] + self.local[k] + (self.length if k == 2 else 0.0)

    def go(self, code: int, end: list[float], arc: Arc | None = None) -> None:
        way = math.dist(self.at, end) if self.mode == 93 else 1.0  # a speed is that of its line
        feed = (self.mode, self.feed * way) if code else None
        self.out.append(Move(code, tuple(self.at), tuple(end), feed, arc))
        self.at = list(end)

    def reached(self, words: dict[str, float]) -> list[float]:
        end = list(self.at)
        for k, axis in enumerate("XYZ"):
            if axis in words:
                end[k] = words[axis] + (self.at[k] if self.steps else self.zero(k))
        return end


def read(name: str, text: str) -> list[Move | str]:
    """Return what a program does, without moves that go nowhere."""
    control = Control(name)
    for line in text.splitlines():
        if not control.over:
            block(control, line)
    return moving(control.out)


def moving(out: list[Move | str]) -> list[Move | str]:
    """Return what was done without moves shorter than what decimals leave."""
    return [
        each
        for each in out
        if isinstance(each, str) or each.arc or math.dist(each.start, each.end) > 3e-3
    ]


def block(control: Control, line: str) -> None:
    """Execute a line."""
    comment = r";.*" if control.name == "siemens" else r"\([^)]*\)|;.*"
    text = re.sub(rf"{comment}|^\s*N\d+", "", line.upper()).strip()
    if not text or text[0] in "%O":
        return
    if text in ("#MCS ON", "#MCS OFF"):
        control.machine = text.endswith("ON")
        return
    if found := HOLE.fullmatch(text):
        given = tuple(float(each or "nan") for each in (found[2] or "").split(",") if found[2])
        control.called = given if found[1] else ()
        if not found[1] and given:
            drilled(control, given)
        return
    machine = "SUPA" in text or control.machine
    found = WORD.findall(re.sub(r"SUPA|TURN\s*=\s*\d+", "", text).replace("CR=", "R="))
    codes = [float(number) for letter, number in found if letter == "G"]
    functions = [int(float(number)) for letter, number in found if letter == "M"]
    words = {letter: float(number) for letter, number in found if letter not in "GM"}
    if 4 in codes:
        pointed = control.name == "haas" and "." in text.split("P")[-1]
        control.out.append(f"dwell {dwell(control, words, pointed):.6g}")
        return
    if control.name in FANUCS:
        for letter, number in found:
            drills = control.motion in CYCLES or set(codes) & set(CYCLES)
            counts = letter == "K" and control.name == "fanuc" and drills
            assert letter not in "XYZIJKRQ" or counts or "." in number or not float(number), line
    modes(control, codes, words)
    told(control, functions, words)
    lengths(control, codes, words)
    moves(control, codes, words, machine)
    if control.called and words.keys() & set("XYZ"):
        drilled(control, control.called)
    late(control, functions)


def drilled(control: Control, given: tuple[float, ...]) -> None:
    """Drill a hole of CYCLE81 or CYCLE82: RTP, RFP, SDIS, DP, DPR, DTB."""
    back, reference, above, bottom, *_, wait = (*given[:4], *given[5:6], 0.0)[:5]
    k = "XYZ".index(AXES[control.plane][2])
    steps = [(0, reference + above), (1, bottom), (4, wait), (0, back)]
    for code, level in steps:
        if code == 4:
            control.out += [f"dwell {level:.6g}"] if level else []
            continue
        end = list(control.at)
        end[k] = level * control.unit + control.zero(k)
        control.go(code, end)


def dwell(control: Control, words: dict[str, float], pointed: bool) -> float:
    """Return how long a G4 waits."""
    if control.name not in FANUCS:
        return next(iter(words.values()))
    return words["X"] if "X" in words else words["P"] * (1.0 if pointed else 0.001)


def modes(control: Control, codes: list[float], words: dict[str, float]) -> None:
    """Take units, feed, plane, distances and where cycles end."""
    units = OWN_UNITS if control.name in LANGUAGES else UNITS
    for code in codes:
        control.unit = units.get(int(code), control.unit)
        control.plane = int(code) if code in AXES else control.plane
        control.mode = int(code) if code in (93, 94, 95) else control.mode
        control.steps = code == 91 if code in (90, 91) else control.steps
        control.back = int(code) if code in (98, 99) else control.back
    if "F" in words:
        control.feed = words["F"] * (control.unit if control.mode != 93 else 1.0)


def told(control: Control, functions: list[int], words: dict[str, float]) -> None:
    """Take spindle, coolant and tools; a Fanuc ends both behind its move."""
    if words.get("S", control.spindle) != control.spindle:
        control.spindle = words["S"]
        control.out.append(f"S{control.spindle:g}")
    control.tools = int(words.get("T", control.tools[0])), control.tools[1]
    for function in functions:
        if function == 6:
            control.tools = control.tools[0], control.tools[0]
            control.out.append(f"T{control.tools[0]}")
        elif function in (3, 4, 5, 7, 8, 9) and not held(control, function):
            control.out.append(f"M{function}")


def held(control: Control, function: int) -> bool:
    return control.name in FANUCS and function in (5, 9)


def late(control: Control, functions: list[int]) -> None:
    """Take what is done behind the move of a block."""
    for function in functions:
        if held(control, function) or function in (0, 1):
            control.out.append(f"M{function}")
        control.over |= function in (2, 30)


def lengths(control: Control, codes: list[float], words: dict[str, float]) -> None:
    """Take tool lengths and work offsets."""
    for code in codes:
        if code == 43:
            control.length = LENGTHS[int(words.pop("H", control.tools[1]))]
        elif code == 43.1:
            control.length = words.pop("Z") * control.unit
        elif code == 49:
            control.length = 0.0
        elif 54 <= code <= 59:
            control.work = int(code) - 53
    if control.name in LANGUAGES and "D" in words:
        control.length = LENGTHS[control.tools[1]] if words["D"] else 0.0


def moves(control: Control, codes: list[float], words: dict[str, float], machine: bool) -> None:
    """Do what a block does with its axes."""
    begins = begun(control, codes)
    axes = {axis: words[axis] * control.unit for axis in "XYZ" if axis in words}
    if {10, 52} & set(codes):
        shift(control, words, axes, 52 in codes)
    elif 28 in codes:
        control.go(0, control.reached(axes))
        named = ["XYZ".index(axis) for axis in axes]
        control.go(0, [HOME[k] if k in named else at for k, at in enumerate(control.at)])
    elif machine or 53 in codes:
        control.go(0, [axes.get("XYZ"[k], at) for k, at in enumerate(control.at)])
    elif control.motion in (0, 1) and axes:
        control.go(control.motion, control.reached(axes))
    elif control.motion in (2, 3) and words.keys() & set("XYZIJKR"):
        arc(control, words, control.reached(axes))
    elif control.motion in CYCLES and (begins or words.keys() & set("XYZRPQKL")):
        cycle(control, words, axes)


def begun(control: Control, codes: list[float]) -> bool:
    """Take the motion of a block; return whether it begins a cycle."""
    for code in codes:
        if code in CYCLES and control.motion not in CYCLES:
            normal = "XYZ".index(AXES[control.plane][2])
            control.hole = {"from": control.at[normal] - control.zero(normal)}
        control.motion = int(code) if code in (0, 1, 2, 3, 80, *CYCLES) else control.motion
    return bool(set(codes) & set(CYCLES))


def shift(control: Control, words: dict[str, float], axes: dict[str, float], local: bool) -> None:
    """Set the zero of a work offset, or shift all of them."""
    for axis, value in axes.items():
        k = "XYZ".index(axis)
        if local:
            control.local[k] = value
        else:
            zero = control.zeros[int(words["P"])]
            zero[k] = value + (zero[k] if control.steps else 0.0)


def arc(control: Control, words: dict[str, float], end: list[float]) -> None:
    """Go along an arc."""
    first, second, _ = AXES[control.plane]
    i, j = "XYZ".index(first), "XYZ".index(second)
    z, e = complex(control.at[i], control.at[j]), complex(end[i], end[j])
    sense = 1 if control.motion == 3 else -1
    if "R" in words:
        radius, chord = words["R"] * control.unit, e - z
        height = math.sqrt(max(radius**2 - abs(chord) ** 2 / 4, 0.0))
        centre = z + chord / 2 + 1j * sense * math.copysign(height, radius) * chord / abs(chord)
    else:
        given = (words.get(CENTRES[axis], 0.0) for axis in (first, second))
        centre = z + complex(*given) * control.unit
    control.go(control.motion, end, (control.plane, centre, swept(z, e, centre, sense)))


def swept(z: complex, e: complex, centre: complex, sense: int) -> float:
    """Return the angle of an arc, rad; a whole turn where it ends where it began."""
    if abs(e - z) < 2e-3:
        return math.tau
    return sense * (cmath.phase(e - centre) - cmath.phase(z - centre)) % math.tau


def cycle(control: Control, words: dict[str, float], axes: dict[str, float]) -> None:
    """Drill the holes of a block of a Fanuc or a Haas."""
    first, second, normal = AXES[control.plane]
    k, hole = "XYZ".index(normal), control.hole
    hole |= {"Q": words["Q"] * control.unit} if "Q" in words else {}
    hole |= {"P": words["P"] / 1000} if "P" in words else {}
    if "R" in words:
        hole["R"] = words["R"] * control.unit + (hole["from"] if control.steps else 0.0)
    if normal in axes:
        hole["Z"] = axes[normal] + (hole["R"] if control.steps else 0.0)
    count = int(words.get("K" if control.name == "fanuc" else "L", 1))
    if not (axes or "R" in words):
        return
    for _ in range(count):
        control.go(
            0, control.reached({axis: axes[axis] for axis in (first, second) if axis in axes})
        )
        for code, level in levels(
            control.motion, hole, hole["from" if control.back == 98 else "R"]
        ):
            if code == 4:
                control.out.append(f"dwell {level:.6g}")
                continue
            end = list(control.at)
            end[k] = level + control.zero(k)
            control.go(code, end)


def levels(code: int, hole: dict[str, float], back: float) -> list[tuple[int, float]]:
    """Return the steps of a hole: rapids 0 and feeds 1 to levels, and 4 with its seconds."""
    top, bottom = hole["R"], hole["Z"]
    wait = [(4, hole["P"])] if code in (82, 89) else []
    out = [(1, top)] if code in (85, 89) else []
    if code not in (73, 83):
        return [(0, top), (1, bottom), *wait, *out, (0, back)]
    steps, depth = [(0, top)], top
    while depth > bottom:
        if depth < top:
            steps += [(0, top), (0, depth + CLEAR)] if code == 83 else [(0, depth + BREAK)]
        depth = max(depth - hole["Q"], bottom)
        steps.append((1, depth))
    return [*steps, (0, back)]


def differs(one: list[Move | str], other: list[Move | str]) -> tuple[object, object] | None:
    """Return the first two things that are not the same; None if all are."""
    for a, b in zip(one, other, strict=False):
        if isinstance(a, str) or isinstance(b, str):
            if a != b:
                return a, b
        elif not same(a, b):
            return a, b
    return None if len(one) == len(other) else (len(one), len(other))


def same(a: Move, b: Move) -> bool:
    """Whether two moves are the same to the decimals that programs are written in."""
    if (a.code, a.arc is None, a.feed is None) != (b.code, b.arc is None, b.feed is None):
        return False
    if a.feed and b.feed:
        coarse = 0.001 if a.feed[0] == 95 else 0.02 * max(a.feed[1], 0.5)
        if a.feed[0] != b.feed[0] or abs(a.feed[1] - b.feed[1]) > coarse:
            return False
    if a.arc and b.arc:
        turned = abs(a.arc[2] - b.arc[2]) > 0.01 or abs(a.arc[1] - b.arc[1]) > 0.02
        if turned or a.arc[0] != b.arc[0]:
            return False
    return math.dist(a.end, b.end) <= 4e-3
