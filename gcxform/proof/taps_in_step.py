"""The proof of taps in step with the spindle by another code: G33.1 for G84 and G74, or back.

    F, n    feed of a way in or out of the source, mm/min; speed of the spindle, 1/min, as read from
            the output
    K, d    way for each turn as read from the output, mm; half of its last decimal

Claimed of every such row: its written row is fed per turn, |K - F / n| <= d, or |K - F| <= d where
F is a way for each turn (G95); the spindle turns there by M3 for G84 and M4 for G74, and the tap of
the source does not wait. Where the ends are is proved as of all rows; what a cycle does between its
moves is that of the code: G33.1 goes in as the spindle turns, and back as it is reversed.

Where a cycle stands for G33.1, the written F is |F - K n| <= e F, e = PITCH_ERROR, or K in G95; it
is G84 where M3 turns the spindle, G74 where M4 does. Its moves that go nowhere are left out, and so
are M29 before it and S beside that, if it is the speed in force.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from gcxform.contract.passes import PassContext
from gcxform.dialect.code_translation import RIGID
from gcxform.dialect.codes import Effect
from gcxform.dialect.dialect import INCH
from gcxform.modal.interpreter import Interpreted
from gcxform.proof.feeds import Wrong
from gcxform.proof.trace import Trace
from gcxform.system.arrays import Flags, Floats, Ints
from gcxform.toolpath.path import Event, FeedMode, Form, Toolpath

SENSE = {84: 1, 74: 2}
"""The number of M3 and M4 among the modes of the spindle."""
ROUNDED = 0.501  # of the last decimal
PITCH_ERROR = 1.5e-4  # relative; what the rounding of F may change
STILL = 1e-6  # mm; sums of steps end in other bits than what is written for them


class TapProof:
    """Follows the spindle of an output, window by window."""

    def __init__(self, context: PassContext) -> None:
        self.context = context
        self.says = context.saying.taps_in_step
        self.by_cycles = context.saying.taps_as_cycles
        self.speed = np.nan

    def rows(self, read: Interpreted) -> Flags:
        """Return which rows of the source are ways in and out of such taps (n,)."""
        path = read.path
        tied = path.form == Form.SYNCHRONISED
        if self.by_cycles:
            return np.asarray(tied)
        cycle = read.modes.cycle[path.block]
        return np.asarray(tied & ((cycle == 84) | (cycle == 74)) & self.says)

    def of_cycles(self, back: Interpreted) -> Interpreted:
        """Return what was read from the output without what its cycles do besides a tap."""
        path = back.path
        tied = path.form == Form.SYNCHRONISED
        if not self.by_cycles or not tied.any():
            return back
        path = path.replace(events=tuple(self._without_rigid(path)))
        path = self.without_inner(path, tied)
        lines = np.isin(path.block, path.block[tied])
        stays = (np.abs(path.end - path.start) <= STILL).all(axis=1)
        still = lines & (path.form == Form.CYCLE) & stays
        path = path.with_rows((~still).astype(np.int64))
        begins = np.append(True, path.block[1:] != path.block[:-1])
        at = np.arange(len(path))
        nth = at - np.maximum.accumulate(np.where(begins, at, 0))
        return replace(back, path=path.replace(nth=nth))

    def _without_rigid(self, path: Toolpath) -> Iterator[Event]:
        """Yield events without those that make a tap rigid, at the speed in force."""
        codes, speed = self.context.target.m_codes, self.speed
        rigid = {f"M{n}" for n, code in codes.items() if code.group == RIGID}
        lines = {event.line for event in path.events if event.what in rigid}
        for event in path.events:
            said = dict(event.values).get("S") if event.what == "S" else None
            if event.what in rigid or (event.line in lines and said == speed):
                continue
            speed = speed if said is None else said
            yield event

    def without_inner(self, path: Toolpath, rows: Flags) -> Toolpath:
        """Return a path without what such cycles do between their moves."""
        if not rows.any():
            return path
        lines = {*path.source[rows].tolist()}
        kept = tuple(e for e in path.events if not (e.within and e.line in lines))
        return path.replace(events=kept)

    def wrong(
        self, read: Interpreted, back: Interpreted, rows: Flags, trace: Trace
    ) -> Iterator[Wrong]:
        """Yield the taps that are other ones in the output."""
        if not (self.says or self.by_cycles):
            return
        speeds = self._speeds(back.path)
        if not rows.any():
            return
        written, owner = back.path, trace.written_owner
        mine = np.flatnonzero(rows[owner])
        old, line = trace.before, written.block[mine]
        feed, mode = old.feed[owner[mine]], old.feed_mode[owner[mine]]
        if self.by_cycles:
            off = self._other_feed(written, mine, feed, speeds[mine])
            cycle = back.modes.cycle[line]
        else:
            wanted = np.where(mode == FeedMode.PER_TURN, feed, feed / speeds[mine])
            timed = (written.feed_mode[mine] != FeedMode.PER_TURN) | (mode == FeedMode.INVERSE_TIME)
            off = timed | ~(np.abs(written.feed[mine] - wanted) <= self._slack(written, mine))
            cycle = read.modes.cycle[old.block[owner[mine]]]
        sense = np.where(cycle == 84, SENSE[84], SENSE[74])
        other = back.modes.spindle[line] != sense
        for which, what in ((off, "a tap has another pitch"), (other, "a tap of another hand")):
            for row in mine[which][:1].tolist():
                output = int(written.source[row])
                yield Wrong(what, trace.line_of(output), output)
        for event in old.events:
            if event.within and event.what == "DWELL" and rows[event.row - 1] and _waits(event):
                yield Wrong("a tap does not wait any more", event.line)

    def _other_feed(self, written: Toolpath, mine: Ints, pitch: Floats, speed: Floats) -> Flags:
        """Return which feeds of cycles are not those of a pitch (mm) at a speed (1/min)."""
        mode, feed = written.feed_mode[mine], written.feed[mine]
        wanted = np.where(mode == FeedMode.PER_TURN, pitch, pitch * speed)
        known = mode != FeedMode.INVERSE_TIME
        return np.asarray(~(known & (np.abs(feed - wanted) <= PITCH_ERROR * feed)))

    def _slack(self, written: Toolpath, mine: Ints) -> Floats:
        """Return half of the last decimal of K, in mm."""
        context, inch = self.context, written.blocks.inch[written.block[mine]]
        usual = (context.numbers.mm, context.numbers.inch)
        mm, inches = (10.0 ** -context.decimals.get("K", each) for each in usual)
        return np.where(inch, inches * INCH, mm) * ROUNDED

    def _speeds(self, path: Toolpath) -> Floats:
        """Return the speed of the spindle at each row (n,) 1/min; nan where that is not known."""
        found, at = np.full(len(path), np.nan), 0
        for event in path.events:
            if event.row > at:
                found[at : event.row] = self.speed
                at = event.row
            self.speed = self._behind(event)
        found[at:] = self.speed
        return found

    def _behind(self, event: Event) -> float:
        """Return the speed behind an event: that of S, until something else may have set it."""
        if event.what == "S":
            return dict(event.values).get("S", np.nan)  # only the machine knows it
        target = self.context.target
        if event.what[0] == "M" and event.what[1:].isdigit():
            m_code = target.m_codes.get(int(event.what[1:]), target.block_rule.unknown_m)
            return self.speed if m_code and not m_code.loses_position else np.nan
        code = target.codes.get(event.what)
        kept = code is None or code.effect not in (Effect.CALL, Effect.BARRIER)
        return self.speed if kept and event.what != "G96" else np.nan


def _waits(event: Event) -> bool:
    return dict(event.values).get("seconds", 0.0) > 0
