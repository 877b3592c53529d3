"""Random programs of words become Klartext and words again, and are the same on the way."""

from __future__ import annotations

import math
from random import Random

import pytest
from gcxform_plugins.passes.absolute import Absolute
from gcxform_plugins.passes.segment import Segment
from heidenhain_kit import DIALECT, TOOLS
from seeds_kit import LONG, some

import gcxform as gx
from gcxform.modal.state import Reading
from gcxform.pipeline.pipeline import Pipeline
from gcxform.plugin.registry import default_registry

START = {"X": 0.0, "Y": 0.0, "Z": 50.0}
WORDS = default_registry().dialect("linuxcnc")
FUNCTIONS = ("M3 S1000", "M8", "M9", "M5", "M7", "M0", "M1", "M4 S500", "S700", "G4 P0.5")


class Writer:
    """Draws programs: `at` is where they are, in mm, `steps` whether G91 is in force."""

    def __init__(self, seed):
        self.draw = Random(seed)
        self.at = {"X": 0.0, "Y": 0.0, "Z": 5.0}
        self.steps = False

    def program(self):
        lines = ["G21 G17 G90 G94 G40", "G0 X0. Y0. Z5.", "F120."]
        kinds = [self.line, self.line, self.arc, self.arc, self.function, self.switch]
        for _ in range(self.draw.randint(3, 18)):
            kind = self.draw.choice([*kinds, *([self.tool] if self.draw.random() < 0.4 else [])])
            lines += kind()
        return "".join(f"{line}\n" for line in (*lines, self.draw.choice(("M2", "M30")))).encode()

    def words(self, ends):
        text = ""
        for axis, value in ends.items():
            by = round(value - self.at[axis], 4)
            text += f" {axis}{by if self.steps else value:.4f}"
            self.at[axis] = round(self.at[axis] + by, 4) if self.steps else value
        return text

    def number(self, size=40.0):
        return round(self.draw.uniform(-size, size), self.draw.choice((0, 1, 3, 4)))

    def line(self):
        axes = self.draw.sample("XYZ", self.draw.randint(1, 3))
        feed = self.draw.choice(("", " F250.", " F33.5"))
        code, feed = self.draw.choice((("G0", ""), ("G1", feed)))
        note = self.draw.choice(("", "", " (a; [b])"))
        return [f"{code}{self.words({axis: self.number() for axis in axes})}{feed}{note}"]

    def arc(self):
        radius, begin, end = (self.draw.uniform(*r) for r in ((1, 30), (0, 6.28), (0, 6.28)))
        by = [round(radius * f(begin), 4) for f in (math.cos, math.sin)]
        centre = [self.at[axis] + d for axis, d in zip("XY", by, strict=True)]
        size = math.hypot(*by)
        ends = {"X": round(centre[0] + size * math.cos(end), 4)}
        ends["Y"] = round(centre[1] + size * math.sin(end), 4)
        if self.draw.random() < 0.2:
            ends = {axis: self.at[axis] for axis in "XY"}
        if self.draw.random() < 0.4:
            ends["Z"] = self.number(5.0)
        turns = self.draw.choice(("", "", "", " P2", " P3"))
        return [f"{self.draw.choice(('G2', 'G3'))}{self.words(ends)} I{by[0]} J{by[1]}{turns}"]

    def function(self):
        return [self.draw.choice(FUNCTIONS)]

    def switch(self):
        self.steps = not self.steps
        return ["G91" if self.steps else "G90"]

    def tool(self):
        number, self.steps = self.draw.randint(1, 5), False
        self.at = {"X": 1.0, "Y": 2.0, "Z": 9.0}
        ahead = self.draw.choice(([], ["G90", "G53 G0 Z0."]))
        return [*ahead, f"T{number} M6", f"G43 H{number}", "G90 G0 X1. Y2. Z9."]


def read(text, dialect):
    return gx.read(text, dialect, start=START, tools=TOOLS)


@pytest.mark.parametrize("seed", some(20 if not LONG else 20_000))
def test_words_and_klartext_say_the_same(seed):
    text, reading = Writer(seed).program(), Reading(START, tools=TOOLS)
    said = Pipeline(WORDS, DIALECT, (), reading).run(text).text
    one, two = read(text, WORDS), read(said, DIALECT)
    assert gx.compare(one, two).same, text.decode()
    back = Pipeline(DIALECT, WORDS, (Absolute(),), reading).run(said).text
    assert gx.compare(two, read(back, WORDS)).same, text.decode()
    passes = Absolute(), Segment(chord_error=0.05)
    own = Pipeline(DIALECT, DIALECT, passes, Reading(START)).run(said).text
    assert gx.compare(two, read(own, DIALECT), 0.06).same, text.decode()


def test_a_full_circle_behind_a_helix_stays_one():
    text = (
        b"G21 G17 G90 G94\nG0 X1.7534 Y39.5 Z5.\nF100.\nG3 X-1.7452 Y48.3339 Z-4. I-1.7063 J4.434\n"
    )
    text += b"G3 X-1.7452 Y48.3339 I24.6399 J-8.3528\nM2\n"
    said = Pipeline(WORDS, DIALECT, (), Reading(START)).run(text).text
    assert b"CP IPA+360 DR+" in said


def test_helices_of_rounded_words_lead_to_their_places():
    """Each ends on a circle that is a little off, in inches by up to 0.0025 mm."""
    there, back = "X-2.9206 Y-1.8892 {} I-0.0884 J0.0793", "X-2.7439 Y-2.0478 {} I0.0884 J-0.0793"
    turns = [(there, back)[k % 2].format(f"Z-{k / 100:.2f}") for k in range(30)]
    head = ("G20 G17 G90 G94", "G0 X-2.7439 Y-2.0478 Z0.2", "G1 Z0.1 F10.")
    last = "X-2.7135 Y-1.9685 Z-0.31 I-0.0884 J0.0793"
    text = "\n".join((*head, f"G3 {turns[0]}", *turns[1:], last, "M2\n")).encode()
    said = Pipeline(WORDS, DIALECT, (), Reading(START)).run(text).text
    one, two = read(text, WORDS), read(said, DIALECT)
    assert gx.compare(one, two, 2e-3).same
