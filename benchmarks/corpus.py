"""Run every real program of a corpus and print how many go through and why the rest is refused.

    python benchmarks/corpus.py [CORPUS] [--list]

CORPUS is a folder with `manifest.csv` and `programs/`; by default the one beside the checkout. For
each program: reading and printing must give its bytes, so must the empty pipeline, and `absolute |
segment | volumetric` must give a verified program or a refusal with a code and a line. Programs of
other dialects are run too, as each of ours: they may be refused, but never crash.

A second table says what the programs that go through held, before and after: blocks that move,
subprograms, parameters that are set. A program that moved and does not move any more is emptied,
and one that is refused has lost nothing.
"""

from __future__ import annotations

import argparse
import csv
import re
import sys
from collections import Counter
from pathlib import Path

import gcxform as gx
from gcxform.modal.reader import WindowReader
from gcxform.modal.state import Reading
from gcxform.pipeline.pipeline import Pipeline
from gcxform.plugin.registry import default_registry
from gcxform.syntax.source import Source
from gcxform.syntax.tree import print_block

HERE = Path(__file__).resolve().parent
BESIDE = HERE.parents[1] / "shared" / "corpus"
MODEL = HERE.parent / "examples" / "lddm" / "model.toml"
CHAIN = (
    "absolute | segment chord-error=5um | "
    f"volumetric model={MODEL} part-origin=0,0,0 outside=clamp tolerance=1um"
)
OURS = ("fanuc", "grbl", "haas", "linuxcnc")
START = Reading({"X": 0.0, "Y": 0.0, "Z": 0.0})
"""Many programs leave an axis where it is: the machine is taken to stand at its origin."""
NUMBERS = gx.NumberFormat(mm=4, inch=5, angle=4)


def pipeline(dialect: str, chain: str) -> Pipeline:
    """Return a chain in one of our dialects."""
    kind = default_registry().dialect(dialect)
    passes = Pipeline.parse(chain, dialect).passes
    return Pipeline(kind, kind, passes, START, numbers=NUMBERS)


def prints_back(text: bytes, dialect: str) -> bool:
    """Whether the trees of all lines print the bytes they were read from."""
    reader = WindowReader(default_registry().dialect(dialect))
    grammar = reader.dialect.load_grammar()
    printed = []
    for part in Source.of_bytes(text).windows():
        window = reader.read(part)
        for line in range(len(window)):
            block = grammar.parse(window.line(line).decode("latin-1"))
            end = part[int(window.end[line]) : int(window.next[line])]
            printed.append(print_block(block).encode("latin-1") + end)
    return b"".join(printed) == text


HELD = ("motions", "definitions", "assignments")
WORD = rb"(?<![#<A-Z])[XYZABCUVW][ \t]*(?:[-+.0-9#\[]|[A-Z]{2,5}[ \t]*\[)"
MOVES = re.compile(WORD, re.IGNORECASE)
NAME = re.compile(rb"O[ \t]*(?:<[^<>]*>|[0-9]+)[ \t]*(?:SUB)?", re.IGNORECASE)
FLOW = re.compile(rb"O[ \t]*(?:<[^<>]*>|[0-9]+)[ \t]*[A-Z]{2}", re.IGNORECASE)
SETS = re.compile(rb"#[^#=\s]+[ \t]*=", re.IGNORECASE)
ASIDE = re.compile(rb"\([^()\n]*\)|;[^\n]*|^[/\s]*(?:N[0-9.]+)?\s+")


def held(text: bytes) -> tuple[int, int, int]:
    """Return how many blocks move, begin a subprogram, and set a parameter, by patterns alone."""
    lines = [ASIDE.sub(b"", line) for line in text.splitlines()]
    names = sum(NAME.fullmatch(line) is not None for line in lines)
    plain = [line for line in lines if FLOW.match(line) is None]
    moves = sum(MOVES.search(line) is not None for line in plain)
    return moves, names, sum(len(SETS.findall(line)) for line in plain)


def outcome(text: bytes, dialect: str, chain: str, before_after: Counter[str] | None = None) -> str:
    """Return "verified", or the code with which a program is refused.

    What a program that goes through held is added to `before_after`.
    """
    try:
        result = pipeline(dialect, chain).run(text)
    except gx.GcxformError as error:
        first = error.diagnostics[0]
        placed = first.where is not None and first.where.line > 0
        return first.code if placed else f"{first.code} WITHOUT A LINE"
    if before_after is not None:
        _add_up(before_after, held(text), held(result.text))
    return "verified" if result.certificate.verified else "NOT VERIFIED"


def _add_up(total: Counter[str], before: tuple[int, ...], after: tuple[int, ...]) -> None:
    """Add what a program held before and after to the sums."""
    for kind, one, other in zip(HELD, before, after, strict=True):
        total[f"{kind} before"] += one
        total[f"{kind} after"] += other
    total["programs that keep their motion"] += before[0] > 0 and after[0] > 0
    total["emptied"] += before[0] > 0 and not after[0]


def main() -> int:
    """Print the tables; return 1 if anything is not as promised."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("corpus", nargs="?", type=Path, default=BESIDE)
    parser.add_argument("--list", action="store_true", help="one line per program")
    options = parser.parse_args()
    with (options.corpus / "manifest.csv").open() as stream:
        entries = [row for row in csv.DictReader(stream) if row["role"] == "program"]
    tables: dict[str, Counter[str]] = {dialect: Counter() for dialect in OURS}
    sums: dict[str, Counter[str]] = {dialect: Counter() for dialect in OURS}
    bad = 0
    for entry in entries:
        text = (options.corpus / entry["path"]).read_bytes()
        mine = [entry["dialect"]] if entry["dialect"] in OURS else list(OURS)
        for dialect in mine:
            ours = entry["dialect"] in OURS
            found = outcome(text, dialect, CHAIN, sums[dialect] if ours else None)
            same = outcome_of_nothing(text, dialect)
            if entry["dialect"] in OURS:
                tables[dialect][found] += 1
                same = same and prints_back(text, dialect)
            bad += not same or found == "NOT VERIFIED" or "WITHOUT" in found
            if options.list or not same:
                print(f"{found:10} {'same' if same else 'CHANGED'} {dialect:9} {entry['path']}")
    print_tables(tables)
    print_sums(sums)
    emptied = sum(table["emptied"] for table in sums.values())
    return 1 if bad or emptied else 0


def outcome_of_nothing(text: bytes, dialect: str) -> bool:
    """Whether the empty pipeline gives the same bytes."""
    return pipeline(dialect, "").run(text).text == text


def print_sums(sums: dict[str, Counter[str]]) -> None:
    """Print a Markdown table of what programs that go through held, before and after."""
    rows = [f"{kind} {when}" for kind in HELD for when in ("before", "after")]
    print(f"\n| verified programs | {' | '.join(sums)} |\n|---|{'--:|' * len(sums)}")
    for row in ["programs that keep their motion", "emptied", *rows]:
        print(f"| {row} | {' | '.join(str(table[row]) for table in sums.values())} |")


def print_tables(tables: dict[str, Counter[str]]) -> None:
    """Print a Markdown table of outcomes."""
    from gcxform.catalogue import CATALOGUE

    print(f"| outcome | {' | '.join(tables)} | meaning |")
    print(f"|---|{'--:|' * len(tables)}---|")
    codes = sorted({code for table in tables.values() for code in table}, reverse=True)
    for code in codes:
        counts = " | ".join(str(table[code]) for table in tables.values())
        print(f"| {code} | {counts} | {CATALOGUE.get(code, ('',))[0]} |")
    print(f"| all | {' | '.join(str(t.total()) for t in tables.values())} | |")


if __name__ == "__main__":
    sys.exit(main())
