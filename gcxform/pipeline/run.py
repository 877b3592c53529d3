"""One run of a pipeline on a program: read, transform, write and verify, window by window."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace

from gcxform.contract.passes import Pass, resolved
from gcxform.contract.tip_codes import switches_of
from gcxform.diagnostics import GcxformError, InputError, Location, VerificationError
from gcxform.emit.centres import in_words_of
from gcxform.emit.emitter import Emitted, Emitter
from gcxform.flow.straightened import located, written_out
from gcxform.modal.interpreter import Interpreted, Interpreter
from gcxform.modal.inventory import Account
from gcxform.modal.meaning.tables import MeaningTable
from gcxform.modal.program_end import Ending, Frame, frame_for, with_ends
from gcxform.modal.reader import Apart, WindowReader
from gcxform.pipeline.blind_moves import check_blind
from gcxform.pipeline.called_files import not_done_yet
from gcxform.pipeline.cutter_comp import check_compensated
from gcxform.pipeline.kept_promises import check_ensured, check_promised
from gcxform.pipeline.leaving import NOTHING, Leaving
from gcxform.pipeline.mixed_feeds import check_mixed
from gcxform.pipeline.output import Output
from gcxform.pipeline.own_language import writes_back
from gcxform.pipeline.placing import placing
from gcxform.pipeline.plan import Plan
from gcxform.pipeline.reasons import changed_lines
from gcxform.pipeline.structure import Structure
from gcxform.pipeline.text_passes import TextRun
from gcxform.pipeline.timed_arcs import check_timed_arcs
from gcxform.pipeline.translated_moves import said_in_moves, settled
from gcxform.pipeline.whole_cuts import undivided
from gcxform.pipeline.written_back import SpelledOut, WrittenBack, structure_of
from gcxform.proof.findings import Findings
from gcxform.proof.inventory import Books, Others
from gcxform.proof.verify import Verifier
from gcxform.stamps.chain import check_stamps
from gcxform.stamps.comment import StampReader
from gcxform.stamps.writing import Heads, Seal, comment_line
from gcxform.syntax.scan import Window
from gcxform.syntax.source import Source, lines_in
from gcxform.system.arrays import Floats
from gcxform.system.heap import Heap
from gcxform.system.worker import Worker, ahead, relay, worker
from gcxform.toolpath.path import Toolpath
from gcxform.values import dataclass

Progress = Callable[[int], object]


@dataclass(frozen=True, slots=True)
class Transformed:
    """A window as it was read, the path that is meant, and the one to be written."""

    window: Window
    table: MeaningTable
    read: Interpreted
    meant: Toolpath
    path: Toolpath


@dataclass(frozen=True, slots=True)
class Stages:
    """What reads, writes and proves the windows of a program that is not only copied."""

    interpreter: Interpreter
    emitter: Emitter
    verifier: Verifier | None


class Run:
    """One run: its readers, writer and verifier; `leaves` is what it writes before its end."""

    def __init__(self, plan: Plan, source: Source, verify: str, leaves: Leaving = NOTHING) -> None:
        self.plan = plan
        self.leaves = leaves
        self.marks = plan.marks(source)
        self.heads = self._heads()
        self.source, self.verify = source, verify
        self.text = TextRun(plan.text_passes, plan.target, source.name, self._tell)
        if not plan.copies:
            self.source = written_out(source, plan.read_as, plan.machine_reading, plan.target)
        self.executes = self.source is not source
        self.plan, said = settled(plan, self.source)
        self.steps, self.assumed = self.plan.path_passes, (*self.source.assumed, *said)
        self.executed = getattr(self.source, "executed", None)
        self.files = not_done_yet(plan, getattr(self.source, "files", ()))
        self.structure = structure_of(plan, source, self.source, self.marks)
        if self.executed is not None:
            self.executed.refuse(self.marks.changes, self.structure is not None)
        self.source, self.dialect = plan.without_tip_codes(self.source)
        self.ending = Ending(self.dialect, source.name)
        self.books = Books(plan.context, frozenset(), self.executed)
        self.others = Others(self.dialect, self.source.name)
        self.account = Account()
        self.frame = Frame()
        self.given = source
        self.reader = WindowReader(self.dialect)
        self.measured: dict[str, float] = {}
        self.added: dict[str, int] = {}
        self.held: dict[int, Floats] = {}
        self.findings = Findings()
        self.stages = None if plan.copies else self._stages()

    def _tell(self, step: str, lines: Iterable[int]) -> None:
        """Tell who asks which lines of the program a step has changed."""
        if self.plan.told is not None:
            self.plan.told(step, [self.source.line_of(line + 1) - 1 for line in lines])

    @property
    def verifier(self) -> Verifier | None:
        """What proves windows; None where nothing is to be proved."""
        return None if self.stages is None else self.stages.verifier

    def _heads(self) -> Heads | None:
        """Return what writes stamps; None where there are none, or those that there are stay."""
        stay = writes_back(self.plan) or (self.plan.copies and not self.plan.text_passes)
        if stay or not (self.marks.changes or self.marks.read):
            return None
        target = self.plan.target
        lines = [comment_line(target, stamp.content) for stamp in self.marks.written]
        return Heads(target, lines, bool(self.marks.read))

    def _stages(self) -> Stages:
        """Return what reads, writes and proves windows; note what frames the program."""
        plan = self.plan
        axes = plan.machine_reading.axes_of(self.source, plan.source)
        written = set(axes).union(*(step.demands.letters for step in self.steps))
        axes = "".join(axis for axis in plan.source.axes if axis in written)
        reading = plan.reading_at_start(axes)
        interpreter = Interpreter(self.dialect, reading, axes, self.source.name)
        interpreter.undecided = self.source.undecided
        self.frame = self._frame()
        where = interpreter.state.position, self.source.name
        emitter = Emitter(plan.manner, *where, self.source.is_called)
        emitter.believed.inch = int(plan.first_units == "in")
        self.books = Books(plan.context, self._switches(), self.executed)
        if self.verify == "off":
            return Stages(interpreter, emitter, None)
        verifier = Verifier(
            self.steps[resolved(self.steps) :],
            plan.context,
            self.plan.reading_of_output(reading),
            axes,
            plan.limit_of_written,
            plan.angle_limits(written=True),
            self.source.name,
            any(step.demands.folds for step in self.steps),
            self._switches(),
            *(plan.bounded, self.source.undecided),
        )
        return Stages(interpreter, emitter, verifier)

    def _frame(self) -> Frame:
        """Return the percent signs that the program lacks for the target."""
        try:
            executes = self.plan.reading.block_delete == "execute"
            return frame_for(self.source, self.dialect, self.plan.target, executes)
        except GcxformError as error:
            raise located(error, self.source) from None

    def _switches(self) -> frozenset[str]:
        """Return the M codes that a pass takes over from the control."""
        if self.plan.read_as is self.plan.source:
            return frozenset()
        return frozenset(switches_of(self.plan.source, self.plan.machine_reading.control))

    def over(self, out: Output, progress: Progress, size: int = 0) -> None:
        """Run over the program, `size` bytes at a time. Raises GcxformError."""
        if self.heads is not None and not isinstance(self.structure, SpelledOut):
            out.seal = Seal(self.plan.target, out.written, self.marks.seal)
        if self.heads is not None or isinstance(self.structure, WrittenBack):
            out.proof = StampReader() if self.verify != "off" else None
        try:
            self._over(size, out, progress)
        except GcxformError as error:
            raise located(error, self.source) from None
        if self.structure is not None:
            self._fold(self.structure, out)
        if self.heads is not None:
            out.close(self.heads)
        bare = self.heads is not None and self.heads.waits and not self.findings.moves
        if out.proof is not None and not bare:
            check_stamps(out.proof.found, self.marks)

    def _over(self, size: int, out: Output, progress: Progress) -> None:
        """Run over the windows of a program.

        While one is transformed and written the next is read, and the one before proved, by
        processes of their own if the program is long.
        """
        texts = self.source.windows(size)
        if self.plan.copies:
            texts, whole = self.text.gathered(lambda: self.source.windows(size))
            for text in texts:
                out.read.update(text)
                self._copy(text, out, whole)
                progress(len(text))
            return
        texts = undivided(texts, self.plan)
        read = WindowReader(self.dialect).read_apart
        long = self.source.is_long(size)
        with worker(read, long) as reader, self._proof(long) as proof:
            windows = ahead(reader, self._counted(texts, out))
            self._write_all(windows, proof, out, progress)

    def _fold(self, structure: Structure | WrittenBack | SpelledOut, out: Output) -> None:
        """Hand the program on with its calls and loops, or written out where that cannot be."""
        folded = structure.fold()
        if folded is None:
            assert isinstance(structure, Structure)
            self._put(structure.text, structure.lines.tolist(), out, True)
            return
        if self.verify != "off":
            reading = self.plan.reading_of_output(self.plan.machine_reading)
            structure.prove(folded, reading, self.account, self.findings)
        out.lines_in = structure.lines_read
        whole = folded.text
        text = whole if isinstance(structure, Structure) else structure.sealed(whole)
        out.put(*self.text.edit(text, list(folded.lines), True))

    def _proof(self, long: bool) -> Worker[Findings]:
        """Return who proves windows: one reads what was written, and another compares."""
        if self.verifier is None:
            return worker(Findings, False)
        return relay(self.verifier.read, self.verifier.check, long)

    def _counted(self, texts: Iterator[bytes], out: Output) -> Iterator[bytes]:
        """Yield texts; their hash is that of the program if that is what is executed."""
        empty = self.frame.behind  # percent signs need a window
        for text in texts:
            if self.source is self.given:
                out.read.update(text)
            empty = False
            yield text
        if empty:
            yield b""

    def _write_all(
        self,
        windows: Iterator[Apart],
        proof: Worker[Findings],
        out: Output,
        progress: Progress,
    ) -> None:
        """Transform and write the windows; of several errors the first in the program is raised."""
        heap = Heap()
        try:
            for apart, first, last in with_ends(windows, self.frame.behind):
                one = self._transform(apart)
                if self.marks.changes:
                    self.others.refuse_moving(one.window, one.table, one.read.live)
                emitted = self._emitted(one, first, last)
                if self.dialect.program_rule.needs_end:
                    self.ending.look(one.window, one.table)
                self.books.add(one.window, one.table, one.read, len(one.path.given))
                if proof.full:
                    self.findings = proof.end()
                if self.verifier is not None:
                    given = one.window.lines, emitted.source, emitted.nth
                    proof.begin(emitted.text, replace(one.read, path=one.meant), *given)
                read = one.window, one.table, one.read.live
                self._hand_on(one.window, self.leaves.with_back(emitted, *read), out)
                progress(len(one.window.text))
                del apart, one, emitted  # or they would last until the next one is there
                heap.give_back()
            if any(step.demands.feed_mode is not None for step in self.steps):
                self._check_end()
        finally:
            while proof.busy and not isinstance(sys.exception(), KeyboardInterrupt):
                self.findings = proof.end()
        if self.verifier is not None:
            self._check_whole()

    def _check_whole(self) -> None:
        """Check that nothing is lost, and that the target takes the file if the source's did."""
        found = self.findings
        self.account, wrong = self.books.close(found.file, found.path_modes)
        where = Location(self.source.name, max(self.reader.lines, 1))
        if wrong:
            raise VerificationError.one("GX601", wrong, where)
        faulty = self.dialect.name == self.plan.target.name and self.ending.wrong
        if found.file.no_end and not faulty:
            raise VerificationError.one("GX601", found.file.no_end, where)

    def _emitted(self, one: Transformed, first: bool, last: bool) -> Emitted:
        """Return the text of a window, with the stamps if they are due."""
        assert self.stages is not None
        emitted = self.stages.emitter.emit(one.window, one.table, one.read, one.path)
        emitted = emitted.framed(self.frame, first, last)
        emitted = self.leaves.with_codes(emitted, one.window, one.table, one.read.live)
        if self.heads is None:
            return emitted
        text, kept = self.heads.edit(emitted.text)
        if kept is None:
            return emitted
        return Emitted(text, emitted.source[kept], emitted.nth[kept])

    def _check_end(self) -> None:
        """Refuse to leave the control in another feed mode than the source program does."""
        assert self.stages is not None
        emitter, interpreter = self.stages.emitter, self.stages.interpreter
        if emitter.believed.feed_mode != interpreter.state.groups["feed-mode"]:
            where = Location(self.source.name, max(self.reader.lines, 1))
            message = "the program ends without M2 or M30: its feed mode cannot be restored"
            raise InputError.one("GX321", message, where, "write M30 at its end")

    def _hand_on(self, window: Window, emitted: Emitted, out: Output) -> None:
        out.lines_in += len(window)
        if self.structure is not None:
            self.structure.parts.append(emitted)
        elif out.source_map is None and not self.text.passes:
            out.put(emitted.text, emitted.source)
        else:
            self._put(emitted.text, emitted.source.tolist(), out)

    def _copy(self, text: bytes, out: Output, whole: bool = False) -> None:
        """Hand a window on as it is, but for passes that change text."""
        if out.source_map is None and not self.text.passes:
            first, count = out.lines_in, lines_in(text)
            out.lines_in += count
            out.put(text, range(first, first + count))
            return
        lines = list(self.reader.read(text).lines)
        out.lines_in += len(lines)
        if self.heads is not None:
            text, kept = self.heads.edit(text)
            lines = lines if kept is None else [lines[k] for k in kept]
        self._put(text, lines, out, whole)

    def _put(self, text: bytes, lines: list[int], out: Output, whole: bool = False) -> None:
        text, lines = self.text.edit(text, lines, whole)
        if out.source_map is not None and self.source is not self.given:
            lines = [self.source.line_of(k + 1) - 1 for k in lines]
        out.put(text, lines)

    def _transform(self, apart: Apart) -> Transformed:
        """Interpret one window and run the passes."""
        assert self.stages is not None
        window = self.reader.take_over(apart)
        read = self.stages.interpreter.interpret(window, table := self.reader.table)
        meant, name = read.path, self.source.name
        path = said_in_moves(self.plan, 0, read, read.path, window, name)
        for number, step in enumerate(self.steps, 1):
            path = self._apply(step, self._held(number, path), window)
            if len(path):
                self.held[number] = path.end[-1].copy()
            if step.demands.resolves:
                self._prove(step, meant, path, window)
                meant = path
            path = said_in_moves(self.plan, number, read, path, window, name)
        with placing(window, name):
            check_mixed(read.path, path, self.plan.context)
            check_timed_arcs(read.path, path, self.plan.context)
        return Transformed(window, table, read, meant, in_words_of(self.plan.target, path))

    def _held(self, number: int, path: Toolpath) -> Toolpath:
        """Return a path that knows where what a step has written before has left the axes."""
        return path.replace(held=self.held.get(number, path.entry))

    def _prove(self, step: Pass, before: Toolpath, after: Toolpath, window: Window) -> None:
        """Let a pass that resolves prove its path, against the one that the program means."""
        if self.verify == "off":
            return
        with placing(window, self.source.name):
            step.prove(before, after, self.plan.context)

    def _apply(self, step: Pass, path: Toolpath, window: Window) -> Toolpath:
        with placing(window, self.source.name):
            check_blind(step, path)
            after = step.apply(path, self.plan.context)
            if not step.demands.resolves:
                check_compensated(step, path, after)
        found = step.measure(path, after, self.plan.context)
        check_promised(step, found)
        for what, size in found.items():
            counts, before = what in step.demands.counts, self.measured.get(what, 0.0)
            self.measured[what] = before + size if counts else max(size, before)
        for what, number in step.added(path, after, self.plan.context).items():
            self.added[what] = self.added.get(what, 0) + number
        if self.plan.told is not None:
            self._tell(step.name, changed_lines(path, after))
        if self.verify == "full":
            check_ensured(step, after)
        return after

    def check_growth(self, out: Output) -> None:
        """Refuse an output that has more blocks than the budget allows. Raises InputError."""
        limit = self.plan.growth
        if limit is None or out.blocks_out <= limit * out.blocks_in:
            return
        message = f"{out.blocks_in} blocks became {out.blocks_out}, {out.growth:.4g} times as many"
        message += f"; the budget allows {limit:g} times"
        enough = math.ceil(out.growth or 0)
        hint = f"give a step that cuts moves a larger tolerance, or growth = {enough} in [budget]"
        raise InputError.one("GX507", message, Location(self.source.name, out.lines_in), hint)
