"""Which moves of a path are a contour under cutter compensation, with those that end it."""

from __future__ import annotations

import numpy as np

from gcxform.system.arrays import Flags
from gcxform.toolpath.path import Toolpath


def contour_rows(path: Toolpath) -> Flags:
    """Return which rows (n + 1,) are under compensation or end it, and whether one behind would.

    G40 without a move is carried out by the first move in the plane behind it. What comes before
    that, along the axis of the tool, is of the contour as well: controls differ in which it is.
    """
    on, rows = path.side != 0, np.arange(len(path))
    way = path.end[:, :3] != path.start[:, :3]
    in_plane = (way & (np.arange(3) != 2 - path.plane[:, None])).any(axis=1)
    before = -1 if path.leaving else -2
    last_on = np.maximum.accumulate(np.where(np.append(on, False), np.append(rows, 0), before))
    last_left = np.maximum.accumulate(np.append(-2, np.where(in_plane & ~on, rows, -2)))
    return np.asarray(last_on > last_left)
