"""One program, one fact about a control: gcxform reads it so, or refuses what it should refuse.

The facts of `tests/facts` are ours; those beside the checkout are run where they are. Facts about
controls that there is no dialect for are skipped, by the name of the control.
"""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from facts import grbl, record
from facts.known import KNOWN
from facts.matching import NotReadYet, problem
from oracles import rs274

HERE = Path(__file__).parent
BESIDE = HERE.parents[1] / "shared" / "dialect-facts"
OURS = [*json.loads(record.RECORDED.read_text("utf-8")), *grbl.facts()]
SHARED = sorted(BESIDE.glob("*.json"))


def check(fact, program):
    try:
        wrong = problem(fact, program)
    except NotReadYet as reason:
        pytest.skip(str(reason))
    assert not wrong, f"{fact.get('fact', '')}\n{wrong}\n{program.decode('latin-1')}"


@pytest.mark.parametrize("fact", OURS, ids=lambda fact: fact["name"])
def test_our_facts(fact):
    check(fact, fact["program"].encode())


def parameter(path):
    why = KNOWN.get(path.stem, "")
    marks = [pytest.mark.xfail(strict=True, reason=why)] if why else []
    return pytest.param(path, id=path.stem, marks=marks)


@pytest.mark.skipif(not SHARED, reason="no collection of facts beside the checkout")
@pytest.mark.parametrize("path", [parameter(path) for path in SHARED])
def test_facts_beside_the_checkout(path):
    fact = json.loads(path.read_text("utf-8"))
    check(fact, (path.parent / fact["file"]).read_bytes())


def test_names_are_of_one_fact():
    names = [fact["name"] for fact in OURS]
    assert len(set(names)) == len(names)


@pytest.mark.by_turns
@pytest.mark.skipif(not rs274.available(), reason="rs274 is not installed")
@pytest.mark.parametrize("fact", [*record.facts()], ids=lambda fact: fact["name"])
def test_linuxcnc_still_says_so(fact):
    stored = {one["name"]: one for one in OURS}
    assert json.loads(json.dumps(record.recorded(fact))) == stored[fact["name"]]


def test_every_program_is_recorded():
    stored = {f["name"]: f["program"] for f in OURS if f["dialect"] == "linuxcnc"}
    assert {f["name"]: f["text"] for f in record.facts()} == stored


# --- a wrong meaning is noticed ---

FACT = {
    "dialect": "linuxcnc",
    "expect": "ok",
    "motions": [
        {"type": "canon", "call": "START_SPINDLE_CLOCKWISE", "args": "0"},
        {"type": "rapid", "end": {"X": 1}},
        {"type": "dwell", "seconds": 1.0},
        {"type": "feed", "end": {"X": 2, "Y": 0}, "F": 100},
        {"type": "arc", "sense": "cw", "turns": 1, "end": {"X": 4}, "center": {"X": 3, "Y": 0}},
    ],
    "end_position": {"X": 4},
    "something_else": 7,
}
GOOD = "S1 M3\nG0 X1\nG4 P1\nG1 X2 F100\nG2 X4 I1\nM2\n"


def test_a_good_reading_passes():
    assert problem(FACT, GOOD.encode()) == ""
    assert problem(FACT | {"expect": "refuse"}, GOOD.encode())


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("M3", "M4"),
        ("S1 M3\nG0 X1", "G0 X1\nS1 M3"),
        ("X1", "X1.0002"),
        ("P1", "P2"),
        ("G4 P1\n", ""),
        ("F100", "F101"),
        ("G2", "G3"),
        ("G2 X4 I1", "G2 X4 I1 P2"),
        ("G2 X4 I1", "G2 X4 R1.5"),
        ("M2", "X9\nM2"),
        ("G0 X1", "G0 X1\nX2 Y1"),
        ("X2", "X2 Y3"),
        ("G0 X1\n", ""),
        ("M2", "M9\nM2"),
        ("M2", "G99.9\nM2"),
    ],
)
def test_a_wrong_reading_fails(before, after):
    assert problem(FACT, GOOD.replace(before, after, 1).encode())


def test_what_cannot_be_interpreted_fails_with_the_reason():
    unknown = FACT | {"motions": [{"type": "canon", "call": "WHATEVER", "args": ""}]}
    assert "WHATEVER" in problem(unknown, GOOD.encode())
    assert "leap" in problem(FACT | {"motions": [{"type": "leap"}]}, GOOD.encode())
    assert "perhaps" in problem(FACT | {"expect": "perhaps"}, GOOD.encode())
    assert "JUMP" in problem({"dialect": "grbl", "expect": "ok", "trace": ["JUMP X1"]}, b"G0X1\n")
