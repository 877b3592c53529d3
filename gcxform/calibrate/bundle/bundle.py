"""All rotary axes at once, from balls at any poses, with the squareness of the linear axes.

A machine whose axes are known says where X, Y and Z stand when the tip is at the centre of a ball;
the unknowns are what moves these readings: of each rotary axis two shifts across it and two tilts,
the place of each ball, and of the linear axes two differences of scale and three squarenesses.
With M their errors (the actual is the nominal position plus M times it) a reading is

    q = (I + M)^-1 p,    p = where the chain has to stand

The absolute scale is one more unknown that nothing tells: points, balls and readings grow together.
Least squares with central differences of the chain; a robust fit finds outliers, as in `rotary`.
What the readings do not determine is refused, with the direction in which nothing changes.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cached_property, lru_cache
from typing import Final

import numpy as np

from gcxform.calibrate.rotary.axis import OUTLYING, REJECTED
from gcxform.calibrate.solution import CAUCHY, TIGHT, Scatter, belonging, cauchy
from gcxform.diagnostics import InputError, Location
from gcxform.machine.chain import Chain, Rotary
from gcxform.system.arrays import Flags, Floats
from gcxform.system.stages import stage
from gcxform.values import dataclass

BLIND: Final = 1e-7
"""Singular values below this part of the largest, columns of length 1, tell nothing."""
LINEAR: Final = ("scale Y - X", "scale Z - X", "C0Y", "B0Z", "A0Z", "scale")
MODES: Final = {"none": 0, "differences": 5, "absolute": 6}
SHIFT: Final = 1e-2  # mm, of the differences
TILT: Final = 1e-4  # rad


@dataclass(frozen=True, eq=False)
class Poses:
    """Ball centres (n, 3) in mm, angles (n, axes) in degrees, which ball (n,), and the places."""

    degrees: Floats
    ball: tuple[str, ...]
    points: Floats
    where: Callable[[int], Location | None] = lambda row: None

    @cached_property
    def balls(self) -> tuple[str, ...]:
        """The names of the balls, as they come."""
        return tuple(dict.fromkeys(self.ball))

    @cached_property
    def index(self) -> list[int]:
        """Of each row the place of its ball in `balls`."""
        return [self.balls.index(name) for name in self.ball]


@dataclass(frozen=True, eq=False)
class Layout:
    """The unknowns: of each axis two shifts and two tilts, of each ball three, linear ones."""

    chain: Chain
    poses: Poses
    linear: int

    @cached_property
    def names(self) -> tuple[str, ...]:
        """The names of the unknowns."""
        ways = ("shift 1", "shift 2", "tilt 1", "tilt 2")
        axes = [f"{letter} {way}" for letter in self.chain.letters for way in ways]
        balls = [f"ball {name} {letter}" for name in self.poses.balls for letter in "XYZ"]
        return (*axes, *balls, *LINEAR[: self.linear])

    @cached_property
    def steps(self) -> Floats:
        """The sizes (k,) of the differences: mm, rad or mm per mm."""
        shifted = [SHIFT, SHIFT, TILT, TILT] * len(self.chain.axes)
        balls = [SHIFT] * (3 * len(self.poses.balls))
        return np.array(shifted + balls + [TILT] * self.linear)

    def start(self) -> Floats:
        """Return the unknowns (k,) of the machine as it is believed to be."""
        found = np.zeros(len(self.names))
        tips = self.chain.tip_at(self.poses.points, self.poses.degrees)
        index = np.array(self.poses.index)
        first = 4 * len(self.chain.axes)
        for k in range(len(self.poses.balls)):
            found[first + 3 * k : first + 3 * k + 3] = tips[index == k].mean(axis=0)
        return found

    def machine(self, unknowns: Floats) -> Chain:
        """Return the chain with its axes shifted and tilted."""
        axes = [moved(axis, unknowns[4 * k : 4 * k + 4]) for k, axis in enumerate(self.chain.axes)]
        count = len(self.chain.table)
        return replace(self.chain, table=tuple(axes[:count]), head=tuple(axes[count:]))

    def errors(self, unknowns: Floats) -> Floats:
        """Return M (3, 3): the errors of the linear axes, mm per mm."""
        values = np.zeros(6)
        if self.linear:
            values[: self.linear] = unknowns[-self.linear :]
        y, z, c0y, b0z, a0z, scale = values.tolist()
        return np.array([[scale, -c0y, b0z], [0.0, scale + y, -a0z], [0.0, 0.0, scale + z]])

    def readings(self, unknowns: Floats) -> Floats:
        """Return what X, Y and Z (n, 3) read, mm."""
        first = 4 * len(self.chain.axes)
        balls = unknowns[first : first + 3 * len(self.poses.balls)].reshape(-1, 3)
        stands = self.machine(unknowns).linear(balls[self.poses.index], self.poses.degrees)
        return np.asarray(np.linalg.solve(np.eye(3) + self.errors(unknowns), stands.T).T)

    def design(self, unknowns: Floats) -> Floats:
        """Return what each unknown does to the readings, (3 n, k)."""
        columns = []
        for k, size in enumerate(self.steps.tolist()):
            step = np.zeros(len(unknowns))
            step[k] = size
            apart = self.readings(unknowns + step) - self.readings(unknowns - step)
            columns.append(apart.ravel() / (2.0 * size))
        return np.column_stack(columns)


@dataclass(frozen=True, eq=False)
class Bundled:
    """A machine as measured: the unknowns, what was kept, and the stated noise in mm."""

    layout: Layout
    noise: float
    unknowns: Floats
    kept: Flags

    @property
    def chain(self) -> Chain:
        """The machine with the axes that were found."""
        return self.layout.machine(self.unknowns)

    @cached_property
    def residuals(self) -> Floats:
        """Measured minus fitted readings (n, 3), mm."""
        return np.asarray(self.layout.poses.points - self.layout.readings(self.unknowns))

    @cached_property
    def _design(self) -> Floats:
        return self.layout.design(self.unknowns)

    @cached_property
    def standardised(self) -> Floats:
        """The largest of the three residuals of each pose over its standard deviation, (n,)."""
        weights, noise = self.kept.astype(float), self.scatter.effective
        size = _standardised(self._design, self.residuals, weights, noise)
        return np.asarray(size.max(axis=1))

    @cached_property
    def scatter(self) -> Scatter:
        """What the residuals say of the noise."""
        total = float((self.residuals[self.kept] ** 2).sum())
        return Scatter(self.noise, total / self.noise**2, self.redundancy)

    @cached_property
    def covariance(self) -> Floats:
        """The covariance (k, k) of the unknowns, for the effective noise."""
        kept = self._design[np.repeat(self.kept, 3)]
        return np.asarray(self.scatter.effective**2 * np.linalg.inv(kept.T @ kept))

    @property
    def condition(self) -> float:
        """The condition number of the design, its columns of length 1."""
        return float(np.linalg.cond(_scaled(self._design[np.repeat(self.kept, 3)])))

    @property
    def redundancy(self) -> int:
        """How many more numbers were measured than unknowns."""
        return 3 * int(self.kept.sum()) - len(self.unknowns)

    @property
    def rms(self) -> float:
        """The noise of a coordinate that the residuals show, mm; nan without redundancy."""
        total = float((self.residuals[self.kept] ** 2).sum())
        return math.sqrt(total / self.redundancy) if self.redundancy > 0 else math.nan

    def spread(self, name: str) -> float:
        """Return the standard deviation of an unknown."""
        k = self.layout.names.index(name)
        return math.sqrt(float(self.covariance[k, k]))


def bundle(chain: Chain, poses: Poses, noise: float, linear: str = "differences") -> Bundled:
    """Return the machine that agrees with the poses; `linear` is one of `MODES`.

    Raises InputError: unknowns that the poses do not determine (GX489), residuals above `REJECTED`
    times the noise (GX475), or a fit that does not converge (GX486).
    """
    layout = Layout(chain, poses, MODES[linear])
    start = layout.start()
    whole = np.ones(len(poses.points))
    check(layout, start)
    unknowns = _fitted(layout, start, whole)
    kept = _believed(layout, unknowns, noise)
    if not kept.all():
        unknowns = _fitted(layout, unknowns, kept.astype(float))
    found = Bundled(layout, noise, unknowns, kept)
    if found.rms > REJECTED * noise:
        raise InputError.one(
            "GX475",
            f"the readings are off by {found.rms * 1e3:.3g} um rms, more than {REJECTED:g} times "
            f"the noise of {noise * 1e3:.3g} um",
            poses.where(int(found.standardised.argmax())),
            "the worst is marked; look at angles, signs and units, or state the noise there is",
        )
    return found


def check(layout: Layout, unknowns: Floats) -> None:
    """Raise InputError (GX489) for unknowns that can change together without a reading changing."""
    design = layout.design(unknowns)
    if len(design) < len(unknowns):
        message = f"{len(design)} readings do not determine {len(unknowns)} unknowns"
        raise InputError.one("GX489", message, layout.poses.where(0), "probe more poses")
    for row in blind(layout, design):
        raise InputError.one(
            "GX489",
            f"the readings determine {rank(design)} of {len(unknowns)} unknowns: these change "
            f"together, and no reading does: {worded(layout, row)}",
            layout.poses.where(0),
            "the absolute scale is never determined; leave unknowns out (--linear), or probe poses "
            "that turn each axis while the others stand elsewhere",
        )


def rank(design: Floats) -> int:
    """Return how many unknowns the readings determine."""
    values = np.linalg.svd(_scaled(design), compute_uv=False)
    return int((values > BLIND * values[0]).sum())


def blind(layout: Layout, design: Floats) -> Floats:
    """Return the directions (m, k) among the unknowns in which no reading changes, largest 1."""
    _, values, rows = np.linalg.svd(_scaled(design))
    hidden = rows[values <= BLIND * values[0]] / _lengths(design)
    largest = np.take_along_axis(hidden, np.abs(hidden * _lengths(design)).argmax(1)[:, None], 1)
    return np.asarray(hidden / largest)


def worded(layout: Layout, row: Floats) -> str:
    """Return a direction among the unknowns in words, for one millimetre or milliradian."""
    if "scale" in layout.names and row[layout.names.index("scale")]:
        row = row / row[layout.names.index("scale")]
    seen = np.abs(row) > 1e-4 * np.abs(row).max()
    pairs = zip(layout.names, row.tolist(), seen.tolist(), strict=True)
    return " with ".join(f"{name} {value:+.4g}" for name, value, said in pairs if said)


def _fitted(
    layout: Layout, start: Floats, scale: Floats, loss: str | Callable[[Floats], Floats] = "linear"
) -> Floats:
    """Return the unknowns of least squares of residuals times a scale. Raises InputError (GX486).

    `scale` (n,) is of the poses, `loss` as scipy takes it.
    """
    from scipy.optimize import least_squares

    rows = np.repeat(scale, 3)

    def design(unknowns: Floats) -> Floats:
        stage("fitting the axes")
        return np.asarray(layout.design(unknowns) * rows[:, None])

    found = least_squares(
        lambda unknowns: (layout.readings(unknowns) - layout.poses.points).ravel() * rows,
        start,
        design,
        x_scale="jac",
        loss=loss,
        **TIGHT,
    )
    if not found.success:
        message = "the ball centres do not agree with this machine: the fit does not converge"
        raise InputError.one("GX486", message, layout.poses.where(0))
    return np.asarray(found.x)


def _believed(layout: Layout, start: Floats, noise: float) -> Flags:
    """Return which poses belong to the rest, by a robust fit."""
    unknowns = _fitted(layout, start, np.full(len(layout.poses.points), 1.0 / noise), cauchy)
    size = np.linalg.norm(layout.poses.points - layout.readings(unknowns), axis=1) / noise
    weights = 1.0 / (1.0 + (size / CAUCHY) ** 2)
    away = layout.poses.points - layout.readings(unknowns)
    design = layout.design(unknowns)
    kept = belonging(_standardised(design, away, weights, noise), OUTLYING)
    few = 4 * (~kept).sum() <= len(kept)
    enough = few and rank(design[np.repeat(kept, 3)]) == len(unknowns)
    return kept if enough else np.ones(len(kept), dtype=bool)


def _standardised(design: Floats, away: Floats, weights: Floats, noise: float) -> Floats:
    weighted = design * np.repeat(weights, 3)[:, None]
    lengths = _lengths(design)
    inverse = np.linalg.pinv((weighted / lengths).T @ (design / lengths))
    taken = np.einsum("ni,ij,nj->n", design / lengths, inverse, weighted / lengths)
    spread = noise * np.sqrt(np.clip(1.0 - taken, 1e-6, None))
    return np.asarray((np.abs(away.ravel()) / spread).reshape(-1, 3))


def moved(axis: Rotary, step: Floats) -> Rotary:
    """Return an axis shifted (2, mm) and tilted (2, rad) along two directions across it."""
    first, second = across(axis)
    point = np.array(axis.point) + step[0] * first + step[1] * second
    direction = np.array(axis.direction) + step[2] * first + step[3] * second
    x, y, z = (direction / np.linalg.norm(direction)).tolist()
    u, v, w = point.tolist()
    return replace(axis, direction=(x, y, z), point=(u, v, w))


@lru_cache(64)  # a fit moves the same few axes thousands of times
def across(axis: Rotary) -> Floats:
    """Return two unit vectors (2, 3) across an axis, near those of the machine."""
    along = np.array(axis.direction)
    near = np.eye(3)[(int(np.abs(along).argmax()) + 1) % 3]
    first = near - (near @ along) * along
    (x, y, z), (u, v, w) = axis.direction, (first / np.linalg.norm(first)).tolist()
    found = np.array([[u, v, w], [y * w - z * v, z * u - x * w, x * v - y * u]])
    found.flags.writeable = False  # others are given the same
    return found


def _lengths(design: Floats) -> Floats:
    return np.asarray(np.linalg.norm(design, axis=0))


def _scaled(design: Floats) -> Floats:
    lengths = _lengths(design)
    return np.asarray(design / np.where(lengths > 0.0, lengths, 1.0))
