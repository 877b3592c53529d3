"""What a start of gcxform takes, in ratios to `import numpy`, which no start can do without.

    python benchmarks/starting.py [--rounds N] [--check] [--bare [EXTRA]]

Processor time (user + sys) and peak memory are medians of runs in turn, so they hold on a computer
that does other things as well. `--check` ends with 1 where a job takes more than `LIMITS`.
`--bare` builds the sdist, the wheel from it, and installs that into a new environment, which has
nothing else, or what an extra brings (`all`); pip needs an index for what gcxform stands on.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import venv
from pathlib import Path

ROOT = Path(__file__).parents[1]
PROGRAM = b"G21 G90 G17 G54\nG0 X0 Y0 Z5\nG91\nG1 Z-6 F500\nG90\nX10\nM2\n"
NUMPY = "import numpy"
LIMITS = {"gcxform --version": 1.0, "gcxform --help": 1.0, "gcxform run, 7 lines": 2.5}
SLACK = 1.1  # two computers, and two hours of one, differ by as much


def jobs(python: Path, program: Path) -> dict[str, list[str]]:
    """Return what is measured, by name."""
    gcxform = [str(python), "-m", "gcxform.cli"]
    chain = ["-f", "linuxcnc", "-x", "absolute"]
    kept = ["-o", f"{program}.out", "--certificate", f"{program}.json"]
    return {
        "python": [str(python), "-c", ""],
        NUMPY: [str(python), "-c", NUMPY],
        "import gcxform": [str(python), "-c", "import gcxform"],
        "gcxform --version": [*gcxform, "--version"],
        "gcxform --help": [*gcxform, "--help"],
        "gcxform completion bash": [*gcxform, "completion", "bash"],
        "gcxform run, 7 lines": [*gcxform, "run", "-q", *chain, str(program), *kept],
        "gcxform post, 7 lines": [*gcxform, "post", *chain, f"{program}.out"],
        "gcxform check, 7 lines": [*gcxform, "check", *chain, str(program)],
        "gcxform info, 7 lines": [*gcxform, "info", "-f", "linuxcnc", str(program)],
    }


def measured(command: list[str]) -> tuple[float, float]:
    """Return the processor time of a command in ms, and its peak memory in MB."""
    compiled = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
    with open(os.devnull, "wb") as nowhere:
        child = subprocess.Popen(command, stdout=nowhere, cwd=tempfile.gettempdir(), env=compiled)
    _, status, used = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode:
        sys.exit(f"{command} ended with {child.returncode}")
    return (used.ru_utime + used.ru_stime) * 1e3, used.ru_maxrss * 1024 / 1e6


def bare(folder: Path, extra: str) -> Path:
    """Return the Python of a new environment in which only the wheel of the sdist is installed."""
    build = [sys.executable, "-m", "build", "--outdir", str(folder), str(ROOT)]
    subprocess.run(build, check=True, capture_output=True)
    (wheel,) = folder.glob("*.whl")
    venv.create(folder / "bare", with_pip=True)
    python = folder / "bare" / "bin" / "python"
    what = f"{wheel}[{extra}]" if extra else str(wheel)
    pip = [str(python), "-m", "pip", "install", "-q", "--disable-pip-version-check"]
    subprocess.run([*pip, what], check=True)
    return python


def main() -> None:
    """Measure, and print a table in Markdown."""
    words = argparse.ArgumentParser(description=__doc__)
    words.add_argument("--rounds", type=int, default=9)
    words.add_argument("--check", action="store_true")
    words.add_argument("--bare", nargs="?", const="", metavar="EXTRA")
    asked = words.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        python = Path(sys.executable) if asked.bare is None else bare(folder, asked.bare)
        (folder / "part.nc").write_bytes(PROGRAM)
        todo = jobs(python, folder / "part.nc")
        for command in todo.values():
            measured(command)  # modules are compiled, grammars kept
        rounds = [
            {name: measured(each) for name, each in todo.items()} for _ in range(asked.rounds)
        ]
    medians = {
        name: [statistics.median(r[name][k] for r in rounds) for k in (0, 1)] for name in todo
    }
    print("| | ms | of import numpy | MB | of import numpy |\n|---|---|---|---|---|")
    for name, (time, memory) in medians.items():
        ratios = time / medians[NUMPY][0], memory / medians[NUMPY][1]
        print(f"| `{name}` | {time:.0f} | {ratios[0]:.2f} | {memory:.1f} | {ratios[1]:.2f} |")
    most = {name: LIMITS[name] * SLACK * medians[NUMPY][0] for name in LIMITS}
    slow = [name for name in LIMITS if medians[name][0] > most[name]]
    if asked.check and slow:
        sys.exit(f"over their limit: {', '.join(slow)}")


if __name__ == "__main__":
    main()
