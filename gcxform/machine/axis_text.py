"""A machine file with another direction, point and sign of one axis; the rest keeps its bytes.

However the file spells the axis, only the values of these keys are replaced. Above the first of
them stand the comments of a calibration, which begin with `# calibrated:`, in place of those of an
earlier one. What comes out is read again: it has to be what was read before, but for these values.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Mapping
from typing import Any, Final

from gcxform.config.toml_text import locate_key
from gcxform.diagnostics import Location, UsageError
from gcxform.machine.machine import Axis
from gcxform.machine.text import axis_lines

MARK: Final = "# calibrated:"
_BYTE_ORDER_MARK: Final = "\ufeff"


def with_axis(text: str, letter: str, axis: Axis, comments: Iterable[str], file: str) -> str:
    """Return the text of a machine file with the direction, point and sign of an axis.

    `comments` are put above them. Raises UsageError (GX435) if what comes out would not read as
    what went in with these three values.
    """
    stated = tomllib.loads("\n".join(axis_lines(axis)))
    plain = text.removeprefix(_BYTE_ORDER_MARK)
    wanted = tomllib.loads(plain)
    wanted["axis"][letter].update(stated)
    written = _with_comments(_with_values(plain, letter, stated), letter, stated, comments)
    if "\n" not in plain.replace("\r\n", ""):
        written = re.sub("(?<!\r)\n", "\r\n", written)
    if tomllib.loads(written) != wanted:
        message = f"the axis {letter} is spelled in a way in which its values cannot be replaced"
        hint = f"write [axis.{letter}], with direction, point and sign on a line each"
        raise UsageError.one("GX435", message, Location(file), hint)
    return text[: len(text) - len(plain)] + written


def _with_values(text: str, letter: str, stated: Mapping[str, Any]) -> str:
    """Return the text with the values of an axis; new keys stand first in a table of its own."""
    import tomlkit

    lines = text.split("\n")
    line, column = locate_key(text, ("axis", letter))
    if lines[line - 1][column - 1] == "[":
        known = tomllib.loads(text)["axis"][letter]
        lines[line:line] = [f"{key} = 0" for key in stated if key not in known]
    document: Any = tomlkit.parse("\n".join(lines))
    document["axis"][letter].update(stated)
    return tomlkit.dumps(document)


def _with_comments(text: str, letter: str, keys: Iterable[str], comments: Iterable[str]) -> str:
    """Return the text with comments above the first key of an axis, the older ones left out."""
    lines = text.split("\n")
    first = min(locate_key(text, ("axis", letter, key))[0] for key in keys) - 1
    old = first
    while old and lines[old - 1].lstrip().startswith(MARK):
        old -= 1
    lines[old:first] = [f"{MARK} {comment}" for comment in comments]
    return "\n".join(lines)
