"""Write down what becomes of real programs, to compare two commits byte for byte.

    python benchmarks/outputs.py OUT [CORPUS] [--jobs N]

Every program of the corpus, in each of our dialects, through each chain: a line with the digest of
the output, or with what the refusal says and where. Run it at both commits and `diff` the files.
"""

from __future__ import annotations

import argparse
import csv
import hashlib
import os
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

import gcxform as gx
from corpus import BESIDE, CHAIN, OURS, WHOLE_LANGUAGES, pipeline

CHAINS = {
    "absolute": "absolute",
    "compensated": CHAIN,
    "plain": "cycles | offsets | absolute | arcs tolerance=5um | metric",
    "numbered": "feed scale=0.5 | renumber",
}


def outcome(text: bytes, dialect: str, chain: str) -> str:
    """Return a digest of the output, or what the refusal says."""
    try:
        result = pipeline(dialect, CHAINS[chain]).run(text)
    except gx.GcxformError as error:
        return " / ".join(f"{d.code} {_line(d)} {d.message}" for d in error.diagnostics)
    return hashlib.sha256(result.text).hexdigest()


def _line(found: gx.Diagnostic) -> str:
    return str(found.where.line) if found.where is not None else "-"


def outcomes(corpus: Path, path: str) -> list[str]:
    """Return the lines about one program."""
    text = (corpus / path).read_bytes()
    words = [dialect for dialect in OURS if dialect not in WHOLE_LANGUAGES]
    return [f"{path} {d} {c}: {outcome(text, d, c)}\n" for d in words for c in CHAINS]


def main() -> None:
    """Write the file."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path)
    parser.add_argument("corpus", nargs="?", type=Path, default=BESIDE)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    options = parser.parse_args()
    with (options.corpus / "manifest.csv").open() as stream:
        paths = [row["path"] for row in csv.DictReader(stream) if row["role"] == "program"]
    with ProcessPoolExecutor(options.jobs) as pool:
        found = pool.map(partial(outcomes, options.corpus), paths)
        options.out.write_text("".join(line for lines in found for line in lines), "utf-8")


if __name__ == "__main__":
    main()
