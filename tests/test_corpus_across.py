"""Real programs in other dialects: proved, and `check` finds nothing there that it does not here.

By default each so manieth of them; all in the profile for the night. `benchmarks/translation.py`
says what comes of each, and counts.
"""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from seeds_kit import LONG

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

import translation

import corpus

EVERY = 1 if LONG else 23
FIRST = {"linuxcnc": 3, "fanuc": 7, "haas": 11, "grbl": 15}
"""Which of them is the first, by target: not the same for all."""
BROKEN = {"CRASH", "NOT VERIFIED", "CHECK", "RS274"}


def pairs(target: str) -> list[translation.Pair]:
    if not corpus.BESIDE.is_dir():
        pytest.skip(f"{corpus.BESIDE} is not here: real programs are not run")
    jobs = corpus.counted(corpus.BESIDE, [d for d in translation.TARGETS if d != target])
    whole = [job for job in jobs if job.chain == "absolute"]
    return [translation.Pair(job, target) for job in whole[FIRST[target] % EVERY :: EVERY]]


@pytest.mark.parametrize("target", translation.TARGETS)
def test_check_finds_nothing_new_in_a_result(target: str) -> None:
    found = [(pair, translation.translate(pair).outcome) for pair in pairs(target)]
    for pair, one in found:
        assert one.code not in BROKEN, f"{pair.job.path}: {one.code} {one.line} {one.says}"
    assert not all(one.code for _, one in found), "all were refused"


def test_a_finding_that_the_source_has_not_is_one() -> None:
    """A line that a GRBL does not take, in a result that is otherwise proved."""
    pair = pairs("grbl")[0]
    text = b"G21 G90 G94 G17\nG0 X1.\nM2\n"
    assert not translation.new_findings(pair, text)
    assert translation.new_findings(pair, text.replace(b"M2", b"G91.7\nM2")) == {"GX201"}
