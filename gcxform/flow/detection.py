"""Does a program have calls, loops, or codes that are computed? Asked of every program, so quickly.

A byte that most windows of a long program do not have is looked for first, then a pattern that
begins with a letter, which is fast, and only then is the text looked at without its comments. What
is not seen here is refused where it is read.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence

from gcxform.dialect.dialect import Dialect
from gcxform.flow.oword_names import STANDS
from gcxform.syntax.source import COMMENT, Source

CODE = re.compile("[GM][0-9]+|T")
TO_THE_END = re.compile(rb";[^\r\n]*")
REST = re.compile(rb"[^\r\n]*")
NUMBERED = rb"(?:N[ \t]*[0-9.]+[ \t]*)?"
MODES = rb"M[ \t]*0*(?:98|7[0-3])(?![0-9])"
CALLS = rb"M[ \t]*0*9[789](?![0-9])"
WITH_VALUES = rb"G[ \t]*0*6[56](?![0-9])"
NULL = rb"#[ \t]*0+(?![0-9])"
COMPUTED = (
    (b"#", rb"G[ \t]*#"),
    (b"#", rb"M[ \t]*#"),
    (b"[", rb"G[ \t]*\["),
    (b"[", rb"M[ \t]*\["),
)
NAMES = "|".join(STANDS).upper().encode()
POSITION = rb"#[ \t]*(?:5[ \t]*4[ \t]*2|<[ \t]*(?:%s)[ \t]*>(?![ \t]*=))" % NAMES
PRINTED = re.compile(rb"\([ \t]*(?:DEBUG|PRINT|LOG)[ \t]*,[^()\n\r]*" + POSITION, re.IGNORECASE)
"""Messages of LinuxCNC that may print where the axes stand, or modes."""
READS = rb"#[ \t]*(?:40(?:0[123567]|14)|4109|4120|500[123])(?![0-9])"
"""Variables of macro B that say modes of the block before, and where the axes stand."""
ALARM = rb"#[ \t]*3000(?![0-9])"
"""The variable with which a program of macro B stops the control for good."""
WHILE = rb"WHILE|WH[ \t]*\["
SIGNS: dict[str, tuple[tuple[bytes, bytes], ...]] = {
    "o-words": (
        (b"O", rb"O[ \t]*[0-9<#]"),
        (b"M", MODES),
        *COMPUTED,
        (b"#", POSITION),
        (b"@", rb"@"),
        (b"^", rb"\^"),
    ),
    "macro-b": (
        (b"M", CALLS),
        (b"O", rb"GOTO"),
        (b"[", WHILE),
        (b"[", rb"IF[ \t]*\["),
        (b"G", WITH_VALUES),
        (b"#", NULL),
        (b"#", READS),
        (b"#", ALARM),
    ),
}
"""A byte, and what a program with flow has where it has that byte."""
PROOFS = {
    "o-words": re.compile(
        rb"^[/ \t]*"
        + NUMBERED
        + rb"O[^\n\r;]*?[A-Z]{2}|[@^]|[GM][ \t]*[#\[]|"
        + b"|".join((MODES, POSITION)),
        re.IGNORECASE | re.MULTILINE,
    ),
    "macro-b": re.compile(
        rb"|".join((CALLS, rb"GOTO|IF[ \t]*\[", WHILE, WITH_VALUES, NULL, READS, ALARM)),
        re.IGNORECASE,
    ),
}
"""What that looks like outside of comments."""


def aliases(control: Mapping[str, str | float]) -> dict[str, int]:
    """Return the programs that codes call, by code, as a machine file says: G100 calls O9010."""
    said = ((name.removeprefix("macro "), value) for name, value in control.items())
    return {
        name: int(value)
        for name, value in said
        if CODE.fullmatch(name) and not isinstance(value, str)
    }


def has_flow(source: Source, dialect: type[Dialect], control: Mapping[str, str | float]) -> bool:
    """Whether a program may have calls, loops or codes that are computed."""
    if dialect.flow_rule.language not in SIGNS:
        return False
    if dialect.flow_rule.macro_levels and aliases(control):
        return True
    signs = [(byte, re.compile(pattern)) for byte, pattern in _cased(dialect)]
    return any(_flows(text, dialect, signs) for text in source.windows())


def _flows(
    text: bytes, dialect: type[Dialect], signs: Sequence[tuple[bytes, re.Pattern[bytes]]]
) -> bool:
    """Whether lines have flow; the line of the first sign mostly says it already."""
    found = (pattern.search(text) for byte, pattern in signs if byte in text)
    sign = next((each for each in found if each), None)
    if sign is None:
        return False
    first = max(text.rfind(end, 0, sign.start()) for end in (b"\n", b"\r")) + 1
    rest = REST.match(text, sign.end())
    line = text[first : rest.end() if rest else sign.end()]
    proof = PROOFS[dialect.flow_rule.language]
    return bool(
        proof.search(_without_comments(line, dialect))
        or proof.search(_without_comments(text, dialect))
        or (dialect.flow_rule.language == "o-words" and PRINTED.search(text))
    )


def _cased(dialect: type[Dialect]) -> Iterator[tuple[bytes, bytes]]:
    """Yield the signs, in small letters too where the control takes these."""
    for byte, pattern in SIGNS[dialect.flow_rule.language]:
        yield byte, pattern
        small = re.sub(rb"[A-Z]+", lambda letters: letters[0].lower(), pattern)
        if dialect.text_rule.lower_case and small != pattern:
            yield byte.lower(), small


def _without_comments(text: bytes, dialect: type[Dialect]) -> bytes:
    bare = COMMENT.sub(b"", text)
    return TO_THE_END.sub(b"", bare) if ";" in dialect.text_rule.comments else bare
