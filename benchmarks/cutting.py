"""Where volumetric compensation cuts: as its tolerance needs it, against pieces of one length.

    python benchmarks/cutting.py [--check]

For the linear example of LDDM, and for real programs (of ../shared/corpus, where it is beside the
checkout) under a machine of 21 parameters: how many blocks are written and how far the machine is
then off at worst, by the certificate of each run, for tolerances of 0.5 to 5 um, and for moves cut
every 10 mm and every 1 mm. Behind these stands what the adaptive cuts need for the same residual,
and how many blocks no program could do without (benchmarks/fewest.py).
With --check the exit code is 1 if a tolerance was exceeded, or if more than a third of the blocks
of the fixed cuts were written for one of the first programs. The moves of the others are short, or
arcs, which a pass may cut every 10 mm and hardly write more of them than it has to.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from fewest import fewest

import gcxform as gx
from gcxform.errormodel.model_file import load_model

HERE = Path(__file__).resolve().parent
EXAMPLES = HERE.parent / "examples"
PROGRAMS = HERE.parents[1] / "shared" / "corpus" / "programs"
NINE = EXAMPLES / "lddm" / "model.toml"
RIGID = EXAMPLES / "rigid-body" / "model.toml"
TOLERANCES = (0.5, 1.0, 2.0, 5.0)  # um
LENGTHS = (10.0, 1.0)  # mm
TOOL = 100.0  # mm, the length for which the model was measured
SHARE = 3.0  # fixed cuts need so many times the blocks


@dataclass(frozen=True)
class Case:
    """A program, its dialect, the model, and the origin of the program in the model."""

    name: str
    program: bytes
    dialect: str
    model: Path
    origin: tuple[float, float, float]
    checked: bool

    def place(self, folder: Path) -> tuple[str, str]:
        """Return how a pipeline says where the origin is: its [machine], and an option."""
        if b"G55" not in self.program:
            return "", f"part-origin = {list(self.origin)}"
        x, y, z = self.origin
        work = f"{{ X = {x}, Y = {y}, Z = {z - TOOL} }}"
        (folder / "machine.toml").write_text(
            f"format = 1\nwork-offset = {{ G54 = {work}, G55 = {work} }}\n"
            f"[tool.1]\nlength = {TOOL}\n"
        )
        return '[machine]\nfile = "machine.toml"', ""


LONG = (
    ("grbl/winder-Universal-G-Code-Sender/fixtures/run-from/simple.g1.input.nc", "linuxcnc"),
    ("haas/stcline-CNC_Training/NC_Files/Writing_A_Program_Example.nc", "haas"),
    ("iso-generic/appliedengdesign-vscode-gcode-syntax/samplenc/sample-profile.nc", "linuxcnc"),
)
OTHERS = (
    ("grbl/Sienci-Labs-gsender/examples/gcode/big_circle_offset.nc", "linuxcnc"),
    ("fanuc/MaestroFusion360-easy_gcode_plot/cnc_programs/TEST_G90.NC", "fanuc"),
    ("mach3/fragmuffin-pygcode/linuxcnc/Smiley_face.tap", "linuxcnc"),
    ("grbl/winder-Universal-G-Code-Sender/test_files/ugs.gcode", "grbl"),
)


def cases() -> Iterator[Case]:
    """Yield the programs that are there."""
    linear = EXAMPLES / "lddm" / "linear_in.nc"
    yield Case("LDDM linear", linear.read_bytes(), "fanuc", NINE, (0.0, 0.0, 0.0), True)
    for name, dialect in LONG + OTHERS:
        file = PROGRAMS / name
        if file.is_file():
            program = file.read_bytes()
            origin, checked = _centred(program, dialect), (name, dialect) in LONG
            yield Case(file.name, program, dialect, RIGID, origin, checked)


def _centred(program: bytes, dialect: str) -> tuple[float, float, float]:
    """Return the origin which puts a program into the middle of the machine, below its top."""
    ends = gx.read(program, dialect).path.end[:, :3]
    low, high = np.nanmin(ends, axis=0), np.nanmax(ends, axis=0)
    x, y = (-np.round((low + high) / 2)[:2]).tolist()
    return x, y, float(-np.round(high[2]) - 20.0)


def run(case: Case, folder: Path, options: str, before: str = "") -> tuple[int, float]:
    """Return the blocks which a run writes, and how far (um) the machine is then off."""
    machine, origin = case.place(folder)
    (folder / "p.toml").write_text(
        f"""\
format = 1
[input]
dialect = "{case.dialect}"
start = {{ X = 0.0, Y = 0.0, Z = 0.0 }}
{machine}
[budget]
deviation = 1.0
[[pass]]
use = "absolute"
{before}
[[pass]]
use = "volumetric"
model = "{case.model}"
{origin}
{options}
[output]
dialect = "{case.dialect}"
decimals = 6
"""
    )
    result = gx.Pipeline.load(folder / "p.toml").run(case.program)
    largest = result.certificate.largest["deviation"]
    assert largest is not None
    blocks = len(gx.read(result.text, case.dialect).path)
    return blocks, 1000.0 * largest


def adaptive(case: Case, folder: Path, tolerance: float) -> tuple[int, float]:
    """Return blocks and residual (um) for a tolerance (um)."""
    return run(case, folder, f'tolerance = "{tolerance:.6f} um"')


def fixed(case: Case, folder: Path, length: float) -> tuple[int, float]:
    """Return blocks and residual (um) for pieces of at most a length (mm)."""
    cut = f'[[pass]]\nuse = "segment"\nmax-length = {length}\narcs = "split"'
    return run(case, folder, 'split = "none"', cut)


def table(folder: Path) -> Iterator[tuple[str, bool]]:
    """Yield the lines of the table, and whether each is as it should be."""
    yield "| program | cut | blocks | off by, um | adaptive | ratio | at least |", True
    yield "|---|---|--:|--:|--:|--:|--:|", True
    for case in cases():
        path = gx.read(case.program, case.dialect).path
        yield f"| {case.name} | moves read | {len(path)} | | | | |", True
        for tolerance in TOLERANCES:
            blocks, off = adaptive(case, folder, tolerance)
            line = f"| {case.name} | {tolerance:g} um | {blocks} | {off:.3f} | | | |"
            yield line, off <= tolerance + 0.001  # the numbers are rounded to a nanometre
        for length in LENGTHS:
            blocks, off = fixed(case, folder, length)
            same, _ = adaptive(case, folder, off)
            least = fewest(path, load_model(case.model), np.array(case.origin), off / 1000.0)
            figures = f"{blocks} | {off:.3f} | {same} | {blocks / same:.2f} | {least}"
            line = f"| {case.name} | {length:g} mm | {figures} |"
            yield line, blocks >= SHARE * same or not case.checked


def main() -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="exit with 1 if a limit is missed")
    check = parser.parse_args().check
    good = True
    with tempfile.TemporaryDirectory() as folder:
        for line, right in table(Path(folder)):
            print(line, flush=True)
            good &= right
    return int(check and not good)


if __name__ == "__main__":
    sys.exit(main())
