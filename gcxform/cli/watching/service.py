"""What a system needs to run `gcxform watch` by itself: a unit of systemd, a task of Windows.

The texts are files beside this module. The command is the one that runs now, by its whole path.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Sequence
from importlib.resources import files
from typing import Final
from xml.sax.saxutils import escape

from gcxform.diagnostics import UsageError

FILES: Final = {"systemd": "gcxform-watch.service", "windows": "gcxform-watch.xml"}
COMMAND: Final = (os.path.abspath(sys.executable), "-m", "gcxform.cli")
CONTROLS: Final = "".join(map(chr, range(32)))


def text_of(system: str, words: Sequence[str], folder: str) -> str:
    """Return the file for a system that runs the verb with some words, from the current folder.

    Raises UsageError for words that a file of text cannot hold.
    """
    here = os.getcwd()
    for word in (*words, folder, here):
        if any(c in CONTROLS for c in word) or not _is_text(word):
            message = f"{word!a} cannot stand in a file for {system}"
            raise UsageError.one("GX706", message, hint="give the folder another name")
    text = (files("gcxform.cli.watching") / FILES[system]).read_text("utf-8")
    for name, value in PARTS[system](words, folder, here).items():
        text = text.replace(f"{{{name}}}", value)
    return text


def _systemd(words: Sequence[str], folder: str, here: str) -> dict[str, str]:
    command = " ".join(map(_for_systemd, (*COMMAND, *words)))
    plain = {"folder": os.path.abspath(folder), "here": here}
    return {"command": command, **{name: text.replace("%", "%%") for name, text in plain.items()}}


def _for_systemd(word: str) -> str:
    """Return a word as systemd takes it: in quotes, its own signs doubled."""
    for sign, written in (("\\", "\\\\"), ('"', '\\"'), ("%", "%%"), ("$", "$$")):
        word = word.replace(sign, written)
    return f'"{word}"'


def _windows(words: Sequence[str], folder: str, here: str) -> dict[str, str]:
    rest = subprocess.list2cmdline([*COMMAND[1:], *words])
    told = {"program": COMMAND[0], "arguments": rest, "folder": os.path.abspath(folder)}
    return {name: escape(text) for name, text in {**told, "here": here}.items()}


def _is_text(word: str) -> bool:
    try:
        word.encode()
    except UnicodeEncodeError:
        return False
    return True


PARTS: Final[dict[str, Callable[[Sequence[str], str, str], dict[str, str]]]] = {
    "systemd": _systemd,
    "windows": _windows,
}
