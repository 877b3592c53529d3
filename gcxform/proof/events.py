"""The proof of events: what is done between the moves is that of the source, in its order.

Claimed, with e_1 ... e_n the events of the source and f_1 ... f_m those read from the output,
lengths in mm, without those that are folded or taken over by a pass: n = m, and for every j what
e_j and f_j do and their numbers are the same, but for those that set a zero from where the axes
stand (`gcxform/proof/zeros.py`), f_j is in a block of the line of e_j, and the written
row before which f_j stands is the one for the row before which e_j stands (`Trace.stand_before`);
rows no longer together than the budget may lie between.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import groupby

import numpy as np

from gcxform.contract.passes import PassContext
from gcxform.dialect.code_translation import HOME, MACHINE
from gcxform.dialect.codes import Effect
from gcxform.modal.interpreter import Interpreted
from gcxform.modal.meaning.meaning import FRAMING, PRESETS
from gcxform.modal.meaning.sorting import only_for_cycles
from gcxform.modal.moves.blind_moves import BY
from gcxform.proof.feeds import Wrong
from gcxform.proof.known_positions import in_mm
from gcxform.proof.trace import Trace
from gcxform.proof.zeros import zeros_differ
from gcxform.toolpath.path import Event, Form, Kind, Toolpath
from gcxform.values import dataclass

SPINDLE, COOLANT = frozenset({"S", "M3", "M4", "M5"}), frozenset({"M7", "M8", "M9"})
SWITCHED = SPINDLE | COOLANT
"""What spindle and coolant are told."""


def _machine_last(events: list[Event], machine: str, home: set[int]) -> list[Event]:
    """Return events in which a way home of these lines is said behind the others of its block."""
    for n in range(len(events) - 2, -1, -1):
        at, moves = n, events[n].what == machine and events[n].line in home
        while moves and at + 1 < len(events) and _beside(*events[at : at + 2]):
            events[at], events[at + 1] = events[at + 1], events[at]
            at += 1
    return events


def _beside(one: Event, other: Event) -> bool:
    """Whether two events are of one block, and before the same row, the other of a G code."""
    return (one.line, one.row) == (other.line, other.row) and other.what.startswith("G")


def _beside_switch(event: Event, one: Event, switches: frozenset[str]) -> bool:
    """Whether one event is of these, and of the block of another, before the same row."""
    return one.what in switches and (one.line, one.row) == (event.line, event.row)


@dataclass(frozen=True)
class EventProof:
    """What of the events has to be in the output too.

    folded    codes that set frames are not written
    switches  the M codes that a pass takes over from the control
    homes     the points of the machine are other ones, so that more or less is known behind them
    """

    context: PassContext
    folded: bool
    switches: frozenset[str]
    homes: bool = False

    def of_source(self, path: Toolpath) -> tuple[Event, ...]:
        """Return the events of the source without those that a pass has taken over."""
        told = tuple(event for event in self.told(path) if event.what not in self.switches)
        told = self._until_end(told)
        saying = self.context.saying
        told = self._without_feeds_in_machine(told, path) if saying.feeds_in_work else told
        if not (saying.crosses or saying.drop or saying.m_codes):
            return told
        told = self._without_bare_machine(told, path) if saying.crosses else told
        alone = {e.what for e in told if saying.lengthens(e.what)}
        alone |= {e.what for e in told if saying.ends_length_alone(e.what)}
        if alone:  # they have blocks of their own, before their lines
            told = tuple(sorted(told, key=lambda e: (e.line, e.what not in alone)))
        there = [self._as_there(event, path) for event in told if saying.instead(event.what)]
        codes = self.context.source.codes
        home = {e.line for e in told if e.what in codes and codes[e.what].act == HOME}
        return tuple(_machine_last(self._afterwards(there), saying.machine, home))

    def _afterwards(self, there: list[Event]) -> list[Event]:
        """Return events in which a code that the user has said acts last in its block, if it does.

        A block with a move has such a code behind its rows, and what came before them is not moved.
        """
        known = self.context.target.m_codes
        said = {int(name[1:]) for name in self.context.saying.m_codes.values()}
        late = {f"M{number}" for number in said if number in known and known[number].after}
        blocks = groupby(there, key=lambda event: (event.line, event.row))
        return [each for _, block in blocks for each in sorted(block, key=lambda e: e.what in late)]

    def _without_feeds_in_machine(
        self, told: tuple[Event, ...], path: Toolpath
    ) -> tuple[Event, ...]:
        """Return events without the codes of moves that the target makes in its work offset."""
        codes = self.context.source.codes
        fed = {*path.source[(path.form == Form.MACHINE) & (path.kind == Kind.LINE)].tolist()}
        machine = {name for name, code in codes.items() if code.act == MACHINE}
        return tuple(e for e in told if not (e.what in machine and e.line in fed))

    def _without_bare_machine(self, told: tuple[Event, ...], path: Toolpath) -> tuple[Event, ...]:
        """Return events without codes of the machine that move nothing: they name no axis."""
        codes = self.context.source.codes
        moved = {*path.source[path.form == Form.MACHINE].tolist()}
        machine = {name for name, code in codes.items() if code.act == MACHINE}
        return tuple(e for e in told if not (e.what in machine and e.line not in moved))

    def _until_end(self, told: tuple[Event, ...]) -> tuple[Event, ...]:
        """Return events without further ends behind one at which the target alone stops."""
        source, target = self.context.source, self.context.target
        if source.program_rule.stops_at_end or not target.program_rule.stops_at_end:
            return told
        ends = {f"M{number}" for number, code in source.m_codes.items() if code.ends}
        first = next((n for n, event in enumerate(told) if event.what in ends), len(told))
        return tuple(e for n, e in enumerate(told) if n <= first or e.what not in ends)

    def _as_there(self, event: Event, path: Toolpath) -> Event:
        """Return an event of the source as the target names it.

        A way home that names no axis has one row, for it goes over no point.
        """
        saying = self.context.saying
        code = self.context.source.codes.get(event.what)
        if code is not None and code.act == HOME:
            rows = np.flatnonzero(path.source == event.line)
            called = path.frames[path.frame[rows[0]]].called
            moves = saying.moves_home(event.what, len(rows) == 1, called)
            return replace(event, what=saying.machine, values=()) if moves else event
        words = saying.words_of(event.what, "".join(address for address, _ in event.values))
        said = saying.instead(event.what)
        values = tuple((a, value) for a, value in event.values if a in words)
        return replace(event, what=said, values=values)

    def told(self, path: Toolpath) -> tuple[Event, ...]:
        """Return the events of a path that the control is told: not those that are folded away."""
        source, target = self.context.source, self.context.target
        events = tuple(
            in_mm(event, path, source.tip_rule.unfollowed)
            for event in path.events
            if not only_for_cycles(event.what, source, target)
            and not (self.homes and event.what.startswith(BY))
        )
        if not self.folded:
            return events
        codes, folds = self.context.source.codes, self.context.saying.folds_value
        acts = [codes[e.what].act if e.what in codes else "" for e in events]
        told = [act not in FRAMING and not folds(act) for act in acts]
        return tuple(event for event, here in zip(events, told, strict=True) if here)

    def unset(self, path: Toolpath) -> int:
        """Return how many codes of a source leave a zero in the control, and are folded away."""
        codes = self.context.source.codes
        acts = (codes[event.what].act for event in path.events if event.what in codes)
        return sum(act in PRESETS & FRAMING for act in acts) if self.folded else 0

    def wrong_zeros(self, read: Interpreted, back: Interpreted, trace: Trace) -> Iterator[Wrong]:
        """Yield where a zero would be elsewhere; another control may know others of them."""
        if self.context.source is self.context.target and not (self.folded or self.homes):
            yield from zeros_differ(read.zeroed, back.zeroed, trace)

    def _values(self, event: Event) -> tuple[tuple[str, float], ...]:
        """Return the numbers of an event that are those of the source.

        Where a length is said for the number of a tool, the positions behind it show whether it is
        the same. Where a zero is set from where the axes stand the words of axes are others, if
        they stand elsewhere: the proof of zeros compares what they set, and here it is which axes
        there are.
        """
        if event.what == self.context.saying.length_said:
            return ()
        if event.what.endswith("DWELL"):
            return tuple((a, round(value, 9)) for a, value in event.values)
        code = self.context.source.codes.get(event.what)
        here = code is not None and code.effect is Effect.FRAME and self._counts(code.act, event)
        if not here or self.context.source is not self.context.target:
            return event.values
        axes = self.context.source.axes
        return tuple((a, 0.0 if a in axes else value) for a, value in event.values)

    def _counts(self, act: str, event: Event) -> bool:
        """Whether a code sets a zero from where the axes stand."""
        here = self.context.source.offset_rule.g10_l20 == "here"
        return act == "preset" or (act == "set-work" and here and ("L", 20.0) in event.values)

    def _frames_first(self, events: tuple[Event, ...]) -> tuple[Event, ...]:
        """Return events in which codes of coordinates stand before spindle and coolant beside them.

        And coolant before the spindle. Controls differ in what they do first. With no move between,
        none of them counts for another.
        """
        found: list[Event] = []
        for event in events:
            at, behind = len(found), SWITCHED if self._sets_frame(event) else frozenset[str]()
            behind = SPINDLE if event.what in COOLANT else behind
            while at and _beside_switch(event, found[at - 1], behind):
                at -= 1
            found.insert(at, event)
        return tuple(found)

    def _sets_frame(self, event: Event) -> bool:
        dialects = self.context.source, self.context.target
        codes = [dialect.codes.get(event.what) for dialect in dialects]
        moves = any(code is not None and code.act in (HOME, MACHINE) for code in codes)
        return not moves and any(code and code.effect is Effect.FRAME for code in codes)

    def wrong(
        self, old: tuple[Event, ...], new: tuple[Event, ...], trace: Trace, budget: float
    ) -> Iterator[Wrong]:
        """Yield where events are not the same, in order, at the same place between the moves."""
        saying = self.context.saying
        if any(saying.ends_length_alone(event.what) for event in old):  # first in its block
            new = tuple(sorted(new, key=lambda e: (e.line, not saying.ends_length_alone(e.what))))
        if saying.crosses:
            old, new = self._frames_first(old), self._frames_first(new)
        both = min(len(old), len(new))
        lines = trace.lines_of(np.array([event.line for event in new[:both]], np.int64))
        written = np.array([event.row for event in new[:both]], np.int64)
        rows = np.array([event.row for event in old[:both]], np.int64)
        stands = trace.stand_before(written, rows, budget)
        pairs = zip(old, new, lines.tolist(), stands.tolist(), strict=False)
        for before, after, line, stays in pairs:
            same = (before.what, before.line) == (after.what, line)
            same &= before.values == after.values or self._values(before) == self._values(after)
            if not same or not stays:
                message = f"{before.what} of the source became {after.what}, or moved"
                yield Wrong(message, before.line, after.line)
        if len(old) != len(new):
            rest = old[len(new) :] or new[len(old) :]
            line = rest[0].line if len(old) > len(new) else trace.line_of(rest[0].line)
            yield Wrong(f"{rest[0].what} is missing or too many", line)
