"""Where a rotary axis is, from centres of a ball at known angles: direction, point, covariance.

A ball on the table is probed at angles q, all other rotary axes at 0. Its centres are

    p = c + R(V, q) a        (a square to V, c on the axis in the plane of the circle)

with seven unknowns: c, three small turns of the figure, its radius. The start is linear, p = c + u
cos q + w sin q, and V is along u x w, so that the sense of the axis comes from the angles; then
least squares (reference: estimators with encoder angles). The shift along V changes nothing,
so the point that is given is c. A probe in a turning head goes round a fixed ball by the same
equation, and the axis is where the tip was at 0, plus a.

A robust fit (Cauchy) finds readings that do not belong to the rest; the result is the least-squares
fit of the rest, and those left out are named. The covariance is that of the noise that the
residuals show, or of the stated one if that is more.

The weights of the robust fit alone would make the covariance a guess.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cached_property
from typing import Final

import numpy as np

from gcxform.calibrate.rotary.circle import Circles, fit_circles, upright
from gcxform.calibrate.solution import CAUCHY, TIGHT, Scatter, belonging, cauchy
from gcxform.diagnostics import InputError, Location
from gcxform.machine.chain import Triple, turned
from gcxform.system.arrays import Flags, Floats
from gcxform.values import dataclass

UNKNOWNS: Final = 7
ILL: Final = 20.0
HOPELESS: Final = 100.0
"""Condition numbers of (cos q, sin q, 1) from which the result is poor, and refused."""
OUTLYING: Final = 4.0
"""Standardised residuals above this are outliers."""
REJECTED: Final = 3.0
"""Residuals above this many times the stated noise contradict each other."""
EVEN: Final = 1.4  # times the gap of even positions: three at 180 degrees are not around a turn


@dataclass(frozen=True, eq=False)
class Centres:
    """Centres of a ball (n, 3) in mm at angles (n,) in degrees; `where` is the place of one."""

    degrees: Floats
    points: Floats
    where: Callable[[int], Location | None] = lambda row: None

    def __len__(self) -> int:
        return len(self.degrees)


@dataclass(frozen=True, eq=False)
class Figure:
    """Points that go round: c + R(direction, q) arm, right-handed; lengths in mm."""

    centre: Floats
    direction: Floats
    arm: Floats

    @property
    def radius(self) -> float:
        """The length of the arm, mm."""
        return float(np.linalg.norm(self.arm))

    def arms(self, degrees: Floats) -> Floats:
        """Return the arm (n, 3) at angles (n,)."""
        return turned(np.tile(self.arm, (len(degrees), 1)), _triple(self.direction), degrees)

    def moved(self, step: Floats) -> Figure:
        """Return the figure shifted (3), turned (3, rad) about its centre, and grown (1, mm)."""
        angle = float(np.linalg.norm(step[3:6]))
        about = _triple(step[3:6] / angle) if angle else (0.0, 0.0, 1.0)
        frame = turned(np.array([self.direction, self.arm]), about, np.degrees([angle, angle]))
        direction = frame[0] / np.linalg.norm(frame[0])
        arm = frame[1] - (frame[1] @ direction) * direction
        arm *= (self.radius + step[6]) / np.linalg.norm(arm)
        return Figure(self.centre + step[:3], direction, arm)


@dataclass(frozen=True, eq=False)
class Placed:
    """A rotary axis as measured: the figure, what was kept, and what was assumed.

    `tip` is the tip of the probe with all axes at 0 if the axis turns the head, None for the table.
    """

    centres: Centres
    noise: float
    kept: Flags
    figure: Figure
    free: Circles
    tip: Triple | None = None

    @property
    def direction(self) -> Floats:
        """The unit vector (3,) along the axis, its largest component positive."""
        return upright(self.figure.direction)

    @property
    def sign(self) -> int:
        """+1 where a positive command turns right-handed about the direction."""
        return 1 if float(self.direction @ self.figure.direction) > 0.0 else -1

    @property
    def point(self) -> Floats:
        """A point (3,) on the axis in machine coordinates, mm."""
        if self.tip is None:
            return self.figure.centre + 0.0
        return np.asarray(self.figure.arm + self.tip)

    @cached_property
    def residuals(self) -> Floats:
        """Measured minus fitted centres (n, 3), mm."""
        return residuals(self.centres, self.figure)

    @cached_property
    def standardised(self) -> Floats:
        """The largest of the three residuals of each centre over its standard deviation, (n,)."""
        weights, noise = self.kept.astype(float), self.scatter.effective
        return np.asarray(standardised(self.centres, self.figure, noise, weights).max(axis=1))

    @property
    def redundancy(self) -> int:
        """How many more numbers were measured than unknowns."""
        return 3 * int(self.kept.sum()) - UNKNOWNS

    @property
    def rms(self) -> float:
        """The noise of a coordinate that the residuals show, mm."""
        total = float((self.residuals[self.kept] ** 2).sum())
        return math.sqrt(total / self.redundancy)

    @property
    def condition(self) -> float:
        """The condition number of (cos q, sin q, 1) of the centres kept."""
        return condition(self.centres.degrees[self.kept])

    @cached_property
    def scatter(self) -> Scatter:
        """What the residuals say of the noise."""
        total = float((self.residuals[self.kept] ** 2).sum())
        return Scatter(self.noise, total / self.noise**2, self.redundancy)

    @cached_property
    def covariance(self) -> Floats:
        """The covariance (6, 6) of point (mm) and direction, for the effective noise."""
        moves = self.moves
        return np.asarray(moves @ self.of_unknowns @ moves.T)

    @cached_property
    def of_unknowns(self) -> Floats:
        """The covariance (7, 7) of shift, turn (rad) and growth of the figure, mm."""
        design = jacobian(self.figure, self.centres.degrees[self.kept]).reshape(-1, UNKNOWNS)
        return np.asarray(self.scatter.effective**2 * np.linalg.inv(design.T @ design))

    @property
    def moves(self) -> Floats:
        """What the unknowns do to point and direction (6, 7)."""
        shift = np.hstack([np.eye(3), np.zeros((3, 4))])
        if self.tip is not None:
            shift = jacobian(self.figure, np.zeros(1))[0] - shift
        tilt = np.hstack([np.zeros((3, 3)), -crossing(self.direction), np.zeros((3, 1))])
        return np.vstack([shift, tilt])


def locate(
    centres: Centres, noise: float, tip: Triple | None = None, *, robust: bool = True
) -> Placed:
    """Return the axis that turns a ball, or a probe with its tip at `tip`; `noise` in mm.

    Raises InputError: centres that are no circle (GX486), positions that do not determine it
    (GX487), residuals above `REJECTED` times the noise (GX475).
    """
    check(centres, noise)
    kept = np.ones(len(centres), dtype=bool)
    figure = fitted(centres, kept.astype(float))
    if robust and len(centres) > 3:
        kept = _believed(centres, figure, noise)
        figure = fitted(centres, kept.astype(float), figure)
    free = fit_circles(centres.points[kept])
    found = Placed(centres, noise, kept, figure, free, tip)
    if not bool(free.converged):
        _refuse(centres, "the centres are not on a circle: the fit does not converge")
    if found.rms > REJECTED * noise:
        raise InputError.one(
            "GX475",
            f"the centres are off a circle with these angles by {found.rms * 1e3:.3g} um rms, more "
            f"than {REJECTED:g} times the noise of {noise * 1e3:.3g} um",
            centres.where(int(found.standardised.argmax())),
            "the worst is marked; look at angles, signs and units, or state the noise there is "
            "(--noise)",
        )
    return found


def _believed(centres: Centres, start: Figure, noise: float) -> Flags:
    """Return which centres belong to the rest, by a robust fit."""
    figure = fitted(centres, np.full(len(centres), 1.0 / noise), start, cauchy)
    size = np.linalg.norm(residuals(centres, figure), axis=1) / noise
    weights = 1.0 / (1.0 + (size / CAUCHY) ** 2)
    kept = belonging(standardised(centres, figure, noise, weights), OUTLYING)
    enough = distinct(centres.degrees[kept]) >= 4 and 4 * (~kept).sum() <= len(centres)
    return kept if enough else np.ones(len(centres), dtype=bool)


def without_each(found: Placed) -> tuple[Floats, Floats]:
    """Return what leaving out each centre changes: the point (n, 3) in mm, the direction (n, 3).

    A shift along the axis is no change. nan where the others alone do not determine the axis.
    """
    across = np.eye(3) - np.outer(found.direction, found.direction)
    point, direction = np.full((2, len(found.centres), 3), np.nan)
    for k in np.flatnonzero(found.kept):
        kept = found.kept.copy()
        kept[k] = False
        degrees = found.centres.degrees[kept]
        if distinct(degrees) >= 3 and condition(degrees) <= HOPELESS:
            figure = fitted(found.centres, kept.astype(float), found.figure)
            other = Placed(found.centres, found.noise, kept, figure, found.free, found.tip)
            point[k] = across @ (other.point - found.point)
            direction[k] = other.direction - found.direction
    return point, direction


# --- what can be refused before ---


def check(centres: Centres, noise: float) -> None:
    """Raise InputError for centres that cannot be those of a turning ball (GX486, GX487)."""
    degrees, points = centres.degrees, centres.points
    if len(degrees) < 3:
        _refuse(centres, f"{len(degrees)} centres are no circle: three are the least")
    _check_twice(centres)
    if distinct(degrees) < 3:
        _refuse(centres, "the centres were measured at fewer than three angles")
    singular = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    blur = REJECTED * noise * math.sqrt(len(degrees))
    if singular[0] <= blur:
        _refuse(centres, "the ball hardly moves: it is on the axis, or the wrong axis turned")
    if singular[1] <= max(blur, 1e-6 * singular[0]):
        _refuse(centres, "the centres are on a straight line, and through it goes no circle")
    poor = condition(degrees)
    if poor > HOPELESS:
        raise InputError.one(
            "GX487",
            f"an arc of {arc(degrees):.3g} degrees does not determine the axis: condition "
            f"{poor:.0f}, at most {HOPELESS:.0f} is accepted",
            centres.where(0),
            "measure along a longer arc; 180 degrees and more are good",
        )


def _check_twice(centres: Centres) -> None:
    seen: dict[tuple[float, ...], int] = {}
    for row, point in enumerate(map(tuple, centres.points.tolist())):
        first = seen.setdefault(point, row)
        apart = float(centres.degrees[row] - centres.degrees[first])
        if first != row and (apart == 0.0 or math.remainder(apart, 360.0) != 0.0):
            _refuse(centres, f"the same centre stands twice, also in row {first + 1}", row)


def _refuse(centres: Centres, message: str, row: int = 0) -> None:
    hint = "a centre for each of four angles and more, spread over the whole turn if possible"
    raise InputError.one("GX486", message, centres.where(row), hint)


def distinct(degrees: Floats) -> int:
    """Return how many different positions of the axis there are."""
    return len(np.unique(np.round(np.mod(degrees, 360.0), 6) % 360.0))


def condition(degrees: Floats) -> float:
    """Return the condition number of the rows (cos q, sin q, 1)."""
    return float(np.linalg.cond(_rows(degrees)))


def arc(degrees: Floats) -> float:
    """Return the arc that positions cover, degrees: a turn less the largest gap, 360 if even."""
    around = np.sort(np.mod(degrees, 360.0))
    gaps = np.diff(np.append(around, around[0] + 360.0))
    even = len(gaps) > 2 and gaps.max() < EVEN * 360.0 / len(gaps)
    return 360.0 if even else float(360.0 - gaps.max())


# --- the fit ---


def fitted(
    centres: Centres,
    scale: Floats,
    start: Figure | None = None,
    loss: str | Callable[[Floats], Floats] = "linear",
) -> Figure:
    """Return the figure of least squares of residuals times a scale. Raises InputError (GX486).

    `scale` (n,) is of the centres, `loss` as scipy takes it.
    """
    from scipy.optimize import least_squares

    first, scales = start or _started(centres), np.repeat(scale, 3)
    found = least_squares(
        lambda step: residuals(centres, first.moved(step)).ravel() * scales,
        np.zeros(UNKNOWNS),
        lambda step: slopes(centres, first, step) * scales[:, None],
        x_scale="jac",
        loss=loss,
        **TIGHT,
    )
    if not found.success:
        _refuse(centres, "the centres do not turn with the angles: the fit does not converge")
    return first.moved(found.x)


def _started(centres: Centres) -> Figure:
    """Return the figure of the linear fit c + u cos q + w sin q."""
    rows = _rows(centres.degrees)
    u, w, centre = np.linalg.lstsq(rows, centres.points, rcond=None)[0]
    across = np.cross(u, w)
    size = float(np.linalg.norm(across))
    if not size > 0.1 * float(u @ u + w @ w) / 2.0:
        _refuse(centres, "the centres do not turn with the angles: they are not on a circle")
    direction = across / size
    # Square, and as long as the area says: the mean of u and of w turned back.
    arm = (u + np.cross(w, direction)) / 2.0
    return Figure(centre, direction, arm)


def residuals(centres: Centres, figure: Figure) -> Floats:
    """Return measured minus fitted centres (n, 3), mm."""
    return np.asarray(centres.points - figure.centre - figure.arms(centres.degrees))


def slopes(centres: Centres, figure: Figure, step: Floats) -> Floats:
    """Return what a little more of each of a step (7,) does to the residuals, (3 n, 7)."""
    design = jacobian(figure.moved(step), centres.degrees)
    design[..., 3:6] = design[..., 3:6] @ _added(step[3:6])
    return np.asarray(-design.reshape(-1, UNKNOWNS))


def jacobian(figure: Figure, degrees: Floats) -> Floats:
    """Return what shift, turn (rad) and growth of a figure do to its points, (n, 3, 7)."""
    arms = figure.arms(degrees)
    shift = np.broadcast_to(np.eye(3), (len(arms), 3, 3))
    growth = (arms / figure.radius)[..., None]
    return np.concatenate([shift, -crossing(arms), growth], axis=-1)


def _added(turn: Floats) -> Floats:
    """Return (3, 3): the turn that follows a turn (3, rad) when a little is added to its vector.

    The left Jacobian of SO(3), I + (1 - cos t) / t^2 K + (t - sin t) / t^3 K K with K v = turn x v.
    """
    size, across = float(np.linalg.norm(turn)), crossing(turn)
    if size < 1e-4:  # the first terms of the series, exact to 1e-13
        return np.asarray(np.eye(3) + across / 2.0 + across @ across / 6.0)
    once, twice = (1.0 - math.cos(size)) / size**2, (size - math.sin(size)) / size**3
    return np.asarray(np.eye(3) + once * across + twice * across @ across)


def standardised(centres: Centres, figure: Figure, noise: float, weights: Floats) -> Floats:
    """Return the residuals of each centre over the standard deviation of them, (n, 3)."""
    design = jacobian(figure, centres.degrees)
    weighted = design * weights[:, None, None]
    normal = np.einsum("nki,nkj->ij", weighted, design)
    taken = np.einsum("nki,ij,nkj->nk", design, np.linalg.inv(normal), weighted)
    spread = noise * np.sqrt(np.clip(1.0 - taken, 1e-6, None))
    return np.asarray(np.abs(residuals(centres, figure)) / spread)


def crossing(vectors: Floats) -> Floats:
    """Return the matrices (..., 3, 3) of v x for vectors v (..., 3)."""
    x, y, z = np.moveaxis(vectors, -1, 0)
    none = np.zeros_like(x)
    rows = [[none, -z, y], [z, none, -x], [-y, x, none]]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def _rows(degrees: Floats) -> Floats:
    radians = np.radians(degrees)
    return np.column_stack([np.cos(radians), np.sin(radians), np.ones(len(radians))])


def _triple(vector: Sequence[float] | Floats) -> Triple:
    x, y, z = (float(part) for part in vector)
    return x, y, z
