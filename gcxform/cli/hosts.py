"""`gcxform hosts`: what the programs that call gcxform need to be told, with the right paths in it.

The command in it is the one that runs now, by its whole path: hosts have a PATH of their own, or
none. The pipeline is loaded before anything is said, so that what is wrong with it is found here
and not in a dialog box.
"""

from __future__ import annotations

from pathlib import Path

import click

from gcxform.cli import VERBS
from gcxform.cli.common.failures import say
from gcxform.cli.common.options import ENVIRONMENT
from gcxform.cli.common.outputs import destination
from gcxform.cli.common.request import Asked, excluding
from gcxform.cli.host.hosts import HOSTS, Host, place_of_post, text_of
from gcxform.diagnostics import UsageError
from gcxform.pipeline.pipeline import Pipeline


@click.command("hosts", help=VERBS["hosts"], short_help=VERBS["hosts"])
@click.option("-p", "--pipeline", metavar="FILE", help="Pipeline (TOML) that the host is to run.")
@click.option("--install", is_flag=True, help="Write it where FreeCAD looks for it.")
@click.argument("name", required=False, type=click.Choice(list(HOSTS)))
def command(name: str | None, pipeline: str | None, install: bool) -> None:
    """List hosts, or print what one of them needs."""
    if name is None:
        width = max(map(len, HOSTS))
        for each, host in HOSTS.items():
            click.echo(f"{each:{width}}  {host.title}")
        return
    asked = Asked(pipeline=pipeline)
    if asked.file is None:
        hint = f"-p FILE, or set {ENVIRONMENT}; gcxform machine new -p FILE PROGRAM writes one"
        raise UsageError.one("GX726", f"which pipeline is {name} to run?", hint=hint)
    _check(name, HOSTS[name], asked.build())
    text = text_of(name, Path(asked.file).absolute())
    if not install:
        click.echo(text, nl=False)
    elif name == "freecad":
        _install(text, place_of_post())
    else:
        raise excluding(f"--install and {name}, whose settings only its user can change")


def _install(text: str, place: Path) -> None:
    """Write a file for a host, and say where it is."""
    place.parent.mkdir(parents=True, exist_ok=True)
    with destination(str(place)) as put:
        put(text.encode())
    say(f"wrote {place}")


def _check(name: str, host: Host, pipeline: Pipeline) -> None:
    """Raise UsageError if a pipeline does not write what a host executes."""
    if host.dialect not in ("", pipeline.target.name):
        raise UsageError.one(
            "GX739",
            f"{name} executes {host.dialect}, and the pipeline writes {pipeline.target.name}",
            hint=f'dialect = "{host.dialect}" in [output]',
        )
