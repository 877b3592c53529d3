"""TOOL CALL and TOOL DEF among the lines of a program, once all of them are known."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

CALLED = re.compile(r'(TOOL CALL (?:[0-9]+|"[^"]*") Z)( ;.*)?')
SPEED = re.compile(r"TOOL CALL Z( S[^;]+)")


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
            yield f"{called[1]}{speed[1]}{called[2] or ''}", waits[1]
            waits = None
            continue
        if waits:
            yield waits
        waits = line, of
    if waits:
        yield waits
