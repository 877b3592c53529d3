"""What `run.py` measures: programs, the commands that work on them, and what they are called.

Only the standard library is imported, as in `run.py`.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median

HERE = Path(__file__).resolve().parent
EXAMPLE = HERE.parent / "examples" / "lddm"
GCXFORM = Path(sys.executable).parent / "gcxform"
HELP_RUNS = 10
EXAMPLE_RUNS = 5
MISSING = "not installed"

READ, PLAIN = "`rs274 -g`", "plain C"
VERIFIED, UNVERIFIED = "gcxform, verified", "gcxform, `--verify off`"
TURNING = "gcxform, verified, 21 parameters"
TENFOLD = "gcxform, verified, ten times the lines"
FIVE, FIVE_UNVERIFIED = "five axes: gcxform, verified", "five axes: gcxform, `--verify off`"
SHOP_READ, SHOP_COPIED = "shop: `rs274 -g`", "shop: gcxform, verified"
SHOP_REWRITTEN, SHOP_UNVERIFIED = "shop: gcxform, rewritten", "shop: gcxform, `--verify off`"
SHOP_TENFOLD = "shop: gcxform, rewritten, ten times the lines"
HELP, LDDM = "`gcxform --help`", "LDDM example"
COPIED, REWRITTEN = "absolute", "cycles | offsets | absolute"


@dataclass(frozen=True)
class Sample:
    """What one run of a program took: seconds and megabytes."""

    wall: float
    cpu: float
    peak: float


@dataclass
class Job:
    """A command to measure, the file it writes (how it must end), and what was measured."""

    name: str
    command: list[str]
    out: Path | None = None
    lines: int = 0
    last_word: bytes = b""
    samples: list[Sample] = field(default_factory=list)
    failure: str = ""

    def middle(self, quantity: str) -> float | None:
        """Return the median of a quantity, or None where nothing was measured."""
        values = [getattr(sample, quantity) for sample in self.samples]
        return median(values) if values and not self.failure else None


def build_baseline(scratch: Path) -> Path:
    """Compile the plain C program and return where it is."""
    binary = scratch / "baseline"
    subprocess.run(["cc", "-O2", "-o", str(binary), str(HERE / "baseline.c")], check=True)
    return binary


def surfacing(scratch: Path, lines: int) -> Path:
    """Write a surfacing program of that many lines and return where it is."""
    path = scratch / f"surfacing-{lines}.nc"
    command = [sys.executable, str(HERE / "surfacing.py"), "--lines", str(lines), str(path)]
    subprocess.run(command, check=True)
    return path


def reading_job(source: Path, scratch: Path, lines: int) -> Job:
    """LinuxCNC's interpreter reading the program, its canonical calls going to a file.

    The file is named as an argument: rs274 does not buffer its standard output, which would
    double its time.
    """
    out = scratch / "canon.txt"
    rs274 = shutil.which("rs274")
    command = [rs274 or "rs274", "-g", str(source), str(out)]
    job = Job(READ, command, out, lines, b"PROGRAM_END()")
    job.failure = "" if rs274 else MISSING
    return job


def gcxform_job(
    name: str, source: Path, out: Path, lines: int, *options: str, pipeline: str = "surfacing.toml"
) -> Job:
    """Return the whole job: absolute, volumetric, emission and, unless it is off, proof."""
    chain = str(HERE / pipeline)
    options = ("--allow-outside", *options)  # the models are those of the examples
    command = [str(GCXFORM), "run", "-p", chain, "-o", str(out), *options, str(source)]
    return Job(name, command, out, lines, b"M30")


def main_jobs(scratch: Path, lines: int) -> list[Job]:
    """Return the jobs which are compared with each other, on one program."""
    source = surfacing(scratch, lines)
    plain_out = scratch / "plain.nc"
    plain = [str(build_baseline(scratch)), str(source), str(plain_out)]
    return [
        reading_job(source, scratch, lines),
        Job(PLAIN, plain, plain_out, lines, b"M30"),
        gcxform_job(VERIFIED, source, scratch / "verified.nc", lines),
        gcxform_job(UNVERIFIED, source, scratch / "unverified.nc", lines, "--verify", "off"),
        gcxform_job(
            TURNING, source, scratch / "turning.nc", lines, pipeline="surfacing-21-parameters.toml"
        ),
    ]


def shop(scratch: Path, lines: int) -> tuple[Path, int]:
    """Write a shop program of about so many lines; return where it is, and how many it has."""
    path = scratch / f"shop-{lines}.ngc"
    command = [sys.executable, str(HERE / "shop.py"), "--lines", str(lines), str(path)]
    written = subprocess.run(command, check=True, stdout=subprocess.PIPE)
    return path, int(written.stdout)


def shop_job(name: str, program: tuple[Path, int], scratch: Path, chain: str, *more: str) -> Job:
    """Return a job on the shop program: copied, or written without cycles and offsets."""
    source, lines = program
    out = scratch / "shop-out.ngc"
    machine = str(HERE / "shop-machine.toml")
    options = ["-q", "-f", "linuxcnc", "-m", machine, "-x", chain, "-o", str(out), *more]
    return Job(name, [str(GCXFORM), "run", *options, str(source)], out, lines, b"M30")


def shop_jobs(scratch: Path, lines: int) -> list[Job]:
    """Return the jobs that are compared with each other on the shop program."""
    program = shop(scratch, lines)
    reading = reading_job(program[0], scratch, program[1])
    reading.name = SHOP_READ
    return [
        reading,
        shop_job(SHOP_COPIED, program, scratch, COPIED),
        shop_job(SHOP_REWRITTEN, program, scratch, REWRITTEN),
        shop_job(SHOP_UNVERIFIED, program, scratch, COPIED, "--verify", "off"),
    ]


def five_axis_jobs(scratch: Path, lines: int) -> list[Job]:
    """Return the jobs from tips to axes, on a program of a fifth of the lines."""
    source, lines = scratch / "five-axis.nc", max(lines // 5, 10)
    command = [sys.executable, str(HERE / "five_axis.py"), "--lines", str(lines), str(source)]
    subprocess.run(command, check=True)
    chain, off = "five-axis.toml", ("--verify", "off")
    return [
        gcxform_job(FIVE, source, scratch / "five.nc", lines, pipeline=chain),
        gcxform_job(
            FIVE_UNVERIFIED, source, scratch / "five-unverified.nc", lines, *off, pipeline=chain
        ),
    ]


def small_jobs(scratch: Path) -> list[tuple[Job, int]]:
    """Return the jobs that measure the start, each with the number of its runs."""
    out = scratch / "linear_out.nc"
    pipeline, source = str(EXAMPLE / "linear.toml"), str(EXAMPLE / "linear_in.nc")
    example = [str(GCXFORM), "run", "-p", pipeline, "-o", str(out), source]
    return [
        (Job(HELP, [str(GCXFORM), "--help"]), HELP_RUNS),
        (Job(LDDM, example, out), EXAMPLE_RUNS),
    ]


def find(jobs: list[Job], name: str) -> Job:
    """Return the job of that name; one that was not asked for has no samples."""
    return next((job for job in jobs if job.name == name), Job(name, []))
