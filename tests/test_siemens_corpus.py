"""Programs of the corpus without macros are written for a SINUMERIK, and for their control again.

Paths agree within rounding. What only says how corners are rounded, or is shown to the operator, is
said otherwise or left out, as the certificate tells.
"""

from __future__ import annotations

import re
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from gcxform_plugins.passes.absolute import Absolute
from gcxform_plugins.passes.cycles import ExpandCycles
from seeds_kit import LONG

import gcxform as gx
from gcxform.pipeline.pipeline import Pipeline
from gcxform.plugin.registry import default_registry

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

import corpus

MACRO = re.compile(rb"#|\bO\s*<|\bo[0-9<]|\[|M98|G65", re.IGNORECASE)
COMMENT = re.compile(rb"\([^)]*\)|;.*")
LONGEST = 120_000 if LONG else 20_000  # bytes of a program
NEAR = 0.005  # mm: three decimals of ends, and of centres, twice
EVERY = 1 if LONG else 5
WRITTEN = 14  # programs that get there and back
SIEMENS = default_registry().dialect("siemens")
KNOWN = {"edge-after-tool-change": 0.0, "tool-length-axis": "Z"}
TOLD = ("start", "increment", "units", "tools", "homes", "work_offsets", "inert_m", "control")
REFUSED = {"GX501", "GX509", "GX213", "GX504", "GX230", "GX226"}


def programs():
    """Yield the jobs for programs of LinuxCNC and Fanuc that have no macros."""
    for job in corpus.counted(corpus.BESIDE, ("linuxcnc", "fanuc")):
        bare = b"\n".join(COMMENT.sub(b"", line) for line in job.text.splitlines())
        if job.chain == "absolute" and len(job.text) < LONGEST and not MACRO.search(bare):
            yield job


def there_and_back(job):
    """Return how a program and what it became differ, and that and what it became again."""
    filled = corpus.filled_in(job.dialect, job.path, "absolute", job.corpus)
    reading = filled.machine_reading
    reading = replace(reading, control={**reading.control, **KNOWN}, units="mm")
    there = Pipeline(filled.source, SIEMENS, (ExpandCycles(), Absolute()), reading).run(job.text)
    plain = replace(reading, increment=None)
    back = Pipeline(SIEMENS, filled.source, (Absolute(),), plain).run(there.text)
    made = [
        gx.read(text, dialect, **{name: getattr(told, name) for name in TOLD})
        for text, dialect, told in (
            (job.text, filled.source, reading),
            (there.text, SIEMENS, plain),
            (back.text, filled.source, reading),
        )
    ]
    return gx.compare(*made[:2]), gx.compare(*made[1:])


@pytest.mark.skipif(not corpus.BESIDE.exists(), reason="the corpus is not beside the checkout")
def test_what_is_written_for_it_comes_back_the_same():
    written = 0
    for job in [*programs()][::EVERY]:
        try:
            compared = there_and_back(job)
        except gx.GcxformError as error:
            if error.diagnostics[0].code not in REFUSED:
                raise
            continue
        written += 1
        for found in compared:
            assert found.deviation < NEAR, job.path
            assert not found.feeds, job.path
            assert found.parted is None, job.path
    assert written * EVERY >= WRITTEN - EVERY
