"""Edits: what hints offer to do, and what text passes make of a program."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Sequence
from dataclasses import fields, is_dataclass, replace
from pathlib import Path
from typing import Any, Final, NamedTuple

from gcxform.catalogue import remedies as offers
from gcxform.catalogue.remedies import MACHINE, StepBefore, ways
from gcxform.catalogue.settings import Setting
from gcxform.cli.editing.program import Program
from gcxform.cli.editing.shop import Found
from gcxform.cli.editing.text import Edit, Place, Span, Text
from gcxform.config.to_fill_in import TO_FILL_IN
from gcxform.contract.passes import TextPass
from gcxform.diagnostics import Diagnostic, UsageError

OPEN: Final = re.compile(r"\.\.\.|\b[a-z]\b")
"""What stands for a number in the value of a setting that a hint offers."""
RENUMBER: Final = "renumber"


class Action(NamedTuple):
    """Something that a hint offers: its words, the diagnostic, and edits by file."""

    title: str
    of: Diagnostic
    edits: dict[str, list[Edit]]


# --- what hints offer ---


def actions(program: Program, diagnostics: Sequence[Diagnostic]) -> list[Action]:
    """Return what can be done about findings, each way out by itself."""
    found = []
    for each in diagnostics:
        for way in ways(each.hint):
            edits = _way(program, each, way)
            if edits:
                found.append(Action("; ".join(map(_title, way)), each, edits))
    return found


def _title(offer: offers.Offer) -> str:
    if isinstance(offer, Setting):
        return f"{offer.key} = {_value(offer)}" + (
            f" in [{offer.section}]" if offer.section else ""
        )
    if isinstance(offer, StepBefore):
        before = f" before {offer.step}" if offer.step else ""
        return f"put the pass {offer.name}{before}"
    return f"write {offer.text}" if offer.how == "replace" else "leave the block out"


def _way(
    program: Program, found: Diagnostic, way: Sequence[offers.Offer]
) -> dict[str, list[Edit]] | None:
    """Return the edits of a way out, None if one of its offers cannot be carried out here."""
    edits: dict[str, list[Edit]] = {}
    for offer in way:
        if isinstance(offer, offers.Edit):
            path, edit = program.path, _edit(program.text, found, offer)
        else:
            path, edit = _in_file(program.found, offer)
        if edit is None:
            return None
        edits.setdefault(path, []).append(edit)
    return edits


def _edit(text: Text, found: Diagnostic, offer: offers.Edit) -> Edit | None:
    where = found.where
    if where is None or not where.line:
        return None
    number = where.line - 1
    if offer.how == "line-out":
        return Edit(Span(Place(number, 0), Place(number + 1, 0)), "")
    line = text.line(number)
    start = text.starts[number]
    first = text.offset(text.of_bytes(number, where.column - 1)) - start
    at = line.find(offer.instead, first)
    if at < 0:
        return None
    places = text.place(start + at), text.place(start + at + len(offer.instead))
    return Edit(Span(*places), offer.text)


def _in_file(found: Found, offer: Setting | StepBefore) -> tuple[str, Edit | None]:
    """Return the edit of a pipeline or machine file, and its path."""
    pipeline = found.pipeline
    of_machine = isinstance(offer, Setting) and offer.section.partition(".")[0] in MACHINE
    machine = pipeline.machine.file if pipeline and pipeline.machine else None
    path = machine if of_machine else (found.file or None)
    if path is None or not os.path.isfile(path):
        return "", None
    text = Text(Path(path).read_bytes().decode("utf-8", "replace"))
    if isinstance(offer, StepBefore):
        return str(path), _step(text, offer)
    return str(path), _setting(text, offer) if offer.section else None


def _value(offer: Setting) -> str:
    """Return the value of a setting; one that only the reader knows is left to be filled in."""
    return f'"{TO_FILL_IN}"' if OPEN.search(offer.value) else offer.value


def _setting(text: Text, offer: Setting) -> Edit | None:
    """Return the edit that gives a file a setting; None where it has the key, or "*" a name."""
    if "*" in offer.section:
        return None
    header = re.compile(rf"^\[{re.escape(offer.section)}\][ \t]*(?:#.*)?$")
    lines = [text.line(k) for k in range(len(text))]
    said = f"{offer.key} = {_value(offer)}"
    at = next((k for k, line in enumerate(lines) if header.match(line)), None)
    if at is None:
        end = text.place(len(text.text))
        gap = "" if text.text.endswith("\n") or not text.text else "\n"
        return Edit(Span(end, end), f"{gap}\n[{offer.section}]\n{said}\n")
    for line in lines[at + 1 :]:
        if line.startswith("["):
            break
        if re.match(rf"{re.escape(offer.key)}[ \t]*=", line):
            return None
    return _inserted(at + 1, f"{said}\n")


def _step(text: Text, offer: StepBefore) -> Edit:
    """Return the edit that puts a step before another, or before all."""
    lines = [text.line(k) for k in range(len(text))]
    heads = [k for k, line in enumerate(lines) if line.strip() == "[[pass]]"]
    names = [_use(lines, k) for k in heads]
    at = heads[names.index(offer.step)] if offer.step in names else (heads or [len(lines)])[0]
    said = (each.partition("=") for each in offer.options.split())
    given = "".join(f'{key} = "{value}"\n' for key, _, value in said)
    return _inserted(at, f'[[pass]]\nuse = "{offer.name}"\n{given}\n')


def _use(lines: Sequence[str], head: int) -> str:
    for line in lines[head + 1 :]:
        if found := re.match(r"""use[ \t]*=[ \t]*["']([^"']*)""", line):
            return found[1]
        if line.startswith("["):
            break
    return ""


def _inserted(line: int, text: str) -> Edit:
    return Edit(Span(Place(line, 0), Place(line, 0)), text)


# --- what text passes make ---


def formatted(program: Program, lines: tuple[int, int] | None = None) -> list[Edit]:
    """Return the edits of formatting, of some lines alone if they are given: from, to (from 0).

    Lines by themselves are not renumbered, and none of them is left out. Raises UsageError for a
    chain that is none, and what a run raises.
    """
    wishes, data = program.shop.wishes, program.text.data
    pipeline = program.shop.text_chain(program.path, data, wishes.format)
    steps = pipeline.passes
    if wrong := [step for step in steps if not isinstance(step, TextPass)]:
        message = f"formatting changes no meaning, and {wrong[0].name!r} may"
        raise UsageError.one("GX713", message, hint='format = "strip comments=false | renumber"')
    if lines is not None:
        steps = tuple(_by_lines(step) for step in steps if step.name != RENUMBER)
    made = replace(pipeline, passes=steps, stamp=False).run(data).text
    return list(_difference(program.text, made.decode("utf-8", "replace"), lines))


def _by_lines(step: Any) -> Any:
    """Return a pass that leaves out no blocks."""
    known = {each.name for each in fields(step)} if is_dataclass(step) else set()
    return replace(step, empty=False) if "empty" in known else step


def _difference(before: Text, after: str, lines: tuple[int, int] | None) -> Iterator[Edit]:
    """Yield the edits between two texts: line by line where they have the same lines."""
    now = before.of(after)
    if len(now) == len(before):
        for number in range(len(before)):
            old, new = before.line(number), now.line(number)
            if old != new and (lines is None or lines[0] <= number <= lines[1]):
                end = before.place(before.starts[number] + len(old))
                yield Edit(Span(Place(number, 0), end), new)
    elif lines is None:
        end = before.place(len(before.text))
        yield Edit(Span(Place(0, 0), end), after)
