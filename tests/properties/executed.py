"""Programs with calls, loops, computed words and lost values: read, kept, and asked of LinuxCNC.

Three kinds in turn: plain ones (`flows`) and those in which all is computed (`rich_flows`) are
read, and ones that may keep their structure are written again by `absolute`. What is read of a
program in which only the machine decides is all its ways, one behind the other, and not what the
interpreter does: such a program is written again too, and the interpreter runs both.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from oracles import flows, rich_flows, rs274, toolpaths, ways
from oracles.canon import CanonProgram
from properties.figures import Figures

import gcxform as gx
from gcxform.flow.straightened import written_out
from gcxform.syntax.source import Source

NOT_RESOLVED = (
    "polar words are resolved in G8",
    "the control loses its place",
    "the control may run this loop once only",
    "in a do loop the control",
    "the modes are restored here",
    "one of two coolants would go off",
    "has a value that only the control knows",
    "only the machine knows",
    "is computed by the machine, and would have another value",
    "nothing in the program has set #",  # it is so where a block before was skipped
    "turns the work offset in force, under",
    "is not known here: it was set",
    "goes where only the machine knows",
    "another unit under a tool length",
    "the control goes on counting from there",
    "is incremental, but where",  # behind a word that only the machine knows
    "an arc, but where it starts is not known",
    "is known in two ways here",
    "and calls have it that are written out",
    "from where it stands, and that is not known",
    "where this spline starts or ends in X and Y is not known",
    "an arc in a plane that is turned",
    "this angle hangs on the sign of a zero",
    "which are turned together",
)
"""Why programs are refused that the interpreter runs, in the way that its own faults decide."""

PIPELINE = gx.Pipeline.parse("absolute", "linuxcnc")
ABSOLUTE = replace(
    PIPELINE,
    reading=replace(
        PIPELINE.reading,
        start=toolpaths.START,
        work_offsets=toolpaths.OFFSETS,
        homes=toolpaths.HOMES,
    ),
)


@dataclass
class Executed:
    """A program, what is asked about (what was written, or itself), and what came of it.

    `is_open`: only the machine decides which of its ways it goes.
    """

    seed: int
    chain: str
    source: bytes
    text: bytes = b""
    kind: str = ""
    code: str = ""
    said: str = ""
    is_open: bool = False

    def __str__(self) -> str:
        written = "" if self.text in (b"", self.source) else f"\n---\n{self.text.decode()}"
        return f"seed {self.seed}: {self.kind} {self.said}\n{self.source.decode()}{written}"

    def judge(self, canon: CanonProgram | rs274.Rejected) -> None:
        """Compare what was read of the source with what LinuxCNC does."""
        if self.kind:
            self.kind = "refused" if self._may_be_refused(canon) else "refused without need"
        elif not isinstance(canon, CanonProgram):
            self.kind, self.said = "disagrees", f"LinuxCNC refuses it: {canon}"
        else:
            self.said = self._differs(canon)
            self.kind = "disagrees" if self.said else "compared"

    def _differs(self, canon: CanonProgram) -> str:
        if not self.is_open:
            return toolpaths.difference(toolpaths.read(self.source), canon) or ""
        before = rs274.run_many([self.source])[0]
        if not isinstance(before, CanonProgram):
            return f"LinuxCNC refuses the source alone: {before}"
        return ways.difference(before, canon, 0.001) or ""

    def _may_be_refused(self, canon: CanonProgram | rs274.Rejected) -> bool:
        known = any(reason in self.said for reason in NOT_RESOLVED)
        return known or not isinstance(canon, CanonProgram)


def plain(seed: int) -> Executed:
    """Return a program that is read."""
    return _read(Executed(seed, "as read", flows.program(seed)))


def rich(seed: int) -> Executed:
    """Return a program that is read, in which all is computed."""
    return _read(Executed(seed, "as read, rich", rich_flows.program(seed)))


def kept(seed: int) -> Executed:
    """Return a program that is written by `absolute`."""
    return _written(Executed(seed, "absolute", flows.program(seed, flows.Kept)))


def _read(job: Executed) -> Executed:
    job.text = job.source
    try:
        toolpaths.read(job.source)
    except gx.InputError as error:
        _refuse(job, error)
        return job
    source = Source.of_bytes(job.source)
    executed = written_out(source, PIPELINE.source, ABSOLUTE.reading)
    return _written(job) if executed.undecided else job


def _written(job: Executed) -> Executed:
    source = Source.of_bytes(job.source)
    try:
        job.text = ABSOLUTE.run(job.source).text
        job.is_open = bool(written_out(source, PIPELINE.source, ABSOLUTE.reading).undecided)
    except gx.VerificationError as error:
        job.kind, job.said = "exit 4", str(error)
    except gx.InputError as error:
        _refuse(job, error)
    return job


def _refuse(job: Executed, error: gx.InputError) -> None:
    job.kind, job.code, job.said = "refused", error.diagnostics[0].code, str(error)


KINDS = (plain, rich, kept)


def judged(jobs: Sequence[Executed]) -> Figures:
    """Ask LinuxCNC about programs, and count."""
    figures = Figures()
    answers = rs274.run_many([job.text or job.source for job in jobs])
    for job, canon in zip(jobs, answers, strict=True):
        if job.kind != "exit 4":
            job.judge(canon)
        figures.count(job)
    return figures


def campaign(seeds: range, chunk: int = 500) -> Iterator[Figures]:
    """Yield the figures of programs, some hundred at a time."""
    for first in range(seeds.start, seeds.stop, chunk):
        some = range(first, min(first + chunk, seeds.stop))
        yield judged([KINDS[seed % len(KINDS)](seed) for seed in some])
