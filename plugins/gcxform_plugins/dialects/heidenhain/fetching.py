"""TOOL DEF among the lines of a program: which tool is fetched for the next change."""

from __future__ import annotations

from collections.abc import Iterator


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
