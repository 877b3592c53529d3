"""Do the commands that a page shows print what it shows?"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

from test_docs import _timeless, commands


def check_console(page: Path, folder: Path) -> int:
    """Run the commands of the console blocks of a page in a folder; return how many there were.

    A line of three dots stands for any lines, and times are left out.
    """
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    blocks = re.findall(r"```console\n(.*?)```", page.read_text("utf-8"), re.DOTALL)
    shown = [pair for block in blocks for pair in commands(block)]
    for command, expected in shown:
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
        lines = _timeless(expected).splitlines()
        pattern = "".join(r"(?:.*\n)*?" if s == "..." else re.escape(s) + "\n" for s in lines)
        assert re.fullmatch(pattern, _timeless(done.stdout)), f"{command}\n{done.stdout}"
    return len(shown)
