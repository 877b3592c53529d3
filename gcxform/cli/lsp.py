"""`gcxform lsp`: a language server for editors, which speaks on stdin and stdout."""

from __future__ import annotations

import logging
import sys

import click

from gcxform.cli import VERBS
from gcxform.diagnostics import UsageError


@click.command("lsp", help=VERBS["lsp"], short_help=VERBS["lsp"])
def command() -> None:
    """Answer an editor until it closes the connection; editors start this by themselves."""
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
