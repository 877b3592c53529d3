"""The certificate and the source map that lie beside a program that was written.

They are known by the hash of the output in them, so that their names do not matter but for the
beginning, which is that of the program.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final, Self

import numpy as np

from gcxform.system import inputs
from gcxform.system.arrays import Ints
from gcxform.values import dataclass

MANY: Final = 200  # files of a folder that are looked at
RUN: Final = 4  # numbers of a run of a source map
MOST_LINES: Final = 1 << 27


@dataclass(frozen=True)
class Beside:
    """What was found: the certificate, and the source line, from 0, of each line of the output."""

    certificate: dict[str, Any] | None = None
    origin: Ints | None = None
    notes: tuple[str, ...] = ()

    @classmethod
    def of(cls, file: str, source: str, output: str) -> Self:
        """Return what belongs to a file that was written; the others are hashes of both texts."""
        certificate, origin, notes = None, None, []
        for beside, said in _documents(Path(file)):
            theirs = [said[side].get("sha256") for side in ("source", "output")]
            if theirs != [source, output]:
                notes.append(f"{beside.name} is about other programs, and is left out.")
            elif "lines" in said:
                origin = _expanded(said["lines"])
            else:
                certificate = said
        return cls(certificate, origin, tuple(notes))


def _documents(output: Path) -> Iterator[tuple[Path, dict[str, Any]]]:
    """Yield certificates and source maps whose names begin as that of the output."""
    if not output.is_file():
        return
    for file in sorted(output.parent.glob("*.json"))[:MANY]:
        if not file.name.startswith(output.stem):
            continue
        try:
            said = json.loads(inputs.read(file))
        except (OSError, ValueError, RecursionError):
            continue
        sides = [said.get(side) for side in ("source", "output")] if isinstance(said, dict) else []
        if sides and all(isinstance(side, dict) for side in sides):
            yield file, said


def _expanded(runs: Any) -> Ints | None:
    """Return the source line, from 0, of each line of the output; None where it is no map."""
    try:
        table = np.array(runs, np.int64).reshape(-1, RUN)
    except (TypeError, ValueError, OverflowError):
        return None
    _, first, count, step = table.T
    total = int(count.sum())
    if (count < 1).any() or total > MOST_LINES:
        return None
    within = np.arange(total) - np.repeat(np.cumsum(count) - count, count)
    return np.asarray(np.repeat(first, count) + within * np.repeat(step, count) - 1)
