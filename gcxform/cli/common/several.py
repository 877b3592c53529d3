"""Several programs in one call: each by itself, one that fails leaves the others whole."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from typing import Any, Final

import click

from gcxform.cli.common.failures import told
from gcxform.cli.common.jobs import make_folders
from gcxform.cli.common.outputs import STDOUT, destination
from gcxform.cli.common.programs import opened
from gcxform.cli.common.transform import Done, Job, transformed
from gcxform.diagnostics import GcxformError
from gcxform.pipeline.pipeline import Pipeline
from gcxform.stamps.chain import DONE
from gcxform.syntax.source import Source
from gcxform.values import dataclass

CHANGES: Final = 1
"""The exit code of `--check` where a program would be another one."""
WORDS: Final = {
    "written": "written",
    "unchanged": "as they were",
    "would-change": "would change",
    "done-before": "done already",
    "failed": "failed",
}
"""What becomes of a program: the words of documents, and those of summaries."""


@dataclass(frozen=True)
class Outcome:
    """What became of a program: a word of `WORDS`, what the run has shown, exit code, a reason."""

    job: Job
    state: str
    done: Done | None = None
    exit_code: int = 0
    why: str = ""

    def described(self) -> dict[str, Any]:
        """Return it as plain values."""
        said: dict[str, Any] = {"file": self.job.file, "state": self.state}
        if self.job.out not in (None, "-") and self.state in ("written", "unchanged"):
            said["output"] = self.job.out
        if self.done is not None:
            said["seconds"] = round(self.done.seconds, 3)
            said["certificate"] = self.done.certificate.described()
        return said


def attempt(pipeline: Callable[[str], Pipeline], job: Job) -> Outcome:
    """Run one program and return what became of it. Raises whatever goes wrong."""
    plan = pipeline(job.file)
    make_folders(job)
    with opened(job.file, job.name) as source:
        try:
            done = transformed(plan, source, job)
        except GcxformError as error:
            if error.diagnostics[0].code != DONE or not (
                job.filters or job.out in (None, job.file)
            ):
                raise
            if job.filters:
                _hand_on(source)
            return Outcome(job, "done-before", why=error.diagnostics[0].message)
    if job.out is None:
        return Outcome(job, "would-change" if done.changed else "unchanged", done)
    return Outcome(job, "written" if done.changed else "unchanged", done)


def _hand_on(source: Source) -> None:
    """Print a program as it was read: it is what was asked for."""
    source.stream.seek(0)
    with destination(STDOUT) as put:
        put(source.stream.read())


def each(pipeline: Callable[[str], Pipeline], jobs: Sequence[Job]) -> Iterator[Outcome]:
    """Yield what became of programs; what goes wrong with one of several is said, and they go on.

    With one alone it is raised.
    """
    if len(jobs) == 1:
        yield attempt(pipeline, jobs[0])
        return
    meta = click.get_current_context().meta
    for job in jobs:
        try:
            outcome = attempt(pipeline, job)
        except Exception as error:
            outcome = Outcome(job, "failed", exit_code=told(error, meta))
        yield outcome


def exit_code(outcomes: Sequence[Outcome], check: bool) -> int:
    """Return the exit code of a call: the largest of its programs'; `check`: changes count."""
    changes = check and any(each.state == "would-change" for each in outcomes)
    return max([CHANGES * changes, *(each.exit_code for each in outcomes)])


def counted(outcomes: Sequence[Outcome]) -> str:
    """Return in a line what became of several programs."""
    found = Counter(each.state for each in outcomes)
    said = ", ".join(f"{found[state]} {words}" for state, words in WORDS.items() if found[state])
    return f"{len(outcomes)} programs: {said}"
