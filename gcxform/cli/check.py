"""`gcxform check`: the chain of a pipeline before any program, and a program before any run."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from shlex import quote
from typing import Any, NamedTuple

import click
import numpy as np

from gcxform.catalogue.questions import PIPELINE
from gcxform.cli import VERBS
from gcxform.cli.common import options
from gcxform.cli.common.answer import answer
from gcxform.cli.common.answer import asked as document
from gcxform.cli.common.failures import say, warn
from gcxform.cli.common.first_steps import guessed
from gcxform.cli.common.pipelines import announce
from gcxform.cli.common.programs import opened
from gcxform.cli.common.request import Asked
from gcxform.cli.program.missing import STATELESS, Missing, Visit
from gcxform.cli.program.settings_block import block, sections
from gcxform.cli.program.settings_block import options as as_options
from gcxform.config.to_fill_in import told_open
from gcxform.contract.passes import Pass
from gcxform.diagnostics import PRINTED_AT_MOST, Diagnostic, InputError, Severity, UsageError
from gcxform.flow.by_itself import is_subprogram
from gcxform.flow.straightened import located, written_out
from gcxform.guess import FOREIGN
from gcxform.modal.interpreter import Interpreter
from gcxform.modal.program_end import Ending
from gcxform.modal.reader import Tables, windows_of
from gcxform.pipeline.certify import assumptions
from gcxform.pipeline.chain import facts_after
from gcxform.pipeline.pipeline import Pipeline
from gcxform.plugin.registry import default_registry
from gcxform.proof.centre_path import CentreProof
from gcxform.stamps.chain import edited, told
from gcxform.stamps.comment import stamps_in
from gcxform.syntax.source import Source
from gcxform.toolpath.facts import Fact

ENOUGH = 100 * PRINTED_AT_MOST


@click.command("check", help=VERBS["check"], short_help=VERBS["check"])
@options.pipeline_options
@click.argument("file", metavar="[FILE]", required=False)
def command(file: str | None, **asked: Any) -> int:
    """Check a pipeline, and a program with it; exit 1 if there are findings."""
    what = Asked(**asked) if file is None else Asked(**asked).beside(file)
    announce(what)
    if not what.says_chain and file is not None:
        what = _alone(what, file)
    pipeline = what.build()
    warn((*default_registry().diagnostics, *pipeline.warnings))
    steps = chain(pipeline)
    if file is None:
        answer({"chain": steps}, steps)
        return 0
    with opened(file) as source:
        answer({"chain": steps}, steps)
        return _check(pipeline, source, what)


def _alone(what: Asked, file: str) -> Asked:
    """Return what is asked of a program for which there is no pipeline: whether it can be read.

    A person who says no dialect is told which one it looks like; a program is not answered so.
    """
    if what.dialect:
        return replace(what, chain="")
    if document() is not None:
        return what
    if (guess := guessed(file)) is None:
        return _unlike(file)
    say(f"read as {guess.dialects[0]}, since it looks like {guess}; -f DIALECT says what it is")
    return replace(what, chain="", dialect=guess.dialects[0])


def _unlike(file: str) -> Asked:
    """Refuse a program that looks like none: it cannot be read, or no dialect is its own."""
    if file != "-":
        with opened(file):
            pass
    hint = f"-f DIALECT reads it as that; `gcxform list dialects`, `gcxform info {quote(file)}`"
    raise UsageError.one("GX722", f"{file} looks like a program in no dialect", hint=hint)


# --- the chain ---


def chain(pipeline: Pipeline) -> list[str]:
    """Return the steps of a pipeline with their facts and promises, and the budget."""
    lines = [f"preset {each}" for each in pipeline.machine.taken] if pipeline.machine else []
    lines += [f"read   {pipeline.source.name}: {_names(facts_after(pipeline.path_passes, 0))}"]
    done = 0
    for number, step in enumerate(pipeline.passes, 1):
        lines.append(f"{number:<6} {step.name}")
        if not isinstance(step, Pass):
            lines.append("       changes text and no meaning")
            continue
        done += 1
        for name in ("requires", "ensures", "clears"):
            if facts := getattr(step, name):
                lines.append(f"       {name:8} {_names(facts)}")
        lines.append(f"       then     {_names(facts_after(pipeline.path_passes, done))}")
        proved = ", proved by itself" if step.demands.resolves else ""
        lines.append(f"       promise  {_length(step.promise)}{proved}")
    return [*lines, f"write  {pipeline.target.name}", *_budget(pipeline)]


def _names(facts: frozenset[Fact]) -> str:
    return " ".join(sorted(fact.name for fact in facts)) or "nothing"


def _length(size: float) -> str:
    if not np.isfinite(size):
        return "none: the budget is explicit, and what comes out is measured"
    return f"{size * 1000:g} um" if size else "exact"


def _budget(pipeline: Pipeline) -> list[str]:
    kind = "explicit" if pipeline.budget is not None else "what the steps need"
    bound = pipeline.growth
    growth = [] if bound is None else [f"growth    {bound:g} blocks for each one read, at most"]
    return [
        f"steps     {_length(pipeline.promised())}",
        f"rounding  {pipeline.rounding() * 1000:.3g} um",
        f"budget    {_limits(pipeline)}, {kind}",
        *growth,
    ]


def _limits(pipeline: Pipeline) -> str:
    """Return the budget, and that of a program with arcs where it is another."""
    plain, arcs = (pipeline.limit(arcs=arcs) * 1000 for arcs in (False, True))
    return f"{plain:.4g} um" + (f" ({arcs:.4g} um if there are arcs)" if arcs > plain else "")


# --- the program ---


class Found(NamedTuple):
    """What speaks against a program, what else is to be said of it, and what is missing."""

    wrong: list[Diagnostic]
    others: list[Diagnostic]
    open: Missing


def _found(pipeline: Pipeline, source: Source, taken: list[str]) -> Found:
    """Return what speaks against a program; `taken` gets what was assumed on the way."""
    done = _again(pipeline, source)
    seen = done or speaks_against(pipeline, source, taken)
    errors = [each for each in seen if each.severity is Severity.ERROR]
    missing = Visit(pipeline, source, speaks_against).run([] if done else errors)
    wrong = errors if done else list(told_open(missing.told(), pipeline.to_fill_in))
    return Found(wrong, [each for each in seen if each.severity is not Severity.ERROR], missing)


def _check(pipeline: Pipeline, source: Source, what: Asked) -> int:
    """Say what speaks against a program; return the exit code."""
    stamps = stamps_in(source)
    answer({"stamps": told(stamps)}, (f"stamp     {line}" for line in told(stamps)))
    warn(edited(stamps.edited, source.name, stamps.line))
    taken: list[str] = []
    found, others, open_ = _found(pipeline, source, taken)
    lines = sum(len(window) for window, _ in windows_of(source, pipeline.read_as))
    warn([*found, *others])
    said = pipeline.machine.taken if pipeline.machine else ()
    assumed = [each for each in dict.fromkeys(taken) if each not in said]
    values = {"file": source.name, "lines": lines, "assumed": assumed}
    values["missing"] = [".".join(each) for each in open_.asked()]
    head = [*(f"assumed   {each}" for each in assumed)]
    counted = f"{lines} lines" if lines else "the file is empty"
    head.append(f"{source.name}: {counted}, {_count(found)}")
    answer(values, [*head, *_other_dialect(found, what, pipeline), *_asked(open_, what, pipeline)])
    return 1 if found else 0


def _other_dialect(found: Sequence[Diagnostic], what: Asked, pipeline: Pipeline) -> Iterator[str]:
    """Yield what a program looks like that is read in a dialect which does not know its words."""
    if not what.program or FOREIGN.isdisjoint(each.code for each in found):
        return
    guess = guessed(what.program)
    if guess is not None and pipeline.source.name not in guess.dialects:
        yield f"read as {pipeline.source.name}, and it looks like {guess}"


def _count(found: Sequence[Diagnostic]) -> str:
    """Return in words how many findings there are, and how many places they have."""
    if not found:
        return "no findings"
    places = sum(1 + len(each.also) for each in found)
    said = f"{len(found)} finding{'s' * (len(found) > 1)}"
    return said if places == len(found) else f"{said} at {places} lines"


def _asked(found: Missing, what: Asked, pipeline: Pipeline) -> Iterator[str]:
    """Yield what is missing, as text to paste into files, and as options for who has none."""
    asked, notes = found.asked(), found.notes()
    for question in (each for each in asked if each in pipeline.to_fill_in):
        yield f"fill in   {pipeline.to_fill_in[question]}, {notes.get(question, '')}"
    tables = sections(each for each in asked if each not in pipeline.to_fill_in)
    dialect, file = pipeline.source.name, pipeline.machine.file if pipeline.machine else None
    if PIPELINE in tables:
        yield from ("", f'# {what.file or "pipeline file"}: fill in what is "?"')
        if not what.file:
            yield f"# or as options: {as_options(asked)}"
        yield from block(tables.pop(PIPELINE), notes, dialect)
    if tables:
        yield from ("", f'# {file or "machine file, -m FILE"}: fill in what is "?"')
        yield from [] if file else ["format = 1"]
    for questions in tables.values():
        yield from ("", *block(questions, notes, dialect))


def speaks_against(
    pipeline: Pipeline, source: Source, taken: list[str] | None = None
) -> list[Diagnostic]:
    """Return why a program is refused, or warnings; `taken` gets what was assumed on the way."""
    taken = [] if taken is None else taken
    try:
        alone = not pipeline.copies and is_subprogram(source, pipeline.read_as)
        found = [] if alone else list(_first(speaks_against_reading(pipeline, source, taken)))
        return found or _refusals(pipeline, source, taken)
    except UsageError as error:  # of a pass that was told of a machine on trial
        return list(error.diagnostics)


def _again(pipeline: Pipeline, source: Source) -> list[Diagnostic]:
    """Return why the chain must not run on a program to which something has been done."""
    try:
        pipeline.marks(source)
    except InputError as error:
        return list(error.diagnostics)
    return []


def speaks_against_reading(
    pipeline: Pipeline, source: Source, taken: list[str], tables: Tables | None = None
) -> Iterator[Diagnostic]:
    """Yield what speaks against reading a program, or the blocks that it executes.

    `taken` gets what was assumed on the way; `tables` are kept from one reading to the next.
    """
    try:
        told = pipeline.machine_reading, None if pipeline.copies else pipeline.target
        executed = written_out(source, pipeline.read_as, *told)
    except InputError as error:
        yield from error.diagnostics
        return
    yield from speaks_against_blocks(pipeline, executed, taken, tables)


def speaks_against_blocks(
    pipeline: Pipeline, executed: Source, taken: list[str], tables: Tables | None = None
) -> Iterator[Diagnostic]:
    """Yield what speaks against reading the blocks that a program executes, in its own lines."""
    for diagnostic in reading_findings(pipeline, executed, taken, tables):
        yield from located(InputError((diagnostic,)), executed).diagnostics


def _first(found: Iterator[Diagnostic]) -> Iterator[Diagnostic]:
    for _, diagnostic in zip(range(ENOUGH), found, strict=False):
        yield diagnostic


def reading_findings(
    pipeline: Pipeline,
    source: Source,
    taken: list[str] | None = None,
    tables: Tables | None = None,
) -> Iterator[Diagnostic]:
    """Yield what speaks against reading a program; `taken` gets what was assumed on the way.

    After the first window that is refused nothing is known of the state any more, so from there on
    only those findings count that are about a block by itself.
    """
    axes = pipeline.machine_reading.axes_of(source, pipeline.source)
    chosen = source.assumed
    source, dialect = pipeline.without_tip_codes(source)
    interpreter = Interpreter(dialect, pipeline.machine_reading, axes, source.name)
    interpreter.undecided = source.undecided
    ending = Ending(pipeline.source, source.name)
    centres = CentreProof(pipeline.context, source.name)
    stays = not any(step.demands.resolves for step in pipeline.path_passes)
    for window, reader in windows_of(source, dialect, tables):
        try:
            path = interpreter.interpret(window, reader.table).path
            yield from centres.stops(path) if stays else ()
        except InputError as error:
            only = interpreter.only
            yield from (d for d in error.diagnostics if only is None or d.code in only)
            interpreter.only = STATELESS
        ending.look(window, reader.table)
    yield from ending.wrong
    if taken is not None and interpreter.only is None:
        taken += assumptions(interpreter, pipeline.source, chosen)


def _refusals(pipeline: Pipeline, source: Source, taken: list[str]) -> list[Diagnostic]:
    """Return why the passes or the writing refuse a program that can be read, or warnings."""
    try:
        done = pipeline.run_stream(source, len)
    except InputError as error:
        return list(error.diagnostics)
    taken += done.assumed
    return done.warnings
