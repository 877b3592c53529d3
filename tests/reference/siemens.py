"""A SINUMERIK 840D read one line after the other, by regular expressions and floats.

It shares no code with the package, and knows only programs that are right.
"""

import math
import re
from dataclasses import dataclass, field

PLANES = {17: "XY", 18: "ZX", 19: "YZ"}
CENTRES = {"X": "I", "Y": "J", "Z": "K"}
NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)"
WORD = re.compile(
    rf"(CR|AR|TURN|[IJK]1(?=\s*=)|[A-Z])\s*=?\s*(?:(ACP|ACN|AC|IC|DC)\s*\(\s*)?({NUMBER})\s*\)?"
)
CALL = re.compile(r"(MCALL)?\s*CYCLE8([12])\s*\(([^)]*)\)")


@dataclass
class Move:
    """A motion: kind "0" to "3", ends by axis, and of arcs the centre and whole turns more."""

    kind: str
    end: dict[str, float]
    feed: float
    follows: bool
    centre: tuple[float, float] | None = None
    plane: str = "XY"
    turns: int = 0


@dataclass
class Control:
    """What a control keeps."""

    at: dict[str, float] = field(default_factory=dict)
    motion: str = ""
    plane: str = "XY"
    steps: bool = False
    feed: float = 0.0
    follows: bool = False
    hole: list[tuple[str, float]] = field(default_factory=list)
    moves: list[Move] = field(default_factory=list)
    seconds: list[float] = field(default_factory=list)
    edge: str = ""
    work: str = ""

    def go(self, kind: str, end: dict[str, float], **arc: object) -> None:
        """Move, and remember it."""
        self.at = {**self.at, **end}
        self.moves.append(Move(kind, dict(self.at), self.feed, self.follows, **arc))  # type: ignore[arg-type]


def read(text: str) -> Control:
    """Return what a program does."""
    control = Control()
    for raw in text.splitlines():
        one(control, raw)
    return control


def one(control: Control, raw: str) -> None:
    """Execute a line."""
    line = re.sub(r'MSG\s*\(".*?"\)', "", raw.upper().split(";")[0])
    line = re.sub(r"^\s*(N\s*\d+|:\d+)?\s*([A-Z_]{2}\w*:(?!=))?", "", line)
    call = CALL.search(line)
    if call:
        cycle(control, call)
        return
    if "MCALL" in line:
        control.hole = []
    for name in ("TRAORI(1)", "TRAORI", "TRAFOOF"):
        if name in line:
            control.follows = name != "TRAFOOF"
            return
    cip = "CIP" in line
    words = WORD.findall(re.sub(r"[A-Z_]{3,}(?![A-Z_]|\s*[=(])", " ", line.replace("CIP", " ")))
    named = {letter: (way, float(number)) for letter, way, number in words if letter not in "GM"}
    codes = {float(number) for letter, _, number in words if letter == "G"}
    if 4 in codes:
        control.seconds.append(named["F"][1])
        return
    modes(control, codes, named, cip)
    tooled(control, words, named)
    if named.keys() & {*"XYZABCIJK"}:
        move(control, named, "SUPA" in line)
        for kind, level in control.hole:
            axis = next(a for a in "XYZ" if a not in control.plane)
            control.seconds.append(level) if kind == "4" else control.go(kind, {axis: level})


def tooled(
    control: Control, words: list[tuple[str, str, str]], named: dict[str, tuple[str, float]]
) -> None:
    """Take M6 and D."""
    if 6.0 in {float(number) for letter, _, number in words if letter == "M"}:
        control.at, control.edge = {}, ""
    if "D" in named and str(named["D"][1]) != control.edge:
        control.edge = str(named["D"][1])
        for axis in "XYZ":
            control.at.pop(axis, None)


def modes(
    control: Control, codes: set[float], named: dict[str, tuple[str, float]], cip: bool
) -> None:
    """Take the codes of a line."""
    for code in codes:
        if code in (0, 1, 2, 3):
            control.motion = f"{code:g}"
        if code in PLANES:
            control.plane = PLANES[int(code)]
        if code in (90, 91):
            control.steps = code == 91
        if code in (54, 55, 56, 57, 505, 506) and f"G{code:g}" != control.work:
            if control.work or control.moves:
                control.at = {}
            control.work = f"G{code:g}"
    if cip:
        control.motion = "CIP"
    if "F" in named:
        control.feed = named["F"][1]


def cycle(control: Control, call: re.Match[str]) -> None:
    """CYCLE81 and CYCLE82, modal or not."""
    numbers = [float(part) if part.strip() else 0.0 for part in call[3].split(",")]
    numbers += [0.0] * 9
    back, level, gap, depth, relative = numbers[:5]
    bottom = depth if call[3].split(",")[3].strip() else level - relative
    hole = [("0", level + gap), ("1", bottom)]
    if call[2] == "2" and numbers[5]:
        hole.append(("4", numbers[5]))
    hole.append(("0", back))
    if call[1]:
        control.hole = hole
        return
    axis = next(a for a in "XYZ" if a not in control.plane)
    for kind, value in hole:
        control.seconds.append(value) if kind == "4" else control.go(kind, {axis: value})


def turned(before: float | None, way: str, value: float) -> float:
    """Return where a rotary axis ends."""
    if before is None:
        return value
    if way == "DC":
        return before + math.remainder(value - before, 360.0)
    up = (value - before) % 360.0
    return before + up if way == "ACP" else before + up - 360.0


def move(control: Control, named: dict[str, tuple[str, float]], machine: bool) -> None:
    """Execute a motion; in coordinates of the machine, axes are then nowhere known."""
    start, end = dict(control.at), {}
    for axis in "XYZABC":
        if axis not in named:
            continue
        way, value = named[axis]
        if way == "IC" or (not way and control.steps):
            end[axis] = start[axis] + value
        elif way in ("DC", "ACP", "ACN"):
            end[axis] = turned(start.get(axis), way, value)
        else:
            end[axis] = value
    if machine:
        control.at = {axis: at for axis, at in start.items() if axis not in end}
        end = {}
    if control.motion in ("0", "1"):
        control.go(control.motion, end)
        return
    a, b = control.plane
    s = (start[a], start[b])
    e = (end.get(a, s[0]), end.get(b, s[1]))
    if control.motion == "CIP":
        kind, centre = through(s, tuple(named[CENTRES[x] + "1"][1] for x in (a, b)), e)  # type: ignore[arg-type]
    else:
        kind = control.motion
        centre, e = centred(control, named, s, e)
    end[a], end[b] = e
    turns = int(named["TURN"][1]) if "TURN" in named else 0
    control.go(kind, end, centre=centre, plane=control.plane, turns=turns)


Point = tuple[float, float]


def through(s: Point, m: Point, e: Point) -> tuple[str, Point]:
    """Return sense and centre of an arc over a point, by complex numbers."""
    z, w, v = complex(*s), complex(*m), complex(*e)
    q = (v - z) / (w - z)
    c = (w - z) * (q - abs(q) ** 2) / (2j * q.imag) + z
    return ("3" if q.imag > 0 else "2"), (c.real, c.imag)


def centred(
    control: Control, named: dict[str, tuple[str, float]], s: Point, e: Point
) -> tuple[Point, Point]:
    """Return centre and end of an arc."""
    z, v = complex(*s), complex(*e)
    sense = 1 if control.motion == "3" else -1
    letters = [CENTRES[axis] for axis in control.plane]
    given = [named.get(letter, ("", 0.0)) for letter in letters]
    c = complex(*(n if way == "AC" else n + o for (way, n), o in zip(given, s, strict=True)))
    if "CR" in named:
        radius = named["CR"][1]
        half = (v - z) / 2
        height = math.sqrt(max(radius**2 - abs(half) ** 2, 0.0))
        c = z + half + 1j * sense * math.copysign(1, radius) * height * half / abs(half)
    if "AR" in named:
        angle = math.radians(named["AR"][1])
        turn = complex(math.cos(angle), sense * math.sin(angle))
        if any(letter in named for letter in letters):
            v = c + (z - c) * turn
        else:
            c = (v - z * turn) / (1 - turn)
    return (c.real, c.imag), (v.real, v.imag)
