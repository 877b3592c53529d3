"""The preview of LinuxCNC's user interface as an oracle for splines: the points it draws.

`rs274` prints of a spline no more than how many control points it has. The module `gcode` of the
same package runs the same interpreter, and draws a spline by points at equal steps of its parameter
(60 of a cubic, 45 of a quadratic one), in inches; their Z is not that of an arc before. It belongs
to the Python of the system, so it runs there: `python3 preview.py FOLDER < programs.json`. Each
program has a process of its own, because the interpreter remembers what it was told before.
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

PYTHON = "/usr/bin/python3"
MODULES = "/usr/lib/python3/dist-packages"
INCH = 25.4
MARK = "answer: "
TIMEOUT = 300.0  # seconds

Point = tuple[float, float, float]
Moves = list[tuple[int, list[Point]]]
"""The lines that move, from 1, and the points (mm) each goes through."""


def available() -> bool:
    """Tell whether the module `gcode` is installed."""
    return any(Path(MODULES).glob("gcode*.so")) and Path(PYTHON).exists()


def preview(programs: list[str]) -> list[Moves | str]:
    """Return the moves of programs, or the message with which LinuxCNC refuses one."""
    with tempfile.TemporaryDirectory() as folder:
        env = {"HOME": folder, "PATH": os.environ["PATH"], "INI_FILE_NAME": f"{folder}/a.ini"}
        done = subprocess.run(
            [PYTHON, __file__, folder],
            input=json.dumps(programs),
            capture_output=True,
            text=True,
            env=env,
            timeout=TIMEOUT,
            check=True,
        )
    return [
        answer if isinstance(answer, str) else _moves(answer) for answer in _answers(done.stdout)
    ]


def _answers(text: str) -> list[Any]:
    """Return the answers; the interpreter may have printed something between them."""
    lines = [line.split(MARK)[1] for line in text.splitlines() if MARK in line]
    return [json.loads(line) for line in lines]


def _moves(answer: list[Any]) -> Moves:
    moves: Moves = []
    for line, point in answer:
        if not moves or moves[-1][0] != line:
            moves.append((line, []))
        moves[-1][1].append(tuple(point))
    return moves


class _Canon:
    """Takes the canonical calls of one program; `points` are line and position of each feed."""

    def __init__(self, folder: str) -> None:
        self.parameter_file = f"{folder}/a.var"
        self.line = 0
        self.points: list[tuple[int, Point]] = []

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        return lambda *arguments: None

    def next_line(self, state: Any) -> None:
        self.line = state.sequence_number

    def straight_feed(self, x: float, y: float, z: float, *others: float) -> None:
        self.points.append((self.line, (x * INCH, y * INCH, z * INCH)))

    straight_traverse = straight_feed

    def get_tool(self, *arguments: Any) -> tuple[int, ...]:
        return (0,) * 14

    def get_external_angular_units(self) -> float:
        return 1.0

    get_external_length_units = get_external_angular_units

    def get_axis_mask(self) -> int:
        return 0x1FF

    def get_block_delete(self) -> bool:
        return False

    check_abort = is_lathe = get_block_delete


def _answer(program: str, folder: str) -> Any:
    """Run one program in this process."""
    import gcode  # type: ignore[import-not-found]  # of the Python of the system

    Path(f"{folder}/a.ngc").write_text(program)
    Path(f"{folder}/a.var").write_text("")
    canon = _Canon(folder)
    code, _ = gcode.parse(f"{folder}/a.ngc", canon, "G21", "")
    return canon.points if code <= gcode.MIN_ERROR else gcode.strerror(code)


if __name__ == "__main__":
    sys.path.insert(0, MODULES)
    Path(f"{sys.argv[1]}/a.ini").write_text("[EMC]\n")
    for program in json.load(sys.stdin):
        sys.stdout.flush()
        child = os.fork()
        if not child:
            print(f"{MARK}{json.dumps(_answer(program, sys.argv[1]))}", flush=True)
            os._exit(0)
        os.waitpid(child, 0)
