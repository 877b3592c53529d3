"""The proof of feeds: they are those of the source, or take the time those of the source do.

    F, L       feed and length of a row of the source: mm/min and mm, or 1/min in G93
    f_i, l_i   the same of its written moves i = 1 ... m; t_i = l_i / f_i, or 1 / f_i in G93
    e, u, b    TIME_ERROR, UNEVEN, and the budget: mm, or degrees where rotary axes turn alone

Claimed of every row that is no rapid, but for moves in which an axis is at its full speed:

    feed per minute     |f_i - F| <= SAME_FEED f_i
    G93                 |sum t_i - 1 / F| <= e / F
    G93 and converted   |t_i - s l_i| <= s (u l_i + 2 b),   s = sum t_i / sum l_i
    converted           l (1 - e) - m b <= F sum t_i <= L (1 + e) + m b   (F L for F in G93)

l and L are there the least and the largest of the ways as programmed and as written (an arc whose
ends are on two circles has two), and a row at full speed may be late by that. What F is worth are
the definitions of G93 and G94 in RS274/NGC (NISTIR 6556), 3.5.19. That pieces share the time of
their row as they share its way is derived from them: a control goes evenly along a block. Both ends
of a piece may be off by b, hence 2 b, and a chord is shorter than its arc, hence u.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field
from typing import NamedTuple

import numpy as np

from gcxform.contract.passes import PassContext
from gcxform.deviations.runs import SAME_FEED
from gcxform.dialect.dialect import LINEAR
from gcxform.modal.interpreter import Interpreted
from gcxform.proof.trace import Trace
from gcxform.system.arrays import Flags, Floats, Ints
from gcxform.system.distinct import distinct
from gcxform.toolpath.path import FeedMode, Kind
from gcxform.toolpath.still_axes import moves_linear, turns_only
from gcxform.toolpath.travel import Lengths, lengths
from gcxform.values import dataclass

TIME_ERROR = 1e-3  # relative: what the rounding of the feeds of pieces may change
UNEVEN = 0.25  # relative; a chord of a quarter of a circle is a tenth shorter than its arc


class Wrong(NamedTuple):
    """What is wrong, and where: a line of the source, and one of the output or 0; both from 0."""

    message: str
    line: int
    output_line: int = 0


@dataclass(frozen=True)
class FeedProof:
    """The feeds of one window, and what they may be.

    modes         the feed modes into which passes have converted feeds, in their order
    budget        mm by which the path may be off; `angle_budget`: degrees, of rotary axes
    tapped        (n,) rows of the source that have a proof of their own (`taps_in_step.py`)
    speeds        by axis: the top speed (mm/min, deg/min) and what rounding may add to a way (mm,
                  deg); at full speed a move may take longer than its feed says
    """

    trace: Trace
    modes: Sequence[FeedMode]
    budget: float
    angle_budget: float
    tapped: Flags
    speeds: Mapping[str, tuple[float, float]] = field(default_factory=dict)

    def wrong(self) -> Iterator[Wrong]:
        """Yield where feeds are not those of the source; in inverse time, the times must add up."""
        before, after, owner = self.trace.before, self.trace.after, self.trace.owner
        moving = (before.kind[owner] != Kind.RAPID) & ~self.tapped[owner]
        other = before.feed_mode[owner] != after.feed_mode
        meant = after.feed_mode == self.modes[-1] if self.modes else False
        strange = other & moving & ~np.asarray(meant)
        if strange.any():
            yield self._at("the feed mode has changed", int(np.argmax(strange)))
        if self.modes:
            yield from self._converted()
            moving &= ~self._may_be_converted(owner)
        inverse = after.feed_mode == FeedMode.INVERSE_TIME
        plain = moving & ~inverse
        off = np.abs(after.feed - before.feed[owner]) > SAME_FEED * np.abs(after.feed)
        off |= np.isnan(after.feed) != np.isnan(before.feed[owner])
        if (off & plain).any():
            yield self._at("the feed has changed", int(np.argmax(off & plain)))
        if (moving & inverse).any():
            yield from self._times()
        if self.modes or (moving & inverse).any():
            yield from self._paces()

    def turned_alone(self) -> Iterator[Wrong]:
        """Yield moves of rotary axes alone to which a linear axis was added, in feeds per minute.

        Where the control counts those along linear axes, the others are as fast as they can.
        """
        written, owner = self.trace.written, self.trace.written_owner
        alone = turns_only(self.trace.before)[owner] & (written.kind == Kind.LINE)
        if not alone.any():
            return
        if self.modes:
            alone &= ~self._may_be_converted(owner)
        alone &= (written.feed_mode != FeedMode.INVERSE_TIME) & moves_linear(written)
        if alone.any():
            row = int(written.source[np.argmax(alone)])
            message = "a linear axis moves where rotary ones turned alone, at another speed"
            yield Wrong(message, self.trace.line_of(row), row)

    def _times(self) -> Iterator[Wrong]:
        """Add up the times of the written moves, before the models cut them further."""
        written, owner = self.trace.written, self.trace.written_owner
        mine = written.feed_mode == FeedMode.INVERSE_TIME
        mine &= written.kind != Kind.RAPID
        if self.modes:
            mine &= ~self._may_be_converted(owner)
        time = np.bincount(owner[mine], 1 / written.feed[mine], len(self.trace.before))
        wanted = 1 / self.trace.before.feed
        slack = TIME_ERROR * wanted
        used = distinct(owner[mine])
        wrong = used[np.abs(time[used] - wanted[used]) > slack[used]]
        if len(wrong):
            line = int(self.trace.before.source[wrong[0]])
            yield Wrong("the time of a move in G93 has changed", line)

    def _paces(self) -> Iterator[Wrong]:
        """Check that the pieces of a move share its time as they share its way.

        The time of the whole says nothing of one short piece, whose feed might be any. The way is
        that of the text, or what the machine makes of it: a tip goes evenly while axes do not. Of
        axes that turn alone it is their angle.
        """
        off = self._uneven(lengths(self.trace.written))
        if off.any() and self.trace.after is not self.trace.written:
            off &= self._uneven(self._gone())
        turns = lengths(self.trace.before).turns[self.trace.written_owner]
        if turns.any():
            off = np.where(turns, self._uneven(self._turned()), off)
        if off.any():
            row = int(self.trace.written.source[np.argmax(off)])
            message = "a piece of a move is faster or slower than it"
            yield Wrong(message, self.trace.line_of(row), row)

    def _gone(self) -> Lengths:
        """Return how far the machine goes in each written move."""
        after, written = self.trace.after, self.trace.written
        nths = 1 + int(max(after.nth.max(), written.nth.max()))
        row = np.searchsorted(written.source * nths + written.nth, after.source * nths + after.nth)
        way, count = lengths(after), len(written)
        least, most = (
            np.bincount(row, size, count).astype(float) for size in (way.least, way.most)
        )
        turns = np.bincount(row, way.turns, count) == np.bincount(row, minlength=count)
        return Lengths(least, most, turns)

    def _turned(self) -> Lengths:
        """Return how far rotary axes turn in each written move.

        Where they turn alone in the source, it is they that share the time, although a correction
        of what they do to the tip moves linear axes as well.
        """
        written = self.trace.written
        rotary = [k for k, axis in enumerate(written.axes) if axis not in LINEAR]
        way = np.nan_to_num(written.end - written.start)[:, rotary]
        angle = np.sqrt((way**2).sum(axis=1))
        return Lengths(angle, angle, np.ones(len(written), np.bool_))

    def _uneven(self, way: Lengths) -> Flags:
        """Return which written moves do not take the share of the time that is their way's."""
        written, owner = self.trace.written, self.trace.written_owner
        mine, inverse = written.kind != Kind.RAPID, written.feed_mode == FeedMode.INVERSE_TIME
        mine &= inverse | (self._may_be_converted(owner) if self.modes else False)
        along = (way.least + way.most) / 2
        whole = self._sums(mine, along)[owner]
        slack = 2 * np.where(way.turns, self.angle_budget, self.budget)
        with np.errstate(divide="ignore", invalid="ignore"):
            time = np.where(inverse, 1.0, along) / written.feed
            free = mine & ~self._at_full_speed()
            slow = (self._sums(free, time) / self._sums(free, along))[owner]
            off = np.abs(time - slow * along) > slow * (UNEVEN * along + slack)
        return np.asarray(off & free & (whole > 0))

    def _at_full_speed(self) -> Flags:
        """Return the written rows in inverse time in which an axis is as fast as it can be."""
        written = self.trace.written
        if not self.speeds:
            return np.zeros(len(written), np.bool_)
        least = np.zeros(len(written))
        step = np.abs(written.end - written.start)
        for letter, (speed, rounding) in self.speeds.items():
            if letter in written.axes:
                way = step[:, written.axes.index(letter)] + rounding
                least = np.fmax(least, way / speed)
        timed = written.feed_mode == FeedMode.INVERSE_TIME
        return np.asarray(timed & (least * written.feed >= 1.0 - TIME_ERROR))

    def _may_be_converted(self, owner: Ints) -> Flags:
        """Return the rows whose feeds a pass may have converted, there and back if there are two.

        Passes leave what is in their mode; blocks after which another program may run keep theirs.
        """
        before = self.trace.before
        kept = before.blocks.leaves[before.block]
        if len(set(self.modes)) == 1:
            kept = kept | (before.feed_mode == self.modes[0])
        return np.asarray(~kept[owner])

    def _converted(self) -> Iterator[Wrong]:
        """Check converted feeds by time: at the old feed it is that of the way.

        The way may be measured as programmed or as written, and its pieces may be off by what the
        path may be off.
        """
        before, written, owner = self.trace.before, self.trace.written, self.trace.written_owner
        mine = (written.kind != Kind.RAPID) & self._may_be_converted(owner)
        if not mine.any():
            return
        rows, old, new = distinct(owner[mine]), lengths(before), lengths(written)
        inverse = written.feed_mode == FeedMode.INVERSE_TIME
        ways = np.where(inverse, 1.0, (new.least + new.most) / 2)
        time = self._sums(mine, ways / written.feed)[rows]
        full = mine & self._at_full_speed()
        timed = before.feed_mode[rows] == FeedMode.INVERSE_TIME
        way = (old.least + old.most)[rows] / 2
        implied = time * before.feed[rows] * np.where(timed, way, 1.0)
        pieces = self._sums(mine, np.ones(len(written)))[rows]
        slack = pieces * np.where(old.turns[rows], self.angle_budget, self.budget)
        least = np.minimum(old.least[rows], self._sums(mine, new.least)[rows])
        most = np.maximum(old.most[rows], self._sums(mine, new.most)[rows])
        low, high = least * (1 - TIME_ERROR) - slack, most * (1 + TIME_ERROR) + slack
        late = implied > high
        if full.any():
            late &= ~self._late_at_full_speed(mine, full, ways, new, old)[rows]
        off = rows[~(implied >= low) | late]
        if len(off):
            line = int(before.source[off[0]])
            yield Wrong("the time of a move is another after its feed was converted", line)

    def _late_at_full_speed(
        self,
        mine: Flags,
        full: Flags,
        ways: Floats,
        new: Lengths,
        old: Lengths,
    ) -> Flags:
        """Return the rows of the source that are late only by their pieces at full speed.

        The other pieces have no more than their share of the time.
        """
        free, before = mine & ~full, self.trace.before
        rest = self._sums(free, new.most)
        share = (1 + UNEVEN) * old.most * self._part(free, mine, new)
        with np.errstate(divide="ignore", invalid="ignore"):
            time = self._sums(free, ways / self.trace.written.feed) * before.feed
        slack = self._sums(free, np.ones(len(free)))
        slack *= np.where(old.turns, self.angle_budget, self.budget)
        most = np.maximum(share, rest) * (1 + TIME_ERROR) + slack
        return np.asarray((self._sums(full, new.most) > 0.0) & ~(time > most))

    def _part(self, free: Flags, mine: Flags, new: Lengths) -> Floats:
        """Return how much of the way of each row of the source is that of some written rows.

        It is the largest by what is written, by what the machine makes of it, and by angles.
        """
        ways = [new, self._turned()]
        if self.trace.after is not self.trace.written:
            ways.append(self._gone())
        with np.errstate(divide="ignore", invalid="ignore"):
            parts = [self._sums(free, way.most) / self._sums(mine, way.most) for way in ways]
        return np.asarray(np.nan_to_num(parts).max(axis=0))

    def _sums(self, mine: Flags, values: Floats) -> Floats:
        """Return the sums of values over the written rows `mine` of each row of the source."""
        return np.bincount(
            self.trace.written_owner[mine], values[mine], len(self.trace.before)
        ).astype(float)

    def left_behind(self, read: Interpreted, back: Interpreted) -> Iterator[Wrong]:
        """Yield where what may run after a block finds another feed mode than the source leaves."""
        first = read.path.blocks.first
        for line in np.flatnonzero(read.path.blocks.leaves).tolist():
            places = np.flatnonzero(self.trace.source == line + first)
            mode = back.modes.feed_mode[places[-1:]]
            if (mode != read.modes.feed_mode[line]).any():
                message = "another feed mode is left to what may run after this block"
                yield Wrong(message, line + first, int(places[-1]) + self.trace.first)

    def _at(self, message: str, row: int) -> Wrong:
        """Return what is wrong in a row of what the machine does."""
        output = int(self.trace.after.source[row])
        return Wrong(message, self.trace.line_of(output), output)


def speeds_of(context: PassContext) -> dict[str, tuple[float, float]]:
    """Return the top speeds that the machine file has, by axis, and the last decimals written."""
    numbers, found = context.numbers, {}
    for letter, axis in context.machine.axes.items() if context.machine else ():
        if axis.max_speed is not None:
            known = context.decimals.get(letter, numbers.mm if letter in LINEAR else numbers.angle)
            found[letter] = axis.max_speed, 10.0**-known
    return found
