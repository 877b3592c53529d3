"""A table with a heading and a picture, as HTML that stands for itself.

All text comes from outside (comments of programs, names of files) and is escaped here, once; what
does not print is a dot. There is no script, no style sheet and no address in it.
"""

from __future__ import annotations

import html
from collections.abc import Iterable

CELL = "padding:1px 12px 1px 0;text-align:left;vertical-align:top"


def escaped(text: object) -> str:
    """Return text as a page shows it: no character of it is markup, or does something else."""
    printed = "".join(c if c.isprintable() or c == "\n" else "\N{MIDDLE DOT}" for c in str(text))
    return html.escape(printed, quote=True)


def shown(title: str, rows: Iterable[tuple[str, object]], picture: str = "", text: str = "") -> str:
    """Return a heading, rows of two cells, a picture (SVG, put in as it is) and text as it is."""
    cells = "".join(
        f'<tr><th style="{CELL}">{escaped(name)}</th><td style="{CELL}">{escaped(value)}</td></tr>'
        for name, value in rows
    )
    pre = f'<pre style="white-space:pre-wrap">{escaped(text)}</pre>' if text else ""
    return f"<div><b>{escaped(title)}</b><table>{cells}</table>{picture}{pre}</div>"
