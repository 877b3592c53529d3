"""Write a deterministic shop program: parts with pockets, slots, bores and drilled holes.

    python benchmarks/shop.py [--lines N] OUT

What CAM systems and hands write for a milling machine: rings of pockets with rounded corners,
helices down, trochoidal slots, bores in half circles, canned cycles with long lists of holes, rows
of holes in G91, a pattern shifted by G52 or G92, three work offsets, tool lengths, G28 and G53. A
part has about two thousand lines; a longer program has more parts, which differ in every number.

The program is written for LinuxCNC. It has no line that only one of the two would take.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from itertools import count
from math import cos, pi, sin
from pathlib import Path

PREAMBLE = ("%", "(PLATES)", "G21 G17 G90 G94 G40 G49 G80 G54", "G0 X0. Y0. Z50.")
POSTAMBLE = ("G80", "G0 Z50.", "M5", "M9", "M30", "%")
WORKS = ("G54", "G55", "G59.1")
POCKETS, LEVELS, RINGS = 4, 6, 6
LOOPS, BORES, HOLES = 90, 8, 60
Lines = Iterator[str]


def helix(x: float, y: float, radius: float, depth: float, feed: int) -> Lines:
    """Yield a helix of three turns down into the material, beginning at its centre."""
    yield f"G0 X{x + radius:.3f} Y{y:.3f}"
    yield "Z2."
    yield f"G1 Z{depth + 1.5:.3f} F{feed}"
    yield f"G3 X{x + radius:.3f} Y{y:.3f} Z{depth:.3f} I{-radius:.3f} J0. P3"


def ring(x: float, y: float, half: float, corner: float, feed: int) -> Lines:
    """Yield a ring of a pocket: a square with rounded corners, counter-clockwise."""
    inner = half - corner
    yield f"G1 X{x + half:.3f} Y{y:.3f} F{feed}"
    yield f"Y{y + inner:.3f}"
    yield f"G3 X{x + inner:.3f} Y{y + half:.3f} I{-corner:.3f} J0."
    yield f"G1 X{x - inner:.3f}"
    yield f"G3 X{x - half:.3f} Y{y + inner:.3f} I0. J{-corner:.3f}"
    yield f"G1 Y{y - inner:.3f}"
    yield f"G3 X{x - inner:.3f} Y{y - half:.3f} R{corner:.3f}"
    yield f"G1 X{x + inner:.3f}"
    yield f"G3 X{x + half:.3f} Y{y - inner:.3f} R{corner:.3f}"
    yield f"G1 Y{y:.3f}"


def pocket(x: float, y: float, feed: int) -> Lines:
    """Yield a pocket, level by level and from the inside to the outside."""
    for level in range(LEVELS):
        depth = -1.5 * (level + 1)
        yield from helix(x, y, 2.0, depth, feed // 2)
        for number in range(RINGS):
            yield from ring(x, y, 4.0 + 3.5 * number, 2.5 + 0.5 * number, feed)
        yield "G0 Z5."


def slot(x: float, y: float, feed: int) -> Lines:
    """Yield a trochoidal slot: a half circle forth and a half circle back, again and again."""
    yield f"G0 X{x:.3f} Y{y:.3f}"
    yield f"G1 Z-4.000 F{feed // 3}"
    for loop in range(LOOPS):
        along = x + 0.35 * loop
        yield (
            f"G2 X{along:.3f} Y{y + 6.0:.3f} I0. J3. F{feed}"
            if not loop
            else (f"G2 X{along:.3f} Y{y + 6.0:.3f} I0. J3.")
        )
        yield f"X{along + 0.35:.3f} Y{y:.3f} I0.175 J-3."
    yield "G0 Z5. (SLOT DONE)"


def bore(x: float, y: float, radius: float, feed: int) -> Lines:
    """Yield a bore, finished in two half circles with an approach by an arc."""
    yield f"G0 X{x:.3f} Y{y:.3f}"
    yield f"G1 Z-6.500 F{feed}"
    yield f"G3 X{x + radius:.3f} I{radius / 2:.3f} J0."
    yield f"G3 X{x - radius:.3f} R{radius:.3f}"
    yield f"G3 X{x + radius:.3f} R{radius:.3f}"
    yield f"G3 X{x:.3f} I{-radius / 2:.3f} J0."
    yield "G0 Z5."


def circle_of_holes(x: float, y: float, radius: float, phase: float) -> Lines:
    """Yield places of holes on a circle; the words of the cycle stay in force."""
    for hole in range(1, HOLES):
        angle = phase + 2.0 * pi * hole / HOLES
        yield f"X{x + radius * cos(angle):.3f} Y{y + radius * sin(angle):.3f}"


def rows_of_holes(x: float, y: float) -> Lines:
    """Yield places of holes in rows, forth and back: only one axis has a word in most of them."""
    for hole in range(1, HOLES):
        row, column = divmod(hole, 10)
        at = x + 4.0 * (column if row % 2 == 0 else 9 - column)
        yield f"X{at:.3f} Y{y + 5.0 * row:.3f}" if column == 0 else f"X{at:.3f}"


def tool(number: int, name: str, speed: int, length: float, line: int) -> Lines:
    """Yield a tool change, the way there and the length of the tool; the lines have numbers."""
    yield f"N{line} M9"
    yield f"N{line + 10} M5"
    yield f"N{line + 20} G91 G28 Z0."
    yield f"N{line + 30} G90 G49"
    yield f"N{line + 40} T{number} M6 ({name})"
    yield f"N{line + 50} S{speed} M3"
    yield f"N{line + 60} G4 P0.5"
    yield f"N{line + 70} G43.1 Z{length:.3f}"
    yield f"N{line + 80} M8"


def milling(x: float, y: float, feed: int) -> Lines:
    """Yield what the end mill does to a part."""
    for number in range(POCKETS):
        yield f"(POCKET {number + 1})"
        yield from pocket(x + 60.0 * number, y, feed)
    yield from slot(x - 10.0, y + 30.0, feed)
    for number in range(BORES):
        yield from bore(x + 12.0 * number, y + 45.0, 4.0 + 0.25 * number, feed)


def drilling(x: float, y: float, feed: int, shift: str) -> Lines:
    """Yield what the drills do to a part: four cycles, one of them shifted, one in increments."""
    yield f"G99 G81 X{x + 22.0:.3f} Y{y:.3f} Z-9. R2. F{feed}"
    yield from circle_of_holes(x, y, 22.0, 0.0)
    yield "G80"
    yield shift
    yield f"G98 G82 X{x:.3f} Y{y:.3f} Z-3. R1.5 P0.25 F{feed // 2}"
    yield from rows_of_holes(x, y)
    yield "G80"
    yield "G52 X0. Y0." if shift.startswith("G52") else "G92.1"
    yield f"G0 X{x:.3f} Y{y + 55.0:.3f} Z10."
    yield f"G98 G83 X{x:.3f} Y{y + 55.0:.3f} Z-14. R2. Q5. F{feed}"
    yield from rows_of_holes(x, y + 55.0)
    yield "G80 M9"
    yield f"G99 G73 X{x + 30.0:.3f} Y{y:.3f} Z-8. R1. Q4. F{feed}"
    yield from circle_of_holes(x, y, 30.0, 0.05)
    yield "G80"
    yield f"G0 X{x:.3f} Y{y - 40.0:.3f} Z10."
    yield "G91"
    yield f"G81 X4.5 Y0. Z-7. R-8. L12 F{feed}"
    yield "X0. Y5."
    yield "X-4.5 Y0. L12"
    yield "G90 G80"


def part(number: int) -> Lines:
    """Yield the blocks of a part."""
    x, y = 10.0 + 0.137 * (number % 700), 20.0 + 0.211 * (number % 500)
    feed = 600 + 20 * (number % 30)
    shift = f"G52 X{0.5 * (number % 9):.3f} Y1.25" if number % 3 else "G92 X0. Y0."
    yield f"(PART {number % 1000})"
    yield from tool(1, "END MILL D6", 9000, 80.0 + 0.01 * (number % 50), 100)
    yield WORKS[number % len(WORKS)]
    yield "G0 X0. Y0. Z25."
    yield from milling(x, y, feed)
    yield "G53 G0 Z0."
    yield from tool(2, "DRILL D4", 3200, 110.0 + 0.02 * (number % 40), 1000)
    yield f"G0 X{x:.3f} Y{y:.3f} Z25."
    yield from drilling(x, y, feed // 3, shift)
    yield "G0 Z25."


def program(lines: int) -> Iterator[str]:
    """Yield the lines of a program of whole parts: about ``lines``, at least one part."""
    written = 0
    yield from PREAMBLE
    for number in count():
        blocks = list(part(number))
        if written and written + len(blocks) > lines:
            break
        yield from blocks
        written += len(blocks)
    yield from POSTAMBLE


def write(path: Path, lines: int) -> int:
    """Write a shop program of about ``lines`` lines to ``path``; return how many it has."""
    written = 0
    with path.open("w", encoding="ascii", newline="\n") as out:
        for line in program(lines):
            out.write(line + "\n")
            written += 1
    return written


def main() -> None:
    """Read the command line and write the program."""
    parser = argparse.ArgumentParser(description="Write a deterministic shop program.")
    parser.add_argument("--lines", type=int, default=500_000, help="default: %(default)s")
    parser.add_argument("out", type=Path, help="the file to write")
    arguments = parser.parse_args()
    try:
        print(write(arguments.out, arguments.lines))
    except OSError as error:
        parser.error(str(error))


if __name__ == "__main__":
    main()
