"""Write a deterministic surfacing program: a zig-zag finishing pass over a wavy surface.

    python benchmarks/surfacing.py [--lines N] OUT

The part lies inside X 0..480, Y 0..330, Z 0..450, the volume of the LDDM error tables, with a
margin so that corrected commands stay inside as well. About a million lines cover the surface
once at 0.4 mm; a longer program repeats it layer by layer, so that ten million lines are the
same kind of work as one million. The text is made row by row: memory does not grow with the file.

The program is valid for LinuxCNC and for Fanuc: every coordinate has its decimal point.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from functools import lru_cache
from itertools import count
from pathlib import Path

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]

PITCH = 0.4  # mm between points along X and between rows along Y
X_FIRST, X_LAST = 4.0, 476.0
Y_FIRST, Y_LAST = 10.0, 320.0
Z_SAFE = 430.0
LAYERS, LAYER_STEP, Z_TOP = 10, 20.0, 330.0  # mm; the height of the surface, layer by layer
STRAIGHT_EVERY = 8  # every eighth row is straight (X..Z..), the others meander (X..Y..Z..)
RETRACT_EVERY = 25  # rows between two G0 retracts
FEED_EVERY = 250  # points between two F words
FEEDS = (2400, 1800, 3000, 2100)

PREAMBLE = ("G21 G17 G90 G94 G40 G54", "S12000 M3", f"G0X240.000Y165.000Z{Z_SAFE:.3f}")
POSTAMBLE = (f"G0Z{Z_SAFE:.3f}", "M5", "M30")
POINTS = round((X_LAST - X_FIRST) / PITCH) + 1
ROWS = round((Y_LAST - Y_FIRST) / PITCH) + 1


def row_points(row: int) -> Floats:
    """Return the points of a row, shape (POINTS, 3), in the order in which they are cut."""
    layer, within = divmod(row, ROWS)
    forwards = within if layer % 2 == 0 else ROWS - 1 - within  # the next layer cuts its way back
    x: Floats = X_FIRST + PITCH * np.arange(POINTS, dtype=np.float64)
    y = np.full(POINTS, Y_FIRST + PITCH * forwards)
    if row % STRAIGHT_EVERY:
        y += 4.0 * np.sin(x / 37.0 + 0.01 * forwards)
    z = Z_TOP - LAYER_STEP * (layer % LAYERS) + height(x, y)
    points = np.column_stack((x, y, z))
    return points if row % 2 == 0 else points[::-1]


def height(x: Floats, y: Floats) -> Floats:
    """Return the freeform surface, between -84 and 84 mm."""
    waves = 35.0 * np.sin(x / 61.0) * np.cos(y / 47.0) + 14.0 * np.sin((x + 2.0 * y) / 29.0)
    total: Floats = waves + 35.0 * np.cos((x - y) / 113.0)
    return total


@lru_cache(maxsize=2)
def row_template(straight: bool) -> str:
    """Return the %-format of the points of a row after its first, with a few F words."""
    words = "X%.3fZ%.3f" if straight else "X%.3fY%.3fZ%.3f"
    lines = [words] * POINTS
    for number, point in enumerate(range(0, POINTS, FEED_EVERY)):
        lines[point] += f"F{FEEDS[number % len(FEEDS)]}."
    return "\n".join(lines[1:]) + "\n"


def row_entry(row: int, first: Floats) -> str:
    """Return the lines that lead to the first point of a row: a step-over or a retract."""
    x, y, z = first
    if row % RETRACT_EVERY:
        return f"X{x:.3f}Y{y:.3f}Z{z:.3f}\n"
    return f"G0Z{Z_SAFE:.3f}\nX{x:.3f}Y{y:.3f}\nZ{z + 2.0:.3f}\nG1Z{z:.3f}F{FEEDS[1]}.\n"


def rows() -> Iterator[str]:
    """Yield the text of the rows, without an end."""
    for row in count():
        points = row_points(row)
        straight = row % STRAIGHT_EVERY == 0
        columns = points[1:, ::2] if straight else points[1:]
        body = row_template(straight) % tuple(columns.ravel().tolist())
        yield row_entry(row, points[0]) + body


def program(lines: int) -> Iterator[str]:
    """Yield the program in pieces; it has exactly ``lines`` lines."""
    left = lines - len(PREAMBLE) - len(POSTAMBLE)
    if left < 0:
        raise ValueError(f"a program has at least {len(PREAMBLE) + len(POSTAMBLE)} lines")
    yield "\n".join(PREAMBLE) + "\n"
    for text in rows():
        size = text.count("\n")
        if size >= left:
            yield "".join(text.splitlines(keepends=True)[:left])
            break
        yield text
        left -= size
    yield "\n".join(POSTAMBLE) + "\n"


def write(path: Path, lines: int) -> None:
    """Write a surfacing program of ``lines`` lines to ``path``."""
    with path.open("w", encoding="ascii", newline="\n") as out:
        out.writelines(program(lines))


def main() -> None:
    """Read the command line and write the program."""
    parser = argparse.ArgumentParser(description="Write a deterministic surfacing program.")
    parser.add_argument("--lines", type=int, default=1_000_000, help="default: %(default)s")
    parser.add_argument("out", type=Path, help="the file to write")
    arguments = parser.parse_args()
    try:
        write(arguments.out, arguments.lines)
    except (ValueError, OSError) as error:
        parser.error(str(error))


if __name__ == "__main__":
    main()
