"""LinuxCNC tool tables: lines like `T1 P1 X0.1 Z+2.5 D6 ;end mill`, read as the tools of a machine.

The numbers are in the unit of the machine that the table belongs to, which the file does not say:
whoever names the file has to. D is a diameter. Lathe angles (I, J) and orientation (Q) are not
used; offsets of other axes than X, Y and Z are refused unless they are 0.
"""

from __future__ import annotations

import re
from collections.abc import Container, Iterator
from pathlib import Path

from msgspec.structs import replace

import gcxform as gx
from gcxform.vocabulary import Tool, control_lines

UNITS = {"mm": 1.0, "in": 25.4}
NUMBERS = {"T", "P"}
KEPT = {"X": "x", "Y": "y", "Z": "length", "D": "radius"}
ZERO = set("UVWABC")
IGNORED = set("IJQ")
_TOOL = re.compile(r"[ \t]*T[0-9]+(?![^ \t;])", re.IGNORECASE)
_WORD = re.compile(r"([A-Za-z])([+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+))")


def read_tools(path: Path, unit: str) -> dict[int, Tool]:
    """Return the tools of a table by number: length, radius, x and y where given, in mm.

    `unit` is that of the table, "mm" or "in". Raises FileError, and UsageError for its lines.
    """
    tools: dict[int, Tool] = {}
    first = 0
    found: list[gx.Diagnostic] = []
    lines = control_lines(path)
    for where in lines:
        words = where.text.partition(";")[0].split()
        if not words:
            continue
        problems = [*_problems(words, tools)]
        first = first or where.line
        found += [gx.Diagnostic("GX438", problem, where) for problem in problems]
        if not problems:
            number, tool = _tool(words, UNITS[unit])
            tools[number] = tool
    if found and not any(_TOOL.match(line.text) for line in lines):  # it is not shown: what is it?
        message = "no line of the file is one of a tool table, such as T1 P1 Z100"
        raise gx.UsageError.one("GX438", message, gx.Location(str(path), first or 1))
    if found:
        raise gx.UsageError(tuple(found))
    return tools


def _problems(words: list[str], tools: Container[int]) -> Iterator[str]:
    """Yield what is wrong with a line."""
    seen: set[str] = set()
    for word in words:
        match = _WORD.fullmatch(word)
        if match is None:
            yield f"{word!r} is not a letter with a number"
            continue
        letter, value = match[1].upper(), float(match[2])
        if letter in seen:
            yield f"{letter} stands here twice"
        seen.add(letter)
        if letter in NUMBERS and (value % 1 or value < 0):
            yield f"{letter} is not a whole number"
        elif letter == "T" and int(value) in tools:
            yield f"the tool {int(value)} stands twice"
        elif letter in ZERO and value:
            yield f"an offset of {letter} is not followed"
        elif letter == "D" and value < 0:
            yield "a negative diameter"
        elif letter not in NUMBERS | set(KEPT) | ZERO | IGNORED:
            yield f"a tool table has no word {letter}"
    if "T" not in seen:
        yield "the line has no T word"


def _tool(words: list[str], unit: float) -> tuple[int, Tool]:
    """Return the tool of a good line, and its number."""
    numbers = {word[0].upper(): float(word[1:]) for word in words}
    scale = {"D": unit / 2}
    values = {KEPT[a]: v * scale.get(a, unit) for a, v in numbers.items() if a in KEPT}
    return int(numbers["T"]), replace(Tool(length=0.0, radius=0.0), **values)
