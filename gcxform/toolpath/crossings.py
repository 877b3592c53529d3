"""Where moves cross the planes on which an error field bends."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from gcxform.modal.arcs import TURN

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

Crossings = tuple[Ints, Floats, Ints, Floats]
"""Row, part of the move (0 to 1), axis and plane of each crossing, by row and part."""

APART = 1e-12  # parts of a move closer than this are one


def line_crossings(start: Floats, end: Floats, nodes: Sequence[Floats]) -> Crossings:
    """Return where lines (n, 3) cross the planes x, y, z = node, ends left out."""
    found = []
    for axis, planes in enumerate(nodes):
        if len(planes):
            found.append(_on_axis(start[:, axis], end[:, axis], axis, planes))
    return _sorted(found)


def _on_axis(a: Floats, b: Floats, axis: int, planes: Floats) -> Crossings:
    """Return the crossings with the planes of one axis."""
    low = np.searchsorted(planes, np.minimum(a, b), side="right")
    high = np.searchsorted(planes, np.maximum(a, b), side="left")
    count = np.where(np.isnan(a) | np.isnan(b), 0, np.maximum(high - low, 0))
    rows = np.flatnonzero(count)
    row = np.repeat(rows, count[rows])
    nth = np.arange(len(row)) - np.repeat(np.cumsum(count[rows]) - count[rows], count[rows])
    plane = planes[low[row] + nth]
    return row, (plane - a[row]) / (b[row] - a[row]), np.full(len(row), axis), plane


def arc_crossings(
    centre: Floats,
    radius: Floats,
    first: Floats,
    turn: Floats,
    axes: tuple[int, int],
    nodes: Sequence[Floats],
) -> Crossings:
    """Return where arcs cross the planes of the two axes of their plane.

    centre (n, 2) mm; radius (n,) mm; first (n,) rad, the angle at the start; turn (n,) rad, the
    signed sweep, any number of turns. Crossings that only touch count as well.
    """
    found = []
    for which, axis in enumerate(axes):
        for plane in nodes[axis]:
            reach = (plane - centre[:, which]) / np.where(radius > 0, radius, np.inf)
            rows = np.flatnonzero(np.abs(reach) <= 1.0)
            if len(rows):
                found.append(_on_circle(reach[rows], rows, which, axis, plane, first, turn))
    return _sorted(found)


def _on_circle(
    reach: Floats,
    rows: Ints,
    which: int,
    axis: int,
    plane: float,
    first: Floats,
    turn: Floats,
) -> Crossings:
    half = np.arccos(reach)
    middle = 0.0 if which == 0 else np.pi / 2
    parts, owners = [], []
    for angle in (middle + half, middle - half):
        ahead = np.mod((angle - first[rows]) * np.sign(turn[rows]), TURN)
        turns = int(np.ceil(np.abs(turn).max() / TURN)) if len(turn) else 0
        for extra in range(turns + 1):
            part = (ahead + TURN * extra) / np.abs(turn[rows])
            inside = (part > 0) & (part < 1)
            parts.append(part[inside])
            owners.append(rows[inside])
    row, part = np.concatenate(owners), np.concatenate(parts)
    return row, part, np.full(len(row), axis), np.full(len(row), plane)


def _sorted(found: list[Crossings]) -> Crossings:
    """Return crossings in order of travel; of several at one place the first stays."""
    if not found:
        none = np.empty(0, np.int64)
        return none, np.empty(0), none, np.empty(0)
    row, part, axis, plane = (np.concatenate(columns) for columns in zip(*found, strict=True))
    order = np.lexsort((part, row))
    row, part, axis, plane = row[order], part[order], axis[order], plane[order]
    keep = (part > APART) & (part < 1 - APART)
    keep[1:] &= ~((row[1:] == row[:-1]) & (part[1:] - part[:-1] < APART))
    return row[keep], part[keep], axis[keep], plane[keep]
