"""`gcxform schema`: the JSON Schemas that editors check files with."""

from __future__ import annotations

import json
from typing import Literal

import click

from gcxform.cli import VERBS
from gcxform.pipeline.schema import schema


@click.command("schema", help=VERBS["schema"], short_help=VERBS["schema"])
@click.argument("kind", type=click.Choice(["pipeline", "machine", "model"]))
def command(kind: Literal["pipeline", "machine", "model"]) -> None:
    """Print a schema."""
    click.echo(json.dumps(schema(kind), indent=2))
