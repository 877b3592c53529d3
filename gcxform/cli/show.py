"""`gcxform show`: pictures of an error model, or of the errors along the path of a program."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import click

from gcxform import plot
from gcxform.api import Program
from gcxform.cli import VERBS, options
from gcxform.cli.asked import Asked, needed_dialect
from gcxform.cli.described import built, options_of
from gcxform.cli.outputs import check_places, destination
from gcxform.cli.programs import opened
from gcxform.machine.errors import Outside
from gcxform.options import Length, ModelFile, Option, Vector
from gcxform.pipeline import Pipeline
from gcxform.pipelinefile import parse_chain
from gcxform.registry import default_registry
from gcxform.simulate.heat import before_and_after

PASS = "volumetric"


@dataclass(frozen=True)
class ModelOptions:
    """How the machine of a program is described."""

    model: Annotated[ModelFile | None, Option("error model of the machine that FILE is run on")] = (
        None
    )
    part_origin: Annotated[Vector | None, Option("origin of the program in the machine")] = None
    table_origin: Annotated[Vector, Option("origin of the measurement")] = (0.0, 0.0, 0.0)
    outside: Annotated[Outside, Option("what the error is beyond the tables")] = Outside.ERROR
    tolerance: Annotated[Length, Option("tolerance of the compensation", above=0.0)] = 0.001


@click.command("show", help=VERBS["show"], short_help=VERBS["show"])
@click.option("-o", "--output", metavar="FILE", required=True, help="The picture: SVG or PNG.")
@options.FROM
@click.option(
    "-x",
    "--chain",
    metavar="CHAIN",
    default="absolute",
    show_default=True,
    help="Passes before the compensation.",
)
@options_of(ModelOptions)
@options.reading_options
@options.FILE
def command(
    file: str,
    output: str,
    dialect: str | None,
    chain: str,
    machine: str | None,
    start: str | None,
    increment: str | None,
    feed_increment: str | None,
    block_delete: str | None,
    **given: Any,
) -> None:
    """Draw FILE: an error model, or with --model a program."""
    plot.check(output)
    check_places({"-o": output}, [file, given["model"], machine])
    asked = built(ModelOptions, given, "show")
    if asked.model is None:
        alone = built(ModelOptions, {"model": file}, "show").model
        assert alone is not None
        drawn = plot.model(alone.model, f"{alone.path.name}: {alone.model.kind}")
    else:
        what = Asked(
            machine=machine,
            start=start,
            increment=increment,
            block_delete=block_delete,
            feed_increment=feed_increment,
        )
        reading = what.reading()
        kind = default_registry().dialect(needed_dialect(dialect))
        passes = [*parse_chain(chain, Path.cwd(), default_registry()), _step(asked)]
        pipeline = Pipeline(kind, kind, tuple(passes), reading, what.loaded_machine)
        with opened(file) as source:
            program = Program(b"".join(source.windows()), kind, reading, source.name)
        before, after, _ = before_and_after(program, pipeline)
        drawn = plot.heat(before, after, f"{Path(file).name} on {asked.model.path.name}")
    with destination(output) as put:
        put(plot.rendered(drawn, output))


def _step(asked: ModelOptions) -> Any:
    """Return the pass that compensates."""
    step: Any = default_registry().pass_(PASS)
    return step(**vars(asked))
