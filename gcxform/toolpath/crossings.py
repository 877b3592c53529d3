"""Where moves cross the planes on which an error field bends."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gcxform.system.arrays import Flags, Floats, Ints
from gcxform.toolpath.angles import TURN

Crossings = tuple[Ints, Floats, Ints, Floats]
"""Row, part of the move (0 to 1), axis and plane of each crossing, by row and part."""

APART = 1e-12  # parts of a move closer than this are one


def line_crossings(points: Floats, lines: Flags, nodes: Sequence[Floats]) -> Crossings:
    """Return where moves that go straight from point to point cross the planes x, y, z = node.

    points (n + 1, 3) mm: where the first move starts, and where each ends; lines (n,): the moves
    that are looked at. Ends of moves are no crossings.
    """
    found = []
    for axis, planes in enumerate(nodes):
        if not len(planes):
            continue
        cell = np.searchsorted(planes, points[:, axis], side="right")
        rows = np.flatnonzero((cell[1:] != cell[:-1]) & lines)
        if len(rows):
            found.append(_on_axis(rows, points[rows, axis], points[rows + 1, axis], axis, planes))
    return _sorted(found)


def _on_axis(rows: Ints, a: Floats, b: Floats, axis: int, planes: Floats) -> Crossings:
    """Return the crossings of some moves with the planes of one axis."""
    low = np.searchsorted(planes, np.minimum(a, b), side="right")
    high = np.searchsorted(planes, np.maximum(a, b), side="left")
    count = np.where(np.isnan(a) | np.isnan(b), 0, np.maximum(high - low, 0))
    which = np.repeat(np.arange(len(rows)), count)
    nth = np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count)
    plane = planes[low[which] + nth]
    part = (plane - a[which]) / (b[which] - a[which])
    return rows[which], part, np.full(len(which), axis), plane


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
