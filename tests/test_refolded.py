"""Programs in a language of their own come back in their lines, and are proved so."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

import gcxform as gx
from gcxform.diagnostics import SpellingError
from gcxform.flow.straightened import written_out
from gcxform.flow.translated import Translated
from gcxform.plugin.registry import default_registry
from gcxform.proof.refolded import check_refolded
from gcxform.stamps.comment import stamps_in
from gcxform.syntax.source import Source

PROGRAM = """; PART
N10 G710 G17 G90 G54 G94
MSG("ONE")
R1=60
N20 G0 X10 Y10 Z50 ; THERE
N30 TRANS X5
N40 G1 X=R1 Y40 F100
N50 TRANS
N60 M30
"""
WHOLE = "the whole program: "


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


def written_blocks(text: str) -> tuple[gx.Pipeline, Translated]:
    dialect = default_registry().dialect("siemens")
    target = type("Copy", (dialect,), {"__module__": __name__})
    pipeline = gx.Pipeline(dialect, target, ())
    source = Source.of_bytes(text.encode())
    made = written_out(source, dialect, pipeline.machine_reading, pipeline.target)
    assert isinstance(made, Translated)
    return pipeline, made


WRONG = [
    ("X10 Y10", "X10 Y11", "an end"),
    ("; THERE", "; HERE", "comments"),
    ("R1=60", "R1=60 R2=1", "another value"),
    ("TRANS X5", "TRANS X6", "an end"),
    ('MSG("ONE")', 'MSG("TWO")', "goes along"),
    ("N50 TRANS", "N50 TRANS Y=", "would not read"),
]


@pytest.mark.parametrize(("right", "wrong", "why"), WRONG)
def test_what_came_back_is_read_and_compared(right: str, wrong: str, why: str) -> None:
    pipeline, source = written_blocks(PROGRAM)
    reading = replace(pipeline.reading_of_output(pipeline.machine_reading), crosses=True)
    given = Source.of_bytes(PROGRAM.encode())
    check_refolded(given, source.text, source, pipeline.target, reading)
    other = Source.of_bytes(PROGRAM.replace(right, wrong).encode())
    with pytest.raises(SpellingError, match=why):
        check_refolded(other, source.text, source, pipeline.target, reading)
