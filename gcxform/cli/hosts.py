"""`gcxform hosts`: what the programs that call gcxform need to be told, with the right paths in it.

The command in it is the one that runs now, by its whole path: hosts have a PATH of their own, or
none. The pipeline is loaded before anything is said, so that what is wrong with it is found here
and not in a dialog box.
"""

from __future__ import annotations

from pathlib import Path

import click

from gcxform.cli import VERBS
from gcxform.cli.common.options import ENVIRONMENT
from gcxform.cli.common.request import Asked
from gcxform.cli.host.hosts import HOSTS, Host, text_of
from gcxform.diagnostics import UsageError
from gcxform.pipeline.pipeline import Pipeline


@click.command("hosts", help=VERBS["hosts"], short_help=VERBS["hosts"])
@click.option("-p", "--pipeline", metavar="FILE", help="Pipeline (TOML) that the host is to run.")
@click.argument("name", required=False, type=click.Choice(list(HOSTS)))
def command(name: str | None, pipeline: str | None) -> None:
    """List hosts, or print what one of them needs."""
    if name is None:
        width = max(map(len, HOSTS))
        for each, host in HOSTS.items():
            click.echo(f"{each:{width}}  {host.title}")
        return
    asked = Asked(pipeline=pipeline)
    if asked.file is None:
        hint = f"-p FILE, or set {ENVIRONMENT}"
        raise UsageError.one("GX726", f"which pipeline is {name} to run?", hint=hint)
    _check(name, HOSTS[name], asked.build())
    click.echo(text_of(name, Path(asked.file).absolute()), nl=False)


def _check(name: str, host: Host, pipeline: Pipeline) -> None:
    """Raise UsageError if a pipeline does not write what a host executes."""
    if host.dialect not in ("", pipeline.target.name):
        raise UsageError.one(
            "GX739",
            f"{name} executes {host.dialect}, and the pipeline writes {pipeline.target.name}",
            hint=f'dialect = "{host.dialect}" in [output]',
        )
