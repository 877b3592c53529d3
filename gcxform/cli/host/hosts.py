"""The hosts, and the text that each one is to be given, with the command in it as it calls it.

A text lies beside this module, one file for each host. In it stand the command in the quotes of the
host's shell, and marks for what differs from place to place:

| mark | what stands there |
|---|---|
| `{sh:WORDS}` | gcxform and its words, quoted for a POSIX shell |
| `{win:WORDS}` | the same, quoted as programs of Windows take words |
| `{exe}` | gcxform's own file alone |
| `{words:WORDS}` | the words alone, quoted as programs of Windows take them |

`PIPELINE` among the words is the pipeline file, `FILE` and its like stay as they stand.
"""

from __future__ import annotations

import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Final

from gcxform.diagnostics import UsageError

MARK: Final = re.compile(r"\{(exe|sh|win|words)(?::([^{}]*))?\}")
PIPELINE: Final = "PIPELINE"


@dataclass(frozen=True)
class Host:
    """A program that calls gcxform.

    `dialect` is the one that it executes, where it is only one; `line` is how long a line of its
    settings may be, for one that cuts longer ones off without a word.
    """

    title: str
    dialect: str = ""
    line: int = 10_000


HOSTS: Final = {
    "linuxcnc": Host(
        "LinuxCNC: AXIS, QtVCP, Gmoccapy, by [FILTER] of the INI file", "linuxcnc", 255
    ),
}


def text_of(name: str, pipeline: Path) -> str:
    """Return what a host is to be given, for a pipeline file. Raises UsageError."""
    text = files("gcxform.cli.host").joinpath("texts", f"{name}.txt").read_text("utf-8")
    said = filled(text, program(), pipeline)
    longest = max(map(len, said.splitlines()))
    if longest > HOSTS[name].line:
        raise UsageError.one(
            "GX739",
            f"a line for {name} has {longest} characters, and it reads {HOSTS[name].line} of them",
            hint="give the pipeline file a shorter path, such as that of a link to it",
        )
    return said


def filled(text: str, command: list[str], pipeline: Path) -> str:
    """Return a text with the words of a command in the place of its marks."""

    def fill(mark: re.Match[str]) -> str:
        kind, words = mark[1], (mark[2] or "").split()
        said = [str(pipeline) if word == PIPELINE else word for word in words]
        return {"exe": " ".join(command[:1])}.get(kind) or _JOINED[kind](
            said if kind == "words" else [*command, *said]
        )

    return MARK.sub(fill, text)


def program() -> list[str]:
    """Return the words that start gcxform from anywhere: of what runs now, not of the PATH."""
    beside = shutil.which("gcxform", path=str(Path(sys.executable).parent))
    return [beside] if beside else [sys.executable, "-m", "gcxform.cli"]


_JOINED: Final[dict[str, Callable[[Iterable[str]], str]]] = {
    "sh": shlex.join,
    "win": lambda words: subprocess.list2cmdline([*words]),
    "words": lambda words: subprocess.list2cmdline([*words]),
}
