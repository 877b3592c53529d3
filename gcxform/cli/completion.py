"""`gcxform completion`: the lines by which a shell completes verbs and options."""

from __future__ import annotations

import click
from click.shell_completion import get_completion_class

from gcxform.cli import COMPLETE, VERBS, verbs


@click.command("completion", help=VERBS["completion"], short_help=VERBS["completion"])
@click.argument("shell", type=click.Choice(["bash", "zsh", "fish"]))
def command(shell: str) -> None:
    """Print what a shell is to read: `gcxform completion bash >> ~/.bashrc`."""
    kind = get_completion_class(shell)
    assert kind is not None
    click.echo(kind(verbs, {}, "gcxform", COMPLETE).source())
