"""What a faster job would have to break through: memory, or the part that nobody can share.

    python benchmarks/walls.py [--lines N] [--dialect linuxcnc] [--chain absolute] [FILE]

A million lines of the surfacing program with its pipeline, or FILE with a chain, are run twice: in
one process, and in those that a long program takes. Printed are the processor's seconds of each
stage, and on how many cores the job takes how long: each process has its windows in order and
waits for what it needs and for room, as `system/worker.py` has it, and takes for each window what
was measured of it there. Beside it stands what would be if any core could take any window: then all
but the start and the rest (windows cut, hashes, files) is shared. Seconds are those of processors:
on a computer that does much else, the clock says nothing.

And the bytes that a line moves: each block of memory that is taken is written once and read once at
least. They are counted by a `malloc` of our own, all of 4 kB and more, and those of 1 MB and more,
which no cache of a core holds; beside them stands what copies of long arrays reach. What is read
twice is not counted, and small blocks stay in the cache: so the truth lies between the two shares.
"""

from __future__ import annotations

import argparse
import ctypes
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from time import perf_counter, process_time
from typing import Any

from jobs import surfacing

HERE = Path(__file__).resolve().parent
LARGE, FAR, CHILD, BESIDE = 4096, 1 << 20, "--child", "--beside"
CORES = (1, 2, 3, 4, 8, 16)
WHO = {"WindowReader.read_apart": "read", "Verifier.read": "read again"}
COUNTER = """
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stddef.h>
static void *(*mine)(size_t), *(*again)(void *, size_t);
extern void *__libc_calloc(size_t, size_t);
static unsigned long long taken, far;
static void count(size_t size) {
    if (size >= LARGE) __sync_fetch_and_add(&taken, size);
    if (size >= FAR) __sync_fetch_and_add(&far, size);
}
unsigned long long bytes_taken(void) { return taken; }
unsigned long long bytes_far(void) { return far; }
void *malloc(size_t size) {
    if (!mine) mine = dlsym(RTLD_NEXT, "malloc");
    count(size);
    return mine(size);
}
void *calloc(size_t number, size_t size) {
    count(number * size);
    return __libc_calloc(number, size);
}
void *realloc(void *old, size_t size) {
    if (!again) again = dlsym(RTLD_NEXT, "realloc");
    count(size);
    return again(old, size);
}
"""
STAGES = ("read", "transform", "write", "read again", "prove")


def main() -> int:
    """Measure and print."""
    if sys.argv[1:2] in ([CHILD], [BESIDE]):
        (child if sys.argv[1] == CHILD else beside)(sys.argv[2:])
        return 0
    asked = arguments()
    with tempfile.TemporaryDirectory(prefix="gcxform-walls-") as name:
        scratch = Path(name)
        source = asked.file or surfacing(scratch, asked.lines)
        chain = ["-f", asked.dialect, "-x", asked.chain]
        given = chain if asked.file else ["-p", str(HERE / "surfacing.toml"), "--allow-outside"]
        words = ["run", "-q", *given, "-o", str(scratch / "out.nc"), str(source)]
        found = measured(scratch, words)
        report(found, sum(1 for _ in source.open("rb")), bandwidth())
        done = subprocess.run([sys.executable, __file__, BESIDE, *words], check=True, stdout=-1)
        cores(json.loads(done.stdout.splitlines()[-1]), found)
    return 0


def arguments() -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--lines", type=int, default=1_000_000)
    parser.add_argument("--dialect", default="linuxcnc")
    parser.add_argument("--chain", default="absolute")
    parser.add_argument("file", nargs="?", type=Path)
    return parser.parse_args()


def measured(scratch: Path, words: list[str]) -> dict[str, float]:
    """Run a job in one process with the counter before its `malloc`."""
    code, library = scratch / "counter.c", scratch / "counter.so"
    code.write_text(COUNTER.replace("LARGE", str(LARGE)).replace("FAR", str(FAR)))
    subprocess.run(["cc", "-O2", "-shared", "-fPIC", "-o", library, code, "-ldl"], check=True)
    run = [sys.executable, __file__, CHILD, *words]
    environment = {**os.environ, "LD_PRELOAD": str(library)}
    done = subprocess.run(run, env=environment, check=True, stdout=subprocess.PIPE)
    return dict(json.loads(done.stdout.splitlines()[-1]))


def child(words: list[str]) -> None:
    """Run a job and print what its stages took, and what memory."""
    from gcxform.cli import main as gcxform
    from gcxform.modal.reader import WindowReader
    from gcxform.pipeline.run import Run
    from gcxform.proof.verify import Verifier
    from gcxform.syntax.source import Source

    kinds = (WindowReader, "read_apart"), (Run, "_transform"), (Run, "_emitted")
    kinds = *kinds, (Verifier, "read"), (Verifier, "check")

    counters = [ctypes.CDLL(None).bytes_taken, ctypes.CDLL(None).bytes_far]
    for counter in counters:
        counter.restype = ctypes.c_ulonglong
    took = {"start": 0.0, **dict.fromkeys(STAGES, 0.0)}
    before: list[int] = []

    def begun() -> None:
        if not before:
            took["start"] = process_time()
            before.extend(counter() for counter in counters)

    Source.is_long = lambda self, size=0: False  # type: ignore[method-assign]
    for stage, (of, name) in zip(STAGES, kinds, strict=True):
        setattr(of, name, timed(getattr(of, name), stage, took, begun))
    sys.argv = ["gcxform", *words]
    try:
        gcxform()
    except SystemExit as end:
        if end.code:
            raise
    took["read"] -= took["read again"]  # a reader as well
    near, far = (counter() - count for counter, count in zip(counters, before, strict=True))
    print(json.dumps({**took, "all": process_time(), "near": near, "far": far}))


def beside(words: list[str]) -> None:
    """Run a job in as many processes as it takes; print what each took of a processor, by window.

    What a process took when it was done with a window is written down there.
    """
    from gcxform.cli import main as gcxform
    from gcxform.pipeline.run import Run
    from gcxform.system import worker

    with tempfile.NamedTemporaryFile("a+") as notes:
        serve, answer, over, hand_on = worker._serve, worker._answer, Run._over, Run._hand_on
        who = ["main"]

        def note(name: str) -> None:
            notes.write(f"{name}:{process_time()}\n")
            notes.flush()

        def named(work: Any, *given: Any) -> None:
            who[0] = WHO.get(getattr(work, "__qualname__", ""), "prove")
            note(who[0])
            serve(work, *given)

        def answered(*given: Any) -> list[int]:
            sizes = answer(*given)
            note(who[0])
            return sizes

        def begun(*given: Any) -> None:
            note("main")
            over(*given)

        def handed_on(*given: Any) -> None:
            hand_on(*given)
            note("main")

        worker._serve, worker._answer = named, answered
        Run._over, Run._hand_on = begun, handed_on  # type: ignore[method-assign]
        sys.argv = ["gcxform", *words]
        try:
            gcxform()
        except SystemExit as end:
            if end.code:
                raise
        note("main")
        notes.seek(0)
        took: dict[str, list[float]] = {}
        for line in notes:
            name, _, seconds = line.rpartition(":")
            took.setdefault(name, []).append(float(seconds))
    print(json.dumps(took))


def cores(noted: dict[str, list[float]], found: dict[str, float]) -> None:
    """Print how long the job takes on some cores."""
    steps = {k: [b - a for a, b in pairwise(v)] for k, v in noted.items()}
    start, end = noted["main"][0], steps["main"].pop()
    whole = start + end + sum(map(sum, steps.values()))
    alone = 1.0 - sum(found[stage] for stage in STAGES) / found["all"]
    print(f"\n{whole:.2f} s in four processes, {found['all']:.2f} s in one")
    names = [f"{name} {sum(each):.2f}" for name, each in steps.items()]
    print("s of each: start", f"{start:.2f},", ", ".join(names))
    print("\n| cores | four processes, s | times as fast | windows shared by all |")
    print("|--:|--:|--:|--:|")
    for number in CORES:
        time = start + end + clock(steps, number)
        most = 1.0 / (alone + (1.0 - alone) / number)
        print(f"| {number} | {time:.2f} | {whole / time:.2f} | {most:.2f} |")


def clock(steps: dict[str, list[float]], number: int) -> float:
    """Return how long some cores take for the windows that four processes work on.

    The one that could begin first does, and of those that could now the one that waits for others.
    """
    from gcxform.system.worker import DEPTH

    needs = {  # which process has to be done with which window, seen from the one that is next
        "main": (("read", 0), ("prove", -DEPTH)),
        "read": (("main", -DEPTH),),
        "read again": (("main", 0),),
        "prove": (("read again", 0),),
    }
    done: dict[str, list[float]] = {name: [] for name in steps}
    free = [0.0] * number
    while any(len(done[name]) < len(steps[name]) for name in steps):
        begins = []
        for name, wanted in needs.items():
            nth = len(done[name])
            waits = [(other, nth + by) for other, by in wanted if nth + by >= 0]
            if nth < len(steps[name]) and all(k < len(done[other]) for other, k in waits):
                ready = max([done[name][-1] if nth else 0.0, *(done[o][k] for o, k in waits)])
                begins.append((max(ready, min(free)), len(begins), name))
        begin, _, name = min(begins)
        at = begin + steps[name][len(done[name])]
        done[name].append(at)
        free[free.index(min(free))] = at
    return max(max(each) for each in done.values())


def timed(function: Any, stage: str, took: dict[str, float], begun: Callable[[], None]) -> Any:
    """Return a function that adds the processor's seconds of each call."""

    def inner(*given: Any) -> Any:
        begun()
        began = process_time()
        try:
            return function(*given)
        finally:
            took[stage] += process_time() - began

    return inner


def bandwidth() -> float:
    """Return bytes a second that copies of long arrays read and write, the best of some."""
    import numpy as np

    source, target = np.ones(1 << 25), np.empty(1 << 25)
    best = 0.0
    for _ in range(8):
        began = perf_counter()
        target[:] = source
        best = max(best, 2 * source.nbytes / (perf_counter() - began))
    return best


def report(found: dict[str, float], lines: int, speed: float) -> None:
    """Print the tables."""
    whole = found["all"]
    stages = ["start", *STAGES]
    rest = whole - sum(found[stage] for stage in stages)
    print("| stage | s | share |\n|---|--:|--:|")
    for name, value in [*((stage, found[stage]) for stage in stages), ("rest", rest)]:
        print(f"| {name} | {value:.2f} | {value / whole:.0%} |")
    used = whole - found["start"]
    print(f"\nmemory; copies of long arrays reach {speed / 1e9:.1f} GB/s")
    for what, name in (("4 kB", "near"), ("1 MB", "far")):
        moved = 2 * found[name]
        print(f"blocks of {what} and more: {moved / lines:.0f} bytes a line,", end=" ")
        print(f"{moved / used / 1e9:.1f} GB/s, {moved / speed / used:.0%} of that")


if __name__ == "__main__":
    sys.exit(main())
