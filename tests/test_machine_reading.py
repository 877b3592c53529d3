"""What a machine file says of offsets, homes, tools and codes, wherever a program is read."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from cli_kit import call

import gcxform as gx
from gcxform.machine.file import load_machine
from gcxform.modal.interpreter import Interpreter
from gcxform.modal.reader import WindowReader
from gcxform.modal.state import Reading
from gcxform.plugin.registry import default_registry
from gcxform.resume.restart import _differences
from gcxform.toolpath.path import Toolpath

MACHINE = """format = 1
[axis.X]
max-speed = 6000.0
[axis.Y]
[axis.Z]
[work-offset.G54]
X = 100.0
[work-offset.G55]
X = 150.0
[home.G28]
X = 7.0
Y = 8.0
Z = 300.0
[tool.1]
length = 50.0
[control]
user-codes = "keep"
"""
HEAD = "G21 G90 G94 G17\nG0 X0 Y0 Z5\nG1 Z1 F100\n"  # three lines


def test_what_is_known_is_that_of_each_plan(tmp_path):
    """What one plan has worked out says nothing of a plan that was made of it."""
    file = tmp_path / "machine.toml"
    file.write_text(MACHINE)
    alone = gx.Pipeline.parse("absolute", "linuxcnc")
    assert (alone.machine_reading.work_offsets, alone._repeated) == ({}, 1)
    on_machine = replace(alone, machine=load_machine(file, default_registry().machines))
    assert on_machine.machine_reading.work_offsets.keys() == {"G54", "G55"}
    assert (replace(alone, passes=())._repeated, alone.machine_reading.work_offsets) == (2, {})


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("GCXFORM_PIPELINE", raising=False)
    (tmp_path / "m.toml").write_text(MACHINE)
    return tmp_path


def put(folder: Path, body: str, name: str = "p.nc") -> None:
    (folder / name).write_text(f"{HEAD}{body}M2\n")


@pytest.mark.parametrize(
    "words",
    [
        ["run", "-x", "absolute", "-f", "linuxcnc", "-o", "out.nc", "p.nc"],
        ["post", "-x", "absolute", "-f", "linuxcnc", "p.nc"],
        ["check", "-f", "linuxcnc", "p.nc"],
        ["info", "-f", "linuxcnc", "p.nc"],
        ["info", "p.nc"],
        ["compare", "-f", "linuxcnc", "p.nc", "p.nc"],
        ["explain", "-f", "linuxcnc", "p.nc:2"],
        ["resume", "-f", "linuxcnc", "--line", "4", "p.nc"],
    ],
)
@pytest.mark.parametrize(
    ("old", "new", "place"),
    [
        ("Z = 300.0", 'Z = "3 ft"', "m.toml:13:1: error[GX405]: Z: 'ft' is not a unit"),
        ("[tool.1]", "[tool.one]", "m.toml:14:1: error[GX437]: 'one' is not a tool number"),
    ],
)
def test_a_bad_machine_file(here: Path, words: list[str], old: str, new: str, place: str) -> None:
    put(here, "G91 X1\n")
    before = (here / "p.nc").read_bytes()
    (here / "m.toml").write_text(MACHINE.replace(old, new))
    found = call(*words, "-m", "m.toml")
    assert (found.exit_code, found.stdout) == (2, "")
    assert place in found.stderr
    assert (here / "p.nc").read_bytes() == before
    assert not (here / "out.nc").exists()
    assert "GX401" in call(*words, "-m", "none.toml").stderr


# --- codes of the machine's maker ---

USER = "M100 P1\nG0 X1 Y1 Z1\nG1 X2\n"


def test_check_and_info_keep_codes_of_the_machine(here: Path) -> None:
    put(here, USER)
    plain, kept = (call("check", "-f", "linuxcnc", *m, "p.nc") for m in ([], ["-m", "m.toml"]))
    assert (plain.exit_code, "p.nc:4:1: error[GX214]" in plain.stderr) == (1, True)
    assert (kept.exit_code, "no findings" in kept.stdout) == (0, True)
    words = ["info", "--json", "-f", "linuxcnc", "p.nc"]
    assert json.loads(call(*words).stdout)["refused"] == 1
    found = json.loads(call(*words, "-m", "m.toml").stdout)
    assert (found["refused"], found["events"]["M100"]) == (0, 1)
    after = call("explain", "-f", "linuxcnc", "-m", "m.toml", "p.nc:5").stdout
    assert "at    X? Y? Z?" in after


def test_no_restart_behind_a_code_of_the_machine(here: Path) -> None:
    """It may have switched anything; before it the restart is as safe as ever."""
    put(here, USER)
    words = ["resume", "-f", "linuxcnc", "--clearance", "50mm", "p.nc"]
    assert "p.nc:4:1: error[GX214]" in call(*words, "--line", "6").stderr
    for control in ("", "inert-m = [100]\n"):
        (here / "m.toml").write_text(MACHINE + control)
        found = call(*words, "--line", "6", "-m", "m.toml")
        assert (found.exit_code, found.stdout) == (3, "")
        assert "p.nc:6:1: error[GX732]" in found.stderr
        assert "in line 4 M100 switched something" in found.stderr
        before = call(*words, "--line", "4", "-m", "m.toml")
        assert (before.exit_code, before.stderr) == (0, "")  # proved to the end: M100 is read


# --- offsets, homes, tools ---


PLACES = [
    ("G55\n", "X? Y? Z?", "X-50 Y0 Z1"),
    ("G28 Z20\n", "X0 Y0 Z?", "X0 Y0 Z300"),
    ("G43 H1\n", "X0 Y0 Z?", "X0 Y0 Z-49"),
]


@pytest.mark.parametrize(("block", "unknown", "known"), PLACES)
def test_where_axes_stand(here: Path, block: str, unknown: str, known: str) -> None:
    put(here, f"{block}X1\n")
    words = ["explain", "-f", "linuxcnc", "p.nc:5"]
    assert f"at    {unknown}" in call(*words).stdout
    assert f"at    {known}" in call(*words, "-m", "m.toml").stdout


@pytest.mark.parametrize(("block", "unknown", "known"), PLACES)
@pytest.mark.parametrize("approach", [[], ["--clearance", "500mm"]])
def test_restart_where_axes_stand(
    here: Path, approach: list[str], block: str, unknown: str, known: str
) -> None:
    """The machine file makes the restart safe; the first move after it begins in a new frame."""
    put(here, f"{block}X1\nY2 Z3\n")
    words = ["resume", "-f", "linuxcnc", "--line", "5", *approach, "p.nc"]
    assert "GX732" in call(*words).stderr
    found = call(*words, "-m", "m.toml")
    assert (found.exit_code, found.stderr) == (0, "")
    x, y, z = known.split()
    if approach:
        assert f"G0 {x}. {y}.\nG1 {z}. F100\n" in found.stdout
    else:
        assert f"(THE AXES MUST STAND AT {x}. {y}. {z}.)" in found.stdout


def test_info_counts_from_the_first_offset(here: Path) -> None:
    put(here, "G55\nG1 X10\nG43 H1\nZ2\nG28\n")
    words = ["info", "--json", "-f", "linuxcnc", "p.nc"]
    plain, known = (json.loads(call(*words, *m).stdout) for m in ([], ["-m", "m.toml"]))
    assert (plain["extents"]["X"], plain["extents"]["Z"]) == ([0, 10], [1, 5])
    assert (known["extents"]["X"], known["extents"]["Z"]) == ([-93, 60], [1, 300])
    assert known["length_mm"]["feed"] == pytest.approx(4 + 60 + 51)


@pytest.mark.parametrize(
    ("body", "same_place"),
    [
        ("G55\nG1 X10 Y0 Z1\n", "G54\nG1 X60 Y0 Z1\n"),
        ("G43 H1\nG1 X10 Y0 Z1\n", "G43.1 Z20\nG1 X10 Y0 Z31\n"),
        ("G28\nG1 X10 Y0 Z1\n", "G0 X-93 Y8 Z300\nG1 X10 Y0 Z1\n"),
    ],
)
def test_compare_knows_where_moves_go(here: Path, body: str, same_place: str) -> None:
    """The events differ, as they should; the paths are the same on this machine alone."""
    put(here, body, "a.nc")
    put(here, same_place, "b.nc")
    words = ["compare", "-f", "linuxcnc", "a.nc", "b.nc"]
    alone = call(*words).stdout
    assert alone.endswith("DIFFERENT\n")
    assert "largest deviation 0.000000 mm" not in alone or "not compared there" in alone
    found = call(*words, "-m", "m.toml").stdout
    assert "largest deviation 0.000000 mm" in found
    assert "feeds: the same" in found


# --- the comparison behind a restart ---


def path_of(text: bytes, window: int = 0) -> Toolpath:
    """Return the path of a program from a line on, from 0, read after what is before it."""
    kind = default_registry().dialect("linuxcnc")
    reading = Reading(work_offsets={"G54": {}, "G55": {}})
    reader, interpreter = WindowReader(kind), Interpreter(kind, reading, "XYZ", "-")
    lines = text.splitlines(keepends=True)
    if window:
        interpreter.interpret(reader.read(b"".join(lines[:window])), reader.table)
    return interpreter.interpret(reader.read(b"".join(lines[window:])), reader.table).path


def test_frames_are_compared_and_not_their_numbers() -> None:
    """G55 is at the same place as G54 here, so that nothing but the frame tells them apart."""
    one = path_of(b"G0 G55 X0 Y0 Z0\nG1 X1 F100\n", 1)
    same = path_of(b"G0 G54 X0 Y0 Z0\nG55 G1 X1 F100\n", 1)
    other = path_of(b"G0 G55 X0 Y0 Z0\nG54 G1 X1 F100\n", 1)
    assert one.frame.tolist() != same.frame.tolist()
    assert np.array_equal(one.end, other.end)
    assert list(_differences(one, same.replace(events=one.events))) == []
    assert list(_differences(one, other.replace(events=one.events))) == [2]
