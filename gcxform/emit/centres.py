"""The centre words of the arcs that are written anew, seen from where the control then stands."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from gcxform.catalogue.remedies import either, put_before
from gcxform.diagnostics import Diagnostic, InputError
from gcxform.dialect.dialect import Dialect
from gcxform.emit.arcs import ArcEnds, centre_words
from gcxform.emit.copying import Copying
from gcxform.emit.manner import Task
from gcxform.emit.positions import Positions
from gcxform.emit.same_rows import EXACT
from gcxform.system.arrays import Flags, Floats, Ints, Small
from gcxform.toolpath.angles import TURN
from gcxform.toolpath.path import FeedMode, Kind, Plane, Toolpath


class Centres:
    """Finds the centre words of one window."""

    def __init__(self, task: Task, kind: Small, positions: Positions, copying: Copying) -> None:
        self.task = task
        self.path = task.path
        self.kind = kind
        self.positions = positions
        self.copying = copying
        self.centre = np.zeros((len(self.path), 2))

    def write(self) -> Floats:
        """Return the centre words (rows, 2), as whole numbers of the last decimal.

        Words of full circles that would make them others are taken out of `positions.write`.
        """
        anew = ~self.copying.lines[self.path.block] & (self.kind >= Kind.ARC_CW)
        anew &= self.path.is_free
        if not anew.any():
            return self.centre
        start = self._starts()
        for plane in Plane:
            rows = np.flatnonzero(anew & (self.path.plane == plane))
            if len(rows):
                self._in_plane(plane, rows, start)
        return self.centre

    def _starts(self) -> Floats:
        """Return where rows start in the control (n, 3): off the grid after copied blocks.

        Like all geometry of arcs, in coordinates of the frames of the rows.
        """
        start = self.path.local(self.path.start[:, :3])
        if not self.path.refit_centres:
            return start
        before = self.positions.local(self.positions.before[:, :3])
        first = self.copying.believed_said | self.copying.believed_exact
        exact = np.vstack([first, self.copying.said_exactly()[:-1]])
        return np.where(exact, start, before)

    def _in_plane(self, plane: Plane, rows: Ints, start: Floats) -> None:
        manner = self.task.manner
        if plane.name not in manner.target.arc_rule.planes:
            message = f"{manner.target.name} has no arcs in {plane.name}"
            self._refuse(rows, "GX501", message, put_before("plane"))
        axes = np.array(plane.axes[:2])
        refit = self.path.refit_centres
        begin = start[np.ix_(rows, axes)]
        absolute = self.path.blocks.absolute_centre[self.path.block[rows]]
        inch = self.positions.inch[rows]
        letter = "IJK"[plane.axes[0]]
        arcs = ArcEnds(
            begin,
            self._ends(refit)[np.ix_(rows, axes)],
            self.path.local(self.path.centre)[np.ix_(rows, axes)],
            np.where(absolute[:, None], 0.0, begin),
            np.where(inch, manner.step(letter, True), manner.step(letter, False)),
            self.path.sweep[rows],
            np.where(self.path.mirrored[rows], -1.0, 1.0) * self.path.sense[rows],
            self._spiral(rows, axes),
            inch,
        )
        self.centre[rows], good = centre_words(arcs, manner.target.arc_rule, refit)
        good |= self._full_circles(rows, axes, begin, refit)
        if refit and not good.all():
            message = f"rounded, this arc is another one, or one that {manner.target.name} refuses"
            hint = either("give more decimals", put_before("segment", options="chord-error=2um"))
            self._refuse(rows[~good], "GX504", message, hint)

    def _ends(self, refit: bool) -> Floats:
        """Return where rows end (n, 3): as formatted, or exactly."""
        if refit:
            return self.positions.local(self.positions.held[:, :3])
        return self.path.local(self.path.end[:, :3])

    def _full_circles(self, rows: Ints, axes: Ints, begin: Floats, refit: bool) -> Flags:
        """Settle the end words of full circles; return which of them are good for that.

        The end is written where it is the start to the letter, as every control reads it. A start
        off the grid, in a block that was copied, cannot be written: the words are left out.
        """
        full = np.mod(self.path.sweep[rows] + 1e-9, TURN) < 2e-9
        said = np.full((len(self.path), 3), np.nan)
        for axis in axes.tolist():
            said[rows, axis] = self.positions.said(axis, rows)
        said = self.positions.local(said)[np.ix_(rows, axes)]
        on_grid = (np.abs(said - begin) < EXACT).all(axis=1)
        silent = full & ~on_grid & refit
        # LinuxCNC counts a circle that closes but for the last bit as no way at all in G93.
        silent |= full & (self.path.feed_mode[rows] == FeedMode.INVERSE_TIME)
        rule = self.task.manner.target.arc_rule
        silent = full & (rule.circle == "none") | silent & (rule.circle != "some")
        for axis in axes.tolist():
            self.positions.write[rows[full], axis] = True
            self.positions.write[rows[silent], axis] = False
        return np.asarray(silent)

    def _spiral(self, rows: Ints, axes: Ints) -> Floats:
        """Return by how much (mm) the radii of arcs at start and end differ before rounding."""
        centre = self.path.centre[np.ix_(rows, axes)]
        first = self.path.start[np.ix_(rows, axes)] - centre
        last = self.path.end[np.ix_(rows, axes)] - centre
        return np.asarray(np.abs(np.hypot(*first.T) - np.hypot(*last.T)))

    def _refuse(self, rows: Ints, code: str, message: str, hint: str) -> None:
        lines = self.path.block[rows[:20]].tolist()
        raise InputError(
            tuple(Diagnostic(code, message, self.task.location(line), hint) for line in lines)
        )


def in_words_of(target: type[Dialect], path: Toolpath) -> Toolpath:
    """Return the path written without absolute arc centres if the target has none."""
    if "G90.1" in target.codes or not path.blocks.absolute_centre.any():
        return path
    never = np.zeros(len(path.blocks.absolute_centre), np.bool_)
    return path.replace(blocks=replace(path.blocks, absolute_centre=never))
