"""Programs of canned cycles, drawn at random, and how the kernel plays them.

A program is a list of blocks, each a dictionary of words. It can be written as text for an oracle,
and played: rapids, modes and the spindle here, in the plainest way, and cycles by the kernel.
"""

from __future__ import annotations

import random
from dataclasses import dataclass, field

import numpy as np

from gcxform.dialect.cycle_rule import TAPPING, CycleRule
from gcxform.modal.cycles.expansion import Calls, Cycles, Steps
from gcxform.modal.cycles.steps import Rows
from gcxform.plugin.registry import default_registry
from gcxform.system.arrays import Flags
from gcxform.toolpath.path import Kind, Plane

CODES = (73, 74, 81, 82, 83, 84, 85, 86, 87, 88, 89)
PLANES = {17: Plane.XY, 18: Plane.ZX, 19: Plane.YZ}
Block = dict[str, float]
"""Words by address. G and M codes have keys of their own: "cycle", "plane", "M" and so on."""


def text(blocks: list[Block]) -> bytes:
    """Return a program, ended by M2."""
    lines = [" ".join(_word(*item) for item in block.items()) for block in blocks]
    return "\n".join([*lines, "M2", ""]).encode()


def _word(address: str, value: float) -> str:
    return f"{address if len(address) == 1 else 'G'}{value:.10g}"


def calls(words: list[Block], position: tuple[float, float, float], **more: object) -> Calls:
    """Return calls from words in X, Y, Z; position likewise. `more` are fields of `Calls`."""
    plane = PLANES[int(words[0].get("plane", 17))]
    unit = 25.4 if words[0].get("unit", 21) == 20 else 1.0

    def column(address: str, scale: float = unit) -> np.ndarray:
        return np.array([w.get(address, np.nan) for w in words]) * scale

    first, second, normal = (column("XYZ"[axis]) for axis in plane.axes)
    count = len(words)
    fields = {
        "code": np.array([int(w["cycle"]) for w in words]),
        **{"first": first, "second": second, "normal": normal},
        **{"r": column("R"), "q": column("Q"), "p": column("P", 1.0)},
        "repeats": column("L", 1.0),
        **{a.lower(): column(a) for a in "IJK"},
        "incremental": np.array([w.get("distance", 90) == 91 for w in words]),
        "initial": np.array([w.get("retract", 99) == 98 for w in words]),
        "spindle": np.array([int(w.get("spindle", 1)) for w in words]),
        "turned": np.zeros(count, np.bool_),
        "other_axes": np.array(["A" in w for w in words]),
        "inverse": np.zeros(count, np.bool_),
        "lost": np.zeros(count, np.bool_),
        "line": np.array([int(w.get("line", n)) for n, w in enumerate(words)]),
        "position": np.array([position[axis] for axis in plane.axes]),
        "plane": plane,
        "unit": unit,
    }
    return Calls(**(fields | more))  # type: ignore[arg-type]


def spatial(ends: np.ndarray, plane: Plane) -> np.ndarray:
    """Return points (n, 3) given by the plane's axes as X, Y, Z."""
    points = np.empty_like(ends)
    points[:, list(plane.axes)] = ends
    return points


@dataclass
class Played:
    """Moves as (kind, X, Y, Z), the line of each from 1, and events as (move, text)."""

    moves: list[tuple[str, float, float, float]] = field(default_factory=list)
    lines: list[int] = field(default_factory=list)
    events: list[tuple[int, str]] = field(default_factory=list)
    refused: int = 0  # the line, from 1
    why: str = ""


class Player:
    """Plays blocks; between cycles there are rapids, modes, dwells and the spindle."""

    def __init__(self, rule: CycleRule) -> None:
        self.cycles = Cycles(rule)
        self.position = [0.0, 0.0, 0.0]
        self.modes = {"cycle": 80.0, "plane": 17.0, "unit": 21.0, "distance": 90.0, "retract": 99}
        self.spindle = 0
        self.waiting: list[Block] = []
        self.played = Played()

    def play(self, blocks: list[Block]) -> Played:
        for line, block in enumerate(blocks):
            self._block(block, line)
            if self.played.refused:
                return self.played
        self._flush()
        return self.played

    def _block(self, block: Block, line: int) -> None:
        changes = any(block.get(m, self.modes[m]) != self.modes[m] for m in ("plane", "unit"))
        if changes or "motion" in block or "M" in block or "dwell" in block:
            self._flush()
        self.modes |= {mode: block[mode] for mode in self.modes if mode in block}
        if "M" in block:
            self.spindle = {3: 1, 4: -1, 5: 0}[int(block["M"])]
            self.played.events.append((len(self.played.moves), f"M{block['M']:.0f}"))
        if "dwell" in block:
            self.played.events.append((len(self.played.moves), f"DWELL {block['P']:.10g}"))
        elif "motion" in block:
            self.modes["cycle"] = 80.0
            self.cycles.leave()
            self._rapid(block, line)
        elif self.modes["cycle"] != 80 and ("cycle" in block or set(block) & set("XYZRPQLIJK")):
            self.waiting.append(self.modes | block | {"line": line, "spindle": self.spindle})

    def _rapid(self, block: Block, line: int) -> None:
        if block["motion"] == 80:
            return
        unit = 25.4 if self.modes["unit"] == 20 else 1.0
        for axis, address in enumerate("XYZ"):
            if address in block:
                start = self.position[axis] if self.modes["distance"] == 91 else 0.0
                self.position[axis] = start + block[address] * unit
        x, y, z = self.position
        self.played.moves.append(("RAPID", x, y, z))
        self.played.lines.append(line + 1)

    def _flush(self) -> None:
        if not self.waiting:
            return
        x, y, z = self.position
        stretch = calls(self.waiting, (x, y, z))
        self._take(self.cycles.expand(stretch), stretch)
        self.waiting = []

    def _take(self, steps: Steps, stretch: Calls) -> None:
        before, rows = len(self.played.moves), steps.rows
        made = ~_taps_begin_at_r(rows)
        for kind, end in zip(rows.kind[made], spatial(rows.end[made], stretch.plane), strict=True):
            self.played.moves.append((Kind(kind).name, *map(float, end)))
        self.played.lines += (stretch.line[rows.call[made]] + 1).tolist()
        for event in rows.events:
            time = f" {event.values[0][1]:.10g}" if event.values else ""
            row = before + int(made[: event.row].sum())
            self.played.events.append((row, f"{event.what}{time}"))
        self.position = spatial(steps.after[-1:], stretch.plane)[0].tolist()
        if steps.refusals:
            self.played.refused = int(stretch.line[steps.refusals[0].call]) + 1
            self.played.why = steps.refusals[0].message


def _taps_begin_at_r(rows: Rows) -> Flags:
    """Return the moves of taps down to R that lead nowhere; LinuxCNC makes none of them."""
    tied = rows.synchronised
    to_r = np.append(tied[1:], False)[: len(tied)] & ~tied
    to_r[1:] &= (rows.end[1:] == rows.end[:-1]).all(axis=1)
    return np.asarray(to_r)


# --- cases worked out by hand ---

HOLE: Block = {"X": 1, "Y": 2, "Z": -4, "R": 2}
START = (0.0, 0.0, 10.0)
AXES_OF = {"G17": (17, "XYZ"), "G18": (18, "ZXY"), "G19": (19, "YZX")}
PLANE_OF = {"G17": Plane.XY, "G18": Plane.ZX, "G19": Plane.YZ}


def rule(dialect: str) -> CycleRule:
    found = default_registry().dialect(dialect).cycle_rule
    assert found is not None
    return found


def cycles(dialect: str) -> Cycles:
    return Cycles(rule(dialect), 0.3, 0.4) if dialect == "fanuc" else Cycles(rule(dialect))


def turned(plane: str, block: Block) -> Block:
    """Return a block for G17 as the same one for another plane."""
    number, axes = AXES_OF[plane]
    to = dict(zip("XYZ", axes, strict=True))
    to |= {"IJK"["XYZ".index(a)]: "IJK"["XYZ".index(b)] for a, b in to.items()}
    return {"plane": number, **{to.get(key, key): value for key, value in block.items()}}


def told(steps: Steps) -> str:
    """Return levels and events in the words of the tables."""
    out: list[tuple[float, str]] = []
    for row, (kind, end) in enumerate(zip(steps.rows.kind, steps.rows.end, strict=True)):
        level = round(float(end[2]), 9) + 0.0
        out.append((row, f"{'=' if kind == Kind.LINE else '>'}{level:g}"))
    for event in steps.rows.events:
        what = f"{event.values[0][1]:g}" if event.values else event.what
        out.append((event.row - 0.5, f"!{what}"))
    return " ".join(text for _, text in sorted(out, key=lambda item: item[0]))


def points(steps: Steps, plane: Plane = Plane.XY) -> list[tuple[float, ...]]:
    ends = spatial(steps.rows.end, plane)
    return [tuple(round(value, 9) for value in end) for end in ends.tolist()]


def refusals(steps: Steps) -> list[str]:
    return [f"{refusal.call}: {refusal.message}" for refusal in steps.refusals]


def expanded(dialect: str, *blocks: Block, start: tuple[float, float, float] = START) -> Steps:
    """Return the steps of blocks of which modes stay in force, as in a program."""
    modes: Block = {}
    full = []
    for block in blocks:
        modes |= {m: block[m] for m in ("cycle", "plane", "distance", "retract") if m in block}
        full.append(modes | block)
    return cycles(dialect).expand(calls(full, start))


# --- programs drawn at random ---


class Drawn:
    """Draws a program: mostly right, at times with a word too many or too few."""

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)
        self.mistakes = self.random.random() < 0.3
        self.inch = False
        self.now = {"cycle": 80, "plane": 17, "distance": 90}

    def blocks(self) -> list[Block]:
        blocks: list[Block] = [{"F": 100.0}, {"M": 3.0, "S": 100}]
        blocks.append({"motion": 0, **dict.fromkeys("XYZ", self.number(0, 20))})
        for _ in range(self.random.randint(3, 12)):
            blocks += self.some()
        return blocks

    def some(self) -> list[Block]:
        choice = self.random.random()
        if choice < 0.72:
            block = self.call()
            way = {74: 4.0, 84: 3.0}.get(self.now["cycle"])
            turned = way is not None and (not self.mistakes or self.random.random() < 0.9)
            return [{"M": way}, block] if way is not None and turned else [block]
        if choice < 0.8:
            return [self.rapid()]
        if choice < 0.84:
            self.now["cycle"] = 80
            return [{"motion": 80}]
        if choice < 0.9:
            return [{"M": float(self.random.choice([3, 4, 3, 4, 5] if self.mistakes else [3, 4]))}]
        if choice < 0.93:
            return [{"dwell": 4, "P": 0.5}]
        if choice < 0.96:
            return [{"retract": self.random.choice([98, 99])}]
        self.now |= {"cycle": 80, "distance": 90}
        self.inch = self.random.random() < 0.3
        unit: Block = {"unit": 20 if self.inch else 21, "motion": 0}
        return [{"distance": 90} | unit | dict.fromkeys("XYZ", self.number(0, 20))]

    def rapid(self) -> Block:
        self.now["cycle"] = 80
        axes = self.random.sample("XYZ", self.random.randint(1, 3))
        return {"motion": 0, **{axis: self.number(-5, 20) for axis in axes}}

    def call(self) -> Block:
        block: Block = {}
        before = self.now["cycle"]
        self._modes(block)
        if before == 80 or self.random.random() < 0.35:
            codes = CODES if self.now["plane"] == 17 else [c for c in CODES if c not in TAPPING]
            self.now["cycle"] = block["cycle"] = self.random.choice(codes)
        fresh = self.now["cycle"] != before
        normal = {17: "Z", 18: "Y", 19: "X"}[self.now["plane"]]
        for axis in "XYZ".replace(normal, ""):
            if self.random.random() < 0.6:
                block[axis] = self.number(-10, 10)
        if fresh or self.random.random() < 0.2 or not set(block) & set("XYZ"):
            block[normal] = self.number(-12, 0) if not self.mistakes else self.number(-12, 3)
        if fresh or self.random.random() < 0.2:
            block["R"] = self.number(-8, 12)
            if normal in block and self.now["distance"] == 90:
                block["R"] = round(block[normal] + self.number(0, 12), 4)
        self._parameters(block, fresh)
        if self.mistakes and self.random.random() < 0.15:
            self._mistake(block)
        return block

    def _modes(self, block: Block) -> None:
        if self.random.random() < 0.15:
            self.now["distance"] = block["distance"] = self.random.choice([90, 91])
        if self.random.random() < 0.25:
            block["retract"] = self.random.choice([98, 99])
        chance = {80: 0.3, 74: 0.0, 84: 0.0}.get(self.now["cycle"], 0.02)
        if self.random.random() < chance:
            self.now["plane"] = block["plane"] = self.random.choice([17, 18, 19])

    def _parameters(self, block: Block, fresh: bool) -> None:
        code = self.now["cycle"]
        if code in (73, 83) and (fresh or self.random.random() < 0.2):
            block["Q"] = self.random.choice([0.1, 0.3, 0.5, 1, 2, 7.3, 30])
        dwells = code in (82, 86, 88, 89) and (fresh or self.random.random() < 0.2)
        if dwells or (code in (74, 84) and self.random.random() < 0.2):
            block["P"] = self.random.choice([0, 0.25, 1.5])
        if code == 87 and (fresh or self.random.random() < 0.2):
            block |= {a: self.number(-3, 3) for a in "IJK"}
        if self.random.random() < 0.15:
            block["L"] = self.random.choice([1, 2, 3])

    def _mistake(self, block: Block) -> None:
        if self.random.random() < 0.5 and len(block) > 1:
            del block[self.random.choice([address for address in block if address != "cycle"])]
            return
        address = self.random.choice("PQIJKLA")
        block[address] = self.random.choice([0, 1, 2])

    def number(self, low: int, high: int) -> float:
        scale = self.random.choice([1, 2, 1000])
        value = self.random.randint(low * scale, high * scale) / scale
        return round(value / 10, 4) if self.inch else value
