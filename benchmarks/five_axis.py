"""Write a deterministic program of tips and angles: a zig-zag over a dome, the tool leaning.

    python benchmarks/five_axis.py [--lines N] OUT

The tool leans by 12 to 28 degrees, the same way around the part as the dome slopes, so that both
rotary axes of an A/C trunnion move in every block, by tenths of a degree. Rows are 0.4 mm apart, as
are the points; a longer program repeats the dome layer by layer, and is the same kind of work.
"""

from __future__ import annotations

import argparse
from itertools import count
from pathlib import Path

import numpy as np

PITCH = 0.4  # mm
HALF = 60.0  # mm; half the side of the part
POINTS = round(2.0 * HALF / PITCH) + 1
SAFE = 120.0
PREAMBLE = ("G21 G17 G90 G94 G40 G54", f"G0 X0. Y0. Z{SAFE} A0. C0.", "G43 H1 F2400.")
POSTAMBLE = ("M5", "M30")


def row_text(row: int) -> str:
    """Return the blocks of a row: X, Y, Z of the tip and A, C."""
    x = -HALF + PITCH * np.arange(POINTS)
    x = x if row % 2 == 0 else x[::-1]
    y = np.full(POINTS, -HALF + PITCH * (row % POINTS))
    z = 60.0 - (x**2 + y**2) / 240.0 - 0.05 * (row // POINTS)
    a = 20.0 + 8.0 * np.sin(x / 23.0) * np.cos(y / 31.0)
    c = 40.0 * np.sin((x + 2.0 * y) / 67.0)
    rows = np.column_stack((x, y, z, a, c))
    return ("X%.3fY%.3fZ%.3fA%.3fC%.3f\n" * POINTS) % tuple(rows.ravel().tolist())


def write(path: Path, lines: int) -> None:
    """Write a program of so many lines."""
    left = lines - len(PREAMBLE) - len(POSTAMBLE)
    with path.open("w", encoding="ascii", newline="\n") as out:
        out.write("\n".join(PREAMBLE) + "\n")
        for row in count():
            text = row_text(row).splitlines(keepends=True)[:left]
            text[:1] = ["G1" + part for part in text[:1]] if row == 0 else text[:1]
            out.writelines(text)
            left -= len(text)
            if left <= 0:
                break
        out.write("\n".join(POSTAMBLE) + "\n")


def main() -> None:
    """Read the command line and write the program."""
    parser = argparse.ArgumentParser(description="Write a deterministic five-axis program.")
    parser.add_argument("--lines", type=int, default=200_000, help="default: %(default)s")
    parser.add_argument("out", type=Path, help="the file to write")
    arguments = parser.parse_args()
    if arguments.lines <= len(PREAMBLE) + len(POSTAMBLE):
        parser.error(f"--lines is above {len(PREAMBLE) + len(POSTAMBLE)}")
    write(arguments.out, arguments.lines)


if __name__ == "__main__":
    main()
