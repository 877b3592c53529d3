"""`gcxform show`: pictures of an error model, or of the errors along the path of a program."""

from __future__ import annotations

from dataclasses import fields, replace
from pathlib import Path
from typing import Annotated, Any, Literal

import click

from gcxform import plot
from gcxform.api import Program
from gcxform.cli import VERBS
from gcxform.cli.common import options
from gcxform.cli.common.derived_options import built, options_of
from gcxform.cli.common.outputs import check_places, destination
from gcxform.cli.common.programs import opened
from gcxform.cli.common.request import Asked, needed_dialect
from gcxform.contract.options import Length, ModelFile, Option, Vector
from gcxform.diagnostics import Location, UsageError
from gcxform.dialect.dialect import Dialect
from gcxform.errormodel.model import Outside
from gcxform.pipeline.chain_text import parse_chain
from gcxform.pipeline.pipeline import Pipeline
from gcxform.plugin.registry import default_registry
from gcxform.simulate.heat import before_and_after
from gcxform.values import dataclass

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
    max_correction: Annotated[Length, Option("largest correction", above=0.0)] = 0.2
    max_extrapolation: Annotated[float, Option("cells beyond the tables", above=0.0)] = 1.0
    backlash: Annotated[
        Literal["refuse", "mean"], Option("of a model with backlash: refuse it, or take the mean")
    ] = "refuse"
    time: Annotated[str | None, Option("time (ISO 8601) whose temperatures hold")] = None


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
def command(file: str, output: str, dialect: str | None, chain: str, **given: Any) -> None:
    """Draw FILE: an error model, or with --model a program."""
    plot.check(output, "-o")
    asked = Asked(**{field.name: given.pop(field.name, None) for field in fields(Asked)})
    check_places({"-o": output}, [file, given["model"], asked.machine])
    told = built(ModelOptions, given, "show")
    if told.model is None:
        drawn = _model(file, told.time)
    else:
        kind = default_registry().dialect(needed_dialect(dialect))
        drawn = _program(file, kind, chain, asked, told)
    with destination(output) as put:
        put(plot.rendered(drawn, output))


def _model(file: str, time: str | None) -> Any:
    """Return the picture of an error model, at a time if one is given."""
    if not Path(file).exists():
        raise UsageError.one("GX709", f"the error model {file!r} does not exist", Location(file))
    shown = built(ModelOptions, {"model": file}, "show").model
    assert shown is not None
    shown = shown if time is None else shown.at_time(time)
    return plot.model(shown.model, f"{shown.path.name}: {shown.model.kind}")


def _program(
    file: str, dialect: type[Dialect], chain: str, asked: Asked, told: ModelOptions
) -> Any:
    """Return the picture of a program on a machine."""
    first = parse_chain(chain, Path.cwd(), default_registry())
    compensate: Any = default_registry().pass_(PASS)
    steps = (*first, compensate(**vars(told)))
    said = replace(asked, machine=None).reading()
    pipeline = Pipeline(dialect, dialect, steps, said, asked.loaded_machine)
    with opened(file) as source:
        text, name = b"".join(source.windows()), source.name
    program = Program(text, dialect, pipeline.machine_reading, name)
    before, after, _ = before_and_after(program, pipeline)
    assert told.model is not None
    return plot.heat(before, after, f"{Path(file).name} on {told.model.path.name}")
