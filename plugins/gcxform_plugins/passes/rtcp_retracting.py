"""The moves of `rtcp` that the source does not have: out of a cut, axes turned, and in again.

The tool is drawn back along its own axis with the angles at which it cuts; then the axes turn, the
tip near the place that it was drawn back to; then it goes along its axis to where it left the cut,
with the angles of the other attitude or turn. All are feed moves, as where a tip goes in a rapid is
not known. Their feed is that of the tip, and in degrees where it rests.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from gcxform_plugins.passes.rtcp_bound import leaving

if TYPE_CHECKING:
    from gcxform_plugins.passes.rtcp_moving import Moving

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

HELD = 0.08
"""How far the tip may move while axes turn, as a part of the way it was drawn back."""
MOST = 10_000  # moves in which axes turn


@dataclass(frozen=True)
class Retract:
    """Moves behind the piece `at` of a row: where they end (k, axes), and feeds (k,), 1/min."""

    at: int
    row: int
    end: Floats
    feed: Floats

    @classmethod
    def of(cls, work: Moving, at: int, row: int, sides: tuple[Floats, Floats]) -> Retract:
        """Return the moves between the positions (axes,) on both sides."""
        arrives, leaves = (side[None, :] for side in sides)
        assert work.step.retract is not None
        assert work.step.retract_feed is not None
        length, feed, target = work.step.retract, work.step.retract_feed, work.target
        angles = target.angles(arrives)
        tip = target.tips_of(arrives[:, :3], angles, np.array([row]))
        tip = tip + length * target.chain.tool_axis(angles)
        angles = _turning(work, row, tip, (angles, target.angles(leaves)))
        end = np.repeat(arrives, len(angles), axis=0)
        end[:, target.columns] = angles
        tips = np.repeat(tip, len(angles), axis=0)
        end[:, :3] = target.axes_of(tips, angles, np.full(len(angles), row))
        turned = np.linalg.norm(np.diff(angles, axis=0), axis=1)
        way = np.concatenate([[length], turned, [length]])
        return cls(at, row, np.concatenate([end, leaves]), feed / way)


def _turning(work: Moving, row: int, tip: Floats, sides: tuple[Floats, Floats]) -> Floats:
    """Return angles (k, m) from one side to the other, between which the tip stays near."""
    assert work.step.retract is not None
    limit, count, worst = HELD * work.step.retract, 1, np.inf
    ((chain, _),) = work.target.chains(np.array([row]))
    point = work.target.on_workpiece(tip, chain)
    while True:
        part = np.linspace(0.0, 1.0, count + 1)[:, None]
        angles = work.written(sides[0] + part * (sides[1] - sides[0]))
        points = np.repeat(point, count, axis=0)
        worst = float(leaving(chain, (points, points), (angles[:-1], angles[1:])).max())
        if worst <= limit:
            return np.asarray(angles[np.diff(angles, axis=0, prepend=np.inf).any(axis=1)])
        if count > MOST:
            message = f"to turn here would take more than {MOST} moves"
            hint = "draw the tool back farther: raise retract"
            raise work.path.refuse("GX330", np.array([row]), message, hint)
        count = min(max(int(np.ceil(count * np.sqrt(worst / limit))), count + 1), 4 * count)


def inserted(column: NDArray[Any], retracts: list[Retract], name: str) -> NDArray[Any]:
    """Return a column of pieces with what it has at the moves that draw the tool back."""
    if not retracts:
        return column
    behind = np.concatenate([np.full(len(each.end), each.at + 1) for each in retracts])
    if name == "drawn":
        values: NDArray[Any] = np.ones(len(behind), np.bool_)
    elif name in ("row", "feed_mode"):
        values = column[behind - 1]
    else:
        values = np.concatenate([getattr(each, name) for each in retracts])
    return np.insert(column, behind, values, axis=0)
