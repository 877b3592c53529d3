"""The machine and pipeline files of `corpus.py`, as a user of the machine comes by them.

`gcxform machine new` writes what the programs need, for each chain; what a user of the machine
knows (`corpus_machines/known.toml`) takes the place of `"?"`; and both are done again until nothing
is asked any more. What is known and was never asked for is told: a user would not have said it.
"""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

from gcxform.cli.program.new_machine import Places, Wanted, write_new

HERE = Path(__file__).resolve().parent
KNOWN = HERE / "corpus_machines" / "known.toml"
OPEN = '"?"'
ROUNDS = 4
INLINE = re.compile(rf"(\w+) = {re.escape(OPEN)}")
PLAIN = re.compile(rf"^([\w-]+) = {re.escape(OPEN)}")


def known_of(name: str) -> dict[str, Any] | None:
    """Return what the user of a machine knows, by patterns of keys; None if nothing says it."""
    found: dict[str, Any] | None = tomllib.loads(KNOWN.read_text("utf-8")).get(name)
    return found


def written(
    dialect: str,
    programs: Sequence[Path],
    chains: Iterable[str | None],
    pipeline: Path,
    known: Mapping[str, Any],
) -> list[str]:
    """Write a pipeline file and the machine file beside it; return what was not asked for."""
    machine = pipeline.with_name(f"{pipeline.stem}-machine.toml")
    for file in (machine, pipeline):
        file.unlink(missing_ok=True)
    asked: set[str] = set()
    for _ in range(ROUNDS):
        before = [file.read_bytes() for file in (machine, pipeline) if file.exists()]
        for chain in chains:
            write_new(
                [str(each) for each in programs],
                dialect,
                Wanted(chain, None),
                Places(str(machine), str(pipeline)),
            )
            for file in (machine, pipeline):
                text, found = filled(file.read_text("utf-8"), known)
                file.write_text(text, "utf-8")
                asked |= found
        if before == [machine.read_bytes(), pipeline.read_bytes()]:
            break
    return [pattern for pattern in known if pattern not in asked]


def filled(text: str, known: Mapping[str, Any]) -> tuple[str, set[str]]:
    """Return the text of a file with what is known for "?", and the patterns that were asked."""
    lines, table, asked = [], "", set[str]()
    for line in text.split("\n"):
        if line.startswith("["):
            table = ".".join(_names(tomllib.loads(line)))
        if OPEN in line and not line.startswith("#"):
            key = line.partition(" =")[0]
            inner = INLINE if "{" in line else PLAIN
            for name in [found[1] for found in inner.finditer(line)]:
                path = f"{table}.{key}" + (f".{name}" if "{" in line else "")
                pattern = next((each for each in known if fnmatchcase(path, each)), None)
                if pattern is not None:
                    asked.add(pattern)
                    said = json.dumps(known[pattern])
                    line = line.replace(f"{name} = {OPEN}", f"{name} = {said}", 1)
        lines.append(line)
    return "\n".join(lines), asked


def _names(table: Mapping[str, Any]) -> Iterator[str]:
    """Yield the names of tables, one inside the other."""
    while isinstance(table, dict) and table:
        name, table = next(iter(table.items()))
        yield name
