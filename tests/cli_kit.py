"""What the tests of the command line share: a place to work in, and ways to call it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner, Result

from gcxform.cli import verbs

PART = b"(PART)\r\nG90 G21 G17\r\nG1 F100 X0 Y0 Z0\r\nG91 X10 Y5\r\nG90 X0\r\nM30\r\n"
ABSOLUTE = PART.replace(b"G91 X10 Y5", b"G90 X10. Y5.")
MODEL = """format = 1
kind = "axis-functions"
values = "error"
convention = "relative"
order = "XYZ"
[X]
position = [0.0, 50.0, 100.0]
EXX = [0.0, 0.02, 0.0]
EYX = [0.0, 0.0, 0.0]
EZX = [0.0, 0.0, 0.0]
"""
PIPELINE = """format = 1
[input]
dialect = "linuxcnc"
[[pass]]
use = "absolute"
"""
COMPENSATED = "absolute | volumetric model=model.toml part-origin=10,10,10 outside=extrapolate"


def workplace(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Go to a folder with a program, a pipeline and an error model."""
    monkeypatch.chdir(folder)
    monkeypatch.delenv("GCXFORM_PIPELINE", raising=False)
    (folder / "part.nc").write_bytes(PART)
    (folder / "job.toml").write_text(PIPELINE)
    (folder / "model.toml").write_text(MODEL)
    return folder


def call(*words: str, stdin: bytes | None = None) -> Result:
    return CliRunner().invoke(verbs, words, input=stdin, prog_name="gcxform")


def process(*words: str, **options: Any) -> subprocess.CompletedProcess[bytes]:
    command = [sys.executable, "-W", "error", "-m", "gcxform.cli", *words]
    options = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "timeout": 60} | options
    found: Any = subprocess.run(command, check=False, **options)
    return found  # type: ignore[no-any-return]


def expanded(runs: list[list[int]]) -> list[int]:
    """Return the source lines, from 0, that a map's runs stand for."""
    found: list[int] = []
    for output, source, count, step in runs:
        assert output == len(found) + 1
        found += [source - 1 + step * k for k in range(count)]
    return found
