"""`gcxform lsp`: a language server for editors, which speaks on stdin and stdout."""

from __future__ import annotations

import json
import logging
import sys

import click

from gcxform.cli import VERBS
from gcxform.cli.common.answer import answer
from gcxform.diagnostics import UsageError
from gcxform.plugin.registry import default_registry


@click.command("lsp", help=VERBS["lsp"], short_help=VERBS["lsp"])
@click.option(
    "--highlighting", metavar="DIALECT", help="Print a TextMate grammar for a dialect instead."
)
def command(highlighting: str | None) -> None:
    """Answer an editor until it closes the connection; editors start this by themselves."""
    if highlighting is not None:
        from gcxform.cli.editing.highlighting import highlighting as grammar

        found = grammar(default_registry().dialect(highlighting))
        answer({"grammar": found}, [json.dumps(found, indent=2)])
        return
    try:
        from gcxform.cli.editing.server import new_server
    except ImportError as error:
        if (error.name or "").partition(".")[0] not in ("pygls", "lsprotocol"):
            raise
        hint = "pip install 'gcxform[lsp]'"
        raise UsageError.one("GX736", "the language server needs pygls", hint=hint) from None
    logging.basicConfig(stream=sys.stderr, level=logging.ERROR)
    given, taken = sys.stdin.buffer, sys.stdout.buffer
    sys.stdout = sys.stderr  # nothing but the protocol may come out
    new_server().start_io(given, taken)
