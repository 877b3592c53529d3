"""Do the tests see a wrong gcxform? Each mutation is a small fault; a test must fail on it.

    python tests/mutations.py [--jobs 2] [--every 1] [NAME ...]

The packages are copied to a temporary directory, one fault at a time is written into the copy, and
a few fast tests are run on it. A fault that no test notices survives; then the exit code is 1. The
faults are listed in `tests/faults/`.
"""

from __future__ import annotations

import argparse
import os
import queue
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from faults import MUTATIONS
from faults.mutation import Mutation

ROOT = Path(__file__).parents[1]
PACKAGES = ("gcxform", "plugins/gcxform_plugins", "grammars/gcxform_grammars")
FAILED = 1  # pytest's exit code for tests that failed
TIMEOUT = 180  # seconds for one set of tests; a mutant that hangs is noticed too


# --- the copy ---


def problems() -> list[str]:
    """Return the mutations whose old text does not stand exactly once in its file."""
    found = []
    for mutation in MUTATIONS:
        file = ROOT / mutation.file
        count = file.read_text(encoding="utf-8").count(mutation.old) if file.is_file() else 0
        if count != 1:
            found.append(f"{mutation.name}: stands {count} times in {mutation.file}")
    return found


def copied(folder: Path) -> Path:
    """Copy the packages into a folder."""
    for package in PACKAGES:
        ignored = shutil.ignore_patterns("__pycache__")
        shutil.copytree(ROOT / package, folder / package, ignore=ignored)
    return folder


def run(folder: Path, *tests: str) -> int:
    """Run tests on the packages in a folder; return pytest's exit code."""
    places = [folder, *((folder / package).parent for package in PACKAGES[1:])]
    environment = os.environ | {
        "PYTHONPATH": os.pathsep.join(map(str, places)),
        "PYTHONDONTWRITEBYTECODE": "1",
        "HYPOTHESIS_PROFILE": "ci",
    }
    environment.pop("GCXFORM_MUTATIONS", None)
    own = [sys.executable, "-P"]  # the current directory holds the packages without the fault
    seen = subprocess.run(
        [*own, "-c", "import gcxform; print(gcxform.__file__)"],
        cwd=ROOT,
        env=environment,
        capture_output=True,
        text=True,
        check=True,
    )
    assert seen.stdout.startswith(str(folder)), seen.stdout
    command = [*own, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", *tests]
    try:
        done = subprocess.run(
            command,
            cwd=ROOT,
            env=environment,
            capture_output=True,
            text=True,
            timeout=TIMEOUT * len(tests),
        )
    except subprocess.TimeoutExpired:
        return FAILED
    if done.returncode not in (0, FAILED):
        print(done.stdout[-3000:], done.stderr[-1000:], sep="\n")
    return done.returncode


def verdict(mutation: Mutation, folder: Path) -> str:
    """Run the tests of a mutation on a copy that has it; the copy is mended again."""
    file = folder / mutation.file
    text = file.read_text(encoding="utf-8")
    assert text.count(mutation.old) == 1, mutation.name
    file.write_text(text.replace(mutation.old, mutation.new), encoding="utf-8")
    try:
        code = run(folder, mutation.tests)
    finally:
        file.write_text(text, encoding="utf-8")
    return {0: "SURVIVED", FAILED: "caught"}.get(code, f"BROKEN ({code})")


# --- the script ---


def main(arguments: list[str] | None = None) -> int:
    """Run all mutations, or those named; return the exit code."""
    parser = argparse.ArgumentParser(description="Do the tests see a wrong gcxform?")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--every", type=int, default=1, help="run one of so many")
    parser.add_argument("names", nargs="*", help="parts of names of mutations")
    asked = parser.parse_args(arguments)
    chosen = [m for m in MUTATIONS if not asked.names or any(n in m.name for n in asked.names)]
    chosen = chosen[:: asked.every]
    if found := problems():
        print("\n".join(found))
        return 1
    with tempfile.TemporaryDirectory() as temporary:
        folders = [copied(Path(temporary) / str(n)) for n in range(asked.jobs)]
        tests = sorted({m.tests for m in chosen})
        if run(folders[0], *tests):
            print("the tests fail without any mutation")
            return 1
        verdicts = report(chosen, in_parallel(chosen, folders))
    print(f"{verdicts.count('caught')} of {len(verdicts)} mutations are caught")
    return int(any(v != "caught" for v in verdicts))


def report(chosen: list[Mutation], verdicts: Iterable[str]) -> list[str]:
    """Print the table row by row, as the verdicts come in; return them."""
    width = max(len(mutation.name) for mutation in chosen)
    found = []
    for mutation, one in zip(chosen, verdicts, strict=True):
        print(f"{mutation.name:{width}}  {one}", flush=True)
        found.append(one)
    return found


def in_parallel(chosen: list[Mutation], folders: list[Path]) -> Iterator[str]:
    """Yield the verdicts on mutations, found as many at a time as there are copies."""
    free: queue.Queue[Path] = queue.Queue()
    for folder in folders:
        free.put(folder)

    def work(mutation: Mutation) -> str:
        folder = free.get()
        try:
            return verdict(mutation, folder)
        finally:
            free.put(folder)

    with ThreadPoolExecutor(len(folders)) as pool:
        yield from pool.map(work, chosen)


if __name__ == "__main__":
    sys.exit(main())
