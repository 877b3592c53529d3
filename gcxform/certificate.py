"""The certificate: what was done to a program, what was checked, and what was not."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field
from typing import Any

FORMAT = 1


@dataclass(slots=True)
class Certificate:
    """The proof of one run, as plain values: `to_json` writes it.

    Lengths are mm, hashes SHA-256. `largest` holds the deviation and its source and output line,
    `growth` the blocks read and written, their ratio (None where nothing was read) and its limit,
    `measured` what passes tell of their own work, the largest over the program, and `added` what
    the output has and the source does not, in all.
    """

    version: str
    source: dict[str, Any]
    output: dict[str, Any]
    steps: list[dict[str, Any]]
    budget: dict[str, Any]
    growth: dict[str, Any]
    verified: bool
    largest: dict[str, Any] = field(default_factory=dict)
    checked: dict[str, int] = field(default_factory=dict)
    measured: dict[str, float] = field(default_factory=dict)
    added: dict[str, int] = field(default_factory=dict)
    not_checked: list[str] = field(default_factory=list)
    assumed: list[str] = field(default_factory=list)

    def to_json(self) -> str:
        """Return the certificate as JSON text."""
        return json.dumps({"format": FORMAT, **asdict(self)}, indent=2) + "\n"
