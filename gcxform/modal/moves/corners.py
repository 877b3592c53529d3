"""Corners into which the control puts a piece by itself: those of `X50. ,R5.` and `Y50. ,C3.`.

The word names the piece between a straight move and the one in the block behind it, and the block
names the corner at which the two would meet. Of the corner, with u and w the directions of the two
moves and t the angle from u to w:

    ,C c  a line, from c before the corner to c behind it
    ,R r  an arc that touches both moves, r * tan(t/2) before the corner and behind it; its centre
          is r / cos(t/2) away, in the direction of w - u

What is known of it is said for two lines in the plane that is in force. All else is refused.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from gcxform.dialect.dialect import INCH
from gcxform.modal.findings import Findings
from gcxform.modal.lines import Lines
from gcxform.modal.meaning.corner_words import OUT, does_more
from gcxform.system.arrays import Flags, Floats, Ints
from gcxform.toolpath.frames import Frame
from gcxform.toolpath.path import FeedMode, Form, Kind, Plane, Toolpath

STRAIGHT = np.radians(1.0)
"""Two lines that turn by less have no corner on a Fanuc; nor is there one where they turn back."""
SAME = 1e-9  # mm; a move may be used up by its corners, but for this
KNOWN = "program both axes of the plane before, or give the position at the start"


def with_corners(path: Toolpath, lines: Lines, at_side: int) -> Toolpath:
    """Return the path with the pieces that stand in corners; `at_side` is before its first move."""
    line = np.flatnonzero(lines.flag("corner"))
    if not len(line):
        return path
    corners = Corners(path, lines, line)
    if corners.refused_blocks() or corners.refused_states(at_side) or corners.refused_sizes():
        return path
    return corners.cut()


class Corners:
    """The corners (n,) of a window; row: that of the move that leads to each."""

    def __init__(self, path: Toolpath, lines: Lines, line: Ints) -> None:
        self.path = path
        self.lines = lines
        self.line = line
        self.row: Ints = np.searchsorted(path.block, line)

    def _refuse(self, which: Flags, message: str, hint: str = OUT, code: str = "GX213") -> bool:
        """Refuse corners; `{}` in the message is the word. Return whether there are any."""
        for line in self.line[which][: Findings.enough].tolist():
            word = self.lines.table.meanings[int(self.lines.shape[line])].corner
            self.lines.findings.add(line, code, message.format(word), word, hint)
        return bool(which.any())

    # --- what may stand there ---

    def refused_blocks(self) -> bool:
        """Refuse corners that are not between two straight moves of blocks that follow."""
        message = "{} stands in a corner behind a straight move, and this block is none"
        if self._refuse(~self._straight(self.line), message):
            return True
        message = "where {} ends is said by the block behind, and this is the last that is read"
        if self._refuse(self.line + 1 == len(self.lines.window), message, ""):
            return True
        message = "behind {} a block with a straight move in the same plane has to follow (G1)"
        return self._refuse(~self._straight(self.line + 1) | self._may_part(), message)

    def _straight(self, line: Ints) -> Flags:
        """Return which lines of the window are one straight move and nothing else that counts."""
        path, lines = self.path, self.lines
        inside = line < lines.live
        row, behind = np.searchsorted(path.block, line), np.searchsorted(path.block, line, "right")
        good: Flags = inside & (behind - row == 1)
        row = np.where(good, row, 0)
        good &= (path.kind[row] == Kind.LINE) & (path.form[row] == Form.PLAIN)
        shape = lines.shape[np.where(inside, line, 0)]
        more = {n: bool(does_more(lines.table.meanings[n])) for n in {*shape.tolist()}}
        return good & ~np.array([more[n] for n in shape.tolist()], np.bool_)

    def _may_part(self) -> Flags:
        """Return the corners at which only the machine knows which block comes next."""
        lines, open_ = self.lines, np.zeros(self.lines.live + 1, np.bool_)
        if lines.undecided:
            open_[:-1] |= lines.undecided.at_jumps(lines.window.first_line, lines.live)
        if lines.perhaps is not None:
            open_[:-1] |= lines.perhaps
        return np.asarray(open_[self.line] | open_[self.line + 1])

    def refused_states(self, at_side: int) -> bool:
        """Refuse corners at which something else changes than the direction."""
        path, row = self.path, self.row
        feed, mode = path.feed, path.feed_mode
        same = (feed[row] == feed[row + 1]) | (np.isnan(feed[row]) & np.isnan(feed[row + 1]))
        same &= (mode[row] == mode[row + 1]) & (mode[row] != FeedMode.INVERSE_TIME)
        same &= ~(np.isnan(feed[row]) & self._says_behind("F"))
        message = "the feed is another one behind the corner: at which {} is cut is not known"
        found = self._refuse(~same, message)
        side = np.append(np.int8(at_side), path.side)
        begins = (side[row] != side[row + 1]) | (side[row + 1] != side[row + 2])
        begins |= (side[row + 1] != 0) & self._says_behind("D")
        message = "{} at a move that begins, ends or changes cutter compensation is not followed"
        found |= self._refuse(begins, message)
        other = (path.plane[row] != path.plane[row + 1]) | (path.frame[row] != path.frame[row + 1])
        plain = [[_keeps_shapes(frame, plane) for plane in Plane] for frame in path.frames]
        other |= ~np.array(plain, np.bool_)[path.frame[row], path.plane[row]]
        message = "{} where coordinates change, or are scaled, tilted or polar, is not followed"
        return self._refuse(other, message) or found

    def _says_behind(self, address: str) -> Flags:
        """Return the corners behind which a block has a word."""
        word = self.lines.word(address)
        return np.asarray(
            np.zeros(len(self.line), np.bool_) if word is None else word[1][self.line + 1]
        )

    # --- where it is ---

    @cached_property
    def _in_plane(self) -> Ints:
        """First and second axis of the plane of each corner (n, 2)."""
        axes = np.array([plane.axes[:2] for plane in Plane])
        return np.asarray(axes[self.path.plane[self.row]])

    def _of_plane(self, places: Floats) -> Floats:
        """Return positions (n, axes) in the plane of each corner (n, 2)."""
        return np.take_along_axis(places[:, :3], self._in_plane, axis=1)

    @cached_property
    def _ways(self) -> tuple[Floats, Floats]:
        """The moves to and from the corner (n, 2), in its plane."""
        ends, at = self.path.end, self._of_plane(self.path.end[self.row])
        return at - self._of_plane(self._starts), self._of_plane(ends[self.row + 1]) - at

    @cached_property
    def _starts(self) -> Floats:
        """Where the moves to the corners start (n, axes)."""
        return np.asarray(self.path.start[self.row])

    @cached_property
    def turn(self) -> Floats:
        """The angles (n,) between the moves, rad, positive to the left."""
        u, w = self._ways
        cross, dot = u[:, 0] * w[:, 1] - u[:, 1] * w[:, 0], (u * w).sum(axis=1)
        return np.asarray(np.arctan2(cross, dot))

    @cached_property
    def _sizes(self) -> tuple[Floats, Flags]:
        """The numbers (n,) of the words, mm, and which of them are radii."""
        size, arc = np.full(len(self.line), np.nan), np.zeros(len(self.line), np.bool_)
        for letter in self.lines.dialect.motion_rule.corners:
            word = self.lines.word(f",{letter}")
            if word is None:
                continue
            here = word[1][self.line]
            size[here] = word[0][self.line][here]
            arc |= here & (letter == "R")
        return size * np.where(self.lines.inch[self.line], INCH, 1.0), arc

    @cached_property
    def _cut(self) -> Floats:
        """How much (n,) of either move is cut off, mm."""
        size, arc = self._sizes
        return np.where(arc, size * np.tan(np.abs(self.turn) / 2), size)

    def refused_sizes(self) -> bool:
        """Refuse corners that are none, or do not fit."""
        unknown = np.asarray(~np.isfinite(np.hstack(self._ways)).all(axis=1))
        if self._refuse(unknown, "where the moves at {} start or end is not known", KNOWN, "GX208"):
            return True
        message = "{} where an axis moves that is not in the plane (G17 to G19) is not followed"
        found = self._refuse(self._leave_plane(), message)
        angle = np.abs(self.turn)
        way = np.column_stack([np.hypot(*each.T) for each in self._ways])
        none = (angle <= STRAIGHT) | (angle >= np.pi - STRAIGHT) | (way < SAME).any(axis=1)
        message = "the moves at {} make no corner: they go on, turn back, or one goes nowhere"
        if self._refuse(np.asarray(none), message):
            return True
        found |= self._refuse(
            ~(self._sizes[0] > 0), "the size of {} is not more than 0, or not known"
        )
        message = "the moves are too short for {}: this corner, or two, take more than there is"
        short = np.asarray((self._left(way) < -SAME).any(axis=1))
        return self._refuse(short, message) or found

    def _leave_plane(self) -> Flags:
        """Return the corners at which another axis than those of the plane moves."""
        path, moves = self.path, np.zeros(len(self.line), np.bool_)
        for k, axis in enumerate(path.axes):
            word = self.lines.word(axis)
            others = ~(self._in_plane == k).any(axis=1)
            places = self._starts[:, k], path.end[self.row, k], path.end[self.row + 1, k]
            for nth in (0, 1):
                named = word is not None and word[1][self.line + nth]
                still = np.abs(places[nth + 1] - places[nth]) <= SAME
                still |= np.isnan(places[nth]) & np.isnan(places[nth + 1]) & ~np.asarray(named)
                moves |= others & ~still
        return moves | np.isfinite(path.tool[self.row]).any(axis=1)

    def _left(self, way: Floats) -> Floats:
        """Return what corners leave of the moves before and behind them (n, 2), mm."""
        used = np.zeros(len(self.path) + 1)
        np.add.at(used, self.row, self._cut)
        np.add.at(used, self.row + 1, self._cut)
        return way - np.column_stack([used[self.row], used[self.row + 1]])

    # --- the path ---

    def cut(self) -> Toolpath:
        """Return the path with the corners cut off."""
        u, w = (way / np.hypot(*way.T)[:, None] for way in self._ways)
        corner, cut = self._of_plane(self.path.end[self.row]), self._cut[:, None]
        counts = np.ones(len(self.path), np.int64)
        counts[self.row] = 2
        path, first = self.path.with_rows(counts), self.row + np.arange(len(self.row))
        end = path.end.copy()
        begin, behind = self._meeting(corner - cut * u, corner + cut * w)
        _put(end, first, self._in_plane, begin)
        _put(end, first + 1, self._in_plane, behind)
        nth = path.nth.copy()
        nth[first + 1] = 1
        size, arc = self._sizes
        across = (w - u) / np.hypot(*(w - u).T)[:, None]
        middle = corner + across * (size / np.cos(self.turn / 2))[:, None]
        centre, sweep, kind = path.centre.copy(), path.sweep.copy(), path.kind.copy()
        places = self.path.end[self.row, :3].copy()
        np.put_along_axis(places, self._in_plane, middle, axis=1)
        centre[(first + 1)[arc]] = places[arc]
        sweep[(first + 1)[arc]] = np.abs(self.turn[arc])
        kind[(first + 1)[arc]] = np.where(self.turn[arc] > 0, Kind.ARC_CCW, Kind.ARC_CW)
        return path.replace(end=end, nth=nth, centre=centre, sweep=sweep, kind=kind)

    def _meeting(self, begin: Floats, behind: Floats) -> tuple[Floats, Floats]:
        """Return where pieces begin and end (n, 2), to the bit in one point where nothing is left.

        A move that its corners use up would otherwise go back, by what arithmetic leaves.
        """
        way = np.column_stack([np.hypot(*each.T) for each in self._ways])
        before, after = (self._left(way) <= SAME).T
        follows = np.append(False, np.diff(self.row) == 1)
        last, first = after & ~np.append(follows[1:], False), before & ~follows
        behind[last] = self._of_plane(self.path.end[self.row + 1])[last]
        begin[first] = self._of_plane(self._starts)[first]
        begin[before & follows] = behind[np.flatnonzero(before & follows) - 1]
        return begin, behind


def _put(places: Floats, rows: Ints, axes: Ints, values: Floats) -> None:
    """Put values (n, 2) into positions at rows, each at its axes (n, 2)."""
    places[rows[:, None], axes] = values


def _keeps_shapes(frame: Frame, plane: Plane) -> bool:
    """Whether lengths and angles in a plane are in positions what they are in a frame."""
    if frame.matrix is None or frame.polar or frame.diameter:
        return not (frame.polar or frame.diameter)
    matrix, (*_, normal) = np.array(frame.matrix), plane.axes
    lone = np.abs(np.delete(matrix[normal], normal)).max() < SAME
    return bool(lone and np.abs(matrix.T @ matrix - np.eye(3)).max() < SAME)
