"""A machine file with another direction, point and sign of one axis; the rest keeps its bytes.

The lines of the table of the axis that have these keys are replaced, and so are the comments of an
earlier calibration, which begin with `# calibrated:`. What comes out is read again: it has to be
what was read before, but for these values.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable
from typing import Any, Final

from gcxform.diagnostics import Location, UsageError
from gcxform.machine.machine import Axis
from gcxform.machine.text import axis_lines

MARK: Final = "# calibrated:"
_OWN = re.compile(rf"[ \t]*(?:{re.escape(MARK)}|(?:direction|point|sign)[ \t]*=)")
_HEADER = re.compile(r"[ \t]*\[")


def with_axis(text: str, letter: str, axis: Axis, comments: Iterable[str], file: str) -> str:
    """Return the text of a machine file with the direction, point and sign of an axis.

    `comments` are put before them. Raises UsageError (GX435) if the axis has no table of its own
    with a line for each key.
    """
    end = "\r\n" if "\r\n" in text else "\n"
    new = [*(f"{MARK} {comment}" for comment in comments), *axis_lines(axis)]
    lines = text.splitlines(keepends=True)
    header = re.compile(rf"[ \t]*\[[ \t]*axis[ \t]*\.[ \t]*{letter}[ \t]*\][ \t]*(?:#.*)?")
    found = [k for k, line in enumerate(lines) if header.fullmatch(line.rstrip("\r\n"))]
    if found:
        first = found[0] + 1
        last = next((k for k in range(first, len(lines)) if _HEADER.match(lines[k])), len(lines))
        kept = [line for line in lines[first:last] if not _OWN.match(line)]
        opened = lines[found[0]].rstrip("\r\n") + end
        lines[found[0] : last] = [opened, *(line + end for line in new), *kept]
        written = "".join(lines)
        if _read(written) == _wanted(text, letter, axis):
            return written
    message = f"the axis {letter} has no table of its own in which a line can be replaced"
    hint = f"write [axis.{letter}], with direction, point and sign on a line each"
    raise UsageError.one("GX435", message, Location(file), hint)


def _wanted(text: str, letter: str, axis: Axis) -> dict[str, Any]:
    values = tomllib.loads(text)
    assert axis.direction is not None
    assert axis.point is not None
    stated = {"direction": [*axis.direction], "point": [*axis.point], "sign": axis.sign}
    values["axis"][letter].update(stated)
    return values


def _read(text: str) -> dict[str, Any] | None:
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        return None
