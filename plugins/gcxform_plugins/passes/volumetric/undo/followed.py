"""Where the tip goes with commanded tips that the control follows, on a machine that errs.

The forward model alone, as in `machine.py`. Along a row, s from 0 to 1, p and the angles a go in
proportion, the control brings its axes to q(p, a), they stand at q + E(q), and the tip is at

    m = p + R(a)^-1 E(q)

with R the turn of the table. Claimed: n even pieces of a row between whose ends axes turn stay
within FOLLOW_SLACK of m, for with

    T, Q     rad, mm: by how much the table turns in all; a bound of |q''| (`rtcp/proof/undoing.py`)
    v        mm: |q(1) - q(0)| + Q / 2, how far the axes go at most
    L, K     mm/mm, 1/mm: slope and curvature of E between its nodes; e, mm: the largest |E|

R^-1 E is bent by at most T^2 e + 2 T L v + L Q + v K v where no node is crossed, and what the head
adds (`Arm`), and its chord is off by an eighth of that; and a kink, which changes the slope by no
more than 2 L v, puts a chord off by a quarter of it at most. In pieces the first goes by 1 / n^2,
and the second by 1 / n.
"""

from __future__ import annotations

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Flags, Floats, Ints
from gcxform_plugins.passes.rtcp.proof.undoing import Undoing
from gcxform_plugins.passes.volumetric.followed import Followed
from gcxform_plugins.passes.volumetric.options import VolumetricOptions
from gcxform_plugins.passes.volumetric.place import Place
from gcxform_plugins.passes.volumetric.undo.machine import BEND_SLACK, Machine

FOLLOW_SLACK = BEND_SLACK  # mm


class FollowedMachine(Machine):
    """Where tips go: `path` has positions of the axes, and comes back as one of tips."""

    def __init__(self, step: VolumetricOptions, followed: Followed, place: Place) -> None:
        self.followed = followed
        self.number = np.full(len(followed.path), -1)
        self.number[followed.rows[followed.turning]] = np.flatnonzero(followed.turning)
        super().__init__(step, followed.axes(), place)

    def run(self) -> gx.Toolpath:
        """Return the path of the tips."""
        return Followed.of(super().run(), self.followed.context).tips()

    def slack(self) -> float:
        """Return how far (mm) the pieces are from the curves they stand for."""
        return super().slack() + FOLLOW_SLACK

    def _crossings(self) -> tuple[Ints, Floats]:
        """Return where rows are cut: those along which axes turn into even pieces."""
        row, part = super()._crossings()
        straight = self.number[row] < 0
        row, part = row[straight], part[straight]
        which = np.flatnonzero(self.followed.turning)
        rows, share = self.followed.rows[which], self._share(which)
        every = np.repeat(np.arange(len(rows)), share)
        nth = np.arange(len(every)) - np.repeat(np.cumsum(share) - share, share)
        inner = np.flatnonzero(nth)
        more = nth[inner] / share[every[inner]]
        return np.append(row, rows[every[inner]]), np.append(part, more)

    def _points(self, rows: Ints, part: Floats) -> Floats:
        """Return where the control sends the axes (n, 3) at parts of rows."""
        point = super()._points(rows, part).copy()
        which = self.number[rows]
        mine = (which >= 0) & (part < 1.0)
        point[mine] = self.followed.axes_at(which[mine], part[mine])
        return point

    def _share(self, which: Ints) -> Ints:
        """Return into how many pieces (n,) rows have to be cut, `which` of those that follow."""
        rows, place = self.followed.rows[which], self.followed.place
        assert place is not None
        bent, fast = self._ways(rows, which)
        table = [place.columns[k] for k in range(len(place.chain.table))]
        turn = np.radians(np.abs(self.path.end - self.path.start)[rows][:, table]).sum(axis=1)
        slope = self.lipschitz * np.linalg.norm(fast, axis=1)
        curve = np.einsum("ni,ij,nj->n", fast, self.curvature, fast) / 8.0
        if self.arm is not None:
            curve += self.arm.sag(rows, np.linalg.norm(fast, axis=1), np.ones(len(rows)))
            slope = slope + self.arm.angle * self.arm.turn[rows] * self.arm.long[rows]
        large = slope + np.maximum(self._size(self.start, rows), self._size(self.end, rows))
        curve += self.lipschitz * bent + turn**2 * large / 8.0 + turn * slope / 4.0
        kink = np.where(self._crosses(rows, fast), slope / 2.0, 0.0)
        smooth = np.sqrt(2.0 * curve / FOLLOW_SLACK)
        pieces = np.maximum(np.ceil(smooth), np.ceil(2.0 * kink / FOLLOW_SLACK))
        return np.asarray(np.maximum(pieces, 1.0), np.int64)

    def _ways(self, rows: Ints, which: Ints) -> tuple[Floats, Floats]:
        """Return an eighth of a bound of |q''| (n,) mm, and how far axes go at most (n, 3) mm."""
        mine, place = self.followed.rows, self.followed.place
        assert place is not None
        tips = Undoing(self.followed.path.take(mine), place, to_tips=False)
        tips.start, bent = self.followed.path.start[mine], np.zeros(len(which))
        for chain, here in place.chains(which):
            bent[here] = tips.bend(chain, which[here]) / 8.0
        return bent, np.abs(self.end - self.start)[rows] + 4.0 * bent[:, None]

    def _size(self, table: Floats, rows: Ints) -> Floats:
        """Return how large (n,) mm the error is at places of rows, at the angles of their ends."""
        place = self.place
        tool = place.tool_before(rows) if table is self.start else place.tool_of(rows)
        return np.asarray(np.linalg.norm(self.moved(table[rows], tool), axis=1))

    def _crosses(self, rows: Ints, fast: Floats) -> Flags:
        """Return whether axes may cross a node (n,): none is as far from where they begin."""
        found = np.zeros(len(rows), np.bool_)
        for axis, planes in enumerate(self.step.nodes()):
            away = np.abs(np.subtract.outer(self.start[rows, axis], planes))
            found |= (away <= fast[:, axis, None]).any(axis=1)
        return found
