"""Programs that keep their subprograms and loops do what they did, as LinuxCNC executes both."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import pytest
from hypothesis import settings
from oracles import flows, rs274, toolpaths
from oracles.canon import CanonProgram
from seeds_kit import shares

import gcxform as gx

COUNT = 3 * settings.default.max_examples  # 300; the profile `long` asks for more
PIPELINE = gx.Pipeline.parse("absolute", "linuxcnc")
ABSOLUTE = replace(
    PIPELINE,
    reading=replace(
        PIPELINE.reading,
        start=toolpaths.START,
        work_offsets=toolpaths.OFFSETS,
        homes=toolpaths.HOMES,
    ),
)

pytestmark = pytest.mark.skipif(not rs274.available(), reason="rs274 (LinuxCNC) is not installed")


def folded(program: bytes) -> gx.Result | None:
    try:
        return ABSOLUTE.run(program)
    except gx.InputError:
        return None


def how(program: bytes, done: gx.Result) -> str:
    if done.text == program:
        return "as it was"
    why = done.certificate.written_out
    return "all" if why and why[0].startswith("the whole") else "some" if why else "none"


@shares(COUNT, 100)
def test_what_keeps_its_structure_moves_as_before(seeds: range) -> None:
    programs = [flows.program(seed, flows.Kept) for seed in seeds]
    done = [(program, result) for program in programs if (result := folded(program)) is not None]
    assert len(done) > len(seeds) // 2
    ways = Counter(how(program, result) for program, result in done)
    assert min(ways[way] for way in ("as it was", "all", "some", "none")) > 0, ways
    assert ways["all"] < len(done) // 4, ways
    texts = [result.text for _, result in done]
    for (program, _), text, canon in zip(done, texts, rs274.run_many(texts), strict=True):
        assert isinstance(canon, CanonProgram), f"{canon}\n{program.decode()}\n{text.decode()}"
        problem = toolpaths.difference(toolpaths.read(program), canon)
        assert not problem, f"{problem}\n{program.decode()}\n{text.decode()}"


@shares(COUNT, 100)
def test_a_program_without_increments_does_not_grow(seeds: range) -> None:
    """`absolute` has nothing to change in it, so no line is more than it was."""
    for seed in seeds:
        program = flows.program(seed, flows.Kept).replace(b"G91", b"G90")
        done = folded(program)
        if done is not None:
            assert done.text == program
