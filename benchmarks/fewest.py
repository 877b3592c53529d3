"""How many blocks any compensated program needs at least, if each of its moves stays its own.

A lower bound, which shares nothing with the pass `volumetric`: a piece of a move is as good as a
straight line, or an arc, can be at all that may begin and end anywhere within the tolerance, not
even where the piece before it ends. Only what is aside of the path counts, at points along it, and
of an arc only what is in its plane. So a piece that reaches as far as this allows is never shorter
than that of a real program, and there are never fewer of them in one.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import linprog

import gcxform as gx
from gcxform.system.arrays import Floats

POINTS = 257  # along a move
SLOPE = 0.005  # more of the tolerance: a command off by q moves the machine by up to (1 + slope) q


def fewest(path: gx.Toolpath, model: gx.ErrorModel, offset: Floats, tolerance: float) -> int:
    """Return how many blocks a path takes at least within a tolerance (mm).

    `offset` (3,) mm is position in the model minus position of the path.
    """
    limit = tolerance * (1.0 + SLOPE)
    total = 0
    for row in range(len(path)):
        kind = gx.Kind(int(path.kind[row]))
        total += 1 if kind == gx.Kind.RAPID else _pieces(path, row, model, offset, limit)
    return total


def _pieces(path: gx.Toolpath, row: int, model: gx.ErrorModel, offset: Floats, limit: float) -> int:
    """Return how many pieces a feed move takes at least."""
    part = np.linspace(0.0, 1.0, POINTS)
    if path.is_arc[row]:
        target = gx.points_on_arcs(path, np.full(POINTS, row), part)
        off, shapes = _beside_arc(path, row, target, _correction(model, target + offset))
    else:
        start, end = path.start[row, :3], path.end[row, :3]
        if not np.isfinite(start).all() or np.array_equal(start, end):
            return 1
        target = start + part[:, None] * (end - start)
        off, shapes = _beside_line(end - start, part, _correction(model, target + offset))
    count, at = 0, 0
    while at < POINTS - 1:
        at = _farthest(off, shapes, at, limit)
        count += 1
    return count


def _correction(model: gx.ErrorModel, target: Floats) -> Floats:
    """Return command minus target (n, 3) mm."""
    return gx.compensate(model, target, gx.Outside.EXTRAPOLATE).position - target


def _beside_line(way: Floats, part: Floats, correction: Floats) -> tuple[Floats, Floats]:
    """Return what a command is aside of a line in two directions (n, 2), and what lines can do."""
    aside = np.linalg.svd(way[None, :])[2][1:]
    return correction @ aside.T, np.stack([np.ones_like(part), part], axis=1)


def _beside_arc(
    path: gx.Toolpath, row: int, target: Floats, correction: Floats
) -> tuple[Floats, Floats]:
    """Return what a command is aside of an arc in its plane (n, 1), and what arcs can do (n, 3).

    Another radius and another centre change the distance by 1, cos and sin, apart from squares of
    what is left after the mean of the correction, which are nanometres over millimetres.
    """
    axes = list(gx.Plane(int(path.plane[row])).axes[:2])
    away = (target - path.centre[row])[:, axes]
    away /= np.hypot(*away.T)[:, None]
    left = (correction - correction.mean(axis=0))[:, axes]
    return (left * away).sum(axis=1)[:, None], np.column_stack([np.ones(len(away)), away])


def _farthest(off: Floats, shapes: Floats, at: int, limit: float) -> int:
    """Return the last point up to which one piece from `at` can keep the limit."""
    good, bad = at + 1, len(off)
    trial = bad - 1
    while good < trial:
        if _can(off[at : trial + 1], shapes[at : trial + 1], limit):
            good = trial
        else:
            bad = trial
        trial = (good + bad) // 2
    return good


def _can(off: Floats, shapes: Floats, limit: float) -> bool:
    """Whether some sum of shapes is within the limit of what is off, in each direction."""
    fitted = shapes @ np.linalg.lstsq(shapes, off, rcond=None)[0]
    if float(np.abs(off - fitted).max()) <= limit:
        return True
    rows = np.vstack([shapes, -shapes])
    for one in off.T / limit:
        bounds = np.concatenate([1.0 + one, 1.0 - one])
        free = [(None, None)] * shapes.shape[1]
        if linprog(np.zeros(shapes.shape[1]), rows / limit, bounds, bounds=free).status == 2:
            return False
    return True
