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
from gcxform.modal.state import Reading
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
