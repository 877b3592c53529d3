"""LinuxCNC's interpreter as the judge of threads, taps and probes: the same moves, or a refusal."""

from __future__ import annotations

import random
import re

import pytest
from oracles import rs274, toolpaths
from oracles.canon import CanonProgram
from properties import test_laws as laws
from seeds_kit import DRAWN

import gcxform as gx

COUNT = 5 * DRAWN
CHUNK = 250
NEAR = 1.2e-3  # mm: what is written is rounded to 1e-4 of a unit, which may be an inch

ALONE = re.compile(r"cannot be fed in inverse time|where [AXYZ] stands is not known")
"""What we refuse and LinuxCNC does not: G93 in the block of a probe, and distances after one."""

pytestmark = pytest.mark.skipif(not rs274.available(), reason="rs274 (LinuxCNC) is not installed")


class Drawn:
    """A random program; now and then with a fault that LinuxCNC refuses.

    It probes, or it shifts: stand-alone, LinuxCNC backs off from where it has touched, and takes
    the length of the tool for a part of the way.
    """

    def __init__(self, seed: int, faults: bool = True) -> None:
        self.choose = random.Random(seed)
        self.faults = faults
        self.lost: set[str] = set()
        self.incremental = False
        self.paced = False
        self.modes, other = ("G90", "G91", "G17"), self.choose.random() < 0.5
        self.kinds: tuple[str, ...] = ("move", "move", "thread", "thread", "tap", "probe", "mode")
        if other:
            self.modes += ("G55", "G54", "G10 L2 P1 X1 Y2 Z3", "G43.1 Z4", "G49")
            self.kinds = tuple(kind for kind in self.kinds if kind != "probe")

    def text(self) -> bytes:
        blocks = [self.chance("G20", 0.2) or "G21", "F100 G0 X1 Y2 Z3", self.spindle()]
        for _ in range(self.choose.randint(3, 9)):
            blocks.append(self.block())
        return "\n".join([*blocks, "M2", ""]).encode()

    def spindle(self) -> str:
        if self.faults and self.choose.random() < 0.06:
            return self.choose.choice(("M5", "S100"))
        return self.choose.choice(("S100 M3", "S200 M4"))

    def chance(self, text: str, part: float) -> str:
        return text if self.choose.random() < part else ""

    def block(self) -> str:
        kind = self.choose.choice(self.kinds)
        if kind == "mode":
            mode = self.choose.choice(self.modes)
            self.incremental = {"G90": False, "G91": True}.get(mode, self.incremental)
            return mode
        axes = self.axes()
        text = getattr(self, kind)(" ".join(f"{a}{self.number()}" for a in axes))
        if kind != "tap" and not self.incremental:
            self.lost -= set(axes)
        if kind == "probe":
            self.lost |= set(axes)
        return self.spoiled(text)

    def axes(self) -> list[str]:
        """Return the axes of a move: none of which the position is lost in G91."""
        free = [a for a in "XYZ" if not (self.incremental and a in self.lost)] or ["A"]
        return sorted(self.choose.sample(free, self.choose.randint(1, len(free))))

    def number(self) -> str:
        return f"{self.choose.randint(-40000, 40000) / 1000 or 1:g}"

    def move(self, words: str) -> str:
        self.paced = False
        return f"{self.choose.choice(('G0', 'G1'))} {words}"

    def thread(self, words: str) -> str:
        code = "" if self.paced and self.choose.random() < 0.5 else "G33 "
        self.paced = True
        return f"{code}{words} K{self.choose.choice(('1.5', '0.8', '-2', '.05'))}"

    def tap(self, words: str) -> str:
        self.paced = False
        if "A" in words:
            return self.thread(words)
        return f"G33.1 {words} K1.25{self.chance(' I2', 0.1)}"

    def probe(self, words: str) -> str:
        self.paced = False
        return f"{self.choose.choice(('G38.2', 'G38.3', 'G38.4', 'G38.5'))} {words}"

    def spoiled(self, text: str) -> str:
        """Return a block that may have a word too many or too few."""
        if not self.faults or self.choose.random() > 0.06:
            return text
        words = text.split()
        extra = self.choose.choice(("F50", "I1", "J1", "R1", "K1", "M5", "G95", "G93", "G53", ""))
        if extra and extra[0] not in {word[0] for word in words} - {"G"}:
            return f"{text} {extra}"
        return " ".join(word for word in words if word[0] != "K")


def read_or_refused(program: bytes) -> tuple[gx.Toolpath | None, str]:
    try:
        return toolpaths.read(program), ""
    except gx.InputError as error:
        return None, str(error)


def test_threads_taps_and_probes_move_as_linuxcnc_moves() -> None:
    read = refused = forms = 0
    for first in range(0, COUNT, CHUNK):
        programs = [Drawn(seed).text() for seed in range(first, first + CHUNK)]
        for program, answer in zip(programs, rs274.run_many(programs), strict=True):
            path, error = read_or_refused(program)
            if path is None:
                alone = not isinstance(answer, rs274.Rejected)
                assert not alone or ALONE.search(error), f"{error}\n{program.decode()}"
                refused += 1
                continue
            assert isinstance(answer, CanonProgram), f"{answer}\n{program.decode()}"
            problem = toolpaths.difference(path, answer)
            assert problem == "", f"{problem}\n{program.decode()}"
            read += 1
            forms += len(set(path.form.tolist()))
    assert read > COUNT / 2
    assert refused > COUNT / 20
    assert forms > 2 * read


def test_linuxcnc_makes_the_same_moves_of_what_is_written() -> None:
    """Distances made absolute, and lines cut: threads, taps and probes stay what they were."""
    chain = laws.pipeline(laws.chain_of("absolute"), "linuxcnc")
    programs = [Drawn(seed, faults=False).text() for seed in range(COUNT // 2)]
    done = [(program, laws.transformed(chain, program)) for program in programs]
    jobs = [(program, result.text) for program, result in done if result is not None]
    before = rs274.run_many([job[0] for job in jobs])
    after = rs274.run_many([job[1] for job in jobs])
    for job, old, new in zip(jobs, before, after, strict=True):
        text = b"\n---\n".join(job).decode()
        assert isinstance(old, CanonProgram), f"{old}\n{text}"
        assert isinstance(new, CanonProgram), f"{new}\n{text}"
        assert [(m.kind, m.feed_mode) for m in old.moves] == [
            (m.kind, m.feed_mode) for m in new.moves
        ], text
        for one, other in zip(old.moves, new.moves, strict=True):
            gap = max(abs(one.end[axis] - other.end[axis]) for axis in "XYZA")
            assert gap <= NEAR, f"{one}\n{other}\n{text}"
    assert len(jobs) > 0.8 * len(programs)
