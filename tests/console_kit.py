"""Do the commands that a page shows print what it shows?"""

from __future__ import annotations

import contextlib
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

from cli_kit import call

LAST_EXIT_CODE = 5  # of those that are documented
SHELL = {"|", "||", "&", "&&", ";", "<", ">", ">>"}  # between words: a shell has to be asked
EXPANDED = {"$", "*", "`"}


def check_console(page: Path, folder: Path) -> int:
    """Run the commands of the console blocks of a page in a folder; return how many there were."""
    blocks = re.findall(r"```console\n(.*?)```", page.read_text("utf-8"), re.DOTALL)
    return sum(check_block(block, folder) for block in blocks)


def check_block(block: str, folder: Path) -> int:
    """Run the commands of a console block in a folder; return how many there are.

    A line of three dots stands for any lines, and times are left out.
    """
    shown = commands(block)
    for command, expected in shown:
        printed, code = _run(command, folder)
        lines = _timeless(expected).splitlines()
        pattern = "".join(r"(?:.*\n)*?" if s == "..." else re.escape(s) + "\n" for s in lines)
        assert re.fullmatch(pattern, _timeless(printed)), f"{command}\n{printed}"
        assert code <= LAST_EXIT_CODE, command
    return len(shown)


def commands(block: str) -> list[tuple[str, str]]:
    """Return the commands of a console block, each with what it prints."""
    parts = re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]
    pairs = (part.partition("\n") for part in parts)
    return [(command, printed) for command, _, printed in pairs]


def _run(command: str, folder: Path) -> tuple[str, int]:
    """Run a command; return what it prints, and its exit code.

    gcxform by itself is called in this process: starting one takes longer than most of its work.
    """
    words = shlex.shlex(command, posix=True, punctuation_chars=True)
    words.whitespace_split = True
    first, *rest = words
    if first == "gcxform" and not (SHELL & {*rest} or EXPANDED & {*command}):
        with contextlib.chdir(folder):
            done = call(*rest)
        return done.output, done.exit_code
    return _shell(command, folder)


def _shell(command: str, folder: Path) -> tuple[str, int]:
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        ["bash", "-c", command],
        cwd=folder,
        env={**os.environ, "PATH": path},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=60,
        check=False,
    )
    return done.stdout, done.returncode


def _timeless(text: str) -> str:
    return re.sub(r"\d+\.\d\d s$", "T s", text, flags=re.MULTILINE)
