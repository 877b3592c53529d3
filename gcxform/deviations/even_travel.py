"""How far rows of two paths are apart where both are travelled evenly.

Arcs of other senses, or an arc beside a point, may be near each other all the same: a bend of a
hair's breadth. Points at the same part of two rows are a pairing as any other, and so an upper
bound of their distance. It is taken at even parts; between two of them, a part h apart, the gap of
two curves is at most what it is at the ends, and (|P''| + |Q''|) h^2 / 8 more.
"""

from __future__ import annotations

import numpy as np

from gcxform.dialect.dialect import LINEAR
from gcxform.system.arrays import Flags, Floats, Ints
from gcxform.toolpath.circles import points_on_arcs, radius_and_angle
from gcxform.toolpath.path import Kind, Toolpath

PARTS = 64


def evenly_apart(one: Toolpath, other: Toolpath, rows: Ints) -> Floats:
    """Return upper bounds (mm) of the distance of rows of two paths over the same axes.

    They are inf where a place is known in one path only, for rapids and splines, and where the
    angles of the rotary axes differ from each other in any way.
    """
    bound = np.zeros(len(rows))
    linear = [k for k, axis in enumerate(one.axes) if axis in LINEAR]
    rotary = [k for k, axis in enumerate(one.axes) if axis not in LINEAR]
    for part in np.linspace(0.0, 1.0, PARTS + 1):
        gap = _points(one, rows, part) - _points(other, rows, part)
        gap = np.where(np.isnan(gap), np.inf, gap)
        gap[_nowhere(one, rows) & _nowhere(other, rows)] = 0.0
        apart = np.sqrt((gap[:, linear] ** 2).sum(axis=1))
        apart[(gap[:, rotary] != 0.0).any(axis=1)] = np.inf
        bound = np.maximum(bound, apart)
    for path in (one, other):
        bound += _bend(path, rows) / PARTS**2 / 8.0
        bound[(path.kind[rows] == Kind.RAPID) | path.is_spline[rows]] = np.inf
    return bound


def _nowhere(path: Toolpath, rows: Ints) -> Flags:
    """Return whether neither start nor end of each axis is known (rows, axes)."""
    return np.asarray(np.isnan(path.start[rows]) & np.isnan(path.end[rows]))


def _points(path: Toolpath, rows: Ints, part: float) -> Floats:
    """Return the points (rows, axes) at a part of the rows; nan where they are not known."""
    start, end = path.start[rows], path.end[rows]
    found = np.asarray(start + part * (end - start))
    arcs = np.flatnonzero(path.is_arc[rows])
    if len(arcs):
        found[arcs, :3] = points_on_arcs(path, rows[arcs], np.full(len(arcs), part))
    return found


def _bend(path: Toolpath, rows: Ints) -> Floats:
    """Return bounds (mm) of the second derivative of the rows by their part.

    That of an arc of radius r + t d and sweep s is s^2 (r + t d) towards its centre, and 2 s d.
    """
    found = np.zeros(len(rows))
    arcs = np.flatnonzero(path.is_arc[rows])
    if len(arcs):
        first, last, _ = radius_and_angle(path, rows[arcs])
        sweep = path.sweep[rows[arcs]]
        found[arcs] = np.hypot(
            sweep**2 * np.maximum(first, last), 2.0 * sweep * np.abs(last - first)
        )
    return found
