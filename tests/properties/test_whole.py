"""LinuxCNC as the judge of programs over the whole language: read, and written by random chains."""

from __future__ import annotations

import random
from collections import Counter
from dataclasses import replace

import pytest
from hypothesis import settings
from oracles import rs274
from oracles.canon import CanonProgram
from oracles.toolpaths import difference, read
from properties.test_shifts import CLOSE, TOOLS, gone_elsewhere, vector, written

import gcxform as gx
from gcxform.testing.generate import Options
from gcxform.testing.whole import WholeBuilder

COUNT = 20 * settings.default.max_examples  # 2,000; the profile `long` asks for more
CHUNK = 500
SLACK = 0.02  # mm, chord error and tolerance of the steps
STEPS = (
    "cycles",
    "cutter-comp",
    "offsets",
    "absolute",
    "metric",
    "plane",
    f"segment chord-error={SLACK}mm",
    f"segment chord-error={SLACK}mm max-length=20mm",
    f"arcs tolerance={SLACK}mm",
    "feed mode=inverse-time",
    "feed mode=per-minute",
)
REFUSALS = {"GX233", "GX314", "GX320", "GX501", "GX506", "GX350", "GX504"}
"""What a chain may refuse of a program that is right."""

pytestmark = pytest.mark.skipif(not rs274.available(), reason="rs274 (LinuxCNC) is not installed")


def drawn(seed: int, blocks: int = 30) -> bytes:
    options = Options(max_blocks=blocks)
    return WholeBuilder(random.Random(seed).randint, options, vector).build()


def test_gcxform_reads_the_whole_language_as_linuxcnc_does() -> None:
    codes: Counter[str] = Counter()
    for first in range(0, COUNT, CHUNK):
        sources = [drawn(seed) for seed in range(first, min(first + CHUNK, COUNT))]
        for source, canon in zip(sources, rs274.run_many(sources), strict=True):
            assert isinstance(canon, CanonProgram), (canon, source.decode("latin-1"))
            problem = difference(read(source, TOOLS), canon)
            assert problem == "", f"{problem}\n{source.decode('latin-1')}"
            codes["cycles"] += b"G80" in source
            codes["contours"] += b"41.1" in source or b"42.1" in source
    assert min(codes.values()) > COUNT / 10


def chain_of(choose: random.Random) -> str:
    return " | ".join(dict.fromkeys(choose.choice(STEPS) for _ in range(choose.randint(1, 4))))


def test_the_machine_goes_where_it_went_after_any_chain() -> None:
    """Machine coordinates after each line are the same, as LinuxCNC tells its offsets."""
    jobs, refused = [], Counter[str]()
    for seed in range(COUNT):
        choose = random.Random(seed)
        chain, source = chain_of(choose), drawn(seed, 12)
        try:
            text, lines = written(chain, source, choose.choice((60, 200, 1 << 20)))
        except gx.VerificationError as error:
            pytest.fail(f"{chain}: {error}\n{source.decode('latin-1')}")
        except gx.UsageError:
            continue
        except gx.InputError as error:
            refused[error.diagnostics[0].code] += 1
            continue
        jobs.append((chain, source, text, lines))
    assert set(refused) <= REFUSALS, refused
    assert len(jobs) > 0.6 * COUNT
    before = rs274.run_many([job[1] for job in jobs])
    after = rs274.run_many([job[2] for job in jobs])
    for job, old, new in zip(jobs, before, after, strict=True):
        problem = went_elsewhere(job, old, new)
        assert problem == "", f"{problem}\n{job[0]}\n{job[1].decode()}\n{job[2].decode()}"


Job = tuple[str, bytes, bytes, list[int]]
Answer = CanonProgram | rs274.Rejected


def went_elsewhere(job: Job, old: Answer, new: Answer) -> str:
    chain, _, _, lines = job
    if not isinstance(old, CanonProgram) or not isinstance(new, CanonProgram):
        return f"LinuxCNC refuses: {old} {new}"
    if "arcs" in chain:  # lines were joined: their ends are not places of the output
        return gone_elsewhere(at_the_end(old), at_the_end(new), lines, CLOSE + 2 * SLACK)
    return gone_elsewhere(old, new, lines, CLOSE + SLACK * ("segment" in chain))


def at_the_end(program: CanonProgram) -> CanonProgram:
    return replace(program, moves=program.moves[-1:])
