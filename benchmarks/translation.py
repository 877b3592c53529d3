"""Write every real program in each other dialect, and say which are, and why each other is not.

    python benchmarks/translation.py [CORPUS] [--from NAME] [--to NAME] [--every N] [--list]
                                     [--cause TEXT] [--lathes] [--keep FOLDER]

The programs are those of `corpus.py`, with the machines that it gives them. What counts is a
program that goes through `absolute` in its own dialect, is no file of a subprogram (which goes with
the program that calls it), none of a lathe (`--lathes` takes those as well), and moves no axis that
the target lacks.
*Verified* is one whose result is proved in the target, which `check` finds nothing new in, and of
which LinuxCNC's interpreter, where that is the target, reads every line to the end; what is proved
and is not so is a cause of its own, `CHECK` or `RS274`, for it is worth more than a refusal. Where
a refusal offers a pass, or a code that may be left out, that is taken; how many went through
without stands in brackets. Causes are judged in `translation.toml`.
"""

from __future__ import annotations

import argparse
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from functools import cache
from math import isnan
from pathlib import Path

from msgspec import structs

import gcxform as gx
from corpus import BESIDE, NUMBERS, OURS, Job, Outcome, counted, filled_in
from corpus import run as run_in_own
from gcxform.catalogue.remedies import StepBefore, offers
from gcxform.catalogue.settings import Setting
from gcxform.cli.check import reading_findings
from gcxform.flow.straightened import written_out
from gcxform.machine.machine import Tool
from gcxform.pipeline.chain_text import parse_chain
from gcxform.pipeline.pipeline import Pipeline
from gcxform.plugin.registry import default_registry
from gcxform.syntax.source import Source

TARGETS = ("linuxcnc", "fanuc", "haas", "grbl")
JUDGED = Path(__file__).with_name("translation.toml")
SECONDS = 60
WAYS = 5
"""How many offers of hints are taken, one after the other."""
M_CODES = {"grbl": {"M6": "M0"}}
"""What a user of each target says: a GRBL without a changer stops, and the operator changes."""
INERT = {"fanuc": ("M6",), "haas": ("M6",)}
"""Axes stand where they stood behind a tool change by hand, or by a changer that comes back: of the
target as of the source."""
RADIUS = 1.27
"""mm, of tools of which it was never asked: as `known.toml` has those of which it was."""
LATHES = re.compile(r"lathe|/g76")
"""In the path of a program for turning, which is asked of no mill."""
HELD = 99
"""The tool that is in the spindle of a LinuxCNC before the program, of that radius."""
SETTINGS = {"cycle-without-place": "drills", "peck-clearance": "1 mm"}
"""Setting 28 as a Haas is delivered, and Setting 22 as `known.toml` has it of a Fanuc."""
CONTOURS = "corners=arc entry=own"
"""How the source takes the corners and the entry of a contour, where parameters decide."""
INCREMENTS = {"fanuc": {None: "IS-B", "calculator": "calculator IS-B"}}
"""The steps to which a control rounds what it computes: of most machines those of 0.001 mm."""
UNITS = {"fanuc": "mm", "haas": "in"}
"""Those in which programs begin that do not say it: Setting 9 of a Haas as it is delivered."""
SLASHES = "execute"
"""The switch for blocks with a slash is off."""
DROPPED = ("M31", "M33")
"""What has no equal elsewhere and nobody misses: a Haas starts and stops its chip conveyor."""


@dataclass(frozen=True)
class Pair:
    """A program of the corpus, and the dialect that it is to be written in."""

    job: Job
    target: str


@cache
def into(job: Job, target: str) -> Pipeline:
    """Return the pipeline of a program with another target, and no pass."""
    made = filled_in(job.dialect, job.path, "absolute", job.corpus)
    kind = default_registry().dialect(target)
    source, m_codes = made.source, M_CODES.get(target, {})
    return replace(
        asked_for(made),
        target=kind,
        passes=(),
        numbers=NUMBERS if target != "fanuc" else None,
        m_codes={code: said for code, said in m_codes.items() if int(code[1:]) in source.m_codes},
        drop=frozenset(code for code in DROPPED if int(code[1:]) in source.m_codes),
        inert=frozenset(INERT.get(target, ())),
    )


def asked_for(made: Pipeline) -> Pipeline:
    """Return a pipeline with what its own control was never asked for, as its user knows it."""
    reading, steps = made.reading, INCREMENTS.get(made.source.name, {})
    made = replace(
        made,
        reading=replace(
            reading,
            increment=steps.get(reading.increment, reading.increment),
            block_delete=reading.block_delete or SLASHES,
            units=reading.units or UNITS.get(made.source.name, ""),
        ),
    )
    machine = made.machine
    if machine is None:
        return made
    settings = {key: machine.control.get(key) or said for key, said in SETTINGS.items()}
    known = {key: said for key, said in settings.items() if made.source.name == "haas"}
    tools = {
        number: structs.replace(tool, radius=RADIUS) if isnan(tool.radius) else tool
        for number, tool in machine.tools.items()
    }
    if made.source.name == "linuxcnc":
        made = replace(made, reading=replace(made.reading, tool=HELD))
        tools[HELD] = Tool(radius=RADIUS)
    told = {"tools": tools, "control": {**machine.control, **known}}
    inert = machine.inert_m | {int(code[1:]) for code in INERT.get(made.source.name, ())}
    return replace(made, machine=structs.replace(machine, **told, inert_m=inert, open={}))


@dataclass(frozen=True)
class Found:
    """What became of a program in a target, and what its hints had to add to get there."""

    outcome: Outcome
    added: tuple[str, ...] = ()


def translate(pair: Pair, keep: Path | None = None) -> Found:
    """Write a program in another dialect, and look at what comes out.

    What a refusal offers as a pass, or as a code to be left out, is taken, and nothing else.
    """
    pipeline, added = into(pair.job, pair.target), list[str]()
    while len(added) <= WAYS:
        try:
            result = pipeline.run(pair.job.corpus / pair.job.path)
        except gx.GcxformError as error:
            first = error.diagnostics[0]
            line = first.where.line if first.where else 0
            refused = Outcome(pair.job, first.code, first.message, line)
            try:
                step = offered(first.hint, added)
                step = told(step, pair.job.dialect) if step else step
                pipeline = taken(pipeline, step) if step else pipeline
            except gx.GcxformError:
                step = None
            if step is None:
                return Found(refused, tuple(added))
            added.append(said(step))
        except Exception as error:
            return Found(Outcome(pair.job, "CRASH", repr(error)), tuple(added))
        else:
            return Found(looked_at(pair, pipeline, result, keep), tuple(added))
    return Found(refused, tuple(added))


def offered(
    hint: str, added: Sequence[str], keys: Collection[str] = ("drop",)
) -> StepBefore | Setting | None:
    """Return the first offer of a hint that a user can take who knows the target alone.

    `keys` are those of the output that this user gives.
    """
    for offer in offers(hint):
        gives = isinstance(offer, Setting) and offer.section == "output" and offer.key in keys
        if (gives or isinstance(offer, StepBefore)) and said(offer) not in added:
            return offer
    return None


def said(offer: StepBefore | Setting) -> str:
    """Return an offer in words."""
    if isinstance(offer, Setting):
        return f"{offer.key} {' '.join(offer.worth())}"
    return f"{offer.name} {offer.options}".strip()


def told(offer: StepBefore | Setting, source: str) -> StepBefore | Setting:
    """Return an offer with what only the user of the source knows."""
    if not isinstance(offer, StepBefore) or offer.name != "cutter-comp" or source == "linuxcnc":
        return offer
    return offer._replace(options=f"{CONTOURS} {offer.options}".strip())


def taken(pipeline: Pipeline, offer: StepBefore | Setting) -> Pipeline:
    """Return a pipeline with what a hint offers."""
    if isinstance(offer, Setting):
        codes = getattr(pipeline, offer.key) | frozenset(offer.worth())
        return replace(pipeline, **{offer.key: codes})
    steps = parse_chain(said(offer), BESIDE, default_registry())
    rest = [step.name for step in pipeline.passes]
    at = rest.index(offer.step) if offer.step in rest else 0
    passes = (*pipeline.passes[:at], *steps, *pipeline.passes[at:])
    return replace(pipeline, passes=passes)


def looked_at(pair: Pair, pipeline: Pipeline, result: gx.Result, keep: Path | None) -> Outcome:
    """Return what is to be said of a result."""
    job = pair.job
    if keep is not None:
        file = keep / f"{job.dialect}-{pair.target}" / job.path.replace("/", "__")
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(result.text)
    if not result.certificate.verified:
        return Outcome(job, "NOT VERIFIED")
    return judged(pair, result.text) or Outcome(job)


def judged(pair: Pair, text: bytes) -> Outcome | None:
    """Return what is wrong with a program that is proved, if anything."""
    job, made = pair.job, into(pair.job, pair.target)
    same = replace(made, source=made.target, m_codes={}, drop=frozenset())
    try:
        same.run(text)
    except gx.GcxformError as error:
        first = error.diagnostics[0]
        return Outcome(
            job, "CHECK", f"{first.code} {first.message}", first.where.line if first.where else 0
        )
    if new := new_findings(pair, text):
        return Outcome(
            job, "CHECK", f"{' '.join(sorted(new))} in the target, and not in the source"
        )
    said = said_by_rs274(text, job.corpus) if pair.target == "linuxcnc" else ""
    return Outcome(job, "RS274", said) if said else None


def new_findings(pair: Pair, text: bytes) -> set[str]:
    """Return the codes of what `check` finds in a result, and not in its source."""
    made = replace(into(pair.job, pair.target), passes=())
    there = replace(made, source=made.target, m_codes={}, drop=frozenset(), inert=frozenset())
    found = found_by_check(there, Source.of_bytes(text))
    if not found:
        return found
    here = replace(made, target=made.source, m_codes={}, drop=frozenset(), inert=frozenset())
    return found - found_by_check(here, Source.of_bytes(pair.job.text))


def found_by_check(pipeline: Pipeline, source: Source) -> set[str]:
    """Return the codes of what speaks against reading a program as the source of a pipeline."""
    try:
        read = written_out(source, pipeline.source, pipeline.reading)
    except gx.InputError as error:
        return {each.code for each in error.diagnostics}
    return {each.code for each in reading_findings(pipeline, read)}


def said_by_rs274(text: bytes, corpus: Path) -> str:
    """Return what LinuxCNC's interpreter says against a program; nothing if it reads to its end."""
    if shutil.which("rs274") is None:
        return ""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "program.ngc")
        file.write_bytes(text)
        command = ["rs274", "-g", "-t", str(corpus / "rs274" / "tool.tbl"), str(file), "out"]
        found = subprocess.run(
            command, cwd=folder, capture_output=True, timeout=SECONDS, check=False
        )
        lines = found.stderr.decode("latin-1").splitlines()
        noise = ("executing", "link (updating")
        said = [line for line in lines if line.strip() and not line.startswith(noise)]
        return " ".join(said[:2]) if found.returncode else ""


def cause_of(one: Outcome) -> str:
    """Return the cause of an outcome, with the names of codes and without numbers."""
    says = re.sub(r"(?<![GM.\d])\d[-.\d]*", "..", re.sub("|".join(TARGETS), "it", one.says))
    return f"{one.code} {says[:75]}"


# --- which pairs there are ---


def pairs(jobs: Iterable[Job], targets: Iterable[str]) -> Iterator[Pair]:
    """Yield the programs that go through in their own dialect, with each other target."""
    for job in jobs:
        yield from (Pair(job, target) for target in targets if target != job.dialect)


def own(job: Job) -> bool:
    """Whether a program goes through in its own dialect."""
    return run_in_own(job).code in ("", "LOST")


def apart(pair: Pair, found: Outcome) -> bool:
    """Whether a pair does not count: the target lacks an axis, or the file is a subprogram."""
    if found.code == "GX226":
        return True
    return found.says.endswith("it has no such axis")


# --- what is printed ---


@cache
def judgements() -> list[dict[str, str]]:
    """Return what `translation.toml` says of causes."""
    found: list[dict[str, str]] = tomllib.loads(JUDGED.read_text("utf-8"))["cause"]
    return found


def judgement(one: Outcome) -> str:
    """Return whether a refusal is right or something is missing, and why; nothing for a new one."""
    for cause in judgements():
        if cause["code"] == one.code and re.search(cause.get("says", ""), one.says):
            kind = "right" if "right" in cause else "missing"
            return f"{kind}: {cause[kind]}"
    return ""


def print_tables(
    found: list[tuple[Pair, Found]], sources: Iterable[str], targets: Iterable[str]
) -> None:
    """Print how many are verified of how many, and the causes of the others, with judgements."""
    counts = Counter((p.job.dialect, p.target) for p, _ in found)
    good = Counter((p.job.dialect, p.target) for p, one in found if not one.outcome.code)
    alone = Counter(
        (p.job.dialect, p.target) for p, one in found if not (one.outcome.code or one.added)
    )
    targets = list(targets)
    print(f"\n| from | {' | '.join(f'to {t}' for t in targets)} |\n|---|{'--:|' * len(targets)}")
    for source in sources:
        cells = [
            f"{good[source, t]} ({alone[source, t]}) of {counts[source, t]}"
            if counts[source, t]
            else ""
            for t in targets
        ]
        print(f"| {source} | {' | '.join(cells)} |")
    causes = Counter(
        (judgement(one.outcome) or "NEW", cause_of(one.outcome))
        for _, one in found
        if one.outcome.code
    )
    print("\n| programs | cause | judgement |\n|--:|---|---|")
    for (judged_as, cause), count in causes.most_common():
        print(f"| {count} | {cause} | {judged_as} |")
    ways = Counter(step for _, one in found if not one.outcome.code for step in one.added)
    print("\n" + "; ".join(f"{step}: {count}" for step, count in ways.most_common()))
    total = sum(good.values()), sum(alone.values()), sum(counts.values())
    print("\n{} verified, {} of them without an option, of {}".format(*total))


def main() -> int:
    """Print the tables; return 1 if a program crashed, or a result is not what was promised."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("corpus", nargs="?", type=Path, default=BESIDE)
    parser.add_argument("--from", dest="source", choices=OURS, help="these programs alone")
    parser.add_argument("--to", choices=TARGETS, help="this target alone")
    parser.add_argument("--every", type=int, default=1, help="each so manieth program")
    parser.add_argument("--list", action="store_true", help="one line per program")
    parser.add_argument("--cause", help="list those alone whose cause has this text")
    parser.add_argument("--lathes", action="store_true", help="programs for turning as well")
    parser.add_argument("--keep", type=Path, help="write the results into a folder")
    options = parser.parse_args()
    sources = (options.source,) if options.source else TARGETS
    targets = (options.to,) if options.to else TARGETS
    jobs = [job for job in counted(options.corpus, sources) if job.chain == "absolute"]
    jobs = [job for job in jobs[:: options.every] if options.lathes or not LATHES.search(job.path)]
    with ProcessPoolExecutor(2) as pool:
        goes = list(pool.map(own, jobs, chunksize=4))
        todo = list(pairs((j for j, good in zip(jobs, goes, strict=True) if good), targets))
        outcomes = pool.map(translate, todo, [options.keep] * len(todo), chunksize=8)
        found = list(zip(todo, outcomes, strict=True))
    found = [(pair, one) for pair, one in found if not apart(pair, one.outcome)]
    for pair, each in found:
        one = each.outcome
        why = f"{one.code} {one.line}: {one.says}" if one.code else "verified"
        if options.list or (options.cause and options.cause in why):
            print(f"{pair.job.dialect} to {pair.target} {pair.job.path}: {why} {each.added}")
    print_tables(found, sources, targets)
    bad = {"CRASH", "NOT VERIFIED", "CHECK", "RS274"}
    return 1 if bad & {one.outcome.code for _, one in found} else 0


if __name__ == "__main__":
    sys.exit(main())
