"""Taps in step with the spindle as cycles: G84 and G74 for G33.1, where a control has not that.

Such a cycle goes from where the tool stands, which is its level of R, to the depth and back: G84 as
M3 turns, G74 as M4. Its feed is K by S, or K itself in G95. Before it M29 makes it rigid, on
controls that have that, and G80 stands behind it.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gcxform.dialect.code_translation import RIGID
from gcxform.emit.manner import Task
from gcxform.emit.positions import Positions
from gcxform.emit.taps_in_step import BY_CAM, SAME, TapsInStep, every_other
from gcxform.modal.meaning.tables import TAP
from gcxform.modal.state import CYCLE_OFF
from gcxform.system.arrays import Floats
from gcxform.toolpath.path import FeedMode, Form, Given, Plane

OF_SENSE = {1: 84, 2: 74}
"""The cycle for how the spindle turns, by the number of its mode: M3, M4."""
WORDS = "XYZR"


class TapsAsCycles(TapsInStep):
    """The taps of a window that are cycles; `pace` is the F of each, mm/min, or mm in G95."""

    def _find(self) -> None:
        task, path = self.task, self.task.path
        tap = (task.read.modes.motion == TAP) & (task.read.modes.cycle == CYCLE_OFF)
        self.rows = (path.form == Form.SYNCHRONISED) & tap[path.block]
        self.out = every_other(self.rows)
        self.speeds = self._speeds()
        for row in np.flatnonzero(self.rows & ~self.out).tolist():
            self._check(row)
            both = slice(row, row + 2)
            self.code[both] = OF_SENSE[int(task.read.modes.spindle[path.block[row]])]
            per_turn = path.blocks.feed_mode[path.block[row]] == FeedMode.PER_TURN
            self.pace[both] = path.feed[row] * (1.0 if per_turn else self.speeds[row])

    def _check(self, row: int) -> None:
        """Refuse a tap that no cycle goes like. Raises InputError."""
        path, line = self.task.path, int(self.task.path.block[row])
        normal = Plane(int(path.plane[row])).axes[2]
        way = path.end[row] - self.start[row]
        aside = np.delete(way, normal)
        frame = path.frames[int(path.frame[row])]
        if not frame.shifts_only or frame.polar:
            self._refuse(line, "a tap in coordinates that are turned or mirrored", BY_CAM)
        if not way[normal] < 0 or np.abs(aside[~np.isnan(aside)]).max(initial=0.0) > 0:
            self._refuse(line, "a tap upwards, aside, or from where that is not known", ABSOLUTE)
        if not (np.abs(path.end[row + 1] - self.start[row])[:3] <= SAME).all():
            self._refuse(line, "a tap that does not come back to where it begins", BY_CAM)
        if path.blocks.incremental[line]:
            self._refuse(line, "a tap by steps would be a cycle whose R is one", ABSOLUTE)
        if path.blocks.feed_mode[line] == FeedMode.INVERSE_TIME or not self.speeds[row] > 0:
            message = "a tap whose feed is K by S, and S is not known, or G93 in force"
            self._refuse(line, message, "write S, and G94, in a block before")

    def around(self) -> tuple[list[Given], list[Given]]:
        """Return M29 before taps, and G80 behind them."""
        path, target = self.task.path, self.task.manner.target
        rigid = [f"M{n}" for n, code in target.m_codes.items() if code.group == RIGID]
        into = np.flatnonzero(self.rows & ~self.out).tolist()
        lines = (path.block + path.blocks.first).tolist()
        opens = [Given(row, _rigid(rigid, float(self.speeds[row])), lines[row]) for row in into]
        closes = [Given(row + 2, "G80", lines[row]) for row in into]
        return opens if rigid else [], closes

    def words(self, positions: Positions) -> dict[str, Floats]:
        """Return X, Y, Z and R of each cycle (rows,), as whole numbers of the last decimal."""
        path = self.task.path
        every, rows = np.arange(len(path)), np.flatnonzero(self.rows)
        found = {axis: positions.words_of(k, every) for k, axis in enumerate("XYZ")}
        found["R"] = np.zeros(len(path))
        for row in rows.tolist():
            normal, inch = Plane(int(path.plane[row])).axes[2], bool(positions.inch[row])
            step = self.task.manner.step("R", inch)
            found["R"][row] = np.rint(positions.before[row, normal] / step)
            if np.isnan([found[each][row] for each in WORDS]).any():
                self._refuse(int(path.block[row]), "a tap from where it is not known", ABSOLUTE)
        return found


ABSOLUTE = "say where it is in a block before: G90, with X, Y and Z"


def _rigid(codes: Sequence[str], speed: float) -> str:
    return f"{codes[0]} S{np.format_float_positional(speed, trim='-')}" if codes else ""


def taps_of(task: Task, speed: float) -> TapsInStep:
    """Return the taps of a window that are said by another code; `speed`: of the spindle before."""
    kind = TapsAsCycles if task.manner.saying.taps_as_cycles else TapsInStep
    return kind(task, speed)
