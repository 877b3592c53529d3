"""`gcxform view`: one HTML file in which a program is looked at."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from gcxform.cli import VERBS
from gcxform.cli.common import options
from gcxform.cli.common.outputs import check_places, destination
from gcxform.cli.common.programs import opened
from gcxform.cli.common.request import Asked, needed_dialect
from gcxform.plugin.registry import default_registry
from gcxform.view import document
from gcxform.view.packing import Store
from gcxform.view.programs import described
from gcxform.view.reading import Shown, read


@click.command("view", help=VERBS["view"], short_help=VERBS["view"])
@click.option(
    "-o", "--output", metavar="FILE", default="view.html", show_default=True, help="The page."
)
@options.FROM
@options.reading_options
@options.FILE
def command(file: str, output: str, dialect: str | None, **asked: Any) -> None:
    """Write a page that shows FILE."""
    what = Asked(**asked)
    check_places({"-o": output}, [file, what.machine])
    shown = _read(file, needed_dialect(dialect), what)
    store = Store()
    head = {"title": Path(file).name, "programs": [described(shown, store, {})]}
    with destination(output) as put:
        put(document.written(Path(file).name, head, store).encode())


def _read(file: str, dialect: str, asked: Asked) -> Shown:
    kind = default_registry().dialect(dialect)
    with opened(file) as source:
        return read(source, kind, asked.reading())
