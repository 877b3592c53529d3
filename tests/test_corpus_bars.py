"""Real programs go through, and every refusal has a judgement; GRBL's own rules are these."""

from __future__ import annotations

import re
import sys
from functools import cache
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

import corpus_files
import grbl_rules

import corpus

LEAST = {
    "fanuc": (34, 27),
    "grbl": (38, 37),
    "haas": (13, 11),
    "linuxcnc": (129, 98),
    "siemens": (54,),
    "heidenhain": (18,),
}
"""What goes through already, in each chain: it may not become less."""


LONGEST = {
    ("linuxcnc", "absolute"): "LinuxCNC-linuxcnc/nc_files/smartprobe.ngc",
    ("siemens", "absolute"): "SINULORENZ.MPF",
}
"""Programs that take seconds and go through: each is a test by itself."""


PROGRAMS = {"fanuc": 39, "grbl": 38, "haas": 14, "linuxcnc": 130, "siemens": 55, "heidenhain": 19}
TOGETHER = 20  # programs in a test


@cache
def every(dialect: str) -> list[corpus.Job]:
    """Return what is run of a dialect."""
    if not corpus.BESIDE.is_dir():
        pytest.skip(f"{corpus.BESIDE} is not here: real programs are not run")
    return list(corpus.counted(corpus.BESIDE, [dialect]))


def jobs(dialect: str, chain: str) -> list[corpus.Job]:
    """Return what is run of a dialect through a chain."""
    return [job for job in every(dialect) if job.chain == chain]


def is_longest(job: corpus.Job) -> bool:
    """Whether a program has a test of its own."""
    return job.path.endswith(LONGEST.get((job.dialect, job.chain), "\0"))


@cache
def found(dialect: str, chain: str, share: int) -> tuple[corpus.Outcome, ...]:
    """Return what becomes of some programs: which is asked twice, by tests of one process."""
    some = [job for job in jobs(dialect, chain) if not is_longest(job)]
    return tuple(map(corpus.run, some[share * TOGETHER : (share + 1) * TOGETHER]))


def together(*words: object) -> object:
    """Return the parameters of tests that one process runs: of GRBL, all, to be counted once."""
    shared = words[:1] if words[0] == "grbl" else words[:2]
    group = pytest.mark.xdist_group("-".join(("bars", *map(str, shared))))
    return pytest.param(*words, marks=group, id="-".join(map(str, words)))


WAYS = [(d, c) for d in corpus.OURS for c, _ in zip(corpus.CHAINS, LEAST[d], strict=False)]
SHARES = {way: range(-(-PROGRAMS[way[0]] // TOGETHER)) for way in WAYS}


@pytest.mark.parametrize(
    ("dialect", "chain", "share"), [together(*way, share) for way in WAYS for share in SHARES[way]]
)
def test_a_real_program_goes_through_or_its_refusal_has_a_judgement(
    dialect: str, chain: str, share: int
) -> None:
    for one in found(dialect, chain, share):
        assert one.code not in {"CRASH", "NOT VERIFIED", "TIME"}
        assert not one.code or one.judgement, f"{one.job.path} {one.code} {one.says}"
        placed = one.line or one.says.startswith("this file") or not one.code.startswith("GX")
        assert placed, f"{one.job.path} {one.says}"


@pytest.mark.parametrize(("dialect", "chain"), [together(*way) for way in WAYS])
def test_as_many_real_programs_go_through(dialect: str, chain: str) -> None:
    """And few of their lines are not understood."""
    ends = [one for share in SHARES[dialect, chain] for one in found(dialect, chain, share)]
    alone = (dialect, chain) in LONGEST
    assert len(jobs(dialect, chain)) == PROGRAMS[dialect] == len(ends) + alone
    good, _ = corpus.through(ends)[dialect, chain]
    assert good + alone >= LEAST[dialect][[*corpus.CHAINS].index(chain)]
    if dialect in corpus.MOST_KEPT:
        assert corpus.kept_lines(ends)[dialect][0] <= corpus.MOST_KEPT[dialect]


def test_whose_place_of_call_is_said_is_called_once() -> None:
    """In all programs beside it, by a number in P and without a count."""
    said = [each for each in corpus.notes()["machine"] if "entry" in each]
    for machine in said:
        mine = [
            j
            for j in jobs(machine["dialect"], "compensated")
            if corpus.machine_of(j.dialect, j.path) is machine
        ]
        assert mine
        for job in mine:
            place = job.corpus / job.path
            beside = [each.read_text("latin-1") for each in place.parent.glob("*.nc")]
            calls = re.findall(rf"M98 P{place.stem}(?![0-9])(.*)", "\n".join(beside))
            assert len(calls) == 1
            assert "L" not in calls[0].partition("(")[0]
            assert f"M98 P{place.stem}" in (place.parent / machine["caller"]).read_text("latin-1")


@pytest.mark.parametrize(("dialect", "chain"), LONGEST)
def test_a_long_program_goes_through(dialect: str, chain: str) -> None:
    (job,) = filter(is_longest, jobs(dialect, chain))
    outcome = corpus.run(job)
    assert (outcome.code, outcome.kept) == ("", 0), outcome.says


@pytest.mark.parametrize(
    ("before", "after", "says"),
    [
        (b"O1\nG0 X1\nM98 P2\nM30\nO2\nX2\nM99\n", b"O1\nG0 X1\nX2\nM30\n", "1 of 2 definitions"),
        (b"o<a> sub\nG0 X1\no<a> endsub\n", b"o<b> sub\nG0 X1\no<b> endsub\n", "1 of 1 def"),
        (b"G0 X1\nG1 Y[#1] F1\nZ-.5\n", b"G0 X1\n(Y1)\n", "2 of 3 motions are gone"),
        (b"G0 X1 (a)\no1 while [#1 GT 0]\nY1\no1 endwhile\n", b"G0X1\nY1\nY1\n", ""),
        (b"#<x1> = 5\nF100\nG53 G0 Z0\n", b"G53 G0 Z0.\n", ""),
    ],
)
def test_what_a_result_has_lost_is_noticed(before: bytes, after: bytes, says: str) -> None:
    lost = corpus.what_is_lost(before, after)
    assert says in lost
    assert bool(says) == bool(lost)


def test_what_a_user_knows_takes_the_place_of_what_is_asked() -> None:
    text = (
        '[input]\n# "?" is open\nstart = { X = "?", Y = "?" }\nfeed = "?"\n[tool.3]\nlength = "?"\n'
    )
    known = {"input.start.*": 1.5, "tool.*.length": 120.0, "home.*": 0.0, "input.units": "mm"}
    filled, asked = corpus_files.filled(text, known)
    assert 'start = { X = 1.5, Y = 1.5 }\nfeed = "?"\n[tool.3]\nlength = 120.0\n' in filled
    assert asked == {"input.start.*", "tool.*.length"}


ACCEPTED = [
    b"%\nG21 (mm) G90\n/ g1 x1 f100 ; on\n$H\nX-.5Y+2.\n",
    b"G1F100\nG2X10I5\nG2X0R5\nG3X0.004I5J0\n",
    b"F9G3G19Y1J0.5K9I9\n",
    b"G20\nG92X1\nG1X1F5\nG2X1I1\n",
    b"G53G0X1\nG28\nG30X1\nG28.1\nG92.1\n",
    b"G43.1Z5\nG49\nG10L2P1X3\nG10L20P0X0\n",
    b"G4P1\nM3S100\nT255M5\nN9999999\nG80\nG38.2Z-5F10\n",
    b"G93\nG1X1F2\nG0X2\n",
    b"G2X2I1F100\nM2\nX3\n",
    b"X" + b"0" * 78 + b"\n",
]
REJECTED = [
    (b"G5\n", "no code G5"),
    (b"M6\n", "no code M6"),
    (b"M7\n", "no code M7"),
    (b"G01.5X1\n", "no code G1.5"),
    (b"A1\n", "no word A"),
    (b"X1X2\n", "X twice"),
    (b"X\n", "a letter and a number"),
    (b"#1=2\n", "a letter and a number"),
    (b"S-1\n", "S is negative"),
    (b"N10000001\n", "too large"),
    (b"T256\n", "too large"),
    (b"G0G1X1F1\n", "a second code"),
    (b"G28G1X1F1\n", "axis words"),
    (b"G90G91\n", "a second code"),
    (b"G1X1\n", "no feed"),
    (b"G94G1X1F1\nG93\nX2\n", "no F in inverse time"),
    (b"G4\n", "G4 without P"),
    (b"G10L2P7X1\n", "no such frame"),
    (b"G10L3P1X1\n", "no such L"),
    (b"G10L2P1\n", "without axes"),
    (b"G92\n", "without axes"),
    (b"G2F1X1I.5\nG53X1\n", "another motion"),
    (b"G43.1X1\n", "without Z alone"),
    (b"G80\nX1\n", "axis words in G80"),
    (b"G38.2Z0F1\n", "goes nowhere"),
    (b"G2F1X0R5\n", "goes nowhere"),
    (b"G2F1X10R4\n", "too small"),
    (b"G2F1I5\n", "an axis of its plane"),
    (b"G2F1X1K5\n", "a centre in its plane"),
    (b"G2F1X10.02I5\n", "off its circle"),
    (b"G2F1X0.6I1000\n", "off its circle"),
    (b"R5\n", "R is not used"),
    (b"G0I5X1\n", "I is not used"),
    (b"F1\nM2\nG2X2I1\nG1X0\nP4\n", "P is not used"),
    (b"X" + b"0" * 79 + b"\n", "79 characters"),
]


@pytest.mark.parametrize("text", ACCEPTED)
def test_the_rules_of_grbl_accept(text: bytes) -> None:
    assert grbl_rules.rejected(text) is None


@pytest.mark.parametrize(("text", "says"), REJECTED)
def test_the_rules_of_grbl_reject_in_the_last_line(text: bytes, says: str) -> None:
    found = grbl_rules.rejected(text)
    assert found is not None
    assert says in found[1]
    assert found[0] == text.count(b"\n")
