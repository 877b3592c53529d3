"""Moves of a window: which lines move, from where to where, and at what feed."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from gcxform.dialect import INCH, LINEAR
from gcxform.modal.arcs import ArcWords, resolve_arcs
from gcxform.modal.cutter import compensation, refuse_ends
from gcxform.modal.events import events_of
from gcxform.modal.findings import Findings
from gcxform.modal.lines import LENGTHS, Lines, fill
from gcxform.modal.state import Modes
from gcxform.modal.tables import NUMBER
from gcxform.toolpath.path import Blocks, Form, Kind, Toolpath, column_major, constant

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Small = NDArray[np.int8]
Flags = NDArray[np.bool_]

SAME_PLACE = 1e-7  # mm, deg; an axis that moves by less stands still


class Moves:
    """Turns the lines of a window into rows; `state.position` is left where the window ends."""

    def __init__(self, lines: Lines, modes: Modes, axes: str) -> None:
        self.lines = lines
        self.modes = modes
        self.axes = axes
        self.dialect = lines.dialect
        self.state = lines.state
        self.findings = lines.findings
        self.entry = lines.state.position.copy()
        self.side, self.radius = compensation(lines, modes)

    def path(self) -> Toolpath:
        """Return the moves as a toolpath."""
        rows = self._rows()
        return self._path(rows, self._positions(rows))

    def _rows(self) -> Ints:
        """Return the lines that move, after looking at what they may not be."""
        moves = self.lines.flag("moves")
        centre = self.lines.flag("has_centre")
        arc = (self.modes.motion == 2) | (self.modes.motion == 3)
        for line in np.flatnonzero(moves & (self.modes.motion == NUMBER["G80"])).tolist():
            self.findings.add(
                line,
                "GX209",
                "axis words, but no motion code is in force",
                hint="write G0 or G1 in this block",
            )
        for line in np.flatnonzero(centre & ~arc).tolist():
            self.findings.add(line, "GX203", "I, J, K and R belong to arcs, and this is none")
        for line in np.flatnonzero(centre & arc & self._dwells()).tolist():
            message = "a dwell and an arc: the control takes some words for both"
            self.findings.add(line, "GX203", message, hint="write the dwell in a block of its own")
        moves &= self.modes.motion != NUMBER["G80"]
        rows = np.flatnonzero(moves | (centre & arc))
        self._check_feed(rows)
        return rows

    def _dwells(self) -> Flags:
        """Return the lines with a dwell that takes a word which arcs take as well."""
        if self.dialect.turns_address not in self.dialect.dwell:
            return np.zeros(self.lines.live, np.bool_)
        dwell = np.array([meaning.dwell for meaning in self.lines.table.meanings], np.bool_)
        return np.asarray(dwell[self.lines.shape])

    def _check_feed(self, rows: Ints) -> None:
        """Refuse feed moves without a feed, and blocks in inverse time without a feed word."""
        feeding = rows[self.modes.motion[rows] != Kind.RAPID]
        feed = self.modes.feed[feeding]
        missing = feeding[~(feed > 0)]
        inverse = feeding[self.modes.feed_mode[feeding] == NUMBER["G93"]]
        word = self.lines.word("F")
        if len(inverse):
            none = inverse if word is None else inverse[~word[1][inverse]]
            missing = np.union1d(missing, none)
        for line in missing[: Findings.enough].tolist():
            self.findings.add(
                line,
                "GX204",
                "a feed move, but no feed is in force",
                hint="write an F word; in G93 every feed block needs one",
            )

    def _positions(self, rows: Ints) -> Floats:
        """Return the ends of the moves; the state's position becomes that after the window."""
        lost = self.lines.flag("loses_position")
        self.lost = lost = lost | self._other_frame()
        any_lost = bool(lost.any())
        ends = column_major(len(rows), len(self.axes))
        for column, axis in enumerate(self.axes):
            position = self._axis(axis, column, lost if any_lost else None)
            ends[:, column] = position[rows] if isinstance(position, np.ndarray) else position
            if self.lines.live:
                last = position[-1] if isinstance(position, np.ndarray) else position
                self.state.position[column] = last
        return ends

    def _other_frame(self) -> Flags:
        """Return the lines from which on positions count from another, unknown origin."""
        frame = np.append(self.state.groups["frame"], self.modes.frame)
        other = frame[1:] != frame[:-1]
        stated = self.lines.stated("frame")
        if not self.state.frame_known and stated.any():
            other[int(np.argmax(stated))] = True
            self.state.frame_known = True
        return np.asarray(other)

    def _axis(self, axis: str, column: int, lost: Flags | None) -> Floats | float:
        """Return the position of an axis after each line; one number if it never changes."""
        word = self.lines.word(axis)
        before = float(self.state.position[column])
        if word is None:
            if lost is None:
                return before
            return fill(np.full(self.lines.live, np.nan), lost, before)
        value, present = word
        if axis in LENGTHS and self.modes.inch.any():
            value = np.where(self.modes.inch, value * INCH, value)
        incremental = self.modes.incremental & present
        placed = present & ~incremental
        if lost is not None:
            value = np.where(lost & ~present, np.nan, value)
            placed = placed | (lost & ~incremental)
        if not incremental.any():
            return fill(value, placed, before)
        position = _with_increments(value, placed, incremental, before)
        for line in np.flatnonzero(incremental & np.isnan(position))[: Findings.enough].tolist():
            self.findings.add(
                line,
                "GX207",
                f"{axis} is incremental, but where {axis} stands is not known",
                axis,
                f"begin with an absolute {axis}, or say start = {{ {axis} = ... }} in [input]",
            )
        return position

    def _path(self, rows: Ints, ends: Floats) -> Toolpath:
        """Return the rows as a toolpath; arcs get their centres."""
        count = len(rows)
        path = Toolpath(
            self.axes,
            self.modes.motion[rows],
            ends,
            np.broadcast_to(np.nan, (count, 3)),
            constant(0.0, count),
            self.modes.plane[rows],
            self._feed_of_rows(rows, ends),
            self.modes.feed_mode[rows],
            self.modes.frame[rows],
            rows + self.lines.window.first_line,
            constant(0, count, np.int64),
            constant(Form.PLAIN, count, np.int8),
            _at(self.side, rows),
            _at(self.radius, rows),
            self._lost_before(rows),
            self.entry,
            Blocks(
                self.lines.window.first_line,
                self.modes.inch,
                self.modes.incremental,
                self.modes.absolute_centre,
            ),
            events_of(self.lines, rows),
        )
        path = self._with_history(path)
        refuse_ends(self.lines, self.modes, path.side, path.kind, rows)
        if not path.has_arcs:
            return path
        arcs = np.flatnonzero(path.is_arc)
        return resolve_arcs(path, self._arc_words(rows[arcs]), self.dialect, self.findings)

    def _with_history(self, path: Toolpath) -> Toolpath:
        """Return the path with what passes may want to know of the moves before it."""
        state, after_rapid, after_side = self.state, self.state.rapid, self.state.at_side
        if len(path):
            if state.first_frame < 0:
                state.first_frame = int(path.frame[0])
            state.rapid = bool(path.kind[-1] == Kind.RAPID)
        return path.replace(
            first_frame=max(state.first_frame, 0),
            after_rapid=after_rapid,
            after_side=after_side,
        )

    def _lost_before(self, rows: Ints) -> Flags:
        """Return the moves before which the position was lost since the move before."""
        lost = np.cumsum(self.lost)[rows] if self.lost.any() else np.zeros(len(rows), np.int64)
        return np.diff(lost, prepend=0) > 0

    def _feed_of_rows(self, rows: Ints, ends: Floats) -> Floats:
        """Return feeds in mm/min, 1/min, mm/turn, or deg/min where only rotary axes turn."""
        feed, unit = self.modes.feed[rows], self.modes.feed_unit[rows]
        if (unit == 1.0).all():
            return feed
        plain = self.modes.feed_mode[rows] == NUMBER["G93"]
        plain |= turns_only(self.axes, self.entry, ends) & (self.modes.motion[rows] < 2)
        return np.where(plain, feed, feed * unit)

    def _arc_words(self, lines: Ints) -> ArcWords:
        """Return centre, radius and turns words of arcs, nan where there is none, in mm."""
        scale = np.where(self.modes.inch[lines], INCH, 1.0)

        def column(address: str) -> Floats:
            word = self.lines.word(address) if address else None
            if word is None:
                return np.full(len(lines), np.nan)
            return np.where(word[1][lines], word[0][lines], np.nan)

        return ArcWords(
            lines,
            np.stack([column(a) * scale for a in "IJK"], axis=1),
            column("R") * scale,
            column(self.dialect.turns_address),
            np.stack([~np.isnan(column(a)) for a in "XYZ"], axis=1),
            self.modes.absolute_centre[lines],
        )


def turns_only(axes: str, entry: Floats, ends: Floats) -> Flags:
    """Return the moves (n,) in which no linear axis moves and a rotary one does."""
    linear = [k for k, axis in enumerate(axes) if axis in LINEAR]
    rotary = [k for k, axis in enumerate(axes) if axis not in LINEAR]
    if not rotary or not len(ends):
        return np.zeros(len(ends), np.bool_)
    start = np.vstack([entry, ends[:-1]])
    still = (np.abs(start - ends) < SAME_PLACE) | (np.isnan(start) & np.isnan(ends))
    return np.asarray(still[:, linear].all(axis=1) & ~still[:, rotary].all(axis=1))


def _at(column: NDArray[Any], rows: Ints) -> NDArray[Any]:
    """Return a column of the lines at rows; one that holds one value keeps taking no memory."""
    if column.strides != (0,) or not len(column):
        return column[rows]
    return np.broadcast_to(column[0], (len(rows),))


def _with_increments(value: Floats, placed: Flags, incremental: Flags, before: float) -> Floats:
    """Return positions where some lines place the axis and others add to where it stands."""
    steps = np.cumsum(np.where(incremental, value, 0.0))
    base = fill(np.where(placed, value - steps, 0.0), placed, before)
    return np.asarray(base + steps)
