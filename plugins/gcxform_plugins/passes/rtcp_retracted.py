"""Which moves of a program draw the tool back and in again, and do nothing else: for the proof.

Such moves follow a piece of a line and belong to its block: one back along the tool's axis, by the
length asked for and with all angles as they are; some in which axes turn, each steadily one way,
with the tip near where it is; and one with all angles as they are, to where the tip was, with the
tool axis that it had. Each takes the time that its feed says. What is anything else is no such
move, and has to be one of the source.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

import gcxform as gx
from gcxform_plugins.passes.rtcp_driven import Driven
from gcxform_plugins.passes.rtcp_undoing import SHARE

if TYPE_CHECKING:
    from gcxform_plugins.passes.rtcp import Rtcp

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

NEAR = 0.1
"""How far the tip may move while axes turn, as a part of the way it was drawn back."""
SAME = 1e-6  # mm; of two tips at one place
SAME_TIME = 1e-9  # relative


class Retracted:
    """The work on one window; `found` are the rows of each time that the tool is drawn back."""

    def __init__(self, step: Rtcp, target: Driven) -> None:
        assert step.retract is not None
        assert step.retract_feed is not None
        self.length, self.feed = step.retract, step.retract_feed
        self.lean = np.radians(step.axis_tolerance)
        self.path, self.target = target.path, target
        step_of_angles = target.place.angles(target.end) - target.place.angles(target.start)
        self.turn = np.nan_to_num(step_of_angles, nan=np.inf)
        path = self.path
        timed = (path.kind == gx.Kind.LINE) & (path.form == gx.Form.PLAIN)
        self.timed = timed & (path.feed_mode == gx.FeedMode.INVERSE_TIME)
        self.still = (self.turn == 0.0).all(axis=1)
        self.found = self._find()

    def _find(self) -> list[range]:
        found: list[range] = []
        ends = np.flatnonzero(self.still)
        begins = self.timed[:-1] & self.timed[1:] & self.still[:-1] & ~self.still[1:]
        for first in np.flatnonzero(begins).tolist():
            after = ends[np.searchsorted(ends, first + 1) :][:1].tolist()
            if not after or (found and first in found[-1]):
                continue
            rows = range(first, after[0] + 1)
            if self._drawn_back(rows):
                found.append(rows)
        return found

    def _drawn_back(self, rows: range) -> bool:
        """Whether rows, of which only the first and the last do not turn, are as is said above."""
        first, last = rows[0], rows[-1]
        owner = self.path.source[first - 1 : last + 1]
        if first == 0 or (owner != owner[-1]).any() or not self.timed[first - 1 : last + 1].all():
            return False
        tips, axis, _ = self.target.at(np.array([first, first, last]), np.array([0.0, 1.0, 1.0]))
        back = tips[0] + self.length * axis[0]
        off = np.linalg.norm([back - tips[1], tips[0] - tips[2]], axis=1)
        lean = np.linalg.norm(axis[2] - axis[0])
        turning = np.arange(first + 1, last)
        turn = self.turn[turning]
        steady = np.abs(turn).sum(axis=0) - np.abs(turn.sum(axis=0))
        return bool(
            (off <= SAME).all()
            and lean <= self.lean
            and (steady <= SAME).all()
            and self._held(turning, back)
            and self._in_time(first, turning, last)
        )

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

    def _in_time(self, first: int, turning: Ints, last: int) -> bool:
        """Whether each move takes the time of its way, mm along the tool or degrees."""
        turned = np.linalg.norm(self.turn[turning], axis=1)
        way = np.concatenate([[self.length], turned, [self.length]])
        time = 1.0 / self.path.feed[first : last + 1]
        return bool((np.abs(time * self.feed / way - 1.0) <= SAME_TIME).all())
