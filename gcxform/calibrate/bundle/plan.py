"""Poses for a bundle: where to probe balls so that the rotary axes are found well.

Candidates are all combinations of angles on a grid inside the limits of the axes, for each ball,
where table and head do not lean too far, X, Y and Z stay inside their limits with room for the
probe, and it stays away from other balls. Of them those are taken one after the other that add most
to the information of what is there (D-optimal: the determinant of the normal matrix grows most), by
the design of the bundle itself. So conditioning and uncertainties are known before anything is
measured.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from gcxform.calibrate.bundle.bundle import MODES, Bundled, Layout, Poses, check
from gcxform.calibrate.bundle.clearance import clear, inside, upright
from gcxform.diagnostics import UsageError
from gcxform.machine.chain import Chain, Rotary, Triple
from gcxform.system.arrays import Flags, Floats
from gcxform.system.stages import stage
from gcxform.values import dataclass

GRID: Final = 15.0  # degrees
FAINT: Final = 1e-6
"""The information that is there before the first pose, so that it can be inverted."""
HINT: Final = "put the ball elsewhere, or allow more tilt; limits are those of the machine file"


@dataclass(frozen=True)
class Wanted:
    """What a plan is to have: poses, the room around a ball, mm, and the largest tilt, degrees."""

    poses: int = 30
    room: float = 20.0
    tilt: float = 80.0
    linear: str = "differences"


def planned(chain: Chain, balls: Sequence[Triple], wanted: Wanted, noise: float) -> Bundled:
    """Return a bundle of poses (its residuals are 0) for balls at places of the workpiece, mm.

    Raises UsageError where there is no room for the poses (GX491), and InputError for unknowns that
    they do not determine (GX489).
    """
    candidates = _candidates(chain, balls, wanted)
    if len(candidates.points) < wanted.poses:
        message = f"only {len(candidates.points)} poses are inside the limits, not {wanted.poses}"
        raise UsageError.one("GX491", message, hint=HINT)
    layout = Layout(chain, candidates, MODES[wanted.linear])
    taken = _best(layout.design(layout.start()), wanted.poses)
    chosen = _ordered(candidates, taken)
    layout = Layout(chain, chosen, MODES[wanted.linear])
    start = layout.start()
    check(layout, start)
    return Bundled(layout, noise, start, np.ones(len(chosen.points), dtype=bool))


def planned_circle(chain: Chain, letter: str, ball: Triple, wanted: Wanted) -> Poses:
    """Return poses at equal steps of one axis, the others at 0, along the longest arc there is.

    Equal steps all around matter more than anything else (reference: seed figures). Raises
    UsageError where there is no room (GX491).
    """
    k = chain.letters.index(letter)
    every, closed = _whole_degrees(chain.axes[k])
    angles = np.zeros((len(every), len(chain.axes)))
    angles[:, k] = every
    stands = chain.linear(np.tile(np.array(ball), (len(every), 1)), angles)
    good = inside(chain, stands, angles, wanted.room) & upright(chain, angles, wanted.tilt)
    if closed and good.all():
        turns = every[0] + np.arange(wanted.poses) * 360.0 / wanted.poses
    else:
        low, high = _longest(every, good, closed)
        turns = np.linspace(low, high, wanted.poses)
    if len(turns) < 3 or np.ptp(turns) == 0.0:
        message = f"no arc of {letter} is inside the limits"
        raise UsageError.one("GX491", message, hint=HINT)
    degrees = np.zeros((len(turns), len(chain.axes)))
    degrees[:, k] = turns.round(3)
    points = chain.linear(np.tile(np.array(ball), (len(turns), 1)), degrees).round(3)
    return Poses(degrees, ("1",) * len(turns), points)


def _whole_degrees(axis: Rotary) -> tuple[Floats, bool]:
    """Return the angles of an axis in steps of a degree, and whether they close a turn."""
    if axis.limits is None or axis.limits[1] - axis.limits[0] >= 360.0:
        low = 0.0 if axis.limits is None else axis.limits[0]
        return np.asarray(low + np.arange(360.0)), axis.limits is None
    return np.arange(axis.limits[0], axis.limits[1] + 1e-9), False


def _longest(every: Floats, good: Flags, closed: bool) -> tuple[float, float]:
    """Return the ends of the longest run of good angles; over the end of a closed turn too."""
    twice = np.concatenate([good, good & closed])
    edges = np.flatnonzero(np.diff(np.concatenate([[False], twice, [False]]).astype(int)))
    runs = edges.reshape(-1, 2)
    if not len(runs):
        return 0.0, 0.0
    first, last = runs[int(np.argmax(runs[:, 1] - runs[:, 0]))].tolist()
    return float(every[0] + first), float(every[0] + last - 1)


def _candidates(chain: Chain, balls: Sequence[Triple], wanted: Wanted) -> Poses:
    """Return all poses on the grid that are inside the limits."""
    every = np.array([*itertools.product(*map(_grid, chain.axes))])
    every = every[upright(chain, every, wanted.tilt)]
    parts = []
    for number, ball in enumerate(balls, 1):
        stands = chain.linear(np.tile(np.array(ball), (len(every), 1)), every).round(3)
        good = inside(chain, stands, every, wanted.room)
        good &= clear(chain, balls, number - 1, every, 2.0 * wanted.room)
        parts.append((str(number), every[good], stands[good]))
        if not good.any():
            message = f"no pose of ball {number} is inside the limits, and clear of other balls"
            raise UsageError.one("GX491", message, hint=HINT)
    return Poses(
        np.concatenate([degrees for _, degrees, _ in parts]),
        tuple(name for name, degrees, _ in parts for _ in degrees),
        np.concatenate([points for _, _, points in parts]),
    )


def _grid(axis: Rotary) -> Floats:
    """Return the angles of an axis that are tried: its limits, and what is between."""
    if axis.limits is None or axis.limits[1] - axis.limits[0] >= 360.0:
        low = 0.0 if axis.limits is None else axis.limits[0]
        return np.asarray(low + np.arange(0.0, 360.0, GRID))
    low, high = axis.limits
    return np.linspace(low, high, max(2, math.ceil((high - low) / GRID) + 1)).round(3)


def _best(design: Floats, count: int) -> list[int]:
    """Return the poses, by the rows (3 n, k) of all, that determine the unknowns best."""
    lengths = np.linalg.norm(design, axis=0)
    rows = (design / np.where(lengths > 0.0, lengths, 1.0)).reshape(-1, 3, design.shape[1])
    information = FAINT * np.eye(design.shape[1])
    taken: list[int] = []
    for done in range(count):
        stage("choosing poses", done / count)
        inverse = np.linalg.inv(information)
        gains = np.linalg.slogdet(np.eye(3) + rows @ inverse @ np.swapaxes(rows, 1, 2))[1]
        gains[taken] = -np.inf
        taken.append(int(np.argmax(np.round(gains, 9))))
        information += rows[taken[-1]].T @ rows[taken[-1]]
    return taken


def _ordered(candidates: Poses, taken: Sequence[int]) -> Poses:
    """Return the poses in an order that turns little: by ball and angles, to and fro."""
    keys = [(candidates.ball[k], *candidates.degrees[k].tolist(), k) for k in taken]
    rows: list[int] = []
    groups = itertools.groupby(sorted(keys), key=lambda key: key[:2])
    for number, (_, group) in enumerate(groups):
        part = [int(key[-1]) for key in group]
        rows += part[::-1] if number % 2 else part
    ball = tuple(candidates.ball[k] for k in rows)
    return Poses(candidates.degrees[rows], ball, candidates.points[rows])
