"""All that a program does not say, found in one visit: what is asked is answered, and asked on.

A finding whose hint names a setting (`gcxform.catalogue.questions`) is answered with a value on
trial, and the program is looked at again as if it had been given; a block that no setting helps is
left out. So what stands behind a finding is found too. What is found so is a question, and no
result: nothing is written, and no value on trial leaves this module but as "?".
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import field, replace
from pathlib import Path
from typing import Any, Final

import msgspec

from gcxform.catalogue.questions import OF_THE_STATE, PIPELINE, Question, kind_of, questions
from gcxform.cli.program.machine_needs import ANY, INERT, LENGTH_ALONE, Used, used_by
from gcxform.diagnostics import Diagnostic, Severity
from gcxform.machine.control import (
    COMP_CORNERS,
    COMP_ENTRY,
    inert_of,
    offset_in_blocks,
    settings_of,
)
from gcxform.machine.machine import Machine, Tool
from gcxform.pipeline.pipeline import Pipeline
from gcxform.syntax.source import Source
from gcxform.values import dataclass

STATELESS: Final = frozenset({"GX101", "GX201", "GX202", "GX205", "GX206", "GX210", "GX211"})
"""Findings about a block by itself, which hold whatever stood before it."""
ROUNDS: Final = 30
ON_TRIAL: Final[Mapping[Question, Any]] = {
    ("tool", "radius"): 0.001,
    ("input", "parameters"): 1.0,
    ("control", "macro"): "unchanged",
    ("control", COMP_CORNERS): "arc",
    ("control", COMP_ENTRY): "own",
    LENGTH_ALONE: "shifts",
}
"""Values on trial where 0 would not be one: mm, less than contours are wide; 0 has no unit."""
LOST: Final = frozenset({"GX207", "GX208", "GX311", "GX314", "GX506"})
"""Findings about a position that is not known; where the start does not help, it was lost."""
ENDLESS: Final = frozenset({"GX224"})
"""A loop without an end: left out, it would make the loop around it run to the limit of steps."""
WHERE_LOST: Final[tuple[Question, ...]] = (
    ("tool", ANY, "length"),
    ("home", ANY, "X"),
    ("work-offset", ANY, "X"),
    ("control", "macro", ANY, "ends"),
    LENGTH_ALONE,
    INERT,
)

Look = Callable[[Pipeline, Source], list[Diagnostic]]
Given = dict[Question, Any]


@dataclass
class Cause:
    """One reason for findings, and what it asks for.

    `behind` says what was taken for known when it was found, in words.
    """

    found: list[Diagnostic] = field(default_factory=list)
    asks: set[Question] = field(default_factory=set)
    behind: str = ""

    def told(self) -> Diagnostic:
        """Return the first finding, with the other lines."""
        first, *others = self.found
        lines = {each.where.line: each.where for each in others if each.where is not None}
        if first.where is not None:
            lines.pop(first.where.line, None)
        message = first.message + (f" (if {self.behind})" if self.behind else "")
        return replace(first, message=message, also=tuple(lines[n] for n in sorted(lines)))


@dataclass
class Missing:
    """What one visit has shown: causes, and the values on trial by question."""

    causes: dict[object, Cause] = field(default_factory=dict)
    given: Given = field(default_factory=dict)
    left_out: set[int] = field(default_factory=set)

    def asked(self) -> list[Question]:
        """Return the questions that are open, in the order in which they were asked."""
        asks: set[Question] = set().union(*(cause.asks for cause in self.causes.values()))
        return [question for question in self.given if question in asks]

    def notes(self) -> dict[Question, str]:
        """Return who asks, by question."""
        found: dict[Question, str] = {}
        for cause in self.causes.values():
            lines = sorted({each.where.line for each in cause.found if each.where is not None})
            if lines and lines[0]:
                more = f" and {len(lines) - 1} more" if len(lines) > 1 else ""
                found |= dict.fromkeys(cause.asks, f"asked by line {lines[0]}{more}")
        if codes := self.given.get(INERT):
            named = ", ".join(f"M{each}" for each in codes)
            found[INERT] = f"{found.get(INERT, '')} ({named})".strip()
        return found

    def told(self) -> list[Diagnostic]:
        """Return the findings, one for each cause."""
        return [cause.told() for cause in self.causes.values()]


class Visit:
    """One visit to a program: what is missing, and what is looked at next."""

    def __init__(
        self, pipeline: Pipeline, source: Source, look: Look, used: Used | None = None
    ) -> None:
        self.pipeline, self.source, self.look = pipeline, source, look
        self.used = used or used_by(source, pipeline.source, pipeline.machine_reading)
        if pipeline.machine is not None:
            self.used.keep_axes(pipeline.machine.axes)
        self.so_far = Missing()

    def run(self, seen: Iterable[Diagnostic]) -> Missing:
        """Return why the program is refused, all of it; `seen` speaks against it already."""
        errors = _errors(seen)
        for _ in range(ROUNDS):
            more = self._note(errors)
            if not more and not self._helps_where_lost(errors):
                break
            errors = self._again(self.so_far.given)
        return self.so_far

    def suppose(self, answered: Iterable[Question]) -> Missing:
        """Return what is asked beside, if some questions are answered that nothing has asked."""
        trials = dict(self._trial(q) for q in answered if q not in self.so_far.given)
        if not trials:
            return self.so_far
        self.so_far.given |= trials
        self.so_far.left_out.clear()  # what stands in such lines may be asked for now
        return self.run(self._again(self.so_far.given))

    def _trial(self, question: Question) -> tuple[Question, Any]:
        """Return a question with its value on trial."""
        codes = {INERT: self.used.codes}
        return question, codes.get(question, ON_TRIAL.get(kind_of(question), 0.0))

    def _again(self, given: Given) -> list[Diagnostic]:
        program = _without(self.source, self.so_far.left_out)
        return _errors(self.look(supplied(self.pipeline, given), program))

    # --- what is seen ---

    def _note(self, seen: Iterable[Diagnostic]) -> bool:
        """Note what was seen; return whether there is more to look for."""
        found = self.so_far
        behind, left_out = _taken(found), set(found.left_out)
        new: dict[Question, list[Any]] = {}
        for each in seen:
            asks = self._asks(each, behind=bool(left_out))
            if asks:
                self._add(frozenset(map(_subject, asks)), each, "").asks |= asks.keys()
                for question, values in asks.items():
                    known = new.setdefault(question, [])
                    known += [value for value in values if value not in known]
                continue
            self._take_back(each)
            if left_out and each.code not in STATELESS:
                continue
            self._add((each.code, each.message), each, behind)
            stays = each.code in LOST | ENDLESS
            if not stays and each.where and each.where.file == self.source.name:
                found.left_out |= {each.where.line} - {0}
        self._answer(new)
        return bool(new) or found.left_out != left_out

    def _asks(self, each: Diagnostic, behind: bool) -> dict[Question, list[Any]]:
        """Return what a finding asks for that nothing is given for, with the values it names."""
        asked: dict[Question, list[Any]] = {}
        for question, value in questions(each.hint):
            names_codes = question == INERT and value
            for one in (question,) if names_codes else self.used.named(question):
                if self._is_new(one, value) and not (behind and _of_the_state(one)):
                    asked.setdefault(one, []).append(ON_TRIAL.get(kind_of(one), value))
        return asked

    def _is_new(self, question: Question, value: Any) -> bool:
        """Whether nothing is given for a question, or a list in which something is missing."""
        given = self.so_far.given.get(question)
        return given is None or (isinstance(value, list) and not {*value} <= {*given})

    def _add(self, key: object, each: Diagnostic, behind: str) -> Cause:
        cause = self.so_far.causes.setdefault(key, Cause(behind=behind))
        cause.found.append(each)
        return cause

    def _take_back(self, each: Diagnostic) -> None:
        """Drop a finding from the causes that what is on trial now should have ended."""
        causes = self.so_far.causes
        for key, cause in list(causes.items()):
            if cause.asks:
                same = each.code, each.where, each.message
                cause.found = [f for f in cause.found if (f.code, f.where, f.message) != same]
                if not cause.found:
                    del causes[key]

    # --- what is answered ---

    def _answer(self, new: Mapping[Question, list[Any]]) -> None:
        """Put values on trial; of several, the one with which least is found, of lists all."""
        given = self.so_far.given
        lists = {q: values for q, values in new.items() if isinstance(values[0], list)}
        for question, values in lists.items():
            given[question] = sorted({*given.get(question, ())}.union(*values))
        given |= {q: values[0] for q, values in new.items() if q not in lists}
        for question, values in new.items():
            if len(values) > 1 and question not in lists:
                counts = {k: len(self._again({**given, question: v})) for k, v in enumerate(values)}
                given[question] = values[min(counts, key=lambda k: counts[k])]

    def _helps_where_lost(self, errors: list[Diagnostic]) -> bool:
        """Whether a position that a block has lost is known if the machine file says more.

        All that may help is tried at once, and what helps no less without it is left out again.
        """
        lost = [each for each in errors if each.code in LOST]
        more = {whole: new for whole in WHERE_LOST if (new := self._trials(whole))} if lost else {}
        if not (more and (ended := self._ended(lost, more))):
            return False
        for whole in reversed(list(more)):
            fewer = {other: new for other, new in more.items() if other != whole}
            if self._ended(ended, fewer) == ended:
                more = fewer
        for each in ended:
            self.so_far.causes.pop((each.code, each.message), None)
            self._add(tuple(more), each, "").asks.update(*more.values())
        for new in more.values():
            self.so_far.given |= new
        return True

    def _trials(self, whole: Question) -> Given:
        """Return values on trial for all that a question stands for, and nothing is given for."""
        new = (q for q in self.used.named(whole) if q not in self.so_far.given)
        return dict(map(self._trial, new))

    def _ended(self, lost: list[Diagnostic], more: Mapping[Question, Given]) -> list[Diagnostic]:
        """Return the findings that are gone if more is said."""
        given = {question: value for new in more.values() for question, value in new.items()}
        left = self._again({**self.so_far.given, **given})
        return [each for each in lost if each not in left]


def _errors(seen: Iterable[Diagnostic]) -> list[Diagnostic]:
    return [each for each in seen if each.severity is Severity.ERROR]


def _of_the_state(question: Question) -> bool:
    """Whether a question may be asked only because a block before it was left out."""
    return question[0] == PIPELINE and question[1] in OF_THE_STATE


def _subject(question: Question) -> Question:
    """Return what makes findings one: axes that stand nowhere known are one cause."""
    return question[:2] if question[0] in (PIPELINE, "work-offset", "home") else question


def _taken(found: Missing) -> str:
    """Return what is said of the program on trial, in words."""
    said = {q[1]: value for q, value in found.given.items() if q[0] == PIPELINE}
    words = [
        f'{key} = "{v}"' if isinstance(v, str) else f"{key} = {v:g}" for key, v in said.items()
    ]
    return " and ".join(words)


# --- values on trial ---


def supplied(pipeline: Pipeline, given: Mapping[Question, Any]) -> Pipeline:
    """Return a pipeline to which more is said: values by question, as files have them."""
    if not given:
        return pipeline
    of_machine = {q: v for q, v in given.items() if q[0] != PIPELINE}
    machine = pipeline.machine or Machine(file=Path("machine.toml"))
    return replace(
        pipeline,
        reading=replace(pipeline.reading, **dict(_said(pipeline, given))),
        machine=_machine(machine, of_machine) if of_machine else pipeline.machine,
    )


def _said(pipeline: Pipeline, given: Mapping[Question, Any]) -> Iterator[tuple[str, Any]]:
    """Yield what is said in `[input]`, by the fields of a `Reading`."""
    tables: dict[str, dict[str, Any]] = {}
    for (table, key, *name), value in given.items():
        if table == PIPELINE and name:
            tables.setdefault(key, {})[name[0]] = value
        elif table == PIPELINE:
            yield key.replace("-", "_"), value
    for key, values in tables.items():
        yield key, {**getattr(pipeline.reading, key), **values}


def _machine(machine: Machine, given: Mapping[Question, Any]) -> Machine:
    """Return a machine of which more is said."""
    control: dict[str, Any] = {}
    for (table, name, *key), value in given.items():
        if table == "control" and key:
            control.setdefault(name, {})[key[0]] = {key[1]: value}
        elif table == "control":
            control[name] = value
    tools = dict(machine.tools)
    places = {"work-offset": dict(machine.work_offsets), "home": dict(machine.homes)}
    for (table, name, *key), value in given.items():
        if table == "tool":
            known = tools.get(int(name), Tool())
            tools[int(name)] = msgspec.structs.replace(known, **{key[0]: value})
        elif table in places:
            name = offset_in_blocks(name)
            places[table][name] = {**places[table].get(name, {}), key[0]: value}
    changed: Machine = msgspec.structs.replace(
        machine,
        tools=tools,
        work_offsets=places["work-offset"],
        homes=places["home"],
        control={**machine.control, **settings_of(control)},
        inert_m=machine.inert_m | inert_of(control),
    )
    return changed


def _without(source: Source, lines: set[int]) -> Source:
    """Return a program in which some lines, from 1, are blank."""
    if not lines:
        return source
    kept = []
    for number, line in enumerate(b"".join(source.windows()).splitlines(keepends=True), 1):
        text = line.rstrip(b"\r\n")
        kept.append(b" " * len(text) + line[len(text) :] if number in lines else line)
    blanked = Source.of_bytes(b"".join(kept), source.name)
    blanked.folder, blanked.suffix = source.folder, source.suffix
    return blanked
