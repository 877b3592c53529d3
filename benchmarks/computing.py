"""Write a LinuxCNC program that is more than words and numbers: the roads beside the main one.

    python benchmarks/computing.py ROAD --lines N FILE

ROAD is `comments` (another comment on every line), `expressions` (words with expressions, other
numbers in every line), `assignments` (every other line sets a parameter that the next one reads) or
`loop` (a `while` of four lines, of which so many are executed). Only the standard library is used.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Iterator
from pathlib import Path

HEAD = ("G21 G90 G17", "F1000", "G0 X0 Y0 Z5", "G1 Z0")


def comments(lines: int) -> Iterator[str]:
    """Yield moves, each with a comment of its own."""
    for k in range(lines):
        yield f"G1 X{k % 300 * 0.1:.3f} Y{20 * math.sin(k / 50):.4f} (point {k} of pass {k // 300})"


def expressions(lines: int) -> Iterator[str]:
    """Yield moves whose words are computed."""
    yield "#1=2.5 #2=0.25"
    for k in range(lines - 1):
        x, y = f"[#1+{k % 300 * 0.1:.3f}]", f"[20*SIN[{k * 0.1:.3f}]-{k % 9}]"
        yield f"G1 X{x} Y{y} Z[-[{k % 7}*#2]]"


def assignments(lines: int) -> Iterator[str]:
    """Yield assignments, and behind each a move that reads it."""
    for k in range(lines // 2):
        yield f"#1=[{k % 300}*0.1+{k % 7}]"
        yield f"G1 X#1 Y[#1*{k % 11}+1.5]"


def loop(lines: int) -> Iterator[str]:
    """Yield a loop of which so many lines are executed."""
    yield "#1=0"
    yield f"o1 while [#1 LT {lines // 4}]"
    yield "G1 X[20*COS[#1/10]] Y[20*SIN[#1/10]]"
    yield "#1=[#1+1]"
    yield "o1 endwhile"


ROADS: dict[str, Callable[[int], Iterator[str]]] = {
    "comments": comments,
    "expressions": expressions,
    "assignments": assignments,
    "loop": loop,
}


def main() -> None:
    """Write the program."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("road", choices=ROADS)
    parser.add_argument("--lines", type=int, default=200_000)
    parser.add_argument("file", type=Path)
    given = parser.parse_args()
    text = "\n".join((*HEAD, *ROADS[given.road](given.lines), "M2\n"))
    given.file.write_text(text, "utf-8")


if __name__ == "__main__":
    main()
