"""Thousands of programs through `gcxform batch`, killed and called again, against a shell loop.

    python benchmarks/plant.py [--programs 20000] [--processes 2] [--loop 100] [--scheduler] DIR...

The programs are those of DIR, over and over, until there are so many; what the pipeline (`absolute`
for LinuxCNC) refuses is left out before. Printed are programs a second of wall time and of a
processor, against `gcxform run` on the first ones, each called by itself; the largest process; and
what was done twice or lost when a process, and then the whole call, was ended by SIGKILL. With
`--scheduler` workers of Dask do it, and the scheduler is killed instead of the call.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from itertools import cycle, islice
from pathlib import Path

CALL = [sys.executable, "-m", "gcxform.cli"]
WAY = ["-f", "linuxcnc", "-x", "absolute"]
QUIET = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}


def main() -> int:
    """Measure, and print a table; return 1 if anything was lost or done twice."""
    asked = _arguments()
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)  # modules stay compiled, as where pip put them
    with tempfile.TemporaryDirectory(prefix="gcxform-plant-") as name, ExitStack() as stack:
        here = Path(name)
        count = _programs(here, asked.folders, asked.programs)
        loop = _measured([_loop(here, asked.loop)])
        address: list[str] = []
        cluster: list[subprocess.Popen[bytes]] = []
        if asked.scheduler:
            cluster = stack.enter_context(scheduler(here, asked.processes))
            address = ["--scheduler", _address(here)]
        words = [*CALL, "batch", *WAY, "-o", "out", "-j", str(asked.processes), *address, "many"]
        twice = _killed(here, words, count, cluster)
        if asked.scheduler:
            cluster = stack.enter_context(scheduler(here, asked.processes))
            words[words.index("--scheduler") + 1] = _address(here)
        rest = count - len(_results(here))
        batch = _measured([(words, here)], cluster)
        lost = count - len(_results(here))
        again = _measured([(words, here)], cluster)
    _print(count, asked.loop, loop, rest, batch, again, twice, lost)
    return 1 if twice or lost else 0


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--programs", type=int, default=20_000)
    parser.add_argument("--processes", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--loop", type=int, default=100)
    parser.add_argument("--scheduler", action="store_true")
    parser.add_argument("folders", nargs="+")
    return parser.parse_args()


def _programs(here: Path, folders: list[str], count: int) -> int:
    """Put so many programs into `many`, of those that come through; no two are the same."""
    names = [os.path.abspath(each) for each in folders]
    subprocess.run([*CALL, "batch", *WAY, "-o", "first", *names], cwd=here, check=False, **QUIET)
    found = sorted(path for path in (here / "first").rglob("*.n*c") if path.is_file())
    for k, path in enumerate(islice(cycle(found), count)):
        place = here / "many" / f"{k // 500:03d}" / f"{k:05d}{path.suffix}"
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(path.read_bytes() + b"(program %d)\n" % k)
    return count


def _loop(here: Path, count: int) -> tuple[list[str], Path]:
    names = sorted((here / "many").rglob("*.n*c"))[:count]
    (here / "loop").mkdir()
    lines = [f"{' '.join([*CALL, 'run', '-q', *WAY])} -o loop/{n.name} {n}" for n in names]
    (here / "loop.sh").write_text("\n".join(lines) + "\n")
    return ["sh", "loop.sh"], here


def _measured(
    calls: list[tuple[list[str], Path]], cluster: Sequence[subprocess.Popen[bytes]] = ()
) -> tuple[float, float]:
    """Return the seconds of wall time, and of a processor: the call's and that of its cluster."""
    before, began = _used(cluster), time.perf_counter()
    for words, folder in calls:
        subprocess.run(words, cwd=folder, check=False, **QUIET)  # type: ignore[call-overload]
    return time.perf_counter() - began, _used(cluster) - before


def _used(cluster: Sequence[subprocess.Popen[bytes]]) -> float:
    """Return the seconds of a processor that ended calls and a cluster have taken."""
    ended = resource.getrusage(resource.RUSAGE_CHILDREN)
    stats = [Path(f"/proc/{each.pid}/stat").read_text().rpartition(")")[2] for each in cluster]
    ticks = sum(int(word) for stat in stats for word in stat.split()[11:13])
    return ended.ru_utime + ended.ru_stime + ticks / os.sysconf("SC_CLK_TCK")


def _results(here: Path) -> dict[str, int]:
    """Return the results that are there, by their file numbers: one written anew has another."""
    return {str(path): path.stat().st_ino for path in (here / "out").glob("*/*.n*c")}


def _killed(
    here: Path, words: list[str], count: int, cluster: list[subprocess.Popen[bytes]]
) -> int:
    """End a process of a call at a tenth, the call at a fifth; return how many were done twice."""
    running = subprocess.Popen(words, cwd=here, process_group=0, **QUIET)  # type: ignore[call-overload]
    _until(here, running, count // 10)
    if cluster:
        cluster[1].kill()
    else:
        os.kill(_child(running.pid), signal.SIGKILL)
    _until(here, running, count // 5)
    for each in cluster or [running]:
        each.kill()
    running.kill()
    running.wait()
    time.sleep(1.0)
    before = _results(here)
    again = subprocess.Popen(words, cwd=here, process_group=0, **QUIET)  # type: ignore[call-overload]
    if not cluster:
        _until(here, again, 3 * count // 10)
        again.kill()
    again.wait()
    time.sleep(1.0)
    after = _results(here)
    return sum(after[name] != number for name, number in before.items())


def _until(here: Path, running: subprocess.Popen[bytes], count: int) -> None:
    while len(_results(here)) < count and running.poll() is None:
        time.sleep(0.2)


def _child(pid: int) -> int:
    """Return a process that works for another one."""
    found = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    return int(found[-1])


@contextmanager
def scheduler(here: Path, workers: int) -> Iterator[list[subprocess.Popen[bytes]]]:
    """Give a scheduler of Dask and its workers, as processes."""
    kept = here / "scheduler.json"
    kept.unlink(missing_ok=True)
    begin = [sys.executable, "-m", "distributed.cli.dask_scheduler", "--port", "0"]
    words = ["--scheduler-file", str(kept)]
    running = [subprocess.Popen([*begin, "--dashboard-address", ":0", *words], cwd=here, **QUIET)]  # type: ignore[call-overload]
    while not kept.exists():
        time.sleep(0.1)
    worker = [sys.executable, "-m", "distributed.cli.dask_worker", "--no-nanny", "--nthreads", "1"]
    running += [subprocess.Popen([*worker, *words], cwd=here, **QUIET) for _ in range(workers)]  # type: ignore[call-overload]
    try:
        yield running
    finally:
        for each in running:
            each.kill()
            each.wait()


def _address(here: Path) -> str:
    return str(json.loads((here / "scheduler.json").read_text())["address"])


def _print(
    count: int,
    looped: int,
    loop: tuple[float, float],
    rest: int,
    batch: tuple[float, float],
    again: tuple[float, float],
    twice: int,
    lost: int,
) -> None:
    largest = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
    rows = [
        ("a loop of `gcxform run`", looped, loop),
        ("`gcxform batch`, what was left", rest, batch),
        ("`gcxform batch`, nothing to do", count, again),
    ]
    print("| | programs | a second | a second of a processor |\n|---|---|---|---|")
    for name, programs, (wall, used) in rows:
        print(f"| {name} | {programs} | {programs / wall:.1f} | {programs / max(used, 1e-9):.1f} |")
    print(f"\nlargest process {largest:.0f} MB; done twice {twice}, lost {lost}")


if __name__ == "__main__":
    sys.exit(main())
