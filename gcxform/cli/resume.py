"""`gcxform resume`: the blocks that bring a control into the state before a line."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from typing import Any

import click

from gcxform.cli import VERBS
from gcxform.cli.common import options
from gcxform.cli.common.failures import warn
from gcxform.cli.common.programs import opened
from gcxform.cli.common.request import Asked, needed_dialect
from gcxform.contract.tilted_planes import with_known_planes
from gcxform.diagnostics import Diagnostic, Location, Severity, UsageError
from gcxform.dialect.dialect import Dialect
from gcxform.pipeline.own_language import check_written
from gcxform.resume.preamble import Preamble
from gcxform.resume.restart import Restart
from gcxform.stamps.comment import Stamps, stamps_in, without_lines
from gcxform.stamps.writing import Seal, comment_line
from gcxform.syntax.source import lines_in


@click.command("resume", help=VERBS["resume"], short_help=VERBS["resume"])
@click.option("--line", type=click.IntRange(1), required=True, help="Line to begin at, from 1.")
@click.option("--clearance", type=options.LENGTH, help="Z of the program that is clear of all.")
@click.option("--plunge", metavar="FEED", type=float, help="Feed down to Z, mm/min.  [default: F]")
@click.option("--tool-loaded", is_flag=True, help="Name the tool in a comment; do not change it.")
@click.option("--rest", is_flag=True, help="Print the rest of the program as well.")
@options.FROM
@options.reading_options
@options.FILE
def command(
    file: str,
    line: int,
    clearance: float | None,
    plunge: float | None,
    tool_loaded: bool,
    rest: bool,
    dialect: str | None,
    **asked: Any,
) -> None:
    """Print the blocks for a restart at a line, proved to lead to what the program does."""
    kind, reading = Asked(**asked).reads(needed_dialect(dialect))
    check_written(kind)
    kind = with_known_planes(kind, reading)
    if plunge is not None and not plunge > 0:
        raise UsageError.one("GX706", f"{plunge:g} is not above 0", Location("--plunge"))
    if rest and clearance is None:
        raise UsageError.one("GX705", "--rest needs --clearance", hint="--clearance 50mm")
    with opened(file) as source:
        restart = Restart(kind, source, reading, line)
        preamble = restart.preamble(clearance, plunge, not tool_loaded)
        end = b"\r\n" if b"\r\n" in restart.rest[0] else b"\n"
        frame = ["%"] if rest and restart.state.percents == 1 else []
        stamps = stamps_in(source)
        heads = [comment_line(kind, stamp.content).decode() for stamp in stamps.stamps]
        said = [*frame, *heads, *_blocks(preamble, line), *_standing(restart)]
        text = b"".join(block.encode("latin-1") + end for block in said)
        if open_end := restart.prove(preamble, text):
            warn([_as_note(open_end)])
        whole = _sealed([text, *restart.rest], kind, stamps, end) if rest else [text]
        for part in whole:
            click.echo(part, nl=False)


def _sealed(texts: list[bytes], kind: type[Dialect], stamps: Stamps, end: bytes) -> Iterator[bytes]:
    """Yield a program with a seal of its own if it is stamped; one that did not fit stays."""
    if not stamps:
        yield from texts
        return
    first, *rest = texts
    digest = hashlib.sha256()
    seal = Seal(kind, digest, None if stamps.fits else "".join(stamps.seals[:1]))
    for text in (first, *(without_lines(part) for part in rest)):
        part, _ = seal.let_through(text, range(lines_in(text)) if text else ())
        digest.update(part)
        yield part
    yield seal.close(end, True)[0]


def _as_note(found: Diagnostic) -> Diagnostic:
    note = Severity.NOTE
    return Diagnostic(found.code, found.message, found.where, found.hint, found.context, note)


def _blocks(preamble: Preamble, line: int) -> Iterator[str]:
    """Yield the blocks with what a person must know of them."""
    yield f"(RESTART AT LINE {line})"
    if preamble.memory.loaded is None:
        yield "(NO TOOL CHANGE BEFORE IT: CHECK THE TOOL)"
    yield from preamble.blocks()
    if preamble.approach is None:
        yield f"(THE AXES MUST STAND AT {preamble.places_text()})"


def _standing(restart: Restart) -> Iterator[str]:
    """Yield a word on axes that the program has not moved yet but moves later."""
    later = [axis for axis in restart.unknown() if axis in restart.used]
    if later:
        yield f"({' '.join(later)} MUST STAND WHERE THE PROGRAM BEGAN)"
