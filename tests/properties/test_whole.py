"""LinuxCNC as the judge of programs over the whole language: what they mean."""

from __future__ import annotations

import random
from collections import Counter

import pytest
from oracles import rs274
from oracles.canon import CanonProgram
from oracles.toolpaths import difference, read
from properties.test_shifts import TOOLS, vector
from seeds_kit import DRAWN, shares

from gcxform.testing.generate import Options
from gcxform.testing.linuxcnc_language import WholeBuilder

COUNT = 20 * DRAWN

pytestmark = pytest.mark.skipif(not rs274.available(), reason="rs274 (LinuxCNC) is not installed")


def drawn(seed: int, blocks: int = 30) -> bytes:
    options = Options(max_blocks=blocks)
    return WholeBuilder(random.Random(seed).randint, options, vector).build()


@shares(COUNT, 250)
def test_gcxform_reads_the_whole_language_as_linuxcnc_does(seeds: range) -> None:
    codes: Counter[str] = Counter()
    sources = [drawn(seed) for seed in seeds]
    for source, canon in zip(sources, rs274.run_many(sources), strict=True):
        assert isinstance(canon, CanonProgram), (canon, source.decode("latin-1"))
        problem = difference(read(source, TOOLS), canon)
        assert problem == "", f"{problem}\n{source.decode('latin-1')}"
        codes["cycles"] += b"G80" in source
        codes["contours"] += b"41.1" in source or b"42.1" in source
    assert min(codes.values()) > len(seeds) / 10
