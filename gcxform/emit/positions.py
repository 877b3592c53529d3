"""Formatted positions: what the control believes after each row, and the words that takes."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from gcxform.dialect.dialect import LINEAR
from gcxform.emit.manner import Believed, Task
from gcxform.emit.numbers import quantise
from gcxform.modal.columns import fill
from gcxform.system.arrays import Flags, Floats, Ints, Small
from gcxform.toolpath.columns import column_major
from gcxform.toolpath.path import Form, Kind, Toolpath
from gcxform.toolpath.still_axes import SAME_PLACE, turns_only


class Positions:
    """What is formatted, per row and axis, in column-major arrays (rows, axes).

    end         where the row shall end, in the frame of the row
    held        what the control believes after the row, mm or degrees, in the frame of the row
    before      what it believes before it, in the frame of the row
    after       what it believes after it, as a position
    step        (rows,) per axis: the last decimal, mm or degrees
    programmed  whether the source line names the axis
    write       whether the axis word is written
    """

    def __init__(self, task: Task, believed: Believed) -> None:
        self.task = task
        self.believed = believed
        path = task.path
        rows, axes = len(path), len(path.axes)
        self.end = path.words
        self.entry = believed.position
        if rows and not path.plainly_framed:
            self.entry = path.frames[int(path.frame[0])].words(believed.position[None, :])[0]
        self.inch = path.blocks.inch[path.block]
        self.held = column_major(rows, axes)
        self._mixed = bool(path.blocks.inch.any()) and not path.blocks.inch.all()
        self._mixed |= bool(path.blocks.inch[:1].any()) != bool(believed.inch)
        self._mixed |= self._off_grid()
        self._turning = turns_only(path) & (path.kind == Kind.LINE) & (path.form == Form.PLAIN)
        self._turning[1:] &= path.frame[1:] == path.frame[:-1]  # words are those of a frame
        self.step: list[Floats | float] = []
        self.programmed = np.empty((axes, rows), np.bool_).T
        self.write = np.empty((axes, rows), np.bool_).T
        self.stays = np.empty((axes, rows), np.bool_).T
        for column, axis in enumerate(path.axes):
            slot = task.table.slots[task.shape, ord(axis) - 65]
            self.programmed[:, column] = (slot >= 0)[path.block]
            self._round(column, axis)
        self.after, self.before = self._looking_back()
        for column in range(axes):
            self._choose(column)

    def _round(self, column: int, axis: str) -> None:
        """Find what the control believes of one axis before and after each row."""
        manner = self.task.manner
        end = self.end[:, column]
        decimals = manner.decimals_of(axis, False)
        if axis in LINEAR and self.inch.any():
            step = np.where(self.inch, manner.step(axis, True), manner.step(axis, False))
            held = quantise(end / step, 0) * step
            self.step.append(step)
        else:
            held = quantise(end, decimals) / 10.0**decimals
            self.step.append(manner.step(axis, False))
        if manner.words == "programmed":
            held = fill(held, self.programmed[:, column], self.entry[column])
        stays = self._stays(column, held)
        self.stays[:, column] = stays
        if stays.any():
            held = fill(held, ~stays, self.entry[column])
        self.held[:, column] = held

    def look_again(self) -> None:
        """Take over what has been changed in `held`."""
        self.after, self.before = self._looking_back()
        for column in range(len(self.task.path.axes)):
            self._choose(column)

    def _looking_back(self) -> tuple[Floats, Floats]:
        """Return what the control believes after each row, and before it in the row's frame."""
        path = self.task.path
        after, before = path.from_frames(self.held), column_major(*self.held.shape)
        before[1:] = after[:-1]
        before[:1] = self.believed.position
        path.with_lost(before)
        return after, before if path.plainly_framed else path.in_frames(before)

    def _choose(self, column: int) -> None:
        """Decide which words of an axis are needed: those that change or were programmed."""
        words = self.task.manner.words
        held, programmed = self.held[:, column], self.programmed[:, column]
        known = ~np.isnan(held)
        if words == "programmed":
            self.write[:, column] = programmed & known & ~self.stays[:, column]
        elif words == "all":
            beside = (self.task.path.form == Form.SYNCHRONISED) & (column > 2)  # X, Y, Z alone tap
            self.write[:, column] = known & ~self.stays[:, column] & ~beside
        else:
            moved = ~(np.abs(held - self.before[:, column]) < 0.5 * self.step[column])
            said = programmed & self.last & ((self.task.path.nth == 0) | self._homed)
            self.write[:, column] = (moved | said) & known & ~self.stays[:, column]

    @cached_property
    def _homed(self) -> Flags:
        """Rows that go home as moves in the machine, where the axes may stand already."""
        path, homed = self.task.path, list(self.task.read.homed)
        if not homed:
            return np.zeros(len(path), np.bool_)
        return np.asarray(np.isin(path.block, homed) & (path.form == Form.PLAIN))

    def _off_grid(self) -> bool:
        """Whether the control stands at a place that cannot be written in the present unit."""
        inch = bool(self.inch.any())
        for axis, place in zip(self.task.path.axes, self.entry, strict=True):
            step = self.task.manner.step(axis, inch)
            if abs(np.rint(place / step) * step - place) > SAME_PLACE:
                return True
        return False

    def _stays(self, column: int, held: Floats) -> Flags:
        """Return the rows in which an axis stands still that the source line does not name.

        Where the program changes its unit, such an axis may be off by the rounding in the unit
        before; it stays there, because to write it would make it move. Where rotary axes turn alone
        no linear axis is written: one that moved by a rounding would take over the feed.
        """
        path, manner = self.task.path, self.task.manner
        axis = path.axes[column]
        alone = self._turning if axis in LINEAR else np.zeros(len(path), np.bool_)
        if not self._mixed or not len(path) or any(frame.polar for frame in path.frames):
            return alone
        begins = path.start if path.plainly_framed else path.in_frames(path.start)
        still = np.abs(self.end[:, column] - begins[:, column]) < SAME_PLACE
        still[1:] &= path.frame[1:] == path.frame[:-1]  # words are those of a frame
        both = 0.505 * (manner.step(axis, False) + manner.step(axis, True))
        still[0] &= abs(held[0] - self.entry[column]) < both
        return np.asarray(still & ~self.programmed[:, column]) | alone

    def local(self, words: Floats) -> Floats:
        """Return words (rows, 3) as coordinates: half of what is written as a diameter."""
        path = self.task.path
        halved = np.array([frame.diameter for frame in path.frames], np.bool_)
        if not halved.any():
            return words
        return np.where(halved[path.frame][:, None], words * (0.5, 1.0, 1.0), words)

    @property
    def last(self) -> Flags:
        """Rows that are the last of their block."""
        block = self.task.path.block
        return np.append(block[1:] != block[:-1], True)[: len(block)]

    def said(self, column: int, rows: Ints) -> Floats:
        """Return where an axis would be (mm, deg) in rows if its word were written."""
        step = self.step[column]
        if isinstance(step, np.ndarray):
            step = step[rows]
        incremental = self._steps(column, rows)
        before = np.where(incremental, self.before[rows, column], 0.0)
        return np.asarray(before + self.words_of(column, rows) * step)

    def _steps(self, column: int, rows: Ints) -> Flags:
        """Return in which rows the words of an axis are distances."""
        return np.asarray(self.task.path.steps[rows, column])

    def words_of(self, column: int, rows: Ints) -> Floats:
        """Return the numbers to be written, as whole numbers of the last decimal."""
        step = self.step[column]
        if isinstance(step, np.ndarray):
            step = step[rows]
        value = self.held[rows, column]
        incremental = self._steps(column, rows)
        if incremental.any():
            value = np.where(incremental, value - self.before[rows, column], value)
        return np.asarray(np.rint(value / step))


def motion_kinds(task: Task, positions: Positions) -> Small:
    """Return the kinds of the rows as they are written.

    An arc whose ends are one point after rounding would be read as a full circle: it becomes a
    line, unless it goes round.
    """
    path = task.path
    kind = path.kind.copy()
    arcs = np.flatnonzero(path.is_arc & path.is_free)
    if not len(arcs):
        return as_written(path, kind)
    chord = np.abs(positions.held[arcs, :3] - positions.before[arcs, :3])
    radius = np.nan_to_num(path.centre[arcs] - path.end[arcs, :3])
    length = path.sweep[arcs] * np.sqrt((radius**2).sum(axis=1))
    first_step = positions.step[0]
    step = first_step[arcs] if isinstance(first_step, np.ndarray) else first_step
    same = np.nan_to_num(chord).max(axis=1) < 1e-9
    kind[arcs[same & (length < 4 * step) & (path.sweep[arcs] < np.pi)]] = 1
    return as_written(path, kind)


def as_written(path: Toolpath, kind: Small) -> Small:
    """Return the kinds of rows as a program says them: in a mirrored frame G2 cuts what G3 does."""
    if path.plainly_framed:
        return kind
    return np.where(path.mirrored & (kind >= Kind.ARC_CW), 5 - kind, kind).astype(np.int8)
