"""Moves of one path that stand for runs of moves of another, and how far they are from them.

A row that joins several moves carries the line of the first. The rows of the others are left
without any row of their own, directly after the one they were joined to: from that, and from
nothing that a pass or the writer says, a run is known. What must be the same along a run is looked
at here, and the path along it is compared in both directions and in the order of travel
(`gcxform.deviations.chains`); what is left out of every run has to be too short to matter.
"""

from __future__ import annotations

import numpy as np

from gcxform.deviations.chains import ROOM, Chain, along_chains
from gcxform.deviations.deviation import Deviation, deviation
from gcxform.dialect.dialect import LINEAR
from gcxform.system.arrays import Flags, Floats, Ints
from gcxform.system.distinct import distinct
from gcxform.toolpath.path import FeedMode, Form, Kind, Toolpath
from gcxform.toolpath.splines import spline_chords, splines_as_lines
from gcxform.values import dataclass

SAME_FEED = 2e-4  # relative; what the rounding of a feed may change
STILL = 1e-9  # mm, deg
STRAIGHT = 1e-5  # mm; lines that stand for a spline beside arcs are so near to it


@dataclass(frozen=True, slots=True)
class Runs:
    """Which rows of a path each row of another stands for.

    owner    (rows,) the first of them
    through  (rows,) the last of them
    left     rows of the first path that no row of the other stands for
    """

    owner: Ints
    through: Ints
    left: Ints

    @property
    def joined(self) -> Ints:
        """Rows that stand for several."""
        return np.flatnonzero(self.through > self.owner)


def runs_of(before: Toolpath, owner: Ints) -> Runs:
    """Return what each row of another path stands for; `owner` (rows,) is where its line begins."""
    has = np.zeros(len(before), np.bool_)
    has[owner] = True
    if has.all():
        return Runs(owner, owner, np.empty(0, np.int64))
    row = np.arange(len(before))
    base = np.maximum.accumulate(np.where(has, row, -1))
    alike = ~has & (base >= 0) & _alike(before, base)
    stop = np.maximum.accumulate(np.where(has | alike, -1, row))
    covered = alike & (stop < base)
    last = np.where(has, row, -1)
    np.maximum.at(last, base[covered], row[covered])
    return Runs(owner, last[owner], np.flatnonzero(~has & ~covered))


def _alike(path: Toolpath, base: Ints) -> Flags:
    """Return which rows may be in a run that begins with the row `base`."""
    free = _joinable(path)
    same = free & free[base] & (path.frame == path.frame[base])
    same &= path.feed_mode == path.feed_mode[base]
    return np.asarray(same & (np.abs(path.feed - path.feed[base]) <= SAME_FEED * path.feed))


def _joinable(path: Toolpath) -> Flags:
    """Return which rows may be a part of a run: plain feed moves of X, Y, Z from a known place."""
    start, end = path.start, path.end
    plain = (path.form == Form.PLAIN) | (path.form == Form.SPLINE)
    free = plain & (path.kind != Kind.RAPID) & (path.side == 0)
    free &= np.isfinite(start[:, :3]).all(axis=1) & np.isfinite(end[:, :3]).all(axis=1)
    free &= (path.feed_mode != FeedMode.INVERSE_TIME) & (path.lost == 0)
    for k in range(3, len(path.axes)):
        a, b = start[:, k], end[:, k]
        free &= (np.abs(a - b) < STILL) | (np.isnan(a) & np.isnan(b))
    return np.asarray(free)


def deviation_of_runs(
    before: Toolpath, after: Toolpath, runs: Runs, ahead: float = 0.0
) -> Deviation:
    """Return how far the rows of `after` are from the rows of `before` that they stand for.

    As `deviation`, but that a row may stand for several. Rows that it stands for besides its owner
    count for nothing if they are no longer than `ahead` (mm) together and it follows its owner.
    """
    off = deviation(before, after, runs.owner, ahead)
    _arcs_beside_splines(before, after, runs.owner, off.distance)
    rows = runs.joined
    if not len(rows):
        return off
    group = np.cumsum(np.append(True, np.diff(runs.owner[rows]) != 0)) - 1
    first = rows[np.append(True, np.diff(group) != 0)]
    lengths = runs.through[first] - runs.owner[first] + 1
    sources = _ranges(runs.owner[first], lengths)
    distance, angle = np.array(off.distance), np.array(off.angle)
    one = _straightened(Chain(before, sources, np.repeat(np.arange(len(first)), lengths)))
    other = Chain(after, rows, group)
    for part in _portions(len(first), one, other):
        mine, theirs = one.of(*part), other.of(*part)
        distance[theirs.rows] = along_chains(mine, theirs)
    aside, turned = _other_axes(before, after, runs.owner, rows)
    distance[rows], angle[rows] = np.hypot(distance[rows], aside), turned
    distance[rows] += before.slack + after.slack + (STRAIGHT if one.path is not before else 0.0)
    slight = _left_over(before, runs, rows) <= ahead
    distance[rows] = np.where(slight, np.minimum(distance, off.distance)[rows], distance[rows])
    return Deviation(distance, angle, off.unknown_start)


def _arcs_beside_splines(before: Toolpath, after: Toolpath, owner: Ints, distance: Floats) -> None:
    """Note in `distance` (mm) how far rows are from splines of which arcs have become a part.

    Such a spline is compared as the lines that stand for it, as near to it as `STRAIGHT`.
    """
    arcs = np.flatnonzero(after.is_arc & before.is_spline[owner])
    if not len(arcs):
        return
    group = np.full(len(before), -1)
    splines = distinct(owner[arcs])
    group[splines] = np.arange(len(splines))
    pieces = np.ones(len(before), np.int64)
    pieces[splines] = spline_chords(before, splines, STRAIGHT)
    lines, whose = (
        splines_as_lines(before, pieces),
        group[np.repeat(np.arange(len(before)), pieces)],
    )
    rows = np.flatnonzero(group[owner] >= 0)
    one = Chain(lines, np.flatnonzero(whose >= 0), whose[whose >= 0])
    other = Chain(after, rows, group[owner[rows]])
    for part in _portions(len(splines), one, other):
        mine, theirs = one.of(*part), other.of(*part)
        distance[theirs.rows] = along_chains(mine, theirs)
    aside, _ = _other_axes(before, after, owner, rows)
    distance[rows] = np.hypot(distance[rows] + STRAIGHT, aside) + after.slack


def _straightened(chain: Chain) -> Chain:
    """Return a chain with lines for its splines, as near to them as `STRAIGHT`."""
    path, rows = chain.path, chain.rows
    splines = distinct(rows[path.is_spline[rows]])
    if not len(splines):
        return chain
    pieces = np.ones(len(path), np.int64)
    pieces[splines] = spline_chords(path, splines, STRAIGHT)
    first, count = np.cumsum(pieces) - pieces, pieces[rows]
    lines = splines_as_lines(path, pieces)
    return Chain(lines, _ranges(first[rows], count), np.repeat(chain.group, count))


def _left_over(before: Toolpath, runs: Runs, rows: Ints) -> Floats:
    """Return the lengths (mm) of what rows stand for besides their owners; inf with arcs in it."""
    way = np.nan_to_num(before.end - before.start)
    length = np.where(before.is_arc | before.is_spline, np.inf, np.sqrt((way**2).sum(axis=1)))
    begin = runs.owner[rows] + 1
    whole = np.add.reduceat(
        np.append(length, 0.0), np.stack([begin, runs.through[rows] + 1], 1).ravel()
    )
    return np.asarray(whole[0::2])


def _ranges(first: Ints, lengths: Ints) -> Ints:
    """Return first[k], first[k] + 1 ... for each k, one after another."""
    offset = np.repeat(np.cumsum(lengths) - lengths, lengths)
    return np.arange(len(offset)) - offset + np.repeat(first, lengths)


def _portions(groups: int, one: Chain, other: Chain) -> list[tuple[int, int]]:
    """Return ranges of groups that are as long as a processor's cache has room for."""
    size = np.bincount(one.group, minlength=groups) + np.bincount(other.group, minlength=groups)
    which = np.cumsum(size) // ROOM
    edges = np.flatnonzero(np.append(True, np.diff(which) != 0)).tolist()
    return list(zip(edges, [*edges[1:], groups], strict=True))


def _other_axes(
    before: Toolpath, after: Toolpath, owner: Ints, rows: Ints
) -> tuple[Floats, Floats]:
    """Return how far (mm, deg) axes beyond X, Y, Z are from where they stand along a run."""
    distance, angle = np.zeros((2, len(rows)))
    for k, axis in enumerate(before.axes[3:], 3):
        wanted, end = before.end[owner[rows], k], after.end[rows, k]
        gap = np.where(np.isnan(wanted) & np.isnan(end), 0.0, np.abs(end - wanted))
        gap = np.where(np.isnan(gap), np.inf, gap)
        if axis in LINEAR:
            distance = np.hypot(distance, gap)
        else:
            angle = np.maximum(angle, gap)
    return distance, angle
