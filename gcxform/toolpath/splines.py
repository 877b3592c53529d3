"""Points on the splines of a toolpath, how long they are, how far they reach, and lines for them.

A spline is a cubic Bezier curve B(t), 0 <= t <= 1, with the control points P0 to P3: P0 is where
the row starts, P3 where it ends. Formulas: G. Farin, Curves and Surfaces for CAGD, chapters 4, 5.

A spline is a row of the form `SPLINE` whose kind is `LINE`, because it cuts. Rows of any form but
`PLAIN` are written as the block they came from, or refused; so a pass that knows nothing of splines
cannot take one for a line and write it. The lines for one are equal in the parameter, and as many
as the second differences of the control points ask for.
"""

from __future__ import annotations

import numpy as np

from gcxform.system.arrays import Floats, Ints
from gcxform.toolpath.path import Form, Toolpath

HALVINGS = 6  # of splines, to measure them: their lengths are known to about 1e-6 then
TOO_MANY = 2.0**40  # lines for one spline: refused, and still a whole number
JUST_WHOLE = 1e-9  # a spline that needs so little more than n lines becomes n


def control_points(path: Toolpath, rows: Ints) -> Floats:
    """Return the control points (n, 4, 3) in mm of splines."""
    points = np.empty((len(rows), 4, 3))
    points[:, 0], points[:, 3] = path.start[rows, :3], path.end[rows, :3]
    points[:, 1:3] = path.control[rows]
    return points


def points_on_splines(path: Toolpath, rows: Ints, part: Floats) -> Floats:
    """Return points (n, 3) in mm of splines at parts t of their way, by Bernstein polynomials."""
    t, s = part[:, None], 1.0 - part[:, None]
    p0, p1, p2, p3 = np.moveaxis(control_points(path, rows), 1, 0)
    return np.asarray(s**3 * p0 + 3 * s**2 * t * p1 + 3 * s * t**2 * p2 + t**3 * p3)


def spline_chords(path: Toolpath, rows: Ints, chord_error: float) -> Ints:
    """Return how many chords, equal in t, keep within the chord error (mm) of each spline.

    A chord over a step h of t is off by at most h**2 / 8 times the largest second derivative, and
    that is at most 6 times the larger of the second differences of the control points.
    """
    points = np.nan_to_num(control_points(path, rows))
    second = np.sqrt((np.diff(points, 2, axis=1) ** 2).sum(axis=2)).max(axis=1, initial=0.0)
    return _whole(np.sqrt(0.75 * second / chord_error))


def _whole(value: Floats) -> Ints:
    return np.clip(np.ceil(value - JUST_WHOLE), 1, TOO_MANY).astype(np.int64)


def spline_lengths(path: Toolpath, rows: Ints) -> tuple[Floats, Floats]:
    """Return lengths (n,) in mm between which those of the splines are.

    A part of a spline is no shorter than its chord and no longer than its control polygon.
    """
    parts = np.nan_to_num(control_points(path, rows))[:, None]
    for _ in range(HALVINGS):
        parts = _halved(parts)
    sides = np.sqrt((np.diff(parts, axis=2) ** 2).sum(axis=3)).sum(axis=(1, 2))
    chords = np.sqrt(((parts[:, :, 3] - parts[:, :, 0]) ** 2).sum(axis=2)).sum(axis=1)
    return chords, sides


def _halved(parts: Floats) -> Floats:
    """Return the control points (n, 2 k, 4, 3) of the halves of parts (n, k, 4, 3), in order."""
    a, b, c, d = np.moveaxis(parts, 2, 0)
    ab, bc, cd = (a + b) / 2, (b + c) / 2, (c + d) / 2
    abc, bcd = (ab + bc) / 2, (bc + cd) / 2
    middle = (abc + bcd) / 2
    halves = np.stack(
        [np.stack([a, ab, abc, middle], axis=2), np.stack([middle, bcd, cd, d], axis=2)], axis=2
    )
    return np.asarray(halves.reshape(len(parts), 2 * parts.shape[1], 4, 3))


def spline_extremes(path: Toolpath, rows: Ints) -> Floats:
    """Return the least and the largest X, Y, Z (n, 2, 3) in mm on splines.

    They are at the ends and where the derivative is zero: two roots at most for each axis.
    """
    p = control_points(path, rows)
    steps = np.diff(p, axis=1)
    a, b = steps[:, 0] - 2 * steps[:, 1] + steps[:, 2], steps[:, 1] - steps[:, 0]
    c = steps[:, 0]
    with np.errstate(all="ignore"):
        q = -(b + np.copysign(np.sqrt(b * b - a * c), b))
        roots = np.stack([q / a, c / q, -c / (2 * b)], axis=1)
    t = np.where((roots > 0) & (roots < 1), roots, 0.0)
    s = 1.0 - t
    p0, p1, p2, p3 = (p[:, k, None] for k in range(4))
    found = s**3 * p0 + 3 * s**2 * t * p1 + 3 * s * t**2 * p2 + t**3 * p3
    found = np.concatenate([found, p[:, [0, 3]]], axis=1)
    return np.stack([found.min(axis=1), found.max(axis=1)], axis=1)


def splines_as_lines(path: Toolpath, pieces: Ints) -> Toolpath:
    """Return the path with each spline as so many lines, equal in t; `pieces` (n,), 1 elsewhere."""
    row = np.repeat(np.arange(len(path)), path.check_rows(pieces))
    nth = np.arange(len(row)) - np.repeat(np.cumsum(pieces) - pieces, pieces) + 1
    inner = np.flatnonzero(nth < pieces[row])
    end = path.end[row]
    part = nth[inner] / pieces[row[inner]]
    end[inner, :3] = points_on_splines(path, row[inner], part)
    form = np.where(path.is_spline, np.int8(Form.PLAIN), path.form)[row]
    control = np.broadcast_to(np.nan, (len(row), 2, 3))
    return path.with_rows(pieces, end=np.asfortranarray(end), form=form, control=control)


def straightened(path: Toolpath, error: float) -> Toolpath:
    """Return the path with lines within `error` (mm) for its splines; its slack says so."""
    if not path.has_splines:
        return path
    rows = np.flatnonzero(path.is_spline)
    pieces = np.ones(len(path), np.int64)
    pieces[rows] = spline_chords(path, rows, error)
    return splines_as_lines(path, pieces).replace(slack=path.slack + error)
