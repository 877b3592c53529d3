"""`gcxform view`: one HTML file in which a program is looked at, or two side by side."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click
import numpy as np

from gcxform.cli import VERBS
from gcxform.cli.common import options
from gcxform.cli.common.failures import warn
from gcxform.cli.common.outputs import STDOUT, check_places, destination
from gcxform.cli.common.programs import opened
from gcxform.cli.common.request import Asked, excluding, needed_dialect
from gcxform.cli.program.sidecars import Beside
from gcxform.contract.passes import Pass
from gcxform.pipeline.pipeline import Pipeline
from gcxform.plugin.registry import default_registry
from gcxform.syntax.source import Source
from gcxform.view.pages import Page
from gcxform.view.reading import Shown, on_machines, read, read_for
from gcxform.view.scene import around


@click.command("view", help=VERBS["view"], short_help=VERBS["view"])
@options.pipeline_options
@click.option(
    "-o", "--output", metavar="FILE", default="view.html", show_default=True, help="The page."
)
@click.argument("file", metavar="FILE")
@click.argument("other", metavar="[OUTPUT]", required=False)
def command(file: str, other: str | None, output: str, **asked: Any) -> None:
    """Write a page that shows FILE, or FILE and what became of it.

    That is OUTPUT, with the certificate and the source map that lie beside it, or with -p or -x
    what the pipeline makes of FILE.
    """
    what = Asked(**asked)
    check_places({"-o": output}, [file, other, what.file, what.machine])
    if other is not None and (what.pipeline or what.chain is not None):
        raise excluding("OUTPUT and a pipeline")
    if file == other == STDOUT:
        raise excluding("stdin as FILE and stdin as OUTPUT")
    if other is not None:
        page = _two(file, other, what)
    else:
        page = _run(file, what) if what.says_chain else _one(file, what)
    with destination(output) as put:
        put(page)


def _one(file: str, what: Asked) -> bytes:
    shown = _shown(file, needed_dialect(what.dialect), what)
    return _page(Path(file).name, shown).of_one(shown)


def _two(file: str, other: str, what: Asked) -> bytes:
    source = _shown(file, needed_dialect(what.dialect), what)
    output = _shown(other, what.to or needed_dialect(what.dialect), what, what.dialect)
    beside = Beside.of(other, source.sha256, output.sha256)
    title = f"{Path(file).name} and {Path(other).name}"
    page = _page(title, source)
    page.certificate = beside.certificate
    page.notes += beside.notes
    return page.of_two(source, output, beside.origin)


def _run(file: str, what: Asked) -> bytes:
    """Return the page of a program and of what a pipeline makes of it, which is proved."""
    pipeline = what.build()
    warn((*default_registry().diagnostics, *pipeline.warnings))
    parts: list[bytes] = []
    lines: list[int] = []
    with opened(file) as source:
        certificate = pipeline.run_stream(source, parts.append, "on", lines)
        shown = read_for(pipeline, source)
    warn(certificate.warnings)
    output = _written(pipeline, b"".join(parts), file)
    shown, output = on_machines(pipeline, shown, output)
    page = _page(Path(file).name, shown, pipeline.path_passes)
    page.certificate = certificate.described()
    return page.of_run(pipeline, shown, output, np.array(lines, np.int64))


def _written(pipeline: Pipeline, text: bytes, file: str) -> Shown:
    """Return what a pipeline wrote as it is shown."""
    reading = pipeline.reading_of_output(pipeline.reading_at_start(pipeline.source.axes))
    name = f"{Path(file).name}, as written"
    return read(Source.of_bytes(text, name), pipeline.target, reading)


def _shown(file: str, dialect: str, what: Asked, of: str | None = None) -> Shown:
    with opened(file) as source:
        return read(source, *what.reads(dialect, of or ""))


def _page(title: str, shown: Shown, steps: Sequence[Pass] = ()) -> Page:
    """Return a page without programs, with what a machine file and the steps say."""
    machine = shown.machine
    axes = machine.axes if machine is not None else {}
    speeds = {letter: axis.max_speed for letter, axis in axes.items() if axis.max_speed}
    return Page(title, speeds, scene=around(shown.path, machine, steps))
