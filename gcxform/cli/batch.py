"""`gcxform batch`: a plant's programs, pipelines and machines; what is done is not done again."""

from __future__ import annotations

import os
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Final

import click

from gcxform.cli import VERBS
from gcxform.cli.common import options
from gcxform.cli.common.answer import answer, asked, note_written
from gcxform.cli.common.failures import say
from gcxform.cli.common.progress import Progress
from gcxform.cli.plant.batch_run import Batch
from gcxform.cli.plant.pools import Rows, here, scheduled
from gcxform.cli.plant.report import page
from gcxform.cli.plant.results import KINDS, opened, write_table
from gcxform.cli.plant.rows import STATES, Row
from gcxform.cli.plant.stores import is_url, store_of
from gcxform.cli.plant.tasks import Entry, Task, load_manifest, tasks_of
from gcxform.cli.plant.work import HIDDEN
from gcxform.diagnostics import UsageError, shown
from gcxform.system.alone import alone
from gcxform.system.files import write_atomically

RESULTS: Final = "results.sqlite"
FAILED: Final = 5


@click.command("batch", help=VERBS["batch"], short_help=VERBS["batch"])
@click.option("--manifest", metavar="FILE", help="Lists of programs, pipelines, machines (TOML).")
@click.option("-p", "--pipeline", "pipelines", metavar="FILE", multiple=True, help="Pipelines.")
@click.option("-m", "--machine", "machines", metavar="FILE", multiple=True, help="Machine files.")
@click.option("-x", "--chain", metavar="CHAIN", help="Passes, instead of pipelines.")
@options.FROM
@options.TO
@click.option("-o", "--output", metavar="DIR", required=True, help="A folder, or a URL.")
@click.option(
    "--results", metavar="FILE", help=f"The table of results (SQLite).  [default: DIR/{RESULTS}]"
)
@click.option("--table", metavar="FILE", help=f"The results as a table, too ({', '.join(KINDS)}).")
@click.option("--report", metavar="FILE", help="A page about all of them (HTML).")
@click.option(
    "-j", "--processes", type=click.IntRange(1, 1024), help="Processes.  [default: as processors]"
)
@click.option("--scheduler", metavar="ADDRESS", help="A scheduler of Dask: tcp://HOST:8786.")
@click.option("--anew", is_flag=True, help="Do everything, also what is done.")
@options.VERIFY
@options.QUIET
@click.argument("programs", metavar="[PROGRAM]...", nargs=-1)
def command(
    programs: tuple[str, ...],
    manifest: str | None,
    pipelines: tuple[str, ...],
    machines: tuple[str, ...],
    chain: str | None,
    dialect: str | None,
    to: str | None,
    output: str,
    results: str | None,
    table: str | None,
    report: str | None,
    processes: int | None,
    scheduler: str | None,
    anew: bool,
    verify: str,
    quiet: bool,
) -> int:
    """Transform many programs by many pipelines for many machines, each once.

    Results go to DIR, and what became of each to the table of results. Who calls again does what
    is new or has changed, and what failed; what was refused stays so until a file changes.
    """
    entry = Entry(list(programs), "", list(pipelines), list(machines), chain, dialect, to)
    entries, folder = _entries(manifest, entry)
    tasks = tasks_of(entries, output, verify, folder)
    began = time.monotonic()
    with ExitStack() as stack:
        stack.enter_context(_alone(output))
        base = stack.enter_context(opened(_place_of_results(output, results)))
        batch = Batch(tasks, base, store_of(output))
        batch.recover()
        if scheduler is None:
            batch.sweep()
        left = list(tasks) if anew else batch.left()
        show = stack.enter_context(_shown(len(left), quiet))
        batch.do(_rows(left, processes, scheduler), show)
        rows = batch.rows()
    _write(rows, table, report)
    _tell(rows, len(left), time.monotonic() - began, quiet)
    return max((row.exit_code for row in rows), default=0)


def _entries(manifest: str | None, entry: Entry) -> tuple[list[Entry], str]:
    """Return the lists of programs, and the folder from which names count. Raises UsageError."""
    if manifest is None:
        if not entry.programs:
            raise UsageError.one("GX700", "no programs are named", hint="PROGRAM... or --manifest")
        return [entry], ""
    if any((entry.programs, entry.pipelines, entry.machines, entry.chain, entry.dialect, entry.to)):
        message = "--manifest, and what is said of programs and pipelines, exclude each other"
        raise UsageError.one("GX728", message, hint="write it into the manifest")
    return load_manifest(Path(manifest)), os.path.dirname(manifest)


@contextmanager
def _alone(output: str) -> Iterator[None]:
    """Keep others out of a folder of results. Raises UsageError if somebody is there."""
    if is_url(output):
        yield
        return
    hidden = Path(output, HIDDEN)
    hidden.mkdir(parents=True, exist_ok=True)
    with alone(hidden / "lock") as lock:
        if lock is None:
            message = f"another batch is at work in {output}"
            raise UsageError.one("GX751", message, hint="end that one first")
        yield


def _place_of_results(output: str, results: str | None) -> Path:
    if results is None and is_url(output):
        message = f"the table of results cannot be kept at {output}"
        raise UsageError.one("GX702", message, hint=f"--results {RESULTS}")
    return Path(results or Path(output, RESULTS))


def _rows(left: Sequence[Task], processes: int | None, scheduler: str | None) -> Rows:
    if not left:
        return iter(())
    if scheduler is not None:
        return scheduled(left, scheduler)
    return here(left, min(len(left), processes or _processors()))


def _processors() -> int:
    affinity = getattr(os, "sched_getaffinity", None)
    return len(affinity(0)) if affinity else os.cpu_count() or 1


class _Counting(Progress):
    """Shows how many programs are done, of how many, and how many of them came through."""

    through = 0

    def show(self, percent: int) -> None:
        """Write the numbers."""
        text = f"\r\x1b[K{self.done} of {self.size} programs, {self.through} through"
        print(text, end="", file=sys.stderr, flush=True)


@contextmanager
def _shown(count: int, quiet: bool) -> Iterator[Callable[[Row], None]]:
    """Give what is told of each row."""
    progress = _Counting(count, quiet)

    def told(row: Row) -> None:
        progress.through += row.through
        progress(1)

    try:
        yield told
    finally:
        progress.close()


def _write(rows: Sequence[Row], table: str | None, report: str | None) -> None:
    if table is not None:
        write_table(Path(table), rows)
        note_written(table)
    if report is not None:
        with write_atomically(Path(report)) as put:
            put(page(rows).encode("utf-8", "backslashreplace"))
        note_written(report)


def _tell(rows: Sequence[Row], done: int, seconds: float, quiet: bool) -> None:
    """Say how many came through, and for each code how many did not."""
    states = Counter(row.state for row in rows)
    codes = Counter(row.codes.partition(" ")[0] for row in rows if not row.through)
    values = {"done": done, "states": dict(states), "codes": dict(codes)}
    if asked() is not None:
        answer({"batch": values}, ())
        return
    for row in rows:
        if row.state == "failed" or (not row.through and len(rows) <= 20):
            say(f"{shown(row.place or row.program)}: {row.state}[{row.codes}]: {row.reason}")
    if not quiet:
        said = ", ".join(f"{states[state]} {state}" for state in STATES if states[state])
        why = (
            "; refused: " + ", ".join(f"{n} {c}" for c, n in codes.most_common(5)) if codes else ""
        )
        say(f"{len(rows)} programs: {said}{why}; {done} done now in {seconds:.2f} s")
