"""What came of many random programs, as it is counted and printed."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import Protocol

WRONG = ("disagrees", "refused without need", "exit 4", "exit 70")


class Judged(Protocol):
    """A program and what came of it: `kind` is how it ended, `code` why it was refused."""

    seed: int
    chain: object
    kind: str
    code: str
    said: str


@dataclass
class Figures:
    """What came of many programs; `wrong` are those that must not be."""

    counts: Counter[str] = field(default_factory=Counter)
    refused: Counter[str] = field(default_factory=Counter)
    wrong: list[Judged] = field(default_factory=list)

    def count(self, job: Judged) -> None:
        self.counts["programs"] += 1
        self.counts[job.kind] += 1
        if job.kind == "refused":
            self.refused[job.code] += 1
        if job.kind in WRONG:
            self.wrong.append(job)

    def __iadd__(self, other: Figures) -> Figures:
        self.counts += other.counts
        self.refused += other.refused
        self.wrong += other.wrong
        return self

    def __str__(self) -> str:
        lines = [f"{self.counts[what]:7} {what}" for what in WRONG]
        rest = [pair for pair in self.counts.most_common() if pair[0] not in WRONG]
        lines += [f"{count:7} {what}" for what, count in rest]
        lines += [f"{count:7} refused {code}" for code, count in self.refused.most_common()]
        return "\n".join(lines)
