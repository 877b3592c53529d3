"""PrusaSlicer calls `gcxform post` as a script; what comes out extrudes what was sliced."""

from __future__ import annotations

from pathlib import Path

import boat
import numpy as np
import pytest
import stamp_kit
from cli_kit import call
from seeds_kit import LONG
from slicer_kit import printed, sliced

PIPELINE = """format = 1
[input]
dialect = "marlin"
[machine]
file = "printer.toml"
[[pass]]
use = "segment"
chord-error = "5 um"
max-length = "5 mm"
[[pass]]
use = "volumetric"
model = "model.toml"
"""
PRINTER = """format = 1
[axis.X]
[axis.Y]
[axis.Z]
[home.G28]
X = 0.0
Y = 0.0
Z = 0.0
[work-offset.G54]
X = 0.0
Y = 0.0
Z = 0.0
"""
WAYS = {
    "absolute": (),
    "distances": ("--use-relative-e-distances", "--before-layer-gcode", "G92 E0"),
}


@pytest.fixture
def shop(tmp_path: Path) -> Path:
    """Return a folder with a blank and a quote in its name."""
    folder = tmp_path / "Anna's prints"
    folder.mkdir()
    (folder / "my printer.toml").write_text(PIPELINE)
    (folder / "printer.toml").write_text(PRINTER)
    (folder / "model.toml").write_text(stamp_kit.MODEL.replace("0.2]", "1.0]"))
    return folder


def script_of(folder: Path) -> str:
    """Return the line that the slicer is to be given."""
    said = call("hosts", "prusaslicer", "-p", str(folder / "my printer.toml"))
    assert said.exit_code == 0, said.output
    return said.stdout.splitlines()[-1]


def moves(text: str) -> list[str]:
    """Return the lines that are no comments: those have the date and the settings."""
    return [line for line in text.splitlines() if line[:1] not in ("", ";")]


@pytest.mark.parametrize("way", WAYS)
def test_the_slicer_calls_a_script(way: str, shop: Path) -> None:
    """Filament is fed as sliced, and as far along; corners are where the machine has to be sent."""
    plain = sliced(shop, "plain.gcode", *WAYS[way])
    done = sliced(shop, "done it.gcode", *WAYS[way], "--post-process", script_of(shop))
    assert (plain.returncode, done.returncode) == (0, 0), done.stderr
    before, after = ((shop / name).read_text() for name in ("plain.gcode", "done it.gcode"))
    wanted = call("run", "-q", "-p", str(shop / "my printer.toml"), str(shop / "plain.gcode"))
    assert moves(wanted.stdout) == moves(after)
    was, now = printed(before), printed(after)
    assert len(now.corners) > len(was.corners) > 100
    assert now.fed == pytest.approx(was.fed, abs=1e-3)
    sent = np.array(was.corners)
    sent[:, 0] /= 1 + 1e-3  # the axis goes 1 um further for each mm
    for corner, fed in zip(sent, was.feeds, strict=True):
        k = int(np.argmin(np.abs(np.array(now.feeds) - fed)))
        assert np.abs(np.array(now.corners[k]) - corner).max() < 2e-3, corner


def test_a_boat_sliced_with_post_as_its_script(shop: Path) -> None:
    """Each corner lies where the machine has to be sent, at the filament that was fed by then.

    Two runs of the slicer differ by some micrometres, so the script keeps what it was given.
    """
    keeping = shop / "keeping.sh"
    keeping.write_text(f'#!/bin/sh\ncp "$1" "{shop}/plain.gcode"\nexec {script_of(shop)} "$1"\n')
    keeping.chmod(0o755)
    script = ("--post-process", str(keeping).replace(" ", "\\ ").replace("'", "\\'"))
    fine = ("--layer-height", "0.1" if LONG else "0.3")
    done = sliced(shop, "boat.gcode", *fine, *script, model=boat.boat())
    assert done.returncode == 0, done.stderr
    before, after = ((shop / name).read_text() for name in ("plain.gcode", "boat.gcode"))
    assert ("GCXFORM STAMP" in before, "GCXFORM STAMP" in after) == (False, True)
    was, now = printed(before), printed(after)
    assert len(was.corners) > 2000
    assert now.fed == pytest.approx(was.fed, abs=1e-3)
    sent = np.array(was.corners) / [1 + 1e-3, 1.0]
    feeds, corners = np.array(now.feeds), np.array(now.corners)
    near = np.searchsorted(feeds, np.array(was.feeds) - 1e-4)
    found = [corners[np.minimum(near + k, len(feeds) - 1)] for k in range(4)]
    off = np.min([np.abs(each - sent).max(axis=1) for each in found], axis=0)
    assert off.max() < 2e-3


def test_a_program_that_was_done_stays(shop: Path) -> None:
    (shop / "a.gcode").write_text("G90\nM82\nG28\nG92 E0\nG1 X50 Y10 Z1 F1200\nG1 X60 E1\n")
    assert call("post", "-p", str(shop / "my printer.toml"), str(shop / "a.gcode")).exit_code == 0
    once = (shop / "a.gcode").read_text()
    assert ";GCXFORM STAMP" in once
    assert call("post", "-p", str(shop / "my printer.toml"), str(shop / "a.gcode")).exit_code == 0
    assert (shop / "a.gcode").read_text() == once


def test_what_is_refused_fails_the_export(shop: Path) -> None:
    """The slicer shows why; the file that it leaves is as it was sliced."""
    (shop / "printer.toml").write_text(PRINTER.replace("[home.G28]\nX = 0.0\n", "[home.G28]\n"))
    done = sliced(shop, "bad.gcode", "--post-process", script_of(shop))
    assert done.returncode != 0
    assert "GX311" in done.stdout + done.stderr
    assert "GCXFORM" not in (shop / "bad.gcode").read_text()
