"""Programs that keep their subprograms and loops do what they did, as LinuxCNC executes both."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from oracles import flows, lost_flows, macro_flows, rs274, toolpaths
from oracles.canon import CanonProgram
from oracles.ways import difference
from properties import executed
from seeds_kit import DRAWN, shares

import gcxform as gx

COUNT = 3 * DRAWN
MACROS = """format = 1
[input]
dialect = "{}"
increment = "IS-B"
start = {{ X = 0.0, Y = 0.0, Z = 0.0 }}
[[pass]]
use = "absolute"
"""
pytestmark = pytest.mark.skipif(not rs274.available(), reason="rs274 (LinuxCNC) is not installed")


def folded(program: bytes) -> gx.Result | None:
    try:
        return executed.ABSOLUTE.run(program)
    except gx.InputError:
        return None


def how(program: bytes, done: gx.Result) -> str:
    if done.text == program:
        return "as it was"
    why = done.certificate.written_out
    return "all" if why and why[0].startswith("the whole") else "some" if why else "none"


@shares(COUNT, 60)
def test_what_keeps_its_structure_moves_as_before(seeds: range) -> None:
    programs = [flows.program(seed, flows.Kept) for seed in seeds]
    done = [(program, result) for program in programs if (result := folded(program)) is not None]
    assert len(done) > len(seeds) // 2
    ways = Counter(how(program, result) for program, result in done)
    assert min(ways["as it was"], ways["some"] + ways["none"]) > 0, ways
    assert ways["all"] < len(done) // 2, ways
    texts = [result.text for _, result in done]
    for (program, _), text, canon in zip(done, texts, rs274.run_many(texts), strict=True):
        assert isinstance(canon, CanonProgram), f"{canon}\n{program.decode()}\n{text.decode()}"
        problem = toolpaths.difference(toolpaths.read(program), canon)
        assert not problem, f"{problem}\n{program.decode()}\n{text.decode()}"


@shares(COUNT, 60)
def test_a_program_without_increments_does_not_grow(seeds: range) -> None:
    """`absolute` has nothing to change in it, so no line is more than it was."""
    for seed in seeds:
        program = flows.program(seed, flows.Kept).replace(b"G91", b"G90")
        done = folded(program)
        if done is not None:
            assert done.text == program


@pytest.mark.parametrize("dialect", ["fanuc", "haas"])
def test_macros_that_keep_their_structure_move_as_before(dialect: str, tmp_path: Path) -> None:
    """There is no other reader of these: both programs are read here, and the proof passes."""
    (tmp_path / "p.toml").write_text(MACROS.format(dialect))
    pipeline = gx.Pipeline.load(tmp_path / "p.toml")
    ways: Counter[str] = Counter()
    for seed in range(COUNT // 5):
        program = macro_flows.program(seed, dialect == "haas")
        try:
            done = pipeline.run(program)
        except gx.InputError:
            ways["refused"] += 1
            continue
        ways[how(program, done)] += 1
        told = {"start": pipeline.reading.start, "increment": pipeline.reading.increment}
        old, new = (gx.read(text, dialect, **told).path.end for text in (program, done.text))
        assert old.shape[0] == new.shape[0]
        assert np.abs(old[:, :3] - new[:, :3]).max() < 0.01
    assert ways["refused"] <= COUNT // 50, ways
    assert min(ways["as it was"], ways["none"]) > 0, ways


@shares(DRAWN // 2, 15)
def test_every_way_is_that_of_the_program(seeds: range) -> None:
    """What programs hang on is given values in front of both texts."""
    pairs = [(program, done) for seed in seeds for program, done in written(seed)]
    assert len(pairs) > len(seeds) // 3
    both = [
        [lost_flows.made_concrete(text, values) for text in pair]
        for pair in pairs
        for values in range(2)
    ]
    old, new = (rs274.run_many(texts) for texts in zip(*both, strict=True))
    for (program, text), before, after in zip(both, old, new, strict=True):
        assert isinstance(before, CanonProgram), f"{before}\n{program.decode()}"
        assert isinstance(after, CanonProgram), f"{after}\n{text.decode()}"
        problem = difference(before, after, 0.001)
        assert not problem, f"{problem}\n{program.decode()}\n{text.decode()}"


def written(seed: int) -> list[tuple[bytes, bytes]]:
    """Return a program with what was written for it; nothing if it is refused, or decided here."""
    program = lost_flows.program(seed)
    done = folded(program)
    return [(program, done.text)] if done is not None and b"#31" in done.text else []
