"""The work that `run` and `post` share: one program through a pipeline to its place."""

from __future__ import annotations

import sys
import time
from contextlib import redirect_stdout
from dataclasses import dataclass

from gcxform.cli.common.outputs import destination
from gcxform.cli.common.programs import opened
from gcxform.cli.common.progress import FilterProgress, Progress
from gcxform.cli.common.source_map import SourceMap
from gcxform.diagnostics import Diagnostic
from gcxform.pipeline.certificate import Certificate
from gcxform.pipeline.pipeline import Pipeline
from gcxform.stamps.chain import edited
from gcxform.syntax.source import Source
from gcxform.system.heap import keep


@dataclass(frozen=True)
class Job:
    """What is read and what is written; the certificate and the map only where asked for."""

    file: str
    out: str
    certificate: str | None = None
    source_map: str | None = None
    verify: str = "on"
    quiet: bool = False
    filters: bool = False  # a host reads how far it is


@dataclass(frozen=True)
class Done:
    """What a run has shown, and how long it took (s)."""

    certificate: Certificate
    seconds: float


def transform(pipeline: Pipeline, job: Job) -> Done:
    """Run a pipeline; the output appears last, when all that belongs to it is written.

    Raises GcxformError, and then the output's place is as it was.
    """
    with opened(job.file) as source:
        return transformed(pipeline, source, job)


def transformed(pipeline: Pipeline, source: Source, job: Job) -> Done:
    """Do the same with a source that is open already."""
    began = time.perf_counter()
    keep()
    lines = SourceMap() if job.source_map else None
    with destination(job.out) as put:
        kind = FilterProgress if job.filters else Progress
        progress = kind(source.size, job.quiet and not job.filters)
        try:
            with redirect_stdout(sys.stderr):  # stdout is for the program: plugins may print
                certificate = pipeline.run_stream(source, put, job.verify, lines, progress)
        finally:
            progress.close()
        _write_beside(job, certificate, lines)
    return Done(certificate, time.perf_counter() - began)


def edited_since(certificate: Certificate) -> list[Diagnostic]:
    """Return the warning about a source that is not what it was when it was stamped, if any."""
    said = certificate.stamps
    return [*edited(said["edited"], certificate.source["name"], said["line"])]


def _write_beside(job: Job, certificate: Certificate, lines: SourceMap | None) -> None:
    """Write the certificate and the source map."""
    texts = []
    if job.certificate:
        texts.append((job.certificate, certificate.to_json()))
    if job.source_map and lines is not None:
        texts.append((job.source_map, lines.to_json(certificate, job.out)))
    _write_all(texts)


def _write_all(texts: list[tuple[str, str]]) -> None:
    """Write texts so that none appears before the bytes of all are taken."""
    if texts:
        (name, text), *rest = texts
        with destination(name) as put:
            put(text.encode())
            _write_all(rest)
