"""Free contours (FK): drawn first, then said by their data, and solved again.

The well-known contour of the manuals and its junctions are those of
`../shared/reference/klartext.md`, section 6. A random contour is drawn from points, directions and
circles; what is said of it is chosen from its data, and the ends that are found have to be its own.
"""

from __future__ import annotations

import cmath
import math
from random import Random

import numpy as np
import pytest
from gcxform_plugins.passes.absolute import Absolute
from gcxform_plugins.passes.cutter_comp.cutter_comp import Corners, CutterComp
from heidenhain_kit import DIALECT, program, read
from seeds_kit import LONG, some

import gcxform as gx
from gcxform.machine.machine import Tool
from gcxform.modal.state import Reading
from gcxform.pipeline.pipeline import Pipeline
from gcxform.plugin.registry import default_registry

ISO = default_registry().dialect("linuxcnc")
START = {"X": 0.0, "Y": 0.0, "Z": 0.0}


def solved(*lines, start="L X+0 Y+0 F100"):
    return read(program(start, *lines), start=START)


def ends(*lines, start="L X+0 Y+0 F100"):
    return [complex(*end) for end in solved(*lines, start=start).end[1:, :2]]


PLATE = (
    "FC DR- R18 CLSD+ CCX+20 CCY+30",
    "FLT",
    "FCT DR- R15 CCX+50 CCY+75 ; the top",
    "FLT",
    "FCT DR- R15 CCX+75 CCY+20",
    "FLT",
    "FCT DR- R18 CLSD- CCX+20 CCY+30",
)
JUNCTIONS = (
    *(5.6 + 40.8j, 38 + 84j, 63.6555 + 81.2070j, 88.6555 + 26.2070j, 73.1126 + 5.1192j),
    *(17.7351 + 12.1431j, 2 + 30j),
)


def test_the_contour_of_the_manual():
    path = solved(*PLATE, start="L X+2 Y+30 F100")
    assert [complex(*end) for end in path.end[1:, :2]] == pytest.approx(JUNCTIONS, abs=1e-4)
    assert path.kind[1:].tolist() == [2, 1, 2, 1, 2, 1, 2]
    assert np.abs(path.centre[1, :2] - (20, 30)).max() < 1e-9


@pytest.mark.parametrize(
    ("lines", "wanted"),
    [
        (["FL AN+90 LEN5"], [5j]),
        (["FL X+3 IY+4 LEN5"], [3 + 4j]),
        (["FL AN+45 X+3", "FLT Y+7"], [3 + 3j, 7 + 7j]),
        (["FL AN+0 LEN10", "FCT DR+ R5 CCA90", "FLT LEN3"], [10, 15 + 5j, 15 + 8j]),
        (["FC DR- CCX+0 CCY-5 CCA90", "FCT X+10 Y-5"], [5 - 5j, 10 - 5j]),
        (["FC DR+ AN+0 R5 X+0 Y+10"], [10j]),
        (["FC DR+ AN+0 R5 CCA360"], [0j]),
        (["FL AN+0", "FCT DR+ R5", "FLT AN+90 X+20 Y+30"], [15, 20 + 5j, 20 + 30j]),
        (["FL AN+0", "FCT DR+ R5 CCX+10 CCY+5 CCA90"], [10, 15 + 5j]),
        (["FPOL X+1 Y+1", "FL AN+0 LEN2"], [2]),
        (["FC DR- CCX+0 CCY-5", "FLT X+5 Y-20"], [5 - 5j, 5 - 20j]),
    ],
)
def test_elements_with_one_solution(lines, wanted):
    assert ends(*lines) == pytest.approx(wanted, abs=1e-7)


@pytest.mark.parametrize(
    ("lines", "why"),
    [
        (["FL LEN25 X+20"], "two solutions"),
        (["FL AN+0"], "whose end no row"),
        (["FL AN+0", "L X+5"], "whose end no row"),
        (["L Z+5", "FLT LEN5"], "no direction"),
        (["FC R10 DR+ X+5 Y+5"], "two solutions"),
        (["FL AN+0 LEN5", "FCT R5 DR+ X+8"], "one coordinate or a chord"),
        (["FC DR+ CCX+5 CCY+0 X+5 Y+6"], "not as far"),
        (["FC CCX+5 CCY+0 CCA90"], "without DR"),
        (["FL AN+90 X+5"], "does not come to"),
        (["FL AN+0 X-5"], "does not come to"),
        (["FL X+3 Y+4 LEN6"], "LEN that"),
        (["FL X+3 Y+4 AN+10"], "AN that"),
        (["FC DR+ AN+0 R5 X+0 Y+10 CCA90"], "CCA that"),
        (["FL AN+0 LEN5", "FLT X+8 Y+1"], "leaves the direction"),
        (["FL AN+0 LEN5", "FCT DR- X+8 Y+3"], "against its DR"),
        (["FL PR+5 PA+30"], "PR in a free contour"),
        (["FL AN+0 LEN5 FSELECT2"], "FSELECT in a free"),
        (["FL AN+0 LEN5 P1X+5"], "P1X in a free"),
        (["FL RX+5 3 Y+6"], "RX in a free"),
        (["FL X+5 Y+5", "FSELECT1"], "not resolved|does not fit"),
        (["FL X+Q1 Y+3"], "two solutions"),
        (["FL X+5 Y+5 FMAX"], "FL with FMAX"),
        (["FL X+5 Y+5", "RND R1", "L X+9"], "a corner at"),
        (["FL X+5 Y+5", "CC X+1 Y+1", "FC DR+ CCX+0 CCY+5 X+5 Y+5"], "ends where it begins"),
        (["FL X+5 Y+5", "C X+1 Y+1 DR+"], "needs a CC"),
        (["FC DR- CCX+0 CCY-5", "FLT", "FCT DR- R50 CCX+1 CCY-5"], "no line touches"),
        (["FL X+1 CLSD-"], "without a CLSD"),
        (["FL X+1 X+2 Y+3"], "twice"),
        (["TOOL CALL 1 Z", "L X+5 Y+1 RL", "FL AN+0 LEN5 R0"], "the side changes in lines"),
        (["FL X+1 Y+2 RR"], "the side changes in lines"),
        (["FL X+1 Y+2 R5"], "data of an arc"),
        (["FL X+1 Y+2 DR+"], "data of an arc"),
        (["FC DR- CCX+0 CCY-5 CLSD+", "FLT CLSD-", "FCT DR- R5 CCX+9 CCY-5 CCA10"], "with CLSD"),
        (["FC DR- CCX+0 CCY-5", "FLT IX+5 IY-20"], "steps from where"),
    ],
)
def test_what_has_more_solutions_or_none_is_refused(lines, why):
    with pytest.raises(gx.InputError, match=why):
        ends(*lines)


def test_data_agree_to_as_much_in_inches():
    line = "FL X+3 Y+4 LEN5.01"
    assert ends(line) == [3 + 4j]
    with pytest.raises(gx.InputError, match="LEN that"):
        read(program("L X+0 Y+0 F100", line, unit="INCH"), start=START)


def test_a_free_contour_stays_to_the_same_control():
    text = program("L X+2 Y+30 F100", *PLATE, "L X+1 Y+1 R0 F100", "L IX+5")
    made = Pipeline(DIALECT, DIALECT, (Absolute(),), Reading(START)).run(text.encode())
    assert made.text.decode() == text.replace("L IX+5", "L X+6")


def test_the_ways_on_to_it_and_off_it():
    tools = {1: Tool(length=0.0, radius=2.0)}
    lines = ("TOOL CALL 1 Z", "L X-40 Y+30 Z+5 R0 FMAX", "APPR CT X+2 Y+30 CCA90 R+5 RL F250")
    text = program(*lines, *PLATE, "DEP CT CCA90 R+5", "L X-40 Y+0 FMAX").encode()
    passes = Absolute(), CutterComp(corners=Corners.ARC)
    made = Pipeline(DIALECT, ISO, passes, Reading({}, tools=tools)).run(text)
    path = gx.read(made.text, ISO, tools=tools).path
    found = [complex(*end) for end in path.end[:, :2]]
    assert found[2] == pytest.approx(0 + 30j, abs=1e-3)  # 2 mm outside of the first point
    assert found[1] == pytest.approx(-5 + 25j, abs=1e-3)  # a quarter about -5, 30
    for end, wanted in zip(found[3:9], JUNCTIONS, strict=False):
        assert abs(end - wanted) == pytest.approx(2, abs=1e-3)


def said(value):
    return f"{value:+.7f}"


class Drawn:
    """Draws a contour: `lines` say it, `points` are its ends."""

    def __init__(self, seed):
        self.draw = Random(seed)
        self.at = complex(self.draw.uniform(-50, 50), self.draw.uniform(-50, 50))
        self.first = f"L X{said(self.at.real)} Y{said(self.at.imag)} F100"
        self.along = None
        self.lines, self.points = [], []

    def take(self, line, to, along):
        self.lines.append(line)
        self.points.append(to)
        self.at, self.along = to, along

    def line(self):
        angle, size = self.draw.uniform(-180, 180), self.draw.uniform(1, 40)
        tangential = self.along is not None and self.draw.random() < 0.4
        along = self.along if tangential else cmath.rect(1, math.radians(angle))
        to = self.at + size * along
        words = [f"X{said(to.real)} Y{said(to.imag)}", f"LEN{size:.7f}"]
        if abs(along.real) > 0.2:
            words.append(f"X{said(to.real)}")
        name = "FLT" if tangential else f"FL AN{said(angle)}"
        self.take(f"{name} {self.draw.choice(words)}", to, along)

    def arc(self):
        radius, turn = self.draw.uniform(2, 30), self.draw.uniform(10, 350)
        left, sense = self.draw.choice(((1, "DR+"), (-1, "DR-")))
        tangential = self.along is not None and self.draw.random() < 0.5
        angle = self.draw.uniform(-180, 180)
        along = self.along if tangential else cmath.rect(1, math.radians(angle))
        centre = self.at + left * radius * 1j * along
        to = centre + (self.at - centre) * cmath.rect(1, left * math.radians(turn))
        at, c = (
            f"X{said(to.real)} Y{said(to.imag)}",
            f"CCX{said(centre.real)} CCY{said(centre.imag)}",
        )
        ways = [f"{c} CCA{turn:.7f}", f"{c} R{radius:.7f} {at}"]
        if tangential:
            ways += [f"R{radius:.7f} CCA{turn:.7f}", at]
        else:
            ways.append(f"AN{said(angle)} R{radius:.7f} CCA{turn:.7f}")
        words = [sense, *self.draw.choice(ways).split()]
        self.draw.shuffle(words)
        self.take(
            f"{'FCT' if tangential else 'FC'} {' '.join(words)}",
            to,
            left * 1j * (to - centre) / radius,
        )

    def belt(self):
        """Draw an arc, a line off it, and an arc that the line goes into, all by their centres."""
        before = self.at, self.along
        self.arc()
        while "CCX" not in self.lines[-1]:
            del self.lines[-1], self.points[-1]
            self.at, self.along = before
            self.arc()
        words = [w for w in self.lines[-1].split() if w[0] not in "XY" and w[:3] != "CCA"]
        self.lines[-1] = " ".join(words)
        size, radius = self.draw.uniform(1, 40), self.draw.uniform(2, 30)
        left, sense = self.draw.choice(((1, "DR+"), (-1, "DR-")))
        middle = self.at + size * self.along
        centre = middle + left * radius * 1j * self.along
        self.take("FLT", middle, self.along)
        turn = self.draw.uniform(10, 350)
        to = centre + (middle - centre) * cmath.rect(1, left * math.radians(turn))
        c = f"CCX{said(centre.real)} CCY{said(centre.imag)} R{radius:.7f}"
        self.take(
            f"FCT {sense} {c} X{said(to.real)} Y{said(to.imag)}",
            to,
            left * 1j * (to - centre) / radius,
        )


@pytest.mark.parametrize("seed", some(60 if not LONG else 20_000))
def test_what_is_said_of_a_drawn_contour_leads_along_it(seed):
    drawn = Drawn(seed)
    for _ in range(drawn.draw.randint(1, 6)):
        drawn.draw.choice((drawn.line, drawn.arc, drawn.arc, drawn.belt))()
    found = ends(*drawn.lines, start=drawn.first)
    assert found == pytest.approx(drawn.points, abs=1e-3), drawn.lines
