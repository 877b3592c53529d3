"""The standard programs: the G-code that moves a machine through a test.

They are programs as a machine is given them, with a dwell where an instrument reads. The lines
that matter to the evaluation are kept with the text.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field

import numpy as np

from gcxform.dialect.dialect import Dialect
from gcxform.errormodel.model import AXES
from gcxform.system.arrays import Floats
from gcxform.toolpath.path import Plane
from gcxform.values import dataclass

DWELL = 2.0  # s: the machine stands still before the instrument reads
PLANES: Mapping[str, Plane] = {"XY": Plane.XY, "YZ": Plane.YZ, "ZX": Plane.ZX}
SENSES: Mapping[str, str] = {"ccw": "G3", "cw": "G2"}
_SELECT = {"XY": "G17", "YZ": "G19", "ZX": "G18"}


@dataclass(frozen=True)
class StandardProgram:
    """A program and where it is read.

    `lines` names the lines (from 0) that the evaluation asks for: for a circle the line of the
    circle, for a target the line at whose end the machine stands on it.
    """

    text: bytes
    lines: Mapping[str, tuple[int, ...]]


@dataclass
class _Writer:
    """Blocks of a program in the making; `decimals` of a millimetre."""

    dialect: type[Dialect]
    decimals: int
    feed: float
    blocks: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.blocks += [f"G21 G90 G17 G94 F{self.feed:g}" + ("" if self.feed % 1 else ".")]

    def number(self, value: float) -> str:
        """Return a length with its point and without trailing zeros."""
        text = f"{round(value, self.decimals) + 0.0:.{self.decimals}f}"
        return text.rstrip("0") if self.decimals else f"{text}."

    def words(self, letters: str, values: Sequence[float] | Floats) -> str:
        return " ".join(f"{a}{self.number(float(v))}" for a, v in zip(letters, values, strict=True))

    def move(self, point: Sequence[float] | Floats, dwell: bool = True) -> int:
        """Go straight to a point, stand there, and return the line of the move."""
        self.blocks.append(f"G1 {self.words(AXES, point)}")
        line = len(self.blocks) - 1
        if dwell:
            self.dwell()
        return line

    def dwell(self) -> None:
        rule = self.dialect.point_rule
        letter = next(iter([a for a, unit in rule.dwell.items() if unit == 1.0] or rule.dwell))
        unit = rule.seconds(letter, pointed=True)
        point = "." if unit == 1.0 else ""
        self.blocks.append(f"G4 {letter}{DWELL / unit:.0f}{point}")

    def circle(self, plane: str, sense: str, start: Sequence[float], radius: float) -> int:
        """Go around a full circle from `start`, at angle 0, back to it; return the line.

        The end is written although it is the start: some controls want it.
        """
        first, second, _ = PLANES[plane].axes
        both = sorted((first, second))
        end = self.words("".join(AXES[k] for k in both), [start[k] for k in both])
        centre = [-radius if k == first else 0.0 for k in both]
        centres = self.words("".join("IJK"[k] for k in both), centre)
        self.blocks.append(f"{_SELECT[plane]} {SENSES[sense]} {end} {centres}")
        self.dwell()
        return len(self.blocks) - 2

    @property
    def text(self) -> bytes:
        return "\n".join([*self.blocks, "M30", ""]).encode("ascii")


def circles(
    dialect: type[Dialect],
    decimals: int,
    centre: Sequence[float],
    radius: float,
    planes: Sequence[str],
    feed: float,
) -> StandardProgram:
    """Return the program of a ballbar test: in each plane the centre, then both circles.

    The machine first stands at the centre (mm), where the pivot of the instrument is set. Lines are
    `XY centre`, `XY ccw`, `XY cw` and so on. The circles start at angle 0 of their plane, on its
    first axis, which for ZX is Z (G18).
    """
    writer = _Writer(dialect, decimals, feed)
    lines: dict[str, tuple[int, ...]] = {}
    for plane in planes:
        start = list(centre)
        start[PLANES[plane].axes[0]] += radius
        lines[f"{plane} centre"] = (writer.move(centre),)
        writer.move(start)
        for sense in SENSES:
            lines[f"{plane} {sense}"] = (writer.circle(plane, sense, start, radius),)
    return StandardProgram(writer.text, lines)


@dataclass(frozen=True)
class Line:
    """A straight line of targets, in mm: the targets (m, 3), and `beyond`, the overtravel.

    The line runs from the first to the last target.
    """

    name: str
    targets: Floats
    beyond: float = 0.0

    @property
    def direction(self) -> Floats:
        """The unit vector (3,) of the way up."""
        way = self.targets[-1] - self.targets[0]
        unit: Floats = way / float((way @ way) ** 0.5)
        return unit

    @property
    def along(self) -> Floats:
        """The targets (m,) in mm: positions of an axis, or distances from the first target."""
        found: Floats = self.targets @ self.direction
        return found if np.count_nonzero(self.direction) == 1 else found - found[0]


def linear_cycles(
    dialect: type[Dialect], decimals: int, lines: Sequence[Line], runs: int, feed: float
) -> StandardProgram:
    """Return the program of the standard linear cycle on each line (ISO 230-2:2014, clause 5).

    Every run goes up through all targets, beyond the last one, and down through all of them, so
    that each is approached from both sides. Lines are `NAME up` and `NAME down`, run by run.
    """
    writer = _Writer(dialect, decimals, feed)
    found: dict[str, tuple[int, ...]] = {}
    for line in lines:
        over = line.beyond * line.direction
        up: list[int] = []
        down: list[int] = []
        writer.move(line.targets[0] - over, dwell=False)
        for _ in range(runs):
            up += [writer.move(target) for target in line.targets]
            if line.beyond:
                writer.move(line.targets[-1] + over, dwell=False)
            down += [writer.move(target) for target in line.targets[::-1]]
            if line.beyond:
                writer.move(line.targets[0] - over, dwell=False)
        found |= {f"{line.name} up": tuple(up), f"{line.name} down": tuple(down)}
    return StandardProgram(writer.text, found)
