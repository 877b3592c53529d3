"""Writes the programs of a small shop: 50 for a Fanuc, and the three subprograms they share.

    python make_programs.py FOLDER

They are as different as a shop's are: two fixtures, seven tools, inches and millimetres, drilling
with and without pecks, contours with and without compensation, numbers without a point, a switch.
"""

from __future__ import annotations

import sys
from pathlib import Path

SUBPROGRAMS = {
    "O9100": "(GO HOME)\nM9\nG80 G40\nG91 G28 Z0\nG90",
    "O9200": "(FOUR CORNERS)\nX30.\nY20.\nX0\nY0",
    "O9300": "(A GROOVE)\nG91 G1 Z-1. F80.\nG90\nX40.\nG0 Z2.\nX0",
}
COUNT = 50


def program(number: int) -> str:
    """Return a main program."""
    tool, offset = 1 + number % 7, 54 + number % 2
    inch = number % 10 == 9
    lines = [
        f"O{1000 + number} (PART {number})",
        f"{'G20' if inch else 'G21'} G17 G40 G80 G90 G94",
        f"T{tool} M6",
        f"G{offset} G0 X0 Y0 S{1000 + 50 * tool} M3",
        f"G43 H{tool} Z5.{' M8' if number % 3 else ''}",
    ]
    lines += ["/M7"] if number % 8 == 3 else []
    lines += KINDS[number % len(KINDS)](number, tool)
    return "\n".join([*lines, "M98 P9100", "M30"])


def _drilled(number: int, tool: int) -> list[str]:
    return [f"G81 Z-{2 + tool}. R2. F120.", "M98 P9200", "G80"]


def _pecked(number: int, tool: int) -> list[str]:
    cycle = "G73" if number % 4 else "G83"
    return [f"{cycle} X10. Y10. Z-12. R2. Q{1 + tool}. F100.", "X20.", "G80"]


def _grooves(number: int, tool: int) -> list[str]:
    return ["G0 Z2.", f"G1 Z-{number % 5 + 1}. F60.", "M98 P9300 L3", "G0 Z5."]


def _contour(number: int, tool: int) -> list[str]:
    side = f"G41 D{tool}" if number % 3 == 0 else "G40"
    around = ["Y30.", "G2 X10. Y40. R10.", "G1 X40.", "Y0", "X0"]
    return ["G0 X-20. Y-20.", "G1 Z-2. F150.", f"G1 {side} X0 Y0", *around, "G40 X-20. Y-20."]


def _by_increments(number: int, tool: int) -> list[str]:
    return ["G1 Z-1. F100.", f"X{1000 * tool} Y2500", "X0", "G0 Z5."]


KINDS = (_drilled, _pecked, _grooves, _contour, _by_increments)


def write(folder: Path, count: int = COUNT) -> None:
    """Write programs into a folder, all or the first ones, and the subprograms."""
    folder.mkdir(parents=True, exist_ok=True)
    for number in range(count):
        (folder / f"O{1000 + number}.nc").write_text(f"%\n{program(number)}\n%\n")
    for name, text in SUBPROGRAMS.items():
        (folder / f"{name}.nc").write_text(f"%\n{name} {text}\nM99\n%\n")


if __name__ == "__main__":
    write(Path(sys.argv[1]), *map(int, sys.argv[2:]))
