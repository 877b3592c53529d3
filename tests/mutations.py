"""Do the tests see a wrong gcxform? Each mutation is a small fault; a test must fail on it.

    python tests/mutations.py [--jobs N] [--shares 1] [--since REV] [--remember] [NAME ...]

The packages are copied to temporary directories, as many as run at a time. A fault is written into
a copy, and the tests of the fault run on it until one fails. A fault that no test notices survives;
then the exit code is 1. Which test noticed is printed; in the end those of these that passed with
no other fault run on a copy without any, where they must pass. The faults are listed in
`tests/faults/`. The seconds are those of a processor, and the twenty faults that took most are
named in the end.

A fault is tried first in a copy of a process that has loaded gcxform, in which the code of a few
functions is replaced (`swapping.py`); commands that a test starts find it in the copied packages.
Where that cannot be done, or nothing fails, the copied packages are loaded anew.

With `--since` faults in files that differ from a commit are tried, and those that are noticed by
tests and cases that differ: a case that is changed may notice no more what it was written for.
Of `--shares` each commit has the next one to run: so many commits run all faults.

`--remember` writes into `tests/faults/noticed.txt` which test noticed, where that took long. Next
time it is run first; if it passes, or is no more, all tests of the fault are run. So this file
changes how long a verdict takes, and nothing else.

Tests run in copies of this process, which has imported what others wrote and nothing of gcxform, or
of one that has: a new one starts in milliseconds. Nothing but the test that is named is drawn up.
"""

from __future__ import annotations

import argparse
import compileall
import gc
import importlib
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import traceback
from collections import defaultdict
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from multiprocessing import Pipe
from pathlib import Path

import swapping
from faults import MUTATIONS
from faults.mutation import Mutation

ROOT = Path(__file__).parents[1]
PACKAGES = ("gcxform", "plugins/gcxform_plugins", "grammars/gcxform_grammars")
IMPORTED = (
    *("numpy", "lark", "pluggy", "click", "msgspec", "tomlkit", "tomllib", "scipy.optimize"),
    *("scipy.spatial.transform", "scipy.interpolate", "scipy.stats", "multiprocessing.connection"),
    *("matplotlib.figure", "matplotlib.backends.backend_agg", "hypothesis.strategies"),
    *("pytest", "_hypothesis_pytestplugin", "xdist.plugin", "xdist.looponfail", "xdist.newhooks"),
    *("pdb", "faulthandler", "readline", "unittest.mock", "_pytest.pytester_assertions"),
)
PLUGINS = ["--disable-plugin-autoload"]  # what is installed is not looked through for each fault
PLUGINS += [word for name in ("_hypothesis_pytestplugin", "xdist.plugin") for word in ("-p", name)]
FAILED, BROKEN = 1, 99  # FAILED is pytest's exit code for tests that failed
NOT_SWAPPED = 98
TIMEOUT = 180  # seconds for one set of tests; a mutant that hangs is noticed too
REMEMBERED = ROOT / "tests" / "faults" / "noticed.txt"
LONG = 0.7  # seconds of a processor
SLOWEST = 20  # so many are named in the end
SAID, NOTICED, PASSED = "said.txt", "noticed.txt", "passed.txt"
"""What pytest prints, which test failed, and which passed before it."""


# --- copies ---


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
    """Copy the packages into a folder, and compile what is not compiled already."""
    for package in PACKAGES:
        shutil.copytree(ROOT / package, folder / package)
        compileall.compile_dir(folder / package, quiet=2)
    return folder


def broken(mutation: Mutation, folder: Path) -> None:
    """Write a fault into a copy."""
    file = folder / mutation.file
    text = file.read_text(encoding="utf-8")
    assert text.count(mutation.old) == 1, mutation.name
    file.write_text(text.replace(mutation.old, mutation.new), encoding="utf-8")


def mended(mutation: Mutation, folder: Path) -> None:
    """Take a fault out of a copy; with its old time the file fits what was compiled of it."""
    shutil.copy2(ROOT / mutation.file, folder / mutation.file)


# --- processes ---

Job = tuple[Mutation | None, list[str]]  # a fault, or none, and the tests to run


def started(folder: Path, job: Job, loaded: swapping.Loaded | None) -> int:
    """Run tests on the packages in a folder, in a copy of this process; return its number."""
    for name in (NOTICED, PASSED, SAID):
        (folder / name).write_text("", encoding="utf-8")
    sys.stdout.flush()
    number = os.fork()
    if number == 0:
        code = BROKEN
        try:
            code = tested(folder, job, loaded)
        except BaseException:
            traceback.print_exc()
        finally:
            sys.stderr.flush()
            os._exit(code)
    return number


def tested(folder: Path, job: Job, loaded: swapping.Loaded | None) -> int:
    """Make this process one for the packages in a folder; return pytest's exit code."""
    mutation, tests = job
    os.setsid()  # what it starts can be ended with it
    signal.alarm(TIMEOUT * len(tests))
    if loaded and mutation and not swapped(mutation, loaded):
        return NOT_SWAPPED
    said = os.open(folder / SAID, os.O_CREAT | os.O_TRUNC | os.O_WRONLY)
    os.dup2(said, 1)
    os.dup2(said, 2)
    os.chdir(ROOT)
    sys.path[:0] = places = homes(folder)
    sys.dont_write_bytecode = True
    os.environ["PYTHONPATH"] = os.pathsep.join(places)
    os.environ["PYTHONDONTWRITEBYTECODE"] = "1"
    os.environ["HYPOTHESIS_PROFILE"] = "faults"
    package = importlib.import_module("gcxform")
    assert Path(str(package.__file__)).is_relative_to(ROOT if loaded else folder), package.__file__
    pytest = importlib.import_module("pytest")
    options = ["-x", "-q", "-p", "no:cacheprovider", f"--basetemp={folder / 'tmp'}"]
    options += PLUGINS
    options += ["-W", "ignore::pytest.PytestAssertRewriteWarning"]  # of what is imported already
    named = frozenset(test.partition("::")[2].partition("[")[0] for test in tests)
    return int(pytest.main([*options, *tests], plugins=[Noticed(folder, named)]))


def homes(folder: Path) -> list[str]:
    """Return where the packages are found that a folder has, or the repository."""
    return [str((folder / package).parent) for package in PACKAGES]


def swapped(mutation: Mutation, loaded: swapping.Loaded) -> bool:
    """Put a fault into what is loaded; tell whether that could be done."""
    text = (ROOT / mutation.file).read_text(encoding="utf-8")
    wrong = text.replace(mutation.old, mutation.new)
    return loaded.swapped(ROOT / mutation.file, text, wrong)


@dataclass
class Noticed:
    """Draws up the functions of a file that are named, and writes down what became of each test."""

    folder: Path
    named: frozenset[str]  # an empty name is the whole file

    def __post_init__(self) -> None:
        self.passed: list[str] = []

    def pytest_pycollect_makeitem(self, name):  # type: ignore[no-untyped-def]
        return None if "" in self.named or name in self.named else []

    def pytest_sessionfinish(self) -> None:
        (self.folder / PASSED).write_text("\0".join(self.passed), encoding="utf-8")
        gc.freeze()  # pytest looks for garbage five times before it ends, which took half a second

    def pytest_runtest_logreport(self, report) -> None:  # type: ignore[no-untyped-def]
        if report.failed:
            (self.folder / NOTICED).write_text(report.nodeid, encoding="utf-8")
        elif report.when == "call" and report.passed:
            self.passed.append(report.nodeid)


def ended() -> tuple[int, int, float]:
    """Wait for a process, end what it has started; return its number, exit code and seconds."""
    number, status, used = os.wait3(0)
    with suppress(ProcessLookupError):
        os.killpg(number, signal.SIGKILL)
    code = os.waitstatus_to_exitcode(status)
    seconds = used.ru_utime + used.ru_stime
    return number, FAILED if code == -signal.SIGALRM else code, seconds


# --- verdicts ---


@dataclass(frozen=True)
class Verdict:
    """What became of a job; `test` is the one that failed, empty where none did or one hung.

    `passed` are the tests that did, with the fault.
    """

    job: Job
    code: int
    test: str
    said: str
    seconds: float
    anew: bool  # whether gcxform was loaded for it
    passed: frozenset[str] = frozenset()

    @property
    def word(self) -> str:
        """Return what is printed."""
        return {0: "SURVIVED", FAILED: "caught"}.get(self.code, f"BROKEN ({self.code})")


def finished(
    jobs: list[Job], folders: list[Path], loaded: swapping.Loaded | None = None
) -> Iterator[Verdict]:
    """Do jobs, as many at a time as there are copies; yield the verdicts as they come."""
    waiting, free = jobs[::-1], list(folders)
    running: dict[int, tuple[Job, Path]] = {}
    while waiting or running:
        while waiting and free:
            job, folder = waiting.pop(), free.pop()
            if job[0]:
                broken(job[0], folder)
            running[started(folder, job, loaded)] = job, folder
        number, code, seconds = ended()
        job, folder = running.pop(number)
        if job[0]:
            mended(job[0], folder)
        free.append(folder)
        test, said, passed = (
            (folder / name).read_text("utf-8", "replace") for name in (NOTICED, SAID, PASSED)
        )
        others = frozenset(passed.split("\0"))
        yield Verdict(job, code, test, said[-3000:], seconds, loaded is None, others)


def finished_loaded(jobs: list[Job], folders: list[Path]) -> Iterator[Verdict]:
    """Do jobs as copies of a process that has loaded gcxform; some may be left undone."""
    receiver, sender = Pipe(duplex=False)
    number = os.fork()
    if number == 0:
        try:
            sys.path[:0] = homes(ROOT)
            loaded = swapping.load()
            gc.freeze()
            for one in finished(jobs, folders, loaded):
                sender.send(one)
        except BaseException:
            traceback.print_exc()
        finally:
            os._exit(0)
    sender.close()
    with suppress(EOFError):
        while True:
            yield receiver.recv()
    os.waitpid(number, 0)


def verdicts(chosen: list[Mutation], folders: list[Path]) -> Iterator[tuple[Mutation, Verdict]]:
    """Yield the verdicts on mutations; the test that noticed last time is asked before all."""
    before, left = remembered(), {m.name: m for m in chosen}
    for finish, first in ((finished_loaded, before), (finished, before), (finished, None)):
        jobs: list[Job] = [(m, [(first or {}).get(name, m.tests)]) for name, m in left.items()]
        for one in finish(jobs, folders):
            mutation = one.job[0]
            assert mutation is not None
            if one.code == FAILED or first is None:
                del left[mutation.name]
                yield mutation, one


def remembered() -> dict[str, str]:
    """Return which test noticed a mutation last time, where its tests take long."""
    lines = REMEMBERED.read_text("utf-8").splitlines() if REMEMBERED.is_file() else []
    return dict(line.split("\t") for line in lines)


def remember(found: list[tuple[Mutation, Verdict]]) -> None:
    """Write down which tests noticed, where that took long; keep what is known of the others."""
    known = remembered()
    slow = {m.name: v.test for m, v in found if v.test and (v.seconds > LONG or m.name in known)}
    known = {m.name: (known | slow).get(m.name, "") for m in MUTATIONS}
    lines = [f"{name}\t{test}\n" for name, test in known.items() if test]
    REMEMBERED.write_text("".join(lines), "utf-8")


def failing(found: list[Verdict], folders: list[Path]) -> list[str]:
    """Return what is said of tests that fail without a fault, a file at a time.

    They run as they did when they noticed one: in a gcxform that was loaded for it, or before. One
    that so passed with another fault fails because of its own.
    """
    said = []
    for finish, anew in ((finished_loaded, False), (finished, True)):
        by_file: dict[str, list[str]] = defaultdict(list)
        mine = [one for one in found if one.anew == anew]
        passed = frozenset[str]().union(*(one.passed for one in mine))
        for test in sorted({one.test for one in mine} - passed - {""}):
            by_file[test.partition("::")[0]].append(test)
        jobs: list[Job] = [(None, some) for some in sorted(by_file.values(), key=len, reverse=True)]
        verdicts = list(finish(jobs, folders)) if jobs else []
        assert len(verdicts) == len(jobs), "a process that had loaded gcxform ended before its time"
        said += [one.said for one in verdicts if one.code]
        print(
            f"{sum(one.seconds for one in verdicts):.0f} s to see that they pass without",
            flush=True,
        )
    return said


# --- the script ---


def main(arguments: list[str] | None = None) -> int:
    """Run all mutations, or those named; return the exit code."""
    parser = argparse.ArgumentParser(description="Do the tests see a wrong gcxform?")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--shares", type=int, default=1, help="run one of so many shares")
    parser.add_argument("--since", metavar="REV", help="those near what has changed since REV")
    parser.add_argument("--remember", action="store_true", help="write down what noticed")
    parser.add_argument("names", nargs="*", help="parts of names of mutations")
    asked = parser.parse_args(arguments)
    chosen = [m for m in MUTATIONS if not asked.names or any(n in m.name for n in asked.names)]
    if asked.since:
        git = ["git", "-C", str(ROOT), "diff", "--name-only", "--no-renames", asked.since]
        said = subprocess.run(git, capture_output=True, text=True, check=True).stdout
        paths = {*said.split("\n")}
        chosen = [mutation for mutation in chosen if paths & mutation.files]
    chosen = chosen[commits() % asked.shares :: asked.shares]
    if found := problems():
        print("\n".join(found))
        return 1
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    for module in IMPORTED:
        importlib.import_module(module)
    gc.freeze()
    with tempfile.TemporaryDirectory() as temporary:
        folders = [copied(Path(temporary) / str(n)) for n in range(asked.jobs)]
        return judged(chosen, folders, asked.remember)


def commits() -> int:
    """Return how many commits there are up to this one, 0 where git does not say."""
    count = ["git", "-C", str(ROOT), "rev-list", "--count", "HEAD"]
    if shutil.which("git") is None:
        return 0
    return int(subprocess.run(count, capture_output=True, text=True).stdout or 0)


def judged(chosen: list[Mutation], folders: list[Path], writes: bool) -> int:
    """Print a verdict on each mutation, and what fails without any; return the exit code."""
    width = max(len(mutation.name) for mutation in chosen)
    found = []
    for mutation, one in verdicts(chosen, folders):
        name = f"{mutation.name:{width}}"
        print(f"{name}  {one.word}  {one.seconds:5.1f} s  {one.test}", flush=True)
        if one.code not in (0, FAILED):
            print(one.said)
        found.append((mutation, one))
    print(f"{sum(one.seconds for _, one in found):.0f} s of a processor; most of it:")
    for mutation, one in sorted(found, key=lambda f: f[1].seconds, reverse=True)[:SLOWEST]:
        print(f"{one.seconds:6.1f} s  {mutation.name}  {one.test}")
    caught = sum(one.code == FAILED for _, one in found)
    print(f"{caught} of {len(found)} mutations are caught")
    if wrong := failing([one for _, one in found], folders):
        print("without any mutation these fail as well:", *wrong, sep="\n")
    elif writes:
        remember(found)
    return int(bool(wrong) or caught < len(found))


if __name__ == "__main__":
    sys.exit(main())
