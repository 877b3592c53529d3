"""What became of a task: a row of the table of results."""

from __future__ import annotations

import json
from dataclasses import asdict, fields
from typing import Any, Final, Self

from gcxform.cli.plant.rests import Rests
from gcxform.values import dataclass

THROUGH: Final = ("written", "unchanged")
STATES: Final = (*THROUGH, "refused", "failed")
"""Results were written, with other bytes or the same; refused for a reason in the files; failed."""


@dataclass(frozen=True)
class Row:
    """A result: which program, by what, what it rests on, and what its certificate says.

    Lengths are mm, hashes SHA-256. `codes` are those of the findings that refused it, `reason` the
    first line of the first; `place` its file, line and column. `rests` is what the result rests on
    (`Rests`), `certificate` the whole certificate; both are JSON.
    """

    program: str
    pipeline: str
    machine: str
    state: str
    exit_code: int = 0
    codes: str = ""
    place: str = ""
    reason: str = ""
    output: str = ""
    source_sha256: str = ""
    pipeline_sha256: str = ""
    machine_sha256: str = ""
    output_sha256: str = ""
    deviation: float | None = None
    budget: float | None = None
    source_line: int | None = None
    output_line: int | None = None
    blocks_in: int | None = None
    blocks_out: int | None = None
    verified: bool = False
    seconds: float = 0.0
    version: str = ""
    options: str = ""
    rests: str = "{}"
    certificate: str = ""

    @property
    def through(self) -> bool:
        """Whether a result was written."""
        return self.state in THROUGH

    @property
    def stands_on(self) -> Rests:
        """What it rests on."""
        return Rests(**json.loads(self.rests))

    def to_json(self) -> str:
        """Return it as text."""
        return json.dumps(asdict(self))

    @classmethod
    def from_json(cls, text: str | bytes) -> Self:
        """Return what `to_json` has written. Raises ValueError for what it has not."""
        said: Any = json.loads(text)
        if not isinstance(said, dict) or set(said) - set(COLUMNS):
            raise ValueError("no row")
        try:
            return cls(**said)
        except TypeError as error:
            raise ValueError(str(error)) from None


COLUMNS: Final = tuple(each.name for each in fields(Row))
LONG: Final = ("rests", "certificate")
"""Columns that tables for people leave out."""
