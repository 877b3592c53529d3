"""`gcxform machine jog` and `draw`: what is said of the axes is what they do."""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from cli_kit import call
from kinematics_kit import PRESETS, preset, skewed, tool

from gcxform.machine.chain import Chain, Rotary
from gcxform.machine.jog import WAYS, jog_test

SVG = "{http://www.w3.org/2000/svg}"
MILL = """format = 1
name = "trunnion mill"
kinematics = "ac-trunnion"
[axis.A]
point = [5.0, -32.0, -95.0]
[axis.C]
point = [5.0, -20.0, -60.0]
[tool.1]
length = 120.0
"""
SAID = """trunnion mill
at X0 Y0 Z0 A0 C0 the tip is on the workpiece at
  X0.000 Y0.000 Z-120.000, the tool axis is (0.000000, 0.000000, 1.000000)

A turns the table about a line along +X, (1.000000, 0.000000, 0.000000),
  through X5.000 Y-32.000 Z-95.000
  + turns the table clockwise, seen from +X (the right): left-handed
  that is as in ISO 841
  + moves what is on the +Y side of the axis to -Z (down)
  from A0 to A90:
    on the workpiece the tip moves by (0.000, -7.000, 57.000) mm
      to X0.000 Y-7.000 Z-63.000
    on the workpiece the tool leans towards -Y, by 90.000 degrees
    the tip is held there if X, Y, Z move by (0.000, -57.000, -7.000) mm

C turns the table about a line along +Z, (0.000000, 0.000000, 1.000000),
  through X5.000 Y-20.000 Z-60.000
  + turns the table clockwise, seen from +Z (above): left-handed
  that is as in ISO 841
  + moves what is on the +Y side of the axis to +X (to the right)
  from C0 to C90:
    on the workpiece the tip moves by (-15.000, -25.000, 0.000) mm
      to X-15.000 Y-25.000 Z-120.000
    on the workpiece the tool axis stays
    the tip is held there if X, Y, Z move by (25.000, -15.000, 0.000) mm
"""


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mill.toml").write_text(MILL)
    return tmp_path


def test_a_trunnion_in_words(here: Path) -> None:
    """Worked by hand: the tip is 32 behind A and 25 below it, 5 left of C and 20 behind it."""
    done = call("machine", "jog", "mill.toml", "--tool", "1", "--step", "90")
    assert done.exit_code == 0, done.stderr
    assert done.stdout == SAID


def numbers(line: str) -> list[float]:
    return [float(n) for n in re.findall(r"-?\d+\.\d+", line)]


def chains() -> list[Chain]:
    draw = np.random.default_rng(3)
    kinds = [preset(name, draw) for name in PRESETS]
    return kinds + [skewed(draw, tables) for tables in (0, 1, 2) for _ in range(5)]


@pytest.mark.parametrize("chain", chains())
def test_the_numbers_are_those_of_the_oracle(chain: Chain) -> None:
    at = {"X": 10.0, "Y": -20.0, "Z": 30.0, chain.letters[0]: 25.0, chain.letters[1]: -40.0}
    text = "\n".join(jog_test(chain, at, 7.0))
    linear, angles = np.array([[10.0, -20.0, 30.0]]), np.array([[25.0, -40.0]])
    start, _ = tool(chain, linear, angles)
    parts = text.split("\n\n")[1:]
    assert len(parts) == 2
    for k, part in enumerate(parts):
        side = "table" if k < len(chain.table) else "head"
        assert part.startswith(f"{chain.letters[k]} turns the {side} about a line")
        moved = angles.copy()
        moved[0, k] += 7.0
        tip, _ = tool(chain, linear, moved)
        by = next(line for line in part.splitlines() if "workpiece the tip moves by" in line)
        assert numbers(by) == pytest.approx((tip - start)[0].tolist(), abs=6e-4)
        held = next(line for line in part.splitlines() if "tip is held" in line)
        back, _ = tool(chain, linear + numbers(held), moved)
        assert back[0] == pytest.approx(start[0], abs=2e-3)


@pytest.mark.parametrize("side", ["table", "head"])
@pytest.mark.parametrize("sign", [-1, 1])
@pytest.mark.parametrize(
    "way", [(1.0, 0, 0), (0, 1.0, 0), (0, 0, 1.0), (0, 0.8, 0.6), (-1.0, 0, 0)]
)
def test_the_words_are_what_the_axis_does(
    side: str, sign: int, way: tuple[float, float, float]
) -> None:
    line = Rotary("A", way, (0.0, 0.0, 0.0), sign)
    chain = Chain((line,)) if side == "table" else Chain((), (line,))
    text = " ".join(jog_test(chain, {}, 10.0))
    seen = re.search(r"(\w+), seen from ([+-])([XYZ])", text)
    moves = re.search(r"on the ([+-])([XYZ]) side of the axis to ([+-][XYZ]) \(([a-z ]+)\)", text)
    assert seen is not None
    assert moves is not None
    eye = np.eye(3)["XYZ".index(seen[3])] * float(seen[2] + "1")
    side_of = np.eye(3)["XYZ".index(moves[2])] * float(moves[1] + "1")
    goes = np.eye(3)["XYZ".index(moves[3][1])] * float(moves[3][0] + "1")
    carried = line.turn(side_of[None], np.array([1.0]))[0] - side_of
    assert carried @ goes > 0.5 * np.linalg.norm(carried)
    turn = np.cross(side_of, carried) @ eye
    assert (turn > 0.0) == (seen[1] == "counterclockwise")
    assert WAYS[moves[3]] == moves[4]
    assert ("right-handed" in text) == (sign > 0)
    assert ("as in ISO 841" in text) == (sign == (1 if side == "head" else -1))


def test_an_axis_that_is_off_its_coordinate_says_so() -> None:
    way = np.array([1.0, 0.002, 0.0]) / np.hypot(1.0, 0.002)
    line = Rotary("A", (float(way[0]), float(way[1]), 0.0), (0.0, 0.0, 0.0), -1)
    assert "about a line 0.115 degrees off +X" in " ".join(jog_test(Chain((line,)), {}, 10.0))


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (("--tool", "2"), "GX707"),
        (("--start", "B=4"), "GX707"),
        (("--start", "A"), "GX702"),
        (("--step", "nan"), "GX706"),
    ],
)
def test_what_cannot_be_jogged(here: Path, words: tuple[str, ...], code: str) -> None:
    done = call("machine", "jog", "mill.toml", *words)
    assert done.exit_code == 2
    assert f"error[{code}]" in done.stderr


def test_a_machine_without_rotary_axes(here: Path) -> None:
    (here / "mill.toml").write_text("format = 1\n[axis.X]\n")
    done = call("machine", "jog", "mill.toml")
    assert done.exit_code == 2
    assert "mill.toml: error[GX452]: this machine has no rotary axis" in done.stderr


def test_where_the_axes_start(here: Path) -> None:
    done = call("machine", "jog", "mill.toml", "--start", "A=30,X=4")
    assert done.stdout.splitlines()[1].startswith("at X4 Y0 Z0 A30 C0 the tip")
    assert "from A30 to A40:" in done.stdout


# --- the picture ---


def test_the_picture_has_every_axis_and_its_sense(here: Path) -> None:
    pytest.importorskip("matplotlib")
    done = call("machine", "draw", "mill.toml", "--tool", "1", "-o", "mill.svg")
    assert done.exit_code == 0, done.stderr
    root = ElementTree.parse(here / "mill.svg").getroot()
    shown = {group.get("id") for group in root.iter(f"{SVG}g")}
    assert {"axis A", "A+", "axis C", "C+", "tool", "carries"} <= shown
    assert {"pivot A", "table", "bearing", "spindle", "tip", "distance"} <= shown
    texts = {(text.text or "").strip() for text in root.iter(f"{SVG}text")}
    assert {"A+ (table)", "C+ (table)", "trunnion mill", "A, turns the table"} <= texts
    assert {"Y 12", "Z 35", "pivot X5 Y-32 Z-95 mm", "tip"} <= texts
    first = (here / "mill.svg").read_bytes()
    assert call("machine", "draw", "mill.toml", "--tool", "1", "-o", "mill.svg").exit_code == 0
    assert (here / "mill.svg").read_bytes() == first


def test_the_arrow_turns_as_a_positive_command_does(here: Path) -> None:
    """C of a table turns clockwise as seen from above, which the picture shows."""
    pytest.importorskip("matplotlib")
    assert call("machine", "draw", "mill.toml", "-o", "mill.svg").exit_code == 0
    root = ElementTree.parse(here / "mill.svg").getroot()
    for name, clockwise in (("C+", True), ("A+", True)):
        group = next(g for g in root.iter(f"{SVG}g") if g.get("id") == name)
        path = next(group.iter(f"{SVG}path")).get("d") or ""
        points = np.array(re.findall(r"-?\d+\.?\d*", path), float).reshape(-1, 2)
        x, y = (points - points.mean(axis=0)).T
        area = np.sum(x[:-1] * y[1:] - x[1:] * y[:-1])  # above 0: clockwise, as y goes down
        assert (area > 0.0) == clockwise


def test_a_picture_is_svg_or_png(here: Path) -> None:
    assert "GX737" in call("machine", "draw", "mill.toml", "-o", "mill.gif").stderr
