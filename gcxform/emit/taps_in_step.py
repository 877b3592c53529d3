"""Taps in step with the spindle by another code: G33.1 for G84 and G74, a block for each hole.

A control whose G84 taps so goes down to R, in step to the depth and back to R, and in G98 on to the
level before. The moves between are plain ones; way in and way out are one block of the target: the
end of the thread, and K, the way for each turn. That is F by S, or F itself in G95. So speed and
sense of the spindle have to be those that the program says: nothing may have changed them unseen.

G33.1 does not wait at its end, and goes back at the speed of the way in.
"""

from __future__ import annotations

from typing import NoReturn

import numpy as np

from gcxform.diagnostics import InputError
from gcxform.dialect.codes import Effect
from gcxform.dialect.cycle_rule import DWELL, TAPPING
from gcxform.dialect.dialect import Dialect
from gcxform.emit.manner import Task
from gcxform.emit.positions import Positions
from gcxform.modal.meaning.tables import TAP
from gcxform.system.arrays import Flags, Floats
from gcxform.system.distinct import one_of
from gcxform.toolpath.path import Event, FeedMode, Form, Given

TURNING = {84: 1, 74: 2}
"""How the spindle has to turn in each cycle, by the number of its mode: M3, M4."""
BY_CAM = "let the CAM write the tap for this control"
SAME = 1e-6  # mm


class TapsInStep:
    """The taps of a window that are said so; none where the user does not say that they are.

    rows   (rows,) whether a move is the way in or the way out of such a tap
    out    (rows,) whether it is the way out, which the block of the way in makes as well
    pace   (rows,) mm for each turn, the K of its block
    code   (rows,) the number of the code that is written, -1 for other moves
    speeds (rows,) of the spindle, turns per minute; `speed`: after the window; nan: not known
    start  (rows, axes) where moves begin, mm;  mirrored: (live,) lines that move in a mirror image
    """

    def __init__(self, task: Task, speed: float) -> None:
        self.task, path = task, task.path
        self.rows = np.zeros(len(path), np.bool_)
        self.out = np.zeros(len(path), np.bool_)
        self.pace = np.full(len(path), np.nan)
        self.code = np.full(len(path), -1, np.int8)
        self.speed = speed
        self.speeds = np.full(len(path), np.nan)
        self.start, self.mirrored = path.start, mirrored_lines(task)
        self._find()

    def _find(self) -> None:
        """Find the taps. Raises InputError for those that cannot be said so."""
        task, path = self.task, self.task.path
        if not task.manner.saying.taps_in_step:
            return
        cycle = task.read.modes.cycle[path.block]
        self.rows = (path.form == Form.SYNCHRONISED) & one_of(cycle, sorted(TAPPING))
        self.out = every_other(self.rows)
        self.code[self.rows] = TAP
        self.speeds = self._speeds()
        for row in np.flatnonzero(self.rows & ~self.out).tolist():
            self.pace[row : row + 2] = self._pitch(row, float(self.speeds[row]))
        self._refuse_waits()

    def around(self) -> tuple[list[Given], list[Given]]:
        """Return the blocks that stand before and behind taps."""
        return [], []

    def words(self, positions: Positions) -> dict[str, Floats]:
        """Return the words of cycles by address (rows,), as whole numbers of the last decimal."""
        del positions
        return {}

    @property
    def lines(self) -> Flags:
        """The lines (live,) that have such a tap."""
        lines = np.zeros(self.task.read.live, np.bool_)
        lines[self.task.path.block[self.rows]] = True
        return lines

    def _speeds(self) -> Floats:
        """Return the speed in force at each row, and keep the one after the window."""
        path, found = self.task.path, np.full(len(self.task.path), np.nan)
        at = 0
        for event in path.events:
            found[at : event.row] = self.speed
            at = max(at, event.row)
            self.speed = speed_after(event, self.speed, self.task.manner.source)
        found[at:] = self.speed
        return found

    def _pitch(self, row: int, speed: float) -> float:
        """Return the way of a tap for each turn (mm). Raises InputError where that is not known."""
        path, line = self.task.path, int(self.task.path.block[row])
        code = int(self.task.read.modes.cycle[line])
        self._check_back(row, line, code)
        self._check_hand(line, code)
        feed = float(path.feed[row])
        if int(path.feed_mode[row]) == FeedMode.PER_TURN:
            return feed
        if not speed > 0 or not feed > 0 or int(path.feed_mode[row]) != FeedMode.PER_MINUTE:
            message = f"G{code} in step with a spindle whose speed, or the feed, is not known"
            self._refuse(line, message, "write S and F in the block before, in turns and G94")
        return feed / speed

    def _check_hand(self, line: int, code: int) -> None:
        """Refuse a tap for which the spindle is not told how to turn."""
        if int(self.task.read.modes.spindle[line]) != TURNING[code]:
            turning = f"M{2 + TURNING[code]}"
            message = f"G{code} in step with a spindle that is not known to turn by {turning}"
            self._refuse(line, message, f"write {turning} and S in a block before")

    def _check_back(self, row: int, line: int, code: int) -> None:
        """Refuse a tap that comes back to another place than it begins at, or is mirrored."""
        path, source = self.task.path, self.task.manner.source
        back = np.abs(path.end[row + 1] - self.start[row])
        if self.mirrored[line]:
            self._refuse(line, "a tap in a mirror image: its hand is not certain", BY_CAM)
        if not (back[:3] <= SAME).all():
            message = f"G{code} of {source.name} comes out to another level than it begins at"
            self._refuse(line, message, "write G99 in this block")

    def _refuse_waits(self) -> None:
        """Refuse taps that wait at their ground."""
        path = self.task.path
        for event in path.events:
            waits = event.within and event.what == DWELL and event.values[0][1] > 0
            if waits and self.rows[event.row - 1]:
                message = f"{self.task.manner.target.name} does not wait at the ground of a tap"
                hint = f"leave out P, if the tap need not wait there; else {BY_CAM}"
                self._refuse(event.line - path.blocks.first, message, hint)

    def _refuse(self, line: int, message: str, hint: str) -> NoReturn:
        raise InputError.one("GX501", message, self.task.location(line), hint)


def mirrored_lines(task: Task) -> Flags:
    """Return which lines (live,) of the program as read have moves in a mirror image."""
    path, found = task.read.path, np.zeros(task.read.live, np.bool_)
    matrices = (frame.matrix for frame in path.frames)
    mirrors = [m is not None and bool(np.linalg.det(np.array(m)) < 0) for m in matrices]
    found[path.block[np.array(mirrors, np.bool_)[path.frame]]] = True
    return found


def every_other(rows: Flags) -> Flags:
    """Return the second, fourth ... of each run of flags: ways out, where taps follow at once."""
    at = np.arange(len(rows))
    begins = np.maximum.accumulate(np.where(rows & ~np.append(False, rows[:-1]), at, 0))
    return np.asarray(rows & ((at - begins) % 2 == 1))


def speed_after(event: Event, speed: float, source: type[Dialect]) -> float:
    """Return the speed of the spindle (1/min) behind an event; nan where that is not known."""
    if event.what == "S":
        return event.values[0][1] if event.values else np.nan
    if event.what == "G96":
        return np.nan
    if event.what[0] == "M" and event.what[1:].isdigit():
        code = source.m_codes.get(int(event.what[1:]), source.block_rule.unknown_m)
        return np.nan if code is None or code.loses_position or code.barrier else speed
    known = source.codes.get(event.what)
    runs = known is not None and known.effect in (Effect.CALL, Effect.BARRIER)
    return np.nan if runs else speed
