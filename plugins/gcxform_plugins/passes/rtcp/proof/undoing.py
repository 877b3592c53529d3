"""How tips and axes are undone: the way of the tip when the control moves all axes in proportion.

In the notation of `gcxform/machine/chain.py`, along a row with u from 0 to 1:

    j, q      (3,) mm, (m,) degrees: X, Y, Z and the angles, both in proportion to u
    p, p0     (3,) mm: the tip on the workpiece; the tip with all axes at 0
    M_T, M_H  what table and head do:  p = M_T(q)^-1 (j + M_H(q) p0),  j = M_T(q) p - M_H(q) p0
    T, H      rad: by how much the axes of the table turn in the row, and those of the head, in all
    A         mm: how far the tip is from the axes of the head, at most
    R, V      mm: how far the point that the table carries is from its axes, at most; its own way

Claimed: in each of n even pieces the curve p(u), or j(u) for the reverse, is at most B / (8 n^2)
from its chord (an eighth of the largest second derivative: the remainder of linear interpolation),

    B = T^2 R + 2 T V + H^2 A,   V = |j(1) - j(0)| + H A   or, for the reverse, |p(1) - p(0)|

as a point at most R from axes that turn by T in all, and whose own first and second derivatives are
at most V and a, has a second derivative of at most T^2 R + 2 T V + a. From the axes of one machine
to those of another the table turns there and back: 2 T and 2 H^2 A stand for T and H^2 A. The
comparison of paths counts B / (8 n^2), as `slack`. Nothing is shared with the cutting of lines.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Flags, Floats, Ints
from gcxform_plugins.passes.rtcp.place import Place

TOO_MANY = 2.0**40  # pieces: refused, and still a whole number
SHARE = 0.1
"""The part of the tolerance that is left to the pieces of the proof."""


class Undoing:
    """The work on one window."""

    def __init__(
        self, path: gx.Toolpath, place: Place, to_tips: bool, posted: Place | None = None
    ) -> None:
        self.path = path
        self.place = place
        self.posted = posted
        self.to_tips = to_tips
        self.start, self.end = path.start, path.end

    def run(self, tolerance: float) -> gx.Toolpath:
        """Return the path of tips; of axes for the reverse, and of those that were posted for.

        A tenth of the tolerance (mm) is left to the pieces in which it is followed.
        """
        path = self.path
        bend = self.bends()
        pieces = np.ceil(np.sqrt(bend / (SHARE * tolerance)) - 1e-9)
        pieces = path.check_rows(np.clip(pieces, 1.0, TOO_MANY).astype(np.int64))
        row = np.repeat(np.arange(len(path)), pieces)
        nth = np.arange(len(row)) - np.repeat(np.cumsum(pieces) - pieces, pieces) + 1
        part = (nth / pieces[row])[:, None]
        last = part == 1.0
        end = np.where(last, self.end[row], (1.0 - part) * self.start[row] + part * self.end[row])
        end[:, :3] = self._turned(end, row)
        feed = path.feed[row] * np.where(self._timed(row), pieces[row], 1.0)
        new = path.with_rows(pieces, end=np.asfortranarray(end), feed=feed)
        slack = float(np.max(bend / pieces**2, initial=0.0))
        return new.replace(entry=self._entry(), slack=path.slack + slack)

    def _timed(self, row: Ints) -> Flags:
        return np.asarray(self.path.feed_mode[row] == gx.FeedMode.INVERSE_TIME)

    def _turned(self, positions: Floats, rows: Ints) -> Floats:
        change = self.place.tips_of if self.to_tips else self.place.axes_of
        angles = self.place.angles(positions)
        found = change(positions[:, :3], angles, rows)
        return found if self.posted is None else self.posted.axes_of(found, angles, rows)

    def _entry(self) -> Floats:
        entry = self.path.entry.copy()
        entry[:3] = self._turned(entry[None, :], np.array([0]))[0]
        return entry

    def bends(self) -> Floats:
        """Return an eighth of the bound of the second derivative of each row, mm."""
        path = self.path
        bend = np.zeros(len(path))
        rows = np.flatnonzero((path.kind == gx.Kind.LINE) & path.starts_known)
        turning = np.abs(self._steps(rows)).max(axis=1, initial=0.0) > 0.0
        rows = rows[turning & ~self.place.off[rows]]
        rows = rows[np.isfinite((self.start + self.end)[rows, :3]).all(axis=1)]  # or it is far off
        for chain, here in self.place.chains(rows):
            bend[rows[here]] = self.bend(chain, rows[here]) / 8.0
        return bend

    def _steps(self, rows: Ints) -> Floats:
        return np.radians(self.place.angles(self.end[rows]) - self.place.angles(self.start[rows]))

    def bend(self, chain: gx.Chain, rows: Ints) -> Floats:
        """Return a bound of the second derivative of rows (n,) in which a chain turns, mm."""
        step = np.abs(self._steps(rows))
        table = step[:, : len(chain.table)].sum(axis=1)
        head = step[:, len(chain.table) :].sum(axis=1)
        inner, outer, between = _centres(chain.head)
        arm = float(np.linalg.norm(np.array(chain.tip) - inner)) + between
        start, end = self.start[rows], self.end[rows]
        way = np.linalg.norm((end - start)[:, :3], axis=1)
        inner, outer, between = _centres(chain.table)
        if self.to_tips:
            way = way + head * arm
            carried = (
                self.place.zero + p[:, :3] + chain.arm(self.place.angles(p)) - outer
                for p in (start, end)
            )
        else:
            carried = (self.place.on_workpiece(p[:, :3], chain) - inner for p in (start, end))
        ends = np.max([np.linalg.norm(vectors, axis=1) for vectors in carried], axis=0)
        far = ends + way / 2.0 + between
        if self.posted is None:
            return np.asarray(table**2 * far + 2.0 * table * way + head**2 * arm)
        return self._there_and_back(table, head, far, way)

    def _there_and_back(self, table: Floats, head: Floats, far: Floats, way: Floats) -> Floats:
        """Return the same of axes to which another machine has brought a tip, and its own arm."""
        assert self.posted is not None
        arm = 0.0
        for place in (self.place, self.posted):
            inner, _, between = _centres(place.chain.head)
            reach = np.linalg.norm(place.gauge - place.tools - inner, axis=1).max()
            arm = max(arm, float(reach) + between)
        inner, outer, one = _centres(self.place.chain.table)
        own_inner, own_outer, other = _centres(self.posted.chain.table)
        gaps = [np.linalg.norm(inner - own_inner), np.linalg.norm(outer - own_outer)]
        far = far + one + other + float(np.sum(gaps))
        turns = 2.0 * table
        return np.asarray(turns**2 * far + 2.0 * turns * way + 2.0 * head**2 * arm)


def _centres(axes: tuple[gx.Rotary, ...]) -> tuple[Floats, Floats, float]:
    """Return points on the innermost and the outermost axis of a side, and the way between all.

    The way is along one point on each; of two axes these are where they are nearest.
    """
    if not axes:
        return np.zeros(3), np.zeros(3), 0.0
    points = [np.array(axis.point) for axis in axes]
    if len(axes) == 2:
        ways = np.array([axes[0].direction, axes[1].direction])
        along = np.linalg.lstsq(
            np.stack([ways[0], -ways[1]], axis=1), points[1] - points[0], rcond=None
        )[0]
        points = [point + a * way for point, a, way in zip(points, along, ways, strict=True)]
    between = sum(float(np.linalg.norm(b - a)) for a, b in pairwise(points))
    return points[-1], points[0], between
