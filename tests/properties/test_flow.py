"""Subprograms, loops, calls and stored modes: what is executed is what LinuxCNC executes."""

from __future__ import annotations

import pytest
from oracles import flows, rs274, toolpaths
from oracles.canon import CanonProgram
from properties import executed
from seeds_kit import DRAWN, shares

import gcxform as gx

COUNT = 3 * DRAWN
RICH = 2 * DRAWN

pytestmark = pytest.mark.skipif(not rs274.available(), reason="rs274 (LinuxCNC) is not installed")


@shares(COUNT, 500)
def test_programs_with_flow_are_executed_as_linuxcnc_does(seeds: range) -> None:
    assert agreed([executed.plain(seed) for seed in seeds]) > 0.8 * len(seeds)


@shares(RICH, 200)
def test_programs_in_which_all_is_computed_are_executed_as_linuxcnc_does(seeds: range) -> None:
    assert agreed([executed.rich(seed) for seed in seeds]) > 0.35 * len(seeds)


def agreed(jobs: list[executed.Executed]) -> int:
    """Hold programs to what LinuxCNC does; return how many both execute, and alike."""
    figures = executed.judged(jobs)
    assert not figures.wrong, f"{len(figures.wrong)} of {len(jobs)}, the first:\n{figures.wrong[0]}"
    return figures.counts["compared"]


def test_the_executed_blocks_mean_the_same_by_themselves() -> None:
    """What is written out has no flow any more, and LinuxCNC does the same with it."""
    programs = [flows.program(seed) for seed in range(COUNT // 2)]
    written = [b for program in programs if (b := blocks_of(program)) not in (None, program)]
    assert len(written) > 3 * COUNT // 10
    for program, canon in zip(written, rs274.run_many(written), strict=True):
        assert isinstance(canon, CanonProgram), f"{canon}\n{program.decode()}"
        assert not any(word in program for word in (b"sub", b"call", b"while", b"M98", b"#"))
        problem = toolpaths.difference(toolpaths.read(program), canon)
        assert not problem, f"{problem}\n{program.decode()}"


def blocks_of(program: bytes) -> bytes | None:
    start, told = toolpaths.START, {"work_offsets": toolpaths.OFFSETS, "homes": toolpaths.HOMES}
    try:
        return gx.read(program, "linuxcnc", start=start, **told).executed
    except gx.InputError:
        return None
