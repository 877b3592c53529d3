"""From a name to where it is defined, and back: in the program, and in the files of its folder."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Final, NamedTuple

from gcxform.cli.common.programs import is_program
from gcxform.cli.editing.mentions import Kind, Mention, Mentions, numbered_line
from gcxform.cli.editing.program import Program, lines_of

MOST_FILES: Final = 500  # of a folder that are looked into
MOST_BYTES: Final = 1 << 21  # of one of them


class Target(NamedTuple):
    """A place with a name: a file, None for the program itself, a line from 0, columns in bytes."""

    file: Path | None
    line: int
    start: int
    end: int


def mention_at(program: Program, line: int, column: int) -> Mention | None:
    """Return what is named or defined at a place: a line and a byte, from 0."""
    for number, each in program.mentions:
        if number == line and each.kind != Kind.SECTION and each.start <= column <= each.end:
            return each
    return None


def definition(program: Program, line: int, column: int) -> Target | None:
    """Return where what stands at a place is defined; None where it is not, or is a tool."""
    asked = mention_at(program, line, column)
    if asked is None or asked.kind == Kind.TOOL:
        return None
    own = _own(program, asked)
    return own if own or asked.kind != Kind.PROGRAM else _beside(program, asked)


def references(program: Program, line: int, column: int) -> list[Target]:
    """Return all places of the program with what stands at a place, those that define it too."""
    asked = mention_at(program, line, column)
    if asked is None:
        return []
    names = set(_names(asked))
    return [
        Target(None, number, each.start, each.end)
        for number, each in program.mentions
        if each.kind == asked.kind and names & {*_names(each)}
    ]


def _names(mention: Mention) -> list[str]:
    """Return what a name may be: a Fanuc takes the last four of more digits for the program."""
    name = mention.name
    long = mention.kind == Kind.PROGRAM and name.isdecimal() and len(name) > 4
    return [name, str(int(name[-4:]))] if long else [name]


def _own(program: Program, asked: Mention) -> Target | None:
    for name in _names(asked):
        for number, each in program.mentions:
            if each.defines and (each.kind, each.name) == (asked.kind, name):
                return Target(None, number, each.start, each.end)
        if asked.kind == Kind.LABEL and name.isdecimal():
            at = numbered_line(program.lines, name)
            return None if at is None else Target(None, at, 0, len(program.lines[at]))
    return None


def _beside(program: Program, asked: Mention) -> Target | None:
    """Return the definition of a program in another file: in its text, else by the file's name."""
    by_name = None
    for path in _files(Path(program.path)):
        for name in _names(asked):
            if path.stem.lower().lstrip("o0") == name.lstrip("o0"):
                by_name = by_name or Target(path, 0, 0, 0)
            found = _defined_in(path, name)
            if found is not None:
                return found
    return by_name


def _files(path: Path) -> Iterator[Path]:
    """Yield the programs beside one; no links, for they may lead anywhere."""
    try:
        names = sorted(os.listdir(path.parent))[:MOST_FILES]
    except OSError:
        return
    for each in (path.parent / name for name in names if is_program(name) and name != path.name):
        if each.is_file() and not each.is_symlink() and each.stat().st_size <= MOST_BYTES:
            yield each


def _defined_in(path: Path, name: str) -> Target | None:
    try:
        data = path.read_bytes()
    except OSError:
        return None
    if name.encode() not in data.lower():
        return None
    lines = lines_of(data)
    for number, each in Mentions().of(lines):
        if each.defines and (each.kind, each.name) == (Kind.PROGRAM, name):
            return Target(path, number, each.start, each.end)
    return None
