"""The proof: what was written is read again, undone through the models, compared with the input.

The reader of the output is a new one that knows nothing of how the text was made. Each of its moves
is traced to a line of the input by the source map; the models of what the machine does with the
passes' output are applied in reverse order; what comes out must follow the input's path within the
budget, with the same kinds of moves, feeds and events.

    before     p, the path as read: rows k, mm and degrees
    written    w, the path of the text as it is read again
    after      a = undo_1(... undo_n(w)), what the machine does; `owner` k of each of its rows
    budget b   mm, promises of the passes and rounding; `angle_budget`: degrees, of rotary axes

Claimed, for every row of a and the run of rows of p that it stands for, along both in the order of
travel (a bound of the Frechet distance, `gcxform/deviations/`):

    |a - p| <= b in X, Y and Z,   |angle of a - angle of p| <= angle budget of the axis;

of rapids at their ends only, for no control is bound to go straight in them. Feed moves begin
within b of where they began. Rows of p that nothing stands for are lines, and those that follow one
another have ways of <= b together. Left to bounds of their own are moves between taps (IN_AIR) and
rapids that passes spare (`gcxform/proof/spared_rapids.py`). No pass is believed: this is measured.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from gcxform.contract.passes import Pass, PassContext
from gcxform.deviations.runs import Runs, deviation_of_runs
from gcxform.diagnostics import (
    Diagnostic,
    GcxformError,
    InputError,
    Location,
    VerificationError,
)
from gcxform.modal.interpreter import Interpreted, Interpreter
from gcxform.modal.meaning.tables import PROBES
from gcxform.modal.reader import Apart, WindowReader
from gcxform.modal.state import Reading
from gcxform.proof.centre_path import CentreProof
from gcxform.proof.events import EventProof
from gcxform.proof.feeds import FeedProof, speeds_of
from gcxform.proof.findings import Findings
from gcxform.proof.inventory import Whole, assignments_differ, not_taken
from gcxform.proof.known_positions import as_known, lost_in_target
from gcxform.proof.lost_words import elsewhere
from gcxform.proof.path_modes import PathModes
from gcxform.proof.spared_rapids import led_elsewhere, spared_rows, told
from gcxform.proof.taps_in_step import TapProof
from gcxform.proof.trace import Trace
from gcxform.syntax.scan import Window
from gcxform.syntax.undecided import DECIDED, Undecided
from gcxform.system.arrays import Flags, Floats, Ints
from gcxform.system.distinct import one_of
from gcxform.toolpath.facts import IN_AIR, between_taps
from gcxform.toolpath.path import WHOLE, Kind, Toolpath
from gcxform.toolpath.travel import ways


class Verifier:
    """Follows one run, window by window."""

    def __init__(
        self,
        passes: Sequence[Pass],
        context: PassContext,
        reading: Reading,
        axes: str,
        limit: Callable[[bool, bool, bool], float],
        angle_budgets: Mapping[str, float],
        file: str = "-",
        folded: bool = False,
        switches: frozenset[str] = frozenset(),
        bounded: bool = True,
        undecided: Undecided = DECIDED,
    ) -> None:
        self.passes = passes
        self.switches = switches
        self.bounded = bounded
        self.context = context
        self._again = WindowReader(context.target)
        self.reader = WindowReader(context.target)
        self.interpreter = Interpreter(context.target, reading, axes, "output")
        self.undecided = undecided
        self.behind = 0
        self.whole = Whole(context.target)
        self.limit = limit
        self.centres = CentreProof(context, file)
        self.path_modes = PathModes(context)
        self.taps = TapProof(context)
        homes = any(step.demands.written_for is not None for step in passes)
        self.events = EventProof(context, folded, switches, homes)
        self.feed_modes = [mode for step in passes if (mode := step.demands.feed_mode) is not None]
        self.speeds = speeds_of(context) if any(step.demands.slows for step in passes) else {}
        self.angle_budgets = angle_budgets
        self.angle_budget = max(angle_budgets.values())
        self.file = file
        self.findings = Findings()

    @property
    def budget(self) -> float:
        """What the path may deviate (mm): more once there were blocks in inches, or arcs."""
        return self.limit(self.findings.inch, False, self.findings.arcs)

    def read(self, text: bytes) -> Apart:
        """Read the text written for a window, perhaps in another process than it is checked in."""
        return self._again.read_apart(text)

    def check(
        self, apart: Apart, read: Interpreted, lines: range, source: Ints, nth: Ints
    ) -> Findings:
        """Check what was written for a window; return what has been found in the program so far.

        `apart` is what `read` has made of its text.

        Raises VerificationError.
        """
        again = self.reader.take_over(apart)
        self.interpreter.undecided = self.undecided.through(
            source, again.first_line, range(self.behind, lines.stop)
        )
        self.behind = int(source.max()) + 1 if len(source) else self.behind
        try:
            back = self.interpreter.interpret(again, self.reader.table)
        except GcxformError as error:
            raise not_taken(error, self.context, self.file, again, source) from None
        back = self.taps.of_cycles(back)
        self.findings.file = self.whole.add(again, self.reader.table, back.live)
        path = back.path
        self.findings.inch |= bool(path.blocks.inch[path.block].any())
        self.findings.arcs |= any(p.has_arcs or p.has_splines for p in (path, read.path))
        written = path.source - again.first_line
        line, which = source[written], path.nth + nth[written]
        known = path = as_known(path, read.path, line, which, bool(self.switches))
        for step in reversed(self.passes):
            path = step.undo(path, self.context)
        trace = Trace(read.path, lines, back.path, path, source, nth, again.first_line)
        self._count(read, lines, trace)
        tapped = self.taps.rows(read)
        self._compare(trace, spared_rows(self.passes, read.path), known, tapped)
        for wrong in self.taps.wrong(read, back, tapped, trace):
            self._raise(*wrong)
        self._centres(trace)
        self._forms(trace, read, back)
        for wrong in self._proof(trace, tapped).left_behind(read, back) if self.feed_modes else ():
            self._raise(*wrong)
        source_path = self.taps.without_inner(read.path, tapped)
        old, new = self.events.of_source(source_path), self.events.told(back.path)
        new, moded = self.path_modes.check(old, new, trace, read, self.budget)
        if moded is not None:
            self._raise(*moded)
        self.findings.path_modes = self.path_modes.added
        self.findings.events += len(old)
        self.findings.unset += self.events.unset(read.path)
        lost = assignments_differ(read.assigned, back.assigned, trace, self.context)
        wrongs = *self.events.wrong(old, new, trace, self.budget), lost
        wrongs = *wrongs, *self.events.wrong_zeros(read, back, trace)
        for found in filter(None, (*wrongs, *elsewhere(read, trace, self.budget))):
            self._raise(*found)
        self._given(read.path, again, source)
        return self.findings

    def _count(self, read: Interpreted, lines: range, trace: Trace) -> None:
        found = self.findings
        found.moves += len(read.path)
        found.rapids += int((read.path.kind == Kind.RAPID).sum())
        found.lines_after_end += len(lines) - read.live

    def _compare(self, trace: Trace, spared: Flags, written: Toolpath, tapped: Flags) -> None:
        """Compare moves; each of the output must belong to one of the input, or a run of them.

        `spared` are the rows of the input that are left to the machine, `tapped` those of taps that
        another code says; `written` is not undone.
        """
        before, after = trace.before, trace.after
        if len(trace.owner) and int(trace.owner.min()) < 0:
            row = int(np.argmin(trace.owner))
            self._fail("a move that the source does not have", trace, row)
        runs = trace.find_runs()
        self._missing(trace, runs)
        if not len(trace.owner):
            return
        if lost := lost_in_target(trace, written, self.context, self.file):
            raise lost
        off = deviation_of_runs(before, after, runs, self.budget)
        self.findings.unknown_starts += int(off.unknown_start.sum())
        self._start(trace)
        distance = self._but_between_taps(off.distance, trace)
        if spared.any():
            self._check_told(trace, spared, told(self.passes, written, self.context))
            distance = self._but_spared(distance, trace, spared)
        worst = int(np.argmax(distance))
        if not distance[worst] <= self.findings.deviation:
            self._note_worst(float(distance[worst]), trace, worst)
        self.findings.angle = max(self.findings.angle, float(off.angle.max()))
        if not distance[worst] <= self.budget:
            self._over_budget(float(distance[worst]), trace, worst)
        turned = self._turned_too_far(trace, runs, off.angle)
        if turned is not None:
            self._fail(f"a rotary axis is {off.angle[turned]:.5f} degrees off", trace, turned)
        self._kinds(trace)
        self._sides(trace)
        self._feeds(self._proof(trace, tapped))

    def _feeds(self, proof: FeedProof) -> None:
        if self.context.target.feed_rule.of_linear_axes:
            for wrong in proof.turned_alone():
                where = Location(self.file, wrong.line + 1)
                hint = "write it in inverse time: feed mode=inverse-time, before this step"
                raise InputError.one("GX316", wrong.message, where, hint)
        for wrong in proof.wrong():
            self._raise(*wrong)

    def _over_budget(self, distance: float, trace: Trace, row: int) -> None:
        """Raise: InputError where no step has promised the budget, which then was a wish."""
        size = f"{distance:.5f} mm" if np.isfinite(distance) else "far"
        message = f"the path is {size} off, the budget is {self.budget:.5f} mm"
        if self.bounded or not np.isfinite(distance):
            self._fail(message, trace, row)
        where = Location(self.file, trace.line_of(int(trace.after.source[row])) + 1)
        hint = "a larger deviation in [budget], or a tolerance for the step that has none"
        raise InputError.one("GX510", message, where, hint)

    def _turned_too_far(self, trace: Trace, runs: Runs, angle: Floats) -> int | None:
        """Return the row in which a rotary axis is farthest beyond its budget, if one is.

        `angle` (n,) are degrees. Where budgets differ they are measured again with each axis in
        the measure of the largest budget.
        """
        axes = trace.before.axes
        scale = np.array([self.angle_budget / self.angle_budgets.get(a, np.inf) for a in axes])
        scale[scale == 0.0] = 1.0
        if (scale != 1.0).any():
            both = (path.replace(end=path.end * scale) for path in (trace.before, trace.after))
            before, after = (path.replace(entry=path.entry * scale) for path in both)
            angle = deviation_of_runs(before, after, runs, self.budget).angle
        turned = int(np.argmax(angle))
        return None if angle[turned] <= self.angle_budget else turned

    def _but_between_taps(self, distance: Floats, trace: Trace) -> Floats:
        """Return distances without those of moves between taps that nothing can say better."""
        if all(type(step).undo is Pass.undo for step in self.passes):
            return distance
        rows = between_taps(trace.before)
        rows[trace.written_owner[between_taps(trace.written)]] = True
        free = rows[trace.owner]
        free &= (distance > self.budget) & (distance <= IN_AIR)
        if not free.any():
            return distance
        self.findings.between_taps += int(free.sum())
        self.findings.aside = max(self.findings.aside, float(distance[free].max()))
        return np.where(free, 0.0, distance)

    def _check_told(self, trace: Trace, spared: Flags, path: Toolpath) -> None:
        """Check that the control is told what the program says where the machine is left to it."""
        owner = trace.owners(path)
        row = led_elsewhere(trace.before, path, owner, spared, self.budget)
        if row >= 0:
            output = int(path.source[row])
            message = "a move that is not compensated leads elsewhere than in the source"
            self._raise(message, trace.line_of(output), output)

    def _but_spared(self, distance: Floats, trace: Trace, spared: Flags) -> Floats:
        """Return distances without those of rapids that are left to go where the machine does."""
        free = spared[trace.owner]
        size = distance[free]
        known = size[np.isfinite(size)]
        self.findings.spared += int(spared.sum())
        self.findings.spared_unknown += int(len(size) - len(known))
        self.findings.spared_by = max(self.findings.spared_by, float(known.max(initial=0.0)))
        return np.where(free, 0.0, distance)

    def _proof(self, trace: Trace, tapped: Flags) -> FeedProof:
        limits = self.budget, self.angle_budget
        return FeedProof(trace, self.feed_modes, *limits, tapped, self.speeds)

    def _note_worst(self, distance: float, trace: Trace, row: int) -> None:
        self.findings.deviation = distance
        self.findings.source_line = int(trace.before.source[trace.owner[row]]) + 1
        self.findings.output_line = int(trace.after.source[row]) + 1

    def _start(self, trace: Trace) -> None:
        """Compare where feed moves begin after a rapid: a rapid's own end may be left out."""
        before, after = trace.before, trace.after
        begins = np.append(True, trace.owner[1:] != trace.owner[:-1])
        rows = np.flatnonzero(begins & (before.kind[trace.owner] != Kind.RAPID))
        if not len(rows):
            return
        start, old = after.start[rows, :3], before.start[trace.owner[rows], :3]
        gap = np.nan_to_num(start - old)
        gap[np.isnan(start).any(axis=1) & np.isfinite(old).all(axis=1)] = np.inf
        size = np.sqrt((gap**2).sum(axis=1))
        worst = int(np.argmax(size))
        if size[worst] > self.findings.deviation:
            self._note_worst(float(size[worst]), trace, int(rows[worst]))
        if size[worst] > self.budget:
            message = (
                f"the move starts {size[worst]:.5f} mm off, the budget is {self.budget:.5f} mm"
            )
            self._fail(message, trace, int(rows[worst]))

    def _missing(self, trace: Trace, runs: Runs) -> None:
        """Check that rows which no move in the output stands for were too short to write.

        Those that follow one another have to be that short together, or they might lead far away.
        A move from a place that is not known is not short.
        """
        left, along = runs.left, ways(trace.before, runs.left)
        begins = np.append(True, np.diff(left) > 1)[: len(left)]
        together = np.bincount(np.cumsum(begins) - 1, along) if len(left) else along
        short = together[np.cumsum(begins) - 1] <= self.budget
        far = trace.before.is_arc[left] | ~trace.before.starts_known[left]
        missing = left[far | ~short]
        if len(missing):
            line = int(trace.before.source[missing[0]])
            self._raise("a move of the source is missing in the output", line, 0)

    def _kinds(self, trace: Trace) -> None:
        rapid_before = trace.before.kind[trace.owner] == Kind.RAPID
        wrong = rapid_before != (trace.after.kind == Kind.RAPID)
        if wrong.any():
            self._fail("a rapid became a feed move, or the reverse", trace, int(np.argmax(wrong)))

    def _forms(self, trace: Trace, read: Interpreted, back: Interpreted) -> None:
        """Check that what is tied to the spindle or to a probe is still that, and in one piece."""
        written, owner = trace.written, trace.written_owner
        form, was = written.form, trace.before.form[owner]
        tied = one_of(form, WHOLE) | one_of(was, WHOLE)
        broken = tied & (form != was)
        broken |= tied & (np.bincount(owner, minlength=len(trace.before))[owner] != 1)
        code, old = back.modes.motion[written.block], read.modes.motion[trace.before.block[owner]]
        broken |= (code != old) & (one_of(code, PROBES) | one_of(old, PROBES))
        if broken.any():
            output = int(written.source[np.argmax(broken)])
            message = "a move tied to the spindle or to a probe became another, or several"
            self._raise(message, trace.line_of(output), output)

    def _sides(self, trace: Trace) -> None:
        """Check that cutter compensation is on where it was, on the same side and as far."""
        before, after, owner = trace.before, trace.after, trace.owner
        if not before.side.any() and not after.side.any():
            return
        radius, old = after.radius, before.radius[owner]
        changed = (after.side != before.side[owner]) | ~((radius == old) | np.isnan(radius + old))
        if changed.any():
            self._fail("cutter compensation has changed", trace, int(np.argmax(changed)))

    def _centres(self, trace: Trace) -> None:
        """Check where the control takes the centre of the tool, if it is left to compensate."""
        found = self.findings
        budget = self.limit(found.inch, True, found.arcs)
        for off in self.centres.check(trace.before, trace.after, budget):
            if off.distance > found.deviation:
                found.deviation = off.distance
                found.source_line, found.output_line = off.source_line + 1, off.output_line + 1
        found.contours, found.contour_only = self.centres.compared, self.centres.unknown

    def _given(self, path: Toolpath, text: Window, source: Ints) -> None:
        """Check that the blocks that the user gives stand in the text, once each and in order."""
        for line in sorted({given.line for given in path.given}):
            wanted = [given.text.encode() for given in path.given if given.line == line]
            places = np.flatnonzero(source == line).tolist()
            here = [text.line(at).lstrip(b"/ ") for at in places]  # as the block they stand in
            if [each for each in here if each in wanted] != wanted:
                self._raise("a block that is given is missing, doubled or elsewhere", line, 0)

    def _fail(self, message: str, trace: Trace, row: int) -> None:
        output = int(trace.after.source[row])
        self._raise(message, trace.line_of(output), output)

    def _raise(self, message: str, line: int, output_line: int) -> None:
        """Raise VerificationError about a line of the source and a line of the output, from 0."""
        where = Location(self.file, line + 1)
        if output_line:
            message += f" (output line {output_line + 1})"
        hint = "nothing was written; if the pipeline is right this is a bug of gcxform or a plugin"
        raise VerificationError((Diagnostic("GX601", message, where, hint),))
