"""Which of its attitudes a machine takes along a path, and after how many turns.

An attitude that is the nearest now may lead to a limit, and then the machine would have to flip
over inside the cut. So the whole path is looked at: by dynamic programming, point by point, the
cheapest way to each candidate is found from the candidates of the point before. A way costs the
degrees that all axes turn together. Inside a cut no axis may leap: between two points that are
near each other only a change of attitude does. At the pole the angle of one axis is free; it stays.

Where the tool may be drawn back, axes may leap at a point; as this is dearer than any turn, there
are as few such points as can be, and none where there is a way without. At the pole it is the free
axis that may turn then.

It begins with axes at 0, so a cut does not depend on the one before, and a window needs only whole
cuts. Two points between which no axis may leap are at most 5 degrees of the source apart. Four
codes say why there is no way: out of reach, the pole, the border of reach, or limits that force a
flip. What is chosen is the angle near which the exact one is taken, for every piece.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Flags, Floats, Ints

LEAP = 45.0
"""Degrees; an axis that turns farther from one point to the next leaps."""
IN_AIR = 1e-6  # of two ways of equal cost the one is taken that turns before the cut
NEAR_POLE = 5.0  # degrees of tilt within which a leap is one of the free axis
ALIKE = 45.0  # degrees between both attitudes within which they are about to be one
TURN = 360.0
RETRACT = 1e9  # degrees; what drawing the tool back costs


class Trouble(Enum):
    """Why there is no way."""

    UNREACHABLE = "unreachable"
    LIMITS = "limits"
    POLE = "pole"
    BORDER = "border"
    FLIP = "flip"


DRAWN_BACK = (Trouble.FLIP, Trouble.POLE)
"""What drawing the tool back may help against."""
WHY = {
    Trouble.UNREACHABLE: (
        "GX332",
        "no angles give this tool axis",
        "place the part otherwise, or let the CAM lean the tool less",
    ),
    Trouble.LIMITS: (
        "GX331",
        "no angles within the limits of the axes give this tool axis",
        "place the part otherwise, or let the CAM lean the tool less",
    ),
    Trouble.POLE: (
        "GX333",
        "the tool axis passes the pole, where an axis would have to leap",
        "lead the tool through the pole or farther beside it, or lift it off and turn the axis",
    ),
    Trouble.BORDER: (
        "GX334",
        "the tool axis comes to the border of reach, where both attitudes are one",
        "let the CAM stay some degrees inside of what the axes reach",
    ),
    Trouble.FLIP: (
        "GX335",
        "within their limits the axes would have to flip over or unwind inside this cut",
        'let the tool be drawn back to turn them, with retract = "20 mm"; or lift it off here in '
        "the CAM and begin another cut, or turn the part",
    ),
}
"""What is said of each: a code, a sentence and a hint."""


class NoWayError(Exception):
    """There is no way to a point, whose number is `at`."""

    def __init__(self, trouble: Trouble, at: int) -> None:
        super().__init__(trouble.value)
        self.trouble, self.at = trouble, at


@dataclass
class _Step:
    """The candidates of a point: angles (c, m), what the way there costs (c,), and from where."""

    angle: Floats
    cost: Floats
    come: Ints


class Choice:
    """The way of a chain along tool axes (n, 3); `cut` (n,) are the points reached in a cut.

    At points of `may` (n,) the tool may be drawn back; `retracts` are those where it is, once the
    way is found.
    """

    def __init__(self, chain: gx.Chain, axis: Floats, cut: Flags, may: Flags | None = None) -> None:
        self.chain = chain
        self.cut = cut
        self.retracts: list[int] = []
        self.found = gx.attitudes(chain, axis)
        self.angle, self.allowed = gx.turns(chain, self.found.angle)
        self.may = np.zeros(len(axis), np.bool_) if may is None else may
        self.may = self.may & cut
        self.endless = np.array([each.limits is None for each in chain.axes], np.bool_)
        lost = np.flatnonzero(self.found.state == gx.State.UNREACHABLE)
        if len(lost):
            raise NoWayError(Trouble.UNREACHABLE, int(lost[0]))
        lost = np.flatnonzero(~self.allowed.any(axis=1))
        if len(lost):
            raise NoWayError(Trouble.LIMITS, int(lost[0]))

    def run(self, start: Floats) -> Floats:
        """Return the angles (n, m) of the cheapest way from some angles (m,). NoWayError: none.

        Of a point where the tool is drawn back there are those before and those after it.
        """
        step = _Step(start[None, :], np.zeros(1), np.zeros(1, np.int64))
        steps, points = [], []
        for at in range(len(self.angle)):
            step = self._next(at, step)
            steps.append(step)
            points.append(at)
            if self.may[at]:
                step = self._drawn_back(at, step)
                steps.append(step)
                points.append(at)
        if not steps:
            return np.empty((0, len(start)))
        chosen, which = [], int(np.argmin(steps[-1].cost))
        for step in reversed(steps):
            chosen.append(step.angle[which])
            which = int(step.come[which])
        return self._counted_on(self._told(np.array(chosen[::-1]), points), start)

    def _told(self, chosen: Floats, points: list[int]) -> Floats:
        """Return angles without those that are told again because the tool stays in the cut."""
        again = np.diff(points, prepend=-1) == 0
        stays = again & (np.diff(chosen, axis=0, prepend=np.inf) == 0.0).all(axis=1)
        self.retracts = np.array(points)[again & ~stays].tolist()
        return np.asarray(chosen[~stays])

    def _drawn_back(self, at: int, before: _Step) -> _Step:
        """Return a point's candidates once more, if the tool may be drawn back there to turn."""
        angle = self._candidates(at, before, turns=True)
        way = np.abs(self._way(before.angle[:, None, :], angle[None, :, :])).sum(axis=-1)
        same = (before.angle[:, None, :] == angle[None, :, :]).all(axis=-1)
        cost = before.cost[:, None] + np.where(same, 0.0, RETRACT + way)
        come = np.argmin(cost, axis=0)
        return _Step(angle, cost[come, np.arange(len(angle))], come)

    def _next(self, at: int, before: _Step) -> _Step:
        angle = self._candidates(at, before)
        way = np.abs(self._way(before.angle[:, None, :], angle[None, :, :]))
        cost = before.cost[:, None] + way.sum(axis=-1)
        if self.cut[at]:
            cost += IN_AIR * way.sum(axis=-1)
            cost = np.where(way.max(axis=-1, initial=0.0) > LEAP, np.inf, cost)
        come = np.argmin(cost, axis=0)
        found = cost[come, np.arange(len(angle))]
        good = np.isfinite(found)
        if not good.any():
            raise NoWayError(self._why(at), at)
        return _Step(angle[good], found[good], come[good])

    def _candidates(self, at: int, before: _Step, turns: bool = False) -> Floats:
        """Return the angles (c, m) for a point; at the pole the free one is one that there was.

        Where nothing has been cut yet, or the tool is drawn back and axes turn (`turns`), it may be
        that of what is cut next.
        """
        own = np.asarray(self.angle[at][self.allowed[at]])
        free = self.found.free
        if self.found.state[at] != gx.State.POLE or free is None:
            return own
        held = before.angle[:, free]
        if turns or not self.cut[at]:
            later = np.flatnonzero(self.found.state[at:] != gx.State.POLE)[:1] + at
            held = np.concatenate([held, *(self.angle[k][self.allowed[k]][:, free] for k in later)])
        own = np.repeat(own, len(held), axis=0)
        own[:, free] = np.tile(held, len(own) // len(held))
        return np.unique(own, axis=0)

    def _way(self, one: Floats, other: Floats) -> Floats:
        """Return how far axes turn; those without limits turn the shorter way."""
        way = other - one
        return np.where(self.endless, np.remainder(way + TURN / 2, TURN) - TURN / 2, way)

    def _counted_on(self, angle: Floats, start: Floats) -> Floats:
        """Return angles (n, m) without leaps by whole turns of axes that have no limits."""
        before = np.concatenate([start[None, :], angle[:-1]])
        turns = np.rint((self._way(before, angle) - (angle - before)) / TURN)
        return np.asarray(angle + TURN * np.cumsum(turns, axis=0))

    def _why(self, at: int) -> Trouble:
        """Return why there is no way to a point from the one before."""
        near = slice(max(at - 1, 0), at + 1)
        tilt = self.found.tilt[near]
        if np.minimum(tilt, 180.0 - tilt).min() < NEAR_POLE:
            return Trouble.POLE
        apart = np.abs(np.remainder(np.diff(self.found.angle[near], axis=1) + 180.0, TURN) - 180.0)
        if apart.size and apart.max(axis=(1, 2)).min() < ALIKE:
            return Trouble.BORDER
        return Trouble.FLIP


def nearest(chain: gx.Chain, axis: Floats, guess: Floats) -> Floats:
    """Return the angles (n, m) for tool axes (n, 3) that are nearest to others (n, m).

    Turns are those of the guess; at the pole the free angle is that of the guess.
    """
    found = gx.attitudes(chain, axis)
    angle = found.angle + TURN * np.rint((guess[:, None, :] - found.angle) / TURN)
    if found.free is not None:
        pole = found.state == gx.State.POLE
        angle[pole, :, found.free] = guess[pole, None, found.free]
    far = np.abs(angle - guess[:, None, :]).max(axis=-1)
    return np.asarray(angle[np.arange(len(angle)), np.argmin(far, axis=1)])
