"""LinuxCNC tool tables: lines like `T1 P1 X0.1 Z+2.5 D6 ;end mill`, read as the tools of a machine.

The numbers are in the unit of the machine that the table belongs to, which the file does not say:
whoever names the file has to. D is a diameter. Lathe angles (I, J) and orientation (Q) are not
used; offsets of other axes than X, Y and Z are refused unless they are 0.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from gcxform.diagnostics import Diagnostic, FileError, Location, UsageError
from gcxform.system import inputs

UNITS = {"mm": 1.0, "in": 25.4}
NUMBERS = {"T", "P"}
KEPT = {"X": "x", "Y": "y", "Z": "length", "D": "radius"}
ZERO = set("UVWABC")
IGNORED = set("IJQ")
_TOOL = re.compile(r"[ \t]*T[0-9]+(?![^ \t;])", re.IGNORECASE)
_WORD = re.compile(r"([A-Za-z])([+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+))")


def read_tools(path: Path, unit: str) -> dict[int, dict[str, float]]:
    """Return the tools of a table by number: length, radius, x and y where given, in mm.

    `unit` is that of the table, "mm" or "in". Raises FileError, and UsageError for its lines.
    """
    try:
        lines = inputs.read(path).decode("latin-1").splitlines()
    except OSError as error:
        raise FileError.one("GX901", f"cannot read {path}: {error.strerror}") from None
    tools: dict[int, dict[str, float]] = {}
    first = 0
    found: list[Diagnostic] = []
    for number, line in enumerate(lines, 1):
        words = line.partition(";")[0].split()
        if not words:
            continue
        problems = [*_problems(words, tools)]
        first = first or number
        where = Location(str(path), number, 1, line, max(1, len(line)))
        found += [Diagnostic("GX438", problem, where) for problem in problems]
        if not problems:
            tool, values = _tool(words, UNITS[unit])
            tools[tool] = values
    if found and not any(_TOOL.match(line) for line in lines):  # whatever it is, it is not shown
        message = "no line of the file is one of a tool table, such as T1 P1 Z100"
        raise UsageError.one("GX438", message, Location(str(path), first or 1))
    if found:
        raise UsageError(tuple(found))
    return tools


def _problems(words: list[str], tools: dict[int, dict[str, float]]) -> Iterator[str]:
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


def _tool(words: list[str], unit: float) -> tuple[int, dict[str, float]]:
    """Return number and values of the tool of a good line."""
    numbers = {word[0].upper(): float(word[1:]) for word in words}
    scale = {"D": unit / 2}
    values = {KEPT[a]: v * scale.get(a, unit) for a, v in numbers.items() if a in KEPT}
    return int(numbers["T"]), values
