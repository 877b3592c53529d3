"""Subprograms, loops, calls and stored modes: what is executed is what LinuxCNC executes."""

from __future__ import annotations

import pytest
from oracles import flows, rich_flows, rs274, toolpaths
from oracles.canon import CanonProgram
from seeds_kit import DRAWN, shares

import gcxform as gx

COUNT = 3 * DRAWN
RICH = 2 * DRAWN
NOT_RESOLVED = (
    "polar words are resolved in G8",
    "the control loses its place",
    "the control may run this loop once only",
    "in a do loop the control",
    "the modes are restored here",
    "one of two coolants would go off",
    "has a value that only the control knows",
    "nothing in the program has set #",  # it is so where a block before was skipped
    "turns the work offset in force, under",
    "is not known here: it was set",
    "goes where only the machine knows",
    "another unit under a tool length",
    "the control goes on counting from there",
    "is incremental, but where",  # behind a word that only the machine knows
    "an arc, but where it starts is not known",
    "is known in two ways here",
    "and calls have it that are written out",
    "from where it stands, and that is not known",
    "where this spline starts or ends in X and Y is not known",
    "an arc in a plane that is turned",
)
"""Why programs are refused that the interpreter runs, in the way that its own faults decide."""

pytestmark = pytest.mark.skipif(not rs274.available(), reason="rs274 (LinuxCNC) is not installed")


@shares(COUNT, 500)
def test_programs_with_flow_are_executed_as_linuxcnc_does(seeds: range) -> None:
    assert agreed([flows.program(seed) for seed in seeds]) > 0.8 * len(seeds)


@shares(RICH, 200)
def test_programs_in_which_all_is_computed_are_executed_as_linuxcnc_does(seeds: range) -> None:
    assert agreed([rich_flows.program(seed) for seed in seeds]) > 0.35 * len(seeds)


def agreed(programs: list[bytes]) -> int:
    """Hold programs to what LinuxCNC does; return how many both execute, and alike."""
    count = 0
    for program, canon in zip(programs, rs274.run_many(programs), strict=True):
        text = program.decode()
        try:
            path = toolpaths.read(program)
        except gx.InputError as error:
            refused = str(error)
            known = any(reason in refused for reason in NOT_RESOLVED)
            assert known or not isinstance(canon, CanonProgram), f"{refused}\n{text}"
            continue
        assert isinstance(canon, CanonProgram), f"{canon}\n{text}"
        problem = toolpaths.difference(path, canon)
        assert not problem, f"{problem}\n{text}"
        count += 1
    return count


def test_the_executed_blocks_mean_the_same_by_themselves() -> None:
    """What is written out has no flow any more, and LinuxCNC does the same with it."""
    programs = [flows.program(seed) for seed in range(COUNT // 3)]
    written = [b for program in programs if (b := executed(program)) not in (None, program)]
    assert len(written) > COUNT // 5
    for program, canon in zip(written, rs274.run_many(written), strict=True):
        assert isinstance(canon, CanonProgram), f"{canon}\n{program.decode()}"
        assert not any(word in program for word in (b"sub", b"call", b"while", b"M98", b"#"))
        problem = toolpaths.difference(toolpaths.read(program), canon)
        assert not problem, f"{problem}\n{program.decode()}"


def executed(program: bytes) -> bytes | None:
    start, told = toolpaths.START, {"work_offsets": toolpaths.OFFSETS, "homes": toolpaths.HOMES}
    try:
        return gx.read(program, "linuxcnc", start=start, **told).executed
    except gx.InputError:
        return None
