"""What programs do is the same on both sides of a translation, by interpreters of our own.

An interpreter of four controls that shares nothing with the package: it executes words in order
and notes moves in machine coordinates, dwells in seconds, M codes and zeros, each beside what came
before it. Random programs of one control are written for the others, and what is written has to do
the same. M codes that follow one another have no order.
"""

from __future__ import annotations

import random
import re

import pytest
from seeds_kit import some

import gcxform as gx
from gcxform.modal.state import Reading
from gcxform.plugin.registry import default_registry

DIALECTS = default_registry().dialects
NAMES = ("fanuc", "grbl", "haas", "linuxcnc")
HOME = {"X": 240.0, "Y": 330.0, "Z": 450.0}
ZEROS = {
    "G54": {"X": 10.0, "Y": 20.0, "Z": 100.0},
    "G55": {"X": -5.0, "Y": 7.0, "Z": 90.0},
}
READING = Reading(
    {"X": 0.0, "Y": 0.0, "Z": 50.0},
    homes={"G28": HOME},
    work_offsets=ZEROS,
    control={"peck-clearance": "1 mm"},
)
BEHIND = {"fanuc": {0, 5, 9}, "haas": {0, 5, 9}, "linuxcnc": {0}, "grbl": {0}}
"""M codes that act behind the motion of their block."""
WORD = re.compile(r"([A-Z])([-+]?[\d.]+)")


class Control:
    """Executes blocks of one of the controls."""

    def __init__(self, name):
        self.name = name
        self.at = {a: v + ZEROS["G54"][a] for a, v in READING.start.items()}
        self.shift = dict.fromkeys("XYZ", 0.0)
        self.work, self.motion, self.cycle, self.feed = "G54", 0.0, 0.0, 0.0
        self.absolute, self.to_start = True, name != "linuxcnc"
        self.levels, self.began, self.done = {}, None, []

    def run(self, text):
        for raw in text.split("\n"):
            block = re.sub(r"\([^)]*\)", "", raw).strip()
            if block and block != "%":
                self.block(block)
        return self.done

    def block(self, block):
        words = WORD.findall(block)
        codes = [float(number) for letter, number in words if letter == "G"]
        stops = sorted(int(number) for letter, number in words if letter == "M")
        named = {letter: number for letter, number in words if letter not in "GMN"}
        for code in codes:
            self.mode(code)
        self.feed = float(named.get("F", self.feed))
        self.done += [("M", m) for m in stops if m not in BEHIND[self.name] and m not in (2, 30)]
        self.act(codes, named)
        self.done += [("M", m) for m in stops if m in BEHIND[self.name]]

    def mode(self, code):
        if code in (90, 91):
            self.absolute = code == 90
        elif code in (54, 55):
            self.work = f"G{code:.0f}"
        elif code in (98, 99):
            self.to_start = code == 98
        elif code in (0, 1):
            self.motion, self.cycle = code, 0.0
        elif code in (80, 81, 82):
            self.cycle, self.began = code % 80, None

    def act(self, codes, named):
        axes = {a: float(named[a]) for a in "XYZ" if a in named}
        if 4 in codes:
            self.done.append(("dwell", self.seconds(named)))
        elif 92 in codes:
            for axis, value in axes.items():
                self.shift[axis] += self.at[axis] - self.zero(axis) - value
        elif 28 in codes:
            self.go(0, {a: self.told(a, v) for a, v in axes.items()})
            self.go(0, {a: HOME[a] for a in axes or HOME})
        elif 53 in codes:
            self.go(self.motion, axes)
        elif self.cycle and axes:
            self.drill(named, axes)
        elif axes:
            self.go(self.motion, {a: self.told(a, v) for a, v in axes.items()})

    def seconds(self, named):
        if "X" in named:
            return float(named["X"])
        in_ms = self.name == "fanuc" or (self.name == "haas" and "." not in named["P"])
        return round(float(named["P"]) * (1e-3 if in_ms else 1.0), 6)

    def zero(self, axis):
        return ZEROS[self.work][axis] + self.shift[axis]

    def told(self, axis, value):
        return value + (self.zero(axis) if self.absolute else self.at[axis])

    def go(self, kind, to):
        end = {**self.at, **to}
        if end != self.at or kind:
            place = tuple(round(end[a], 3) for a in "XYZ")
            self.done.append(("move", kind, *place, self.feed if kind else 0.0))
        self.at = end

    def drill(self, named, axes):
        self.began = self.at["Z"] if self.began is None else self.began
        for letter in "RZ":
            if letter in named:
                self.levels[letter] = self.zero("Z") + float(named[letter])
        self.levels["P"] = named.get("P", self.levels.get("P", "0"))
        self.go(0, {a: self.told(a, v) for a, v in axes.items() if a != "Z"})
        self.go(0, {"Z": self.levels["R"]})
        self.go(1, {"Z": self.levels["Z"]})
        if self.cycle == 2:
            self.done.append(("dwell", self.seconds({"P": self.levels["P"]})))
        self.go(0, {"Z": self.began if self.to_start else self.levels["R"]})


def number(draw):
    return f"{draw.randint(-5000, 5000) / 100:.2f}"


def dwell(draw, name):
    words = {"fanuc": ["P500", "X1.5", "P57"], "haas": ["P500", "P1.5", "P57", "P0.25"]}
    return "G4 " + draw.choice(words.get(name, ["P0.5", "P1.25", "P2."]))


def hole(draw, name):
    wait = {"fanuc": " P500", "haas": " P500"}.get(name, " P0.5")
    code = draw.choice(["G81", "G82" + wait])
    back = draw.choice(["G98", "G99"])
    more = f"X{number(draw)}\nX{number(draw)} Y{number(draw)}"
    return f"G0 Z20.\n{back} {code} X{number(draw)} Y1. Z-3. R2. F100.\n{more}\nG80\nG0 Z25."


def program(draw, name):
    """Return a random program of a control."""
    place = lambda: f"X{number(draw)} Y{number(draw)}"  # noqa: E731
    beside = lambda: draw.choice(["", " M8", " M9", " M5", " M5 M9"])  # noqa: E731
    makers = [
        lambda: f"G{draw.randint(0, 1)} {place()} F100.{beside()}",
        lambda: f"G1 Z{draw.randint(-5, 20)}. F80.{beside()}",
        lambda: f"G91 G1 {place()} F90.{beside()}\nG90",
        lambda: dwell(draw, name),
        lambda: f"G91 G28 {draw.choice(['Z0.', 'X0. Y0.'])}{beside()}\nG90\nG0 {place()} Z9.",
        lambda: f"G0 G53 Z{draw.randint(100, 300)}.\nG0 Z20.",
        lambda: f"{draw.choice(['G54', 'G55'])}\nG0 {place()} Z{draw.randint(5, 30)}.",
        lambda: draw.choice(["M8", "M9", "M0", "S100 M3", "M5"]),
        lambda: f"G0 {place()} Z20.\nG92 {place()}" if name != "haas" else "M8",
        lambda: hole(draw, name) if name != "grbl" else "M9",
    ]
    blocks = [draw.choice(makers)() for _ in range(draw.randint(3, 12))]
    head = ["G21 G90 G94 G17 G54", "G0 X1. Y2. Z30."]
    return "\n".join([*head, *blocks, "M30"]) + "\n"


def sorted_stops(done):
    """Return what was done, with M codes that follow one another in order of their numbers."""
    found, run = [], []
    for each in [*done, ("end",)]:
        if each[0] == "M":
            run.append(each)
        else:
            found += [*sorted(run), each]
            run = []
    return found


@pytest.mark.parametrize("seed", some(24))
def test_both_sides_do_the_same(seed):
    draw = random.Random(seed)
    source = draw.choice(NAMES)
    text = program(draw, source)
    wanted = sorted_stops(Control(source).run(text))
    for target in NAMES:
        if target == source:
            continue
        pipeline = gx.Pipeline(DIALECTS[source], DIALECTS[target], (), READING)
        try:
            written = pipeline.run(text.encode()).text.decode()
        except gx.InputError:
            continue
        assert sorted_stops(Control(target).run(written)) == wanted, f"{text}\n{written}"
