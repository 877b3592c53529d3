"""What a faster job would have to break through: memory, or the part that nobody can share.

    python benchmarks/walls.py [--lines N] [--dialect linuxcnc] [--chain absolute] [FILE]

A million lines of the surfacing program with its pipeline, or FILE with a chain, are run in one
process. Printed are the processor's seconds of each stage: with those, what three processes of
today can gain (the longest stage is their path), and what is left in order if windows were read,
transformed, written and proved by anybody (the start, and the rest: windows cut, hashes, files).

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
from pathlib import Path
from time import perf_counter, process_time
from typing import Any

from jobs import surfacing

HERE = Path(__file__).resolve().parent
LARGE, FAR, CHILD = 4096, 1 << 20, "--child"
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
    if sys.argv[1:2] == [CHILD]:
        child(sys.argv[2:])
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
    middle, alone = found["transform"] + found["write"] + rest, found["start"] + rest
    path = found["start"] + max(found["read"], middle, found["prove"])
    print(f"\nthree processes of today: {whole / path:.2f} times as fast at most;")
    for cores in (2, 4, 16):
        most = whole / (alone + (whole - alone) / cores)
        print(f"windows shared by {cores} cores: {most:.1f} times, {alone / whole:.0%} in order")
    used = whole - found["start"]
    print(f"\nmemory; copies of long arrays reach {speed / 1e9:.1f} GB/s")
    for what, name in (("4 kB", "near"), ("1 MB", "far")):
        moved = 2 * found[name]
        print(f"blocks of {what} and more: {moved / lines:.0f} bytes a line,", end=" ")
        print(f"{moved / used / 1e9:.1f} GB/s, {moved / speed / used:.0%} of that")


if __name__ == "__main__":
    sys.exit(main())
