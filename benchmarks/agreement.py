"""Read every real program that LinuxCNC has read, and print where the two agree.

    python benchmarks/agreement.py [CORPUS] [--list]

CORPUS is a folder with `manifest.csv`, `programs/`, and in `rs274/` what LinuxCNC's stand-alone
interpreter printed for each; by default the one beside the checkout. Programs of other dialects
are read as LinuxCNC's where LinuxCNC could. Moves, arcs, feeds, dwells, spindle, coolant, tools and
their order are compared as exactly as the print allows: half of its last decimal, which is 0.05 um
in mm and 1.3 um in inches. A program may be refused, but never be read as something else: any
disagreement makes this fail.
"""

from __future__ import annotations

import argparse
import csv
import gzip
import sys
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "tests"))

from oracles.canon import parsed  # noqa: E402
from oracles.toolpaths import difference, read  # noqa: E402

import gcxform as gx  # noqa: E402
from gcxform.dialect.dialect import INCH  # noqa: E402
from gcxform.machine.machine import Tool  # noqa: E402
from gcxform.toolpath.path import Form  # noqa: E402

TABLE = {number: Tool(radius=0.05 * INCH) for number in range(1, 60)}
"""The tools of `rs274/tool.tbl`."""
BESIDE = HERE.parents[1] / "shared" / "corpus"
AGREE, REFUSED, BOTH = "agree", "refused by gcxform", "refused by both"
ALONE, DISAGREE, HANG = "refused by rs274 alone", "DISAGREE", "rs274 did not end"
THREADS = "threads and lathe cycles in passes, which are not in our path"
LATHE = ("G70", "G71", "G72")


@dataclass(frozen=True)
class Outcome:
    """What became of one program; `why` is the reason of whoever refuses, or what differs."""

    name: str
    kind: str
    code: str = ""
    why: str = ""


def with_mode(text: bytes, mode: str) -> bytes:
    """Return a program with the lines that were added when LinuxCNC read it."""
    parts = mode.split("+")
    if "F1000" in parts:
        text = b"F1000\n" + text
    return text + b"\nM2\n" if "M2" in parts else text


def outcome(corpus: Path, row: dict[str, str]) -> Outcome:
    """Read one program and compare it with what LinuxCNC said of it."""
    name = row["path"].removeprefix("programs/")
    text = with_mode((corpus / row["path"]).read_bytes(), row["mode"])
    said = row["message_and_offending_line"].strip()
    if row["exit"] == "-9":
        return Outcome(name, HANG)
    try:
        path = read(text, TABLE) if row["mode"].startswith("tbl") else read(text)
    except gx.InputError as error:
        first = error.diagnostics[0]
        line = first.where.line if first.where else 0
        kind = BOTH if row["exit"] != "0" else REFUSED
        return Outcome(name, kind, first.code, f"line {line}: {first.message}")
    if row["exit"] != "0":
        return Outcome(name, ALONE, "", said)
    lathe = any(event.what.startswith(LATHE) for event in path.events)
    if lathe or (path.form == Form.PASSES).any():
        return Outcome(name, THREADS)
    canon = gzip.decompress((corpus / row["canon_file"]).read_bytes()).decode("latin-1")
    problem = difference(path, parsed(canon))
    return Outcome(name, DISAGREE if problem else AGREE, "", problem)


def outcomes(corpus: Path, part: slice = slice(None)) -> list[Outcome]:
    """Return what became of every program that LinuxCNC was given, or of a part of them."""
    with (corpus / "rs274_results.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    with (corpus / "manifest.csv").open(newline="") as stream:
        programs = {r["path"] for r in csv.DictReader(stream) if r["role"] == "program"}
    return [outcome(corpus, row) for row in rows[part] if row["path"] in programs]


def print_tables(found: list[Outcome], every: bool) -> None:
    """Print the programs that do not agree, or all, and the totals."""
    for one in found:
        if every or one.kind in (ALONE, DISAGREE):
            print(f"{one.kind}: {one.name} {one.code} {one.why}")
    print("\n| outcome | programs |\n|---|--:|")
    totals = Counter(one.kind for one in found)
    for kind in (AGREE, REFUSED, BOTH, ALONE, HANG, THREADS, DISAGREE):
        print(f"| {kind} | {totals[kind]} |")
    print("\n| read by rs274, refused by gcxform because | programs |\n|---|--:|")
    reasons = Counter((o.code, o.why.partition(": ")[2]) for o in found if o.kind == REFUSED)
    for (code, why), count in reasons.most_common():
        print(f"| {code} {why} | {count} |")


def main() -> int:
    """Print the tables; return 1 if anything is read otherwise than by LinuxCNC."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("corpus", nargs="?", type=Path, default=BESIDE)
    parser.add_argument("--list", action="store_true", help="one line per program")
    options = parser.parse_args()
    found = outcomes(options.corpus)
    print_tables(found, options.list)
    return 1 if any(one.kind == DISAGREE for one in found) else 0


if __name__ == "__main__":
    sys.exit(main())
