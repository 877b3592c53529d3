"""Programs that let the control follow the tip of the tool, read for a pass that does it instead.

`G43.4 H1` says that X, Y and Z are those of the tip from here on, whatever the rotary axes do. A
pass that turns tips into axes reads it as `G43 H1`, and that is what is left in the output. G43
itself has positions of axes, so a program with both is refused.

Other controls are switched by M codes of the machine's own, which mean opposite things on different
machines: LinuxCNC's M428 and M429. The machine file says which is which. They are read as codes of
the dialect, their acts are those of the frame (`following`), and they are not written: the control
stays as it is without them. What reads the output does not know them.

`G43.5 H1` says in addition that I, J and K of lines are the tool axis. It is read as `G43 H1` too,
in a dialect in which that means so, up to the next G49 (`gcxform/modal/moves/tool_vectors.py`).

A pass that corrects tips, and leaves it to the control to follow them, reads the M codes as well,
and they stay in the output (`with_kept`): its reader knows them too.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import replace
from functools import cache
from typing import Any, cast

from gcxform.contract.demands import Demands
from gcxform.diagnostics import InputError, Location
from gcxform.dialect.codes import FOLLOWING, MCode, barrier
from gcxform.dialect.dialect import Dialect
from gcxform.machine.machine import SWITCHES
from gcxform.syntax.source import Source, lines_in

KEPT = {"tip-on": "tip-kept-on", "tip-off": "tip-kept-off"}
"""The acts of M codes that follow the tip and leave it, where they are read and stay."""
OTHERWISE = "it is another tool length in a program with tool vectors"
COMMENT = rb"\([^()\r\n]*\)"


class WithoutTipCodes(Source):
    """A source in whose text each code that follows the tip is another one."""

    def __init__(self, source: Source, codes: Mapping[str, str]) -> None:
        super().__init__(source.stream, source.name)
        self.source = source
        self.codes = {code.encode(): other.encode() for code, other in codes.items()}
        self.others = {other.encode() for other in codes.values()}
        both = {**self.codes, **dict.fromkeys(self.others)}
        self.pattern = re.compile(
            b"|".join([COMMENT, *(_spelled(code) for code in both)]), re.IGNORECASE
        )

    def line_of(self, line: int) -> int:
        """Return the line of the file: see `Source.line_of`."""
        return self.source.line_of(line)

    def windows(self, size: int = 0) -> Iterator[bytes]:
        """Yield the text with the other codes. Raises InputError for a program with both."""
        lines = 0
        for text in self.source.windows(size):
            yield self.pattern.sub(lambda found: self._other(found, lines), text)  # noqa: B023
            lines += lines_in(text)

    def _other(self, found: re.Match[bytes], lines: int) -> bytes:
        """Return what stands in the place of a code, or of a comment."""
        if found[0].startswith(b"("):
            return found[0]
        code = _plain(found[0])
        if code in self.codes:
            return self.codes[code]
        before = found.string[: found.start()]
        line = self.line_of(lines + lines_in(before + b" "))
        names = ", ".join(code.decode() for code in self.codes)
        message = f"{code.decode()} has positions of axes, and {names} those of the tip"
        raise InputError.one("GX330", message, Location(self.name, line))


def switches_of(dialect: type[Dialect], control: Mapping[str, str | float]) -> dict[str, str]:
    """Return the M codes with which a control follows the tip and leaves it: their acts by code.

    They are those of the dialect, and those that the machine file gives.
    """
    said = (dialect.tip_rule.switches, control)
    return {str(given[act]): act for given in said for act in SWITCHES if act in given}


def with_switches(dialect: type[Dialect], control: Mapping[str, str | float]) -> type[Dialect]:
    """Return the dialect with the codes of a control that follow the tip; itself without them."""
    acts = switches_of(dialect, control)
    codes = {int(code[1:]): MCode("tip", act=act) for code, act in acts.items()}
    if not codes:
        return dialect
    return type(dialect.__name__, (dialect,), {"m_codes": {**dialect.m_codes, **codes}})


def with_refusal(dialect: type[Dialect], control: Mapping[str, str | float]) -> type[Dialect]:
    """Return the dialect that does not resolve the code from which on a control follows the tip.

    A dialect may take other M codes of the machine's own for what moves nothing. Programs that are
    only read are written for another control, which follows no tip: the code that leaves it says
    nothing there.
    """
    refused = MCode("tip", barrier=FOLLOWING)
    acts = switches_of(dialect, control)
    codes = {int(code[1:]): refused for code, act in acts.items() if act == "tip-on"}
    if dialect.translator is not None:
        left = (int(code[1:]) for code, act in acts.items() if act == "tip-off")
        codes |= {code: MCode("tip", act="tip-off") for code in left}
    if not codes:
        return dialect
    return type(dialect.__name__, (dialect,), {"m_codes": {**dialect.m_codes, **codes}})


def read_as(
    dialect: type[Dialect], control: Mapping[str, str | float], asked: Iterable[Demands]
) -> type[Dialect]:
    """Return the dialect in which programs are read for passes that ask for this."""
    reads = any(each.reads_tip_codes for each in asked)
    return (with_switches if reads else with_refusal)(dialect, control)


def read_plainly(
    source: Source, dialect: type[Dialect], read: type[Dialect], asked: Collection[Demands]
) -> tuple[Source, type[Dialect]]:
    """Return a program without codes that such passes do instead, and the dialect it is read in."""
    if any(each.reads_vectors for each in asked):
        plain = without_tip_codes(source, dialect.tip_rule.vector_codes)
        return plain, read if plain is source else with_vectors(read)
    if any(each.reads_tip_codes for each in asked):
        source = without_tip_codes(source, dialect.tip_rule.codes)
    return source, read


def with_kept(dialect: type[Dialect], control: Mapping[str, str | float]) -> type[Dialect]:
    """Return the dialect in which such M codes are read, and stay; itself without them."""
    acts = switches_of(dialect, control)
    kept = tuple((int(code[1:]), KEPT[act]) for code, act in acts.items())
    known = dialect.m_codes
    if all(number in known and known[number].act == act for number, act in kept):
        return dialect
    return _keeping(cast(Any, dialect), kept)


@cache
def _keeping(dialect: Any, kept: tuple[tuple[int, str], ...]) -> type[Dialect]:
    codes = {number: MCode("tip", act=act) for number, act in kept}
    made: type[Dialect] = type(
        dialect.__name__, (dialect,), {"m_codes": {**dialect.m_codes, **codes}}
    )
    return made


def with_vectors(dialect: type[Dialect]) -> type[Dialect]:
    """Return the dialect in which what is left of codes for tool vectors is read as what it was."""
    begins, codes = {*dialect.tip_rule.vector_codes.values()}, dict(dialect.codes)
    rule = replace(dialect.tip_rule, takes_vectors=True)
    for name, code in dialect.codes.items():
        if name in begins:
            codes[name] = replace(code, act="vectors")
        elif code.act == "no-length":
            codes[name] = replace(code, act="no-vectors")
        elif code.group == "tool-length":
            codes[name] = barrier(code.group, OTHERWISE, code.takes)
    return type(dialect.__name__, (dialect,), {"codes": codes, "tip_rule": rule})


def without_tip_codes(source: Source, codes: Mapping[str, str]) -> Source:
    """Return a source with others for codes that follow the tip; itself if it has none of them."""
    if not codes:
        return source
    pattern = re.compile(
        b"|".join([COMMENT, *(_spelled(code.encode()) for code in codes)]), re.IGNORECASE
    )
    for text in source.windows():
        if any(not found[0].startswith(b"(") for found in pattern.finditer(text)):
            return WithoutTipCodes(source, codes)
    return source


def _spelled(code: bytes) -> bytes:
    """Return a pattern of a code as programs may write it: `G043.40`."""
    whole, _, part = code[1:].partition(b".")
    decimals = rb"[ \t]*\.[ \t]*" + part + b"0*" if part else rb"(?:\.0*)?"
    return rb"G[ \t]*0*" + whole + decimals + rb"(?![0-9.])"


def _plain(found: bytes) -> bytes:
    """Return a code as the dialect writes it."""
    digits = found[1:].translate(None, b" \t")
    return b"G%g" % float(digits)
