"""Random programs of words become programs for a Fagor and words again, and stay the same."""

from __future__ import annotations

import re

import pytest
from gcxform_plugins.dialects.fagor.lines import Lines
from gcxform_plugins.passes.absolute import Absolute
from gcxform_plugins.passes.segment import Segment
from seeds_kit import LONG, some
from test_siemens_written import READING, WORDS, Wider, read

import gcxform as gx
from gcxform.pipeline.pipeline import Pipeline
from gcxform.plugin.registry import default_registry

FAGOR = default_registry().dialect("fagor")
HEAD = "G21 G17 G90 G94 G49 G54\n"
SEVERAL = re.compile(r" P[23]$|^G53.*$", re.MULTILINE)
"""What a Fagor has no words for: several turns, and places of the machine."""


def written(text, source=WORDS, target=FAGOR, passes=(), reading=READING):
    """Return what a program becomes, proved."""
    result = Pipeline(source, target, tuple(passes), reading).run(text.encode("latin-1"))
    assert result.certificate.verified
    return result.text.decode("latin-1")


def said(blocks, **options):
    """Return the lines for blocks, without those of the head and of the end."""
    return written(f"{HEAD}{blocks}\nM2\n", **options).splitlines()[3:-1]


IDIOMS = [
    ("G0 X1. Y-2.5 (to the part; here)", ["G0 X1 Y-2.5 ; to the part; here"]),
    ("(alone)", ["; alone"]),
    ("N10 G0 X1.", ["N10 G0 X1"]),
    ("T3 M6\nG43 H3\nG0 X1. Y2. Z3.", ["T3 M6", "D1", "G0 X1 Y2 Z3"]),
    ("T3 M6\nG0 X1. Y2. Z3.", ["T3 M6", "D0", "G0 X1 Y2 Z3"]),
    ("T3 M6\nG49\nG0 X1. Y2. Z3.", ["T3 M6", "D0", "G0 X1 Y2 Z3"]),
    ("G4 P1.5", ["G4 K1.5"]),
    ("G0 X0. Y0.\nG2 X20. Y0. I10. J0. F100.", ["G0 X0 Y0", "G2 X20 Y0 I10 J0 F100"]),
    ("G55\nG0 X1.\nG59\nG0 X1.", ["G55", "G0 X1", "G59", "G0 X1"]),
    ("S1000 M3\nM8\nM9\nM5\nM0", ["S1000 M3", "M8", "M9", "M5", "M0"]),
    ("G61\nG1 X1. F50.\nG64\nG1 X2.", ["G7", "G1 X1 F50", "G5", "G1 X2"]),
]


@pytest.mark.parametrize(("blocks", "lines"), IDIOMS)
def test_words_become_lines_in_its_idiom(blocks, lines):
    assert said(blocks) == lines


def test_a_program_has_a_name_that_is_no_subroutine():
    assert Lines("lathe-part 17 of many", False).opening() == ["%PLATHEPART17OF"]


REFUSED = [
    ("T3 M6\nG43 H4\nG0 X1. Y1. Z1.", "the length of another tool than the one in the spindle"),
    ("G92 X5.", "G92"),
    ("G93 G1 X5. F2.", "G93"),
    ("G0 X1.\nM7\nM100", "M100"),
]


@pytest.mark.parametrize(("blocks", "why"), REFUSED)
def test_what_has_no_words_is_refused(blocks, why):
    with pytest.raises(gx.GcxformError, match=why):
        said(blocks)


def test_places_of_the_machine_are_said():
    lines = said("T3 M6\nG43 H3\nG0 X1. Y1. Z1.\nG53 G0 Z0.\nG53 X0. Y0.\nG0 X5. Y5. Z5.")
    machine = ["D0", "#MCS ON", "G0 Z0", "#MCS OFF", "#MCS ON", "X0 Y0", "#MCS OFF", "D1"]
    assert lines[lines.index("D0") :] == [*machine, "G0 X5 Y5 Z5"]


def test_how_far_corners_are_rounded_is_not_said():
    assert "G5" in said("G64 P0.1 Q0.1\nG0 X1. Y1. Z1.")


def test_compensation_is_said_without_its_tool():
    lines = said("T3 M6\nG43 H3\nG0 X0. Y0. Z0.\nG1 G41 D3 X9. F100.\nY9.\nG1 G40 X20.")
    assert "G1 G41 X9 F100" in lines


WRONG = [
    ("D1", "D0"),
    ("G55", "G56"),
    ("M8", "M7"),
    ("G2 X5", "G3 X5"),
    ("G4 K1", "G4 K2"),
    ("X1 Y2", "X1.5 Y2"),
    ("F50", "F51"),
]


@pytest.mark.parametrize(("right", "wrong"), WRONG)
def test_what_is_written_is_read_and_compared(right, wrong, monkeypatch):
    lines = Lines.lines

    def mistaken(self, block):
        return [line.replace(right, wrong) for line in lines(self, block)]

    text = "T3 M6\nG43 H3\nG55\nG0 X1. Y2. Z3.\nG2 X5. Y2. I2. J0. F50.\nM8\nG4 P1."
    said(text)
    monkeypatch.setattr(Lines, "lines", mistaken)
    with pytest.raises(gx.GcxformError, match="GX"):
        said(text)


@pytest.mark.parametrize("seed", some(20 if not LONG else 20_000))
def test_words_and_its_language_say_the_same(seed):
    text = SEVERAL.sub("", Wider(seed).program())
    lines = written(text)
    one, two = read(text, WORDS), read(lines, FAGOR)
    assert gx.compare(one, two).deviation < 0.004, text
    back = written(lines, FAGOR, WORDS, (Absolute(),))
    assert gx.compare(two, read(back, WORDS)).deviation < 0.004, text
    try:
        own = written(lines, FAGOR, FAGOR, (Absolute(), Segment(chord_error=0.05)))
    except gx.InputError as error:  # what is kept is kept in the modes that it had
        if "this is kept as it stands" not in str(error):
            raise
        return
    assert gx.compare(two, read(own, FAGOR), 0.06).same, text


def test_programs_of_its_own_are_guessed():
    program = written(HEAD + "T3 M6\nG43 H3\nG0 X1. Y2. Z3.\nM2\n").encode()
    assert gx.guess_dialect(program).dialects == ("fagor",)
