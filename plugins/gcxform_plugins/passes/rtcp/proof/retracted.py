"""Which moves of a program draw the tool back and in again, and do nothing else: for the proof.

    p, a   (3,) mm, (3,): the tip and the tool axis where the piece before ends
    L, F   mm, mm/min or degrees/min: by how much the tool is drawn back, and at which feed
    y      (3,) mm: the tip in a move between; a' the tool axis where the last one ends

Such moves go from p to p + L a, with |y - (p + L a)| <= NEAR L while axes turn, and from p + L a'
to p, with |a' - a| <= axis tolerance. Each takes the time of its way over F. What is claimed is
that such moves, and no others, are taken for these.

They follow a piece of a line and belong to its block: one back along the tool's axis, by the
length asked for and with all angles as they are; some in which axes turn, each steadily one way,
with the tip near where it is; and one with all angles as they are, to where the tip was, with the
tool axis that it had. Each takes the time that its feed says. What is anything else is no such
move, and has to be one of the source.

The user's lines stand before the turning moves and behind them, all of them, once and in order,
with what happens in them. Where one moves before the turn, X, Y and Z then rest; and where any
does, the tool goes back to where it was drawn back to, along the axes that no line has moved first,
and then along the others, the last ones first.
"""

from __future__ import annotations

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Floats, Ints
from gcxform_plugins.passes.rtcp.options import Options
from gcxform_plugins.passes.rtcp.proof.driven import Driven
from gcxform_plugins.passes.rtcp.proof.undoing import SHARE
from gcxform_plugins.passes.rtcp.user_lines import Line

NEAR = 0.1
"""How far the tip may move while axes turn, as a part of the way it was drawn back."""
SAME = 1e-6  # mm; of two tips at one place
SAME_TIME = 1e-9  # relative


class Retracted:
    """The work on one window; `found` are the rows of each time that the tool is drawn back.

    `given` are the user's blocks in them, and `moves` counts the rows that are none of these.
    """

    def __init__(self, options: Options, target: Driven) -> None:
        assert options.retraction is not None
        self.lines = options.retraction.lines
        self.length, self.feed = options.retraction.length, options.retraction.feed
        self.lean = np.radians(options.axis_tolerance)
        self.path, self.target = target.path, target
        step_of_angles = target.place.angles(target.end) - target.place.angles(target.start)
        self.turn = np.nan_to_num(step_of_angles, nan=np.inf)
        path = self.path
        timed = (path.kind == gx.Kind.LINE) & (path.form == gx.Form.PLAIN)
        self.timed = timed & (path.feed_mode == gx.FeedMode.INVERSE_TIME)
        self.still = (self.turn == 0.0).all(axis=1)
        self.ends = np.append(np.flatnonzero(self.still), len(path))
        rapid = (path.kind == gx.Kind.RAPID) & (path.form == gx.Form.MACHINE)
        self.in_machine = rapid & self.still
        self.step = np.nan_to_num((target.end - target.start)[:, :3], nan=np.inf)
        self.given: list[gx.Given] = []
        self.inside: list[gx.Event] = []
        self.found = self._find()
        self.moves = sum(map(len, self.found)) - sum(given.moves for given in self.given)

    def _find(self) -> list[range]:
        found: list[range] = []
        after = self.in_machine if any(line.ends for line in self.lines.retract) else ~self.still
        begins = self.timed[:-1] & self.still[:-1] & after[1:]
        for first in np.flatnonzero(begins).tolist():
            if found and first in found[-1]:
                continue
            rows = self._rows_from(first)
            if rows is not None:
                found.append(rows)
        return found

    def _rows_from(self, first: int) -> range | None:
        """Return the rows of what begins with a row, None if it is not as is said above."""
        turning = self._moved(first + 1, self.lines.retract)
        behind = int(self.ends[np.searchsorted(self.ends, turning)])
        going = self._moved(behind, self.lines.back)
        last = going + (self._going(first, going) if self.lines.move else 0)
        if turning == behind or last >= len(self.path):
            return None
        parts = first, np.arange(turning, behind), np.arange(going, last), last
        if not self._drawn_back(*parts) or not self._said(first, turning, behind, going, last):
            return None
        return range(first, last + 1)

    def _moved(self, row: int, lines: tuple[Line, ...]) -> int:
        """Return the row behind those in which the user's lines move; the end of all if not.

        An axis that a line does not name stays, and the others are where it says.
        """
        for line in lines:
            if not line.ends:
                continue
            if row >= len(self.path) or not self.in_machine[row]:
                return len(self.path)
            here, before = (side[row, :3] for side in (self.target.end, self.target.start))
            for k, axis in enumerate("XYZ"):
                wanted = line.ends.get(axis, before[k] + self.target.place.zero[k])
                if not abs(here[k] + self.target.place.zero[k] - wanted) <= SAME:
                    return len(self.path)
            row += 1
        return row

    def _going(self, first: int, row: int) -> int:
        """Return how many rows go back to over the cut: each along other axes, in their order."""
        count, last = 0, len(self.path) - 1
        over, _, _ = self.target.at(np.array([first]), np.array([1.0]))
        for axes in self.lines.groups():
            at = min(row + count, last)
            tip, _, _ = self.target.at(np.array([at]), np.array([0.0]))
            if np.linalg.norm(tip - over) <= SAME:
                break
            others = [k for k, axis in enumerate("XYZ") if axis not in axes]
            count += bool((np.abs(self.step[at][others]) <= SAME).all())
        return count

    def _drawn_back(self, first: int, turning: Ints, going: Ints, last: int) -> bool:
        """Whether rows, of which only `turning` turn, are as is said above."""
        owner = self.path.source[first - 1 : last + 1]
        timed = np.concatenate([[first - 1, first], turning, going, [last]])
        if first == 0 or (owner != owner[-1]).any() or not self.timed[timed].all():
            return False
        ends = np.array([first, first, last, last])
        tips, axis, _ = self.target.at(ends, np.array([0.0, 1.0, 1.0, 0.0]))
        back = tips[0] + self.length * axis[0]
        off = np.linalg.norm([back - tips[1], tips[0] - tips[2], back - tips[3]], axis=1)
        lean = np.linalg.norm(axis[2] - axis[0])
        turn = self.turn[turning]
        steady = np.abs(turn).sum(axis=0) - np.abs(turn.sum(axis=0))
        away = any(line.ends for line in self.lines.retract)
        return bool(
            (off <= SAME).all()
            and lean <= self.lean
            and (steady <= SAME).all()
            and self.still[[first, *going, last]].all()
            and (self._rests(turning) if away else self._held(turning, back))
            and self._in_time(first, turning, going, last)
        )

    def _rests(self, rows: Ints) -> bool:
        """Whether X, Y and Z rest along rows."""
        return bool((np.abs(self.step[rows]) <= SAME).all())

    def _held(self, rows: Ints, place: Floats) -> bool:
        """Whether the tip stays near a place (3,) along rows; False where it is nowhere known."""
        limit = NEAR * self.length
        many = np.ceil(np.sqrt(self.target.bends[rows] / (SHARE * limit)))
        many = np.maximum(np.nan_to_num(many), 1.0).astype(np.int64)
        row = np.repeat(rows, many + 1)
        at = np.arange(len(row)) - np.repeat(np.cumsum(many + 1) - many - 1, many + 1)
        pieces = np.repeat(many, many + 1)
        tips, _, _ = self.target.at(row, at / pieces)
        off = np.linalg.norm(tips - place, axis=1) + self.target.bends[row] / pieces**2
        return bool((off <= limit).all())

    def _in_time(self, first: int, turning: Ints, going: Ints, last: int) -> bool:
        """Whether each move takes the time of its way, mm or degrees."""
        turned = np.linalg.norm(self.turn[turning], axis=1)
        gone = np.linalg.norm(self.step[going], axis=1)
        way = np.concatenate([[self.length], turned, gone, [self.length]])
        rows = np.concatenate([[first], turning, going, [last]])
        time = 1.0 / self.path.feed[rows]
        return bool((np.abs(time * self.feed / way - 1.0) <= SAME_TIME).all())

    def _said(self, first: int, turning: int, behind: int, going: int, last: int) -> bool:
        """Whether the user's lines stand there, and what happens is what happens in them."""
        wanted: list[tuple[int, str, bool]] = []
        done: list[tuple[int, str, object]] = []
        for row, lines in ((first + 1, self.lines.retract), (behind, self.lines.back)):
            for line in lines:
                wanted.append((row, line.text, bool(line.ends)))
                done += [(row, what, values) for what, values in line.events]
                row += bool(line.ends)
        given = [g for g in self.path.given if first < g.row <= last]
        inside = [e for e in self.path.events if first < e.row <= last]
        if [(g.row, g.text, g.moves) for g in given] != wanted:
            return False
        if [(e.row, e.what, e.values) for e in inside] != done:
            return False
        self.given += given
        self.inside += inside
        return True
