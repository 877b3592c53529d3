"""Exit 4 never happens by itself: random programs under random chains, and LinuxCNC as the judge.

Whatever the checker accepts ends in a program that is proved, or in a refusal: never in a
verification that fails, never in a bug. What is proved goes where the source went, in coordinates
of the machine, with all that happens on the way. `python tests/fuzz.py` tries as many as one likes.
"""

from __future__ import annotations

import random
from dataclasses import replace
from pathlib import Path

import pytest
import test_corpus
from check_kit import new_in_output
from hypothesis import settings
from oracles import rs274, ways
from oracles.canon import CanonProgram
from properties import chains
from properties.figures import Figures
from seeds_kit import DRAWN, shares

import gcxform as gx
from gcxform.plugin.registry import default_registry
from gcxform.testing.cases import read_case

LONG = settings.default.max_examples > 1000
COUNT = DRAWN if LONG else 5 * DRAWN
TARGETS = ("fanuc", "grbl", "haas", "linuxcnc")
CASES = [case for case in map(read_case, test_corpus.paths()) if not case.xfail]

judged = pytest.mark.skipif(not rs274.available(), reason="rs274 (LinuxCNC) is not installed")


@judged
@shares(COUNT, 25)
def test_a_chain_that_is_accepted_is_proved_and_right_or_refuses(seeds: range) -> None:
    total = Figures()
    for figures in chains.campaign(seeds):
        total += figures
    assert not total.wrong, f"{len(total.wrong)} of {len(seeds)}, the first:\n{total.wrong[0]}"
    assert total.counts["passed"] > len(seeds) / 3, str(total)


@shares(len(CASES), 150)
def test_every_case_of_the_corpus_ends_so_too(seeds: range, tmp_path: Path) -> None:
    """With two random steps in the place of its own, for any target, which takes what is written.

    All of them in the long profile.
    """
    passed = 0
    for number in seeds[:: 1 if LONG else 6]:
        case, folder = CASES[number], tmp_path / str(number)
        folder.mkdir()
        choose = random.Random(number)
        chain, pipeline = chains.of_case(case, folder, choose, test_corpus.PLACES)
        if pipeline is None:
            continue
        program, other = case.sections["input.nc"], choose.choice(TARGETS)
        try:
            if choose.random() < 0.4:
                pipeline = replace(pipeline, target=default_registry().dialect(other))
            found = pipeline.run(program, verify="full").text
        except gx.VerificationError as error:
            pytest.fail(f"{case.path}: {chain}: {error}")
        except (gx.InputError, gx.UsageError):
            continue
        assert not new_in_output(program, found, pipeline), f"{case.path}: {chain}"
        passed += 1
    assert passed


PROGRAM = """\
G21 G90 G94 G17
G0 X0 Y0 Z5
M8
G1 Z-1 F100
X40
G2 X60 Y20 I0 J20
G1 X40
G1 Y40
X30
X40
G0 Z5
M9
M2
"""
CHANGES = {
    "a corner is cut": ("X40\nG2", "X40 Y0.05\nG2"),
    "the sense of an arc": ("G2 X60 Y20", "G3 X60 Y20"),
    "there and back is left out": ("X30\nX40\n", ""),
    "another way, the same ends": ("G1 Y40\nX30\nX40", "G1 X30 Y40\nX40"),
    "a rapid cuts": ("G0 Z5\nM9", "G1 Z5\nM9"),
    "a cut is a rapid": ("G1 Y40", "G0 Y40"),
    "a speed": ("F100", "F120"),
    "coolant late": ("M8\nG1 Z-1 F100\n", "G1 Z-1 F100\nM8\n"),
    "coolant not at all": ("M8\n", ""),
    "exact stops": ("M8\n", "G61\nM8\n"),
    "a message": ("M8\n", "(MSG,now)\nM8\n"),
}


@judged
@pytest.mark.parametrize("name", CHANGES)
def test_the_judge_sees(name: str) -> None:
    """What it is there for; a way in other pieces is the same to it."""
    other = PROGRAM.replace(*CHANGES[name])
    pieces = PROGRAM.replace("X30", "X35\nX30").replace("Y20 I0", "Y20.001 I0")
    assert other != PROGRAM
    old, wrong, same = rs274.run_many([t.encode() for t in (PROGRAM, other, pieces)])
    assert isinstance(old, CanonProgram)
    assert isinstance(wrong, CanonProgram)
    assert isinstance(same, CanonProgram)
    assert ways.difference(old, same, 0.01) == ""
    assert ways.difference(old, wrong, 0.01) != ""


@judged
def test_the_judge_sees_an_error_of_the_machine() -> None:
    errors = chains.Errors(((0.0, 100.0),) * 3, (((0.0, 0.04),) * 3,) * 3)
    (old,) = rs274.run_many([PROGRAM.encode()])
    assert isinstance(old, CanonProgram)
    assert ways.difference(old, old, 0.01, errors.goes) != ""
    assert (
        ways.difference(old, old, 0.01, replace(errors, values=(((0.0, 0.0),) * 3,) * 3).goes) == ""
    )
