"""One program through a pipeline to its place: what `run`, `post` and `watch` do, each its way."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, redirect_stdout
from dataclasses import field, replace
from pathlib import Path

from gcxform.cli.common.outputs import STDOUT, Put, destination
from gcxform.cli.common.progress import FilterProgress, Progress
from gcxform.cli.common.source_map import SourceMap
from gcxform.diagnostics import Diagnostic, FileError, shown
from gcxform.pipeline.certificate import Certificate
from gcxform.pipeline.pipeline import Pipeline
from gcxform.stamps.chain import edited
from gcxform.syntax.source import Source
from gcxform.system.heap import keep
from gcxform.values import dataclass


@dataclass(frozen=True)
class Job:
    """What is read and what is written; the certificate and the map only where asked for.

    `out` is None where the result goes nowhere, and `compared` says that then both texts are kept,
    to be looked at. `name` is what the program is called, if not by the name of its file, and
    `makes_folders` whether folders that are not there yet are made.
    """

    file: str
    out: str | None
    certificate: str | None = None
    source_map: str | None = None
    verify: str = "on"
    quiet: bool = False
    filters: bool = False  # a host reads how far it is
    compared: bool = False
    name: str = ""
    makes_folders: bool = False


@dataclass
class Texts:
    """A program before and after: bytes, the source line of each line, from 0, and who changed it.

    `steps` has for a line of the source, from 0, the names of the steps that have changed it.
    """

    source: bytes = b""
    output: list[bytes] = field(default_factory=list)
    lines: list[int] = field(default_factory=list)
    steps: dict[int, list[str]] = field(default_factory=dict)

    def told(self, step: str, lines: Sequence[int]) -> None:
        """Remember which lines a step has changed."""
        for line in lines:
            names = self.steps.setdefault(line, [])
            names += [step] if step not in names else []


@dataclass(frozen=True)
class Done:
    """What a run has shown, how long it took (s), and both texts if they were to be compared."""

    certificate: Certificate
    seconds: float
    texts: Texts | None = None

    @property
    def changed(self) -> bool:
        """Whether the result has other bytes than the program."""
        found = self.certificate
        return bool(found.source["sha256"] != found.output["sha256"])


def transformed(pipeline: Pipeline, source: Source, job: Job) -> Done:
    """Run a pipeline on a source; the output appears last, when all that belongs to it is written.

    Raises GcxformError, and then the output's place is as it was.
    """
    began = time.perf_counter()
    keep()
    texts = Texts() if job.compared else None
    if texts is not None:
        pipeline = replace(pipeline, told=texts.told)
    mapped = SourceMap() if job.source_map else None
    lines = texts.lines if texts is not None else mapped
    with _place(job, texts) as put:
        kind = FilterProgress if job.filters else Progress
        progress = kind(source.size, job.quiet and not job.filters)
        try:
            with redirect_stdout(sys.stderr):  # stdout is for the program: plugins may print
                certificate = pipeline.run_stream(source, put, job.verify, lines, progress)
        finally:
            progress.close()
        if texts is not None:
            texts.source = _whole(source)
            if mapped is not None:
                mapped += texts.lines
        if job.out == job.file != STDOUT and not source.is_still(Path(job.file)):
            raise FileError.one("GX904", f"{shown(source.name)} changed while it was worked on")
        _write_beside(job, certificate, mapped)
    return Done(certificate, time.perf_counter() - began, texts)


@contextmanager
def _place(job: Job, texts: Texts | None) -> Iterator[Put]:
    """Give what takes the bytes of the result."""
    if job.out is None:
        yield (lambda part: None) if texts is None else texts.output.append
        return
    with destination(job.out) as put:
        yield put


def _whole(source: Source) -> bytes:
    return b"".join(source.windows())


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
        texts.append((job.source_map, lines.to_json(certificate, job.out or "-")))
    _write_all(texts)


def _write_all(texts: list[tuple[str, str]]) -> None:
    """Write texts so that none appears before the bytes of all are taken."""
    if texts:
        (name, text), *rest = texts
        with destination(name) as put:
            put(text.encode())
            _write_all(rest)
