"""`arcs`: runs of short lines become arcs and helices.

An arc goes exactly through the first and the last point of its run. It is taken only where it is
proved (`fit.py`) to be within the tolerance of the lines and they of it, along the whole run, with
the angle growing from point to point: so that what a compensation or a linearisation has made of an
arc gets small again, and nothing else is rounded off.

What is joined has one feed, one work offset, one unit and one plane, that which is active: an arc
in another one would need codes that the program does not have.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Flags, Floats, Ints
from gcxform_plugins.passes.arcs.fit import Fit, Limits
from gcxform_plugins.passes.arcs.reach import farthest_reaching

INCH = 25.4
STEPS = 200
"""Least radius, in steps of the last decimal: rounded, a smaller arc could turn otherwise."""


@dataclass(frozen=True)
class Arcs(gx.Pass):
    """Make arcs and helices of runs of short lines.

    An arc begins and ends where its lines do; all along, it is within `tolerance` of them and they
    of it. Lines are joined only where nothing happens between them and the feed stays the same,
    and only in the plane that is active. Lines that an arc replaces leave the program; their
    comments stay.
    """

    name = "arcs"
    clears = frozenset({gx.LINEAR_ONLY, gx.XY_ARCS})
    demands = gx.Demands(joins=True)

    tolerance: Annotated[
        gx.Length,
        gx.Option("largest distance of an arc from its lines, and of them from it", above=0.0),
    ]
    min_lines: Annotated[int, gx.Option("fewest lines that become an arc", at_least=2)] = 4
    max_radius: Annotated[gx.Length, gx.Option("largest radius", above=0.0)] = 1000.0
    max_sweep: Annotated[
        gx.Angle, gx.Option("largest angle of an arc", above=0.0, at_most=350.0)
    ] = 350.0

    @property
    def promise(self) -> float:
        """The tolerance."""
        return self.tolerance

    def apply(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        """Return the path with arcs for runs of lines."""
        follows = self._follows(path)
        for plane in gx.Plane:
            here = follows & (path.plane == plane)
            if plane.name not in context.target.arc_rule.planes or not here.any():
                continue
            fit = Fit(_corners(path, plane), self._limits(path, context))
            first, last = farthest_reaching(fit, here, path.source, self.min_lines)
            path, follows = _joined(path, plane, fit, first, last, follows)
        return path

    def _limits(self, path: gx.Toolpath, context: gx.PassContext) -> Limits:
        inch = bool(path.blocks.inch.any())
        step = 10.0**-context.numbers.inch * INCH if inch else 10.0**-context.numbers.mm
        return Limits(
            self.tolerance, STEPS * step, self.max_radius, np.radians(self.max_sweep), step
        )

    def _follows(self, path: gx.Toolpath) -> Flags:
        """Return the rows that may be one arc together with the row before."""
        may = _plain_lines(path)
        follows = np.zeros(len(path), np.bool_)
        follows[1:] = may[1:] & may[:-1]
        for column in (path.plane, path.feed, path.feed_mode, path.frame):
            follows[1:] &= column[1:] == column[:-1]
        blocks, block = path.blocks, path.block
        for mode in (blocks.inch, blocks.incremental, blocks.absolute_centre, blocks.feed_mode):
            follows[1:] &= mode[block[1:]] == mode[block[:-1]]
        follows[[e.row for e in path.events if e.row < len(path)]] = False
        return follows


def _plain_lines(path: gx.Toolpath) -> Flags:
    """Return the lines of X, Y and Z, and of nothing else, from one known place to another."""
    start, end = path.start, path.end
    may = (path.kind == gx.Kind.LINE) & (path.form == gx.Form.PLAIN) & (path.side == 0)
    may &= (path.feed_mode != gx.FeedMode.INVERSE_TIME) & (path.lost == 0) & (path.nth == 0)
    may &= np.isfinite(start[:, :3]).all(axis=1) & np.isfinite(end[:, :3]).all(axis=1)
    for k in range(3, len(path.axes)):
        may &= (start[:, k] == end[:, k]) | (np.isnan(start[:, k]) & np.isnan(end[:, k]))
    turned = [frame.matrix is not None or frame.polar for frame in path.frames]
    may &= ~np.array(turned, np.bool_)[path.frame]
    may &= ~path.blocks.apart[path.block]
    return np.asarray(may)


def _corners(path: gx.Toolpath, plane: gx.Plane) -> Floats:
    """Return the points (3, n + 1) between rows: first, second and normal axis of a plane, mm."""
    corners = np.empty((3, len(path) + 1))
    for k, axis in enumerate(plane.axes):
        corners[k, 0], corners[k, 1:] = path.entry[axis], path.end[:, axis]
    return corners


def _joined(
    path: gx.Toolpath, plane: gx.Plane, fit: Fit, first: Ints, last: Ints, follows: Flags
) -> tuple[gx.Toolpath, Flags]:
    """Return the path with the rows from `first` to `last` (inclusive) as one arc each."""
    if not len(first):
        return path, follows
    arcs = fit.arcs(first, last + 1)
    kind, end = np.array(path.kind), np.array(path.end, order="F")
    centre, sweep = np.array(path.centre), np.array(path.sweep)
    kind[first] = np.where(arcs.sense > 0, gx.Kind.ARC_CCW, gx.Kind.ARC_CW)
    end[first], sweep[first] = path.end[last], arcs.sweep
    a, b, normal = plane.axes
    centre[first, a], centre[first, b] = arcs.centre
    centre[first, normal] = fit.corners[2, first]
    inside = np.zeros(len(path) + 1, np.int64)
    np.add.at(inside, first + 1, 1)
    np.add.at(inside, last + 1, -1)
    kept = np.flatnonzero(np.cumsum(inside)[:-1] == 0)
    events = tuple(event.at(int(np.searchsorted(kept, event.row))) for event in path.events)
    new = path.replace(kind=kind, end=end, centre=centre, sweep=sweep, events=events, joined=True)
    return new.take(kept), follows[kept]
