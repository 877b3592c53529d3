"""Random programs of words become programs for a SINUMERIK and words again, and stay the same."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import pytest
from gcxform_plugins.dialects.siemens.lines import Lines
from gcxform_plugins.passes.absolute import Absolute
from seeds_kit import LONG, some
from test_klartext_spelled import Writer
from test_siemens import check

import gcxform as gx
from gcxform.machine.machine import Tool
from gcxform.modal.state import Reading
from gcxform.pipeline.pipeline import Pipeline
from gcxform.plugin.registry import default_registry

DIALECTS = default_registry().dialects
WORDS, SIEMENS = DIALECTS["linuxcnc"], DIALECTS["siemens"]
TOOLS = {n: Tool(length=10.0 * n, radius=1.0) for n in range(1, 9)}
START = {"X": 0.0, "Y": 0.0, "Z": 50.0}
READING = Reading(START, tools=TOOLS, control={"tool-length-axis": "Z"}, block_delete="execute")
EXAMPLE = Path(__file__).parents[1] / "examples" / "bracket"
HEAD = "G21 G17 G90 G94 G49 G54\n"


def written(text, source=WORDS, target=SIEMENS, passes=(), reading=READING):
    """Return what a program becomes, proved."""
    result = Pipeline(source, target, tuple(passes), reading).run(text.encode("latin-1"))
    assert result.certificate.verified
    return result.text.decode("latin-1")


def said(blocks, **options):
    """Return the lines for blocks, without those of the head and of the end."""
    return written(f"{HEAD}{blocks}\nM2\n", **options).splitlines()[2:-1]


IDIOMS = [
    ("G0 X1. Y-2.5 (to the part; here)", ["G0 X1 Y-2.5 ; to the part; here"]),
    ("(alone)", ["; alone"]),
    ("N10 G0 X1.", ["N10 G0 X1"]),
    ("T3 M6\nG43 H3\nG0 X1. Y2. Z3.", ["T3 M6", "D1", "G0 X1 Y2 Z3"]),
    ("T3 M6\nT4\nM5\nM6\nG43 H4", ["T3 M6", "T4", "M5", "M6", "D1"]),
    ("/G0 X1.", ["/G0 X1"]),
    ("G4 P1.5", ["G4 F1.5"]),
    ("G0 X10. Y0.\nG2 X20. Y10. R10. F100.", ["G0 X10 Y0", "G2 X20 Y10 I10 J0 F100"]),
    (
        "G0 X0. Y0.\nG3 X10. Y0. Z-1. I5. J0. P3 F50.",
        ["G0 X0 Y0", "G3 X10 Y0 Z-1 I5 J0 TURN=2 F50"],
    ),
    ("G55\nG0 X1.\nG59\nG0 X1.", ["G55", "G0 X1", "G506", "G0 X1"]),
    ("G53 G0 Z0.", ["SUPA G0 Z0 D0"]),
    ("G93 G1 X5. F2.\nG94 F100. G1 X1.", ["G93 G1 X5 F2", "G94 F100 G1 X1"]),
    ("S1000 M3\nM8\nM9\nM5\nM0", ["S1000 M3", "M8", "M9", "M5", "M0"]),
    ("G61.1\nG1 X1. F50.", ["G60", "G1 X1 F50"]),
    ("G64 P0.01", ["G64"]),
    ("G0 X0. Z0.\nG18\nG2 X1. Z1. I1. K0. F20.", ["G0 X0 Z0", "G18", "G2 X1 Z1 K0 I1 F20"]),
]


@pytest.mark.parametrize(("blocks", "lines"), IDIOMS)
def test_words_become_lines_in_its_idiom(blocks, lines):
    assert said(blocks) == lines


def test_a_length_ends_for_a_move_in_the_machine_and_is_in_force_again():
    found = said("T3 M6\nG43 H3\nG0 X1. Y2. Z3.\nG53 G0 Z0.\nG0 X1. Y1. Z5.")
    assert found[-3:] == ["SUPA G0 Z0 D0", "D1", "G0 X1 Y1 Z5"]


def test_a_length_that_stays_in_force_is_said_before_the_next_move():
    found = said("T3 M6\nG43 H3\nG0 X1. Y2. Z3.\nM5\nM6 T3\nM3 S100\nG0 X1. Y1. Z5.")
    assert found[-4:] == ["T3 M6", "M3 S100", "D1", "G0 X1 Y1 Z5"]


def test_across_the_tool_its_length_need_not_be_said():
    text = "T3 M6\nG43 H3\nG0 X1. Y2. Z3.\nG53 G0 Z0.\nT4 M6\nG0 X1. Y1.\nG43 H4\nG0 Z5."
    lines = said(text)
    assert lines[-5:] == ["SUPA G0 Z0 D0", "T4 M6", "G0 X1 Y1", "D1", "G0 Z5"]


def test_holes_become_cycles_and_rows_of_them_modal_ones():
    hole = "G0 Z2.\nG1 Z-5. F80.\nG0 Z20."
    row = "\n".join(f"X{x}.\nZ2.\nG1 Z-5.\nG0 Z20." for x in (20, 30))
    deeper = "X40.\nZ2.\nG1 Z-6.\nG4 P0.5\nG0 Z20."
    lines = said(f"T3 M6\nG43 H3\nG0 X1. Y2. Z20.\n{hole}\n{row}\n{deeper}\nX50.")
    call = "CYCLE81(20,1,1,-5)"
    there = ["F80", call, f"MCALL {call}", "X20", "X30", "MCALL"]
    assert lines[3:] == [*there, "X40", "CYCLE82(20,1,1,-6,,0.5)", "X50"]


TO = "T3 M6\nG43 H3\nG0 X1. Y2. Z20.\n"
HOLE = "Z2.\nG1 Z-5. F80.\n"
STAY = {
    "without a length, which is an alarm": f"G0 X1. Y2. Z20.\n{HOLE}G0 Z20.",
    "strokes of one hole": f"{TO}{HOLE}G4 P1.\nG0 Z20.\nZ-4.\nG1 Z-9.\nG0 Z20.",
    "in another plane": f"{TO}G18\n{HOLE}G0 Z20.",
    "not up to where it began": f"{TO}{HOLE}G0 Z1.",
    "with the spindle reversed": f"{TO}{HOLE}M4\nG0 Z20.",
}


@pytest.mark.parametrize("blocks", STAY.values(), ids=STAY)
def test_moves_that_are_no_cycle_stay(blocks):
    assert not any("CYCLE" in line for line in said(blocks))


WRONG = [
    ("D1", "D0", "the length of a tool"),
    ("G55", "G56", "a work offset, or a length"),
    ("M8", "M7", "M8 is M7"),
    ("SUPA G0 Z0 D0", "SUPA G0 Z5 D0", "a place in the machine"),
    ("SUPA G0 Z0 D0", "SUPA G0 X0 D0", "X"),
    ("G2 X5", "G3 X5", "kind"),
    ("G4 F1", "G4 F2", "DWELL is DWELL"),
    ("M5", "", "events"),
    ("TURN=1", "TURN=2", "a turn"),
    ("F50", "F51", "feed"),
    ("G64", "", "G64 is G53"),
]


@pytest.mark.parametrize(("right", "wrong", "why"), WRONG)
def test_what_is_written_is_read_and_compared(right, wrong, why, monkeypatch):
    lines = Lines.lines

    def mistaken(self, block):
        return [line.replace(right, wrong) for line in lines(self, block)]

    text = "T3 M6\nG43 H3\nG55\nG0 X1. Y2. Z3.\nG2 X5. Y2. I2. J0. F50.\nM8\nG4 P1."
    text += "\nG2 X1. Y2. I-2. J0. P2\nG61\nG1 X2.\nG64\nX1.\nG53 G0 Z0.\nM5"
    said(text)
    monkeypatch.setattr(Lines, "lines", mistaken)
    with pytest.raises(gx.GcxformError, match=why):
        said(text)


BEHIND = [("Z7", "Z8"), ("SUPA G0 Z0 D0", "SUPA G0 Z5 D0"), ("X9", "X9 Z9")]


@pytest.mark.parametrize(("right", "wrong"), BEHIND)
def test_behind_a_move_in_the_machine_places_are_compared(right, wrong, monkeypatch):
    """G54 is known and the length is not: until Z is named again, one of both knows where it is."""
    lines = Lines.lines

    def mistaken(self, block):
        return [line.replace(right, wrong) for line in lines(self, block)]

    text = "T3 M6\nG43 H3\nG0 X1. Y2. Z3.\nG53 G0 Z0.\nX9.\nZ7."
    reading = replace(READING, tools={}, work_offsets={"G54": {"Z": -5.0}})
    said(text, reading=reading)
    monkeypatch.setattr(Lines, "lines", mistaken)
    with pytest.raises(gx.GcxformError):
        said(text, reading=reading)


REFUSED = [
    ("T3 M6\nG43 H4\nG0 X1. Y1. Z1.", "the length of another tool than the one in the spindle"),
    ("G0 X0. Y0.\nG3 X0. Y0. Z-3. I5. J0. P3 F50.", "TURN= of a full circle"),
    ("G0 U1.", "U"),
]


@pytest.mark.parametrize(("blocks", "why"), REFUSED)
def test_what_has_no_words_is_refused(blocks, why):
    with pytest.raises(gx.GcxformError, match=why):
        said(blocks)


def test_the_length_of_the_tool_in_the_spindle_has_a_number():
    with pytest.raises(gx.InputError) as error:
        said("T3 M6\nG43 H4\nG0 X1. Y1. Z1.")
    assert "write H3" in error.value.diagnostics[0].hint


def test_behind_a_tool_change_without_a_length_a_setting_decides():
    text = "G21 G17 G90 G94\nT1 M6\nG0 X1. Y1. Z1.\nM2\n"
    with pytest.raises(gx.InputError, match="MD20270"):
        written(text)
    lines = written(text, reading=Reading(START, control={"edge-after-tool-change": 0.0}))
    assert "D0" not in lines


def test_what_is_compensated_for_it_says_so_and_is_not_compensated_again():
    plan = replace(Pipeline.load(EXAMPLE / "bracket.toml"), target=SIEMENS)
    result = plan.run(EXAMPLE / "bracket.nc")
    assert result.certificate.verified
    lines = result.text.decode().splitlines()
    assert lines[5].startswith("; GCXFORM STAMP")
    assert lines[-1].startswith("; GCXFORM SEAL")
    assert read(result.text.decode(), SIEMENS).path.end.any()
    with pytest.raises(gx.InputError, match="GX240"):
        replace(plan, source=SIEMENS, target=WORDS).run(result.text)


class Wider(Writer):
    """Draws planes, radii, offsets and units as well."""

    def program(self):
        text = super().program().decode()
        head = self.draw.choice(("G54 G49", "G55 G49", "G58 G64 G49"))
        return f"{head}\n{text}"

    def function(self):
        more = ("G55", "G54", "G61.1", "G64", "(a; [b])", "G59")
        if self.draw.random() < 0.3 and not self.steps:
            return [self.draw.choice(more), f"G0{self.words({a: self.number() for a in 'XYZ'})}"]
        return super().function()

    def arc(self):
        kind = self.draw.random()
        if kind < 0.5 or self.steps:
            return super().arc()
        plane, (a, b) = self.draw.choice((("G17", "XY"), ("G18", "ZX"), ("G19", "YZ")))
        ends = {axis: self.number() for axis in (a, b)}
        chord = math.dist([self.at[axis] for axis in (a, b)], [*ends.values()])
        if chord < 0.5:
            return []
        radius = round(chord * self.draw.uniform(0.52, 2.0), 4) * self.draw.choice((1, 1, -1))
        code = self.draw.choice(("G2", "G3"))
        return [plane, f"{code}{self.words(ends)} R{radius}", "G17"]


def read(text, dialect):
    return gx.read(
        text.encode("latin-1"),
        dialect,
        start=START,
        tools=TOOLS,
        control={"tool-length-axis": "Z"},
    )


@pytest.mark.parametrize("seed", some(20 if not LONG else 20_000))
def test_words_and_its_language_say_the_same(seed):
    text = Wider(seed).program()
    try:
        lines = written(text)
    except gx.InputError as error:
        if "TURN= of a full circle" not in str(error):
            raise
        return
    one, two = read(text, WORDS), read(lines, SIEMENS)
    check(lines)
    assert gx.compare(one, two).deviation < 0.004, text
    back = written(lines, SIEMENS, WORDS, (Absolute(),))
    assert gx.compare(two, read(back, WORDS)).deviation < 0.004, text
    try:
        own = written(lines, SIEMENS, SIEMENS, (Absolute(),))
    except gx.InputError as error:  # lines of D are kept, in the modes that they had
        if "this is kept as it stands" not in str(error):
            raise
        return
    assert gx.compare(two, read(own, SIEMENS)).deviation < 0.004, text


def test_arcs_behind_a_file_that_scales_are_written_anew(tmp_path):
    """Lines that were learnt before it is called stand for no arc behind it."""
    (tmp_path / "BIG.SPF").write_text("SCALE X10 Y10\nM17\n")
    arcs = "G2 X10 Y0 CR=5\nG2 X20 Y0 CR=5\nG2 X30 Y0 CR=5\n"
    head = "G0 G90 G17 G710 X0 Y0 Z5\nG1 F100 Z0\n"
    (tmp_path / "part.mpf").write_text(f"{head}{arcs}BIG\nG0 X0 Y0 Z5\nG1 Z0\n{arcs}SCALE\nM30\n")
    cut = Pipeline.parse("segment chord-error=50um", "siemens")
    result = cut.run(tmp_path / "part.mpf")
    (why,) = result.certificate.written_out
    assert why.startswith("the whole program: line 9: ")
    assert "may lead along an arc" in why
    assert b"G2" not in result.text
    assert b"X300 Y0" in result.text


@pytest.mark.parametrize(
    ("body", "why"),
    [
        ("L10\n", "L10.SPF: this line would change, and stands in another program"),
        ("L20\nX=IC(1)\n", ""),
        ("WHILE R1<2\nX=IC(5) R1=R1+1\nENDWHILE\n", "line 4: this line becomes another each time"),
    ],
)
def test_the_certificate_says_why_a_program_is_written_anew(tmp_path, body, why):
    (tmp_path / "L10.SPF").write_text("X=IC(5)\nM17\n")
    (tmp_path / "L20.SPF").write_text("X5\nM17\n")
    part = tmp_path / "part.mpf"
    part.write_text(f"G710 G17 G90 G94 G54\nR1=0 G0 X0\n{body}M30\n")
    said = Pipeline.parse("absolute", "siemens").run(part).certificate.written_out
    assert [why in each for each in said] == [True] * bool(why)


def test_what_cannot_be_written_anew_either_says_both():
    program = "G710 G17 G90 G94 G54\nG0 X0 Y0 Z5\nG1 Z0 F100\nG2 X5 Y0 CR=4 G642 FA[X]=3\nM30\n"
    with pytest.raises(gx.InputError, match="may lead along an arc") as refused:
        Pipeline.parse("segment chord-error=50um", "siemens").run(program.encode())
    assert "written whole it is refused, too: line 4: FA" in refused.value.diagnostics[0].hint
