"""Arcs of more than a turn, for controls that have none: each becomes several of less."""

from __future__ import annotations

import numpy as np

from gcxform.system.arrays import Floats, Ints
from gcxform.toolpath.angles import SAME_ANGLE, TURN
from gcxform.toolpath.circles import points_on_arcs
from gcxform.toolpath.path import FeedMode, Form, Toolpath


def turning_on(path: Toolpath) -> Ints:
    """Return the rows of arcs of more than a turn that may be written as others."""
    longer = path.is_arc & (path.sweep > TURN + SAME_ANGLE)
    return np.flatnonzero(longer & (path.form == Form.PLAIN) & (path.side == 0))


def within_a_turn(path: Toolpath, rows: Ints) -> Toolpath:
    """Return the path with arcs of less than a turn for those of rows, alike, on the same curve."""
    pieces = np.ones(len(path), np.int64)
    pieces[rows] = np.floor(path.sweep[rows] / TURN + SAME_ANGLE).astype(np.int64) + 1
    row = np.repeat(np.arange(len(path)), path.check_rows(pieces))
    nth = np.arange(len(row)) - np.repeat(np.cumsum(pieces) - pieces, pieces) + 1
    inner = np.flatnonzero(nth < pieces[row])
    part = nth[inner] / pieces[row[inner]]
    end, start = path.end[row], path.start[row[inner]]
    end[inner] = start + part[:, None] * (end[inner] - start)
    end[inner, :3] = points_on_arcs(path, row[inner], part)
    return path.with_rows(
        pieces,
        end=np.asfortranarray(end),
        sweep=path.sweep[row] / pieces[row],
        feed=_timed(path, row, pieces),
    )


def _timed(path: Toolpath, row: Ints, pieces: Ints) -> Floats:
    """Return the feeds of pieces: in inverse time each has its part of the time."""
    inverse = path.feed_mode[row] == FeedMode.INVERSE_TIME
    return np.where(inverse, path.feed[row] * pieces[row], path.feed[row])
