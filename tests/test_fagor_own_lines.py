"""Programs of a Fagor are compensated in their own lines, and another reader agrees."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from reference import fagor_flow
from seeds_kit import LONG, shares
from test_fagor_reference import CONTROL, OPEN, START, Writer

import gcxform as gx
from gcxform.diagnostics import SpellingError
from gcxform.flow.straightened import written_out
from gcxform.flow.translated import Translated
from gcxform.modal.state import Reading
from gcxform.plugin.registry import default_registry
from gcxform.proof.refolded import check_refolded
from gcxform.stamps.comment import stamps_in
from gcxform.syntax.source import Source

MODEL = 'format = 1\nkind = "skew"\n[squareness]\nC0Y = 1e-3\n'
NEAR = 2.5e-3  # mm: what the pass may leave, and three decimals
SEGMENT = "segment chord-error=5um | "


def compensating(folder: Path, before: str = "") -> gx.Pipeline:
    (folder / "model.toml").write_text(MODEL)
    chain = f"volumetric model={folder}/model.toml part-origin=0,0,0 max-correction=9mm"
    pipeline = gx.Pipeline.parse(f"{before}{chain} outside=clamp", "fagor")
    return replace(pipeline, reading=Reading(start=START, control=CONTROL))


def meets(meant: list[tuple[float, ...]], found: list[tuple[float, ...]]) -> bool:
    """Whether moves lead to the ends of others, in their order, as the error of the machine is."""
    at, ends = 0, np.array([move[:3] for move in found])
    for x, y, z in (move[:3] for move in meant):
        far = np.abs(ends[at:] - (x + 1e-3 * y, y, z)).max(axis=1)
        near = np.flatnonzero(far < NEAR)
        if not len(near):
            return False
        at += int(near[0])
    return True


def check(seed: int, folder: Path) -> str:
    """Return how a program came back: whole, with a part written out, or in its own lines."""
    text = Writer(seed).program()
    try:
        found = compensating(folder, SEGMENT).run(text.encode())
    except gx.InputError as error:
        if error.diagnostics[0].code not in OPEN:
            raise
        return ""
    meant, read = (fagor_flow.Program(each) for each in (text, found.text.decode()))
    assert meets(meant.moves, read.moves), f"{text}\n{found.text.decode()}"
    said = found.certificate.written_out
    if any(each.startswith("the whole") for each in said):
        return "whole"
    counted = {name.strip(",") for each in found.certificate.assumed for name in each.split()}
    for name, value in meant.values.items():
        assert name in counted or read.values[name] == value, f"{name}\n{text}"
    return "part" if said else "own"


@shares(40 if not LONG else 5_000, 10)
def test_another_reader_finds_each_place(seeds: range, tmp_path: Path) -> None:
    ways = [check(seed + 400_000, tmp_path) for seed in seeds]
    assert sum(way in ("own", "part") for way in ways) > len(ways) / 2


PROGRAM = """; A SUBROUTINE
%L ONE
G1 X10 Y10 F100
#RET
; PART
%PART
N10 G71 G17 G90 G54 G94
G0 X0 Y0 Z5
LL ONE ; THERE
M30"""


@pytest.mark.parametrize("ends", ["\n", "\r\n"])
@pytest.mark.parametrize("last", ["", "\n"])
def test_a_stamp_and_its_seal_stand_in_the_lines(ends: str, last: str, tmp_path: Path) -> None:
    pipeline = compensating(tmp_path)
    found = pipeline.run((PROGRAM + last).replace("\n", ends).encode())
    lines = found.text.decode().split(ends)
    assert lines[:6] == PROGRAM.replace("X10", "X10.01").splitlines()[:6]
    assert lines[6].startswith("; GCXFORM STAMP ")
    assert lines[7:11] == PROGRAM.splitlines()[6:]
    assert lines[11].startswith("; GCXFORM SEAL ")
    assert stamps_in(Source.of_bytes(found.text)).fits
    with pytest.raises(gx.InputError, match="done already"):
        pipeline.run(found.text)
    twice = replace(pipeline, again=True).run(found.text)
    read = stamps_in(Source.of_bytes(twice.text))
    assert (len(read.stamps), len(read.seals), read.fits) == (2, 1, True)
    assert twice.certificate.written_out == []


SAID = """%PART
N10 G71 G17 G90 G54 G94 G5
P1=60 P101=3
G0 X10 Y10 Z50 ; THERE
#HSC ON [CONTERROR P101]
G1 XP1 Y40I F100 M8
R20 Q45
Q90
G0 G98 G81 X5 Z40 I30
G80
M30
"""
WRONG = [
    ("X10 Y10", "X10 Y11", "an end"),
    ("; THERE", "; HERE", "comments"),
    ("P101=3", "P101=3 P2=1", "another value"),
    ("P1=60 P101=3", "P1=60 P101=4", "goes along"),
    ("CONTERROR P101", "CONTERROR P1", "goes along"),
    ("G80", "P101=4", "another value"),
    ("Q90", "Q91", "an end"),
    ("G98", "G99", "an end"),
    ("I30", "I31", "an end"),
    ("M8", "M9", "M8 is M9"),
    ("G94 G5", "G94 G7", "is G61"),
    ("F100", "F101", "feed"),
    ("R20 Q45", "R20 Q45 P101=4", "goes along|another value"),
]


@pytest.mark.parametrize(("right", "wrong", "why"), WRONG)
def test_what_came_back_is_read_and_compared(right: str, wrong: str, why: str) -> None:
    dialect = default_registry().dialect("fagor")
    target = type("Copy", (dialect,), {"__module__": __name__})
    pipeline = gx.Pipeline(dialect, target, (), Reading(control=CONTROL))
    source = written_out(
        Source.of_bytes(SAID.encode()), dialect, pipeline.machine_reading, pipeline.target
    )
    assert isinstance(source, Translated)
    reading = replace(pipeline.reading_of_output(pipeline.machine_reading), crosses=True)
    given = Source.of_bytes(SAID.encode())
    check_refolded(given, source.text, source, pipeline.target, reading)
    other = Source.of_bytes(SAID.replace(right, wrong).encode())
    with pytest.raises(SpellingError, match=why):
        check_refolded(other, source.text, source, pipeline.target, reading)
