"""Random chains on random programs, and LinuxCNC as the judge of where the machine goes."""

from __future__ import annotations

import bisect
import random
import re
import tempfile
import traceback
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from oracles import rs274, ways
from oracles.canon import CanonProgram
from oracles.toolpaths import OFFSETS as CODES
from properties.figures import Figures

import gcxform as gx
from gcxform.machine.machine import Machine, Tool
from gcxform.modal.state import Reading
from gcxform.pipeline.certify import certificate
from gcxform.pipeline.chain_text import parse_chain
from gcxform.pipeline.run import Output, Run
from gcxform.plugin.registry import default_registry
from gcxform.syntax.source import Source
from gcxform.system import worker
from gcxform.testing.cases import SPECIAL, Case
from gcxform.testing.linuxcnc_programs import Drawn, Wishes, everything

INCH = 25.4
PRINTED = 6e-4  # units: five numbers with four decimals are added up, in three axes
SPAN = 1200.0  # mm, of the tables of errors
PATH_MODES = ("SET_MOTION_CONTROL_MODE", "SET_NAIVECAM")
OF_THE_MACHINE = re.compile(r"G0*(28|30|53)(?![0-9.])")
WINDOWS = (60, 200, 1 << 20)

START = dict.fromkeys("XYZABC", 0.0)
OFFSETS = dict.fromkeys(CODES, START)
HOMES = {"G28": START, "G30": START}

Answer = CanonProgram | rs274.Rejected


def vector(number: int) -> tuple[float, float, float]:
    """Return the vector of a tool, mm."""
    x, y, z = rs274.tool(number)
    return x * INCH, y * INCH, z * INCH


TOOLS = {
    n: Tool(x=vector(n)[0], y=vector(n)[1], length=vector(n)[2], radius=n / 2)
    for n in range(1, 100)
}
MILL = Machine(file=Path("mill.toml"), work_offsets=OFFSETS, homes=HOMES, tools=TOOLS)


# --- a machine with errors, reckoned one number at a time ---


@dataclass(frozen=True)
class Errors:
    """Errors in X, Y and Z (mm) along each axis: `nodes`, and three rows of values for each."""

    nodes: tuple[tuple[float, ...], ...]
    values: tuple[tuple[tuple[float, ...], ...], ...]

    @classmethod
    def drawn(cls, choose: random.Random) -> Errors:
        """Draw errors of some hundredths that bend at a few nodes."""
        nodes, values = [], []
        for _ in range(3):
            inner = sorted({float(choose.randint(-300, 300)) for _ in range(choose.randint(0, 5))})
            axis = (-SPAN, *inner, SPAN)
            size = choose.choice((0.0, 0.005, 0.02))
            nodes.append(axis)
            values.append(
                tuple(tuple(round(choose.uniform(-size, size), 5) for _ in axis) for _ in "XYZ")
            )
        return cls(tuple(nodes), tuple(values))

    def at(self, point: Sequence[float]) -> tuple[float, float, float]:
        """Return the error at a place; beyond the table it is that at its border."""
        total = [0.0, 0.0, 0.0]
        for nodes, rows, value in zip(self.nodes, self.values, point, strict=False):
            k = min(max(bisect.bisect_right(nodes, value) - 1, 0), len(nodes) - 2)
            part = min(max((value - nodes[k]) / (nodes[k + 1] - nodes[k]), 0.0), 1.0)
            for j, row in enumerate(rows):
                total[j] += row[k] + part * (row[k + 1] - row[k])
        return total[0], total[1], total[2]

    def goes(self, command: ways.Point) -> ways.Point:
        """Return where a command takes the machine."""
        off = self.at(command)
        return (*(c + e for c, e in zip(command, off, strict=False)), *command[3:])

    @property
    def size(self) -> float:
        """No error is larger (mm)."""
        return sum(max(abs(v) for v in row) for rows in self.values for row in rows)

    def text(self) -> str:
        """Return the model file."""
        lines = ['format = 1\nkind = "axis-functions"\nvalues = "error"', 'convention = "relative"']
        lines.append('order = "XYZ"')
        for axis, nodes, rows in zip("XYZ", self.nodes, self.values, strict=True):
            lines += [f"[{axis}]", f"position = {list(nodes)}"]
            lines += [f"E{name}{axis} = {list(row)}" for name, row in zip("XYZ", rows, strict=True)]
        return "\n".join(lines) + "\n"


# --- chains ---


@dataclass(frozen=True)
class Chain:
    """A chain as text, what else a pipeline is made of, and the errors of the machine."""

    text: str
    decimals: int | None = None
    budget: float | None = None
    words: str = "changed"
    told: bool = True  # the machine, and where it starts
    errors: Errors | None = None

    @classmethod
    def drawn(cls, choose: random.Random, most: int = 3) -> Chain:
        """Draw one to three steps and the rest."""
        steps = [step(choose) for _ in range(choose.randint(1, most))]
        names = [each.split()[0] for each in steps]
        steps = [s for k, s in enumerate(steps) if names[k] not in names[:k]]
        errors = Errors.drawn(choose) if "volumetric" in names else None
        return cls(
            " | ".join(steps),
            choose.choice((None, None, 3, 4, 5, 6)),
            choose.choice((None, None, None, 0.05)),
            choose.choice(("changed", "changed", "changed", "all")),
            errors is not None or choose.random() < 0.85,
            errors,
        )

    def __str__(self) -> str:
        return f"{self.text} [decimals={self.decimals} budget={self.budget} {self.words}]"

    def pipeline(self, folder: Path) -> gx.Pipeline:
        """Return the pipeline. Raises UsageError where the chain is not accepted."""
        text = self.text
        if self.errors is not None:
            (folder / "model.toml").write_text(self.errors.text())
        parsed = gx.Pipeline.parse("", "linuxcnc").source
        passes = tuple(parse_chain(text, folder, default_registry()))
        numbers = parsed.numbers
        if self.decimals is not None:
            numbers = replace(numbers, mm=self.decimals, inch=self.decimals, angle=self.decimals)
        return gx.Pipeline(
            parsed,
            parsed,
            passes,
            Reading(start=START if self.told else {}, block_delete="execute"),
            MILL if self.told else None,
            self.budget,
            self.words,
            numbers,
        )


def step(choose: random.Random) -> str:
    """Draw a step with its options."""
    chord = f"chord-error={choose.choice((1, 5, 20))}um"
    return choose.choice(
        (
            "absolute",
            "absolute",
            "metric",
            "cycles",
            "cycles",
            "offsets",
            "offsets",
            "cutter-comp",
            "cutter-comp",
            f"segment {chord}",
            f"segment {chord} max-length={choose.choice((2, 7.5, 20))}mm",
            f"segment arcs=split arc-step={choose.choice((10, 45, 90))}deg",
            f"arcs tolerance={choose.choice((2, 10, 20))}um",
            f"plane {chord}",
            "feed mode=inverse-time",
            "feed mode=per-minute",
            f"renumber start={choose.choice((1, 10))} step={choose.choice((1, 5))}",
            "strip",
            "strip comments=false",
            "volumetric model=model.toml outside=clamp",
            "volumetric model=model.toml outside=clamp tolerance=2um",
            "volumetric model=model.toml outside=clamp tolerance=5um min-length=0.1mm",
        )
    )


# --- jobs ---


@dataclass
class Job:
    """A program under a chain, and what came of it: `kind` is passed, refused, or a fault."""

    seed: int
    chain: Chain
    source: Drawn
    kind: str = ""
    code: str = ""
    text: bytes = b""
    near: float = 0.0
    said: str = ""

    def __str__(self) -> str:
        source, text = self.source.text.decode("latin-1"), self.text.decode("latin-1")
        return f"seed {self.seed}: {self.kind} {self.said}\n{self.chain}\n{source}\n---\n{text}"


def drawn(seed: int, folder: Path, blocks: int = 14) -> Job:
    """Draw a chain that is accepted, and a program.

    Splines are only there where lines are made of them, because LinuxCNC does not print them, and
    loops where blocks keep their numbers.
    """
    choose = random.Random(seed)
    chain = Chain.drawn(choose)
    while not accepted(chain, folder):
        chain = Chain.drawn(choose)
    wishes = Wishes("segment chord" in chain.text, "renumber" not in chain.text, chain.told)
    return Job(seed, chain, everything(choose.randint, blocks, vector, wishes))


def of_case(
    case: Case, folder: Path, choose: random.Random, places: Mapping[str, Path]
) -> tuple[str, gx.Pipeline | None]:
    """Return a random chain of two steps and the pipeline of a case with it, if there is one."""
    for name, content in case.sections.items():
        if name not in SPECIAL:
            (folder / name).write_bytes(content)
    text = case.sections["pipeline.toml"]
    for name, path in places.items():
        text = text.replace(f'= "{name}"'.encode(), f"= '{path}'".encode())
    (folder / "pipeline.toml").write_bytes(text)
    (folder / "drawn.toml").write_text(Errors.drawn(choose).text())
    try:
        own = gx.Pipeline.load(folder / "pipeline.toml")
    except gx.UsageError:
        return "", None
    origin = "" if own.machine else " part-origin=0,0,0"
    for _ in range(20):
        chain = f"{step(choose)} | {step(choose)}"
        chain = chain.replace("model.toml outside=clamp", f"drawn.toml outside=clamp{origin}")
        try:
            passes = parse_chain(chain, folder, default_registry())
            return chain, replace(own, passes=tuple(passes))
        except gx.UsageError:
            continue
    return "", None


def accepted(chain: Chain, folder: Path) -> bool:
    """Tell whether there is such a pipeline."""
    try:
        chain.pipeline(folder)
    except gx.UsageError:
        return False
    return True


def done(job: Job, folder: Path) -> Job:
    """Run a job; nothing is raised."""
    window = WINDOWS[job.seed % len(WINDOWS)]
    linux, worker.LINUX = worker.LINUX, job.seed % 10 == 0  # few are read by processes
    try:
        pipeline = job.chain.pipeline(folder)
        parts: list[bytes] = []
        run = Run(pipeline, Source.of_bytes(job.source.text), "full")
        run.over(Output(parts.append, []), lambda size: None, window)
        certificate(run, Output(parts.append, []))
    except gx.VerificationError as error:
        job.kind, job.code, job.said = "exit 4", error.diagnostics[0].code, str(error)
    except gx.InputError as error:
        job.kind, job.code, job.said = "refused", error.diagnostics[0].code, str(error)
    except Exception:
        job.kind, job.code, job.said = "exit 70", "", traceback.format_exc()
    else:
        job.kind, job.text = "passed", b"".join(parts)
        inch = b"20" in job.source.text + job.text
        job.near = pipeline.limit(inch) + PRINTED * (INCH if inch else 1.0) + ways.FINE
    finally:
        worker.LINUX = linux
    return job


def judged(jobs: Sequence[Job]) -> Figures:
    """Ask LinuxCNC about the jobs that passed, and count."""
    figures = Figures()
    passed = [job for job in jobs if job.kind == "passed"]
    before = rs274.run_many([job.source.text for job in passed])
    after = rs274.run_many([job.text for job in passed])
    for job, old, new in zip(passed, before, after, strict=True):
        compare(job, old, new)
    for job in jobs:
        figures.count(job)
    return figures


def compare(job: Job, old: Answer, new: Answer) -> None:
    """Say whether the machine goes where it went."""
    if not isinstance(old, CanonProgram):
        job.kind, job.said = "not LinuxCNC", old.message
        return
    if not isinstance(new, CanonProgram):
        job.kind, job.said = "disagrees", f"LinuxCNC refuses it: {new}"
        return
    if "cycles" in job.chain.text or job.chain.errors:  # a cycle stops exactly at every end
        old, new = (
            replace(run, told=[t for t in run.told if not t[1].startswith(PATH_MODES)])
            for run in (old, new)
        )
    problem = went_elsewhere(job, old, new)
    if problem:
        job.kind, job.said = "disagrees", problem


def went_elsewhere(job: Job, old: CanonProgram, new: CanonProgram) -> str:
    """Return where the machine goes elsewhere.

    Rapids to places of the machine, which are no places of the part, may be as they were.
    """
    if job.chain.errors is None:
        return ways.difference(old, new, job.near, curves=job.source.curves)
    loose = {
        number: 2 * job.chain.errors.size
        for number, line in enumerate(job.text.decode("latin-1").splitlines(), 1)
        if OF_THE_MACHINE.search(re.sub(r"\s", "", line.upper()))
    }
    where = job.chain.errors.goes
    return ways.difference(old, new, job.near, where, job.source.curves, loose)


def campaign(seeds: range, chunk: int = 500) -> Iterator[Figures]:
    """Yield the figures of programs, some hundred at a time."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for first in range(seeds.start, seeds.stop, chunk):
            some = range(first, min(first + chunk, seeds.stop))
            yield judged([done(drawn(seed, folder), folder) for seed in some])
