"""`gcxform machine new`: a machine file, and a pipeline file, for the programs of a shop."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from shlex import quote
from typing import Final, NamedTuple

from gcxform.catalogue.questions import PIPELINE
from gcxform.cli.check import speaks_against
from gcxform.cli.common.failures import say
from gcxform.cli.common.outputs import STDOUT, check_places, destination
from gcxform.cli.common.programs import files_of, opened
from gcxform.cli.common.request import Asked
from gcxform.cli.program.filled_files import with_questions
from gcxform.cli.program.named_schemas import Kind, comment_for
from gcxform.cli.program.settings_block import block
from gcxform.cli.program.survey import Programs, Survey, dialect_of
from gcxform.machine.machine import Machine
from gcxform.pipeline.chain_text import parse_chain
from gcxform.pipeline.pipeline import Pipeline
from gcxform.plugin.registry import default_registry
from gcxform.system.inputs import visit

ANY_PASSES: Final = ("absolute", "cycles | offsets | absolute")
"""Chains that together ask for what a pass may have to know, but for errors and rotary axes."""
DEFAULT: Final = "absolute"


class Places(NamedTuple):
    """Where the machine file goes, and the pipeline file if one is wanted."""

    machine: str
    pipeline: str | None


class Wanted(NamedTuple):
    """What is to be done with the programs: a chain, and the dialect to write; None: as read."""

    chain: str | None
    to: str | None


def write_new(paths: Sequence[str], dialect: str | None, wanted: Wanted, places: Places) -> None:
    """Write what programs need; what the files say already is kept, and taken for known.

    Raises UsageError where a program would be overwritten.
    """
    registry = default_registry()
    known = registry.dialects if dialect is None else {dialect: registry.dialect(dialect)}
    files = files_of(paths)
    check_places({"-o": places.machine, "-p": places.pipeline}, map(str, files))
    found = Survey()
    with visit():  # what is read here are also the files that are added to
        read = dialect_of(files, known)
        pipelines = list(_pipelines(read.dialect, wanted, places))
        for file in read.files:
            with opened(str(file)) as source:
                found.add(source, pipelines, speaks_against)
    _write(read, found, wanted, places)


def _pipelines(dialect: str, wanted: Wanted, places: Places) -> Iterator[Pipeline]:
    """Yield the pipelines for which programs are looked at, with what files say already."""
    machine = places.machine if _is_there(places.machine) else None
    bare = Asked(chain="", dialect=dialect, to=wanted.to, machine=machine).build()
    if bare.machine is None:  # passes ask for one that has none of what they need
        bare = replace(bare, machine=Machine(file=Path(places.machine)))
    for each in (wanted.chain,) if wanted.chain is not None else ANY_PASSES:
        steps = tuple(parse_chain(each, Path.cwd(), default_registry()))
        pipeline = replace(bare, passes=steps)
        if places.pipeline and _is_there(places.pipeline):
            said = Asked(pipeline=places.pipeline, machine=machine).build()
            pipeline = _with_input(pipeline, said)
        yield pipeline


def _with_input(pipeline: Pipeline, said: Pipeline) -> Pipeline:
    """Return a pipeline that knows of programs what another one knows."""
    return replace(pipeline, reading=said.reading, open=said.open)


def _is_there(name: str) -> bool:
    return name != STDOUT and os.path.isfile(name)


# --- what is written ---


def _write(read: Programs, found: Survey, wanted: Wanted, places: Places) -> None:
    """Write both files, and say what was found."""
    asked, notes = found.asked(), found.notes()
    of_pipeline = [question for question in asked if question[0] == PIPELINE]
    of_machine = [question for question in asked if question[0] != PIPELINE]
    head = _text("machine", places.machine, ["format = 1"])
    text = with_questions(head, of_machine, notes, read.dialect, places.machine)
    if places.pipeline:
        head = _text("pipeline", places.pipeline, _pipeline_head(read, wanted, places))
        other = with_questions(head, of_pipeline, notes, read.dialect, places.pipeline)
        with destination(places.pipeline) as put:
            put(other.encode())
    with destination(places.machine) as put:
        put(text.encode())
    for line in _said(read, found):
        say(line)
    if of_pipeline and not places.pipeline:
        say("for [input] of a pipeline file, which -p FILE writes:")
        say("\n".join(block(of_pipeline, notes, read.dialect)))


def _text(kind: Kind, name: str, head: Iterable[str]) -> str:
    """Return the text of a file that is there, which has been read as TOML, or of a new one."""
    schema = [] if name == STDOUT else comment_for(kind, Path(name))
    if _is_there(name):
        return Path(name).read_bytes().decode()
    said = '# Fill in what is "?": until then it says nothing, and is refused where it is needed.'
    return "\n".join([*schema, said, *head, ""])


def _pipeline_head(read: Programs, wanted: Wanted, places: Places) -> Iterator[str]:
    """Yield a pipeline file of which only `[input]` is to be filled in."""
    yield from ("format = 1", "", "[input]", f'dialect = "{read.dialect}"')
    if places.machine != STDOUT:
        folder = Path(places.pipeline or "").resolve().parent
        yield from ("", "[machine]", f'file = "{os.path.relpath(places.machine, folder)}"')
    if wanted.to:
        yield from ("", "[output]", f'dialect = "{wanted.to}"')
    for step in (wanted.chain or DEFAULT).split("|"):
        name, *options = step.split()
        yield from ("", "[[pass]]", f'use = "{name}"')
        yield from (_option(option) for option in options)


def _option(word: str) -> str:
    """Return an option of a pass, as it is typed, as a key of a file."""
    key, _, value = word.partition("=")
    plain = value in ("true", "false") or value.replace(".", "", 1).lstrip("-").isdecimal()
    return f"{key} = {value}" if plain else f'{key} = "{value}"'


def _said(read: Programs, found: Survey) -> Iterator[str]:
    """Yield what was found, in words."""
    subprograms = f", {found.subprograms} subprograms" if found.subprograms else ""
    yield f"{found.programs} program{'s' * (found.programs != 1)} in {read.dialect}{subprograms}"
    if read.others:
        names = ", ".join(path.name for path in read.others[:5])
        more = f" and {len(read.others) - 5} more" if len(read.others) > 5 else ""
        yield f"not read, since too much of them is not {read.dialect}: {names}{more}"
        yield f"  gcxform check -f {read.dialect} {quote(str(read.others[0]))}    what that is"
    left = list(found.left())
    yield from ["what no setting helps:", *(f"  {line}" for line in left)] if left else []
