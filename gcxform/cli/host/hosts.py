"""The hosts, and the text that each one is to be given, with the command in it as it calls it.

A text lies beside this module, one file for each host. A mark in it stands for the command:
`{call:WORDS}` for gcxform and its words in the quotes of this system, a POSIX shell or Windows;
`{tcl:WORDS}` for the same as a list of Tcl; `{exe}` for the program alone and `{args:WORDS}` for
what follows it, both as they stand in a text of JavaScript, which is that of JSON; `{ini:WORDS}`
for the program in one line and what follows in the next.
`PIPELINE` among the words is the pipeline file; FILE and its like stay as they stand.
"""

from __future__ import annotations

import json
import os
import re
import shlex
import shutil
import subprocess
import sys
from importlib.resources import files
from pathlib import Path
from typing import Final

from gcxform.diagnostics import UsageError
from gcxform.values import dataclass

MARK: Final = re.compile(r"\{(call|tcl|exe|args|ini):?([^{}]*)\}")
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
    "freecad": Host("FreeCAD: a post processor that runs another one, and then gcxform"),
    "fusion": Host("Fusion, HSMWorks, Inventor CAM: lines for a post (.cps)"),
    "nx": Host("NX: lines for a post (Tcl)"),
    "prusaslicer": Host("PrusaSlicer, SuperSlicer, OrcaSlicer: a post-processing script"),
    "vectric": Host("VCarve, Aspire, Cut2D: direct output of a post (.pp)"),
}


MACROS: Final = {
    "win32": ("APPDATA", "FreeCAD", "Macro"),
    "darwin": ("HOME", "Library", "Application Support", "FreeCAD", "Macro"),
    "linux": ("HOME", ".local", "share", "FreeCAD", "Macro"),
}
"""Where FreeCAD looks for post processors of a user: a variable, and folders below it."""


def freecad_post(pipeline: Path) -> str:
    """Return the module for FreeCAD, with where gcxform and a pipeline file are."""
    text = files("gcxform.cli.host").joinpath("freecad_post.py").read_text("utf-8")
    text = text.replace('GCXFORM = ["gcxform"]', f"GCXFORM = {program()!r}")
    return text.replace('PIPELINE = ""', f"PIPELINE = {str(pipeline)!r}")


def place_of_post() -> Path:
    """Return where the module for FreeCAD belongs."""
    variable, *folders = MACROS.get(sys.platform, MACROS["linux"])
    return Path(os.environ.get(variable, Path.home()), *folders, "gcxform_post.py")


def text_of(name: str, pipeline: Path) -> str:
    """Return what a host is to be given, for a pipeline file. Raises UsageError."""
    if name == "freecad":
        return freecad_post(pipeline)
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
        said = [str(pipeline) if word == PIPELINE else word for word in mark[2].split()]
        words = [*command, *said]
        match mark[1]:
            case "tcl":
                return " ".join(f"{{{word}}}" for word in words)
            case "exe":
                return json.dumps(words[0])
            case "args":
                return json.dumps(quoted(words[1:]))
            case "ini":
                return f"{words[0]}\n{quoted(words[1:])}"
        return quoted(words)

    return MARK.sub(fill, text)


def quoted(words: list[str]) -> str:
    """Return words as one line of this system's shell."""
    return subprocess.list2cmdline(words) if os.name == "nt" else shlex.join(words)


def program() -> list[str]:
    """Return the words that start gcxform from anywhere: of what runs now, not of the PATH."""
    beside = shutil.which("gcxform", path=str(Path(sys.executable).parent))
    return [beside] if beside else [sys.executable, "-m", "gcxform.cli"]
