"""Holes of other controls become CYCL DEF 200 where its moves are theirs.

What is written is read by a reader of its own hands, line by line: cycle 200 goes in rapid to Q200
over Q203, at Q206 to Q201 below Q203, and leaves in rapid to Q204 over Q203 (TNC 640, cycles);
an F behind it counts only where it is said.
"""

from __future__ import annotations

import re
from random import Random

import pytest
from heidenhain_kit import DIALECT, TOOLS
from seeds_kit import LONG, some

import gcxform as gx
from gcxform.modal.state import Reading
from gcxform.pipeline.pipeline import Pipeline
from gcxform.plugin.registry import default_registry

WORDS = default_registry().dialect("linuxcnc")
START = {"X": 0.0, "Y": 0.0, "Z": 50.0}
HEAD = "G21 G17 G90 G94\nG0 X0. Y0. Z20.\n"


def said(blocks):
    """Return the lines that blocks become, without their numbers and the frame."""
    made = Pipeline(WORDS, DIALECT, (), Reading(START, tools=TOOLS))
    text = made.run(f"{HEAD}{blocks}\nM2\n".encode()).text.decode()
    return [re.sub(r"^\d+ ", "", line) for line in text.splitlines()][2:-1]


def bare(lines):
    """Return lines without what cycle 200 is told."""
    return [line for line in lines if not line.startswith(" ")]


class ByHand:
    """Reads lines, and keeps (kind, place, feed) of each move that goes somewhere."""

    def __init__(self):
        self.at, self.feed, self.moves, self.told = {"X": 0.0, "Y": 0.0, "Z": 20.0}, None, [], {}

    def go(self, feed, **ends):
        if any(self.at[axis] != value for axis, value in ends.items()):
            self.at = {**self.at, **ends}
            self.moves.append((feed, *(round(v, 6) for v in self.at.values())))

    def line(self, line):
        text = line.partition(";")[0]
        if parameter := re.match(r"\s+Q(\d+)=(\S+)", text):
            self.told[int(parameter[1])] = float(parameter[2])
        if text.startswith("L "):
            ends = {axis: float(value) for axis, value in re.findall(r" ([XYZ])([-+.\d]+)", text)}
            found = re.search(r" F(\d\S*)", text)
            self.feed = float(found[1]) if found else self.feed
            assert self.feed is not None or not ends or "FMAX" in text, "which feed is in force?"
            self.go("rapid" if "FMAX" in text else self.feed, **ends)
        if text.startswith("CYCL CALL") or text.rstrip().endswith(" M99"):
            q = self.told
            self.go("rapid", Z=q[203] + q[200])
            self.go(q[206], Z=q[203] + q[201])
            self.go("rapid", Z=q[203] + q[204])
            self.feed = None
            assert q[202] >= -q[201] > 0, "in one stroke"


def by_hand(lines):
    reader = ByHand()
    for line in lines:
        reader.line(line)
    return reader.moves


def moves(text):
    """Return the moves of words, as the reader of other hands has them."""
    path = gx.read(f"{HEAD}{text}\nM2\n".encode(), WORDS, start=START, tools=TOOLS).path
    found = []
    for row in range(1, len(path)):
        if (path.start[row, :3] != path.end[row, :3]).any():
            kind = "rapid" if path.kind[row] == 0 else float(path.feed[row])
            found.append((kind, *path.end[row, :3].round(6).tolist()))
    return found


def test_holes_are_cycle_200_called_by_m99():
    lines = said("M3\nG98 G81 X10. Y5. Z-5. R2. F100.\nX20.\nX30. (last)\nG80\nG1 X40.")
    assert bare(lines) == [
        *("M3", "CYCL DEF 200 DRILLING ~", "L X+10 Y+5 R0 FMAX M99", "L X+20 R0 FMAX M99"),
        *("L X+30 R0 FMAX ; last", "CYCL CALL", "L X+40 F100"),
    ]
    told = ["Q200=+1", "Q201=-6", "Q206=+100", "Q202=+6", "Q210=+0", "Q203=+1", "Q204=+19"]
    assert [line.split()[0] for line in lines if line[0] == " "] == [*told, "Q211=+0"]


def test_holes_that_leave_at_the_plane_are_reached_there():
    lines = said("G99 G82 X10. Y5. Z-5. R2. P0.5 F100.\nX20.\nG80")
    assert bare(lines)[1:] == ["L X+10 Y+5 R0 FMAX M99", "L X+20 R0 FMAX M99"]
    assert "  Q211=+0.5 ;DWELL TIME AT DEPTH" in lines


@pytest.mark.parametrize(
    "blocks",
    [
        "G83 X10. Y5. Z-15. R2. Q4. F100.",
        "G73 X10. Y5. Z-15. R2. Q4. F100.",
        "G0 Z2.\nG1 Z-5. F100.\nG1 Z2.",
        "G0 Z2.\nG1 X1. Z-5. F100.\nG0 Z2.",
        "T1 M6\nG43 H1\nG0 X0. Y0. Z20.\nG41 G1 X9. F100.\nG0 Z2.\nG1 Z-5.\nG0 Z2.\nG0 G40 X20.",
    ],
)
def test_other_strokes_stay_moves(blocks):
    assert not [line for line in said(blocks) if line.startswith("CYCL DEF 200")]


def drawn(seed):
    """Return blocks with holes of all kinds, among other moves."""
    draw = Random(seed)
    lines = []
    for _ in range(draw.randint(2, 9)):
        x, y = draw.randint(-30, 30), draw.randint(-30, 30)
        bottom, plane = draw.choice((-5, -7.25, 1)), draw.choice((2, 3.5, 20))
        code = draw.choice(("G81", "G82", "G83", "G73", "G85", "G89", "L", "L", "C", "M"))
        if code == "L":
            kind = draw.choice(("G0", "G1 F77.", "G1 F50."))
            lines.append(f"{kind} {draw.choice('XYZ')}{draw.randint(2, 30)} (note)")
        elif code == "C":
            lines += [f"G1 Y{y} F30.", f"G2 Y{y + 4} J2. I0.", "G1 Y1.", "G0 Z21."]
        elif code == "M":
            lines.append(draw.choice(("M8", "G4 P1.5", "G91\nG1 Z-1. F9.\nG90", "G0 Z20.", "M0")))
        else:
            words = {"G82": " P0.25", "G89": " P0.5", "G83": " Q3.", "G73": " Q3."}.get(code, "")
            feed = draw.choice((100, 150.5))
            level = draw.choice(("G98", "G99"))
            lines.append(f"{level} {code} X{x} Y{y} Z{bottom} R{plane}{words} F{feed}")
            places = (f"X{draw.randint(-30, 30)}", f"Y{y + 1}", f"Z{bottom - 1}")
            lines += draw.choices(places, k=draw.randint(0, 3))
            lines.append("G80")
            lines += draw.choice(([], ["M9"], [f"G1 X{x}"], [f"G3 X{x} Y{y + 1} R20. F9."][:0]))
    return "\n".join(lines)


@pytest.mark.parametrize("seed", some(12 if not LONG else 5000))
def test_what_is_written_makes_the_moves_of_the_words(seed):
    blocks = drawn(seed)
    lines = said(blocks)
    if not any(line.startswith("C ") for line in lines):
        assert by_hand(lines) == moves(blocks), blocks
