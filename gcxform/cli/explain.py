"""`gcxform explain`: what a diagnostic code means, or what one block of a program does."""

from __future__ import annotations

import re
import textwrap
from typing import Any

import click

from gcxform.catalogue import CATALOGUE
from gcxform.cli import VERBS
from gcxform.cli.common import options
from gcxform.cli.common.answer import answer
from gcxform.config.toml_text import did_you_mean
from gcxform.diagnostics import UsageError

_CODE = re.compile(r"GX\d+|\d{3}", re.IGNORECASE)
_LINE = re.compile(r"(.+):(\d+)")


@click.command("explain", help=VERBS["explain"], short_help=VERBS["explain"])
@options.FROM
@options.reading_options
@click.argument("what", metavar="CODE|FILE:LINE")
def command(what: str, dialect: str | None, **asked: Any) -> None:
    """Explain a code of the catalogue, or a line of a program."""
    line = _LINE.fullmatch(what)
    if line:
        from gcxform.cli.program.block import explained  # what a code means is said without numpy

        said = list(explained(line[1], int(line[2]), dialect, asked))
        answer({"file": line[1], "line": int(line[2]), "lines": said}, said)
    else:
        name, title, text = _code(what)
        wrapped = textwrap.wrap(text, 88, break_on_hyphens=False)
        answer({"code": name, "title": title, "text": text}, [f"{name}: {title}", "", *wrapped])


def _code(text: str) -> tuple[str, str, str]:
    """Return a code, its title and its explanation. Raises UsageError if there is none."""
    name = text.upper() if text[:1].isalpha() else f"GX{text}"
    if name not in CATALOGUE:
        near = did_you_mean(name, CATALOGUE) if _CODE.fullmatch(text) else ""
        near = near if near.endswith("?") else ""
        hint = near or "a code such as GX301, or FILE:LINE with -f DIALECT"
        raise UsageError.one("GX729", f"there is no code {text!r}", hint=hint)
    return (name, *CATALOGUE[name])
