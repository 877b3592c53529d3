"""Guessing the dialect of programs: of generated ones, of one fact, of real ones."""

from __future__ import annotations

import csv
from collections import Counter
from functools import cache
from pathlib import Path
from random import Random
from time import process_time

import pytest

import gcxform as gx
from gcxform.testing.generate import Options, program

BESIDE = Path(__file__).parents[2] / "shared" / "corpus"
NAMES = ("fanuc", "grbl", "haas", "linuxcnc")
TOLD = (*NAMES, "heidenhain")  # which real programs tell
OURS = {"sinumerik": "siemens"}
"""What we call dialects that the collection calls otherwise."""
LARGE = 1 << 17  # bytes; a larger program says no more of its dialect than others


@pytest.mark.parametrize("name", NAMES)
def test_generated_programs_may_be_in_their_dialect(name: str) -> None:
    guesses = [gx.guess_dialect(program(Random(seed).randint, Options(name))) for seed in range(40)]
    right = sum(name in guess.dialects for guess in guesses)
    assert right >= 38, Counter(guess.dialects for guess in guesses)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (b"%\nO1000\nG10.6\nG0 X1. Y2.\nM30\n%\n", {"fanuc"}),
        (b"%\nO01000\nG187 P3\nG0 X1. Y2.\nM30\n%\n", {"haas"}),
        (b"%\nO1000\nG0 G90 X1. Y2.\nG4 P500\nM30\n%\n", {"fanuc", "haas"}),
        (b"G21\no100 sub\n#<x> = 1\nG1 X#<x> F10\no100 endsub\nM2\n", {"linuxcnc"}),
        (b"(for grbl)\nG21 G90\nG1 X1.5 F100\nM30\n", {"grbl"}),
        (b"G21 G90\nG1 X10 Y5 F100\nM30\n", {"grbl", "linuxcnc"}),
        (b"(for fluidnc)\nG21 G90\nG1 X1.5 F100\nM30\n", {"fluidnc"}),
        (b"G21 G90\nG28.2 X0 Y0\nG1 X1.5 F100\nM30\n", {"tinyg", "g2core"}),
        (b"(lift\nG21 G90\nG28.2 X0\nG1 X1.5 F100\nM30\n", {"tinyg"}),
        (b"(for grblhal)\nG21 G90\nG1 X1.5 F100\nM30\n", {"grbl"}),
        (b"0 BEGIN PGM A MM\n1 L X+10 R0 FMAX\n2 END PGM A MM\n", {"heidenhain"}),
        (b"", set()),
        (b"\x00\x01\xff" * 50, set()),
    ],
)
def test_what_tells_dialects_apart(text: bytes, expected: set[str]) -> None:
    guess = gx.guess_dialect(text)
    assert set(guess.dialects) == expected, guess
    assert ("none" in str(guess)) == (not expected)
    assert set(guess.evidence) >= set(NAMES)


def test_the_score_is_the_sum_of_the_evidence(tmp_path: Path) -> None:
    (tmp_path / "p.nc").write_bytes(b"O1000\nG0 X1.\n")
    guess = gx.guess_dialect(tmp_path / "p.nc")
    assert guess.score("fanuc") == sum(item.weight for item in guess.evidence["fanuc"]) > 0
    assert "a point in every distance" in str(guess)


def test_programs_without_comments_take_no_longer() -> None:
    """What tells languages apart looks at each byte a few times, and not once for every line."""
    text = b"G21 G90\n" + b"G1 X1.5 Y2.5\n" * 20_000
    gx.guess_dialect(text[:1000])
    began = process_time()
    gx.guess_dialect(text)
    assert process_time() - began < 5.0


def manifest() -> list[dict[str, str]]:
    """Return the programs of the collection; those of LinuxCNC's tests are no test here."""
    file = BESIDE / "manifest.csv"
    if not file.exists():
        return []
    with file.open() as stream:
        rows = [row for row in csv.DictReader(stream) if (BESIDE / row["path"]).is_file()]
    return [row for row in rows if row["role"] == "program" and int(row["bytes"]) < LARGE]


@cache
def guessed(path: str) -> tuple[str, ...]:
    """Return what a program of the collection may be in."""
    return gx.guess_dialect(BESIDE / path).dialects


@pytest.mark.skipif(not manifest(), reason="the collection of real programs is absent")
@pytest.mark.parametrize("dialect", [*TOLD, "sinumerik"])
def test_real_programs(dialect: str) -> None:
    """Most programs are guessed, and other languages are not taken for one that is known."""
    ours = OURS.get(dialect, dialect)
    hits: Counter[bool] = Counter()
    for row in manifest():
        if row["dialect"] == dialect:
            found = guessed(row["path"])
            right = ours in found if dialect in TOLD else not found or found == (ours,)
            hits[right] += 1
    share = hits[True] / hits.total()
    assert share == 1.0 if dialect == "heidenhain" else share > 0.7, hits


ALIKE = {"trans.mpf", "trans_reset.mpf", "SINUMERIK850.nc"}
"""Programs of a SINUMERIK that could be others as well: a few axis words, and another language."""


@pytest.mark.skipif(not manifest(), reason="the collection of real programs is absent")
@pytest.mark.parametrize("dialect", ["heidenhain", "sinumerik"])
def test_languages_of_their_own_are_told_with_certainty(dialect: str) -> None:
    for row in manifest():
        if row["dialect"] == dialect and Path(row["path"]).name not in ALIKE:
            found = guessed(row["path"])
            assert found == (OURS.get(dialect, dialect),), row["path"]


@pytest.mark.parametrize(
    ("text", "unread"),
    [
        (b"%POCKET,MX,--\nN10 G90 G17\nN20 G0 X0 Y0 Z50\nN30 M30\n", "a Fagor 8055"),
        (b"%A PART,MX--\nG0 X1. Y2.\nM30\n", "a Fagor 8055"),
        (b"%\nO1 (A, MX)\nG0 X1. Y2.\nM30\n%\n", ""),
        (b"%PART\nG0 X1. Y2.\nM30\n", ""),
        (b"%\nN1 M6 T1\nN2 G0 G90 S5000 M3 E1 X0 Y0\nN3 H1 Z.1 M8\nM2\n", "a Fadal"),
        (b"%\nO1\nS500 M3 (E1)\nG0 X1. Y2.\nM30\n%\n", ""),
        (b"M104 S200\nG1 X1 Y2 E1 F600\n", ""),
        (b"M3\nE1\nG0 X1. Y2.\nM30\n", ""),
    ],
)
def test_a_control_that_is_not_read_is_named(text: bytes, unread: str) -> None:
    guess = gx.guess_dialect(text)
    assert guess.unread == unread
    assert not (unread and guess.dialects)
    assert unread in str(guess)
