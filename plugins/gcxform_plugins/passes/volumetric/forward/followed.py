"""How `volumetric` works forward where the control follows the tip and axes turn.

Along a line of tips p with angles a, s from 0 to 1, the axes stand at q(p, a), and the machine,
sent to c with c + E(c) = q, brings the tip to p. What is written is the tip p' that c stands for.
The control goes straight in p', with angles in proportion, so the tip is off its line by as much as
the correction d = p' - p = -R(a)^-1 E(c) leaves its chord. With

    T, Q   rad, mm: how far the table turns in all; a bound of |q''| (`passes/shared/tip_bound.py`)
    v      mm: |q(1) - q(0)| + Q / 2, how far the axes go at most
    L, K   of the error: its slope and curvature;  e: the largest |E| on the way

each of n pieces is off by at most

    L v / (2 n)                                            if they may cross a node of the table
    (T^2 e + 2 T L v + L Q + v K v) / (8 n^2)              besides; and what a turning head bends

and d is no steeper than E by more than 1 + 4 L. So many pieces are made that the sum holds. Lines
along which no axis turns are straight for the axes as well, and are cut as everywhere. Angles of
pieces are rounded when they are written: the tip stays where it is, as the control follows it.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Flags, Floats, Ints
from gcxform_plugins.passes.volumetric.followed import Followed
from gcxform_plugins.passes.volumetric.forward.compensation import PACE, SAME, Compensation
from gcxform_plugins.passes.volumetric.forward.window import PROOF, PROOF_SHARE
from gcxform_plugins.passes.volumetric.options import VolumetricOptions
from gcxform_plugins.passes.volumetric.place import Place
from gcxform_plugins.passes.volumetric.ranges import check_points, crosses, leaves
from gcxform_plugins.passes.volumetric.ways import WAYPOINTS, aside_of, ways_of

MOST = 100_000  # pieces of one block
FOLLOWED = 1e-5  # mm; what the proof may add besides, for tips that it does not follow


class FollowedCompensation(Compensation):
    """The forward work on one window: `path` has positions of axes, `tips` those of the tip."""

    def __init__(self, step: VolumetricOptions, followed: Followed, place: Place) -> None:
        followed.refuse()
        self.followed = followed
        self.number = np.full(len(followed.path), -1)
        self.number[followed.rows[followed.turning]] = np.flatnonzero(followed.turning)
        super().__init__(step, followed.axes(), place)
        self.room = step.limit - min(PROOF + FOLLOWED, PROOF_SHARE * step.limit)

    def run(self) -> gx.Toolpath:
        """Return the tips to be commanded."""
        return Followed.of(super().run(), self.followed.context).tips()

    def _cuts(self, commands: Floats) -> tuple[Ints, Floats]:
        """Return the cuts of lines along which no axis turns, and of those along which one does."""
        row, part = super()._cuts(commands)
        if self.step.split == "none":
            return row, part
        straight = self.number[row] < 0
        which = np.flatnonzero(self.followed.turning)
        rows, count = self.followed.rows[which], self._pieces(which)
        self._check_lengths(rows, count)
        every = np.repeat(np.arange(len(rows)), count - 1)
        first = np.cumsum(count - 1) - (count - 1)
        nth = np.arange(len(every)) - first[every] + 1
        more = nth / count[every]
        return np.append(row[straight], rows[every]), np.append(part[straight], more)

    def _between(self, rows: Ints, part: Floats) -> Floats:
        """Return the places of the axes at parts of rows, in the table."""
        point = super()._between(rows, part)
        which = self.number[rows]
        mine = which >= 0
        axes = self.followed.axes_at(which[mine], part[mine])
        point[mine] = axes + self.offset_of(rows[mine])
        return point

    # --- pieces ---

    def _pieces(self, which: Ints) -> Ints:
        """Return into how many pieces (n,) lines are cut, `which` of the rows that follow."""
        kinked, bent = (each * (1 + 4 * self.lipschitz) for each in self._bounds(which))
        limit = self.room
        count = np.ceil((kinked + np.sqrt(kinked**2 + 4 * bent * limit)) / (2 * limit))
        count = np.asarray(np.maximum(np.nan_to_num(count), 1.0), np.int64)
        if len(count) and int(count.max()) > MOST:
            row = self.followed.rows[which[np.argmax(count)]]
            message = f"this block would become more than {MOST} pieces"
            raise self.path.refuse("GX330", np.array([row]), message, "raise the tolerance")
        return count

    def _bounds(self, which: Ints) -> tuple[Floats, Floats]:
        """Return by how much (n,) mm lines in one piece are off at nodes, and besides."""
        place = self.followed.place
        assert place is not None
        rows = self.followed.rows[which]
        start, end = self.start[rows], self.end[rows]
        path = self.followed.path
        first, last = (place.angles(each[rows]) for each in (path.start, path.end))
        aside = aside_of(self.followed, which)
        self._check_ways(which, aside)
        turn = np.abs(np.radians(last - first))[:, : len(place.chain.table)].sum(axis=1)
        way = np.abs(end - start) + 4.0 * aside[:, None]
        fast = np.sqrt((way**2).sum(axis=1))
        steep = self.lipschitz * fast
        head, bent = np.zeros(len(rows)), np.einsum("ni,ij,nj->n", way, self.curvature, way)
        if self.swing is not None:
            head = self.swing.angle * self.swing.speed[rows]
            bent += 8.0 * self.swing.bend(rows, way, np.ones(len(rows)))
        large = self._largest(rows) + steep + head
        bent += turn**2 * large + 2.0 * turn * (steep + head) + 8.0 * self.lipschitz * aside
        return np.where(self._meets(start, end, aside), (steep + head) / 2.0, 0.0), bent / 8.0

    def _largest(self, rows: Ints) -> Floats:
        """Return the error (n,) mm at the ends of rows, the larger one."""
        place = self.place
        sides = (self.start, place.tool_before(rows)), (self.end, place.tool_of(rows))
        errors = [self.step.error(at[rows], tool) for at, tool in sides]
        return np.asarray(np.max([np.linalg.norm(each, axis=1) for each in errors], axis=0))

    def _meets(self, start: Floats, end: Floats, aside: Floats) -> Flags:
        """Return whether a node may be in the way (n,) of lines, or of their commands."""
        near = (aside + self.step.max_correction)[:, None]
        low, high = np.minimum(start, end) - near, np.maximum(start, end) + near
        meets = np.zeros(len(start), np.bool_)
        for axis, planes in enumerate(self.step.nodes()):
            first = np.searchsorted(planes, low[:, axis])
            meets |= np.searchsorted(planes, high[:, axis]) > first
        return meets

    # --- refusals ---

    def _check_ways(self, which: Ints, aside: Floats) -> None:
        """Refuse lines along which the axes leave the table, between ends that are within it."""
        rows, near = self.followed.rows[which], aside + self.step.max_correction
        near_border = leaves(self.step, self.start[rows], self.end[rows], near)
        which, aside = which[near_border], aside[near_border]
        if not len(which):
            return
        points, rows = ways_of(self.followed, which)
        points = points + self.offset_of(rows)
        check_points(self.step, self.path, points, rows)
        if self.step.outside is not gx.Outside.ZERO:
            return
        ends = points.reshape(len(which), WAYPOINTS + 1, 3)
        near = aside / WAYPOINTS**2 + self.step.max_correction
        over = [crosses(self.step, a, b, near) for a, b in pairwise(np.moveaxis(ends, 1, 0))]
        jumps = np.any(over, axis=0)
        if jumps.any():
            raise self.refuse_jump(self.followed.rows[which[jumps]][:1])

    def _check_lengths(self, rows: Ints, count: Ints) -> None:
        """Refuse pieces that are shorter than is allowed."""
        path = self.followed.path
        length = np.sqrt(((path.end - path.start)[rows, :3] ** 2).sum(axis=1)) / count
        short = (count > 1) & (length < self.step.min_length)
        if short.any():
            first = int(np.argmax(short))
            raise self.refuse_short(int(rows[first]), float(length[first]))

    def _check_paces(self, commands: Floats) -> None:
        """Refuse feeds per minute where the correction is much of what the tip goes.

        The control would measure the feed along a few micrometres, and turn its axes in no time.
        """
        path, followed = self.followed.path, self.followed
        which = np.flatnonzero(followed.turning)
        rows = followed.rows[which]
        assert followed.place is not None
        before = np.vstack([self.entry_command, commands[:-1]])[rows] - self.offset_of(rows)
        after = commands[rows] - self.offset_of(rows)
        tips = [
            followed.place.tips_of(each, followed.place.angles(side[rows]), which)
            for each, side in ((before, path.start), (after, path.end))
        ]
        way = (path.end - path.start)[rows, :3]
        moved = np.sqrt(((tips[1] - tips[0] - way) ** 2).sum(axis=1))
        wrong = moved > PACE * np.sqrt((way**2).sum(axis=1)) + SAME
        wrong &= path.feed_mode[rows] != gx.FeedMode.INVERSE_TIME
        if wrong.any():
            message = "axes turn and the tip hardly moves, but for the correction"
            hint = "write it in inverse time (G93), whose feed does not depend on how far it goes"
            raise path.refuse("GX316", rows[wrong][:1], message, hint)
