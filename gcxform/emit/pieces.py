"""Lines become pieces: one for each row of the path, one for each block that does not move.

For every piece it is settled here which codes and which feed have to be stated, by comparing what
the piece needs with what the control believes before it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from gcxform.dialect.dialect import INCH
from gcxform.emit.fields import Feed, Role
from gcxform.emit.manner import Believed, Task
from gcxform.emit.tapping import Taps
from gcxform.modal.columns import fill
from gcxform.modal.meaning.tables import GROUPS, NUMBER, TAP, THREAD
from gcxform.modal.moves.moves import turns_only
from gcxform.modal.state import CYCLE_OFF
from gcxform.system.arrays import Flags, Floats, Ints, Small
from gcxform.toolpath.path import Event, FeedMode, Form, Given, Kind

NOTHING = np.int8(-1)
Around = Callable[[Flags], tuple[list[Event], list[Event]]]
"""What stands before and behind the moves of lines whose cycles are expanded."""
PLACES = (Form.HOME, Form.MACHINE)
"""Forms whose axis words may be converted where they stand."""


class Pieces:
    """The pieces of a window, in order.

    line      (pieces,) line of the window
    row       (pieces,) row of the path; only where `has_row`
    role      (pieces,) `Role`
    leads     (pieces,) whether it is the first piece of its line
    motion, inch, incremental, absolute_centre, feed_mode
              (pieces,) code to be stated, -1 for none
    silent    (pieces,) whether a motion code that moves nothing is left out
    thread    (pieces,) whether it is a move whose code and K stay as they stand
    tap       (pieces,) whether it is a canned cycle whose ends have moved; `apart`: one of several
              into which its repeats are taken apart
    feed      (pieces,) `Feed`; `feed_value` is the number to write
    special   (pieces,) whether it stands for all moves of a block that is written as it stands
    converted (pieces,) whether such a block, to a place of the machine, is written in another unit
    event     (pieces,) index into `events`, one of each kind, -1 for none: what a cycle does
              between its moves, blocks that the user gives, of which some are moves, and path
              modes around expanded cycles; what stands before one does not lead its line
    repaired  (pieces,) whether something is stated that the source line did not state
    """

    def __init__(
        self, task: Task, kind: Small, believed: Believed, taps: Taps, around: Around
    ) -> None:
        self.task = task
        self.around = around
        self.taps = taps
        self.kind = kind
        self.believed = believed
        self._lay_out()
        self.repaired = np.zeros(len(self.line), np.bool_)
        blocks = task.path.blocks
        self.inch = self._mode("units", blocks.inch, believed.inch, self.has_row)
        self.incremental = self._mode(
            "distance", blocks.incremental, believed.incremental, self.has_row
        )
        arcs = self.of_rows(kind >= Kind.ARC_CW, False)
        self.absolute_centre = self._mode(
            "arc-distance", blocks.absolute_centre, believed.absolute_centre, arcs
        )
        self._feed_modes()
        self._motions()
        self._feeds()

    def _lay_out(self) -> None:
        path, live = self.task.path, self.task.read.live
        self.count = np.bincount(path.block, minlength=live)
        special = np.zeros(live, np.bool_)
        moves = np.array([given.row for given in path.given if given.moves], np.int64)
        own = ~path.is_free
        own[moves] = False
        special[path.block[own]] = True
        special &= ~self.taps.lines
        drilling = self.task.read.modes.cycle != CYCLE_OFF
        self.expanded_line = drilling & ~special & ~self.taps.lines & self.task.manner.expands
        first, expanded = path.blocks.first, self.expanded_line.tolist()
        inner = [e for e in path.events if e.within and expanded[e.line - first]]
        opens, closes = self.around(self.expanded_line)
        still = (given for given in path.given if not given.moves)
        between: list[Event | Given] = [*opens, *inner, *still, *closes]
        said = [*between, *(given for given in path.given if given.moves)]
        self.events = list({_said(each): each for each in reversed(said)}.values())
        number = {_said(each): n for n, each in enumerate(self.events)}
        pieces = np.where(special, 1, np.maximum(self.count, 1))
        pieces = np.where(self.taps.lines, self.taps.count, pieces)
        self.line = np.repeat(np.arange(live), pieces)
        nth = np.arange(len(self.line)) - (np.cumsum(pieces) - pieces)[self.line]
        self.row = (np.cumsum(self.count) - self.count)[self.line] + nth
        self.row[self.taps.lines[self.line]] = self.taps.rows
        self.event = np.full(len(self.line), -1)
        if between:
            self._put_between(between, [number[_said(each)] for each in between])
        self.has_row = (self.count[self.line] > 0) & (self.event < 0)
        for given in (given for given in path.given if given.moves):
            self.event[self.has_row & (self.row == given.row)] = number[_said(given)]
        self.shape = self.task.shape[self.line]
        self._moving = np.flatnonzero(self.has_row)
        self._rows = self.row[self._moving]
        self.opens = self._first_of(self.line)
        self.opens &= np.isin(self.event, [number[_said(each)] for each in opens[:1]])
        self.closes = self._first_of(self.line[::-1])[::-1]
        closing = {number[_said(each)] for each in closes}
        self.closes = self.closes & np.isin(self.event, list(closing))
        self._give_roles(special)

    def _put_between(self, inner: Sequence[Event | Given], which: list[int]) -> None:
        """Give what is done between the moves of a block pieces of their own."""
        line = np.array([e.line - self.task.path.blocks.first for e in inner], np.int64)
        before = np.array([2 * e.row for e in inner], np.int64)
        all_lines = np.concatenate([self.line, line])
        order = np.lexsort((np.concatenate([2 * self.row + 1, before]), all_lines))
        nothing = np.zeros(len(line), np.int64)
        self.line, self.row = all_lines[order], np.concatenate([self.row, nothing])[order]
        self.event = np.concatenate([self.event, np.array(which, np.int64)])[order]

    @staticmethod
    def _first_of(line: Ints) -> Flags:
        """Return which pieces have another line than the one before."""
        return np.append(True, line[1:] != line[:-1])[: len(line)]

    def _give_roles(self, special: Flags) -> None:
        first, self.ends = self._first_of(self.line), self._first_of(self.line[::-1])[::-1]
        self.leads = (first & ~self.opens) | np.roll(self.opens, 1)
        last = (self.ends & ~self.closes) | np.roll(self.closes, -1)
        role = np.where(self.has_row, np.int8(Role.MIDDLE), np.int8(Role.NONE))
        role[self.has_row & self.leads] = Role.FIRST
        role[self.has_row & last] = Role.LAST
        role[self.has_row & self.leads & last] = Role.ONLY
        self.special = special[self.line]
        self.converted = self._converted()
        cycle = self.task.read.modes.cycle[: len(special)] != CYCLE_OFF
        self.tap = (self.taps.lines & cycle)[self.line]
        self.apart = self.tap & (self.taps.count > 1)[self.line]
        if self.task.path.joined:
            role[self._gone()[self.line]] = Role.GONE
        role[self.special] = Role.VERBATIM
        role[self.event >= 0] = Role.EVENT
        self.role = role

    def _converted(self) -> Flags:
        """Return the pieces that lead home or to a place of the machine, in another unit."""
        path, now = self.task.path, self.task.path.blocks.inch
        places = self.of_rows(np.isin(path.form, PLACES), False)
        return np.asarray(
            places & self.special & (now != self.task.read.path.blocks.inch)[self.line]
        )

    def _gone(self) -> Flags:
        """Return the lines whose moves are parts of others', and in which nothing else happens."""
        gone = np.zeros(len(self.count), np.bool_)
        gone[self.task.read.path.block] = True
        gone &= ~self.task.table.flag("has_events", self.task.shape)
        return np.asarray(gone & (self.count == 0))

    def of_rows(self, values: NDArray, absent: object) -> NDArray:  # type: ignore[type-arg]
        """Return a column over the rows as one over the pieces."""
        if len(self._moving) == len(self.line):
            return np.asarray(values[self._rows])
        column = np.full(len(self.line), absent, values.dtype)
        column[self._moving] = values[self._rows]
        return column

    def repaired_in(self, lines: Ints) -> Flags:
        """Return which lines have something to be stated that the source does not state there."""
        repaired = np.zeros(len(self.count), np.bool_)
        repaired[self.line[self.repaired]] = True
        return np.asarray(repaired[lines])

    def _stated_in(self, group: str) -> Flags:
        """Return, per piece, whether its line has a code of a group and it is the piece for it."""
        explicit = self.task.table.groups[:, GROUPS.index(group)] >= 0
        return np.asarray(explicit[self.shape])

    def _mode(self, group: str, wanted: Flags | Small, before: int, needs: Flags) -> Small:
        """Return the values of a mode that have to be stated."""
        explicit = self._stated_in(group) & self.leads
        here = wanted[self.line].astype(np.int8)
        if not explicit.any() and (here == before).all():
            return np.broadcast_to(NOTHING, (len(self.line),))
        held = self._held(np.where(explicit | needs, here, NOTHING), group, before)
        missing = needs & (held != here) & ~explicit
        self.repaired |= missing
        return np.where(explicit | missing, here, NOTHING)

    def _held(self, sets: Small, group: str, before: int) -> Small:
        """Return what holds before each piece, given what each sets (-1: nothing)."""
        resets = self.task.manner.target.resets_at_end
        if group in resets:
            ends = self.task.table.flag("ends", self.task.shape)[self.line] & self.ends
            sets = np.where(ends, np.int8(NUMBER[resets[group]]), sets)
        held = fill(sets, sets >= 0, before)
        return np.append(np.int8(before), held[:-1])[: len(sets)]

    def _feed_modes(self) -> None:
        """State a feed mode where the source stated one, and where the feed mode changes.

        Feed moves need theirs. So do blocks after which something else than this program may run,
        which shall find the control as the source leaves it.
        """
        blocks = self.task.path.blocks
        wanted, before = blocks.feed_mode, self.task.read.modes.feed_mode
        paced = np.isin(self.task.read.modes.motion, (THREAD, TAP))
        self.feeding = self.of_rows(self.kind != Kind.RAPID, False) & ~paced[self.line]
        needs = self.feeding | (blocks.leaves[self.line] & self.ends)
        self.feed_mode = self._mode("feed-mode", wanted, self.believed.feed_mode, needs)
        self.other_mode = (wanted != before)[self.line]
        self.repaired |= self.other_mode & (self.feed_mode >= 0)

    def _motions(self) -> None:
        """State a motion code where the source stated one, and where the motion changes.

        Without a move it would need a feed: in another feed mode it waits for the next move.
        """
        group = self.task.table.groups[self.task.shape, GROUPS.index("motion")]
        feeds = (group >= 1) & (group <= 3)
        self.silent = self.other_mode & ~self.has_row & feeds[self.line]
        self.repaired |= self.silent
        said = self.leads & ~self.silent & (self.role != Role.GONE)
        sets = np.where(said, group[self.line], NOTHING)
        form = self.of_rows(self.task.path.form, Form.PLAIN)
        moves = self.has_row & ((form == Form.PLAIN) | (form == Form.MACHINE))
        sets[moves] = self.of_rows(self.kind, NOTHING)[moves]
        self.motion_after = fill(sets, sets >= 0, self.believed.motion)
        before = self._held(sets, "motion", self.believed.motion)
        explicit = self._stated_in("motion")
        changes = moves & (before != self.motion_after)
        self.repaired |= changes & ~explicit
        self.motion = np.where(moves & (explicit | changes), self.motion_after, NOTHING)
        self.thread = self.has_row & ((form == Form.THREAD) | (form == Form.SYNCHRONISED))
        self.thread &= ~self.special

    def _feeds(self) -> None:
        """State a feed where the source stated one, where it changes, and always in G93.

        What counts is the number that a piece needs after F: a length per minute in the unit of its
        block, or degrees per minute or 1/min, which have no unit.
        """
        modes, path = self.task.read.modes, self.task.path
        slot = self.task.table.slots[self.task.shape, ord("F") - 65]
        word = (slot >= 0)[self.line] & self.leads & ~self.expanded_line[self.line]
        feeding = self.feeding
        inverse = path.blocks.feed_mode == FeedMode.INVERSE_TIME
        unit_here = np.where(self._inch_for_feed(), INCH, 1.0)
        plain = turns_only(path) & (self.kind < Kind.ARC_CW)
        timed = inverse[self.line]
        has_unit = self.of_rows(~plain, True) & ~timed
        unit = np.where(has_unit, unit_here, 1.0)
        given = modes.feed * np.where(inverse, 1.0, modes.feed_unit)
        given = given[self.line] / np.where(timed, 1.0, unit_here)
        need = np.where(word & ~self.other_mode, given, np.nan)
        need = np.where(feeding, self.of_rows(path.feed, np.nan) / unit, need)
        lost = self._feed_lost()
        sets = ~np.isnan(need) | lost
        self.feed_after = fill(need, sets, self.believed.feed)
        self.unit_after = fill(unit_here, sets, self.believed.feed_unit)
        number = np.append(self.believed.feed, self.feed_after[:-1])[: len(need)]
        size = np.append(self.believed.feed_unit, self.unit_after[:-1])[: len(need)]
        held = np.where(has_unit, number * size / unit_here, number)
        held = np.where(lost, np.nan, held)
        changes = feeding & (~_close(held, need) | timed)
        kept = word & _close(need, modes.feed[self.line]) & self._reads_alike(slot)
        self.feed = np.where(
            kept,
            Feed.KEEP,
            np.where(~np.isnan(need) & (word | changes), Feed.WRITE, Feed.NONE),
        ).astype(np.int8)
        self.repaired |= (self.feed == Feed.WRITE) | (word & (self.feed == Feed.NONE))
        self.feed_value = need

    def _reads_alike(self, slot: Ints) -> Flags:
        """Return, per piece, whether its feed word is the same number to the target.

        It is not where a point decides on the unit, to the target or in the word as it stands: in
        another feed mode 1 without a point counts something else.
        """
        manner, task = self.task.manner, self.task
        if not (slot >= 0).any():
            return np.ones(len(self.line), np.bool_)
        if not manner.crossing and manner.source.point_rule.required and self.other_mode.any():
            number = np.where(slot >= 0, task.window.first_number[: len(slot)] + slot, 0)
            pointed = (slot < 0) | (task.window.decimals[number] >= 0)
            return np.asarray(~self.other_mode | pointed[self.line])
        if not (manner.crossing and manner.source.point_rule.required):
            keeps = not (manner.crossing and manner.target.point_rule.required)
            return np.full(len(self.line), keeps)
        number = np.where(slot >= 0, task.window.first_number[: len(slot)] + slot, 0)
        alike = _close(task.window.value[number], task.read.modes.feed)
        return np.asarray(alike & (not manner.target.point_rule.required))[self.line]

    def _feed_lost(self) -> Flags:
        """Return the pieces at which the target forgets the feed."""
        target = self.task.manner.target
        stated = self.feed_mode >= 0
        lost = stated
        if not target.feed_rule.mode_clears and stated.any():
            held = self._held(self.feed_mode, "feed-mode", self.believed.feed_mode)
            lost = stated & (self.feed_mode != held)
        if target.feed_rule.change_clears:
            inch = fill(self.inch, self.inch >= 0, self.believed.inch)
            lost = lost | (np.append(np.int8(self.believed.inch), inch[:-1])[: len(inch)] != inch)
        return np.asarray(lost)

    def _inch_for_feed(self) -> Flags:
        """Return, per piece, whether the control reads its feed in inches."""
        after = fill(self.inch, self.inch >= 0, self.believed.inch) == 1
        if not self.task.manner.target.feed_rule.before_units:
            return np.asarray(after)
        return np.append(self.believed.inch == 1, after[:-1])[: len(after)]


def _said(each: Event | Given) -> tuple[object, ...]:
    """Return what is written for something between the moves."""
    return (each.text,) if isinstance(each, Given) else (each.what, each.values)


def _close(a: Floats, b: Floats) -> Flags:
    return np.asarray(np.abs(a - b) <= 1e-9 * np.abs(b))
