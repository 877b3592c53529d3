"""Random programs of frames: lengths, offsets, moves in the machine and ways home, in any order.

LinuxCNC says where its own programs go. On other controls nothing that is written may fail its own
proof: what cannot be said there is refused by name.
"""

from __future__ import annotations

import random
from collections.abc import Callable

import pytest
import seeds_kit
from oracles import rs274
from reference import shop
from shop_kit import by_linuxcnc
from test_across_drawn import CHANGED, DIALECTS, READING

import gcxform as gx
from gcxform.plugin.registry import default_registry

TARGETS = ("linuxcnc", "fanuc", "haas", "grbl", "siemens", "fagor", "heidenhain", "tinyg")
CHAINS = ((), ("absolute",), ("offsets",), ("metric",), ("offsets", "absolute"))
HEAD = ["G21 G90 G17 G94 G40 G49 G80", "G54 S800 M3", "G0 X1 Y2 Z20", "G1 F100 X3"]


class Writer:
    """Draws the blocks of a program; `steps` whether G91 is in force."""

    def __init__(self, seed: int) -> None:
        self.draw = random.Random(seed)
        self.steps = False

    def text(self) -> str:
        kinds: list[Callable[[], str]] = [
            *(self.line, self.line, self.arc, self.length, self.offset, self.preset, self.table),
            *(self.machine, self.home, self.mode),
        ]
        blocks = [self.draw.choice(kinds)() for _ in range(self.draw.randint(3, 14))]
        return "\n".join([*HEAD, *blocks, "G90", "M2", ""])

    def number(self, size: float = 20.0) -> float:
        return round(self.draw.uniform(-size, size), self.draw.choice((0, 1, 3)))

    def words(self, axes: str, least: int = 1) -> str:
        named = self.draw.sample(axes, self.draw.randint(least, len(axes)))
        return " ".join(f"{axis}{self.number()}" for axis in named)

    def line(self) -> str:
        return f"G{self.draw.choice((0, 1))} {self.words('XYZ')}"

    def arc(self) -> str:
        return f"G{self.draw.choice((2, 3))} X{self.number()} Y{self.number()} R60"

    def length(self) -> str:
        by_value = (f"G43.1 {self.words('XZ')}", f"G43.1 Y{self.number(3)}")
        return self.draw.choice((*by_value, "G49", "G43 H1", "G43 H2", "G43.2 H1"))

    def offset(self) -> str:
        return self.draw.choice(("G54", "G55", "G56"))

    def preset(self) -> str:
        return self.draw.choice((f"G92 {self.words('XYZ')}", "G92.1", "G92.2", "G92.3"))

    def table(self) -> str:
        where = f"G10 L2 P{self.draw.choice((1, 2))}"
        return self.draw.choice((f"{where} {self.words('XYZ')}", f"{where} R30", "G10 L20 P1 X3"))

    def machine(self) -> str:
        return f"G53 {self.draw.choice(('G0', 'G0', 'G1', ''))} {self.words('XYZ')}"

    def home(self) -> str:
        return self.draw.choice(("G28", "G28 Z0" if self.steps else "G28 Z90", "G30"))

    def mode(self) -> str:
        if self.draw.random() < 0.5:
            return self.draw.choice(("G20\nF4", "G21\nF100"))
        self.steps = not self.steps
        return "G91" if self.steps else "G90"


@pytest.mark.skipif(not rs274.available(), reason="rs274 (LinuxCNC) is not installed")
@seeds_kit.shares(20_000 if seeds_kit.LONG else 200, 100)
def test_frames_mean_the_same_there(seeds: range) -> None:
    written = 0
    for seed in seeds:
        text, choose = Writer(seed).text(), random.Random(f"chain {seed}")
        try:
            wanted = by_linuxcnc(text)
        except rs274.Rejected:
            continue
        target, names = choose.choice(TARGETS), choose.choice(CHAINS)
        passes = tuple(default_registry().passes[name]() for name in names)
        inert = frozenset({"M6"}) if target in CHANGED else frozenset[str]()
        pipeline = gx.Pipeline(DIALECTS["linuxcnc"], DIALECTS[target], passes, READING, inert=inert)
        try:
            found = pipeline.run(text.encode())
        except gx.VerificationError as error:
            pytest.fail(f"{target} {names}: {error}\n{text}")
        except gx.GcxformError:
            continue
        written += 1
        if target == "linuxcnc":
            differs = shop.differs(wanted, by_linuxcnc(found.text.decode()))
            assert differs is None, f"{names}: {differs}\n{text}\n{found.text.decode()}"
    assert written > len(seeds) // 8, "nearly all was refused"
