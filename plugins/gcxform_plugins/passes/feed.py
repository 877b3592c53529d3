"""`feed`: feeds per minute (G94) become inverse times (G93), or the reverse.

In G93 a feed is the inverse of the minutes that its block takes, so one is the other times the
length of the move as the control measures it: along X Y Z, round the arc and up the helix, or in
degrees where only a rotary axis turns. What controls measure in ways of their own is refused.

The proof then goes by the clock: at the old feed the time of a line's moves is that of its way, as
programmed or as written (`gcxform/toolpath/travel.py`, which is not used here). In G93 a motion
code without axis words, or F without a move, would be an error or mean something else, so both wait
for the next move. A program that changes its feed mode and has no end is refused.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated, Literal

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Flags, Floats, Ints

LINEAR = "XYZUVW"
INCH = 25.4  # mm
SAME_PLACE = 1e-7  # mm, deg; an axis that moves by less stands still


@dataclass(frozen=True)
class FeedPass(gx.Pass):
    """Write feeds as inverse times (G93), or as feeds per minute (G94).

    Moves that go nowhere are left out of G93. A block that ends the program, or that calls what
    may move axes, keeps its feed mode: what runs after it finds what it found before.
    """

    name = "feed"

    mode: Annotated[
        Literal["inverse-time", "per-minute"], gx.Option("feed mode of all blocks: G93 or G94")
    ]

    @property
    def demands(self) -> gx.Demands:
        """Feeds are converted."""
        return gx.Demands(feed_mode=self.feed_mode)

    @property
    def feed_mode(self) -> gx.FeedMode:
        """The mode that feeds are converted to."""
        if self.mode == "inverse-time":
            return gx.FeedMode.INVERSE_TIME
        return gx.FeedMode.PER_MINUTE

    def apply(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        """Return the path with its feeds converted. Refuses lengths that are not known."""
        kept = path.blocks.leaves
        other = (path.feed_mode != self.feed_mode) & ~kept[path.block]
        rows = np.flatnonzero(other & (path.kind != gx.Kind.RAPID))
        still = np.zeros(len(path), np.bool_)
        feed = np.where(other, np.nan, path.feed)
        if not self._is_there(path, rows, context.target):
            return path
        if len(rows):
            moves = _Moves(path, rows)
            self._check(path, moves, context)
            way = moves.lengths()
            still[rows] = way == 0.0
            with np.errstate(divide="ignore"):
                factor = 1 / way if self.mode == "inverse-time" else way
            feed[rows] = path.feed[rows] * factor
            self._check_rate(path, rows, way, context)
        changed = path.replace(
            feed=feed,
            feed_mode=np.where(other, np.int8(self.feed_mode), path.feed_mode),
            blocks=replace(
                path.blocks,
                feed_mode=np.where(kept, path.blocks.feed_mode, np.int8(self.feed_mode)),
            ),
        )
        return changed.with_rows((~still).astype(np.int64)) if still.any() else changed

    # --- what is refused ---

    def _is_there(self, path: gx.Toolpath, rows: Ints, target: type[gx.Dialect]) -> bool:
        """Whether the target has the mode; refuse moves in one that it has not.

        Until one comes the mode stays as it is: before its place there is nothing to refuse.
        """
        name = "G93" if self.mode == "inverse-time" else "G94"
        code = target.codes.get(name)
        if code is not None and not code.reason:
            return True
        if len(rows):
            why = code.reason if code else "it has no such code"
            self._refuse(path, rows, f"feeds in {name} on {target.name}: {why}")
        return False

    def _check(self, path: gx.Toolpath, moves: _Moves, context: gx.PassContext) -> None:
        """Raise InputError for moves whose time or length is not known."""
        rows = moves.rows
        there, here = context.source, context.target
        per_minute = there if self.mode == "inverse-time" else here
        timed = here if self.mode == "inverse-time" else there
        mixed = (moves.families > 1) | (moves.rotary.sum(axis=1) > 1)
        if per_minute.feed_rule.along_lines:
            mixed = moves.both_linear
        arcs = path.is_arc[rows]
        for wrong, why in (
            (path.feed_mode[rows] == gx.FeedMode.PER_TURN, "its speed depends on the spindle"),
            (path.form[rows] == gx.Form.SPLINE, 'it is a spline, put "segment" before'),
            (path.form[rows] != gx.Form.PLAIN, "it is a part of a cycle, or tied to something"),
            (path.side[rows] != 0, "cutter compensation changes its length"),
            (np.isnan(moves.lengths()), "where it starts is not known"),
            (np.isnan(path.feed[rows]), "only the machine knows the feed"),
            (mixed, f"{per_minute.name} may measure it along any of its axes"),
            (arcs & (not timed.feed_rule.arcs_in_time), f"{timed.name} does not time arcs in G93"),
            (self._goes_nowhere(moves), "it goes nowhere, but takes time in G93"),
        ):
            if wrong.any():
                self._refuse(path, rows[wrong], f"the feed of this move is not converted: {why}")

    def _goes_nowhere(self, moves: _Moves) -> Flags:
        """Return which moves have a time that no feed per minute can say."""
        return np.asarray((moves.lengths() == 0.0) & (self.mode == "per-minute"))

    def _check_rate(
        self, path: gx.Toolpath, rows: Ints, way: Floats, context: gx.PassContext
    ) -> None:
        """Refuse what the control moves faster in G93 than it is told."""
        inverse = self.mode == "inverse-time"
        least = (context.target if inverse else context.source).feed_rule.least_inverse_rate
        rate = path.feed[rows] * (1.0 if inverse else way)
        inches = path.blocks.inch[path.block[rows]] & ~_Moves(path, rows).turns
        slow = (rate < least * np.where(inches, INCH, 1.0)) & (way > 0.0)
        if slow.any():
            message = f"the control moves no slower in G93 than {least:g} per minute"
            self._refuse(path, rows[slow], message)

    def _refuse(self, path: gx.Toolpath, rows: Ints, message: str) -> None:
        hint = "let the CAM write this part in the feed mode that is wanted"
        raise path.refuse("GX320", rows, message, hint)


class _Moves:
    """Some moves, as a control measures them.

    `rotary` (n, axes) which rotary axes turn; `turns` (n,) whether they turn alone; `families` (n,)
    how many of X Y Z, U V W and the rotary axes move; `both_linear` (n,) whether the first two do.
    """

    def __init__(self, path: gx.Toolpath, rows: Ints) -> None:
        self.path = path
        self.rows = rows
        start, end = path.start[rows], path.end[rows]
        self.way = np.where(np.isnan(start) & np.isnan(end), 0.0, end - start)
        moved = ~(np.abs(self.way) < SAME_PLACE)
        main = moved[:, :3].any(axis=1) | path.is_arc[rows]
        self.linear = np.array([axis in LINEAR for axis in path.axes])
        self.rotary = moved[:, ~self.linear]
        second = moved[:, 3:][:, self.linear[3:]].any(axis=1)
        self.both_linear = main & second
        self.turns = ~main & ~second & self.rotary.any(axis=1)
        self.families = 1 * main + 1 * second + 1 * self.rotary.any(axis=1)
        self.moved = moved.any(axis=1) | path.is_arc[rows]

    def lengths(self) -> Floats:
        """Return lengths (n,): mm, or degrees where rotary axes turn alone; nan where unknown."""
        size = np.sqrt((self.way[:, self.linear] ** 2).sum(axis=1))
        turned = np.sqrt((self.way[:, ~self.linear] ** 2).sum(axis=1))
        size = np.where(self.turns, turned, size)
        arcs = np.flatnonzero(self.path.is_arc[self.rows])
        if len(arcs):
            size[arcs] = self._arc_lengths(arcs)
        return np.where(self.moved, size, 0.0)

    def _arc_lengths(self, arcs: Ints) -> Floats:
        """Return the lengths of arcs, with their turns and what they rise."""
        rows = self.rows[arcs]
        first, _, _ = gx.radius_and_angle(self.path, rows)
        normal = np.array([plane.axes[2] for plane in gx.Plane])[self.path.plane[rows]]
        return np.asarray(np.hypot(first * self.path.sweep[rows], self.way[arcs, normal]))
