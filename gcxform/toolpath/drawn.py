"""A toolpath as strokes of a small picture: rapids apart from feeds, arcs and splines round."""

from __future__ import annotations

import numpy as np

from gcxform.notebook import Stroke
from gcxform.system.arrays import Flags, Floats, Ints
from gcxform.toolpath.circles import points_on_arcs
from gcxform.toolpath.path import Form, Kind, Toolpath
from gcxform.toolpath.splines import points_on_splines

STEP = 0.2  # rad; what an arc turns from one point to the next
PIECES = 12  # of a spline
MOST = 100_000  # points; pieces that would be more are ends of moves alone


def strokes(path: Toolpath) -> list[Stroke]:
    """Return a path as strokes, through the ends of its moves and points between them."""
    counts = _counts(path)
    row = np.repeat(np.arange(len(path)), counts)
    first = np.repeat(np.cumsum(counts) - counts, counts)
    part = (np.arange(len(row)) - first + 1) / counts[row]
    points = np.array(path.end[row, :3])
    open_axes = np.isnan(path.end[:, :3]).all(axis=0)  # of which nothing is known: drawn at 0
    for chosen, along in (
        (path.is_arc, points_on_arcs),
        (path.form == Form.SPLINE, points_on_splines),
    ):
        here = chosen[row] & (part < 1.0)
        if here.any():
            points[here] = along(path, row[here], part[here])
    begins = path.start[row, :3]
    points[:, open_axes] = begins[:, open_axes] = 0.0
    feeds = (path.kind != Kind.RAPID)[row]
    opening = np.append(True, row[1:] != row[:-1])[: len(row)]
    return [
        Stroke(_of(points, begins, opening, feeds == wanted), name)
        for wanted, name in ((False, "rapid"), (True, "feed"))
    ]


def _counts(path: Toolpath) -> Ints:
    """Return into how many pieces (n,) each row is drawn."""
    counts = np.ones(len(path), np.int64)
    arcs = path.is_arc
    counts[arcs] = np.clip(np.ceil(path.sweep[arcs] / STEP), 1, 200).astype(np.int64)
    counts[path.form == Form.SPLINE] = PIECES
    return counts if counts.sum() <= MOST else np.ones(len(path), np.int64)


def _of(points: Floats, begins: Floats, opening: Flags, chosen: Flags) -> Floats:
    """Return the points (n, 3) of some moves, with nan where a stretch of them begins."""
    fresh = chosen & ~np.append(False, chosen[:-1])[: len(chosen)] & opening
    rows = np.flatnonzero(chosen)
    gaps = np.flatnonzero(fresh[rows])
    nan = np.full((len(gaps), 3), np.nan)
    starts = np.stack([nan, begins[rows[gaps]]], axis=1).reshape(-1, 3)
    return np.insert(points[rows], np.repeat(gaps, 2), starts, axis=0)
