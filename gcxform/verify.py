"""The proof: what was written is read again, undone through the models, compared with the input.

The reader of the output is a new one that knows nothing of how the text was made. Each of its moves
is traced to a line of the input by the source map; the models of what the machine does with the
passes' output are applied in reverse order; what comes out must follow the input's path within the
budget, with the same kinds of moves, feeds and events.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from gcxform.contract import Pass, PassContext
from gcxform.diagnostics import Diagnostic, GcxformError, Location, VerificationError
from gcxform.dialect import INCH
from gcxform.modal.interpreter import Interpreted, Interpreter
from gcxform.modal.meaning import FRAMING
from gcxform.modal.reader import WindowReader
from gcxform.modal.sorting import only_for_cycles
from gcxform.modal.state import Reading
from gcxform.syntax.scan import Window
from gcxform.toolpath.path import WHOLE, Event, FeedMode, Kind, Toolpath
from gcxform.toolpath.runs import SAME_FEED, Runs, deviation_of_runs, runs_of
from gcxform.toolpath.travel import lengths, ways

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]


LENGTHS = frozenset("XYZUVWIJKR")
TIME_ERROR = 1e-3  # relative: what the rounding of the feeds of pieces may change


@dataclass(slots=True)
class Findings:
    """What the verification has found so far: counts, and the worst places.

    deviation   mm; `source_line` and `output_line` count from 1
    angle       degrees, of rotary axes
    """

    moves: int = 0
    events: int = 0
    deviation: float = 0.0
    angle: float = 0.0
    source_line: int = 0
    output_line: int = 0
    rapids: int = 0
    unknown_starts: int = 0
    lines_after_end: int = 0
    problems: list[str] = field(default_factory=list)


class Verifier:
    """Follows one run, window by window."""

    def __init__(
        self,
        passes: Sequence[Pass],
        context: PassContext,
        reading: Reading,
        axes: str,
        budgets: tuple[float, float],
        angle_budget: float,
        file: str = "-",
        folded: bool = False,
    ) -> None:
        self.passes = passes
        self.folded = folded
        self.context = context
        self.reader = WindowReader(context.target)
        self.interpreter = Interpreter(context.target, reading, axes, "output")
        self.budgets = budgets
        self.feed_modes = [step.feed_mode for step in passes if step.feed_mode is not None]
        self.inch = False
        self.angle_budget = angle_budget
        self.file = file
        self.findings = Findings()

    @property
    def budget(self) -> float:
        """What the path may deviate (mm): more once a block in inches has been written."""
        return self.budgets[self.inch]

    def check(
        self, read: Interpreted, window: Window, text: bytes, source: Ints, nth: Ints
    ) -> None:
        """Check the text written for a window; `source` is the input line of each output line.

        `nth` says which of the moves of its input line the first move of an output line is.
        Raises VerificationError.
        """
        first = self.reader.lines
        again = self.reader.read(text)
        try:
            back = self.interpreter.interpret(again, self.reader.table)
        except GcxformError as error:
            raise VerificationError(error.diagnostics) from None
        path = back.path
        self.inch |= bool(path.blocks.inch[path.block].any())
        for step in reversed(self.passes):
            path = step.undo(path, self.context)
        trace = _Trace(read.path, window, back.path, path, source, nth, first)
        self._count(read, window, trace)
        self._compare(trace)
        if self.feed_modes:
            self._left_modes(read, back, trace)
        self._events(self._told(read.path), self._told(back.path), trace)

    def _count(self, read: Interpreted, window: Window, trace: _Trace) -> None:
        found = self.findings
        found.moves += len(read.path)
        found.rapids += int((read.path.kind == Kind.RAPID).sum())
        found.lines_after_end += len(window) - read.live

    def _compare(self, trace: _Trace) -> None:
        """Compare moves; each of the output must belong to one of the input, or a run of them."""
        before, after = trace.before, trace.after
        if len(trace.owner) and int(trace.owner.min()) < 0:
            row = int(np.argmin(trace.owner))
            self._fail("a move that the source does not have", trace, row)
        runs = trace.find_runs()
        self._missing(trace, runs)
        if not len(trace.owner):
            return
        off = deviation_of_runs(before, after, runs, self.budget)
        self.findings.unknown_starts += int(off.unknown_start.sum())
        self._start(trace)
        worst = int(np.argmax(off.distance))
        if not off.distance[worst] <= self.findings.deviation:
            self._note_worst(float(off.distance[worst]), trace, worst)
        self.findings.angle = max(self.findings.angle, float(off.angle.max()))
        if not off.distance[worst] <= self.budget:
            size = f"{off.distance[worst]:.5f} mm" if np.isfinite(off.distance[worst]) else "far"
            self._fail(f"the path is {size} off, the budget is {self.budget:.5f} mm", trace, worst)
        turned = int(np.argmax(off.angle))
        if not off.angle[turned] <= self.angle_budget:
            self._fail(f"a rotary axis is {off.angle[turned]:.5f} degrees off", trace, turned)
        self._kinds(trace)
        self._forms(trace)
        self._sides(trace)
        self._feeds(trace)

    def _note_worst(self, distance: float, trace: _Trace, row: int) -> None:
        self.findings.deviation = distance
        self.findings.source_line = int(trace.before.source[trace.owner[row]]) + 1
        self.findings.output_line = int(trace.after.source[row]) + 1

    def _start(self, trace: _Trace) -> None:
        """Compare where feed moves begin after a rapid: a rapid's own end may be left out."""
        before, after = trace.before, trace.after
        begins = np.append(True, trace.owner[1:] != trace.owner[:-1])
        rows = np.flatnonzero(begins & (before.kind[trace.owner] != Kind.RAPID))[1:]
        if not len(rows):
            return
        gap = (after.start[rows] - before.start[trace.owner[rows]])[:, :3]
        size = np.sqrt((np.nan_to_num(gap) ** 2).sum(axis=1))
        worst = int(np.argmax(size))
        if size[worst] > self.findings.deviation:
            self._note_worst(float(size[worst]), trace, int(rows[worst]))
        if size[worst] > self.budget:
            message = (
                f"the move starts {size[worst]:.5f} mm off, the budget is {self.budget:.5f} mm"
            )
            self._fail(message, trace, int(rows[worst]))

    def _missing(self, trace: _Trace, runs: Runs) -> None:
        """Check that rows which no move in the output stands for were too short to write."""
        left = ways(trace.before, runs.left).tolist()
        for row, length in zip(runs.left.tolist(), left, strict=True):
            if trace.before.is_arc[row] or not length <= self.budget:
                line = int(trace.before.source[row])
                self._raise("a move of the source is missing in the output", line, 0)

    def _kinds(self, trace: _Trace) -> None:
        rapid_before = trace.before.kind[trace.owner] == Kind.RAPID
        wrong = rapid_before != (trace.after.kind == Kind.RAPID)
        if wrong.any():
            self._fail("a rapid became a feed move, or the reverse", trace, int(np.argmax(wrong)))

    def _forms(self, trace: _Trace) -> None:
        """Check that what is tied to the spindle or to a probe is still that, and in one piece."""
        written, owner = trace.written, trace.written_owner
        form, was = written.form, trace.before.form[owner]
        tied = np.isin(form, WHOLE) | np.isin(was, WHOLE)
        broken = tied & (form != was)
        broken |= tied & (np.bincount(owner, minlength=len(trace.before))[owner] != 1)
        if broken.any():
            output = int(written.source[np.argmax(broken)])
            message = "a move tied to the spindle or to a probe became another, or several"
            self._raise(message, trace.line_of(output), output)

    def _sides(self, trace: _Trace) -> None:
        """Check that cutter compensation is on where it was, on the same side and as far."""
        before, after, owner = trace.before, trace.after, trace.owner
        if not before.side.any() and not after.side.any():
            return
        radius, old = after.radius, before.radius[owner]
        changed = (after.side != before.side[owner]) | ~((radius == old) | np.isnan(radius + old))
        if changed.any():
            self._fail("cutter compensation has changed", trace, int(np.argmax(changed)))

    def _feeds(self, trace: _Trace) -> None:
        """Check that feeds are those of the source; in inverse time, the times must add up."""
        before, after, owner = trace.before, trace.after, trace.owner
        moving = before.kind[owner] != Kind.RAPID
        other = before.feed_mode[owner] != after.feed_mode
        meant = after.feed_mode == self.feed_modes[-1] if self.feed_modes else False
        strange = other & moving & ~np.asarray(meant)
        if strange.any():
            self._fail("the feed mode has changed", trace, int(np.argmax(strange)))
        if self.feed_modes:
            self._converted(trace)
            moving &= ~self._may_be_converted(trace, owner)
        inverse = after.feed_mode == FeedMode.INVERSE_TIME
        plain = moving & ~inverse
        off = np.abs(after.feed - before.feed[owner]) > SAME_FEED * np.abs(after.feed)
        if (off & plain).any():
            self._fail("the feed has changed", trace, int(np.argmax(off & plain)))
        if (moving & inverse).any():
            self._times(trace)

    def _times(self, trace: _Trace) -> None:
        """Add up the times of the written moves, before the models cut them further."""
        written, owner = trace.written, trace.written_owner
        mine = written.feed_mode == FeedMode.INVERSE_TIME
        mine &= written.kind != Kind.RAPID
        if self.feed_modes:
            mine &= ~self._may_be_converted(trace, owner)
        time = np.bincount(owner[mine], 1 / written.feed[mine], len(trace.before))
        wanted = 1 / trace.before.feed
        slack = TIME_ERROR * wanted
        used = np.unique(owner[mine])
        wrong = used[np.abs(time[used] - wanted[used]) > slack[used]]
        if len(wrong):
            line = int(trace.before.source[wrong[0]])
            self._raise("the time of a move in G93 has changed", line, 0)

    def _told(self, path: Toolpath) -> tuple[Event, ...]:
        """Return the events that have to be in the output too: not those that are folded away."""
        source, target = self.context.source, self.context.target
        events = tuple(
            _in_mm(event, path)
            for event in path.events
            if not only_for_cycles(event.what, source, target)
        )
        if not self.folded:
            return events
        codes = self.context.source.codes
        return tuple(e for e in events if e.what not in codes or codes[e.what].act not in FRAMING)

    def _may_be_converted(self, trace: _Trace, owner: Ints) -> NDArray[np.bool_]:
        """Return the rows whose feeds a pass may have converted, there and back if there are two.

        One pass alone leaves what is in its mode; blocks after which another program may run keep
        their mode.
        """
        before = trace.before
        kept = before.blocks.leaves[before.block]
        if len(self.feed_modes) == 1:
            kept = kept | (before.feed_mode == self.feed_modes[0])
        return np.asarray(~kept[owner])

    def _converted(self, trace: _Trace) -> None:
        """Check converted feeds by time: at the old feed it is that of the way.

        The way may be measured as programmed or as written, and its pieces may be off by what the
        path may be off.
        """
        before, written, owner = trace.before, trace.written, trace.written_owner
        mine = (written.kind != Kind.RAPID) & self._may_be_converted(trace, owner)
        if not mine.any():
            return
        rows, old, new = np.unique(owner[mine]), lengths(before), lengths(written)
        inverse = written.feed_mode == FeedMode.INVERSE_TIME
        ways = np.where(inverse, 1.0, (new.least + new.most) / 2)
        time = self._sums(trace, mine, ways / written.feed)[rows]
        timed = before.feed_mode[rows] == FeedMode.INVERSE_TIME
        way = (old.least + old.most)[rows] / 2
        implied = time * before.feed[rows] * np.where(timed, way, 1.0)
        pieces = self._sums(trace, mine, np.ones(len(written)))[rows]
        slack = pieces * np.where(old.turns[rows], self.angle_budget, self.budget)
        least = np.minimum(old.least[rows], self._sums(trace, mine, new.least)[rows])
        most = np.maximum(old.most[rows], self._sums(trace, mine, new.most)[rows])
        low, high = least * (1 - TIME_ERROR) - slack, most * (1 + TIME_ERROR) + slack
        off = rows[~((implied >= low) & (implied <= high))]
        if len(off):
            line = int(before.source[off[0]])
            self._raise("the time of a move is another after its feed was converted", line, 0)

    def _sums(self, trace: _Trace, mine: NDArray[np.bool_], values: Floats) -> Floats:
        """Return the sums of values over the written rows `mine` of each row of the source."""
        return np.bincount(trace.written_owner[mine], values[mine], len(trace.before)).astype(float)

    def _left_modes(self, read: Interpreted, back: Interpreted, trace: _Trace) -> None:
        """Check that what may run after a block finds the feed mode that the source leaves."""
        first = read.path.blocks.first
        for line in np.flatnonzero(read.path.blocks.leaves).tolist():
            places = np.flatnonzero(trace.source == line + first)
            mode = back.modes.feed_mode[places[-1:]]
            if (mode != read.modes.feed_mode[line]).any():
                message = "another feed mode is left to what may run after this block"
                self._raise(message, line + first, int(places[-1]) + trace.first)

    def _events(self, old: tuple[Event, ...], new: tuple[Event, ...], trace: _Trace) -> None:
        """Check that events are the same, in order, at the same place between the moves."""
        self.findings.events += len(old)
        for before, after in zip(old, new, strict=False):
            line = trace.line_of(after.line)
            same = (before.what, before.values, before.line) == (after.what, after.values, line)
            if not same or not trace.stands_before(after.row, before.row, self.budget):
                message = f"{before.what} of the source became {after.what}, or moved"
                self._raise(message, before.line, after.line)
        if len(old) != len(new):
            rest = old[len(new) :] or new[len(old) :]
            line = rest[0].line if len(old) > len(new) else trace.line_of(rest[0].line)
            self._raise(f"{rest[0].what} is missing or too many", line, 0)

    def _fail(self, message: str, trace: _Trace, row: int) -> None:
        output = int(trace.after.source[row])
        self._raise(message, trace.line_of(output), output)

    def _raise(self, message: str, line: int, output_line: int) -> None:
        """Raise VerificationError about a line of the source and a line of the output, from 0."""
        where = Location(self.file, line + 1)
        if output_line:
            message += f" (output line {output_line + 1})"
        hint = "nothing was written; if the pipeline is right this is a bug of gcxform or a plugin"
        raise VerificationError((Diagnostic("GX601", message, where, hint),))


def _in_mm(event: Event, path: Toolpath) -> Event:
    """Return an event with the lengths among the words of its G code in mm."""
    if event.what[0] != "G" or not path.blocks.inch[event.line - path.blocks.first]:
        return event
    values = tuple((a, v * INCH if a in LENGTHS else v) for a, v in event.values)
    return replace(event, values=values)


class _Trace:
    """Which move of the output belongs to which move of the input.

    `written` are the moves as read from the output, `after` what the machine does with them.
    """

    def __init__(
        self,
        before: Toolpath,
        window: Window,
        written: Toolpath,
        after: Toolpath,
        source: Ints,
        nth: Ints,
        first: int,
    ) -> None:
        self.before = before
        self.written = written
        self.after = after
        self.source = source
        self.first = first
        self._nth = nth
        line = before.source - window.first_line
        self._count = np.bincount(line, minlength=len(window))
        self._row_of_line = np.where(self._count > 0, np.cumsum(self._count) - self._count, -1)
        self._window_first = window.first_line
        self.owner = self._owners(after)
        self.written_owner = self.owner if after is written else self._owners(written)
        self.through = self.written_owner

    def find_runs(self) -> Runs:
        """Find which moves of the input each move stands for."""
        runs = runs_of(self.before, self.owner)
        same = self.written_owner is self.owner
        self.through = (runs if same else runs_of(self.before, self.written_owner)).through
        return runs

    def _owners(self, path: Toolpath) -> Ints:
        written = path.source - self.first
        lines = self.source[written] - self._window_first
        first = self._row_of_line[lines]
        nth = path.nth + self._nth[written]
        return np.where((first >= 0) & (nth < self._count[lines]), first + nth, -1)

    def line_of(self, output_line: int) -> int:
        """Return the input line of an output line, both from 0."""
        index = output_line - self.first
        return int(self.source[index]) if 0 <= index < len(self.source) else 0

    def stands_before(self, written_row: int, row: int, short: float) -> bool:
        """Whether what stands before a written move stands before that row of the input.

        Rows no longer than `short` (mm) together may have been left out on either side of it.
        """
        owner = self.written_owner
        earlier = written_row == 0 or self._ends_before(written_row - 1, row, short)
        later = written_row >= len(owner) or int(owner[written_row]) >= row
        return earlier and later

    def _ends_before(self, written_row: int, row: int, short: float) -> bool:
        """Whether a written move stands for nothing from a row on, or for too little to matter."""
        through = int(self.through[written_row])
        if through < row:
            return True
        rest = slice(row, through + 1)
        if int(self.written_owner[written_row]) >= row or self.before.is_arc[rest].any():
            return False
        rows = np.arange(row, through + 1)
        return float(ways(self.before, rows).sum()) <= short
