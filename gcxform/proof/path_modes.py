"""Proves in which path mode each move is made: G61 ends moves exactly, G64 rounds corners.

Where a control ends the moves of canned cycles exactly whatever is stated
(`MotionRule.cycles_stop`), moves that stand for one under G64 have to be in G61, and all others in
the mode of the source. What was added for that is taken out of the events, and is nothing but a
pair around each such block.

    M(k)  mode in force in row k of the source, with its words in mm;  N(i)  in written row i
    k(i)  the row that i stands for;  expanded  i is a plain move of a line that calls a cycle

Claimed: N(i) = G61 where i is expanded and M(k(i)) = G64, else N(i) = M(k(i)); and at the end of
each window both files have left the same mode.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence

import numpy as np

from gcxform.contract.passes import PassContext
from gcxform.modal.interpreter import Interpreted
from gcxform.modal.state import CYCLE_OFF
from gcxform.proof.inventory import Wrong
from gcxform.proof.trace import Trace
from gcxform.system.arrays import Flags, Ints
from gcxform.toolpath.path import Event, Form
from gcxform.toolpath.travel import ways

Stated = tuple[str, tuple[tuple[str, float], ...]]
"""A path mode and its words, in mm; nothing where none has been stated."""
EXACT: Stated = ("G61", ())


class PathModes:
    """Follows the path modes of a source and of what was written for it, window by window.

    `added` is how many blocks with a path mode the output has that the source has not.
    """

    def __init__(self, context: PassContext) -> None:
        source = context.source
        self.looks = source is context.target and source.motion_rule.cycles_stop
        self.coded = {code for code, what in source.codes.items() if what.group == "path"}
        self.source: Stated = ("", ())
        self.output: Stated = ("", ())
        self.added = 0

    def check(
        self,
        old: Sequence[Event],
        new: Sequence[Event],
        trace: Trace,
        read: Interpreted,
        budget: float,
    ) -> tuple[tuple[Event, ...], Wrong | None]:
        """Return the events of the output without what was added, and what is wrong, if anything.

        `old` and `new` are the events of the source and of the output, their lengths in mm;
        `budget` (mm): moves no longer may be left out.
        """
        if not self.looks:
            return tuple(new), None
        expanded, owner = self._expanded(trace, read), trace.written_owner
        before = self._modes(old, self.source)
        after = self._modes(new, self.output)
        was = np.searchsorted(_rows(old, self.coded), owner, "right")
        now = np.searchsorted(_rows(new, self.coded), np.arange(len(owner)), "right")
        blends = np.array([mode[0] == "G64" for mode in before], np.bool_)[was]
        wrong = self._at_rows((before, was, expanded & blends), (after, now), trace)
        wrong = wrong or self._joined(trace, read, blends, budget)
        self.source, self.output = before[-1], after[-1]
        if wrong is None and self.source != self.output:
            wrong = (
                f"{_said(self.source)} is left as {_said(self.output)}",
                int(trace.source[-1]),
                0,
            )
        kept, pairs = self._without_added(old, new, trace, read)
        return kept, wrong or self._pairs(pairs)

    def _modes(self, events: Sequence[Event], before: Stated) -> list[Stated]:
        return [before, *((e.what, e.values) for e in events if e.what in self.coded)]

    def _expanded(self, trace: Trace, read: Interpreted) -> Flags:
        """Return, per move of the output, whether it stands for a move of a cycle, and is plain."""
        line = trace.source[trace.written.source - trace.first] - read.path.blocks.first
        cycles = read.modes.cycle[line] != CYCLE_OFF
        return np.asarray(cycles & (trace.written.form == Form.PLAIN))

    @staticmethod
    def _at_rows(
        wanted: tuple[list[Stated], Ints, Flags], found: tuple[list[Stated], Ints], trace: Trace
    ) -> Wrong | None:
        """Return the first move that is made in another path mode than it should be.

        Modes are given with which of them holds in each row; where a flag is set it is `EXACT`.
        """
        before, was, exactly = wanted
        after, now = found
        number = {mode: k for k, mode in enumerate(dict.fromkeys([EXACT, *before, *after]))}
        one = np.array([number[mode] for mode in before])[was]
        other = np.array([number[mode] for mode in after])[now]
        rows = np.flatnonzero(np.where(exactly, number[EXACT], one) != other)
        if not len(rows):
            return None
        row = int(rows[0])
        output = int(trace.written.source[row])
        mode = EXACT if exactly[row] else before[was[row]]
        message = f"a move in {_said(mode)} is made in {_said(after[now[row]])}"
        return message, trace.line_of(output), output

    @staticmethod
    def _joined(trace: Trace, read: Interpreted, blends: Flags, budget: float) -> Wrong | None:
        """Return a move under G64 that stands for moves of a cycle and for others."""
        block = trace.before.source - read.path.blocks.first
        cycles = read.modes.cycle[block] != CYCLE_OFF
        owner, through = trace.written_owner, trace.through
        apart = (cycles[owner] != cycles[through]) & blends
        for row in np.flatnonzero(apart).tolist():
            rows = np.arange(owner[row], through[row] + 1)
            if ways(trace.before, rows[cycles[rows] != cycles[owner[row]]]).sum() > budget:
                output = int(trace.written.source[row])
                message = "a move stands for one of a cycle, which ends exactly, and for another"
                return message, trace.line_of(output), output
        return None

    def _without_added(
        self, old: Sequence[Event], new: Sequence[Event], trace: Trace, read: Interpreted
    ) -> tuple[tuple[Event, ...], Mapping[int, list[Event]]]:
        """Return the events of the output without path modes that blocks of cycles got, and these.

        They are by the line of the source; what states a path mode itself keeps it.
        """
        first = read.path.blocks.first
        own = {event.line for event in old if event.what in self.coded}
        kept: list[Event] = []
        pairs: dict[int, list[Event]] = defaultdict(list)
        for event in new:
            line = trace.line_of(event.line)
            cycle = read.modes.cycle[line - first] != CYCLE_OFF
            if event.what in self.coded and cycle and line not in own:
                pairs[line].append(event)
            else:
                kept.append(event)
        self.added += sum(map(len, pairs.values()))
        return tuple(kept), pairs

    @staticmethod
    def _pairs(pairs: Mapping[int, list[Event]]) -> Wrong | None:
        """Return the first block with anything but a pair around it."""
        for line, events in pairs.items():
            names = [event.what for event in events]
            if names != ["G61", "G64"]:
                return f"{' '.join(names)} around a cycle", line, events[0].line
        return None


def _rows(events: Sequence[Event], coded: set[str]) -> Ints:
    """Return before which rows path modes are stated."""
    return np.array([event.row for event in events if event.what in coded], np.int64)


def _said(mode: Stated) -> str:
    words = (f"{address}{value:g}" for address, value in mode[1])
    return " ".join([mode[0] or "no path mode", *words])
