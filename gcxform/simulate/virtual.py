"""The three tests: what is measured before and after compensation, and the figures of both.

Each test writes its standard program, runs the virtual machine with it, compensates the program by
the pipeline, reads what came out, and runs the machine again. Noise is the same in both runs.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from typing import Generic, TypeVar

import numpy as np

from gcxform.diagnostics import UsageError
from gcxform.errormodel.model import AXES, ErrorModel, Outside
from gcxform.simulate.circles import Circles
from gcxform.simulate.drives import NONE, STILL, Drives
from gcxform.simulate.figures import Positioning
from gcxform.simulate.positions import Chain, Compensated, Track
from gcxform.simulate.programs import (
    PLANES,
    SENSES,
    Line,
    StandardProgram,
    circles,
    linear_cycles,
)
from gcxform.system.arrays import Floats
from gcxform.system.stages import stage
from gcxform.values import dataclass

POINTS_AROUND = 7200  # points of a circle: one every 0.05 degrees
NEVER = 1e9  # mm; spacing of points where only the ends of moves are read
Reading = TypeVar("Reading")


@dataclass(frozen=True)
class Outcome(Generic[Reading]):
    """What a test reads before and after compensation, by plane, axis or diagonal."""

    program: StandardProgram
    compensated: Compensated
    before: Mapping[str, Reading]
    after: Mapping[str, Reading]


def _outcome(
    chain: Chain,
    program: StandardProgram,
    spacing: float,
    readings: Callable[[Track], Mapping[str, Reading]],
) -> Outcome[Reading]:
    """Run a program as it is and compensated, and read the instrument both times."""
    stage("the program as it is", 0.0)
    before = chain.before(program, spacing)
    _check_inside(chain, before.commanded)
    stage("the program compensated", 1 / 3)
    after, done = chain.after(program, spacing)
    stage("the readings", 2 / 3)
    return Outcome(program, done, readings(before), readings(after))


def _check_inside(chain: Chain, points: Floats) -> None:
    """Refuse a test that leaves the model, before anything is computed from it."""
    model = chain.model.model
    beyond = model.outside(points)
    if chain.outside is not Outside.ERROR or not beyond.any():
        return
    axis = int(np.argmax(beyond.any(axis=0)))
    low, high = model.range_of(axis)
    here = points[:, axis]
    raise UsageError.one(
        "GX738",
        f"the test goes from {AXES[axis]} {here.min():g} to {here.max():g} mm, "
        f"and the error model from {low:g} to {high:g}",
        hint="choose a place and a size within the model, or --outside extrapolate",
    )


def ranges(model: ErrorModel) -> Floats:
    """Return the lowest and highest position (3, 2) in mm; both 0 for an axis without limits."""
    found = np.array([model.range_of(axis) for axis in range(3)])
    found[~np.isfinite(found).all(axis=1)] = 0.0
    return found


# --- ballbar ---


@dataclass(frozen=True)
class Ballbar:
    """A ballbar test: circles of `radius` (mm) about `centre` (mm) in some planes.

    `noise` is the standard deviation in mm of a reading of the bar, drawn from `seed`. `drives` is
    what the axes do besides the errors of the model, and `pivot` how far the pivot of the
    instrument is set off where the machine stood, mm.
    """

    centre: tuple[float, float, float]
    radius: float
    planes: tuple[str, ...] = tuple(PLANES)
    feed: float = 1000.0
    noise: float = 0.0
    seed: int = 0
    drives: Drives = STILL
    pivot: tuple[float, float, float] = NONE

    def run(self, chain: Chain) -> Outcome[Circles]:
        """Return the readings. Raises UsageError if the circles leave the model."""
        decimals = chain.numbers.mm
        program = circles(chain.dialect, decimals, self.centre, self.radius, self.planes, self.feed)
        spacing = 2.0 * np.pi * self.radius / POINTS_AROUND
        return _outcome(chain, program, spacing, lambda t: self._read(program, t))

    def _read(self, program: StandardProgram, track: Track) -> Mapping[str, Circles]:
        """Return both circles of each plane about the pivot, set where the machine stood."""
        random = np.random.default_rng(self.seed)
        found = {}
        for plane in self.planes:
            axes = list(PLANES[plane].axes[:2])
            pivot = track.stops(program.lines[f"{plane} centre"])[0] + self.pivot
            paths = {}
            for sense in SENSES:
                path = (track.on(program.lines[f"{plane} {sense}"][0]) - pivot)[:, axes]
                driven = path + self._driven(path + np.array(self.pivot)[axes], plane, sense)
                paths[sense] = self._disturbed(driven, random)
            found[plane] = Circles(self.radius, paths["cw"], paths["ccw"])
        return found

    def _driven(self, path: Floats, plane: str, sense: str) -> Floats:
        """Return what the drives add to a path (n, 2) about its middle."""
        first, second = PLANES[plane].axes[:2]
        angle = np.arctan2(path[:, 1], path[:, 0])
        middle = np.array([self.centre[first], self.centre[second]])
        turn = 1 if sense == "ccw" else -1
        return self.drives.off(angle, turn, (first, second), (middle, self.radius))

    def _disturbed(self, path: Floats, random: np.random.Generator) -> Floats:
        """Return a path (n, 2) with noise along the bar.

        The noise is that of fixed angles, because the number of points depends on how the circle is
        cut into blocks.
        """
        if not self.noise:
            return path
        angles = np.linspace(-np.pi, np.pi, POINTS_AROUND // 4, endpoint=False)
        values = random.normal(0.0, self.noise, len(angles))
        angle = np.arctan2(path[:, 1], path[:, 0])
        size = np.hypot(path[:, 0], path[:, 1])
        longer = np.interp(angle, angles, values, period=2.0 * np.pi) / size
        return path * (1.0 + longer[:, None])


# --- lines ---


@dataclass(frozen=True)
class LinearTest:
    """A test along lines with a laser: `runs` up and down each of them.

    `noise` is the standard deviation in mm of an approach (repeatability), drawn from `seed`.
    """

    lines: tuple[Line, ...]
    runs: int = 5
    feed: float = 1000.0
    noise: float = 0.0
    seed: int = 0

    def run(self, chain: Chain) -> Outcome[Positioning]:
        """Return the readings. Raises UsageError if a line leaves the model."""
        program = linear_cycles(chain.dialect, chain.numbers.mm, self.lines, self.runs, self.feed)
        return _outcome(chain, program, NEVER, lambda t: self._read(program, t))

    def _read(self, program: StandardProgram, track: Track) -> Mapping[str, Positioning]:
        """Return the deviations along each line; the beam is along the nominal line."""
        random = np.random.default_rng(self.seed)
        found = {}
        for line in self.lines:
            read = {}
            for way in ("up", "down"):
                places = track.stops(program.lines[f"{line.name} {way}"])
                runs = places.reshape(self.runs, len(line.targets), 3)
                ordered = runs if way == "up" else runs[:, ::-1]
                deviation = ((ordered - line.targets) @ line.direction).T
                read[way] = deviation + random.normal(0.0, 1.0, deviation.shape) * self.noise
            found[line.name] = Positioning(line.along, read["up"], read["down"])
        return found


def axis_line(
    axis: int,
    at: Sequence[float],
    low: float,
    high: float,
    count: int,
    beyond: float,
    scatter: float = 0.0,
    seed: int = 0,
) -> Line:
    """Return the targets of an axis between `low` and `high`, the overtravel included, in mm.

    The interval is even plus a random amount up to `scatter` for each target, so that the pitch of
    a screw or scale is not hidden (ISO 230-2:2014, clause 5).
    """
    random = np.random.default_rng([seed, axis])
    inner = beyond + scatter
    places = np.linspace(low + inner, high - inner, count)
    places = np.round(places + random.uniform(-scatter, scatter, count), 3)
    targets = np.tile(np.asarray(at, dtype=np.float64), (count, 1))
    targets[:, axis] = places
    return Line(AXES[axis], targets, beyond)


BODY = ("PPP", "NPP", "PNP", "PPN")
FACES = ("PP0", "NP0", "0PP", "0NP", "P0P", "N0P")


def diagonal_line(name: str, box: Floats, count: int, beyond: float = 0.0) -> Line:
    """Return a diagonal of a box (3, 2) in mm by its name in the manner of ISO 230-6:2002.

    The letters are the senses of X, Y and Z on the way up: P positive, N negative; 0 for an axis
    that stands in the middle of the box, of a face diagonal.
    """
    low, high = box[:, 0], box[:, 1]
    middle = (low + high) / 2.0
    first = np.select([[c == "P" for c in name], [c == "N" for c in name]], [low, high], middle)
    last = np.select([[c == "P" for c in name], [c == "N" for c in name]], [high, low], middle)
    way = last - first
    over = beyond * way / float(np.linalg.norm(way))
    part = np.linspace(0.0, 1.0, count)[:, None]
    first, last = first + over, last - over
    return Line(name, first + part * (last - first), beyond)


def possible(names: Sequence[str], box: Floats) -> tuple[str, ...]:
    """Return the diagonals of a box for which each axis that moves has a range."""
    wide = box[:, 1] > box[:, 0]
    return tuple(
        n for n in names if all(w or c == "0" for c, w in zip(n, wide.tolist(), strict=True))
    )


def largest(readings: Mapping[str, Positioning], names: Sequence[str], symbol: str) -> float:
    """Return the largest figure of some diagonals, mm: E_D and B_D of ISO 230-6:2002."""
    return max(itertools.chain([0.0], (readings[n].figures[symbol] for n in names)))
