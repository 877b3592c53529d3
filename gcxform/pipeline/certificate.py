"""The certificate: what was done to a program, what was checked, and what was not."""

from __future__ import annotations

import json
from dataclasses import asdict, field
from typing import Any

from gcxform.diagnostics import Diagnostic
from gcxform.values import dataclass

FORMAT = 1


@dataclass(slots=True)
class Certificate:
    """The proof of one run, as plain values: `to_json` writes it.

    Lengths are mm, hashes SHA-256. `largest` holds the deviation and its source and output line,
    `growth` the blocks read and written, their ratio (None where nothing was read) and its limit,
    `stamps` the stamps of the two programs, what was done to the source after it was stamped, and
    the line of its first stamp (0: none),
    `measured` what passes tell of their own work, the largest over the program, and `added` what
    the output has and the source does not, in all. `inventory` is what source and output hold, by
    kind, and the rules that account for the difference, each with how many it adds or takes away.
    `written_out` says which calls and loops were written out, though others might stay, and why.
    `kept_calls` counts calls of programs that are not at hand, by what they call.
    `assumed` is what was taken for granted, in sentences, and `warnings` what of it may surprise;
    these are shown, and not written.
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
    inventory: dict[str, Any] = field(default_factory=dict)
    stamps: dict[str, Any] = field(default_factory=dict)
    written_out: list[str] = field(default_factory=list)
    kept_calls: dict[str, int] = field(default_factory=dict)
    not_checked: list[str] = field(default_factory=list)
    assumed: list[str] = field(default_factory=list)
    warnings: list[Diagnostic] = field(default_factory=list)

    def described(self) -> dict[str, Any]:
        """Return the certificate as plain values, as it is written."""
        said = {name: value for name, value in asdict(self).items() if name != "warnings"}
        return {"format": FORMAT, **said}

    def _repr_html_(self) -> str:
        """Return what a notebook shows: whether it is proved, within what, and what was assumed."""
        off = self.largest.get("deviation")
        rows: list[tuple[str, object]] = [
            ("verified", "yes" if self.verified else "no"),
            ("passes", " | ".join(str(step.get("use", "")) for step in self.steps) or "none"),
            ("moves compared", self.checked.get("moves", 0)),
        ]
        if off is not None:
            rows.append(("largest deviation", f"{off * 1000.0:.4g} um"))
        rows += [("assumed", each) for each in self.assumed]
        from gcxform.notebook import shown

        return shown("certificate", rows)

    def to_json(self) -> str:
        """Return the certificate as JSON text."""
        return json.dumps(self.described(), indent=2) + "\n"
