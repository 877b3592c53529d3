"""Senders read what gcxform writes: every line, and moves end where they should.

bCNC is that of Debian; of CNCjs it is the package of npm by which it draws a program.
"""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
import stamp_kit

import gcxform as gx
from gcxform.system.arrays import Floats

PYTHON = Path("/usr/bin/python3")
BCNC = Path("/usr/share/bcnc/bCNC/CNC.py")
HERE = Path(__file__).parent
PART = b"""G21 G90 G17 G54 G94
G0 X0 Y0 Z5
M3 S8000
G1 Z-1 F200
G1 X40 F600
G3 X50 Y10 I0 J10
G91
G1 Y20
G90
G2 X40 Y40 I-10 J0
G1 X0 Y0
G0 Z5
M5
M2
"""
CHAINS = (
    "absolute",
    "segment chord-error=5um",
    "segment chord-error=5um | volumetric model=model.toml part-origin=0,0,0",
)


@pytest.mark.parametrize("chain", CHAINS)
def test_bcnc_goes_where_the_program_goes(chain: str, tmp_path: Path) -> None:
    if not (PYTHON.exists() and BCNC.exists()):
        pytest.skip("bcnc is not installed: no program is read by it")
    (tmp_path / "model.toml").write_text(stamp_kit.MODEL)
    done = stamp_kit.pipeline(chain, tmp_path, "grbl").run(PART)
    (tmp_path / "part.nc").write_bytes(done.text)
    words = [str(PYTHON), str(HERE / "bcnc_reads.py"), str(tmp_path / "part.nc")]
    said = subprocess.run(words, capture_output=True, cwd=tmp_path, env={}, check=False)
    found = json.loads(said.stdout)
    assert found["loaded"]
    assert found["lines"] == done.text.decode().splitlines()
    agree(done.text, found["ends"])


@pytest.mark.parametrize("chain", CHAINS)
def test_cncjs_draws_where_the_program_goes(chain: str, tmp_path: Path) -> None:
    """The package is looked for where Node does so: NODE_PATH names a folder `node_modules`."""
    (tmp_path / "model.toml").write_text(stamp_kit.MODEL)
    done = stamp_kit.pipeline(chain, tmp_path, "grbl").run(PART)
    (tmp_path / "part.nc").write_bytes(done.text)
    words = ["node", str(HERE / "cncjs_reads.js"), str(tmp_path / "part.nc")]
    node = shutil.which("node")
    said = subprocess.run(words, capture_output=True, check=False) if node else None
    if said is None or b"Cannot find module 'gcode-toolpath'" in said.stderr:
        pytest.skip("gcode-toolpath is not installed: no program is drawn by what CNCjs has")
    found = json.loads(said.stdout)
    assert found["lines"] == len(done.text.splitlines())
    agree(done.text, found["ends"])


def agree(program: bytes, ends: list[list[float]]) -> None:
    """Hold ends of moves, as somebody else sees them, to those of a program."""
    path = gx.read(program, "grbl").path
    ours = corners(path.end[np.isfinite(path.end[:, :3]).all(axis=1), :3])
    theirs = corners(np.array(ends))
    assert theirs.shape == ours.shape
    assert np.abs(theirs - ours).max() < 1e-6


def corners(ends: Floats) -> Floats:
    """Return ends of moves without those that go nowhere: bCNC has one for G91 alone."""
    return ends[np.r_[True, np.abs(np.diff(ends, axis=0)).max(axis=1) > 0]]
