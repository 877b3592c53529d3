"""Lines that are translated at once are what each of them is by itself."""

from __future__ import annotations

from random import Random
from time import process_time

import pytest
from gcxform_plugins.dialects.heidenhain.runs import Runs
from heidenhain_kit import DIALECT, TOOLS
from seeds_kit import LONG, some

from gcxform.diagnostics import InputError
from gcxform.flow.translated import translated
from gcxform.modal.state import Reading
from gcxform.syntax.source import Source

START = {"X": 0.0, "Y": 0.0, "Z": 5.0}
BETWEEN = (
    *("L IX+1 Y+2", "CC X+0 Y+0", "CC IX+3 IY+4", "C X+3 Y+4 DR+", "L X+3 R0", "L Y+2,5 FMAX"),
    *("L X+1 Y+1 RL F200", "L Y+3 R0", "L X+0 FMAX M3", "TOOL CALL 2 Z S500", "l x+1 y+2", "STOP"),
    *(
        "M128",
        "L X+1 ; note 5",
        "L  X+1",
        "CT X+5 Y+5",
        "CC X+1",
        "C X+1 DR+",
        "CC Y+1 Z+2",
        "C Y+1 Z+2 DR+",
        "CR X+1 Y+1 R+5 DR-",
        "L X +1",
        "LBL 0",
        "L X+1 X+2",
        "L X+1.Y2",
        "Q1 = 5",
    ),
    *("L X+Q1", "L X-+5", "L A+5 X+1", "L X+1 F0", "L Z+3 R00", "LP PR+4 PA+30", "L F300", "L"),
    *(
        "CYCL DEF 7.1 X+5",
        "L X+1234567890123456789012",
        "/L X+3",
        "L IZ-1 FMAX",
        "RND R2",
        "L X+1.",
    ),
)
SHAPES = (
    *("CC XV YV", "C XV YV DR+", "C XV YV DR-", "C XV YV DR- FV", "CC XV YV", "C XV YV DR+"),
    *("L XV YV", "L XV", "L XV YV ZV", "L XV YV FMAX", "L ZV R0 FMAX", "L YV FV", "L XV R0 FV"),
)


def drawn(seed):
    """Return a program: runs of few shapes, and between them what may change what they mean."""
    draw, lines = Random(seed), []
    for _ in range(draw.randint(1, 6)):
        shapes = draw.sample(SHAPES, draw.randint(1, 4))
        for _ in range(draw.randint(1, 12)):
            line = draw.choice(shapes)
            while "V" in line:
                digits = draw.choice(("0", "7", "12.5", "3.", "0.0004", "123456.789"))
                signs = ("",) if line.startswith("FV", line.index("V") - 1) else ("+", "-", "")
                line = line.replace("V", draw.choice(signs) + digits, 1)
            lines.append(line)
        lines += draw.choices(BETWEEN, k=draw.randint(0, 2))
    numbers = draw.choice((True, True, False))
    unit = draw.choice(("MM", "MM", "INCH"))
    lines = [f"BEGIN PGM A {unit}", "L Z+5 F100", *lines, f"END PGM A {unit}"]
    return "".join(f"{k} {line}\n" if numbers else f"{line}\n" for k, line in enumerate(lines))


def result(text, stays):
    source = Source.of_bytes(text.encode("latin-1"), "a.h")
    try:
        found = translated(source, DIALECT, Reading(START, stays=stays, tools=TOOLS))
    except InputError as error:
        return str(error)
    state = found.translator
    known = state.place, state.moved, state.feed, state.polar, state.motion, state.lost
    known += state.pole, state.last, state.plane
    return found.text, found.origin.tolist(), len(set(found.visits.tolist())), known


@pytest.mark.parametrize("seed", some(60 if not LONG else 20_000))
def test_runs_are_their_lines(seed, monkeypatch):
    text = drawn(seed)
    at_once = [result(text, stays) for stays in (False, True)]
    monkeypatch.setattr(Runs, "several", lambda self: [])
    assert at_once == [result(text, stays) for stays in (False, True)], text


def test_there_are_runs(monkeypatch):
    taken = []
    several = Runs.several
    monkeypatch.setattr(Runs, "several", lambda self: taken.append(several(self)) or taken[-1])
    for seed in range(20):
        result(drawn(seed), False)
    assert sum(map(len, taken)) > 30


def test_a_run_with_r0_leaves_the_contour():
    lines = ["L X+1 Y+1 RL F200", *(f"L X+{k} R0" for k in range(8))]
    text = "".join(f"{line}\n" for line in ("BEGIN PGM A MM", "TOOL CALL 1 Z", *lines, "M2"))
    found = result(text, False)
    assert isinstance(found, tuple), found
    assert b"G40 X0\n" in found[0]


def test_r_of_a_line_is_r0_where_it_says_so():
    lines = [
        "CC X+0 Y+0",
        "L X+1 R0 F200",
        "L Y+1 R0 F200",
        "CC X+0 Y+0",
        "L X+1 R5 F200",
        "L X+2 R0 F9",
    ]
    text = "".join(f"{line}\n" for line in ("BEGIN PGM A MM", *lines, "M2"))
    assert "a.h:6:1: error[GX203]" in result(text, False)


def test_a_run_of_lines_and_circles_ends_where_they_lead():
    turn = ["L X+5 Y+0 F200", "CC X+0 Y+0", "C X+0 Y+5 DR+", "L Z+1", "L IX+1"]
    text = "".join(f"{line}\n" for line in ("BEGIN PGM A MM", *turn, "M2"))
    found = result(text, False)
    assert isinstance(found, tuple), found
    assert found[0].decode().split("\n")[1:5] == ["G1 X5 Y0 F200", "G3 X0 Y5 I-5 J0", "G1 Z1", "X1"]


def test_a_run_of_lines_ends_where_they_lead():
    lines = ["L F9", "L X+1", "L Y+1", "STOP", "L X+2", "L Y+3", "L X+2", "L X+9", "L IY+1"]
    text = "".join(f"{line}\n" for line in ("BEGIN PGM A MM", *lines, "M2"))
    found = result(text, False)
    assert isinstance(found, tuple), found
    assert found[0].endswith(b"X9\nY4\nM2\n")


def test_a_run_that_is_repeated_ends_where_it_ended(monkeypatch):
    run, other = [f"L X+{k}" for k in range(5)], [f"L Y+{k}" for k in range(6)]
    lines = ["L F9", "LBL 1", *run, "STOP", *other, "CALL LBL 1 REP 2"]
    text = "".join(f"{line}\n" for line in ("BEGIN PGM A MM", *lines, "M2"))
    at_once = result(text, False)
    monkeypatch.setattr(Runs, "several", lambda self: [])
    assert at_once == result(text, False)


@pytest.mark.parametrize("line", ["L X+{} F200", "CC X+{} Y+0\nC X+{} Y+0 DR+ F200"])
def test_what_ends_a_run_is_not_looked_for_again_in_every_line(line):
    """Eight times the lines of a program in inches with F in each take some eight times as long."""
    taken = []
    for count in (1_000, 1_000, 8_000):
        lines = "".join(line.replace("{}", str(k % 97)) + "\n" for k in range(count))
        began = process_time()
        result(f"BEGIN PGM A INCH\nL X+1 Y+1 F9\n{lines}END PGM A INCH\n", False)
        taken.append(process_time() - began)
    assert taken[2] < 24 * taken[1]
