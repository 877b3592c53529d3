"""Corners that stay as they are written: a block with `,R5.` is two moves, and copied as one block.

Where its pieces lie hangs on the block behind, so that the blocks of corners in a row stand
together or are written anew together: each piece is then a block of its own, without the word. In
G91 the block behind the last one counts from the corner, where the tool never is, and belongs to
them as well.
"""

from __future__ import annotations

import numpy as np

from gcxform.emit.manner import Task
from gcxform.system.arrays import Flags, Ints
from gcxform.toolpath.path import MODES, Toolpath


def standing_corners(task: Task) -> Flags:
    """Return the lines (live,) that are written as they stand, because of a corner."""
    corner = task.table.flag("corner", task.shape)
    if not corner.any() or task.manner.crossing or task.path.frames != task.read.path.frames:
        return np.zeros(len(corner), np.bool_)
    behind = np.append(False, corner[:-1])
    together = np.cumsum(corner & ~behind) * (corner | behind)
    broken = together[~_as_before(task.path, task.read.path, task.read.live)]
    stands = (together > 0) & ~np.isin(together, broken)
    return np.asarray(stands & (corner | task.path.blocks.incremental))


def counted_from_corners(task: Task) -> Flags:
    """Return the lines (live,) whose words are distances from a corner, and not from its piece."""
    corner = task.table.flag("corner", task.shape)
    return np.asarray(np.append(False, corner)[:-1] & task.path.blocks.incremental)


def _as_before(path: Toolpath, old: Toolpath, live: int) -> Flags:
    """Return the lines (live,) whose moves are those of the source, and start where these do."""
    now, was = path.blocks, old.blocks
    good = np.bincount(path.block, minlength=live) == np.bincount(old.block, minlength=live)
    for mode in MODES:
        good &= getattr(now, mode) == getattr(was, mode)
    rows, others = np.flatnonzero(good[path.block]), np.flatnonzero(good[old.block])
    good[path.block[rows[~_alike(path, old, rows, others)]]] = False
    return np.asarray(good)


def _alike(path: Toolpath, old: Toolpath, rows: Ints, others: Ints) -> Flags:
    """Return which rows say the same as others of the source."""
    same = np.ones(len(rows), np.bool_)
    for name in ("kind", "form", "plane", "frame", "side", "sweep", "feed_mode"):
        same &= getattr(path, name)[rows] == getattr(old, name)[others]
    for name in ("start", "end", "centre", "feed"):
        here, there = getattr(path, name)[rows], getattr(old, name)[others]
        equal = (here == there) | (np.isnan(here) & np.isnan(there))
        same &= equal if equal.ndim == 1 else equal.all(axis=1)
    return same
