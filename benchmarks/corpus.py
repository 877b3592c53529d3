"""Run every real program of a corpus and say which go through, and why each other does not.

    python benchmarks/corpus.py [CORPUS] [--list] [--dialect NAME] [--cause TEXT] [--bytes] [--new]

CORPUS is a folder with `manifest.csv`, `rs274_results.csv` and `programs/`; by default the one
beside the checkout. Each program is run where it lies, through two chains, with the files that
`gcxform machine new` wrote and a user of its machine filled in (`corpus_machines/`, chosen by
`corpus.toml`); `--new` writes them anew, and says what a user knows and was never asked for.

*Through* is a program whose result is proved, and which holds what its source held: as many blocks
that move, and every subprogram by its name, counted by patterns that know nothing of gcxform. What
is lost in a proved run is the cause `LOST`, and counts as not through.

Every cause has a judgement in `corpus.toml`: *right*, and why; or *missing*, and what. Programs of
LinuxCNC count if its interpreter `rs274` accepts them, of GRBL if its parser does, by the rules in
`grbl_rules.py`.
"""

from __future__ import annotations

import argparse
import csv
import re
import signal
import sys
import tomllib
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from types import FrameType
from typing import Any

from corpus_files import known_of, written
from grbl_rules import accepts

import gcxform as gx
from gcxform.modal.reader import WindowReader
from gcxform.modal.state import Entry, Reading
from gcxform.pipeline.chain_text import parse_chain
from gcxform.pipeline.file import load
from gcxform.pipeline.pipeline import Pipeline
from gcxform.plugin.registry import default_registry
from gcxform.syntax.source import Source
from gcxform.syntax.tree import print_block

HERE = Path(__file__).resolve().parent
BESIDE = HERE.parents[1] / "shared" / "corpus"
MODEL = HERE.parent / "examples" / "lddm" / "model.toml"
CHAIN = f"absolute | segment chord-error=5um | volumetric model={MODEL} outside=clamp tolerance=1um"
CHAINS = {"absolute": "absolute", "compensated": CHAIN}
OURS = ("fanuc", "grbl", "haas", "linuxcnc", "siemens", "heidenhain")
NAMED = {"sinumerik": "siemens"}
"""The dialects of the corpus that have another name here."""
WHOLE_LANGUAGES = ("siemens", "heidenhain")
"""Those that are written in their own language: by passes that change no position."""
BARS = {"fanuc": 32, "grbl": 38, "haas": 11, "linuxcnc": 129, "siemens": 42, "heidenhain": 17}
"""Programs that are to go through `absolute`; in the long chain a tenth fewer may."""
KEPT = re.compile(r"lines .* \((\d+)\) are kept as they stand")
STANDING = re.compile(r"lines .* \((\d+)\) stand as they do")
"""What a certificate says of lines that are not understood, and of others that stay as they do."""
MOST_KEPT = {"siemens": 140}
"""Lines of programs that may be kept as not understood."""
SECONDS = 120  # of a processor
START = Reading({"X": 0.0, "Y": 0.0, "Z": 0.0})
"""Many programs leave an axis where it is: the machine is taken to stand at its origin."""
NUMBERS = gx.NumberFormat(mm=4, inch=5, angle=4)


@dataclass(frozen=True)
class Job:
    """A program of the corpus, and the chain that it is run through."""

    corpus: Path
    path: str
    dialect: str
    chain: str

    @property
    def text(self) -> bytes:
        """The program."""
        return (self.corpus / self.path).read_bytes()


@dataclass(frozen=True)
class Outcome:
    """What became of a program: nothing in `code` if it went through.

    `kept`: how many of its lines stay because they are not understood; `standing`: how many others
    do, because only the control knows their values, or whether they are executed.
    """

    job: Job
    code: str = ""
    says: str = ""
    line: int = 0
    kept: int = 0
    standing: int = 0

    @property
    def cause(self) -> str:
        """The code and the sentence, without names and numbers."""
        says = re.sub(r"(?<=O)<[^>]*>|\d[-.\d]*", "..", self.says, flags=re.IGNORECASE)
        return f"{self.code} {says[:75]}"

    @property
    def judgement(self) -> str:
        """What `corpus.toml` says of the cause; empty if nothing."""
        for cause in notes()["cause"]:
            named = re.search(cause.get("programs", ""), self.job.path)
            if cause["code"] == self.code and re.search(cause.get("says", ""), self.says) and named:
                kind = "right" if "right" in cause else "missing"
                return f"{kind}: {cause[kind]}"
        return ""


# --- what is run ---


@cache
def notes() -> dict[str, list[dict[str, Any]]]:
    """Return the machines and the judgements of `corpus.toml`."""
    return tomllib.loads((HERE / "corpus.toml").read_text("utf-8"))


def pipeline(dialect: str, chain: str) -> Pipeline:
    """Return a chain in one of our dialects, with nothing that a machine file says."""
    kind = default_registry().dialect(dialect)
    passes = tuple(parse_chain(chain, HERE, default_registry()))
    return Pipeline(kind, kind, passes, START, numbers=NUMBERS)


def machine_of(dialect: str, path: str) -> dict[str, Any]:
    """Return what `corpus.toml` says of the machine of a program."""
    mine = [m for m in notes()["machine"] if m["dialect"] == dialect]
    return [m for m in mine if re.search(m.get("programs", ""), path)][-1]


def write_anew(jobs: Iterable[Job]) -> None:
    """Write the files of the machines of programs, and print what was not asked for."""
    programs: dict[tuple[str, str], dict[Path, None]] = {}
    for job in jobs:
        machine = job.dialect, machine_of(job.dialect, job.path)["file"]
        programs.setdefault(machine, {})[job.corpus / job.path] = None
    for (dialect, file), paths in programs.items():
        place = HERE / "corpus_machines" / file
        known = known_of(place.stem)
        if known is None:
            print(f"{file}: written by hand")
            continue
        left = written(dialect, [*paths], (None, CHAIN), place, known)
        print(f"{file}: not asked for: {', '.join(left) or 'nothing'}")


def entry_of(said: Mapping[str, Any]) -> Entry:
    """Return how a subprogram is called: modes, feed, and where each axis stands."""
    start = {axis: value for axis, value in said.items() if axis.isupper()}
    return Entry(modes=tuple(said["modes"].split()), start=start, feed=said["feed"])


@cache
def filled_in(dialect: str, path: str, chain: str, corpus: Path) -> Pipeline:
    """Return a chain with what the user of the machine of a program filled in."""
    registry = default_registry()
    user = machine_of(dialect, path)
    spec = load(HERE / "corpus_machines" / user["file"], registry)
    passes = tuple(parse_chain(CHAINS[chain], HERE, registry))
    made = Pipeline.of_spec(replace(spec, passes=passes), registry, dialect)
    if "entry" in user:
        made = replace(made, reading=replace(made.reading, entry=entry_of(user["entry"])))
    if "tool" in user:
        made = replace(made, reading=replace(made.reading, tool=user["tool"]))
    if "beside" in user:
        folder = (corpus / path).parent / user["beside"]
        made = replace(made, reading=replace(made.reading, subprograms=(folder,)))
    return replace(made, numbers=NUMBERS)


def counted(corpus: Path, ours: Iterable[str] = OURS) -> Iterator[Job]:
    """Yield the programs that count, through each chain."""
    with (corpus / "rs274_results.csv").open(newline="") as stream:
        accepted = {row["path"] for row in csv.DictReader(stream) if row["exit"] == "0"}
    with (corpus / "manifest.csv").open(newline="") as stream:
        programs = [r for r in csv.DictReader(stream) if r["role"] == "program"]
    for row in programs:
        dialect, path = NAMED.get(row["dialect"], row["dialect"]), row["path"]
        if dialect not in ours or (dialect == "linuxcnc" and path not in accepted):
            continue
        if dialect == "grbl" and not accepts((corpus / path).read_bytes()):
            continue
        chains = ["absolute"] if dialect in WHOLE_LANGUAGES else CHAINS
        yield from (Job(corpus, path, dialect, chain) for chain in chains)


def run(job: Job) -> Outcome:
    """Run a program through its chain."""
    try:
        with_limit = filled_in(job.dialect, job.path, job.chain, job.corpus)
        signal.signal(signal.SIGPROF, _too_long)
        signal.setitimer(signal.ITIMER_PROF, SECONDS)
        result = with_limit.run(job.corpus / job.path)
    except gx.GcxformError as error:
        first = error.diagnostics[0]
        return Outcome(job, first.code, first.message, first.where.line if first.where else 0)
    except TimeoutError:
        return Outcome(job, "TIME", f"not done after {SECONDS} s of a processor")
    except Exception as error:
        return Outcome(job, "CRASH", repr(error))
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
    if not result.certificate.verified:
        return Outcome(job, "NOT VERIFIED")
    lost = what_is_lost(job.text, result.text, job.dialect)
    said = result.certificate.assumed
    kept, standing = (sum(int(m[1]) for m in map(w.search, said) if m) for w in (KEPT, STANDING))
    return Outcome(job, "LOST", lost) if lost else Outcome(job, kept=kept, standing=standing)


def _too_long(number: int, frame: FrameType | None) -> None:
    raise TimeoutError


def outcomes(jobs: Iterable[Job], processes: int = 2) -> list[Outcome]:
    """Return what became of programs."""
    with ProcessPoolExecutor(processes) as pool:
        return list(pool.map(run, jobs))


# --- what a program holds ---

WORD = rb"(?<![#<A-Z])[XYZABCUVW][ \t]*(?:[-+.0-9#\[]|[A-Z]{2,5}[ \t]*\[)"
MOVES = re.compile(WORD, re.IGNORECASE)
NAME = re.compile(rb"O[ \t]*(<[^<>]*>|[0-9]+)[ \t]*(?:SUB)?", re.IGNORECASE)
SIEMENS = re.compile(rb"(?<![A-Z0-9_$])[XYZABCUVW][0-9]?[ \t]*(?:[-+.0-9]|=)", re.IGNORECASE)
DEFINED = re.compile(rb"(?:N[0-9]+[ \t]+)?((?:DEF|PROC|EXTERN)\b.*)", re.IGNORECASE)
KLARTEXT = re.compile(
    rb"^[ \t]*(?:[0-9]+[ \t]+)?(?:L|LP|C|CP|CR|CT|CTP|RND|CHF|APPR|DEP|LN|F[LC]T?)"
    rb"(?![A-Z])(?=[^;]*[0-9])",
    re.IGNORECASE,
)
LABELS = re.compile(rb"[ \t]*(?:[0-9]+[ \t]+)?((?:LBL|CYCLE?[ \t]+DEF|TOOL[ \t]+DEF)\b.*)", re.I)
LANGUAGES = {"siemens": (SIEMENS, DEFINED), "heidenhain": (KLARTEXT, LABELS)}
"""Patterns of lines that move, and of definitions, where programs are not made of words alone."""
FLOW = re.compile(rb"O[ \t]*(?:<[^<>]*>|[0-9]+)[ \t]*[A-Z]{2}", re.IGNORECASE)
ASIDE = re.compile(rb"\([^()\n]*\)|;[^\n]*|^[/\s]*(?:N[0-9.]+)?\s+")


def held(text: bytes, dialect: str) -> tuple[int, Counter[bytes]]:
    """Return how many blocks move, and which names of subprograms there are, by patterns alone.

    Of a language with definitions these are what counts as names.
    """
    if dialect in WHOLE_LANGUAGES:
        moves, definition = LANGUAGES[dialect]
        codes = [line.partition(b";")[0].strip() for line in text.splitlines()]
        defined = Counter(m[1].lower() for m in map(definition.fullmatch, codes) if m)
        return sum(moves.search(line) is not None for line in codes), defined
    lines = [ASIDE.sub(b"", line).strip() for line in text.splitlines()]
    names = Counter(m[1].lower() for m in map(NAME.fullmatch, lines) if m)
    plain = [line for line in lines if FLOW.match(line) is None]
    return sum(MOVES.search(line) is not None for line in plain), names


def what_is_lost(before: bytes, after: bytes, dialect: str = "") -> str:
    """Return a sentence about blocks and names of a source that its result has not; or nothing."""
    moves, names = held(before, dialect)
    moves_after, names_after = held(after, dialect)
    gone = names - names_after
    if gone:
        return f"{gone.total()} of {names.total()} definitions are gone"
    return f"{moves - moves_after} of {moves} motions are gone" if moves > moves_after else ""


def prints_back(text: bytes, dialect: str) -> bool:
    """Whether the empty pipeline, and the trees of all lines, give the bytes that were read."""
    reader = WindowReader(default_registry().dialect(dialect))
    grammar = reader.dialect.load_grammar()
    printed = []
    for part in Source.of_bytes(text).windows():
        window = reader.read(part)
        for line in range(len(window)):
            block = grammar.parse(window.line(line).decode("latin-1"))
            end = part[int(window.end[line]) : int(window.next[line])]
            printed.append(print_block(block).encode("latin-1") + end)
    return b"".join(printed) == text == pipeline(dialect, "").run(text).text


# --- what is printed ---


def kept_lines(found: Iterable[Outcome]) -> dict[str, tuple[int, int, int, int]]:
    """Return of whole languages how many lines are not understood, stand, and have code.

    Then in how many programs all are understood. Programs that do not go through do not count.
    """
    table: dict[str, tuple[int, int, int, int]] = {}
    for one in found:
        if one.job.dialect in WHOLE_LANGUAGES and not one.code:
            codes = [line.partition(b";")[0].strip() for line in one.job.text.splitlines()]
            mine = one.kept, one.standing, len([*filter(None, codes)]), int(not one.kept)
            so_far = table.get(one.job.dialect, (0, 0, 0, 0))
            table[one.job.dialect] = tuple(map(sum, zip(so_far, mine, strict=True)))  # type: ignore[assignment]
    return table


def through(found: Iterable[Outcome]) -> dict[tuple[str, str], tuple[int, int]]:
    """Return how many programs went through, and how many there are, by dialect and chain."""
    kinds = [(one.job.dialect, one.job.chain, not one.code) for one in found]
    totals, good = Counter(k[:2] for k in kinds), Counter(k[:2] for k in kinds if k[2])
    return {key: (good[key], total) for key, total in totals.items()}


def print_tables(found: list[Outcome]) -> None:
    """Print how many go through, and each cause with its judgement."""
    table = through(found)
    print(f"\n| through | {' | '.join(CHAINS)} | of | bar |\n|---|{'--:|' * (len(CHAINS) + 2)}")
    for dialect in dict.fromkeys(key[0] for key in table):
        counts = [table[dialect, chain][0] if (dialect, chain) in table else "" for chain in CHAINS]
        cells = [dialect, *counts, table[dialect, "absolute"][1], BARS[dialect]]
        print(f"| {' | '.join(map(str, cells))} |")
    for dialect, (kept, standing, lines, whole) in kept_lines(found).items():
        bar = f" (bar {MOST_KEPT[dialect]})" if dialect in MOST_KEPT else ""
        print(f"\n{dialect}: of {lines} lines {kept} are not understood{bar}")
        print(f"and {standing} stand as they do; in {whole} programs all are understood")
    causes = Counter((o.job.chain, o.job.dialect, o.cause, o.judgement) for o in found if o.code)
    print("\n| chain | dialect | cause | programs | judgement |\n|---|---|---|--:|---|")
    for (chain, dialect, cause, judgement), count in sorted(causes.items()):
        print(f"| {chain} | {dialect} | {cause} | {count} | {judgement} |")


def main() -> int:
    """Print the tables; return 1 if a program crashed, or a result is not what was promised."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("corpus", nargs="?", type=Path, default=BESIDE)
    parser.add_argument("--list", action="store_true", help="one line per program")
    parser.add_argument("--dialect", choices=OURS, help="these programs alone")
    parser.add_argument("--cause", help="list those alone whose cause has this text")
    parser.add_argument("--bytes", action="store_true", help="also that trees print the programs")
    parser.add_argument("--new", action="store_true", help="write the files of the machines anew")
    options = parser.parse_args()
    ours = (options.dialect,) if options.dialect else OURS
    jobs = list(counted(options.corpus, ours))
    if options.new:
        write_anew(jobs)
    found = outcomes(jobs)
    for one in found:
        kept = f", {one.kept} lines not understood" if one.kept else ""
        why = f"{one.code} {one.line}: {one.says}" if one.code else f"through{kept}"
        if options.list or (options.cause and options.cause in why):
            print(f"{one.job.dialect} {one.job.chain} {one.job.path}: {why}")
    print_tables(found)
    words = [job for job in jobs if job.dialect not in WHOLE_LANGUAGES]
    same = not options.bytes or all(prints_back(job.text, job.dialect) for job in words)
    return 0 if same and not {"CRASH", "NOT VERIFIED"} & {one.code for one in found} else 1


if __name__ == "__main__":
    sys.exit(main())
