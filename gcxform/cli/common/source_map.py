"""The source map: for every line of the output the line of the program it came from, as JSON.

    {"format": 1, "source": {...}, "output": {...}, "lines": [[1, 1, 40, 1], [41, 40, 6, 0], ...]}

`lines` holds runs: first output line, first source line, how many output lines, and by how much the
source line grows from one to the next. Lines count from 1; those of a file that the program calls
are counted on behind its own, from the `first` of the file in `source`. A program of which little
is changed has few runs, and a split block is one.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any, Final, Self

import numpy as np

from gcxform.pipeline.certificate import Certificate

FORMAT: Final = 1
Run = list[int]


class SourceMap(list[int]):
    """Takes source lines, from 0, in the order of the output, and keeps nothing but runs."""

    def __init__(self) -> None:
        super().__init__()
        self.runs: list[Run] = []
        self.total = 0

    def __iadd__(self, lines: Iterable[int], /) -> Self:  # type: ignore[override,misc]
        values = np.fromiter(lines, np.int64)
        for first, length in _even_parts(values):
            step = int(values[first + 1] - values[first]) if length > 1 else 1
            self._add([self.total + first + 1, int(values[first]) + 1, length, step])
        self.total += len(values)
        return self

    def _add(self, run: Run) -> None:
        """Add a run, or continue the last one with it."""
        if self.runs:
            _, source, count, step = last = self.runs[-1]
            fits = step if count > 1 else run[1] - source
            if run[1] == source + count * fits and (run[2] == 1 or run[3] == fits):
                last[2:] = [count + run[2], fits]
                return
        self.runs.append(run)

    def to_json(self, certificate: Certificate, output: str) -> str:
        """Return the map as JSON, with the hashes of the two programs it belongs to."""
        document: dict[str, Any] = {
            "format": FORMAT,
            "source": certificate.source,
            "output": {"name": output, **certificate.output},
            "lines": self.runs,
        }
        return json.dumps(document, separators=(",", ":")) + "\n"


def _even_parts(values: np.ndarray[Any, np.dtype[np.int64]]) -> Iterable[tuple[int, int]]:
    """Yield start and length of the longest parts, one after the other, that grow evenly."""
    grows = np.diff(values)
    changes = np.flatnonzero(grows[1:] != grows[:-1]) + 1
    at = 0
    for change in [*changes.tolist(), len(values) - 1]:
        if change >= at:
            length = change - at + 1 if change > at or change == len(values) - 1 else 1
            yield at, length
            at += length
