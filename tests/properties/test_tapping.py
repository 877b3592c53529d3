"""Taps under compensation: the same cycles, their ends where the machine takes them to the hole.

Programs are drawn at random, and so are machines whose errors grow evenly along X and Z. Where the
machine goes with a command is reckoned here, by hand; what was written is read again, and for
LinuxCNC its own interpreter says whether it moves so.
"""

from __future__ import annotations

import random
from pathlib import Path

import numpy as np
import pytest
from oracles import rs274, toolpaths
from oracles.canon import CanonProgram
from seeds_kit import DRAWN

import gcxform as gx
from gcxform.toolpath.path import Form

COUNT = 2 * DRAWN
TOLERANCE = 0.002  # mm
ROUNDING = 0.0018  # mm: three decimals in three axes, twice, where blocks are in G91
BETWEEN = 0.1  # mm, of levels between taps, that no words say
SPAN = 400.0  # mm
AXES = {"G17": "XYZ", "G18": "ZXY", "G19": "YZX"}


class Machine:
    """Errors in X, Y, Z (mm) that grow with x and z."""

    def __init__(self, choose: random.Random) -> None:
        self.along_x = [choose.uniform(-2e-4, 2e-4) for _ in range(3)]
        self.along_z = [choose.uniform(-1e-4, 1e-4) for _ in range(3)]

    def goes(self, command: np.ndarray) -> np.ndarray:
        """Return where commands (n, 3) take the tool."""
        x, z = command[:, :1], command[:, 2:]
        return command + x * np.array(self.along_x) + z * np.array(self.along_z)

    def written(self, folder: Path) -> Path:
        text = 'format = 1\nkind = "axis-functions"\nvalues = "error"\nconvention = "relative"\n'
        text += 'order = "XYZ"\n'
        for axis, slopes in (("X", self.along_x), ("Z", self.along_z)):
            text += f"[{axis}]\nposition = [{-SPAN}, {SPAN}]\n"
            for name, slope in zip("XYZ", slopes, strict=True):
                text += f"E{name}{axis} = [{-SPAN * slope!r}, {SPAN * slope!r}]\n"
        path = folder / "model.toml"
        path.write_text(text)
        return path


class Drawn:
    """A random program of tapped patterns."""

    def __init__(self, choose: random.Random, dialect: str) -> None:
        self.choose, self.fanuc = choose, dialect == "fanuc"

    def text(self) -> bytes:
        blocks = ["G21 G90 G94 G17", "G0 X0. Y0. Z0."]
        for _ in range(self.choose.randint(1, 3)):
            blocks += self.pattern()
        return "\n".join([*blocks, "M30" if self.fanuc else "M2", ""]).encode()

    def number(self, low: int, high: int) -> str:
        return f"{self.choose.randint(low * 1000, high * 1000) / 1000:.3f}"

    def pattern(self) -> list[str]:
        choose = self.choose
        plane = choose.choice(list(AXES)) if self.fanuc else "G17"
        code = choose.choice(("G84", "G74"))
        self.repeats = "K" if self.fanuc else "L" if code == "G84" else ""
        self.first, self.second, self.normal = AXES[plane]
        self.level, self.steps = choose.randint(20, 60), choose.random() < 0.4
        approach = f"G0 {self.first}5. {self.second}-5. {self.normal}{self.level}.5"
        spindle = [f"M{3 if code == 'G84' else 4} S500"]
        spindle += ["M29 S500"] if self.fanuc and choose.random() < 0.5 else []
        distance = "G91" if self.steps else "G90"
        retract = choose.choice(("G98", "G99"))
        pitch = f"F{choose.randint(100, 900)}." if not self.fanuc else "F1.25"
        mode = "G95 " if self.fanuc else ""
        words = [self.place(), self.r(), self.depth()]
        if self.repeats and choose.random() < 0.3:
            words.append(f"{self.repeats}{choose.randint(1, 3)}")
        choose.shuffle(words)
        begin = f"{mode}{distance} {retract} {code} {' '.join(words)} {pitch} (first)"
        holes = [self.hole() for _ in range(choose.randint(0, 5))]
        return [plane, approach, *spindle, begin, *holes, "G80 G90 G94", f"G0 {self.first}0."]

    def place(self) -> str:
        if self.steps:
            return f"{self.first}{self.number(1, 20)} {self.second}{self.number(-5, 5)}"
        return f"{self.first}{self.number(-99, 99)} {self.second}{self.number(-99, 99)}"

    def r(self) -> str:
        if self.steps:
            return f"R-{self.number(5, 15)}"
        return f"R{self.choose.choice((self.number(-5, 15), f'{self.level}.5'))}"

    def depth(self) -> str:
        return f"{self.normal}{self.number(-20, -8)}"

    def hole(self) -> str:
        """Return a hole that leaves to the words in force what it does not say."""
        some = [self.place().split()[self.choose.randint(0, 1)]]
        some += [self.r()] if self.choose.random() < 0.2 else []
        some += [self.depth()] if self.choose.random() < 0.2 else []
        some += [f"{self.repeats}2"] if self.repeats and self.choose.random() < 0.15 else []
        retract = f"{self.choose.choice(('G98', 'G99'))} " if self.choose.random() < 0.3 else ""
        return retract + " ".join(some)


def compensated(program: bytes, dialect: str, model: Path) -> gx.Result | None:
    """Return what becomes of a program; None where a tap does not fit into the tolerance."""
    try:
        return pipeline_of(dialect, model).run(program)
    except gx.InputError as error:
        if "GX506" in str(error) and "off at its ends" in str(error):
            return None
        pytest.fail(f"{error}\n{program.decode()}")


def pipeline_of(dialect: str, model: Path) -> gx.Pipeline:
    text = (
        f'format = 1\n[input]\ndialect = "{dialect}"\n[[pass]]\nuse = "volumetric"\n'
        f'model = "{model.name}"\npart-origin = [0.0, 0.0, 0.0]\ntolerance = {TOLERANCE}\n'
        "[output]\nstamp = false\ndecimals = 3\n"
    )
    pipeline = model.parent / "pipeline.toml"
    pipeline.write_text(text)
    return gx.Pipeline.load(pipeline)


def ends_of(path: gx.Toolpath) -> tuple[np.ndarray, np.ndarray]:
    """Return where tied moves begin and end (n, 3), commanded."""
    tied = path.form == Form.SYNCHRONISED
    return path.start[tied, :3], path.end[tied, :3]


def far(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    return np.asarray(np.sqrt(((one - other) ** 2).sum(axis=1)))


def check(program: bytes, result: gx.Result, dialect: str, machine: Machine) -> None:
    """Compare tied moves, one by one: their ends, feeds and number."""
    before, after = gx.read(program, dialect).path, gx.read(result.text, dialect).path
    both = f"{program.decode()}---\n{result.text.decode()}"
    tied, still = before.form == Form.SYNCHRONISED, after.form == Form.SYNCHRONISED
    assert tied.sum() == still.sum(), both
    assert len(before) == len(after), both
    assert (before.feed[tied] == after.feed[still]).all(), both
    assert (before.feed_mode[tied] == after.feed_mode[still]).all(), both
    (start, end), (began, ended) = ends_of(before), ends_of(after)
    off = far(machine.goes(began), start), far(machine.goes(ended), end)
    within = TOLERANCE + ROUNDING
    assert off[0].max() <= within, f"{off[0]}\n{both}"
    way_in = np.arange(len(end)) % 2 == 0
    at_r = np.append((ended[1:] == began[:-1]).all(axis=1), False)
    back = np.append(False, at_r[:-1])  # ends where its way in began
    assert off[1][way_in | back].max() <= within, f"{off[1]}\n{both}"
    gap = far(machine.goes(after.end[:, :3]), before.end[:, :3])
    assert gap.max() <= BETWEEN, both


@pytest.mark.parametrize("dialect", ["fanuc", "linuxcnc"])
def test_taps_stay_taps_and_their_ends_are_compensated(dialect: str, tmp_path: Path) -> None:
    written, refused, moved, texts = 0, 0, 0, []
    for seed in range(COUNT):
        choose = random.Random(seed)
        machine = Machine(choose)
        program = Drawn(choose, dialect).text()
        result = compensated(program, dialect, machine.written(tmp_path))
        if result is None:
            refused += 1
            continue
        check(program, result, dialect, machine)
        written += 1
        moved += result.text != program
        texts.append(result.text)
    assert written > COUNT / 3
    assert moved == written
    assert refused > COUNT / 20
    if dialect == "linuxcnc" and rs274.available():
        for text, answer in zip(texts, rs274.run_many(texts), strict=True):
            assert isinstance(answer, CanonProgram), f"{answer}\n{text.decode()}"
            problem = toolpaths.difference(toolpaths.read(text, {}), answer)
            assert problem == "", f"{problem}\n{text.decode()}"


@pytest.mark.parametrize(
    "block",
    ["G33 Z-30 K1.5", "G33 X60 Z-30 K2", "G33.1 Z-30 K1.5", "G91 G33.1 Z-30 K1.5"],
)
def test_threads_and_taps_of_one_move_move_their_ends_only(block: str, tmp_path: Path) -> None:
    """They cross a node of the table, where a line would be cut."""
    choose = random.Random(1)
    machine = Machine(choose)
    program = f"G21 G90 G94\nS300 M3\nG0 X50 Y0 Z15\n{block}\nG90 G0 Z15\nM2\n".encode()
    model = machine.written(tmp_path)
    bent = model.read_text().replace(
        f"position = [{-SPAN}, {SPAN}]", f"position = [{-SPAN}, 0.0, {SPAN}]"
    )
    for line in [line for line in bent.splitlines() if line.startswith("E")]:
        bent = bent.replace(line, line.replace(", ", ", 0.0, "))
    model.write_text(bent)
    result = compensated(program, "linuxcnc", model)
    assert result is not None
    before, after = gx.read(program, "linuxcnc").path, gx.read(result.text, "linuxcnc").path
    tied = np.isin(after.form, (Form.SYNCHRONISED, Form.THREAD))
    assert after.form.tolist() == before.form.tolist()
    assert after.feed[tied].tolist() == before.feed[tied].tolist()
    assert len(result.text.splitlines()) == len(program.splitlines())
    assert far(machine.goes(after.end[:, :3]), before.end[:, :3])[1:].max() <= ROUNDING
    line = result.text.splitlines()[3].decode()
    assert line != block
    assert line.split()[-1] == block.split()[-1]


def test_threading_cycles_are_refused_by_name(tmp_path: Path) -> None:
    program = b"G21 G90 G94\nS300 M3\nG0 X50 Y0 Z15\nG76 P1.5 Z-30 I-2 J.5 K1\nM2\n"
    model = Machine(random.Random(1)).written(tmp_path)
    with pytest.raises(gx.InputError, match="G76"):
        pipeline_of("linuxcnc", model).run(program)
