"""However many processes take part: the same bytes, the same certificate, or the same refusal.

Random programs under random chains are read in windows of a few lines, so that modes, offsets,
loops and compensation go on over their borders. In some of them a block is spoiled, and some are
written wrong, which the proof has to tell of the same line.
"""

from __future__ import annotations

import random
from pathlib import Path

import pytest
from properties import chains
from seeds_kit import DRAWN, LONG, shares

import gcxform as gx
from gcxform.emit.emitter import Emitted, Emitter
from gcxform.pipeline.certify import certificate
from gcxform.pipeline.output import Output
from gcxform.pipeline.run import Run
from gcxform.syntax.source import Source

COUNT = DRAWN if LONG else DRAWN // 2
SPOILED = (b"G1 X", b"G999", b"G2 X1 R0.001", b"G1 X#<nowhere>", b"M2\nG0 X5", b"(GCXFORM SEAL)")
WRONG = ((b"X1", b"X-1"), (b"Z", b"Z1"), (b"M", b"(M)"), (b"Y", b"Y2"))

emit = Emitter.emit


def program(seed: int, folder: Path) -> tuple[chains.Job, bytes]:
    """Return a chain and a program; in every third a block is one that is mostly refused."""
    job = chains.drawn(seed, folder, 30)
    choose, lines = random.Random(seed), job.source.text.split(b"\n")
    if seed % 3 == 0:
        lines.insert(choose.randrange(1, len(lines)), choose.choice(SPOILED))
    return job, b"\n".join(lines)


def outcome(pipeline: gx.Pipeline, text: bytes, window: int) -> tuple[object, ...]:
    """Return all that comes of a run."""
    parts: list[bytes] = []
    lines: list[int] = []
    out = Output(parts.append, lines)
    try:
        run = Run(pipeline, Source.of_bytes(text), "full")
        run.over(out, lambda size: None, window)
        return b"".join(parts), lines, certificate(run, out).to_json()
    except gx.GcxformError as error:
        return type(error).__name__, [each.render() for each in error.diagnostics]


def writing_wrong(seed: int, what: tuple[bytes, bytes]) -> object:
    """Return a writer that says something else in some windows."""

    def wrong(self: Emitter, *given: object) -> Emitted:
        made = emit(self, *given)  # type: ignore[arg-type]
        if (seed + len(made.text)) % 4:
            return made
        return Emitted(made.text.replace(*what, 1), made.source, made.nth)

    return wrong


@shares(COUNT, 50)
def test_any_number_of_processes_makes_the_same(
    seeds: range, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    ways = set()
    for seed in seeds:
        job, text = program(seed, tmp_path)
        choose = random.Random(seed)
        if seed % 5 == 0:
            monkeypatch.setattr(Emitter, "emit", writing_wrong(seed, choose.choice(WRONG)))
        window, found = choose.choice((40, 80, 200)), []
        for copies in (False, True):
            monkeypatch.setattr("gcxform.system.worker.LINUX", copies)
            found.append(outcome(job.chain.pipeline(tmp_path), text, window))
        monkeypatch.setattr(Emitter, "emit", emit)
        assert found[0] == found[1], f"seed {seed}\n{job.chain}\n{text.decode('latin-1')}"
        ways.add(len(found[0]))
    assert ways == {2, 3}  # some were refused, some went through
