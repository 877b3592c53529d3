"""Subprograms by themselves that are compensated, held to a caller of the test's own.

An interpreter of a few lines executes what is written from the command of the caller: the tool,
errors included, is where it was meant to be, and the caller finds its axes and its mode.
"""

from __future__ import annotations

import random
import re
from pathlib import Path

import pytest
from seeds_kit import some

import gcxform as gx
from gcxform.pipeline import at_call

PIPELINE = """
format = 1
[input]
dialect = "fanuc"
[entry]
modes = "{modes} G21 G94 G17 G54 G49"
start = {{ X = 100.0, Y = 200.0, Z = 50.0 }}
feed = 100.0
[[pass]]
use = "volumetric"
model = "model.toml"
part-origin = [0.0, 0.0, 0.0]
"""
MODEL = 'format = 1\nkind = "skew"\n[squareness]\nC0Y = 1e-4\nA0Z = 1e-4\n'
START = (100.0, 200.0, 50.0)
NEAR = 2e-3  # mm: commands of three decimals, and what a cut may leave
Point = tuple[float, ...]


def written(text: str, modes: str, folder: Path) -> str:
    """Return what is written for a subprogram that is called from START."""
    (folder / "model.toml").write_text(MODEL)
    (folder / "pipeline.toml").write_text(PIPELINE.format(modes=modes))
    pipeline = gx.Pipeline.load(folder / "pipeline.toml")
    return pipeline.run(text.encode()).text.decode()


def executed(text: str, modes: str) -> tuple[list[Point], str]:
    """Return the commands after each line that moves, and the mode that is left."""
    at, points = [*START], []
    for line in re.sub(r"\([^)]*\)", "", text).splitlines():
        modes = next(reversed(re.findall(r"G9[01]", line)), modes)
        words = re.findall(r"([XYZ])(-?[0-9.]+)", line)
        for axis, number in words:
            place = "XYZ".index(axis)
            at[place] = float(number) + (at[place] if modes == "G91" else 0.0)
        points += [tuple(at)] * bool(words)
    return points, modes


def reached(command: Point) -> Point:
    """Return where the machine goes: squareness between X and Y, and between Y and Z."""
    x, y, z = command
    return x - 1e-4 * y, y - 1e-4 * z, z


def near(one: Point, other: Point) -> bool:
    return all(abs(a - b) < NEAR for a, b in zip(one, other, strict=True))


def drawn(seed: int) -> tuple[str, str]:
    """Return a subprogram of lines and the mode in which it is called."""
    draw = random.Random(seed)
    mode = called = draw.choice(["G90", "G91"])
    lines = ["O7"]
    for _ in range(draw.randint(1, 6)):
        code = draw.choice(["G0 ", "G1 "])
        if draw.random() < 0.3:
            mode = draw.choice(["G90", "G91"])
            code = f"{mode} {code}"
        axes = draw.sample("XYZ", draw.randint(1, 3))
        far = {"X": 100, "Y": 200, "Z": 50} if mode == "G90" else dict.fromkeys("XYZ", 0)
        lines.append(code + " ".join(f"{a}{far[a] + draw.randint(-90, 90) / 10}" for a in axes))
    return "\n".join([*lines, "M99", ""]), called


@pytest.mark.parametrize("seed", some(30))
def test_the_tool_goes_where_it_was_meant_to_go(seed: int, tmp_path: Path) -> None:
    text, modes = drawn(seed)
    meant, left = executed(text, modes)
    commands, found = executed(written(text, modes, tmp_path), modes)
    assert found == left
    assert near(commands[-1], meant[-1])
    gone = [reached(command) for command in commands]
    for point in meant:
        while gone and not near(gone[0], point):
            gone.pop(0)
        assert gone, f"{point} is not reached"


@pytest.mark.parametrize("modes", ["G90", "G91"])
def test_first_moves_that_feed_begin_where_the_caller_stands(modes: str, tmp_path: Path) -> None:
    """A rapid goes to the command of that place, and the modes of the call hold behind it."""
    text = "O7\nG1 Z45.\nG0 Z50.\nM99\n" if modes == "G90" else "O7\nG1 Z-5.\nG0 Z5.\nM99\n"
    commands, left = executed(written(text, modes, tmp_path), modes)
    assert near(reached(commands[0]), START)
    assert near(reached(commands[1]), (100.0, 200.0, 45.0))
    assert (commands[-1], left) == (START, modes)


def test_where_it_leaves_its_caller_is_read_again(monkeypatch, tmp_path: Path) -> None:
    """A block that would go elsewhere is noticed in the finished text."""
    right = at_call.going_back
    monkeypatch.setattr(
        "gcxform.pipeline.subprogram.going_back",
        lambda run: tuple(each.replace("X-", "X") for each in right(run)),
    )
    with pytest.raises(gx.InputError, match="its caller would find the axes"):
        written("O7\nG0 X5.\nM99\n", "G91", tmp_path)
