"""What lines of a program define and name: programs, labels, tools, and sections by comments.

This finds its way about a text and decides nothing of what it does, so one table serves the
languages of all controls: what would be a jump in one of them stands in no other. A line is looked
at once, however often the text is changed.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import field
from enum import IntEnum
from typing import Final, NamedTuple

from gcxform.values import dataclass


class Kind(IntEnum):
    """What is mentioned; a smaller one holds greater ones."""

    PROGRAM = 0
    TOOL = 1
    LABEL = 2
    SECTION = 3


class Mention(NamedTuple):
    """A name in a line: the columns (bytes, from 0) of what stands there, and whether it defines.

    `name` is as names are compared: numbers without zeros in front, letters small.
    """

    kind: Kind
    name: str
    start: int
    end: int
    defines: bool


_HEAD: Final = r"^[ \t]*(?:/[0-9]?)?[ \t]*(?:N[ \t]*[0-9]+[ \t]*)?"
_NAME: Final = r"[A-Z_]{2}[A-Z0-9_]*"
_QUOTED: Final = r'[0-9]+|"[^"]*"'
_OWORD: Final = r"O[ \t]*([0-9]+|<[^<>]*>)[ \t]*"


def _all(*patterns: str) -> tuple[re.Pattern[bytes], ...]:
    return tuple(re.compile(each.encode("ascii")) for each in patterns)


DEFINED: Final = {
    Kind.PROGRAM: _all(
        rf"{_HEAD}O[ \t]*([0-9]+)[ \t]*$",
        rf"{_OWORD}SUB(?![A-Z])",
        r"^[ \t]*:[ \t]*([0-9]+)",
        r"^[ \t]*%_N_([A-Z0-9_]+)_[MS]PF",
        rf"{_HEAD}PROC[ \t]+({_NAME})",
        r"^[ \t]*[0-9]*[ \t]*BEGIN PGM ([^ \t]+)",
        rf"^[ \t]*%(?!_N_)(?:L[ \t]+)?({_NAME})",
    ),
    Kind.LABEL: _all(
        rf"{_HEAD}({_NAME})[ \t]*:(?!=)",
        r"^[ \t]*\[([A-Z_][A-Z0-9_]*)\]",
        rf"^[ \t]*[0-9]*[ \t]*LBL[ \t]*({_QUOTED})",
    ),
}
NAMED: Final = {
    Kind.PROGRAM: _all(
        r"(?<![A-Z])M[ \t]*0*98(?![0-9]).*?P[ \t]*([0-9]+)",
        r"(?<![A-Z])G[ \t]*6[56](?![0-9]).*?P[ \t]*([0-9]+)",
        rf"{_OWORD}CALL(?![A-Z])",
        r"CALL PGM ([^ \t]+)",
        r'(?<![A-Z])CALL[ \t]*"([^"]+)"',
        rf"#P?CALL[ \t]*\[?({_NAME})",
        rf"{_HEAD}L[ \t]+({_NAME})",
        rf"{_HEAD}({_NAME})(?:[ \t]*\(|[ \t]*$|[ \t]+P[ \t]*[=0-9])",
    ),
    Kind.LABEL: _all(
        r"GOTO[BFCS]?[ \t]*N?[ \t]*([0-9]+)",
        rf"GOTO[BFCS]?[ \t]+(?!LBL)({_NAME})",
        r"GOTO[ \t]*\[([A-Z_][A-Z0-9_]*)\]",
        r"(?<![A-Z])M[ \t]*0*9[79](?![0-9]).*?P[ \t]*([0-9]+)",
        rf"(?:CALL|GOTO)[ \t]*LBL[ \t]*({_QUOTED})",
        rf"REPEATB?[ \t]+({_NAME})",
        rf"REPEATB?[ \t]+{_NAME}[ \t]+({_NAME})",
    ),
}
_TOOL: Final = re.compile(rb'(?<![A-Z])(?:TOOL CALL|T)[ \t]*=?[ \t]*([0-9]+|"[^"]*")')
_CHANGE: Final = re.compile(rb"(?<![A-Z])M[ \t]*0*6(?![0-9.])|TOOL CALL")
_SECTION: Final = re.compile(
    rb"^[ \t]*(?:N[ \t]*[0-9]+[ \t]*)?(?:\(([^()]*)\)|;(.*)|[0-9]*[ \t]*\*[ \t]*-?(.*))[ \t]*$"
)
_COMMENT: Final = re.compile(rb"\([^()]*\)|;.*")
_NUMBERED: Final = re.compile(rb"[ \t]*(?:/[0-9]?)?[ \t]*N[ \t]*0*([0-9]+)(?![0-9.])")
_PLAIN: Final = re.compile(rb"(?![ \t]*\[|.*[A-Z]{2})[-+*=#\[\]. \t0-9NGXYZABCUVWIJKRFQS]*")
_CYCLE: Final = re.compile(rb"G[ \t]*6[56]")
"""Lines of such letters, one by one, name nothing, but for G65 and G66."""
_ALONG: Final = re.compile(
    rb"[ \t]*[0-9]+[ \t]+(?:L|LP|C|CC|CP|CR|CT)(?:[ \t]+(?:I?[XYZABCUVW][-+]?[0-9.]+|"
    rb"I?P[RA][-+]?[0-9.]+|R(?:[0LR]|[-+]?[0-9.]+)|F(?:MAX|AUTO|[0-9.]+)|DR[-+]))*[ \t]*"
)
"""Lines of Klartext that only go somewhere name nothing either."""


def name_of(text: bytes) -> str:
    """Return a name as names are compared."""
    found = text.decode("utf-8", "replace").strip().strip('"<>').lower()
    return str(int(found)) if found.isascii() and found.isdecimal() else found


def of_line(line: bytes) -> tuple[Mention, ...]:
    """Return what a line defines and names."""
    upper = line.upper()
    if _is_plain(upper):
        return ()
    if found := _SECTION.match(upper):
        group = found.lastindex or 1
        words = line[slice(*found.span(group))].decode("utf-8", "replace").strip()
        return (Mention(Kind.SECTION, words, *found.span(group), True),) if words else ()
    bare = _COMMENT.sub(lambda m: b" " * len(m[0]), upper)
    if bare != upper and _is_plain(bare):
        return ()
    found_here = [*_found(DEFINED, bare, defines=True), *_found(NAMED, bare, defines=False)]
    if found := _TOOL.search(bare):
        changes = _CHANGE.search(bare) is not None
        found_here.append(
            Mention(Kind.TOOL, name_of(found[1]), found.start(), found.end(), changes)
        )
    elif _CHANGE.search(bare):
        found_here.append(Mention(Kind.TOOL, "", 0, len(line), True))
    return tuple(found_here)


def _is_plain(line: bytes) -> bool:
    """Whether a line, in capitals, cannot name anything: most lines are told so at once."""
    if _PLAIN.fullmatch(line):
        return not _CYCLE.search(line)
    return _ALONG.fullmatch(line) is not None


def _found(
    table: dict[Kind, tuple[re.Pattern[bytes], ...]], line: bytes, defines: bool
) -> Iterator[Mention]:
    for kind, patterns in table.items():
        for pattern in patterns:
            for found in pattern.finditer(line):
                yield Mention(kind, name_of(found[1]), found.start(1), found.end(1), defines)


@dataclass
class Mentions:
    """What the lines of a text mention; lines that were looked at are remembered."""

    _known: dict[bytes, tuple[Mention, ...]] = field(default_factory=dict)

    def of(self, lines: Sequence[bytes]) -> list[tuple[int, Mention]]:
        """Return all mentions with their lines, from 0, in order."""
        known = self._known
        if len(known) > 4 * len(lines) + 10_000:
            known.clear()
        found = []
        for number, line in enumerate(lines):
            mentions = known.get(line)
            if mentions is None:
                mentions = known[line] = of_line(line)
            if mentions:
                found += [(number, each) for each in mentions]
        return found


def numbered_line(lines: Sequence[bytes], name: str) -> int | None:
    """Return the first line, from 0, that begins with a number, None if there is none."""
    for number, line in enumerate(lines):
        found = _NUMBERED.match(line.upper())
        if found and name_of(found[1]) == name:
            return number
    return None


class Symbol(NamedTuple):
    """A part of a program: what it is, what it is called, its lines (from, to), and what is in it.

    `at` are the columns of the name in its first line.
    """

    kind: Kind
    title: str
    lines: tuple[int, int]
    at: tuple[int, int]
    inside: list[Symbol]


def outline(mentions: Sequence[tuple[int, Mention]], count: int) -> list[Symbol]:
    """Return the parts of a program of so many lines.

    A tool is where it is changed; where nothing says so, wherever it is named.
    """
    changed = any(each.kind == Kind.TOOL and each.defines for _, each in mentions)
    parts = list(_parts(mentions, changed))
    ends, next_of = [], [count] * len(Kind)
    for line, each, _ in reversed(parts):
        ends.append(max(min(next_of[: each.kind + 1]) - 1, line))
        next_of[each.kind] = line
    found: list[Symbol] = []
    above: list[Symbol] = []
    for (line, each, title), last in zip(parts, reversed(ends), strict=True):
        symbol = Symbol(each.kind, title, (line, last), (each.start, each.end), [])
        while above and above[-1].kind >= each.kind:
            above.pop()
        (above[-1].inside if above else found).append(symbol)
        above.append(symbol)
    return found


def _parts(
    mentions: Sequence[tuple[int, Mention]], changed: bool
) -> Iterator[tuple[int, Mention, str]]:
    """Yield what begins a part, with its line and its title."""
    chosen = "?"
    seen = -1
    for line, each in mentions:
        if each.kind == Kind.TOOL:
            chosen = each.name or chosen
            if changed and not each.defines:
                continue
            yield line, each, f"T{chosen}"
        elif each.defines and (each.kind, line) != (Kind.PROGRAM, seen):
            seen = line if each.kind == Kind.PROGRAM else seen
            yield line, each, each.name
