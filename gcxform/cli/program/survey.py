"""What the programs of a shop need of their machine: which settings, and how many programs each.

A program needs a setting that it is refused without, be it read for the passes that are named or
for any pass that keeps positions; it uses a work offset, a tool or a reference point that it names,
which passes in the coordinates of the machine need.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import field
from pathlib import Path
from typing import Final, NamedTuple

from gcxform.catalogue.questions import PIPELINE, Question
from gcxform.cli.program.machine_needs import INERT, Places, Used
from gcxform.cli.program.missing import Look, Missing, Visit
from gcxform.diagnostics import Location, UsageError
from gcxform.dialect.dialect import Dialect
from gcxform.flow.by_itself import is_subprogram
from gcxform.guess import guess_dialect
from gcxform.pipeline.pipeline import Pipeline
from gcxform.syntax.source import Source
from gcxform.values import dataclass

LEFT_SHOWN: Final = 20


@dataclass
class Tally:
    """In which programs something is found, and the place of the first."""

    programs: set[str] = field(default_factory=set)
    first: Location | None = None

    def add(self, program: str, where: Location | None) -> None:
        """Count a program."""
        self.programs.add(program)
        self.first = self.first or where

    def said(self, of: int) -> str:
        """Return it in words that follow a verb."""
        first = "" if self.first is None else f", e.g. {Path(self.first.file).name}"
        line = f":{self.first.line}" if self.first is not None and self.first.line else ""
        return f"by {len(self.programs)} of {of} program{'s' * (of > 1)}{first}{line}"


@dataclass
class Survey:
    """What a number of programs need, what they use, and what no setting helps."""

    programs: int = 0
    subprograms: int = 0
    needed: dict[Question, Tally] = field(default_factory=dict)
    used: dict[Question, Tally] = field(default_factory=dict)
    own_codes: dict[str, Tally] = field(default_factory=dict)
    refused: dict[tuple[str, str], Tally] = field(default_factory=dict)

    def add(self, source: Source, pipelines: Sequence[Pipeline], look: Look) -> None:
        """Take a program into account; a subprogram counts with those that call it."""
        if is_subprogram(source, pipelines[0].source):
            self.subprograms += 1
            return
        first = Visit(pipelines[0], source, look)
        used = first.used  # of all: they read alike
        visits = [first, *(Visit(pipeline, source, look, used) for pipeline in pipelines[1:])]
        found = [visit.run(look(visit.pipeline, source)) for visit in visits]
        self.programs += 1
        for cause in found[0].causes.values():
            if not cause.asks:
                key = cause.found[0].code, cause.found[0].message
                self.refused.setdefault(key, Tally()).add(source.name, cause.found[0].where)
        named = dict(used.questions())
        for question, where in named.items():
            self.used.setdefault(question, Tally()).add(source.name, where)
        self._codes(source.name, used.own_codes)
        for each in [visit.suppose([*named, INERT]) for visit in visits]:
            self._needs(source.name, each, used)

    def _needs(self, program: str, found: Missing, used: Used) -> None:
        """Note what a program is refused without, what is used being answered or not."""
        for cause in found.causes.values():
            if INERT in cause.asks:
                self._codes(program, used.changes)
            for question in cause.asks:
                self.needed.setdefault(question, Tally()).add(program, cause.found[0].where)

    def _codes(self, program: str, codes: Places) -> None:
        for code, where in codes.items():
            self.own_codes.setdefault(code, Tally()).add(program, where)

    # --- in words ---

    def asked(self) -> list[Question]:
        """Return all questions: those of the pipeline file, of the control, and the rest."""
        order = (PIPELINE, "control", "home", "work-offset", "tool")
        found = dict.fromkeys([*self.needed, *self.used])
        if self.own_codes:
            found[INERT] = None
        return sorted(found, key=lambda q: (order.index(q[0]), _by_number(q[1]), q[2:]))

    def notes(self) -> dict[Question, str]:
        """Return who asks, by question."""
        notes = {q: f"used {t.said(self.programs)}" for q, t in self.used.items()}
        notes |= {q: f"needed {t.said(self.programs)}" for q, t in self.needed.items()}
        codes = [f"M{c} {t.said(self.programs)}" for c, t in self.own_codes.items()]
        return notes | {INERT: f"used: {'; '.join(codes)}"}

    def left(self) -> Iterator[str]:
        """Yield what no setting helps, in words, the commonest first."""
        common = sorted(self.refused.items(), key=lambda each: -len(each[1].programs))
        for (code, message), tally in common[:LEFT_SHOWN]:
            yield f"{code} {tally.said(self.programs)}: {message}"
        if len(common) > LEFT_SHOWN:
            yield f"... and {len(common) - LEFT_SHOWN} more"


def _by_number(name: str) -> tuple[int, str]:
    return (int(name), "") if name.isdecimal() else (0, name)


class Programs(NamedTuple):
    """Programs, the dialect that fits them, and files in which no dialect fits."""

    dialect: str
    files: list[Path]
    others: list[Path]


def dialect_of(files: Iterable[Path], known: Mapping[str, type[Dialect]]) -> Programs:
    """Return in which dialect files are best read together. Raises UsageError for several.

    Where one alone is known it is that one: files in which nothing fits are read if no other is,
    since their findings say more than that they do not fit.
    """
    scores: Counter[str] = Counter()
    programs: list[Path] = []
    others: list[Path] = []
    for path in files:
        guess = guess_dialect(path, known)
        (programs if guess.dialects else others).append(path)
        for name in guess.evidence if guess.dialects else ():
            scores[name] += guess.score(name)  # type: ignore[assignment]
    if len(known) == 1:
        (said,) = known
        return Programs(said, programs or others, others if programs else [])
    best = [name for name in scores if scores[name] == max(scores.values())]
    if len(best) != 1:
        several = f"{' or '.join(sorted(best))} fit as well" if best else "none fits"
        message = f"which dialect are the programs in? {several}"
        raise UsageError.one("GX722", message, hint="-f DIALECT; `gcxform list dialects`")
    return Programs(best[0], programs, others)
