"""TOOL CALL and TOOL DEF among the lines of a program, once all of them are known."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from decimal import Decimal

import gcxform as gx
from gcxform_plugins.dialects.heidenhain.numerals import signed

INCHES, MILLIMETRES = "INCH", "MM"
CALLED = re.compile(r'(TOOL CALL (?:[0-9]+|"[^"]*") Z)((?: D[LR][-+.0-9]+)*(?: ;.*)?)')
SPEED = re.compile(r"TOOL CALL Z( S[^;]+)")


def told_of(deltas: Mapping[str, Decimal], inch: bool) -> str:
    """Return what TOOL CALL tells of its tool, with the unit, in a block."""
    told = "".join(f" {name}{signed(by)}" for name, by in sorted(deltas.items()))
    return gx.Speller.told(f"{INCHES if inch else MILLIMETRES}{told}")


def words_of(told: str, inch: bool) -> str:
    """Return the words of TOOL CALL for what it tells of its tool. Raises UnspeakableError."""
    unit, _, words = told.partition(" ")
    if told and (unit == INCHES) != inch:
        raise gx.UnspeakableError(f"{words} of a tool in another unit than the program has")
    return f" {words}" if words else ""


def fetched_ahead(lines: list[tuple[str, int]]) -> Iterator[tuple[str, int]]:
    """Yield lines without a TOOL DEF behind which TOOL CALL takes the tool at once."""
    after = ""
    found = []
    for line, of in reversed(lines):
        called = f"TOOL CALL {line.removeprefix('TOOL DEF ')} Z"
        if not (line.startswith("TOOL DEF ") and after.startswith(called)):
            found.append((line, of))
        after = after if line.startswith(";") else line
    yield from reversed(found)


def called_with_speed(lines: Iterable[tuple[str, int]]) -> Iterator[tuple[str, int]]:
    """Yield lines with the speed in the TOOL CALL of the tool, where one follows upon the other."""
    waits: tuple[str, int] | None = None
    for line, of in lines:
        speed, called = SPEED.fullmatch(line), CALLED.fullmatch(waits[0]) if waits else None
        if waits and called and speed:
            yield f"{called[1]}{speed[1]}{called[2]}", waits[1]
            waits = None
            continue
        if waits:
            yield waits
        waits = line, of
    if waits:
        yield waits
