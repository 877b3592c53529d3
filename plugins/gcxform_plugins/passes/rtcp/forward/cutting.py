"""How positions are converted: lines are cut until their pieces hold, then their ends are."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

import gcxform as gx
from gcxform.vocabulary import Flags, Floats, Ints
from gcxform_plugins.passes.rtcp.forward.ways import Way
from gcxform_plugins.passes.rtcp.options import Options
from gcxform_plugins.passes.rtcp.place import SAME, TURN_BACK, Place, turned_at
from gcxform_plugins.passes.rtcp.proof.undoing import SHARE

STILL = 1e-7  # mm, degrees; what moves by less stands still
ASTRAY = 0.7  # of the tolerance; what rounded angles may take of it, where they move the tip
MOST = 100_000  # pieces of one block


class Cutting:
    """The work on one window: of positions of one kind those of another."""

    def __init__(
        self, options: Options, path: gx.Toolpath, context: gx.PassContext, place: Place, way: Way
    ) -> None:
        self.options = options
        self.context = context
        self.place = place
        self.way = way
        self.path = path
        self.to_axes = options.to_axes
        self.end = self._rounded(path.end)
        self.start = path.start
        self.start[1:] = self.end[:-1]
        self.start = path.with_lost(self.start)
        self.start[:1] = self._rounded(self.start[:1])
        followed = [0, 1, 2, *place.columns]
        self.unknown_start = np.isnan(self.start[:, followed]).any(axis=1)
        self.turned = turned_at(place.angles(self.end)) & ~place.off
        self.turned_before = turned_at(place.angles(self.start)) & ~place.off
        self.own = (path.form == gx.Form.HOME) | (path.form == gx.Form.MACHINE)
        self.cuts = (path.kind == gx.Kind.LINE) & (path.form == gx.Form.PLAIN)
        per_minute = path.feed_mode == gx.FeedMode.PER_MINUTE
        self.least = np.ones(len(path), np.int64)
        self.nowhere = self.cuts & self.to_axes & per_minute & (self._ways() < STILL)

    def run(self) -> tuple[gx.Toolpath, Ints]:
        """Return the path converted, and of which row (n,) each of its rows is a piece."""
        self._check()
        path = self.path
        pieces = np.where(self.nowhere, 0, self._pieces())
        row = np.repeat(np.arange(len(path)), pieces)
        end = self._cut(pieces, row)
        self._check_limits(end, row)
        result = end.copy(order="F")
        result[:, :3] = self.way.converted(end, row)
        entry = self._entry()
        feeds = self._feeds(pieces, row, np.concatenate([entry[None, :], result]))
        return path.with_rows(pieces, end=result, **feeds).replace(entry=entry), row

    # --- positions ---

    def _rounded(self, positions: Floats) -> Floats:
        """Return positions with angles as they will be written: X, Y, Z have to suit those."""
        rounded = positions.copy()
        for column in self.place.columns:
            decimals = self.context.decimals_of_angle(self.path.axes[column])
            rounded[:, column] = np.round(positions[:, column], decimals)
        return rounded

    def _entry(self) -> Floats:
        """Return where the axes stand before the first row."""
        entry = self._rounded(self.path.entry[None, :])
        entry[:, :3] = self.way.converted(entry, np.array([0]))
        return np.asarray(entry[0])

    def _cut(self, pieces: Ints, row: Ints) -> Floats:
        """Return the ends (n, axes) of the pieces of rows, before they are converted."""
        middle, last = self._middle(pieces, row)
        return np.where(last, self.end[row], self._rounded(middle))

    def _middle(self, pieces: Ints, row: Ints) -> tuple[Floats, Flags]:
        """Return the same with angles in proportion, and which (n, 1) are ends of rows."""
        nth = np.arange(len(row)) - np.repeat(np.cumsum(pieces) - pieces, pieces) + 1
        part = (nth / np.maximum(pieces[row], 1))[:, None]
        start, end = self.start[row], self.end[row]
        return np.asarray(start + part * (end - start)), np.asarray(part == 1.0)

    # --- pieces ---

    def _pieces(self) -> Ints:
        """Return into how many pieces each row is cut, so that the tip stays on its line."""
        pieces = self.least.copy()
        limit = (1.0 - SHARE) * self.options.tolerance
        rows = self._turning()
        while len(rows):
            worst = self._worst(rows, pieces[rows])
            over = worst > limit
            more = np.ceil(pieces[rows] * np.sqrt(worst / limit) * 0.98)
            rows, more = rows[over], more[over]
            most = np.maximum(np.minimum(more, 4 * pieces[rows]), pieces[rows] + 1)
            pieces[rows] = np.ceil(most / self.least[rows]) * self.least[rows]
            if len(rows) and int(pieces[rows].max()) > MOST:
                row = rows[np.argmax(pieces[rows])]
                message = f"this block would become more than {MOST} pieces"
                raise self.path.refuse("GX330", np.array([row]), message, "raise the tolerance")
        return pieces

    def _turning(self) -> Ints:
        """Return the rows that cut while axes turn."""
        way = np.abs(self.place.angles(self.end - self.start)).max(axis=1, initial=0.0)
        return np.flatnonzero(self.cuts & (way > 0.0) & ~self.place.off)

    def _worst(self, rows: Ints, count: Ints) -> Floats:
        """Return how far (mm) the tip can be off in any of the pieces, `count` of each of rows."""
        row = np.repeat(rows, count)
        first = np.cumsum(count) - count
        pieces = np.zeros(len(self.path), np.int64)
        pieces[rows] = count
        end = self._cut(pieces, row)
        start = np.empty_like(end)
        start[1:] = end[:-1]
        start[first] = self.start[rows]
        return np.asarray(np.maximum.reduceat(self._off((start, end), pieces, row), first))

    def _off(self, sides: tuple[Floats, Floats], pieces: Ints, row: Ints) -> Floats:
        """Return how far (n,) mm the tip can leave its line in pieces between two sides."""
        far = self.way.leaving(sides, row)
        return far if self.to_axes else far + self._astray(pieces, sides[1], row)

    def _astray(self, pieces: Ints, end: Floats, row: Ints) -> Floats:
        """Return how far (n,) mm rounded angles take the tip astray, at either end of pieces."""
        middle, last = self._middle(pieces, row)
        there = self._apart(np.where(last, self.path.end[row], middle), end, row)
        self._check_astray(there, row)
        before, first = np.append(0.0, there[:-1]), np.flatnonzero(np.diff(row, prepend=-1))
        before[first] = self._apart(self.path.start[row[first]], self.start[row[first]], row[first])
        return np.asarray(np.maximum(before, there))

    def _apart(self, one: Floats, other: Floats, row: Ints) -> Floats:
        """Return how far (n,) mm tips are apart, where axes stand at positions (n, axes)."""
        place = self.place
        tips = [place.tips_of(at[:, :3], place.angles(at), row) for at in (one, other)]
        return np.asarray(np.nan_to_num(np.linalg.norm(tips[0] - tips[1], axis=1)))

    def _check_astray(self, astray: Floats, row: Ints) -> None:
        """Refuse angles that take the tip so far astray (mm) that nothing is left for its way."""
        over = astray > ASTRAY * self.options.tolerance
        if over.any():
            far, letters = float(astray.max()), self.place.chain.letters
            message = f"angles as they are written would take the tip {far:.4f} mm off"
            more = ", ".join(f"{a} = {self.context.decimals_of_angle(a) + 1}" for a in letters)
            hint = f"write more decimals: decimals = {{ {more} }} in [output]; or raise tolerance"
            raise self.path.refuse("GX330", np.unique(row[over]), message, hint)

    # --- feeds ---

    def _feeds(self, pieces: Ints, row: Ints, stops: Floats) -> dict[str, NDArray[Any]]:
        """Return feeds and their modes, in which each piece takes its share of the time.

        It takes longer where an axis would be too fast. `stops` (n + 1, axes) are where axes are.
        """
        path = self.path
        feed, mode = path.feed.copy(), path.feed_mode.copy()
        if self.to_axes:
            leaves = path.blocks.leaves[path.block]
            told = (mode == gx.FeedMode.PER_MINUTE) & ~leaves
            moving = told & (path.kind != gx.Kind.RAPID) & ~self.nowhere
            feed[told] = np.nan
            feed[moving] = path.feed[moving] / self._ways()[moving]
            mode[told] = gx.FeedMode.INVERSE_TIME
        inverse = mode == gx.FeedMode.INVERSE_TIME
        feed = feed[row] * np.where(inverse[row], pieces[row], 1.0)
        if self.to_axes:
            most = 1.0 / np.maximum(self._least_times(stops), 1e-300)
            feed = np.where(moving[row], np.fmin(feed, most), feed)
        return {"feed": feed, "feed_mode": mode[row]}

    def _least_times(self, stops: Floats) -> Floats:
        """Return the time (n,) min that the axes take at least from each place to the next."""
        assert self.context.machine is not None
        least = np.zeros(len(stops) - 1)
        for column, letter in enumerate(self.path.axes):
            axis = self.context.machine.axes.get(letter)
            if axis is not None and axis.max_speed is not None:
                way = np.nan_to_num(np.abs(np.diff(stops[:, column])))
                least = np.maximum(least, way / axis.max_speed)
        return least

    def _ways(self) -> Floats:
        """Return how far (n,) tips go, in mm; in degrees where only axes turn."""
        step = self.end - self.start
        way = np.linalg.norm(step[:, :3], axis=1)
        turned = np.linalg.norm(self.place.angles(step), axis=1)
        return np.asarray(np.where(way < STILL, turned, way))

    # --- what is refused ---

    def _check(self) -> None:
        angles, before = self.place.angles(self.end), self.place.angles(self.start)
        moved = np.nan_to_num(np.abs(angles - before)).max(axis=1) > STILL
        moved |= (np.isnan(before) & ~np.isnan(angles)).any(axis=1)
        turned = self.turned | self.turned_before
        self._check_known(turned, moved)
        turned |= moved & (self.path.kind != gx.Kind.RAPID) & ~self.place.off  # a whole turn
        self._check_forms(turned)
        if self.options.corrects:
            self._check_decimals()
        else:
            self._check_ends()
            self._check_feeds(moved)
            if not self.options.rapids_turn:
                self._check_rapids(moved)
        self._check_ways_round()
        self._check_tools(turned)

    def _check_known(self, turned: Flags, moved: Flags) -> None:
        unknown = np.isnan(self.place.angles(self.end)).any(axis=1)
        unknown |= np.isnan(self.end[:, :3]).any(axis=1) & turned
        unknown |= self.cuts & (turned | moved) & self.unknown_start
        hint = "program all axes before, or say where they are with start in [input]"
        if self.place.off.any():
            hint = "after a switch with axes turned, name X, Y and Z together in a rapid"
        elif self.path.lost[: int(np.argmax(unknown)) + 1].any():
            hint = "name all axes in the first rapid behind a tool change, which moves them"
        message = "where the axes stand is not known here"
        self._refuse("GX311", unknown & ~self.own, message, hint)

    def _check_forms(self, turned: Flags) -> None:
        """Refuse what is no plain move, and moves to the machine's own points while turned."""
        path, hint = self.path, TURN_BACK
        message = "a move in machine coordinates, where axes are turned"
        self._refuse("GX330", self.own & turned, message, hint)
        message = "cutter compensation is in force"
        self._refuse("GX330", path.side != 0, message, gx.put_before("cutter-comp"))
        cycle = np.isin(path.form, (gx.Form.CYCLE, gx.Form.SYNCHRONISED))
        message = "a canned cycle or a tap is no plain move"
        self._refuse("GX330", cycle, message, gx.put_before("cycles"))
        other = ~self.own & (path.form != gx.Form.PLAIN) & turned
        self._refuse("GX330", other, "this is no plain move", hint)

    def _check_rapids(self, moved: Flags) -> None:
        """Refuse rapids that turn axes, but from an unknown angle to 0, as a program begins."""
        unknown = np.isnan(self.place.angles(self.start)).any(axis=1)
        rapid = (self.path.kind == gx.Kind.RAPID) & ~(unknown & ~self.turned) & ~self.place.off
        message = "where the tip goes in a rapid that turns axes is not known"
        hint = 'move at a feed, or say rapids = "ends" if the tool is clear on any way'
        self._refuse("GX330", rapid & moved, message, hint)

    def _check_ends(self) -> None:
        """Refuse where blocks end, if the angles there are rounded by too much."""
        if self.to_axes:
            return
        off = np.nan_to_num(np.abs(self.place.angles(self.end - self.path.end))).max(axis=1)
        rows = np.flatnonzero((off > 0.0) & ~self.own)
        self._check_astray(self._apart(self.path.end[rows], self.end[rows], rows), rows)

    def _check_decimals(self) -> None:
        """Refuse angles that are rounded: where the tip was is not known at others."""
        off = np.nan_to_num(np.abs(self.place.angles(self.end - self.path.end))).max(axis=1)
        hint = "write as many as the program has: decimals = { A = 4, C = 4 } in [output]"
        message = "an angle has more decimals than are written"
        self._refuse("GX330", off > STILL, message, hint)

    def _check_ways_round(self) -> None:
        """Refuse moves that a control may make the other way round."""
        step = np.abs(self.place.angles(self.end - self.start))
        for k, axis in enumerate(self.place.chain.axes):
            if axis.wrap is not None:
                far = self.cuts & (step[:, k] >= axis.wrap / 2.0)
                message = f"{axis.letter} turns by half of its wrap or more, either way round"
                hint = "program a point on the way; or leave out wrap if the axis does not take"
                self._refuse("GX330", far, message, f"{hint} the shorter way")

    def _check_tools(self, turned: Flags) -> None:
        """Refuse another tool length while the tool is turned, and none on a head that is.

        A control that is switched by codes keeps the coordinates as they are, and lets the axes
        leap to what they mean with the new length; where a rapid ends is known nevertheless.
        """
        which = self.place.which
        changed = (which != self.place.which_before) & self.turned_before
        hint = "call the tool length while the rotary axes are at 0"
        if self.options.tip_codes:
            changed &= (self.path.kind != gx.Kind.RAPID) | (not self.options.rapids_turn)
        message = "the tool length changes where the axes are turned"
        self._refuse("GX330", changed, message, hint)
        if self.place.chain.head:
            none = ~self.place.called
            message = "no tool length is in force, and the head is turned"
            self._refuse(
                "GX330", none & turned, message, "call it with G43 before, clear of the part"
            )

    def _check_feeds(self, moved: Flags) -> None:
        path = self.path
        feeding = path.kind != gx.Kind.RAPID
        told = feeding & (path.feed_mode != gx.FeedMode.INVERSE_TIME)
        hint = "let the CAM write this part in the feed mode that is wanted"
        axes = np.full(len(path), not self.to_axes) | self.place.off
        message = "what a feed of linear and rotary axes together means is not known"
        self._refuse("GX320", told & moved & axes, message, hint)
        if not self.to_axes:
            return
        turn = path.feed_mode == gx.FeedMode.PER_TURN
        self._refuse("GX320", feeding & turn, "its speed depends on the spindle", hint)
        leaves = path.blocks.leaves[path.block]
        message = "the block ends the program or calls what may move axes, in its own feed mode"
        self._refuse("GX320", told & leaves, message, "put the move into a block of its own")
        self._refuse("GX320", told & self.unknown_start, "where it starts is not known", hint)

    def _check_limits(self, end: Floats, row: Ints) -> None:
        """Refuse positions that the machine does not reach."""
        place = self.way.axes
        posted = not self.to_axes and not self.options.corrects
        axes = end[:, :3] if posted else self.way.converted(end, row)
        axes = axes + place.zero
        angles = place.angles(end)
        named = [*zip("XYZ", place.chain.travel, axes.T, strict=True)]
        for axis, values in zip(place.chain.axes, angles.T, strict=True):
            if axis.limits is not None:
                named.append((axis.letter, axis.limits, values))
        self._check_named(named, row)

    def _check_named(
        self,
        named: list[tuple[str, tuple[float, float], Floats]],
        row: Ints,
        why: Flags | None = None,
    ) -> None:
        """Refuse what is beyond; `why` (n,) are the moves that draw the tool back."""
        for letter, (low, high), values in named:
            beyond = ((values < low - SAME) | (values > high + SAME)) & ~self.own[row]
            if beyond.any():
                at = int(np.argmax(beyond))
                message = f"{letter} would have to go to {values[at]:.3f}"
                if why is not None and why[at]:
                    message += " where the tool is drawn back to turn axes"
                hint = f"it goes from {low:g} to {high:g}"
                raise self.path.refuse("GX331", row[at : at + 1], message, hint)

    def _refuse(self, code: str, where: Flags, message: str, hint: str) -> None:
        rows = np.flatnonzero(where)
        if len(rows):
            raise self.path.refuse(code, rows, message, hint)
