"""Taps whose ends have moved: the words that say where their cycles go now.

A tapping cycle stays a cycle, for only so its feed is tied to the spindle. It goes straight along
the drilling axis: one place in the plane stands for the top of the thread, at R, and for its
bottom. It is put in the middle between where these two shall be, and R and depth are said exactly.
Every tap gets words of its own, because those in force may be other ones now. How high the tool is
between taps has no word: that is settled by the move before the first of them.

A tap of one move (G33.1) is written anew like a thread: its end has words.

Half of what top and bottom are apart in the plane has to be within what the passes promise. The
taps behind one that has moved get words as well, down to repeats in G91. The proof lets the level
between taps be off by up to 0.1 mm (`between_taps`), the certificate says by how much, and no feed
move may begin there. A tap always has its move down to R, also where it leads nowhere, so that with
R a little elsewhere it has as many.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NoReturn

import numpy as np

from gcxform.diagnostics import InputError
from gcxform.emit.manner import Believed, Task
from gcxform.emit.numbers import quantise
from gcxform.emit.positions import Positions
from gcxform.modal.meaning.tables import TAP
from gcxform.modal.state import CYCLE_OFF
from gcxform.system.arrays import Flags, Floats
from gcxform.toolpath.facts import IN_AIR
from gcxform.toolpath.path import Form, Kind, Plane
from gcxform.values import dataclass

EXACT = 1e-9  # mm; closer values are the same number
ROOM = 0.99  # of what the passes promise: undoing them may stretch what is off
WORDS = "XYZR"
MOVES_TO_R = 2  # over the hole, and down to R


@dataclass(frozen=True, slots=True)
class _Hole:
    """One tap: its first row, how many moves there are to R, and where the pass wants its ends.

    These are its top, at R, and its bottom (axes,).
    """

    row: int
    moves: int
    top: Floats
    bottom: Floats


class Taps:
    """Finds the taps of a window that have moved, and the words of their blocks.

    lines   (live,) whether a line is written anew
    count   (live,) as how many blocks
    words   by address (rows,): the numbers to be written, as whole numbers of the last decimal, in
            the first row of each block
    rows    (blocks,) the first row of each block that is written anew
    aside   mm; how far off the control stands after the window, if a tap is its last move
    level   in words: the level from which the cycle in force after the window has begun; nan: none

    Those `in_step` (rows,) are said by another code, and are none of these.
    """

    def __init__(
        self, task: Task, positions: Positions, believed: Believed, in_step: Flags
    ) -> None:
        self.task, self.positions = task, positions
        self.path, self.original = task.path, task.read.path
        live = task.read.live
        self.lines = np.zeros(live, np.bool_)
        self.count = np.ones(live, np.int64)
        self.words: dict[str, Floats] = {}
        self.rows = np.empty(0, np.int64)
        self.level, self.moved, self.aside = np.nan, False, believed.aside
        self._check_start(0)
        self.active = task.read.modes.cycle[:live] != CYCLE_OFF
        tied = (self.path.form == Form.SYNCHRONISED) & ~in_step
        if not tied.any() and not self.active[-1:].any():
            return
        self.row = np.searchsorted(self.path.block, np.arange(live + 1))
        self.tied = np.zeros(live, np.bool_)
        self.tied[self.path.block[tied]] = True
        single = self.tied & (task.read.modes.motion == TAP) & ~self.active
        self._follow(self._changed(), single, believed)

    def _changed(self) -> Flags:
        """Return the lines with tied rows that end elsewhere than in the source, or say so."""
        changed = np.zeros(len(self.lines), np.bool_)
        for line in np.flatnonzero(self.tied).tolist():
            now, was = self._rows(line), self._source_rows(line)
            if now.stop - now.start != was.stop - was.start:
                continue
            off = np.abs(self.path.end[now] - self.original.end[was]) > EXACT
            if self.path.frames != self.original.frames and not self._in_steps(line):
                off |= np.abs(self.positions.end[now] - self.original.words[was]) > EXACT
            changed[line] = off.any()
        return changed

    def _rows(self, line: int) -> slice:
        return slice(int(self.row[line]), int(self.row[line + 1]))

    def _source_rows(self, line: int) -> slice:
        first, last = np.searchsorted(self.original.block, [line, line + 1]).tolist()
        return slice(first, last)

    def _in_steps(self, line: int) -> bool:
        return bool(self.path.blocks.incremental[line])

    # --- in order: each tap begins where the one before ends ---

    def _follow(self, changed: Flags, single: Flags, believed: Believed) -> None:
        """Find the words of the taps that have moved, and of those that follow them."""
        for address in WORDS:
            self.words[address] = np.zeros(len(self.path))
        calls = np.flatnonzero(self.active & self.task.table.flag("drills", self.task.shape))
        pattern = np.cumsum(~self.active)
        last = -1
        going_on = 0 if believed.level == believed.level else -1
        self.level, self.moved = believed.level, believed.tapping
        for line in sorted({*calls.tolist(), *np.flatnonzero(changed & single).tolist()}):
            if single[line]:
                self._single(line)
                continue
            if pattern[line] not in (last, going_on):
                axis = Plane(int(self.task.read.modes.plane[line])).axes[2]
                self.level, self.moved = float(self._standing(int(self.row[line]))[axis]), False
            last, going_on = int(pattern[line]), -1
            self.moved |= bool(changed[line])
            if self.moved and self.row[line + 1] > self.row[line]:
                self._cycle(line)
        if not self.active[-1:].any():
            self.level, self.moved = np.nan, False
        if self.lines.any():
            self.positions.look_again()

    def _standing(self, row: int) -> Floats:
        """Return where the control stands before a row (axes,), in words of its frame."""
        path = self.path
        if not len(path):
            return self.positions.entry
        if row == 0:
            return np.array(self.positions.before[0])
        place = self.positions.held[row - 1][None, :]
        if row == len(path):
            return np.asarray(place[0])
        if path.frame[row] != path.frame[row - 1]:
            place = path.frames[int(path.frame[row - 1])].positions(place)
            place = path.frames[int(path.frame[row])].words(place)
        lost = int(path.lost[row])
        gone = [bool(lost >> axis & 1) for axis in range(len(path.axes))]
        return np.where(gone, np.nan, place[0])

    def _begin(self, row: int) -> None:
        """Note the first row of a block that is written anew."""
        self.rows = np.append(self.rows, row)

    # --- one block ---

    def _single(self, line: int) -> None:
        """Let a tap of one move be written with the words of its end, if it comes back."""
        rows = self._rows(line)
        back = self.positions.held[rows.stop - 1] - self._standing(rows.start)
        other = self.path.blocks.inch[line] != self.original.blocks.inch[line]  # K stays as it is
        off = np.nanmax(np.abs(back), initial=0.0) > EXACT
        if self.task.manner.crossing or other or off:
            return
        self.lines[line] = True
        self._begin(rows.start)

    def _cycle(self, line: int) -> None:
        """Find the words of a block that calls a cycle, one after another for its holes."""
        rows = self._rows(line)
        self._check(line, rows)
        holes = list(self._holes(rows))
        standing = self._standing(rows.start)
        if not self._in_steps(line):
            apart = max(np.abs(hole.bottom - holes[0].bottom).max() for hole in holes)
            if apart > EXACT:
                self._refuse(line, "repeats of one tap would have to go to several places")
            holes = holes[:1]
        elif len(holes) > 1 and holes[0].moves > MOVES_TO_R:
            self._refuse(line, "repeats of a tap that rises to R would rise in blocks of their own")
        elif not _same(holes[-1].bottom[3:], holes[0].bottom[3:]):
            self._refuse(line, "repeats of a tap that turn axes would be blocks of their own")
        self.lines[line], self.count[line] = True, len(holes)
        for hole in holes:
            self._begin(hole.row)
            standing = self._hole(line, hole, standing)
        self.positions.held[rows] = standing
        self._end(line, rows.stop, standing)

    def _check(self, line: int, rows: slice) -> None:
        """Refuse a cycle that cannot be written with other words."""
        was = self._source_rows(line)
        path, original = self.path, self.original
        frames = {path.frames[number] for number in path.frame[rows].tolist()}
        before = {original.frames[number] for number in original.frame[was].tolist()}
        same = rows.stop - rows.start == was.stop - was.start
        same = same and bool((path.form[rows] == original.form[was]).all())
        if not same or not self.tied[line]:
            self._refuse(line, "a canned cycle beside a tap that moves cannot be written anew")
        if self.task.manner.crossing or path.blocks.inch[line] != original.blocks.inch[line]:
            self._refuse(line, "a tap would have to be written in another dialect or unit")
        plain = all(frame.shifts_only and not frame.polar for frame in frames | before)
        if not plain or len(frames) > 1:
            self._refuse(line, "a tap in turned, scaled or mirrored coordinates")
        if not _same(path.end[rows, 3:], original.end[was, 3:]):
            self._refuse(line, "a tap would have to turn rotary axes")
        self._check_place(line)

    def _check_place(self, line: int) -> None:
        """Refuse a tap that may be none: words of its own would make it one."""
        rule = self.task.manner.source.cycle_rule
        first, second, _ = ("XYZ"[k] for k in Plane(int(self.task.read.modes.plane[line])).axes)
        words = self.task.table.meanings[int(self.task.shape[line])].slots
        if rule is None or not self.task.manner.open_place or first in words or second in words:
            return
        message = f"a tap without {first} and {second} that moves: a setting decides if it drills"
        self._refuse(line, message, rule.hint_without_place(first, second))

    def _holes(self, rows: slice) -> Iterator[_Hole]:
        """Yield the taps of a block. Before the way in there is always a move down to R."""
        tied = self.path.form[rows] == Form.SYNCHRONISED
        ways_in = rows.start + np.flatnonzero(tied & ~np.append(False, tied[:-1]))
        for number, row in enumerate(ways_in.tolist()):
            first = row - MOVES_TO_R if number else rows.start
            yield _Hole(first, row - first, self.positions.end[row - 1], self.positions.end[row])

    def _hole(self, line: int, hole: _Hole, standing: Floats) -> Floats:
        """Set the words of a tap; return where the control stands after it (axes,)."""
        axes = Plane(int(self.task.read.modes.plane[line])).axes
        place, normal = list(axes[:2]), axes[2]
        goal = np.array(hole.bottom)
        goal[place] = (hole.top[place] + hole.bottom[place]) / 2
        clearance = self._clearance(line, hole, float(standing[normal]), normal)
        beside = np.sqrt(((hole.top - goal)[place] ** 2).sum())
        self._check_fits(line, float(np.hypot(beside, clearance - hole.top[normal])))
        said = [self._rounded(line, "XYZ"[axis], float(goal[axis])) for axis in range(3)]
        rest = self._rounded(line, "R", clearance)
        after = np.array(standing)
        after[place] = [said[axis] for axis in place]
        after[3:] = hole.bottom[3:]
        retracts = self.task.read.modes.retract[line] == 1
        after[normal] = max(self.level, rest) if retracts else rest
        from_here = [standing[axis] for axis in range(3)]
        from_here[normal] = rest
        for axis in range(3):
            self._say(line, hole.row, "XYZ"[axis], said[axis], float(from_here[axis]))
        self._say(line, hole.row, "R", rest, self.level)
        return after

    def _clearance(self, line: int, hole: _Hole, standing: float, normal: int) -> float:
        """Return the R level: on that side of two other levels on which it was.

        If the cycle begins below R, a control rises before it goes to the hole, or refuses it. In
        G98 LinuxCNC goes there at the initial level if the tool stands at R or below.
        """
        top, step = float(hole.top[normal]), self._step(line, "R")
        if hole.moves > MOVES_TO_R:
            return max(top, self.level + step)
        rule = self.task.manner.source.cycle_rule
        if rule is not None and rule.rises_first and self.task.read.modes.retract[line] == 1:
            was = hole.row - self._rows(line).start + self._source_rows(line).start
            at_r = was + hole.moves - 1
            high = self.original.start[was, normal] - self.original.end[at_r, normal]
            top = min(top, standing - step) if high > EXACT else max(top, standing)
        return min(top, self.level)

    def _rounded(self, line: int, address: str, value: float) -> float:
        """Return a length as it can be written."""
        step = self._step(line, address)
        return float(quantise(np.array([value / step]), 0)[0]) * step

    def _step(self, line: int, address: str) -> float:
        return self.task.manner.step(address, bool(self.path.blocks.inch[line]))

    def _say(self, line: int, row: int, address: str, value: float, before: float) -> None:
        """Set a word of a row; `before` is what it counts from in G91."""
        if self._in_steps(line):
            value -= before
        if np.isnan(value):
            self._refuse(line, f"{address} of a tap that moves is not known")
        self.words[address][row] = np.rint(value / self._step(line, address))

    # --- what does not fit ---

    def _check_fits(self, line: int, off: float) -> None:
        """Refuse a tap whose top and bottom would be too far from where they shall be (mm)."""
        if off <= self._allowed:
            return
        self._refuse(
            line,
            f"a tap goes straight along its axis, and would be {off * 1000:.3f} um off at its ends:"
            f" the passes promise {self.task.manner.promised * 1000:g} um",
            "give the pass a larger tolerance",
        )

    def _end(self, line: int, row: int, standing: Floats) -> None:
        """Note how far off (mm) the control stands before a row, after a tap."""
        self.aside = float(np.abs(standing - self.positions.end[row - 1])[:3].max())
        if self.aside > IN_AIR:
            message = f"between taps the tool would be {self.aside:.3f} mm from where it shall be"
            self._refuse(line, message)
        self._check_start(row)

    def _check_start(self, row: int) -> None:
        """Refuse a feed move from where a tap has ended too far off; a rapid makes up for it."""
        if row == len(self.path):
            return
        if self.path.kind[row] != Kind.RAPID and self.aside > self._allowed:
            message = f"a feed move begins where a tap has ended, {self.aside * 1000:.3f} um off"
            self._refuse(int(self.path.block[row]), message, "put a rapid between them")
        self.aside = 0.0

    @property
    def _allowed(self) -> float:
        """How far a tap may be off (mm)."""
        return max(ROOM * self.task.manner.promised, EXACT)

    def _refuse(self, line: int, message: str, hint: str = "leave it without the pass") -> NoReturn:
        raise InputError.one("GX506", message, self.task.location(line), hint)


def _same(one: Floats, other: Floats) -> bool:
    return bool(((np.abs(one - other) <= EXACT) | (np.isnan(one) & np.isnan(other))).all())
