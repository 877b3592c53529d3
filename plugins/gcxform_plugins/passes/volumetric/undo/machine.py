"""How `volumetric` is undone: from what is commanded to where the machine goes.

The forward model alone: nothing here is shared with the search for commands.

    c(x)  commanded point, x in 0 ... 1 along a row, mm; o  `offset`: c + o is in the table
    t     from the gauge point to the tip, mm; E(c + o, t)  error of the model, mm
    K     `curvature` (3, 3), mm/mm2: along a way w E is bent by |w| K |w|, |w| its moduli by axis
    T, r  a tip at most r (mm) from axes that turn by T (rad) goes T r, bends by T^2 r (`Arm`)

The machine is at m = c + E(c + o, t). Claimed: pieces between the cuts stay within `slack` of m,

    |m - chord of a piece| <= (|w| K |w| + bending by T and r) / (8 n^2) <= BEND_SLACK

for each of the n pieces of a line between two nodes, because E has no kink there, and a chord is
off its curve by an eighth of the bending at most (the remainder of linear interpolation). Arcs are
cut so that UNDO_SLACK holds (`arc_cuts` of `gcxform/toolpath/`). So nothing is sampled.
Nodes are found as the search finds them (`gcxform/toolpath/crossings.py`), which has tests of its
own.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Flags, Floats, Ints
from gcxform_plugins.passes.volumetric.levers import Lever
from gcxform_plugins.passes.volumetric.options import VolumetricOptions
from gcxform_plugins.passes.volumetric.place import Place
from gcxform_plugins.passes.volumetric.ranges import beyond_tables, check_inside

NO_WAY = 1e-12  # of a move; two cuts nearer to each other are one
AT_ONCE = 1e-9  # of a move: where one is looked at that begins with a jump
UNDO_SLACK = 2e-6  # mm; how far pieces of an undone arc are from the curve they stand for
BEND_SLACK = 1e-5  # mm; the same for pieces of a line, and what the bending adds to an arc


class Arm:
    """How far the error may be from its chord because the head turns, by lengths alone.

    A tip at most r from the points of all axes of the head, which turn by T in all, goes T r and
    bends by T^2 r at most. With bounds a of the angular error and s of its slope, the error along a
    way w is bent by 2 s w T r + a T^2 r, and a piece is off its chord by an eighth of that.

    turn  (n,) rad, T of each row
    long  (n,) mm, r
    reach mm, how far the tip is at most from where the errors were measured
    """

    def __init__(self, step: VolumetricOptions, lever: Lever) -> None:
        model = step.model.model
        self.angle, self.slope = model.turning(step.cells)
        self.turn = np.abs(np.radians(lever.stop - lever.begin)).sum(axis=1)
        points = [np.array(axis.point) for axis in lever.head]
        between = sum(float(np.linalg.norm(b - a)) for a, b in pairwise(points))
        tips = np.linalg.norm(lever.held + lever.gauge - points[-1], axis=1)
        self.long = tips + between
        nearest = gx.reach_of(model, np.vstack([lever.starts, lever.ends]))
        self.reach = nearest + float((self.turn * self.long).max(initial=0.0)) / 2.0

    def sag(self, rows: Ints, length: Floats, share: Floats) -> Floats:
        """Return how far (n,) mm shares of rows, `length` (n,) mm long, are off their chords."""
        turn, long = self.turn[rows] * share, self.long[rows]
        bent = 2.0 * self.slope * length * turn * long + self.angle * turn**2 * long
        return np.asarray(bent / 8.0)


class Machine:
    """Where the machine goes with commands: the forward model alone."""

    def __init__(self, step: VolumetricOptions, path: gx.Toolpath, place: Place) -> None:
        self.step = step
        self.path = path
        self.place = place
        offset = self.offset = place.offset
        model = step.model.model
        self.arm = None if place.lever is None else Arm(step, place.lever)
        reach = gx.reach_of(model, place.tool) if self.arm is None else self.arm.reach
        self.lipschitz, self.curvature = model.lipschitz(reach), model.curvature(reach)
        self.start = path.start[:, :3] + offset
        self.end = path.end[:, :3] + offset

    def run(self) -> gx.Toolpath:
        """Return the path of the machine."""
        path = self.path
        own = (path.form == gx.Form.HOME) | (path.form == gx.Form.MACHINE)
        own &= path.kind == gx.Kind.RAPID
        near = self.step.max_correction  # the table may end between a target and its command
        check_inside(self.step, path, self.offset, np.flatnonzero(~own), near)
        rows, part = self._crossings()
        whole = np.arange(len(path))
        counts = np.ones(len(path), np.int64)
        every, at = whole, np.ones(len(path))
        if len(rows):
            every = np.concatenate([whole, rows])
            at = np.concatenate([at, part])
            order = np.lexsort((at, every))
            every, at = _apart(every[order], at[order])
            counts = np.bincount(every, minlength=len(path))
        point = self._points(every, at)
        table = point + self.place.offset_of(every)
        actual = point + self.moved(table, self.place.tool_of(every, at))
        of_machine = np.flatnonzero(own[every])  # which may be where nobody has measured
        actual[of_machine[self._beyond(table[of_machine])]] = np.nan
        return self._path(counts, every, at, actual)

    def _beyond(self, table: Floats) -> Flags:
        """Return which commands (n, 3), in the table, are where nobody has measured."""
        return beyond_tables(self.step, table, self.step.max_correction)

    def _entry(self) -> Floats:
        """Return where the machine stands before the first row (3,): it errs there as well."""
        entry = self.path.entry[None, :3]
        table = entry + self.offset[:1]
        actual = entry + self.moved(table, self.place.first_tool)
        actual[self._beyond(table)] = np.nan
        return np.asarray(actual[0])

    def moved(self, table: Floats, tool: Floats | None) -> Floats:
        """Return by how much (n, 3) points in the table (n, 3) are moved: the error, mm."""
        return self.step.error(table, tool)

    @property
    def curved(self) -> bool:
        """Whether the error is more than straight between its nodes."""
        return self.arm is not None or bool(self.curvature.any())

    def _crossings(self) -> tuple[Ints, Floats]:
        """Return where lines and arcs are cut: at nodes, and arcs also where they turn far."""
        path = self.path
        plain = np.isin(path.form, gx.FREE)
        lines = np.flatnonzero((path.kind == gx.Kind.LINE) & path.starts_known & plain)
        row, part = self._curves(lines, *self._bends(lines))
        if path.has_arcs:
            bend = float(np.linalg.norm(self.curvature, 2))
            arc_row, arc_part = gx.arc_cuts(
                path, self.offset, self.step.nodes(), self.lipschitz, bend, UNDO_SLACK
            )
            row, part = np.append(row, arc_row), np.append(part, arc_part)
        begins = self._jumping()
        return np.append(row, begins), np.append(part, np.full(len(begins), AT_ONCE))

    def _jumping(self) -> Ints:
        """Return the feed rows that begin behind another length or offset, with no move between.

        A path has one place between two rows, which is that of the row before: so these have a cut
        at their beginning, where the machine is off as it is at other points of theirs.
        """
        path = self.path
        if len(self.offset) == 1:
            return np.empty(0, np.int64)
        jumps = np.append(False, (np.diff(self.offset, axis=0) != 0.0).any(axis=1))
        cuts = (path.kind != gx.Kind.RAPID) & np.isin(path.form, gx.FREE)
        return np.flatnonzero(jumps & cuts & path.starts_known)

    def _bends(self, lines: Ints) -> tuple[Ints, Floats]:
        """Return row and part of the way where lines cross a node."""
        rows: list[Ints] = [np.empty(0, np.int64)]
        parts: list[Floats] = [np.empty(0)]
        for axis, planes in enumerate(self.step.nodes()):
            a, b = self.start[lines, axis], self.end[lines, axis]
            first = np.searchsorted(planes, np.minimum(a, b), side="right")
            stop = np.searchsorted(planes, np.maximum(a, b), side="left")
            count = np.maximum(stop - first, 0)
            which = np.repeat(np.arange(len(lines)), count)
            nth = np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count)
            part = (planes[first[which] + nth] - a[which]) / (b - a)[which]
            inside = np.flatnonzero((part > 0.0) & (part < 1.0))
            rows.append(lines[which[inside]])
            parts.append(part[inside])
        return np.concatenate(rows), np.concatenate(parts)

    def _curves(self, lines: Ints, row: Ints, part: Floats) -> tuple[Ints, Floats]:
        """Return the cuts, and more where between two of them the error is no straight line."""
        if not self.curved:
            return row, part
        rows = np.concatenate([row, lines])
        stop = np.append(part, np.ones(len(lines)))
        order = np.lexsort((stop, rows))
        rows, stop = rows[order], stop[order]
        begin = np.where(np.append(True, rows[1:] != rows[:-1]), 0.0, np.append(0.0, stop[:-1]))
        way = np.abs(self.end[rows] - self.start[rows]) * (stop - begin)[:, None]
        sag = np.nan_to_num(np.einsum("ni,ij,nj->n", way, self.curvature, way)) / 8.0
        if self.arm is not None:
            length = np.sqrt((np.nan_to_num(way) ** 2).sum(axis=1))
            sag += self.arm.sag(rows, length, stop - begin)
        pieces = np.maximum(np.ceil(np.sqrt(sag / BEND_SLACK)), 1.0).astype(np.int64)
        every = np.repeat(np.arange(len(rows)), pieces)
        nth = np.arange(len(every)) - np.repeat(np.cumsum(pieces) - pieces, pieces) + 1
        at = begin[every] + (stop - begin)[every] * nth / pieces[every]
        at = np.where(nth == pieces[every], stop[every], at)
        inner = at < 1.0
        return rows[every][inner], at[inner]

    def _points(self, rows: Ints, part: Floats) -> Floats:
        """Return commanded points (n, 3) of rows at parts of their way."""
        path = self.path
        if len(rows) == len(path):
            return np.asarray(path.end[:, :3])
        start, end = path.start[rows, :3], path.end[rows, :3]
        point = start + part[:, None] * (end - start)
        arcs = path.is_arc[rows]
        if arcs.any():
            point[arcs] = gx.points_on_arcs(path, rows[arcs], part[arcs])
        return np.where((part == 1.0)[:, None] | np.isnan(point), end, point)

    def _path(self, counts: Ints, rows: Ints, part: Floats, actual: Floats) -> gx.Toolpath:
        path = self.path
        end = gx.column_major(len(rows), len(path.axes))
        end[:, :3] = actual
        a, b = path.start[rows, 3:], path.end[rows, 3:]
        end[:, 3:] = np.where((part == 1.0)[:, None], b, a + part[:, None] * (b - a))
        entry = path.entry.copy()
        entry[:3] = self._entry()
        columns: dict[str, Floats] = {"end": end}
        before = np.where(np.append(True, rows[1:] != rows[:-1]), 0.0, np.append(0.0, part[:-1]))
        inverse = path.feed_mode[rows] == gx.FeedMode.INVERSE_TIME
        if inverse.any():
            feed = path.feed[rows]
            columns["feed"] = np.where(inverse, feed / (part - before), feed)
        if path.has_arcs:
            columns["sweep"] = path.sweep[rows] * (part - before)
            middle = self._points_between(rows, (part + before) / 2)
            columns["centre"] = path.centre[rows] + middle
        new = path.with_rows(counts, **columns)
        new = new.replace(entry=entry, slack=path.slack + self.slack())
        return new.replace(sweep=gx.swept_anew(new)) if new.has_arcs else new

    def slack(self) -> float:
        """Return how far (mm) the pieces are from the curves they stand for."""
        slack = UNDO_SLACK if self.path.has_arcs else 0.0
        return slack + ((BEND_SLACK + slack) if self.curved else 0.0)

    def _points_between(self, rows: Ints, part: Floats) -> Floats:
        """Return how far the middle of pieces of arcs is moved (n, 3); 0 for other rows."""
        errors = np.zeros((len(rows), 3))
        arcs = np.flatnonzero(self.path.is_arc[rows])
        point = gx.points_on_arcs(self.path, rows[arcs], part[arcs])
        table = point + self.place.offset_of(rows[arcs])
        errors[arcs] = self.moved(table, self.place.tool_of(rows[arcs]))
        return errors


def _apart(rows: Ints, part: Floats) -> tuple[Ints, Floats]:
    """Return sorted cuts and ends of rows without cuts that are no way before the next, or after 0.

    Nodes of two axes may be met together, and an arc be divided where it meets one.
    """
    too_near = np.append((rows[1:] == rows[:-1]) & (np.diff(part) <= NO_WAY), False)
    too_near |= part <= NO_WAY
    return rows[~too_near], part[~too_near]
