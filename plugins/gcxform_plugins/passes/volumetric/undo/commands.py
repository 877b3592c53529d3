"""How `volumetric inverse=true` is undone: the commands that take the machine along a path.

The search for them is done here once more, and shares nothing with the writing of the path. Where
the error is linear between its nodes, the commands for a straight way whose two ends have their
commands in one cell of the table are a straight way as well: a cell is convex, and the machine goes
straight along straight commands in it. So ways are cut until that is so of every piece.

    q, c  a point of the path of the machine, and its command: c + E(c) = q; mm
    L     `lipschitz` of E, at most STEEPEST

Claimed: c_k+1 = q - E(c_k) ends within FOUND of c, for |c_k+1 - c| <= L / (1 - L) |c_k+1 - c_k|
(Banach's fixed point theorem, L <= 1/2); and pieces stay within `slack` of c, where commands that
reach `beyond` their cell add 2 L of that, and the inverse is steeper than the model by at most
`stretch` = 1 / (1 - L), since |c' + E'(c) c'| >= (1 - L) |c'|.

The facts of the pass are turned round: a program of commands is taken for COMPENSATED when it is
read.
"""

from __future__ import annotations

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Flags, Floats, Ints
from gcxform_plugins.passes.volumetric.undo.machine import BEND_SLACK, UNDO_SLACK, Arm, Machine

Cuts = tuple[Ints, Floats]

STEPS = 40  # of the search for a command, each of which leaves less than half of what is off
FOUND = 1e-10  # mm; so near is near enough
ROUNDS = 12  # of the search for nodes; each leaves a small part of the way beyond one
SEAM = 1e-7  # mm; what a piece may be off because its commands reach a little beyond their cell
STEEPEST = 0.5  # mm/mm; `begin` refuses a model much earlier


class Commands(Machine):
    """The commands for a path of the machine."""

    beyond = 0.0  # mm; how far commands reach beyond the cell of their piece

    @property
    def stretch(self) -> float:
        """How much farther commands move than the machine, at most."""
        return 1.0 / (1.0 - min(self.lipschitz, STEEPEST))

    def moved(self, table: Floats, tool: Floats | None) -> Floats:
        """Return command minus place of the machine (n, 3), mm: c = q - E(c), step by step."""
        shift = np.zeros(table.shape)
        last = np.inf
        for _ in range(STEPS):
            before, shift = shift, -self.step.error(table + shift, tool)
            last = float(np.nanmax(np.abs(shift - before), initial=0.0))
            if last < FOUND:
                return shift
        raise gx.InputError.one(
            "GX309", f"the command for a place of the machine still moves by {last:.3g} mm"
        )

    def slack(self) -> float:
        """Return how far (mm) the pieces are from the curves they stand for.

        A piece of an arc may also leave the cell of its ends by as much as it is off its chord,
        which is so little that this adds less than the chord itself.
        """
        slack = 2.0 * UNDO_SLACK if self.path.has_arcs else 0.0
        if self.curved:
            slack += self.stretch * BEND_SLACK + slack
        bulge = BEND_SLACK if self.arm is not None else 0.0
        return slack + 2.0 * self.lipschitz * (self.beyond + self.stretch * bulge)

    def _crossings(self) -> Cuts:
        path = self.path
        plain = np.isin(path.form, gx.FREE)
        lines = (path.kind == gx.Kind.LINE) & path.starts_known & plain
        cuts: Cuts = np.empty(0, np.int64), np.empty(0)
        if path.has_arcs:
            bend = float(np.linalg.norm(self.curvature, 2)) * self.stretch**3
            nowhere = (np.empty(0), np.empty(0), np.empty(0))
            steep = self.lipschitz * self.stretch
            cuts = gx.arc_cuts(path, self.offset, nowhere, steep, bend, UNDO_SLACK)
        if self.arm is not None:
            cuts = self._swung(self.arm, np.flatnonzero(lines), *cuts)
            return self._at_nodes(np.flatnonzero(lines | path.is_arc), *cuts)
        cuts = self._at_nodes(np.flatnonzero(lines | path.is_arc), *cuts)
        return self._straight(lines, *cuts) if self.curvature.any() else cuts

    def _at_nodes(self, moves: Ints, row: Ints, part: Floats) -> Cuts:
        """Return the cuts of moves, and more until the commands of no piece cross a node."""
        for _ in range(ROUNDS):
            more_row, more_part, self.beyond = self._once(moves, row, part)
            if 2.0 * self.lipschitz * self.beyond <= SEAM:
                break
            row, part = np.append(row, more_row), np.append(part, more_part)
        return row, part

    def _once(self, moves: Ints, row: Ints, part: Floats) -> tuple[Ints, Floats, float]:
        """Return where the commands of pieces seem to cross nodes, and by how much (mm) at most."""
        row, begin, stop = _pieces(moves, row, part)
        a, b = self._command(row, begin), self._command(row, stop)
        rows, parts, farthest = [np.empty(0, np.int64)], [np.empty(0)], 0.0
        for axis, planes in enumerate(self.step.nodes()):
            for plane in planes:
                before, after = plane - a[:, axis], plane - b[:, axis]
                off = np.minimum(np.abs(before), np.abs(after))
                which = np.flatnonzero((before * after < 0) & (2.0 * self.lipschitz * off > SEAM))
                farthest = max(farthest, float(off[which].max(initial=0.0)))
                share = before[which] / (before[which] - after[which])
                rows.append(row[which])
                parts.append(begin[which] + share * (stop - begin)[which])
        return np.concatenate(rows), np.concatenate(parts), farthest

    def _straight(self, lines: Flags, row: Ints, part: Floats) -> Cuts:
        """Return the cuts, and more of lines where the error between two of them is curved."""
        mine = lines[row]
        of, begin, stop = _pieces(np.flatnonzero(lines), row[mine], part[mine])
        way = np.abs(self._command(of, stop) - self._command(of, begin))
        sag = np.einsum("ni,ij,nj->n", way, self.curvature, way) / 8.0
        of, more = _divided(of, begin, stop, sag)
        return np.append(row, of), np.append(part, more)

    def _swung(self, arm: Arm, lines: Ints, row: Ints, part: Floats) -> Cuts:
        """Return the cuts, and more of lines so that commands are straight between two of them.

        The command c for a point q is c = q - E(c, t), and so, with L of the error and a way T r of
        the tip, |c'| (1 - L) <= |q'| + a T r, and c is bent by what bends E along it, stretched.
        Commands of a piece then leave its chord by little, and its cell by no more than that.
        """
        way = np.abs(self.end[lines] - self.start[lines])
        swung = arm.angle * arm.turn[lines] * arm.long[lines]
        fast = (np.sqrt((way**2).sum(axis=1)) + swung) * self.stretch
        ways = way + (self.lipschitz * fast + swung)[:, None]
        sag = np.einsum("ni,ij,nj->n", ways, self.curvature, ways) / 8.0
        sag += arm.sag(lines, fast, np.ones(len(lines)))
        of, more = _divided(lines, np.zeros(len(lines)), np.ones(len(lines)), sag)
        return np.append(row, of), np.append(part, more)

    def _command(self, rows: Ints, part: Floats) -> Floats:
        """Return the commands (n, 3), in the table, for points of rows."""
        path = self.path
        start = path.start[rows, :3]
        point = start + part[:, None] * (path.end[rows, :3] - start)
        arcs = path.is_arc[rows]
        if arcs.any():
            point[arcs] = gx.points_on_arcs(path, rows[arcs], part[arcs])
        table = point + self.place.offset_of(rows)
        return table + self.moved(table, self.place.tool_of(rows, part))


def _divided(rows: Ints, begin: Floats, stop: Floats, sag: Floats) -> Cuts:
    """Return where pieces of rows, off their chords by `sag` (mm), are divided to be straight."""
    count = np.maximum(np.ceil(np.sqrt(np.nan_to_num(sag) / BEND_SLACK)), 1.0).astype(np.int64)
    every = np.repeat(np.arange(len(rows)), count - 1)
    nth = np.arange(len(every)) - np.repeat(np.cumsum(count - 1) - (count - 1), count - 1) + 1
    return rows[every], begin[every] + (stop - begin)[every] * nth / count[every]


def _pieces(moves: Ints, row: Ints, part: Floats) -> tuple[Ints, Floats, Floats]:
    """Return row, begin and stop of the pieces into which cuts divide moves."""
    rows = np.concatenate([row, moves])
    stop = np.append(part, np.ones(len(moves)))
    order = np.lexsort((stop, rows))
    rows, stop = rows[order], stop[order]
    begin = np.where(np.append(True, rows[1:] != rows[:-1]), 0.0, np.append(0.0, stop[:-1]))
    return rows, begin, stop
