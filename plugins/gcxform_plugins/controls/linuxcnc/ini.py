"""INI files of LinuxCNC: what they say of programs. All of it was asked of `rs274 -i`.

| `[DISPLAY] PROGRAM_PREFIX`, `[RS274NGC] SUBROUTINE_PATH` | folders of subprograms, as its own |
| any key of a section, in capitals, with a plain number   | what `#<_ini[section]key>` is worth |
| `[RS274NGC] REMAP` of M0, M1, M6, M60, M61               | runs a program: refused in programs |
| `[EMCIO] TOOL_CHANGE_POSITION`, `..._AT_G30`, `..._QUILL_UP` | M6 moves axes |

Of two sections of one name, and of two keys in one section, the first one counts. A folder that is
not there is passed over. What PARAMETER_FILE holds is not taken: each program that ran since may
have left something else in it. `#INCLUDE` is refused, and so are a REMAP of T, S or F, and codes at
the start (`RS274NGC_STARTUP_CODE`) that are not in force without them.
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
_REMAPPED = re.compile(r"([A-Z])([0-9.]*)(?:[ \t].*)?", re.IGNORECASE)
_STARTUP = re.compile(r"([A-Z])[ \t]*([-+0-9.]*)[ \t]*", re.IGNORECASE)
# fmt: off
_IN_FORCE = frozenset((
    "G8", "G17", "G21", "G40", "G49", "G54", "G64", "G69", "G80", "G90", "G91.1", "G92.1", "G94",
    "G97", "G99", "M5", "M9", "M48",
))
# fmt: on
_CHANGES = ("TOOL_CHANGE_POSITION", "TOOL_CHANGE_AT_G30", "TOOL_CHANGE_QUILL_UP")
_FOLDERS = (("DISPLAY", "PROGRAM_PREFIX"), ("RS274NGC", "SUBROUTINE_PATH"))


def read_ini(path: Path) -> ProgramSettings:
    """Return the folders of subprograms, and the values that programs read.

    Raises FileError, and UsageError for a file that is included, a folder elsewhere, words that run
    programs, and other modes at the start.
    """
    codes: dict[str, str] = {}
    values: dict[tuple[str, str], gx.Location] = {}
    texts: dict[tuple[str, str], str] = {}
    for section, key, text, where in _values(path):
        if (section, key) == ("RS274NGC", "REMAP"):
            codes |= _remapped(text, where)
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
    start = ("RS274NGC", "RS274NGC_STARTUP_CODE")
    if start in texts:
        _check_start(texts[start], values[start])
    if any(texts.get(("EMCIO", key), "0") != "0" for key in _CHANGES):
        codes = {"M6": "moves"} | codes
    return ProgramSettings(tuple(folders), parameters, codes)


def _remapped(text: str, where: gx.Location) -> dict[str, str]:
    """Return the code that runs a program; those that the control has not are none of a program."""
    found = _REMAPPED.fullmatch(text)
    letter, number = (found[1].upper(), found[2]) if found else ("", "")
    if letter in ("G", "M"):
        return {f"M{int(number)}": "program"} if letter == "M" and number.isdigit() else {}
    message = f"REMAP={text.split(' ')[0]}: a word that runs a program is not followed"
    raise gx.UsageError.one("GX454", message, where)


def _check_start(text: str, where: gx.Location) -> None:
    """Refuse codes that are in force before the first block, and that programs do not say."""
    for letter, number in _STARTUP.findall(text):
        code = f"{letter.upper()}{float(number):g}" if number else ""
        if letter.upper() in "GM" and code not in _IN_FORCE:
            message = f"RS274NGC_STARTUP_CODE: {code} at the start of programs is not followed"
            hint = "take it out of a copy of the file, if all programs say what they need"
            raise gx.UsageError.one("GX454", message, where, hint)


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
