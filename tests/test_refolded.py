"""Programs in a language of their own come back in their lines, and are proved so."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from refolded_kit import written_blocks

import gcxform as gx
from gcxform.diagnostics import SpellingError
from gcxform.proof.refolded import check_refolded
from gcxform.stamps.comment import stamps_in
from gcxform.syntax.source import Source

PROGRAM = """; PART
N10 G710 G17 G90 G54 G94
MSG("ONE")
R1=60 R3=1
N20 G0 X10 Y10 Z50 ; THERE
N30 TRANS X5
N40 G1 X=R1 Y40 F100
N50 TRANS
N60 M30
"""


def compensating(folder: Path, language: str = "siemens", before: str = "") -> gx.Pipeline:
    (folder / "model.toml").write_text('format = 1\nkind = "skew"\n[squareness]\nC0Y = 1e-4\n')
    chain = f"{before}volumetric model={folder}/model.toml part-origin=0,0,0 outside=clamp"
    return gx.Pipeline.parse(chain, language)


@pytest.mark.parametrize("ends", ["\n", "\r\n"])
@pytest.mark.parametrize("last", ["", "\n"])
def test_a_stamp_and_its_seal_stand_in_the_lines(ends: str, last: str, tmp_path: Path) -> None:
    text = (PROGRAM.rstrip() + last).replace("\n", ends).encode()
    pipeline = compensating(tmp_path)
    found = pipeline.run(text)
    lines = found.text.decode().split(ends)
    assert lines[0] == "; PART"
    assert lines[1].startswith("; GCXFORM STAMP ")
    assert lines[2] == "N10 G710 G17 G90 G54 G94"
    assert lines[-3] == "N60 M30"
    assert lines[-2].startswith("; GCXFORM SEAL ")
    assert stamps_in(Source.of_bytes(found.text)).fits
    assert found.certificate.written_out == []
    with pytest.raises(gx.InputError, match=r"COMPENSATED|done already"):
        pipeline.run(found.text)


def test_a_program_that_is_run_once_more_has_both_stamps_and_one_seal(tmp_path: Path) -> None:
    pipeline = compensating(tmp_path)
    once = pipeline.run(PROGRAM.encode()).text
    twice = replace(pipeline, again=True).run(once)
    read = stamps_in(Source.of_bytes(twice.text))
    assert (len(read.stamps), len(read.seals), read.fits) == (2, 1, True)
    assert twice.certificate.written_out == []
    assert b"N20 G0 X10.002 Y10 Z50 ; THERE" in twice.text
    assert len(twice.text.splitlines()) == len(once.splitlines()) + 1


def test_each_line_has_the_line_that_it_is_for(tmp_path: Path) -> None:
    found = compensating(tmp_path, before="segment chord-error=5um max-length=20mm | ").run(
        PROGRAM.encode()
    )
    lines = found.text.decode().splitlines()
    of = [(line, k) for line, k in zip(lines, found.source_map, strict=True) if "GCX" not in line]
    pieces = [k for line, k in of if line.startswith("G1")]
    assert [k for line, k in of if not line.startswith("G1")] == list(range(9))
    assert pieces == [6, 6, 6]


WRONG = [
    ("X10 Y10", "X10 Y11", "an end"),
    ("; THERE", "; HERE", "comments"),
    ("R3=1", "R3=2", "another value"),
    ("R3=1", "R3=1 R2=1", "another value"),
    ("TRANS X5", "TRANS X6", "an end"),
    ('MSG("ONE")', 'MSG("TWO")', "goes along"),
    ("N50 TRANS", "N50 TRANS Y=", "would not read"),
]


@pytest.mark.parametrize(("right", "wrong", "why"), WRONG)
def test_what_came_back_is_read_and_compared(right: str, wrong: str, why: str) -> None:
    pipeline, source = written_blocks("siemens", PROGRAM)
    reading = replace(pipeline.reading_of_output(pipeline.machine_reading), crosses=True)
    given = Source.of_bytes(PROGRAM.encode())
    check_refolded(given, source.text, source, pipeline.target, reading)
    other = Source.of_bytes(PROGRAM.replace(right, wrong).encode())
    with pytest.raises(SpellingError, match=why):
        check_refolded(other, source.text, source, pipeline.target, reading)


CALLING = """G710 G17 G90 G54 G94 G0 X0 Y0 Z0
R1=1
HOLE
X10 Y10
HOLE
M30
"""
HOLES = ("G0 X=R1\nR1=R1+1\nRET\n", "G0 Z2\nR1=R1+1\nRET\n", "TRANS X=DD\nX5\nTRANS\nRET\n")


def test_a_call_that_cannot_stay_is_written_out_alone(tmp_path: Path) -> None:
    pipeline, main = compensating(tmp_path), tmp_path / "MAIN.MPF"
    main.write_text(CALLING)
    for hole, why in (
        (HOLES[0], ["line 5, and what it calls: line 1 of HOLE.SPF: "]),
        (HOLES[1], []),
        (f"DEF REAL DD=5\n{HOLES[2]}", ["the whole program: line 2 of "]),
    ):
        (tmp_path / "HOLE.SPF").write_text(hole)
        found = pipeline.run(main)
        said = found.certificate.written_out
        assert len(said) == len(why), said
        assert all(one.startswith(other) for one, other in zip(said, why, strict=True)), said
        assert found.certificate.verified


def test_steps_of_a_loop_are_the_same_where_nothing_changes_them(tmp_path: Path) -> None:
    text = "G710 G17 G90 G54 G94 G0 X0 Y0 Z0\nR1=0\nROUND: G91 X1\nR1=R1+1\nIF R1<5 GOTOB ROUND"
    found = compensating(tmp_path).run(f"{text}\nG90 Y50\nM30\n".encode())
    assert found.text.decode().splitlines()[1:6] == text.splitlines()[:5]
    assert found.text.decode().splitlines()[6] == "G90 Y50 X5.005"


def test_a_line_that_no_words_can_say_is_written_out(tmp_path: Path) -> None:
    (tmp_path / "z.toml").write_text('format = 1\nkind = "skew"\n[squareness]\nA0Z = 1e-3\n')
    chain = f"volumetric model={tmp_path}/z.toml part-origin=0,0,0"
    text = "G710 G17 G90 G54 G94 G0 X0 Y0 Z50\nF100\nCYCLE81(10,0,2,-8,) ; HOLE\nG0 X1 Z20\nM30\n"
    found = gx.Pipeline.parse(chain, "siemens").run(text.encode())
    (why,) = found.certificate.written_out
    assert why.startswith("line 3, and what it calls: line 3: what this line became")
    assert b"CYCLE81" not in found.text
    assert b"; HOLE" in found.text
