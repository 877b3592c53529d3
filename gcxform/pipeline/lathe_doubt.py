"""Doubts whether a program is one of a mill, where it has no block that only lathes have.

On a lathe X is a diameter: half of what a mill would go. Programs with X and Z and no Y anywhere
that change tools by four digits without M6, or say G99, feed per turn, are such ones in all
likelihood. A mill may well have them, so it is a warning.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Final

from gcxform.diagnostics import Diagnostic, Location, Severity
from gcxform.dialect.dialect import Dialect
from gcxform.syntax.source import Source, lines_in

CODE: Final = "GX236"
COMMENT: Final = re.compile(rb"\([^)\r\n]*\)|;[^\r\n]*")
BOTH: Final = (re.compile(rb"X[ \t]*[-+.0-9]"), re.compile(rb"Z[ \t]*[-+.0-9]"))
OF_MILLS: Final = re.compile(rb"Y|(?<![A-Z])(?:M[ \t]*0*6|G[ \t]*(?:43|44|17))(?![0-9.])")
HOLES: Final = re.compile(rb"(?<![A-Z])G[ \t]*(?:8[0-9]|7[346])(?![0-9])")
TOOL: Final = re.compile(rb"(?<![A-Z])T[0-9]{4}(?![0-9])")
PER_TURN: Final = re.compile(rb"(?<![A-Z])G99(?![0-9.])")
HINT: Final = "programs of lathes are not read: X is a diameter there"


def lathe_doubts(source: Source, dialect: type[Dialect]) -> tuple[Diagnostic, ...]:
    """Return a warning about a program that may be for a lathe; nothing for all others."""
    if not dialect.block_rule.mill:
        return ()
    lines, found, holes = 0, list[tuple[int, str]](), False
    named = set[re.Pattern[bytes]]()
    for text in source.windows():
        plain = COMMENT.sub(lambda comment: b" " * len(comment[0]), text.upper())
        if OF_MILLS.search(plain):
            return ()
        holes = holes or HOLES.search(plain) is not None
        named |= {word for word in BOTH if word.search(plain)}
        found += ((lines + line, what) for line, what in _signs(plain))
        lines += lines_in(text)
    signs = [(line, what) for line, what in found if not (holes and what == "G99")][:1]
    return tuple(_warning(source, *sign) for sign in signs if len(named) > 1)


def _signs(plain: bytes) -> Iterator[tuple[int, str]]:
    """Yield the first of each sign in a text, with the line, from 0, in which it is."""
    for sign, what in ((TOOL, "a tool of four digits"), (PER_TURN, "G99")):
        if match := sign.search(plain):
            yield lines_in(plain[: match.start()] + b".") - 1, what


def _warning(source: Source, line: int, what: str) -> Diagnostic:
    message = f"X and Z without Y, and {what}: this may be a program for a lathe"
    where = Location(source.name, line + 1)
    return Diagnostic(CODE, message, where, HINT, severity=Severity.WARNING)
