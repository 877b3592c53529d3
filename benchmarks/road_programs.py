"""Write a program that is more than words and numbers: the roads beside the main one.

    python benchmarks/road_programs.py NAME --lines N FILE

Each function below is such a program, and says what it has; `siemens` and `klartext` have twins of
the same moves, `siemens-twin` and `klartext-twin`, for LinuxCNC's interpreter reads neither. Only
the standard library is used.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Iterator
from itertools import cycle, islice
from pathlib import Path

HEAD = ("G21 G90 G17", "F1000", "G0 X0 Y0 Z5", "G1 Z0")
Lines = Iterator[str]


def points(count: int, off: float = 0.0) -> Iterator[tuple[float, float, float]]:
    """Yield points of a finishing pass, mm; ``off`` moves every third one along Y."""
    for k in range(count):
        y = 20 * math.sin(k / 50) + (off if k % 3 == 0 else 0.0)
        yield k % 300 * 0.1, y, -2 + math.cos(k / 17)


def straight(lines: int, off: float = 0.0) -> Lines:
    """Yield moves and nothing else."""
    for x, y, z in points(lines, off):
        yield f"G1 X{x:.3f} Y{y:.4f} Z{z:.4f}"


def nearby(lines: int) -> Lines:
    """Yield moves that are 0.4 um beside those of `straight`, every third one."""
    return straight(lines, 0.0004)


def decimals(lines: int) -> Lines:
    """Yield moves with nine decimals."""
    for x, y, z in points(lines):
        yield f"G1 X{x:.3f} Y{y:.9f} Z{z:.9f}"


def comments(lines: int) -> Lines:
    """Yield moves, each with a comment of its own."""
    for k in range(lines):
        yield f"G1 X{k % 300 * 0.1:.3f} Y{20 * math.sin(k / 50):.4f} (point {k} of pass {k // 300})"


def expressions(lines: int) -> Lines:
    """Yield moves whose words are computed."""
    yield "#1=2.5 #2=0.25"
    for k in range(lines - 1):
        x, y = f"[#1+{k % 300 * 0.1:.3f}]", f"[20*SIN[{k * 0.1:.3f}]-{k % 9}]"
        yield f"G1 X{x} Y{y} Z[-[{k % 7}*#2]]"


def assignments(lines: int) -> Lines:
    """Yield assignments, and behind each a move that reads it."""
    for k in range(lines // 2):
        yield f"#1=[{k % 300}*0.1+{k % 7}]"
        yield f"G1 X#1 Y[#1*{k % 11}+1.5]"


def written_out(lines: int) -> Lines:
    """Yield rounds of a loop as a CAM system without loops writes them: five lines each."""
    for k in range(lines // 5):
        yield f"N{10 * k + 10} #1={k % 360}"
        yield "#2=[20*COS[#1]]"
        yield "#3=[20*SIN[#1]]"
        yield f"G1 X#2 Y#3 Z-{k % 7 * 0.1:.1f}"
        yield f"(round {k})"


def loop(lines: int) -> Lines:
    """Yield a loop of which so many lines are executed."""
    yield "#1=0"
    yield f"o1 while [#1 LT {lines // 4}]"
    yield "G1 X[20*COS[#1/10]] Y[20*SIN[#1/10]]"
    yield "#1=[#1+1]"
    yield "o1 endwhile"


def frames(lines: int) -> Lines:
    """Yield moves with another work offset in every fourth line."""
    works = cycle(("G54", "G55", "G59.1"))
    for k, (x, y, z) in enumerate(points(lines)):
        yield next(works) if k % 4 == 3 else f"G1 X{x:.3f} Y{y:.4f} Z{z:.4f}"


def returns(lines: int) -> Lines:
    """Yield moves with a return to G28, one to G53, and a tool change with its length."""
    moves = straight(lines)
    for k in range(lines // 12):
        yield from ("G53 G0 Z0", "G28 X0 Y0 Z5", f"T{k % 3 + 1} M6", f"G43.1 Z{k % 9 + 50}")
        yield f"G0 X{k % 40}.5 Y{k % 30}"
        yield from islice(moves, 7)


def circles(lines: int) -> Lines:
    """Yield arcs: halves by I and J, quarters by R, helices."""
    for k in range(lines // 4):
        x = k % 300 * 0.1
        yield f"G1 X{x:.3f} Y0 Z0"
        yield f"G3 X{x + 6:.3f} Y0 I3 J0"
        yield f"G2 X{x + 4:.3f} Y2 R2"
        yield f"G2 X{x + 2:.3f} Y0 Z-1.5 I-2 J0"


def drilling(lines: int) -> Lines:
    """Yield patterns of five holes; each pattern has another depth, every third pecks."""
    for k in range(lines // 6):
        word = ("G81", "G82 P0.2", "G83 Q1.5")[k % 3]
        yield f"G98 {word} X{k % 300 * 0.1:.3f} Y1 Z-{4 + k % 40 * 0.1:.1f} R2 F200"
        yield from (f"X{k % 300 * 0.1 + j:.3f} Y{j * 2 + k % 9}" for j in range(1, 5))
        yield "G80"


def contours(lines: int) -> Lines:
    """Yield contours with rounded corners, to the left of which the cutter goes."""
    for k in range(lines // 12):
        x, y = k % 30 * 100.0, k % 17 * 100.0
        yield f"G0 X{x - 20:.3f} Y{y - 20:.3f}"
        yield f"G41.1 D8 G1 X{x - 10:.3f} Y{y:.3f}"
        yield f"X{x:.3f} Y{y:.3f}"
        yield f"Y{y + 40:.3f}"
        yield f"G2 X{x + 10:.3f} Y{y + 50:.3f} I10 J0"
        yield f"G1 X{x + 40:.3f}"
        yield f"G2 X{x + 50:.3f} Y{y + 40:.3f} R10"
        yield f"G1 Y{y + 10 + k % 7:.3f}"
        yield f"X{x + 45:.3f} Y{y:.3f}"
        yield f"X{x - 10:.3f}"
        yield "G40"
        yield f"G1 X{x - 20:.3f} Y{y - 20:.3f}"


def chords(lines: int) -> Lines:
    """Yield a way of chords of arcs of 2 to 12 mm, as CAM systems cut them: two degrees each."""
    x = y = turned = 0.0
    for k in range(lines):
        radius = 2 + k // 45 % 11
        turned += math.radians(2) * (1 if k // 45 % 2 else -1)
        x, y = x + radius * 0.0349 * math.cos(turned), y + radius * 0.0349 * math.sin(turned)
        yield f"G1 X{x:.4f} Y{y:.4f}"


def siemens(lines: int) -> Lines:
    """Yield a SINUMERIK program: words, radii as CR, values of R parameters."""
    for k, (x, y, z) in enumerate(points(lines)):
        if k % 8 == 7:
            yield f"R1={k % 7}.5"
        elif k % 8 == 3:
            yield f"G3 X={x:.3f} Y={y + 4:.4f} CR=2.5"
        else:
            yield f"G1 X{x:.3f} Y{y:.4f} Z={'R1' if k % 8 == 0 else f'{z:.4f}'}"


def siemens_twin(lines: int) -> Lines:
    """Yield the same for LinuxCNC."""
    for k, (x, y, z) in enumerate(points(lines)):
        if k % 8 == 7:
            yield f"#1={k % 7}.5"
        elif k % 8 == 3:
            yield f"G3 X{x:.3f} Y{y + 4:.4f} R2.5"
        else:
            yield f"G1 X{x:.3f} Y{y:.4f} Z{'#1' if k % 8 == 0 else f'{z:.4f}'}"


def klartext(lines: int) -> Lines:
    """Yield a program in Klartext, numbered: lines, and half circles round their centres."""
    for k in range(lines // 5):
        x, y = k % 300 * 0.1, 20 * math.sin(k / 50)
        block = 5 * k + 6
        yield f"{block} L X{x:+.3f} Y{y:+.4f} Z-1.5 F1000"
        yield f"{block + 1} L X{x + 1:+.3f} Y{y + 1:+.4f}"
        yield f"{block + 2} CC X{x + 3:+.3f} Y{y + 1:+.4f}"
        yield f"{block + 3} C X{x + 5:+.3f} Y{y + 1:+.4f} DR-"
        yield f"{block + 4} L Z+0.5"


def klartext_twin(lines: int) -> Lines:
    """Yield the same for LinuxCNC; a CC is the I and J of its C, so there are fewer lines."""
    for k in range(lines // 5):
        x, y = k % 300 * 0.1, 20 * math.sin(k / 50)
        yield f"G1 X{x:.3f} Y{y:.4f} Z-1.5 F1000"
        yield f"G1 X{x + 1:.3f} Y{y + 1:.4f}"
        yield f"(centre X{x + 3:.3f} Y{y + 1:.4f})"
        yield f"G2 X{x + 5:.3f} Y{y + 1:.4f} I2 J0"
        yield "G1 Z0.5"


def klartext_plain(lines: int) -> Lines:
    """Yield straight code in Klartext."""
    for k, (x, y, z) in enumerate(points(lines), 3):
        yield f"{k} L X{x:+.3f} Y{y:+.4f} Z{z:+.4f}"


PROGRAMS: dict[str, Callable[[int], Lines]] = {
    "straight": straight,
    "nearby": nearby,
    "decimals": decimals,
    "comments": comments,
    "expressions": expressions,
    "assignments": assignments,
    "written-out": written_out,
    "loop": loop,
    "frames": frames,
    "returns": returns,
    "circles": circles,
    "drilling": drilling,
    "contours": contours,
    "chords": chords,
    "siemens": siemens,
    "siemens-twin": siemens_twin,
    "siemens-plain": straight,
    "fagor-plain": straight,
    "klartext-plain": klartext_plain,
    "klartext": klartext,
    "klartext-twin": klartext_twin,
}
KLARTEXT = (
    ("0 BEGIN PGM ROAD MM", "1 TOOL CALL 1 Z S5000 F1000", "2 L X+0 Y+0 Z+5 R0 FMAX M3"),
    ("END PGM ROAD MM",),
)
FRAMES: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "siemens": (("G71 G90 G17", "F1000", "G0 X0 Y0 Z5", "G1 Z0"), ("M30",)),
    "siemens-plain": (("G710 G90 G17", "F1000", "G0 X0 Y0 Z5", "G1 Z0"), ("M30",)),
    "fagor-plain": (("G71 G90 G17", "F1000", "G0 X0 Y0 Z5", "G1 Z0"), ("M30",)),
    "klartext": KLARTEXT,
    "klartext-plain": KLARTEXT,
}
"""What stands before and behind a program of another language than LinuxCNC's."""


def write(name: str, lines: int, file: Path) -> None:
    """Write a program of about so many lines."""
    head, tail = FRAMES.get(name, (HEAD, ("M2",)))
    text = "\n".join((*head, *PROGRAMS[name](lines), *tail, ""))
    file.write_text(text, "utf-8")


def main() -> None:
    """Write the program."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("name", choices=PROGRAMS)
    parser.add_argument("--lines", type=int, default=200_000)
    parser.add_argument("file", type=Path)
    given = parser.parse_args()
    write(given.name, given.lines, given.file)


if __name__ == "__main__":
    main()
