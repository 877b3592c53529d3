"""Measure gcxform against LinuxCNC's interpreter and a plain C program, in one run.

    python benchmarks/run.py [--lines N] [--rounds N] [--ten-million] [--check [--slack F]]
    python benchmarks/run.py --roads [...]    # the roads beside the main one alone

Builds ``baseline.c``, writes the surfacing and the shop program, and runs the programs in turn,
round by round, so that a slow spell of the computer meets all of them. Prints the medians as
Markdown, with the limits. What is run is in ``jobs.py``. Only the standard library is imported
here: a child's peak memory is counted from the size of the process that starts it, so this one
stays small and NumPy runs in a child.
"""

from __future__ import annotations

import argparse
import filecmp
import os
import platform
import resource
import select
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter

from jobs import (
    FIVE,
    GCXFORM,
    HELP,
    LDDM,
    MISSING,
    PLAIN,
    READ,
    REWRITTEN,
    SHOP_COPIED,
    SHOP_READ,
    SHOP_REWRITTEN,
    SHOP_TENFOLD,
    TENFOLD,
    TURNING,
    UNVERIFIED,
    VERIFIED,
    Job,
    Sample,
    find,
    five_axis_jobs,
    gcxform_job,
    main_jobs,
    shop,
    shop_job,
    shop_jobs,
    small_jobs,
    surfacing,
)
from roads import ROADS, road_jobs, used

# modules stay compiled from run to run, as they are where pip installed the package
ENVIRONMENT = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}


@dataclass(frozen=True)
class Limit:
    """A figure with the largest value that it may have, and that which it is to have one day."""

    what: str
    value: float | None
    most: float
    unit: str = ""
    goal: float | None = None

    def state(self, slack: float) -> str:
        """Say whether the limit is held, with ``slack`` as a factor on it."""
        if self.value is None:
            return "not measured"
        if self.value <= self.most:
            return "held"
        return "within the slack" if self.value <= self.most * slack else "**missed**"


# Running


def run_once(job: Job, scratch: Path) -> None:
    """Run a job once and keep its sample; after a failure it is not run again."""
    if job.failure:
        return
    if job.out is not None:
        job.out.unlink(missing_ok=True)
    printed, complaints = scratch / "stdout", scratch / "stderr"
    status, sample = timed(job.command, scratch, printed, complaints)
    if status != 0:
        job.failure = f"exit code {status}"
        tail = complaints.read_text(encoding="utf-8", errors="replace").strip()[-2000:]
        say(f"{job.name}: {job.failure}\n{tail}")
    elif not complete(job):
        job.failure = "output incomplete"
        say(f"{job.name}: {job.failure}")
    else:
        job.samples.append(sample)


def complete(job: Job) -> bool:
    """Tell whether the output of a job is there to its last word."""
    if job.out is None:
        return True
    if not job.out.exists() or job.out.stat().st_size == 0:
        return False
    with job.out.open("rb") as text:
        text.seek(max(0, job.out.stat().st_size - 1000))
        return job.last_word in text.read()


def timed(command: list[str], cwd: Path, stdout: Path, stderr: Path) -> tuple[int, Sample]:
    """Run a command to its end and return its exit code with what it took."""
    with stdout.open("wb") as out, stderr.open("wb") as err:
        start = perf_counter()
        child = subprocess.Popen(
            command, cwd=cwd, stdin=subprocess.DEVNULL, stdout=out, stderr=err, env=ENVIRONMENT
        )
        together = watched(child.pid)
        _, status, used = os.wait4(child.pid, 0)
        wall = perf_counter() - start
    child.returncode = os.waitstatus_to_exitcode(status)
    peak = max(together, megabytes(used.ru_maxrss))
    return child.returncode, Sample(wall, used.ru_utime + used.ru_stime, peak)


def watched(pid: int) -> float:
    """Wait for a process; return the most that it and its own ones took together, in MB.

    It is looked at every 20 ms. Memory that several processes share counts for each of them.
    """
    if not hasattr(os, "pidfd_open"):
        return 0.0
    most, ended = 0, os.pidfd_open(pid)
    while not select.select([ended], [], [], 0.02)[0]:
        most = max(most, pages(pid))
    os.close(ended)
    return most * os.sysconf("SC_PAGE_SIZE") / 1e6


def pages(pid: int) -> int:
    """Return how many pages of memory a process and its own ones have; 0 once they have ended."""
    try:
        own = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
        others = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    except OSError:
        return 0
    return own + sum(pages(int(other)) for other in others)


def megabytes(maxrss: int) -> float:
    """Return a peak size in MB (10^6 bytes); Linux counts in KiB, macOS in bytes."""
    return maxrss / 1e6 if sys.platform == "darwin" else maxrss * 1024 / 1e6


def say(text: str) -> None:
    """Tell how it goes on stderr: stdout carries the report only."""
    print(text, file=sys.stderr, flush=True)


# All of them


def measure(scratch: Path, lines: int, rounds: int, tenfold: bool) -> list[Job]:
    """Run everything and return the jobs with their samples."""
    jobs = main_jobs(scratch, lines)
    small = small_jobs(scratch)
    for job, runs in small:
        repeat([job], runs, scratch)
    repeat(jobs, rounds, scratch)
    demand_same_output(jobs)
    parts = shop_jobs(scratch, lines)
    repeat(parts, rounds, scratch)
    tips = five_axis_jobs(scratch, lines)
    repeat(tips, rounds, scratch)
    roads = measure_roads(scratch, lines, rounds)
    jobs += [*parts, *tips, *roads, *(job for job, _ in small)]
    if tenfold:
        source = surfacing(scratch, 10 * lines)
        big = gcxform_job(TENFOLD, source, scratch / "tenfold.nc", 10 * lines)
        repeat([big], 1, scratch)
        more = shop_job(SHOP_TENFOLD, shop(scratch, 10 * lines), scratch, REWRITTEN)
        repeat([more], 1, scratch)
        jobs += [big, more]
    return jobs


def measure_roads(scratch: Path, lines: int, rounds: int) -> list[Job]:
    """Run the roads beside the main one and return their jobs."""
    jobs = road_jobs(scratch, lines)
    repeat(jobs, rounds, scratch)
    return jobs


def measured(options: argparse.Namespace, scratch: Path) -> list[Job]:
    """Run what the command line asks for."""
    if options.roads:
        return measure_roads(scratch, options.lines, options.rounds)
    return measure(scratch, options.lines, options.rounds, options.ten_million)


def repeat(jobs: Iterable[Job], rounds: int, scratch: Path) -> None:
    """Run the jobs in turn, so many times."""
    for _ in range(rounds):
        for job in jobs:
            run_once(job, scratch)


def demand_same_output(jobs: list[Job]) -> None:
    """Fail the unverified job where it does not write what the verified one writes."""
    verified, unverified = find(jobs, VERIFIED), find(jobs, UNVERIFIED)
    if verified.failure or unverified.failure or not verified.out or not unverified.out:
        return
    if not filecmp.cmp(verified.out, unverified.out, shallow=False):
        unverified.failure = "not the bytes of the verified run"
        say(f"{unverified.name}: {unverified.failure}")


# The report


def ratio(above: float | None, below: float | None) -> float | None:
    """Return a quotient, or None where one of its parts was not measured."""
    return above / below if above is not None and below else None


def a_block(job: Job) -> float | None:
    """Return the wall time of a job for each line of its program."""
    wall = job.middle("wall")
    return wall / job.lines if wall is not None and job.lines else None


def limits(jobs: list[Job]) -> list[Limit]:
    """Return the figures that have a limit."""

    def wall(name: str) -> float | None:
        return find(jobs, name).middle("wall")

    peak, tenfold, shop_peak, shop_tenfold = (
        find(jobs, name).middle("peak")
        for name in (VERIFIED, TENFOLD, SHOP_REWRITTEN, SHOP_TENFOLD)
    )
    five = ratio(a_block(find(jobs, FIVE)), a_block(find(jobs, VERIFIED)))
    return [
        Limit(f"{VERIFIED} / {READ}", ratio(wall(VERIFIED), wall(READ)), 1.0),
        Limit(f"{UNVERIFIED} / {READ}", ratio(wall(UNVERIFIED), wall(READ)), 0.5),
        Limit(f"{UNVERIFIED} / {PLAIN}", ratio(wall(UNVERIFIED), wall(PLAIN)), 2.0),
        Limit(f"{TURNING} / nine functions", ratio(wall(TURNING), wall(VERIFIED)), 2.0),
        Limit("five axes / three axes, a block", five, 4.0),
        Limit(f"{SHOP_COPIED} / {READ}", ratio(wall(SHOP_COPIED), wall(SHOP_READ)), 1.0),
        Limit(f"{SHOP_REWRITTEN} / {READ}", ratio(wall(SHOP_REWRITTEN), wall(SHOP_READ)), 1.0),
        Limit(f"peak memory, {SHOP_REWRITTEN}", shop_peak, 400.0, " MB"),
        Limit("shop: peak memory, ten times the lines / once", ratio(shop_tenfold, shop_peak), 1.1),
        Limit(f"peak memory, {VERIFIED}", peak, 400.0, " MB"),
        Limit("peak memory, ten times the lines / once", ratio(tenfold, peak), 1.1),
        *road_limits(jobs),
        Limit(HELP, wall(HELP), 0.15, " s"),
        Limit(LDDM, wall(LDDM), 0.5, " s"),
    ]


def road_limits(jobs: list[Job]) -> list[Limit]:
    """Return the figures of the roads, and that of straight code on the main one."""
    return [
        Limit(
            f"{road.name}: user+sys / rs274's",
            used(lambda name: find(jobs, name), road),
            road.most,
            goal=road.goal,
        )
        for road in ROADS
    ]


def report(jobs: list[Job], found: list[Limit], slack: float) -> Iterator[str]:
    """Yield the lines of the report."""
    yield f"{platform.machine()}, {os.cpu_count()} cores, Python {platform.python_version()}"
    yield ""
    yield from time_table(jobs)
    yield ""
    yield from limit_table(found, slack)


def time_table(jobs: list[Job]) -> Iterator[str]:
    """Yield the table of medians; ratios are of wall time, those of user + sys in brackets."""
    yield "| program | lines | runs | wall s | user+sys s | peak MB | / rs274 | / C |"
    yield "|---|--:|--:|--:|--:|--:|--:|--:|"
    readings = [find(jobs, READ), find(jobs, SHOP_READ)]
    of_roads = {
        name: find(jobs, road.reading) for road in ROADS for name in (road.reading, road.ours)
    }
    for job in jobs:
        lines = f"{job.lines:,}" if job.lines else ""
        if job.failure:
            yield f"| {job.name} | {lines} | {job.failure} | | | | | |"
            continue
        shop, other = job.name.startswith("shop"), job.name.startswith("five")
        off = shop or other or job.name in of_roads
        reading = of_roads.get(job.name, readings[shop])
        others = (reading, Job(PLAIN, []) if off else find(jobs, PLAIN))
        against = [ratio_cell(job, other) if job.lines == other.lines else "" for other in others]
        times = [f"{job.middle(quantity):.3f}" for quantity in ("wall", "cpu")]
        cells = [job.name, lines, str(len(job.samples)), *times, peak_cell(job), *against]
        yield f"| {' | '.join(cells)} |"


def ratio_cell(job: Job, other: Job) -> str:
    """Return the ratios of two jobs: wall time (user + sys)."""
    wall, cpu = (ratio(job.middle(kind), other.middle(kind)) for kind in ("wall", "cpu"))
    return "not measured" if wall is None or cpu is None else f"{wall:.2f} ({cpu:.2f})"


def peak_cell(job: Job) -> str:
    """Return the peak memory, or that it was below what this process can see."""
    own = megabytes(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
    peak = job.middle("peak") or 0.0
    return f"{peak:.0f}" if peak > own else f"< {own:.0f}"


def limit_table(found: list[Limit], slack: float) -> Iterator[str]:
    """Yield the table of the limits."""
    yield "| figure | measured | limit | goal | |"
    yield "|---|--:|--:|--:|---|"
    for limit in found:
        digits = 0 if limit.unit == " MB" else 3
        value = "" if limit.value is None else f"{limit.value:.{digits}f}{limit.unit}"
        cells = [limit.what, value, f"{limit.most:g}{limit.unit}", goal_cell(limit)]
        yield f"| {' | '.join(cells)} | {limit.state(slack)} |"


def goal_cell(limit: Limit) -> str:
    """Return the goal of a figure where there is one, and that it is missed where it is."""
    if limit.goal is None:
        return ""
    return f"{limit.goal:g}{', missed' if limit.value and limit.value > limit.goal else ''}"


def verdict(jobs: list[Job], found: list[Limit], slack: float) -> int:
    """Return the exit code of ``--check``: 1 where a limit is missed or a program failed."""
    states = [limit.state(slack) for limit in found]
    missed, unmeasured = states.count("**missed**"), states.count("not measured")
    failed = sum(bool(job.failure) and job.failure != MISSING for job in jobs)
    say(f"{len(found)} limits: {missed} missed, {unmeasured} not measured; {failed} runs failed")
    return 1 if missed or failed else 0


def arguments() -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(description="Measure gcxform against rs274 and plain C.")
    parser.add_argument("--lines", type=int, default=1_000_000, help="default: %(default)s")
    parser.add_argument("--rounds", type=int, default=5, help="default: %(default)s")
    parser.add_argument(
        "--ten-million", action="store_true", help="also peak memory at ten times the lines"
    )
    parser.add_argument(
        "--roads", action="store_true", help="only the roads beside the main one, a fifth of N each"
    )
    parser.add_argument("--check", action="store_true", help="exit 1 if a limit is missed")
    parser.add_argument("--slack", type=float, default=1.0, help="factor on every limit (1.0)")
    options = parser.parse_args()
    if options.rounds < 1 or options.lines < 10:
        parser.error("--rounds is at least 1, --lines at least 10")
    if not GCXFORM.exists():
        parser.error(f"no gcxform beside {sys.executable}: install the package first")
    return options


def main() -> int:
    """Measure, print the report and return the exit code."""
    options = arguments()
    with tempfile.TemporaryDirectory(prefix="gcxform-benchmark-") as scratch:
        jobs = measured(options, Path(scratch))
    found = road_limits(jobs) if options.roads else limits(jobs)
    print("\n".join(report(jobs, found, options.slack)))
    return verdict(jobs, found, options.slack) if options.check else 0


if __name__ == "__main__":
    sys.exit(main())
