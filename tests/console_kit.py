"""Do the commands that a page shows print what it shows?"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

LAST_EXIT_CODE = 5  # of those that are documented


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
        done = _run(command, folder)
        lines = _timeless(expected).splitlines()
        pattern = "".join(r"(?:.*\n)*?" if s == "..." else re.escape(s) + "\n" for s in lines)
        assert re.fullmatch(pattern, _timeless(done.stdout)), f"{command}\n{done.stdout}"
        assert done.returncode <= LAST_EXIT_CODE, command
    return len(shown)


def commands(block: str) -> list[tuple[str, str]]:
    """Return the commands of a console block, each with what it prints."""
    parts = re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]
    pairs = (part.partition("\n") for part in parts)
    return [(command, printed) for command, _, printed in pairs]


def _run(command: str, folder: Path) -> subprocess.CompletedProcess[str]:
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    return subprocess.run(
        ["bash", "-c", command],
        cwd=folder,
        env={**os.environ, "PATH": path},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=60,
        check=False,
    )


def _timeless(text: str) -> str:
    return re.sub(r"\d+\.\d\d s$", "T s", text, flags=re.MULTILINE)
