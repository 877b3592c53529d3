"""Programs of a TNC come back in their own lines, are proved so, and quickly."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from random import Random

import pytest
from refolded_kit import written_blocks
from test_refolded import compensating

from gcxform.diagnostics import SpellingError
from gcxform.emit.own_lines import OwnLines
from gcxform.emit.unrolling import Unit, Walk
from gcxform.proof.refolded import check_refolded
from gcxform.stamps.comment import stamps_in
from gcxform.syntax.source import Source

PROGRAM = """0 BEGIN PGM PART MM
1 TOOL CALL 1 Z S2000 F700
2 Q1 = 60 ; WIDE
3 L X+10 Y+10 Z+50 R0 FMAX M3 ; THERE
4 L Z+0 FAUTO
5 L IX+5 F100
6 CC X+15 Y+20
7 C X+25 Y+20 DR+
8 CYCL DEF 240 CENTERING Q200=+2 Q343=+0 Q201=-2 Q344=-5 Q206=+100 Q211=+0 Q203=+0 Q204=+50
9 L X+Q1 Y+40 FMAX M99
10 Q5 = Q1
11 CALL LBL 1
12 CYCL DEF 10.0 ROTATION
13 CYCL DEF 10.1 ROT+30
14 L X+50 Y+50 F100 M30
15 LBL 1
16 LP PR+10 PA+90 F300
17 LBL 0
18 END PGM PART MM
"""


@pytest.mark.parametrize("ends", ["\n", "\r\n"])
@pytest.mark.parametrize("last", ["", "\n"])
def test_a_stamp_and_its_seal_stand_within_the_program(
    ends: str, last: str, tmp_path: Path
) -> None:
    text = "0 BEGIN PGM A MM\n1 ; PART\n2 L X+10 Y+10 Z+5 FMAX\n3 L Y+20 F100\n4 END PGM A MM"
    pipeline = compensating(tmp_path, "heidenhain")
    found = pipeline.run((text + last).replace("\n", ends).encode())
    lines = found.text.decode().split(ends)
    assert lines[0] == "0 BEGIN PGM A MM"
    assert lines[1].startswith("1 ; GCXFORM STAMP ")
    assert lines[2:5] == ["2 ; PART", "3 L X+10.001 Y+10 Z+5 FMAX", "4 L X+10.002 Y+20 F100"]
    assert lines[5].startswith("5 ; GCXFORM SEAL ")
    assert lines[6:] == ["6 END PGM A MM", *([""] if last else [])]
    assert stamps_in(Source.of_bytes(found.text)).fits
    twice = replace(pipeline, again=True).run(found.text)
    assert len(twice.text.splitlines()) == len(lines) - bool(last) + 1
    assert twice.certificate.written_out == []


WRONG = [
    ("X+10 Y+10", "X+10 Y+11", "would not read"),
    ("IX+5", "IX+6", "would not read"),
    ("; THERE", "; HERE", "comments"),
    ("10 Q5", "10 Q6", "another value"),
    ("Q5 = Q1", "Q5 = Q1 + 1", "another value"),
    ("10 Q5 = Q1", "10 Q5 = Q1\nQ6 = 1", "another value"),
    ("FAUTO", "F701", "feed"),
    ("F700", "F800", "feed"),
    ("Y+40 FMAX", "Y+40 F100", "kind"),
    ("Y+40 FMAX", "Y+40", "kind"),
    ("DR+", "DR-", "a turn|kind"),
    ("6 CC X+15 Y+20", "6 CC X+15 Y+20.01", "an end|a centre|would not read"),
    ("6 CC X+15 Y+20", "6 CC X+15 Y+20\nCC X+0 Y+0", "would not read"),
    ("7 C X+25 Y+20 DR+", "7 C X+25 Y+20 DR+\nCC X+0 Y+1", "an end"),
    ("Q201=-2", "Q201=-3", "an end"),
    ("M99", "", "moves"),
    ("FMAX M3", "FMAX M4", "M3 is M4"),
    ("ROT+30", "ROT+31", "an end"),
    ("PART MM", "OTHER MM", "goes along"),
    ("11 CALL LBL 1", "11 CALL LBL 2", "would not read"),
]


@pytest.mark.parametrize(("right", "wrong", "why"), WRONG)
def test_what_came_back_is_read_and_compared(right: str, wrong: str, why: str) -> None:
    pipeline, source = written_blocks("heidenhain", PROGRAM)
    reading = replace(pipeline.reading_of_output(pipeline.machine_reading), crosses=True)
    given = Source.of_bytes(PROGRAM.encode())
    check_refolded(given, source.text, source, pipeline.target, reading)
    assert right in PROGRAM
    other = Source.of_bytes(PROGRAM.replace(right, wrong).encode())
    with pytest.raises(SpellingError, match=why):
        check_refolded(other, source.text, source, pipeline.target, reading)


PLACES = ("X{}", "X{} Y{}", "Y{} Z{}", "Z{}", "X{} Y{} Z{}", "X{}  Y{}", "x{} Y{}")
BETWEEN = (
    *("CYCL DEF 7.0\nCYCL DEF 7.1 IX{}", "Q1 = {}", "L X+Q1 R0", "L IY{} FMAX", "L IX{} IZ{}"),
    *("L X{} F{F}", "L Z{} M8", "L X{} Y{} R0 F{F} M9", "L X{} FMAX M7", "L X{} R", "L Y{} M90"),
    *("CR X+1 Y+1 R+900 DR+\nL X{}", "CC X+0 Y+0\nLP PR+5 PA{} FMAX", "LBL 9", "L X{} FQ2"),
)


def drawn(random: Random, count: int) -> str:
    """Return a program in which most lines are like others."""
    lines = ["BEGIN PGM A MM", "Q1 = 1", "Q2 = 50", "L X+1 Y+1 Z+50 FMAX", "L X+2 F500"]
    for _ in range(count):
        few = random.random() < 0.1
        text = random.choice(BETWEEN) if few else f"L {random.choice(PLACES)}"
        text = text.replace("LBL 9", "; NOTHING").replace(" M90", "")
        while "{}" in text:
            number = f"{random.uniform(1, 90):.{random.randrange(4)}f}"
            text = text.replace("{}", random.choice(("", "-", "+", "+")) + number, 1)
        text = text.replace("{F}", str(random.randrange(1, 900)))
        end = random.choice(("", "", "", " R0", " FMAX", " R0 FMAX", " F300")) if not few else ""
        lines.append(text + end + random.choice(("", "", " ; X+9 Y-8", "  ")))
    lines.append("END PGM A MM")
    if random.random() < 0.5:
        flat = "\n".join(lines).split("\n")
        lines = [f"{k} {text}" for k, text in enumerate(flat)]
    return "\n".join([*lines, ""])


@pytest.mark.parametrize("seed", range(12))
def test_what_is_alike_is_spelled_as_word_by_word(
    seed: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = drawn(Random(seed), 120).encode()
    pipeline = compensating(tmp_path, "heidenhain")
    quick = pipeline.run(text)
    assert quick.certificate.written_out == []
    monkeypatch.setattr(OwnLines, "_counts_alike", lambda *_: False)
    assert pipeline.run(text).text == quick.text


def test_most_lines_are_alike(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    slow = []
    word_by_word = OwnLines._worded
    monkeypatch.setattr(
        OwnLines, "_worded", lambda *given: slow.append(given[1]) or word_by_word(*given)
    )
    lines = ["BEGIN PGM A MM", "L X+1 Y+1 Z+50 R0 FMAX", "L X+2 F500"]
    lines += ["L X-1.5 Y+2.5 R0 ; A", "L X+4 Y+3"] * 50 + ["END PGM A MM", ""]
    numbered = "\n".join(f"{k} {text}" if text else "" for k, text in enumerate(lines))
    found = compensating(tmp_path, "heidenhain").run(numbered.encode())
    assert found.text.count(b" R0 ; A") == 50
    assert len(slow) < 10


def test_steps_by_a_parameter_stay_where_they_are_the_same(tmp_path: Path) -> None:
    lines = ["BEGIN PGM A MM", "Q1 = 5", "L X+1 Y+20 Z+5 FMAX", "L IX+Q1 FMAX", "L IX+Q1 IY-Q1 F9"]
    text = "\n".join([*lines, "END PGM A MM", ""])
    found = compensating(tmp_path, "heidenhain").run(text.encode()).text.decode()
    assert found.splitlines()[4:6] == ["L IX+Q1 FMAX", "L IX+4.9995 IY-Q1 F9"]


def test_a_loop_in_a_call_is_written_out_there(tmp_path: Path) -> None:
    lines = [
        *("BEGIN PGM A MM", "L X+0 Y+0 Z+5 FMAX", "CALL LBL 1", "L X+9 FMAX M30", "LBL 1"),
        *("LBL 2", "L X+5 IY+10 FMAX", "CALL LBL 2 REP 1", "LBL 0", "END PGM A MM", ""),
    ]
    found = compensating(tmp_path, "heidenhain").run("\n".join(lines).encode())
    made = [line for line in found.text.decode().splitlines() if "GCXFORM" not in line]
    assert made[3:8] == [
        *("L X+9.002 FMAX M30", "LBL 1", "L X+5.001 IY+10 FMAX", "L X+5.002 IY+10 FMAX", "LBL 0")
    ]
    (why,) = found.certificate.written_out
    assert why.startswith("lines 6 to 8: line 7: this line becomes another")


def test_a_loop_that_calls_is_written_out_without_what_it_calls(tmp_path: Path) -> None:
    lines = [
        *("BEGIN PGM A MM", "L X+0 Y+0 Z+5 FMAX", "LBL 2", "L X+5 IY+10 FMAX", "CALL LBL 1"),
        *("CALL LBL 2 REP 1", "L Z+9 FMAX M30", "LBL 1", "L Z+2 FMAX", "LBL 0", "END PGM A MM", ""),
    ]
    found = compensating(tmp_path, "heidenhain").run("\n".join(lines).encode())
    (why,) = found.certificate.written_out
    assert why.startswith("lines 3 to 6: line 4: this line becomes another")
    made = [line for line in found.text.decode().splitlines() if "GCXFORM" not in line]
    assert made[-5:] == ["L Z+9 FMAX M30", "LBL 1", "L Z+2 FMAX", "LBL 0", "END PGM A MM"]


def test_what_is_within_what_is_written_out_is_so_with_it() -> None:
    outer, inner = Unit(5, 6, 10, 40, "outer"), Unit(50, 51, 20, 25, "inner")
    other = Unit(7, 7, 41, 41, "other")
    walk = Walk.__new__(Walk)
    assert walk.together([inner, other, outer]) == [outer, other]
