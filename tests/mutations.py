"""Do the tests see a wrong gcxform? Each mutation is a small fault; a test must fail on it.

    python tests/mutations.py [--jobs 2] [NAME ...]

The packages are copied to a temporary directory, one fault at a time is written into the copy, and
a few fast tests are run on it. A fault that no test notices survives; then the exit code is 1.
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
from dataclasses import dataclass
from pathlib import Path

from cycle_faults import CYCLE_FAULTS

ROOT = Path(__file__).parents[1]
PACKAGES = ("gcxform", "plugins/gcxform_plugins", "grammars/gcxform_grammars")
FAILED = 1  # pytest's exit code for tests that failed
TIMEOUT = 180  # seconds; a mutant that hangs is noticed too

PASSES = "plugins/gcxform_plugins/passes"
VERIFY = "tests/test_verify.py"
FIGURES = "tests/test_volumetric.py"
FOUND = "tests/properties/test_found.py"
CORPUS = "tests/test_corpus.py::test_case"
KIT = "tests/test_kit.py::test_registered_passes"
LAWS = "tests/properties/test_laws.py"
ARCS = "tests/test_arcs.py"
CYCLES = "tests/test_cycles.py"
STRETCHES = "tests/test_stretches.py"
LIMITS = "gcxform/modal/limits.py"
FACTS = "tests/test_dialect_facts.py::test_our_facts"
READING = "tests/test_verify.py::test_the_proof_reads_as_the_control_does"


@dataclass(frozen=True)
class Mutation:
    """A fault: `old`, which stands once in `file`, becomes `new`; a test of `tests` must fail."""

    name: str
    file: str
    old: str
    new: str
    tests: str


def _verifier(name: str, old: str, new: str = "if False:") -> Mutation:
    return Mutation(f"verifier: {name}", "gcxform/verify.py", old, new, VERIFY)


def _computed(name: str, file: str, old: str, new: str) -> Mutation:
    tests = "tests/test_expressions.py"
    return Mutation(f"computing: {name}", f"gcxform/modal/{file}.py", old, new, tests)


def _together(name: str, old: str, new: str) -> Mutation:
    drilling = "gcxform/modal/drilling.py"
    return Mutation(f"cycles: stretches made together {name}", drilling, old, new, STRETCHES)


MUTATIONS = (
    *(Mutation(f"cycles: {name}", *where, CYCLES) for name, *where in CYCLE_FAULTS),
    _together(
        "count events from the first of them", "event.row - int(bounds[number])", "event.row"
    ),
    _together("end at R under G98", "if initial else clearance", "if False else clearance"),
    _together("keep the dwell before them", "if place >= first:\n", "if False:\n"),
    _together("are one", "bounds[:-1], positions", "bounds[:1], positions[:1]"),
    Mutation(
        "cycles: a hole above R",
        "gcxform/modal/cyclechecks.py",
        "stretch.bottom > stretch.clearance",
        "stretch.bottom > np.inf",
        "tests/test_cycle_refusals.py",
    ),
    # times and restarts
    Mutation(
        "info: the feed per turn forgets the spindle",
        "gcxform/cli/times.py",
        "speed[event.row :] = self.spindle",
        "speed[event.row :] = 1.0",
        "tests/test_info.py",
    ),
    Mutation(
        "info: rapids take as long as the fastest axis",
        "gcxform/cli/times.py",
        "each.max(axis=1, initial=0.0)",
        "each.min(axis=1)",
        "tests/test_info.py",
    ),
    Mutation(
        "resume: the feed is stated in the wrong unit",
        "gcxform/cli/preamble.py",
        "feed_inch = self.state.feed_unit == INCH",
        "feed_inch = self.state.feed_unit != INCH",
        "tests/test_resume.py",
    ),
    Mutation(
        "resume: the coolant stays on",
        "gcxform/cli/memory.py",
        "off = COOLANT_OFF.get(code)",
        "off = ()",
        "tests/test_resume.py",
    ),
    Mutation(
        "haas: a dwell with a point is in milliseconds",
        "gcxform/modal/events.py",
        "lines.window.decimals[number] >= 0:",
        "lines.window.decimals[number] >= 9:",
        "tests/test_info.py",
    ),
    # parameters and expressions
    _computed("relations are as close as sums", "arithmetic", "EQUAL = 1e-4", "EQUAL = 1e-9"),
    _computed(
        "fractions are cut towards zero", "arithmetic", "float(math.floor(a))", "float(int(a))"
    ),
    _computed("MOD keeps the sign", "arithmetic", "rest if rest >= 0 else rest + abs(b)", "rest"),
    _computed("XOR is OR", "arithmetic", "(a != 0) != (b != 0)", "a != 0 or b != 0"),
    _computed("angles are in radians", "arithmetic", "np.longdouble(a) * PI / 180", "a"),
    _computed("a sign is lost", "expressions", "-value if children[0]", "value if children[0]"),
    _computed("operands are swapped", "expressions", "(left), self", "(right), self"),
    _computed("names have their case", "expressions", "BLANKS).lower()", "BLANKS)"),
    _computed(
        "what nobody set is zero",
        "expressions",
        "value = self.parameters.get(key)\n",
        "value = self.parameters.get(key, 0.0)\n",
    ),
    _computed(
        "assignments act at once",
        "computing",
        "return key, evaluator.value(expression)",
        "self.lines.parameters[key] = evaluator.value(expression)\n            return None",
    ),
    _computed(
        "parameters end with their window",
        "interpreter",
        "self.state.parameters = lines.parameters",
        "pass",
    ),
    Mutation(
        "an assignment stands in every piece of its block",
        "gcxform/emit/templates.py",
        "elif self.key.role not in (Role.MIDDLE, Role.LAST):\n            self._statement",
        "else:\n            self._statement",
        "tests/test_corpus.py",
    ),
    Mutation(
        "what a macro may have set is still known",
        "gcxform/modal/computing.py",
        "if self.meaning.runs_macro:",
        "if False:",
        "tests/test_corpus.py",
    ),
    Mutation(
        "computed distances are not rounded to the increment",
        "gcxform/modal/lines.py",
        "np.where(computed, rounded, np",
        "np.where(computed, value, np",
        "tests/test_expressions.py",
    ),
    # the error model and the search for commands
    Mutation(
        "compensate: the sign of the error is swapped",
        "gcxform/machine/errors.py",
        "np.subtract(target, command, out=command)",
        "np.add(target, command, out=command)",
        FIGURES,
    ),
    Mutation(
        "undo: the sign of the error is swapped",
        f"{PASSES}/undoing.py",
        "actual = point + self.step.error(point + offset)",
        "actual = point - self.step.error(point + offset)",
        VERIFY,
    ),
    Mutation(
        "E: an axis is dropped",
        "gcxform/machine/errors.py",
        'for k in range(3):\n            # "clip" spares',
        'for k in range(2):\n            # "clip" spares',
        FIGURES,
    ),
    Mutation(
        "E: one cell farther",
        "gcxform/machine/errors.py",
        "return cell.astype(np.intp), part",
        "return cell.astype(np.intp), part + 1.0",
        FIGURES,
    ),
    Mutation(
        "volumetric: the first node is skipped",
        f"{PASSES}/volumetric.py",
        "(n if bends else n[1:-1] for n in",
        "(n if bends else n[2:-1] for n in",
        FIGURES,
    ),
    Mutation(
        "volumetric: the last node of a move is skipped",
        "gcxform/toolpath/crossings.py",
        "np.maximum(high - low, 0)",
        "np.maximum(high - low - 1, 0)",
        FIGURES,
    ),
    Mutation(
        "volumetric: cuts are not made where the command crosses",
        f"{PASSES}/splitting.py",
        "part = part + np.where(",
        "part = part + 3.0 * np.where(",
        FIGURES,
    ),
    Mutation(
        "volumetric: the tolerance is doubled",
        f"{PASSES}/splitting.py",
        "limit = residual * (1 - 1e-6)",
        "limit = 2 * residual * (1 - 1e-6)",
        FIGURES,
    ),
    Mutation(
        "volumetric: pieces in inverse time keep the feed",
        f"{PASSES}/compensation.py",
        "path.feed[row] / share, path.feed[row]",
        "path.feed[row], path.feed[row]",
        VERIFY,
    ),
    # segment
    Mutation(
        "segment: the chord error is doubled",
        f"{PASSES}/segment.py",
        "chords(path, self.chord_error))",
        "chords(path, 2 * self.chord_error))",
        f"{KIT}[segment]",
    ),
    Mutation(
        "segment: pieces in inverse time keep the feed",
        f"{PASSES}/segment.py",
        "path.feed[row] * pieces[row], path.feed[row]",
        "path.feed[row], path.feed[row]",
        VERIFY,
    ),
    Mutation(
        "segment: pieces of arcs keep the sweep",
        f"{PASSES}/segment.py",
        "(path.sweep / pieces)[row]",
        "path.sweep[row]",
        f"{KIT}[segment]",
    ),
    Mutation(
        "undo: pieces in inverse time keep the feed",
        f"{PASSES}/undoing.py",
        "feed / (part - before), feed)",
        "feed, feed)",
        f"{KIT}[volumetric]",
    ),
    # feed
    Mutation(
        "feed: an arc is as long as its chord",
        f"{PASSES}/feed.py",
        "size[arcs] = self._arc_lengths(arcs)",
        "pass",
        f"{KIT}[feed]",
    ),
    Mutation(
        "feed: a helix does not rise",
        f"{PASSES}/feed.py",
        "np.hypot(first * self.path.sweep[rows], self.way[arcs, normal])",
        "first * self.path.sweep[rows]",
        f"{KIT}[feed]",
    ),
    Mutation(
        "feed: length over feed for feed over length",
        f"{PASSES}/feed.py",
        "factor = 1 / way if",
        "factor = way if",
        f"{KIT}[feed]",
    ),
    Mutation(
        "feed: degrees count beside millimetres",
        f"{PASSES}/feed.py",
        "self.way[:, self.linear] ** 2",
        "self.way**2",
        f"{CORPUS}[feed/rotary]",
    ),
    Mutation(
        "feed: the mode of a tool change is not restored",
        f"{PASSES}/feed.py",
        "kept = path.blocks.leaves",
        "kept = np.zeros_like(path.blocks.leaves)",
        f"{CORPUS}[feed/macro]",
    ),
    Mutation(
        "feed: the slowest rate of the control is ignored",
        f"{PASSES}/feed.py",
        "if slow.any():",
        "if False:",
        f"{CORPUS}[bad/gx320-too-slow]",
    ),
    Mutation(
        "writing: a feed mode that has changed is not stated",
        "gcxform/emit/pieces.py",
        'self._mode("feed-mode", wanted, self.believed.feed_mode, needs)',
        'self._mode("feed-mode", wanted, self.believed.feed_mode, needs & False)',
        f"{CORPUS}[feed/to-inverse-time]",
    ),
    Mutation(
        "writing: the end of a circle in inverse time is written",
        "gcxform/emit/centres.py",
        "silent |= full & (self.path.feed_mode[rows] == FeedMode.INVERSE_TIME)",
        "silent |= False",
        f"{CORPUS}[feed/full-circle]",
    ),
    Mutation(
        "a program without end leaves its feed mode behind",
        "gcxform/run.py",
        "if feed_modes:",
        "if False:",
        f"{CORPUS}[bad/gx321-no-end]",
    ),
    # reading
    Mutation(
        "reading: inches are millimetres",
        "gcxform/modal/track.py",
        "np.where(self.modes.inch, word[0] * INCH, word[0])",
        "word[0]",
        READING,
    ),
    Mutation(
        "reading: the sense of arcs is swapped",
        "gcxform/toolpath/path.py",
        "2.0 * self.kind - 5.0",
        "5.0 - 2.0 * self.kind",
        READING,
    ),
    Mutation(
        "reading: a full circle has no sweep",
        "gcxform/modal/arcs.py",
        "return np.where(same, TURN, angle)",
        "return np.where(same, 0.0, angle)",
        READING,
    ),
    Mutation(
        "reading: the long arc by radius is the short one",
        "gcxform/modal/arcs.py",
        "np.where(radius > 0, sense, -sense)",
        "np.where(radius > 0, sense, sense)",
        READING,
    ),
    Mutation(
        "reading: distances are added to the last absolute position only",
        "gcxform/modal/track.py",
        "np.where(placed, value - steps, 0.0)",
        "np.where(placed, value, 0.0)",
        READING,
    ),
    Mutation(
        "reading: positions are not carried into the next window",
        "gcxform/modal/track.py",
        "end[k] = position[-1]",
        "pass",
        VERIFY,
    ),
    Mutation(
        "reading: modes are not carried into the next window",
        "gcxform/modal/interpreter.py",
        "int(column[-1]) for name, column in last.items()",
        "self.state.groups[name] for name in last",
        VERIFY,
    ),
    Mutation(
        "reading: a lost position is ignored",
        "gcxform/toolpath/path.py",
        "start[(self.lost >> axis & 1) == 1, axis] = np.nan",
        "pass",
        FOUND,
    ),
    # writing
    Mutation(
        "writing: numbers are cut off, not rounded",
        "gcxform/emit/numbers.py",
        "(0.5 + TIE))\n    return np.copysign",
        "TIE)\n    return np.copysign",
        FIGURES,
    ),
    Mutation(
        "writing: an axis that the block does not name stays behind",
        "gcxform/emit/positions.py",
        "moved = ~(np.abs(held - self.before[:, column]) < 0.5 * self.step[column])",
        "moved = np.zeros(len(held), np.bool_)",
        FIGURES,
    ),
    Mutation(
        "writing: a motion code that has changed is not stated",
        "gcxform/emit/pieces.py",
        "changes = moves & (before != self.motion_after)",
        "changes = np.zeros(len(before), np.bool_)",
        LAWS + "::test_a_motion_code_that_no_longer_holds_is_stated",
    ),
    Mutation(
        "writing: centres count from where the start was before rounding",
        "gcxform/emit/centres.py",
        "np.where(exact[:, None], start, before)",
        "start",
        LAWS + "::test_centres_count_from_the_start_as_it_is_written",
    ),
    Mutation(
        "writing: distances are rounded one by one",
        "gcxform/emit/positions.py",
        "value - self.before[rows, column], value)",
        "(self.task.path.end - self.task.path.start)[rows, column], value)",
        LAWS + "::test_distances_do_not_drift",
    ),
    Mutation(
        "writing: what the control believes is not carried into the next window",
        "gcxform/emit/emitter.py",
        "believed.position = np.array(held)",
        "del held",
        VERIFY,
    ),
    # arcs for lines
    Mutation(
        "arcs: the sense is swapped",
        f"{PASSES}/fit.py",
        "np.where(self._sum(y) < 0, 1.0, -1.0)",
        "np.where(self._sum(y) < 0, -1.0, 1.0)",
        ARCS,
    ),
    Mutation(
        "arcs: the sagitta of the lines is not looked at",
        f"{PASSES}/fit.py",
        "flat = np.maximum(np.abs(size - inside), sagitta)",
        "flat = np.abs(size - inside)",
        ARCS,
    ),
    Mutation(
        "arcs: corners are not looked at",
        f"{PASSES}/fit.py",
        "flat = np.maximum(np.abs(size - inside), sagitta)",
        "flat = sagitta",
        ARCS,
    ),
    Mutation(
        "arcs: lines may go back",
        f"{PASSES}/fit.py",
        "good = (angle > 0) & (angle <= WIDEST) & self._points_along(x, y, size, wx, wy, length)",
        "good = angle <= WIDEST",
        ARCS,
    ),
    Mutation(
        "arcs: a break between lines is explained away",
        f"{PASSES}/fit.py",
        "(angle <= WIDEST) & self._points_along(x, y, size, wx, wy, length)",
        "(angle <= WIDEST)",
        ARCS,
    ),
    Mutation(
        "arcs: the axis of a helix is not looked at",
        f"{PASSES}/fit.py",
        "axial = self._off_axis(turned / sweep[self.run])",
        "axial = np.zeros(len(turned))",
        ARCS,
    ),
    Mutation(
        "arcs: what happens between lines is ignored",
        f"{PASSES}/arcs.py",
        "follows[[e.row for e in path.events if e.row < len(path)]] = False",
        "pass",
        ARCS,
    ),
    Mutation(
        "arcs: another feed is ignored",
        f"{PASSES}/arcs.py",
        "(path.plane, path.feed, path.feed_mode, path.frame)",
        "(path.plane, path.feed_mode, path.frame)",
        ARCS,
    ),
    Mutation(
        "arcs: they end inside blocks",
        f"{PASSES}/reach.py",
        "return np.where(self._own(first, stop), stop, self.before[stop])",
        "return stop",
        ARCS,
    ),
    Mutation(
        "arcs: a way straight ahead is an arc",
        f"{PASSES}/fit.py",
        "curved = near & (rises > self.limits.tolerance + self.limits.step)",
        "curved = near.copy()",
        ARCS,
    ),
    Mutation(
        "arcs: the motion code of a block that is gone counts",
        "gcxform/emit/pieces.py",
        "self.leads & ~self.silent & (self.role != Role.GONE)",
        "self.leads & ~self.silent",
        ARCS,
    ),
    Mutation(
        "runs: events may stand inside",
        "gcxform/verify.py",
        "through = int(self.through[written_row])",
        "through = int(self.written_owner[written_row])",
        ARCS,
    ),
    Mutation(
        "runs: another feed is ignored",
        "gcxform/toolpath/runs.py",
        "return np.asarray(same & (np.abs(path.feed - path.feed[base]) <= SAME_FEED * path.feed))",
        "return np.asarray(same)",
        ARCS,
    ),
    Mutation(
        "runs: another work offset is ignored",
        "gcxform/toolpath/runs.py",
        "same = free & free[base] & (path.frame == path.frame[base])",
        "same = free & free[base]",
        ARCS,
    ),
    Mutation(
        "runs: rapids are joined",
        "gcxform/toolpath/runs.py",
        "free = (path.kind != Kind.RAPID) & (path.form",
        "free = (path.kind >= Kind.RAPID) & (path.form",
        ARCS,
    ),
    Mutation(
        "runs: what lies behind a row that is not alike is joined",
        "gcxform/toolpath/runs.py",
        "covered = alike & (stop < base)",
        "covered = alike",
        ARCS,
    ),
    Mutation(
        "runs: arcs are compared at their ends alone",
        "gcxform/toolpath/beside.py",
        "bound[pieces] = np.maximum(bound[pieces], off)",
        "pass",
        ARCS,
    ),
    Mutation(
        "runs: lines are not compared at their ends",
        "gcxform/toolpath/beside.py",
        "bound = np.maximum(_apart(one.start, other.start), _apart(one.end, other.end))",
        "bound = np.zeros(len(one.row))",
        ARCS,
    ),
    # what a control refuses
    Mutation(
        "limits: a line may be one character longer",
        LIMITS,
        "if long > limit:",
        "if long > limit + 1:",
        FACTS,
    ),
    Mutation(
        "limits: blanks and comments count",
        LIMITS,
        "without_blanks(window.line(line)) if blanks else int(length[line])",
        "int(length[line])",
        FACTS,
    ),
    Mutation(
        "limits: speeds and times may be negative",
        LIMITS,
        "any(value < 0 for",
        "any(value < -10 for",
        FACTS,
    ),
    Mutation(
        "limits: turns belong to lines",
        LIMITS,
        "modes.motion < Kind.ARC_CW",
        "modes.motion > Kind.ARC_CCW",
        FACTS,
    ),
    # verification
    _verifier("the budget is ignored", "if not off.distance[worst] <= self.budget:"),
    _verifier("rotary axes are ignored", "if not off.angle[turned] <= self.angle_budget:"),
    _verifier("kinds are ignored", "if wrong.any():"),
    _verifier("feeds are ignored", "if (off & plain).any():"),
    _verifier("feed modes are ignored", "if strange.any():"),
    _verifier("converted feeds are ignored", "if len(off):"),
    _verifier(
        "feed modes left behind are ignored",
        "if (mode != read.modes.feed_mode[line]).any():",
    ),
    _verifier("times are ignored", "if len(wrong):"),
    _verifier(
        "events are ignored",
        "self._events(self._told(read.path.events), self._told(back.path.events), trace)",
        "",
    ),
    _verifier("missing events are ignored", "if len(old) != len(new):"),
    _verifier(
        "the place of events is ignored",
        "or not trace.stands_before(after.row, before.row, self.budget)",
        "",
    ),
    _verifier("missing moves are ignored", "self._missing(trace, runs)\n        if not", "if not"),
    _verifier("moves of nobody are ignored", "if len(trace.owner) and int(trace.owner.min()) < 0:"),
    _verifier("nothing is undone", "path = step.undo(path, self.context)", "pass"),
    Mutation(
        "deviation: the sense of arcs is ignored",
        "gcxform/toolpath/deviation.py",
        "(after.sense[rows] == self.sense)",
        "np.isfinite(self.sense)",
        VERIFY,
    ),
)


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
            command, cwd=ROOT, env=environment, capture_output=True, text=True, timeout=TIMEOUT
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
    parser.add_argument("names", nargs="*", help="parts of names of mutations")
    asked = parser.parse_args(arguments)
    chosen = [m for m in MUTATIONS if not asked.names or any(n in m.name for n in asked.names)]
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
