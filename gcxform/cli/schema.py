"""`gcxform schema`: the JSON Schemas of files that editors check, and of what verbs answer."""

from __future__ import annotations

import json
from importlib.resources import files
from pathlib import Path
from typing import Any, Final

import click

from gcxform.cli import VERBS
from gcxform.cli.common.answer import answer
from gcxform.cli.common.failures import say
from gcxform.cli.program.named_schemas import KINDS as OF_FILES
from gcxform.cli.program.named_schemas import schema, write_schemas

ANSWER: Final = "answer"
KINDS: Final = (*OF_FILES, ANSWER)
FOLDER: Final = files("gcxform.cli") / "schemas"


@click.command("schema", help=VERBS["schema"], short_help=VERBS["schema"])
@click.option("--write", metavar="DIR", help="Write the schemas of all files into DIR instead.")
@click.argument("words", metavar="KIND | FILE...", nargs=-1)
def command(words: tuple[str, ...], write: str | None) -> None:
    """Print a schema: of a kind of files, or of what verbs answer with --json.

    KIND is pipeline (gcxform.toml is one), machine, model, manifest (of a batch) or answer. With
    --write, each FILE is given a first line that names its schema in DIR, for editors.
    """
    if write is not None:
        for path in write_schemas(Path(write), words):
            say(f"wrote {path}")
        return
    kind = _kind(words)
    found = answers() if kind == ANSWER else schema(kind)
    answer({"kind": kind, "schema": found}, [json.dumps(found, indent=2)])


def _kind(words: tuple[str, ...]) -> Any:
    if len(words) != 1:
        raise click.UsageError(f"give one of {', '.join(KINDS)}")
    return click.Choice(KINDS).convert(words[0], None, click.get_current_context())


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
