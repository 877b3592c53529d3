"""`gcxform watch`: a hot folder, for CAM systems and senders that only write and read files."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import Any

import click

from gcxform.cli import VERBS
from gcxform.cli.common import options
from gcxform.cli.common.answer import answer, lines_of_documents
from gcxform.cli.common.failures import WORDS, reported, say
from gcxform.cli.common.pipelines import Pipelines
from gcxform.cli.common.programs import opened
from gcxform.cli.common.request import Asked
from gcxform.cli.common.several import Outcome, attempt
from gcxform.cli.common.transform import Job
from gcxform.cli.run import summary
from gcxform.cli.watching.folders import Folders
from gcxform.cli.watching.loop import waker, watch
from gcxform.cli.watching.service import FILES, text_of
from gcxform.cli.watching.whole_files import Settling
from gcxform.cli.watching.work import Told, Work, document
from gcxform.diagnostics import GcxformError, UsageError
from gcxform.pipeline.pipeline import Pipeline
from gcxform.system.alone import alone, ignore_leases
from gcxform.system.inputs import visit

SECONDS = click.FloatRange(0.0, 3600.0)


@click.command("watch", help=VERBS["watch"], short_help=VERBS["watch"])
@options.pipeline_options
@click.option("-o", "--output", metavar="OUT", help="Where results go.  [default: DIR/out]")
@click.option(
    "--rest",
    metavar="SECONDS",
    type=SECONDS,
    default=2.0,
    show_default=True,
    help="For how long a file must not change before it is taken.",
)
@click.option(
    "--every",
    metavar="SECONDS",
    type=SECONDS,
    default=1.0,
    show_default=True,
    help="How often the folder is looked at, if no event comes before.",
)
@click.option("--once", is_flag=True, help="Do what is there, and end.")
@click.option(
    "--service",
    type=click.Choice(list(FILES)),
    help="Print the file by which a system runs this command, and end.",
)
@options.VERIFY
@click.argument("folder", metavar="DIR")
def command(
    folder: str,
    output: str | None,
    rest: float,
    every: float,
    once: bool,
    service: str | None,
    verify: str,
    **asked: Any,
) -> int:
    """Transform what is dropped into a folder, each program once, as soon as it is whole.

    Results go to OUT, programs to DIR/done with their certificates, those that are refused to
    DIR/failed with the reason beside them. A line is printed for each.
    """
    folders = Folders(Path(folder), Path(output) if output else Path(folder) / "out")
    what = Asked(**asked).beside(os.path.join(folder, "any"))
    if service is not None:
        if what.pipeline is None and what.chain is None and what.found is None:
            hint = "-p FILE, -x CHAIN, or gcxform.toml in the folder: a variable may be another one"
            raise UsageError.one("GX726", "which pipeline is the service to run?", hint=hint)
        what.build()
        text = text_of(service, _words(), folder)
        answer({"text": text}, [text.rstrip("\n")])
        return 0
    Pipelines(what).of(folder)  # what is wrong with it is said before anything is taken
    folders.make()
    with ExitStack() as stack:
        lock = stack.enter_context(alone(folders.lock))
        if lock is None:
            message = f"another watcher is at work in {folder}"
            raise UsageError.one("GX751", message, hint="end that one first")
        wait = stack.enter_context(waker(folders.folder))
        ignore_leases()
        shop = Shop(what, folders.folder, stack.enter_context(lines_of_documents()))
        work = Work(
            folders, shop.run, shop.check, shop.line, shop.tell, Job("", None, None, None, verify)
        )
        watch(work, Settling(folders.folder, rest), shop.ready, wait, every, lock, once)
    return max(work.exit_code, 5 if work.waits else 0)


class Shop:
    """The pipeline of a folder, read anew before programs are done: it may have been changed."""

    def __init__(self, asked: Asked, folder: Path, put: Callable[[str], None] | None) -> None:
        self.asked, self.folder, self.put = asked, folder, put
        self.pipeline: Pipeline | None = None
        self.complaint = ""

    def ready(self) -> bool:
        """Build the pipeline; say once why that cannot be."""
        try:
            with visit():
                self.pipeline = self.asked.build()
        except GcxformError as error:
            text = reported(error)[0]
            if text != self.complaint:
                say(text)
            self.complaint = text
            return False
        self.complaint = ""
        return True

    def run(self, job: Job) -> Outcome:
        """Run one program. Raises GcxformError."""
        assert self.pipeline is not None or self.ready()
        pipeline = self.pipeline
        assert pipeline is not None
        with visit():
            return attempt(lambda program: pipeline, job)

    def check(self, path: Path) -> None:
        """Raise InputError for a program that was done before. Raises FileError."""
        assert self.pipeline is not None
        with opened(str(path)) as source:
            self.pipeline.marks(source)

    def line(self, outcome: Outcome) -> str:
        """Return a line about a program that was done."""
        assert self.pipeline is not None
        assert outcome.done is not None
        said = summary(self.pipeline, outcome.done).replace("\n  ", "   ")
        return f"done   {said.partition(': ')[2]}"

    def tell(self, told: Told) -> None:
        """Print a line, or a document in a line; who reads them may have gone."""
        with suppress(OSError):
            if self.put is None:
                click.echo(told.line)
            else:
                self.put(json.dumps(document(told)))


def _words() -> list[str]:
    """Return the command line as it was typed, without what asks for the file of a service."""
    typed = iter(click.get_current_context().meta[WORDS])
    words = []
    for word in typed:
        if word == "--service":
            next(typed, None)
        elif word != "--json" and not word.startswith("--service="):
            words.append(word)
    return words
