"""`gcxform schema`: the JSON Schemas of files that editors check, and of what verbs answer."""

from __future__ import annotations

import json
from importlib.resources import files
from typing import Any, Final, get_args

import click

from gcxform.cli import VERBS
from gcxform.cli.common.answer import answer
from gcxform.pipeline.schema import Kind, schema

ANSWER: Final = "answer"
FOLDER: Final = files("gcxform.cli") / "schemas"


@click.command("schema", help=VERBS["schema"], short_help=VERBS["schema"])
@click.argument("kind", type=click.Choice([*get_args(Kind), ANSWER]))
def command(kind: Any) -> None:
    """Print a schema: of a kind of files, or of what verbs answer with --json."""
    found = answers() if kind == ANSWER else schema(kind)
    answer({"kind": kind, "schema": found}, [json.dumps(found, indent=2)])


def answers() -> dict[str, Any]:
    """Return the schema of what verbs answer: what all have, and by verb what each adds.

    A verb without a file of its own adds nothing. `calibrate.json` is that of all below it.
    """
    whole: dict[str, Any] = json.loads((FOLDER / "answer.json").read_text("utf-8"))
    own = sorted(each.name.removesuffix(".json") for each in FOLDER.iterdir())
    own = [name for name in own if name in VERBS]
    whole["allOf"] = [
        {
            "if": {"properties": {"verb": {"pattern": f"^{name}( |$)"}}},
            "then": json.loads((FOLDER / f"{name}.json").read_text("utf-8")),
        }
        for name in own
    ]
    return whole
