"""A Fagor 8065 read one line after the other, by itself: no code is shared with the package.

It knows what the programs of `tests/test_fagor.py` have, and nothing else. Lengths in mm.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field

WORD = re.compile(r"\s*([A-Z])\s*=?\s*([+-]?(?:\d+\.?\d*|\.\d+))(I(?!\s*[-+.\d=]))?")
PLANES = {17: "XYZ", 18: "ZXY", 19: "YZX"}


@dataclass
class Move:
    """One move: its end by axis, None where it is not known; centre and turn (rad) of an arc."""

    line: int
    kind: str
    end: dict[str, float | None]
    feed: float | None
    centre: dict[str, float] = field(default_factory=dict)
    sweep: float = 0.0
    following: bool | None = None
    length: str = ""


class Control:
    """What is in force."""

    def __init__(self) -> None:
        self.at: dict[str, float | None] = dict.fromkeys("XYZABC", 0.0)
        self.kind, self.plane, self.unit = 1, 17, 1.0
        self.incremental = False
        self.feed: float | None = None
        self.following: bool | None = None
        self.tool = self.loaded = self.length = self.edge = ""
        self.moves: list[Move] = []

    def line(self, number: int, text: str) -> bool:
        """Execute a line; return whether the program goes on."""
        text = re.sub(r"\([^)]*\)?|;.*", "", text.upper())
        text = re.sub(r"^\s*(%.*|\[\w+\])", "", text)
        text = re.sub(r"^\s*(N\d+):?", "", text).strip()
        if text.startswith("#"):
            if text.split()[0] == "#RTCP":
                self.following = text.split()[1] == "ON"
            return True
        words, rest = [], text
        while rest.strip():
            found = WORD.match(rest)
            if found is None:
                raise ValueError(f"{number}: {rest!r}")
            words.append((found[1], float(found[2]), bool(found[3])))
            rest = rest[found.end() :]
        return self.block(number, words)

    def block(self, number: int, words: list[tuple[str, float, bool]]) -> bool:
        """Execute a block of words."""
        codes = [value for name, value, _ in words if name == "G"]
        given = {name: (value, marked) for name, value, marked in words if name not in "GM"}
        if 4 in codes:
            return True
        for code in codes:
            self.code(code)
        if "F" in given:
            self.feed = given["F"][0] * self.unit
        self.change(given, [value for name, value, _ in words if name == "M"])
        axes = {name: given[name] for name in given if name in self.at}
        centre = {name: given[name][0] * self.unit for name in "IJKR" if name in given}
        if axes or centre:
            self.move(number, axes, centre, 6 in codes)
        return not any(name == "M" and value in (2, 30) for name, value, _ in words)

    def code(self, code: float) -> None:
        """Take a code into account."""
        if code in (0, 1, 2, 3):
            self.kind = int(code)
        elif code in PLANES:
            self.plane = int(code)
        elif code in (90, 91):
            self.incremental = code == 91
        elif code in (70, 71):
            self.unit, self.feed = (25.4 if code == 70 else 1.0), None

    def change(self, given: dict[str, tuple[float, bool]], m: list[float]) -> None:
        """Take tools and lengths into account."""
        if "T" in given:
            self.tool, self.edge = f"{given['T'][0]:g}", ""
        if "D" in given:
            self.edge = f"{given['D'][0]:g}"
        if 6 in m:
            self.loaded, self.tool = self.tool, ""
            self.at = dict.fromkeys(self.at)
        if self.edge and not self.tool:
            self.length = f"H{self.loaded}" if self.edge != "0" else ""

    def move(
        self,
        number: int,
        axes: dict[str, tuple[float, bool]],
        centre: dict[str, float],
        absolute: bool,
    ) -> None:
        """Move the axes."""
        start, end = dict(self.at), dict(self.at)
        for name, (value, marked) in axes.items():
            value *= self.unit if name in "XYZ" else 1.0
            before = start[name]
            further = marked or self.incremental
            end[name] = None if further and before is None else value + (before or 0) * further
        self.at = end
        kind = ("rapid", "line", "cw", "ccw")[self.kind]
        move = Move(number, kind, end, None if self.kind == 0 else self.feed)
        if self.kind in (2, 3):
            self.arc(move, start, centre, absolute)
        move.following, move.length = self.following, self.length
        self.moves.append(move)

    def arc(
        self, move: Move, start: dict[str, float | None], centre: dict[str, float], absolute: bool
    ) -> None:
        """Find centre and turn of an arc."""
        u, v, _ = PLANES[self.plane]
        sense = 1 if move.kind == "ccw" else -1
        su, sv, eu, ev = (float(p[n] or 0) for p in (start, move.end) for n in (u, v))
        if "R" in centre:
            half = math.dist((su, sv), (eu, ev)) / 2
            rise = math.sqrt(max(centre["R"] ** 2 - half**2, 0.0))
            rise *= sense * math.copysign(1, centre["R"])
            cu = (su + eu) / 2 - (ev - sv) / (2 * half) * rise
            cv = (sv + ev) / 2 + (eu - su) / (2 * half) * rise
        else:
            letters = {"X": "I", "Y": "J", "Z": "K"}
            cu = centre.get(letters[u], 0.0) + (0.0 if absolute else su)
            cv = centre.get(letters[v], 0.0) + (0.0 if absolute else sv)
        turn = sense * (math.atan2(ev - cv, eu - cu) - math.atan2(sv - cv, su - cu))
        turn %= 2 * math.pi
        if math.dist((su, sv), (eu, ev)) < 1e-9:
            turn = 2 * math.pi
        move.centre, move.sweep = {u: cu, v: cv}, turn


def read(text: str) -> list[Move]:
    """Return the moves of a program."""
    control = Control()
    for number, line in enumerate(re.split(r"\r\n|\n|\r", text), 1):
        if not control.line(number, line):
            break
    return control.moves
