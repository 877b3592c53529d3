"""Prints on a bed that is tilted and bowed: what is fed along the way stays, and so do retracts.

The reader here is nobody's of ours: it knows lines, G92 E, M82 and M83. The Benchy is one of the
collection beside the checkout; with `--long` the whole of it.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest
from cli_kit import call
from seeds_kit import LONG

BESIDE = Path(__file__).parents[2] / "shared/corpus/programs/reprap/bradenwingfield-gcode-parsing"
BY_CURA, BY_PRUSA = (BESIDE / f"3DBenchy_{slicer}.gcode" for slicer in ("Cura", "Prusa"))
IN_THE_AIR = ("G1 Z50 F240", "G1 X2.0 Y10 F3000", "G1 Z0.28 F240")
"""Feed moves of the start code, where the printer stands nowhere known: GX317 wants rapids."""
WORD = re.compile(r"([GMXYZEF])(-?\d*\.?\d+)")
PIPELINE = """format = 1
[input]
dialect = "{}"
[machine]
file = "printer.toml"
[[pass]]
use = "segment"
chord-error = "5 um"
max-length = "5 mm"
[[pass]]
use = "volumetric"
model = "printer.cfg"
tolerance = "2 um"
outside = "clamp"
max-correction = "1 mm"
"""
PRINTER = "format = 1\n[axis.X]\n[axis.Y]\n[axis.Z]\n" + "".join(
    f"[{name}]\nX = 0.0\nY = 0.0\nZ = 0.0\n" for name in ("home.G28", "work-offset.G54")
)
BED = "[bed_mesh default]\nversion = 1\npoints =\n{}x_count = 7\ny_count = 7\nmesh_x_pps = 0\n"
BED += "mesh_y_pps = 0\nmin_x = 0\nmax_x = 240\nmin_y = 0\nmax_y = 240\n"


class Move(NamedTuple):
    """A move: its way (mm), what it feeds (mm), and its line."""

    way: float
    fed: float
    line: str


def bed() -> str:
    """Return a bed that rises along X, falls along Y, and is bowed, as Klipper keeps it."""
    at = [40.0 * k for k in range(7)]
    bow = {x: 0.25 * ((x - 120.0) / 120.0) ** 2 for x in at}
    rows = [[0.3 * x / 240 - 0.2 * y / 240 + bow[x] + bow[y] for x in at] for y in at]
    return BED.format("".join(f"  {', '.join(f'{h:.6f}' for h in row)}\n" for row in rows))


def write_shop(folder: Path, dialect: str, program: str) -> None:
    for name, text in (
        ("p.toml", PIPELINE.format(dialect)),
        ("printer.toml", PRINTER),
        ("printer.cfg", bed()),
        ("print.gcode", program),
    ):
        (folder / name).write_text(text)


def compensated(program: str, dialect: str, folder: Path) -> str:
    write_shop(folder, dialect, program)
    done = call("run", "-q", "-p", str(folder / "p.toml"), str(folder / "print.gcode"))
    assert done.exit_code == 0, done.output
    return str(done.stdout)


def moves(program: str) -> Iterator[Move]:
    """Yield the moves of a program of lines."""
    at, by_steps = dict.fromkeys("XYZE", 0.0), False
    for line in program.splitlines():
        words = {letter: float(number) for letter, number in WORD.findall(line.partition(";")[0])}
        if words.get("M") in (82.0, 83.0):
            by_steps = words["M"] == 83.0
        elif words.get("G") == 92.0:
            at["E"] = words.get("E", at["E"])
        elif words.get("G") in (0.0, 1.0):
            goal = {**at, **{k: v for k, v in words.items() if k in at}}
            fed = words.get("E", 0.0) if by_steps else goal["E"] - at["E"]
            yield Move(math.dist([at[k] for k in "XYZ"], [goal[k] for k in "XYZ"]), fed, line)
            at = goal


def check(before: str, after: str) -> int:
    """Hold the prints together; return how many moves extrude."""
    was, now = [*moves(before)], [*moves(after)]
    apart = [[m.line for m in all_of if m.fed and m.way < 1e-9] for all_of in (was, now)]
    assert apart[0] == apart[1]
    pieces = iter([m for m in now if m.fed and m.way >= 1e-9])
    extruding = [m for m in was if m.fed and m.way >= 1e-9]
    near = 2e-5 if "M83" in before else 4e-6  # what is left by the rounding of pieces
    for move in extruding:
        left, way = move.fed, move.way
        while abs(left) > near or way > 1e-3 * move.way:  # less than 0: it wipes and draws back
            piece = next(pieces)
            way -= piece.way
            assert abs(piece.fed - move.fed / move.way * piece.way) < 1e-4 * piece.way + 1.1e-5, (
                move,
                piece,
            )
            left -= piece.fed
        assert abs(left) <= near, move
    assert next(pieces, None) is None
    assert sum(m.fed for m in now) == pytest.approx(sum(m.fed for m in was), abs=1e-4)
    return len(extruding)


@pytest.mark.skipif(not BY_CURA.is_file(), reason="no Benchy beside the checkout")
def test_a_benchy_on_a_tilted_and_bowed_bed(tmp_path: Path) -> None:
    text = BY_CURA.read_text().replace("G1 Z2.0 F3000", "G0 Z2.0 F3000", 1)  # as GX317 asks for
    lines = text.splitlines(keepends=True)
    program = "".join(lines if LONG else lines[:1200])
    assert check(program, compensated(program, "marlin2", tmp_path)) > (50_000 if LONG else 900)


@pytest.mark.skipif(not BY_PRUSA.is_file(), reason="no Benchy beside the checkout")
def test_a_benchy_by_prusaslicer_through_post(tmp_path: Path) -> None:
    """What PrusaSlicer has written is handed to `post` as it hands it over: the file, in place."""
    text = BY_PRUSA.read_text()
    for line in IN_THE_AIR:
        assert f"\n{line}\n" in text
        text = text.replace(f"\n{line}\n", f"\nG0{line[2:]}\n", 1)
    lines = text.splitlines(keepends=True)
    program = "".join(lines if LONG else lines[:4000])
    write_shop(tmp_path, "marlin2", program)
    done = call("post", "-p", str(tmp_path / "p.toml"), str(tmp_path / "print.gcode"))
    assert done.exit_code == 0, done.output
    after = (tmp_path / "print.gcode").read_text()
    assert "GCXFORM STAMP" in after
    assert check(program, after) > (100_000 if LONG else 2_000)


def made(relative: bool) -> str:
    """Return two layers of a square with a retraction between them."""
    mode = "M83" if relative else "M82"
    lines, total = ["G28", "G90", mode, "G0 X20 Y20 Z2", "G92 E0"], 0.0
    for layer in (1, 2):
        lines += [f"G0 X20 Y20 Z{0.2 * layer:.1f} F6000", "G92 E0"]
        total = 0.0
        for x, y in ((220, 20), (220, 170), (20, 170), (20, 20.5)):
            fed = 200.0 if y in (20, 170) and (x, y) != (220, 170) else 150.0
            total += 0.03 * fed
            lines.append(f"G1 X{x} Y{y} E{0.03 * fed if relative else total:.3f} F1800")
        lines.append(f"G1 E{-5 if relative else total - 5:.3f} F2700")
        lines.append("G0 Z5")
        lines.append(f"G1 E{5 if relative else total:.3f} F2700")
    return "\n".join([*lines, "M84", ""])


@pytest.mark.parametrize("relative", [True, False])
@pytest.mark.parametrize(
    "dialect", ["marlin", "marlin2", "rrf", "klipper", "prusa", "smoothieware"]
)
def test_a_print_by_each_firmware(dialect: str, relative: bool, tmp_path: Path) -> None:
    program = made(relative)
    assert check(program, compensated(program, dialect, tmp_path)) == 8


def test_filament_goes_along_arcs(tmp_path: Path) -> None:
    """An arc is as long as what its pieces feed, whatever they have become."""
    program = (
        "G28\nG90\nM83\nG0 X20 Y120 Z2\nG0 X20 Y120 Z0.2\nG1 X60 Y120 E1 F1800\n"
        "G3 X180 Y120 I60 J0 E6\nG1 E-5 F2700\nG0 Z5\n"
    )
    text = compensated(program, "marlin", tmp_path)
    words = [dict(WORD.findall(line)) for line in text.splitlines()]
    fed = [float(w["E"]) for w in words if w.get("G") in ("1", "2", "3") and "E" in w]
    assert sum(fed) == pytest.approx(1 + 6 - 5, abs=1e-4)
    assert "G1 E-5 F2700" in text
    assert len(fed) > 10
