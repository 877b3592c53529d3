"""INI files of LinuxCNC: what they say of programs. All of it was asked of `rs274 -i`.

| `[DISPLAY] PROGRAM_PREFIX`, `[RS274NGC] SUBROUTINE_PATH` | folders of subprograms, as its own |
| any key of a section, in capitals, with a plain number   | what `#<_ini[section]key>` is worth |

Of two sections of one name, and of two keys in one section, the first one counts. A folder that is
not there is passed over. What PARAMETER_FILE holds is not taken: each program that ran since may
have left something else in it. `#INCLUDE` is refused, and what remaps a code is not taken over.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from pathlib import Path

import gcxform as gx
from gcxform.vocabulary import ProgramSettings, control_lines, referred

_SECTION = re.compile(r"[ \t]*\[([^\]]*)\]")
_VALUE = re.compile(r"[ \t]*([^=#;\[\s][^=]*?)[ \t]*=[ \t]*(.*?)[ \t\r]*")
_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_FOLDERS = (("DISPLAY", "PROGRAM_PREFIX"), ("RS274NGC", "SUBROUTINE_PATH"))


def read_ini(path: Path) -> ProgramSettings:
    """Return the folders of subprograms, and the values that programs read.

    Raises FileError, and UsageError for a file that is included, or a folder elsewhere.
    """
    values: dict[tuple[str, str], gx.Location] = {}
    texts: dict[tuple[str, str], str] = {}
    for section, key, text, where in _values(path):
        values.setdefault((section, key), where)
        texts.setdefault((section, key), text)
    folders = [path.parent]
    for at in _FOLDERS:
        for name in filter(None, texts.get(at, "").split(":")):
            folder = referred(path.parent, name, values[at])
            folders += [folder] if os.path.isdir(folder) else []
    parameters = {
        f"<_ini[{section.lower()}]{key.lower()}>": float(text)
        for (section, key), text in texts.items()
        if section == section.upper() and key == key.upper() and _NUMBER.fullmatch(text)
    }
    return ProgramSettings(tuple(folders), parameters)


def _values(path: Path) -> Iterator[tuple[str, str, str, gx.Location]]:
    """Yield section, key and text of each line that counts, with its place."""
    section, seen = "", set[str]()
    for where in control_lines(path):
        if where.text.lstrip().upper().startswith("#INCLUDE"):
            message = "#INCLUDE is not followed: what the other file says is not known"
            raise gx.UsageError.one("GX454", message, where, "put its lines into this file")
        if begins := _SECTION.match(where.text):
            section = "" if begins[1] in seen else begins[1]
            seen.add(begins[1])
        elif section and (found := _VALUE.fullmatch(where.text)):
            yield section, found[1], found[2], where
