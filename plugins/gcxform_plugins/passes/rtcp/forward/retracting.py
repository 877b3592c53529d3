"""The moves of `retarget` that the source does not have: out of a cut, axes turned, and in again.

The tool is drawn back along its own axis with the angles at which it cuts; then the axes turn, the
tip near the place that it was drawn back to; then it goes along its axis to where it left the cut,
with the angles of the other attitude or turn. All are feed moves, as where a tip goes in a rapid is
not known. Their feed is that of the tip, and in degrees where it rests.

The user's own lines may take X, Y and Z to places of the machine before the axes turn; then these
stay there meanwhile. Afterwards each goes back to over the cut by itself: first those that no line
has moved, then the others, the last ones first.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

import gcxform as gx
from gcxform.vocabulary import Floats, Ints
from gcxform_plugins.passes.rtcp.options import Retraction
from gcxform_plugins.passes.rtcp.place import Place
from gcxform_plugins.passes.rtcp.user_lines import Line
from gcxform_plugins.passes.shared.tip_bound import leaving

HELD = 0.08
"""How far the tip may move while axes turn, as a part of the way it was drawn back."""
MOST = 10_000  # moves in which axes turn


NEXT_TO = 1e-6  # mm; nearer than that an axis need not go


@dataclass(frozen=True)
class Retract:
    """Moves behind the piece `at` of a row: where they end (k, axes), and feeds (k,), 1/min.

    `kind` and `form` (k,) are those of the moves. `lines` are the user's own, each with the number
    of the move that it stands before, or which it is.
    """

    at: int
    row: int
    end: Floats
    feed: Floats
    kind: Ints
    form: Ints
    lines: tuple[tuple[int, Line], ...] = ()


@dataclass(frozen=True)
class Drawing:
    """What drawing the tool back in a row needs to know: where the axes are, and how it is done."""

    target: Place
    how: Retraction
    row: int

    def retract(self, at: int, sides: tuple[Floats, Floats]) -> Retract:
        """Return the moves behind a piece, between the positions (axes,) on both sides."""
        arrives, leaves = sides
        length, target, lines = self.how.length, self.target, self.how.lines
        angles = target.angles(arrives[None, :])
        tip = target.tips_of(arrives[None, :3], angles, np.array([self.row]))
        tip = tip + length * target.chain.tool_axis(angles)
        over = [arrives.copy(), leaves.copy()]
        for place in over:
            place[:3] = self.brought(tip, target.angles(place[None, :]))
        moves = _Moves(self, arrives)
        moves.feed_to(over[0], length)
        moves.follow(lines.retract)
        if any(line.ends for line in lines.retract):
            moves.turn_to([target.angles(leaves[None, :])[0]], None)
        else:
            ends = (angles, target.angles(leaves[None, :]))
            moves.turn_to([*self._turning(tip, ends)[1:]], tip)
        moves.follow(lines.back)
        for axes in lines.groups() if lines.move else ():
            moves.go_back(over[1], axes)
        moves.feed_to(leaves, length)
        return Retract(at, self.row, *moves.columns(), tuple(moves.lines))

    def brought(self, tip: Floats, angles: Floats) -> Floats:
        """Return the position (3,) with which the axes take a tip (1, 3) there at angles (1, m)."""
        return np.asarray(self.target.axes_of(tip, angles, np.array([self.row]))[0])

    def _turning(self, tip: Floats, sides: tuple[Floats, Floats]) -> Floats:
        """Return angles (k, m) from one side to the other, between which the tip stays near."""
        limit, count, worst = HELD * self.how.length, 1, np.inf
        row = np.array([self.row])
        ((chain, _),) = self.target.chains(row)
        point = self.target.on_workpiece(tip, chain)
        while True:
            part = np.linspace(0.0, 1.0, count + 1)[:, None]
            angles = self.target.written(sides[0] + part * (sides[1] - sides[0]))
            points = np.repeat(point, count, axis=0)
            worst = float(leaving(chain, (points, points), (angles[:-1], angles[1:])).max())
            if worst <= limit:
                return np.asarray(angles[np.diff(angles, axis=0, prepend=np.inf).any(axis=1)])
            if count > MOST:
                message = f"to turn here would take more than {MOST} moves"
                hint = "draw the tool back farther: raise retract"
                raise self.target.path.refuse("GX330", row, message, hint)
            count = min(max(int(np.ceil(count * np.sqrt(worst / limit))), count + 1), 4 * count)


class _Moves:
    """Moves one after the other, from a position (axes,)."""

    def __init__(self, work: Drawing, here: Floats) -> None:
        self.work, self.here = work, here
        self.found: list[tuple[Floats, float, int, int]] = []
        self.lines: list[tuple[int, Line]] = []

    def _add(self, end: Floats, feed: float, kind: gx.Kind, form: gx.Form) -> None:
        self.found.append((end, feed, kind, form))
        self.here = end

    def feed_to(self, end: Floats, way: float) -> None:
        """Feed to a position that is so far, in mm or degrees."""
        self._add(end, self.work.how.feed / way, gx.Kind.LINE, gx.Form.PLAIN)

    def follow(self, lines: tuple[Line, ...]) -> None:
        """Do what the user's lines say."""
        zero = self.work.target.zero
        for line in lines:
            self.lines.append((len(self.found), line))
            if line.ends:
                end = self.here.copy()
                for axis, value in line.ends.items():
                    end["XYZ".index(axis)] = value - zero["XYZ".index(axis)]
                self._add(end, np.nan, gx.Kind.RAPID, gx.Form.MACHINE)

    def turn_to(self, angles: list[Floats], tip: Floats | None) -> None:
        """Turn axes, from angles to angles (m,), the others still or with the tip (1, 3) held."""
        target = self.work.target
        for there in angles:
            end = self.here.copy()
            end[target.columns] = there
            if tip is not None:
                end[:3] = self.work.brought(tip, there[None, :])
            self.feed_to(end, float(np.linalg.norm((end - self.here)[target.columns])))

    def go_back(self, over: Floats, axes: str) -> None:
        """Go with some axes to where they stand over the cut."""
        end = self.here.copy()
        for axis in axes:
            end["XYZ".index(axis)] = over["XYZ".index(axis)]
        way = float(np.linalg.norm((end - self.here)[:3]))
        if way > NEXT_TO:
            self.feed_to(end, way)

    def columns(self) -> tuple[Floats, Floats, Ints, Ints]:
        """Return ends, feeds, kinds and forms."""
        end, feed, kind, form = zip(*self.found, strict=True)
        return np.array(end), np.array(feed), np.array(kind, np.int8), np.array(form, np.int8)


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


def with_lines(path: gx.Toolpath, retracts: list[Retract]) -> gx.Toolpath:
    """Return a path of pieces with the user's lines, and with what happens in them."""
    events, given, before = [*path.events], [], 0
    for each in retracts:
        line = int(path.source[each.at + 1 + before])
        for number, user in each.lines:
            row = each.at + 1 + before + number
            given.append(gx.Given(row, user.text, line, bool(user.ends)))
            events += [gx.Event(row, what, values, line, True) for what, values in user.events]
        before += len(each.end)
    events.sort(key=lambda event: event.row)
    return path.replace(events=tuple(events), given=tuple(given))
