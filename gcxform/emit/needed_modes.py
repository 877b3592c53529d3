"""What each piece has to state: what it needs beside what the control believes before it."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from gcxform.dialect.dialect import INCH
from gcxform.emit.fields import Feed, Role
from gcxform.emit.manner import Believed, Task
from gcxform.emit.pieces import Pieces
from gcxform.modal.columns import fill
from gcxform.modal.meaning.tables import GROUPS, NUMBER, TAP, THREAD
from gcxform.system.arrays import Flags, Floats, Ints, Small
from gcxform.system.distinct import one_of
from gcxform.toolpath.path import FeedMode, Form, Kind
from gcxform.toolpath.still_axes import turns_only
from gcxform.values import dataclass

NOTHING = np.int8(-1)


@dataclass(frozen=True, slots=True)
class Motions:
    """Motion codes to be stated (pieces,), -1 for none, and those in force after each piece.

    silent    (pieces,) whether a motion code that moves nothing is left out
    thread    (pieces,) whether it is a move whose code and K stay as they stand
    repaired  (pieces,) whether something is stated that the source line did not state
    """

    code: Small
    after: Small
    silent: Flags
    thread: Flags
    repaired: Flags


@dataclass(frozen=True, slots=True)
class Feeds:
    """`Feed` of each piece (pieces,), the number to write, and the feed in force after it.

    unit_after  (pieces,) mm, of the unit in which `after` was written
    repaired    (pieces,) whether something is stated that the source line did not state
    """

    word: Small
    value: Floats
    after: Floats
    unit_after: Floats
    repaired: Flags


@dataclass(frozen=True, slots=True)
class Stated:
    """What pieces state: codes of modes (pieces,), -1 for none; motions and feeds.

    kind      (rows,) the kinds of rows as they are written
    repaired  (pieces,) whether something is stated that the source line did not state
    """

    kind: Small
    inch: Small
    incremental: Small
    absolute_centre: Small
    feed_mode: Small
    motion: Motions
    feed: Feeds
    repaired: Flags


def stated_by(task: Task, pieces: Pieces, kind: Small, believed: Believed) -> Stated:
    """Return what pieces have to state."""
    need, blocks = _Needs(task, pieces, kind, believed), task.path.blocks
    moves, arcs = pieces.has_row, pieces.of_rows(kind >= Kind.ARC_CW, False)
    inch, other_unit = need.mode("units", blocks.inch, believed.inch, moves)
    steps, other_steps = need.mode("distance", blocks.incremental, believed.incremental, moves)
    centre, other_centre = need.mode(
        "arc-distance", blocks.absolute_centre, believed.absolute_centre, arcs
    )
    feed_mode, other_mode = need.feed_mode()
    motion, feed = need.motion(), need.feed(inch, feed_mode)
    repaired = other_unit | other_steps | other_centre | other_mode
    repaired = repaired | motion.repaired | feed.repaired
    return Stated(kind, inch, steps, centre, feed_mode, motion, feed, repaired)


@dataclass(frozen=True)
class _Needs:
    """The comparison of the pieces of a window with what the control believes."""

    task: Task
    pieces: Pieces
    kind: Small
    believed: Believed

    @cached_property
    def _other_mode(self) -> Flags:
        """Whether the line of a piece (pieces,) has another feed mode than in the source."""
        blocks, before = self.task.path.blocks, self.task.read.modes.feed_mode
        return np.asarray((blocks.feed_mode != before)[self.pieces.line])

    @cached_property
    def _feeding(self) -> Flags:
        """Whether a piece (pieces,) moves at the feed of the feed mode."""
        paced = one_of(self.task.read.modes.motion, (THREAD, TAP))
        cuts = self.pieces.of_rows(self.kind != Kind.RAPID, False) & ~self._in_step
        return cuts & ~paced[self.pieces.line]

    @cached_property
    def _in_step(self) -> Flags:
        """Whether a piece (pieces,) is a tap that another code says."""
        return np.asarray(self.pieces.tap_code >= 0)

    def _stated_in(self, group: str) -> Flags:
        """Return, per piece, whether its line has a code of a group."""
        explicit = self.task.table.groups[:, GROUPS.index(group)] >= 0
        return np.asarray(explicit[self.task.shape][self.pieces.line])

    def mode(
        self, group: str, wanted: Flags | Small, before: int, needs: Flags
    ) -> tuple[Small, Flags]:
        """Return the values of a mode that have to be stated, and where the source does not."""
        explicit = self._stated_in(group) & self.pieces.leads
        here = wanted[self.pieces.line].astype(np.int8)
        if not explicit.any() and (here == before).all():
            return np.broadcast_to(NOTHING, here.shape), np.broadcast_to(False, here.shape)
        held = self._held(np.where(explicit | needs, here, NOTHING), group, before)
        missing = needs & (held != here) & ~explicit
        return np.where(explicit | missing, here, NOTHING), missing

    def _held(self, sets: Small, group: str, before: int) -> Small:
        """Return what holds before each piece, given what each sets (-1: nothing)."""
        resets = self.task.manner.target.program_rule.resets_at_end
        if group in resets:
            over = self.task.table.flag("ends", self.task.shape)
            ends = over[self.pieces.line] & self.pieces.ends
            sets = np.where(ends, np.int8(NUMBER[resets[group]]), sets)
        held = fill(sets, sets >= 0, before)
        return np.append(np.int8(before), held[:-1])[: len(sets)]

    def feed_mode(self) -> tuple[Small, Flags]:
        """State a feed mode where the source stated one, and where the feed mode changes.

        Feed moves need theirs. So do blocks after which something else than this program may run,
        which shall find the control as the source leaves it.
        """
        blocks, pieces = self.task.path.blocks, self.pieces
        needs = self._feeding | (blocks.leaves[pieces.line] & pieces.ends)
        before = self.believed.feed_mode
        stated, missing = self.mode("feed-mode", blocks.feed_mode, before, needs)
        return stated, missing | (self._other_mode & (stated >= 0))

    def motion(self) -> Motions:
        """State a motion code where the source stated one, and where the motion changes.

        Without a move it would need a feed: in another feed mode it waits for the next move.
        """
        pieces = self.pieces
        group = self.task.table.groups[self.task.shape, GROUPS.index("motion")]
        feeds = (group >= 1) & (group <= 3)
        silent = self._other_mode & ~pieces.has_row & feeds[pieces.line]
        said = pieces.leads & ~silent & (pieces.role != Role.GONE)
        sets = np.where(said, group[pieces.line], NOTHING)
        form = pieces.of_rows(self.task.path.form, Form.PLAIN)
        moves = pieces.has_row & one_of(form, (Form.PLAIN, Form.MACHINE, Form.BLIND))
        sets[moves] = pieces.of_rows(self.kind, NOTHING)[moves]
        sets[self._in_step] = TAP
        moves |= self._in_step
        after = fill(sets, sets >= 0, self.believed.motion)
        before = self._held(sets, "motion", self.believed.motion)
        explicit = self._stated_in("motion")
        alone = self.task.manner.target.block_rule.one_command
        changes = moves & ((before != after) | alone)
        code = np.where(moves & (explicit | changes), after, NOTHING)
        code = np.where(pieces.tap_code > TAP, pieces.tap_code, code)
        thread = pieces.has_row & ((form == Form.THREAD) | (form == Form.SYNCHRONISED))
        repaired = silent | (changes & ~explicit)
        thread &= ~pieces.special & ~self._in_step
        return Motions(code, after, silent, thread, repaired)

    def feed(self, inch: Small, feed_mode: Small) -> Feeds:
        """State a feed where the source stated one, where it changes, and always in G93.

        What counts is the number that a piece needs after F: a length per minute in the unit of its
        block, or degrees per minute or 1/min, which have no unit.
        """
        modes, path, pieces = self.task.read.modes, self.task.path, self.pieces
        slot = self.task.table.slots[self.task.shape, ord("F") - 65]
        word = (slot >= 0)[pieces.line] & pieces.leads & ~pieces.expanded_line[pieces.line]
        inverse = path.blocks.feed_mode == FeedMode.INVERSE_TIME
        unit_here = np.where(self._inch_for_feed(inch), INCH, 1.0)
        plain = turns_only(path) & (self.kind < Kind.ARC_CW)
        timed = inverse[pieces.line]
        has_unit = pieces.of_rows(~plain, True) & ~timed
        unit = np.where(has_unit, unit_here, 1.0)
        given = modes.feed * np.where(inverse, 1.0, modes.feed_unit)
        given = given[pieces.line] / np.where(timed, 1.0, unit_here)
        need = np.where(word & ~self._other_mode, given, np.nan)
        need = np.where(self._feeding, pieces.of_rows(path.feed, np.nan) / unit, need)
        cycles = pieces.tap_code > TAP  # whose F stays in force
        need = np.where(cycles, pieces.pace / unit_here, need)
        unknown = word & np.isnan(given)  # only the machine knows it
        lost = self._feed_lost(inch, feed_mode) | unknown
        sets = ~np.isnan(need) | lost
        after = fill(need, sets, self.believed.feed)
        unit_after = fill(unit_here, sets, self.believed.feed_unit)
        number = np.append(self.believed.feed, after[:-1])[: len(need)]
        size = np.append(self.believed.feed_unit, unit_after[:-1])[: len(need)]
        held = np.where(has_unit, number * size / unit_here, number)
        held = np.where(lost, np.nan, held)
        changes = self._feeding & (~_close(held, need) | timed)
        kept = word & _close(need, modes.feed[pieces.line]) & self._reads_alike(slot)
        kept |= unknown
        written = ~kept & ~np.isnan(need) & (word | changes)
        which = np.where(kept, Feed.KEEP, np.where(written, Feed.WRITE, Feed.NONE)).astype(np.int8)
        which[self._in_step] = Feed.PITCH
        which[cycles] = Feed.WRITE
        need = np.where(self._in_step, pieces.pace / unit_here, need)
        return Feeds(which, need, after, unit_after, written | (word & ~kept))

    def _reads_alike(self, slot: Ints) -> Flags:
        """Return, per piece, whether its feed word is the same number to the target.

        It is not where a point decides on the unit, to the target or in the word as it stands: in
        another feed mode 1 without a point counts something else.
        """
        manner, task, line = self.task.manner, self.task, self.pieces.line
        if not (slot >= 0).any():
            return np.ones(len(line), np.bool_)
        if not manner.crossing and manner.source.point_rule.required and self._other_mode.any():
            number = np.where(slot >= 0, task.window.first_number[: len(slot)] + slot, 0)
            pointed = (slot < 0) | (task.window.decimals[number] >= 0)
            return np.asarray(~self._other_mode | pointed[line])
        if not (manner.crossing and manner.source.point_rule.required):
            keeps = not (manner.crossing and manner.target.point_rule.required)
            return np.full(len(line), keeps)
        number = np.where(slot >= 0, task.window.first_number[: len(slot)] + slot, 0)
        alike = _close(task.window.value[number], task.read.modes.feed)
        return np.asarray(alike & (not manner.target.point_rule.required))[line]

    def _feed_lost(self, inch: Small, feed_mode: Small) -> Flags:
        """Return the pieces at which the target forgets the feed."""
        target = self.task.manner.target
        stated = feed_mode >= 0
        lost = stated
        if not target.feed_rule.mode_clears and stated.any():
            held = self._held(feed_mode, "feed-mode", self.believed.feed_mode)
            lost = stated & (feed_mode != held)
        if target.feed_rule.change_clears:
            now = fill(inch, inch >= 0, self.believed.inch)
            lost = lost | (np.append(np.int8(self.believed.inch), now[:-1])[: len(now)] != now)
        return np.asarray(lost)

    def _inch_for_feed(self, inch: Small) -> Flags:
        """Return, per piece, whether the control reads its feed in inches."""
        after = fill(inch, inch >= 0, self.believed.inch) == 1
        if not self.task.manner.target.feed_rule.before_units:
            return np.asarray(after)
        return np.append(self.believed.inch == 1, after[:-1])[: len(after)]


def _close(a: Floats, b: Floats) -> Flags:
    return np.asarray(np.abs(a - b) <= 1e-9 * np.abs(b))
