"""Points on the arcs of a toolpath, and where to cut them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from gcxform.system.arrays import Floats, Ints
from gcxform.toolpath.angles import TURN, swept
from gcxform.toolpath.crossings import arc_crossings
from gcxform.toolpath.path import Plane, Toolpath


def radius_and_angle(path: Toolpath, rows: Ints) -> tuple[Floats, Floats, Floats]:
    """Return radius at the start, radius at the end (mm) and angle at the start (rad) of arcs."""
    first, last, angle = np.zeros((3, len(rows)))
    start, end = path.start[rows], path.end[rows]
    for plane, here in _by_plane(path, rows):
        axes = list(plane.axes[:2])
        centre = path.centre[rows[here]][:, axes]
        u, v = start[here][:, axes] - centre, end[here][:, axes] - centre
        first[here], last[here] = np.hypot(*u.T), np.hypot(*v.T)
        angle[here] = np.arctan2(u[:, 1], u[:, 0])
    return first, last, angle


def _by_plane(path: Toolpath, rows: Ints) -> Iterator[tuple[Plane, Ints]]:
    """Yield the planes that rows are in, each with the places of its rows: mostly it is one."""
    of = path.plane[rows]
    for plane in Plane:
        here = np.flatnonzero(of == plane)
        if len(here):
            yield plane, here


def points_on_arcs(path: Toolpath, rows: Ints, part: Floats) -> Floats:
    """Return points (n, 3) in mm of arcs at parts of their sweeps.

    The radius changes evenly from start to end, and the axis normal to the plane moves evenly with
    the angle.
    """
    first, last, angle = radius_and_angle(path, rows)
    size = first + (last - first) * part
    at = angle + path.sense[rows] * path.sweep[rows] * part
    start, end = path.start[rows, :3], path.end[rows, :3]
    point = start + part[:, None] * (end - start)
    for plane, here in _by_plane(path, rows):
        a, b, _ = plane.axes
        point[here, a] = path.centre[rows[here], a] + size[here] * np.cos(at[here])
        point[here, b] = path.centre[rows[here], b] + size[here] * np.sin(at[here])
    return np.asarray(point)


def swept_anew(path: Toolpath) -> Floats:
    """Return the sweeps (rad) of all rows, those of arcs measured about their centres.

    Full turns, and arcs too short to measure, are taken from the sweeps that the path has.
    """
    sweep = np.array(path.sweep)
    start = path.start
    for plane in Plane:
        rows = np.flatnonzero(path.is_arc & (path.plane == plane))
        if not len(rows):
            continue
        axes = np.array(plane.axes[:2])
        centre = path.centre[np.ix_(rows, axes)]
        u, v = start[np.ix_(rows, axes)] - centre, path.end[np.ix_(rows, axes)] - centre
        measured = swept(u, v, path.sense[rows])
        measured += TURN * np.round((sweep[rows] - measured) / TURN)
        sweep[rows] = np.where(measured > 0, measured, sweep[rows])
    return sweep


def arc_extremes(path: Toolpath) -> tuple[Floats, Ints]:
    """Return the points (n, 3) of arcs farthest along their plane's axes, and their rows."""
    rows = np.flatnonzero(path.is_arc)
    _, _, angle = radius_and_angle(path, rows)
    points, owners = [np.empty((0, 3))], [np.empty(0, np.int64)]
    for quarter in range(4):
        ahead = np.mod((quarter * np.pi / 2 - angle) * path.sense[rows], TURN)
        inside = ahead < path.sweep[rows]
        points.append(points_on_arcs(path, rows[inside], (ahead / path.sweep[rows])[inside]))
        owners.append(rows[inside])
    return np.vstack(points), np.concatenate(owners)


def arc_cuts(
    path: Toolpath,
    offset: Floats,
    nodes: Sequence[Floats],
    lipschitz: float,
    curvature: float,
    slack: float,
) -> tuple[Ints, Floats]:
    """Return row and part of the cuts at which an error field leaves arcs nearly arcs.

    Between two cuts the field, with its Lipschitz constant (mm/mm), is linear in the position
    (`nodes`, in positions plus `offset` (n or 1, 3)), so that an arc's image is within `slack` (mm)
    of an arc. Where the field is curved there, by up to `curvature` (mm/mm2) along any direction,
    the pieces are so short that this adds `slack` once more.
    """
    rows = np.flatnonzero(path.is_arc)
    first, last, angle = radius_and_angle(path, rows)
    size = np.maximum(first, last)
    widest = np.sqrt(8 * slack / np.maximum(size * lipschitz, 1e-12)) / 2
    if curvature:
        length = np.hypot(size * path.sweep[rows], _rise(path, rows))
        longest = np.sqrt(8 * slack / curvature)
        widest = np.minimum(widest, path.sweep[rows] * longest / np.maximum(length, longest))
    count = np.ceil(path.sweep[rows] / np.minimum(widest, 0.5)).astype(np.int64)
    found = [_even_cuts(rows, count)]
    for plane, here in _by_plane(path, rows):
        mine = rows[here]
        shift = offset if len(offset) == 1 else offset[mine]
        a, b, normal = plane.axes
        turn = path.sense[mine] * path.sweep[mine]
        centre = (path.centre[mine] + shift)[:, [a, b]]
        cut, part, _, _ = arc_crossings(centre, size[here], angle[here], turn, (a, b), nodes)
        found.append((mine[cut], part))
        rise = _rise_crossings(path, mine, shift, normal, nodes[normal])
        found.append((mine[rise[0]], rise[1]))
    return np.concatenate([r for r, _ in found]), np.concatenate([p for _, p in found])


def _even_cuts(rows: Ints, count: Ints) -> tuple[Ints, Floats]:
    """Return row and part of the cuts of rows into so many even pieces."""
    row = np.repeat(rows, count)
    nth = np.arange(len(row)) - np.repeat(np.cumsum(count) - count, count)
    return row[nth > 0], (nth / np.repeat(count, count))[nth > 0]


def _rise(path: Toolpath, rows: Ints) -> Floats:
    """Return how far (mm) arcs go along the axes of their planes; 0 where that is not known."""
    normal = np.array([plane.axes[2] for plane in Plane])[path.plane[rows]]
    return np.asarray(np.nan_to_num(path.end[rows, normal] - path.start[rows, normal]))


def _rise_crossings(
    path: Toolpath, rows: Ints, shift: Floats, normal: int, planes: Floats
) -> tuple[Ints, Floats]:
    """Return where helices cross the planes of their axis, as index and part."""
    a = path.start[rows, normal] + shift[:, normal]
    b = path.end[rows, normal] + shift[:, normal]
    found: list[tuple[Ints, Floats]] = [(np.empty(0, np.int64), np.empty(0))]
    for plane in planes:
        with np.errstate(invalid="ignore", divide="ignore"):
            part = (plane - a) / (b - a)
        inside = np.flatnonzero((part > 0) & (part < 1))
        found.append((inside, part[inside]))
    return np.concatenate([r for r, _ in found]), np.concatenate([p for _, p in found])


def circle_through(a: Floats, b: Floats, c: Floats) -> Floats:
    """Return the centres (n, 2) of the circles through three points (n, 2); inf if in a line."""
    u, v = b - a, c - a
    cross = 2 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    uu, vv = (u**2).sum(axis=1), (v**2).sum(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        x = (v[:, 1] * uu - u[:, 1] * vv) / cross
        y = (u[:, 0] * vv - v[:, 0] * uu) / cross
    return np.asarray(a + np.stack([x, y], axis=1))
