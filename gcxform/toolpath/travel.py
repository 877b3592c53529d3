"""How far moves go: what a feed in inverse time (G93) is to one per minute (G94)."""

from __future__ import annotations

import numpy as np

from gcxform.dialect.dialect import LINEAR
from gcxform.system.arrays import Flags, Floats, Ints
from gcxform.toolpath.circles import radius_and_angle
from gcxform.toolpath.path import Plane, Toolpath
from gcxform.toolpath.splines import spline_lengths
from gcxform.values import dataclass

STILL = 1e-7  # mm; linear axes that move by less stand still


@dataclass(frozen=True)
class Lengths:
    """Lengths (n,) of moves: mm along the linear axes, or degrees where only rotary ones turn.

    An arc whose ends are on two circles, and a spline, are between `least` and `most`. `turns` says
    which moves are those of rotary axes alone. Unknown lengths are nan.
    """

    least: Floats
    most: Floats
    turns: Flags


def lengths(path: Toolpath) -> Lengths:
    """Return how far the moves of a path go."""
    start, end = path.start, path.end
    way = np.where(np.isnan(start) & np.isnan(end), 0.0, end - start)
    linear = np.array([axis in LINEAR for axis in path.axes])
    along = np.sqrt((way[:, linear] ** 2).sum(axis=1))
    least, most = along.copy(), along.copy()
    arcs = np.flatnonzero(path.is_arc)
    if len(arcs):
        first, last, _ = radius_and_angle(path, arcs)
        normal = np.array([plane.axes[2] for plane in Plane])[path.plane[arcs]]
        rise = way[arcs, normal]
        least[arcs] = np.hypot(np.minimum(first, last) * path.sweep[arcs], rise)
        most[arcs] = np.hypot(np.maximum(first, last) * path.sweep[arcs], rise)
    splines = np.flatnonzero(path.is_spline)
    if len(splines):
        least[splines], most[splines] = spline_lengths(path, splines)
    turned = np.sqrt((way[:, ~linear] ** 2).sum(axis=1))
    turns = (most < STILL) & (turned > 0)
    return Lengths(np.where(turns, turned, least), np.where(turns, turned, most), turns)


def ways(path: Toolpath, rows: Ints) -> Floats:
    """Return how far lines and splines take all axes (mm, degrees); no less than they go."""
    way = np.nan_to_num(path.end[rows] - path.start[rows])
    length = np.sqrt((way**2).sum(axis=1))
    if path.has_splines:
        splines = path.is_spline[rows]
        length[splines] = spline_lengths(path, rows[splines])[1]
    return np.asarray(length)
