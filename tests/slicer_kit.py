"""PrusaSlicer, where it is installed, and what its programs extrude, read by nobody of ours."""

from __future__ import annotations

import re
import shutil
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

import pytest

CORNERS = [(x, y, z) for z in (0, 1) for x, y in ((0, 0), (20, 0), (20, 20), (0, 20))]
FACES = (
    *((0, 2, 1), (0, 3, 2), (4, 5, 6), (4, 6, 7), (0, 1, 5), (0, 5, 4)),
    *((1, 2, 6), (1, 6, 5), (2, 3, 7), (2, 7, 6), (3, 0, 4), (3, 4, 7)),
)
WORD = re.compile(r"([GMXYZEF])(-?\d*\.?\d+)")


def plate() -> str:
    """Return a plate of 20 by 20 by 1 mm as STL."""
    facets = []
    for face in FACES:
        points = "".join(f"vertex {x} {y} {z}\n" for x, y, z in (CORNERS[k] for k in face))
        facets.append(f"facet normal 0 0 0\nouter loop\n{points}endloop\nendfacet\n")
    return f"solid plate\n{''.join(facets)}endsolid plate\n"


def sliced(
    folder: Path, name: str, *words: str, model: str = ""
) -> subprocess.CompletedProcess[str]:
    """Slice a plate, or a model, into a program of a folder; skip where no slicer is installed."""
    slicer = shutil.which("prusa-slicer")
    if slicer is None:
        pytest.skip("prusa-slicer is not installed: no slicer calls gcxform")
    (folder / "model.stl").write_text(model or plate())
    out = ["--export-gcode", "-o", str(folder / name), *words, str(folder / "model.stl")]
    return subprocess.run([slicer, *out], capture_output=True, text=True, timeout=60, check=False)


@dataclass
class Printed:
    """What a program does: corners that it goes to while it extrudes, and how much it feeds."""

    corners: list[tuple[float, float]] = field(default_factory=list)
    fed: float = 0.0
    feeds: list[float] = field(default_factory=list)


def printed(program: str) -> Printed:
    """Read a program as a printer does, one command in a line."""
    found, at, by_steps = Printed(), {"X": 0.0, "Y": 0.0, "E": 0.0}, False
    for line in program.splitlines():
        words = {letter: float(number) for letter, number in WORD.findall(line.partition(";")[0])}
        if words.get("M") in (82.0, 83.0):
            by_steps = words["M"] == 83.0
        elif words.get("G") == 92.0:
            at["E"] = words["E"]
        elif words.get("G") in (0.0, 1.0):
            goal = {**at, **{k: v for k, v in words.items() if k in at}}
            step = words.get("E", 0.0) if by_steps else goal["E"] - at["E"]
            found.fed += step
            if step > 0 and (goal["X"], goal["Y"]) != (at["X"], at["Y"]):
                found.corners.append((goal["X"], goal["Y"]))
                found.feeds.append(found.fed)
            at = goal
    return found
