"""A pipeline: a chain of passes that is checked once, then run on programs.

The chain is checked before any program is read: dialects, options, facts, budget. A run reads a
program window by window, transforms, writes and verifies it, and hands the text on; memory does not
grow with the program. Nothing here touches the file system: see `gcxform.files`.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from gcxform.certificate import Certificate
from gcxform.contract import Pass, PassContext, TextPass
from gcxform.diagnostics import GcxformError, InputError, Location, UsageError, VerificationError
from gcxform.dialect import LINEAR, Dialect, NumberFormat
from gcxform.emit.emitter import Emitted, Emitter
from gcxform.emit.manner import Manner
from gcxform.machine.machine import Machine, load_machine
from gcxform.modal.interpreter import Interpreter, Reading
from gcxform.modal.tables import GROUPS
from gcxform.pipelinefile import PipelineSpec, load, parse_chain
from gcxform.registry import Registry, default_registry
from gcxform.source import Source
from gcxform.syntax.scan import Window
from gcxform.textpasses import TextRun
from gcxform.toolpath.facts import AT_READING, LINEAR_ONLY, Fact
from gcxform.toolpath.path import Toolpath
from gcxform.verify import Verifier, WindowReader
from gcxform.version import VERSION

ARC_ROUNDING = 2.0  # of the last decimal: what rounding ends and centre can add along an arc
VERIFY = ("off", "on", "full")

Sink = Callable[[bytes], object]
Progress = Callable[[int], None]


@dataclass(frozen=True)
class Result:
    """What a run on a program in memory gives: the text, its proof, and the source map.

    `source_map` holds, for each line of the output from 0, the line of the input it came from.
    """

    text: bytes
    certificate: Certificate
    source_map: list[int]


@dataclass
class _Run:
    """What one run collects."""

    sink: Sink
    source_map: list[int] | None
    read: hashlib._Hash = field(default_factory=hashlib.sha256)
    written: hashlib._Hash = field(default_factory=hashlib.sha256)
    lines_in: int = 0
    lines_out: int = 0

    def put(self, text: bytes) -> None:
        self.written.update(text)
        self.sink(text)


@dataclass(frozen=True)
class Pipeline:
    """Passes between two dialects. Build it with `load`, `parse` or the constructor.

    budget   mm that the path may deviate; None: what the steps promise, and the rounding
    words    which axis words a changed block gets: "changed", "programmed" or "all"
    """

    source: type[Dialect]
    target: type[Dialect]
    passes: tuple[Pass | TextPass, ...] = ()
    reading: Reading = field(default_factory=Reading)
    machine: Machine | None = None
    budget: float | None = None
    words: str = "changed"
    numbers: NumberFormat | None = None
    decimals: Mapping[str, int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        check_chain(self.path_passes)
        for step in self.path_passes:
            step.begin(self.context)
        self._check_budget()

    # --- ways to build one ---

    @classmethod
    def load(cls, path: str | Path, registry: Registry | None = None) -> Pipeline:
        """Return the pipeline of a TOML file. Raises UsageError."""
        registry = registry or default_registry()
        return cls.of_spec(load(Path(path), registry), registry)

    @classmethod
    def parse(
        cls,
        chain: str,
        dialect: str = "",
        base: Path | None = None,
        registry: Registry | None = None,
    ) -> Pipeline:
        """Return the pipeline of a chain like `absolute | segment chord-error=5um`."""
        registry = registry or default_registry()
        passes = tuple(parse_chain(chain, base or Path.cwd(), registry))
        spec = PipelineSpec(passes=passes)
        return cls.of_spec(spec, registry, dialect)

    @classmethod
    def of_spec(
        cls,
        spec: PipelineSpec,
        registry: Registry,
        dialect_in: str = "",
        dialect_out: str = "",
        machine: Path | None = None,
    ) -> Pipeline:
        """Return the pipeline of a file's contents; the other arguments take precedence."""
        name_in = dialect_in or spec.input.dialect
        if not name_in:
            raise UsageError.one(
                "GX722",
                "which dialect is the program in?",
                hint='dialect = "fanuc" in [input], or -f fanuc; `gcxform list dialects`',
            )
        source = registry.dialect(name_in)
        target = registry.dialect(dialect_out or spec.output.dialect or name_in)
        numbers, decimals = _numbers(target, spec)
        file = machine or spec.machine
        return cls(
            source,
            target,
            tuple(spec.passes),
            _reading(source, spec),
            load_machine(file) if file else None,
            spec.budget,
            spec.output.words,
            numbers,
            decimals,
        )

    # --- what is known before a run ---

    @property
    def path_passes(self) -> tuple[Pass, ...]:
        """The passes that change the path."""
        return tuple(step for step in self.passes if isinstance(step, Pass))

    @property
    def text_passes(self) -> tuple[TextPass, ...]:
        """The passes that change text only; they run on what is written."""
        return tuple(step for step in self.passes if isinstance(step, TextPass))

    @property
    def manner(self) -> Manner:
        """How the program is written."""
        numbers = self.numbers or self.target.numbers
        return Manner(self.source, self.target, numbers, self.words, self.decimals)

    @property
    def context(self) -> PassContext:
        """What the passes are told."""
        return PassContext(
            self.source, self.target, self.numbers or self.target.numbers, self.machine
        )

    @property
    def copies(self) -> bool:
        """Whether there is nothing to do but to copy."""
        return not self.path_passes and self.source is self.target

    def rounding(self) -> float:
        """Return the largest distance (mm) that rounding alone can make."""
        facts = facts_after(self.path_passes)
        size = max(self.manner.rounding(False), self.manner.rounding(True))
        if any(fact.name == "METRIC" for fact in facts) or self.reading.units == "mm":
            size = self.manner.rounding(False)
        if any(fact.name == "ABSOLUTE" for fact in facts):
            return size
        return 2 * size

    def promised(self) -> float:
        """Return the sum of what the passes promise (mm); inf if one promises nothing."""
        return sum(step.promise for step in self.path_passes)

    def limit(self) -> float:
        """Return the deviation (mm) that a run may have."""
        if self.budget is not None:
            return self.budget
        total = self.promised() + self.rounding()
        if LINEAR_ONLY not in facts_after(self.path_passes):
            total += ARC_ROUNDING * self.manner.step("X", False)
        return total

    def _check_budget(self) -> None:
        """Refuse a budget that the steps cannot keep, and steps without bound or budget."""
        bounded = self.promised() < np.inf and self.words != "programmed"
        if self.budget is None:
            if not bounded:
                raise UsageError.one(
                    "GX723",
                    "a step promises no bound, so the pipeline needs an explicit budget",
                    hint='[budget] deviation = "20 um"; the certificate states what was measured',
                )
        elif bounded and self.promised() + self._least_rounding() > self.budget * (1 + 1e-9):
            raise UsageError.one(
                "GX724",
                f"the steps may deviate by {self.promised() * 1000:g} um and rounding by "
                f"{self._least_rounding() * 1000:.2f} um: more than the budget of "
                f"{self.budget * 1000:g} um",
                hint="raise the budget, lower a tolerance, or write more decimals",
            )

    def _least_rounding(self) -> float:
        return self.manner.rounding(False)

    # --- runs ---

    def run(self, program: bytes | str | Path, verify: str = "on") -> Result:
        """Run on a program: its bytes, or a path. Raises GcxformError; writes no file."""
        source = (
            Source.of_bytes(program) if isinstance(program, bytes) else Source.open(Path(program))
        )
        parts: list[bytes] = []
        lines: list[int] = []
        certificate = self.run_stream(source, parts.append, verify, lines)
        return Result(b"".join(parts), certificate, lines)

    def run_stream(
        self,
        source: Source,
        sink: Sink,
        verify: str = "on",
        source_map: list[int] | None = None,
        progress: Progress | None = None,
    ) -> Certificate:
        """Run on a source, handing the text to a sink piece by piece.

        What was handed over is to be thrown away if an error is raised.
        """
        run = _Run(sink, source_map)
        work = _Work(self, source, verify)
        for text in source.windows():
            run.read.update(text)
            work.window(text, run)
            if progress is not None:
                progress(len(text))
        return work.certificate(run)


class _Work:
    """One run: its readers, writer and verifier."""

    def __init__(self, pipeline: Pipeline, source: Source, verify: str) -> None:
        self.pipeline = pipeline
        self.source = source
        self.verify = verify
        self.steps = pipeline.path_passes
        self.text = TextRun(pipeline.text_passes, pipeline.target, source.name)
        self.reader = WindowReader(pipeline.source)
        self.verifier: Verifier | None = None
        self.interpreter: Interpreter | None = None
        if not pipeline.copies:
            self._prepare()

    def _prepare(self) -> None:
        pipeline = self.pipeline
        letters = self.source.letters()
        axes = "".join(a for a in pipeline.source.axes if a in letters or a in "XYZ")
        reading = _with_assumed_start(pipeline, axes)
        self.axes = axes
        self.interpreter = Interpreter(pipeline.source, reading, axes, self.source.name)
        start = self.interpreter.state.position
        self.emitter = Emitter(pipeline.manner, start, self.source.name)
        if self.verify != "off":
            self.verifier = Verifier(
                self.steps,
                pipeline.context,
                replace(reading, units=_first_units(pipeline)),
                axes,
                pipeline.limit(),
                10.0 ** -pipeline.manner.decimals_of("F", False) * 25.4,
                1.01 * 10.0 ** -pipeline.manner.decimals_of("A", False),
                self.source.name,
            )

    def window(self, text: bytes, run: _Run) -> None:
        """Transform one window and hand it on."""
        if self.pipeline.copies:
            self._copy(text, run)
            return
        window = self.reader.read(text)
        emitted = self._transform(window)
        run.lines_in += len(window)
        if run.source_map is None and not self.text.passes:
            run.lines_out += len(emitted.source)
            run.put(emitted.text)
        else:
            self._put(emitted.text, emitted.source.tolist(), run)

    def _copy(self, text: bytes, run: _Run) -> None:
        """Hand a window on as it is, but for passes that change text."""
        first = self.reader.lines
        if run.source_map is None and not self.text.passes:
            run.put(text)
            return
        count = len(self.reader.read(text))
        run.lines_in += count
        self._put(text, list(range(first, first + count)), run)

    def _put(self, text: bytes, lines: list[int], run: _Run) -> None:
        text, lines = self.text.edit(text, lines)
        run.lines_out += len(lines)
        if run.source_map is not None:
            run.source_map += lines
        run.put(text)

    def _transform(self, window: Window) -> Emitted:
        """Interpret, pass, emit and verify one window."""
        assert self.interpreter is not None
        read = self.interpreter.interpret(window, self.reader.table)
        path = read.path
        for step in self.steps:
            path = self._apply(step, path, window)
        emitted = self.emitter.emit(window, self.reader.table, read, path)
        if self.verifier is not None:
            self.verifier.check(read, window, emitted.text, emitted.source)
        return emitted

    def _apply(self, step: Pass, path: Toolpath, window: Window) -> Toolpath:
        try:
            after = step.apply(path, self.pipeline.context)
        except InputError as error:
            raise _located(error, window, self.source.name) from None
        if self.verify == "full":
            for fact in step.ensures:
                if not fact.check(after):
                    raise VerificationError.one(
                        "GX602", f"{step.name} ensures {fact.name}, and the path does not have it"
                    )
        return after

    # --- the certificate ---

    def certificate(self, run: _Run) -> Certificate:
        """Return the proof of the run."""
        pipeline = self.pipeline
        self.text.finish()
        certificate = Certificate(
            VERSION,
            {"name": self.source.name, "dialect": pipeline.source.name, "lines": run.lines_in}
            | {"sha256": run.read.hexdigest()},
            {"dialect": pipeline.target.name, "lines": run.lines_out}
            | {"sha256": run.written.hexdigest()},
            [_described(step) for step in pipeline.passes],
            _budget(pipeline),
            self.verifier is not None or (pipeline.copies and self.verify != "off"),
        )
        self._fill(certificate)
        return certificate

    def _fill(self, certificate: Certificate) -> None:
        if self.verifier is None:
            if self.pipeline.copies and not self.text.passes:
                certificate.not_checked.append("meaning: every byte was copied")
            elif self.verify == "off":
                certificate.not_checked.append("anything: verification was switched off")
            return
        found = self.verifier.findings
        certificate.largest = {
            "deviation": found.deviation,
            "source_line": found.source_line,
            "output_line": found.output_line,
            "angle": found.angle,
        }
        certificate.checked = {"moves": found.moves, "events": found.events}
        self._not_checked(certificate)

    def _not_checked(self, certificate: Certificate) -> None:
        assert self.verifier is not None
        assert self.interpreter is not None
        found = self.verifier.findings
        for count, what in (
            (
                found.rapids,
                "rapids: only their ends, because controls do not move straight in them",
            ),
            (found.unknown_starts, "moves from an unknown position: only their ends"),
            (found.lines_after_end, "lines after the end of the program: copied, not read"),
        ):
            if count:
                certificate.not_checked.append(f"{count} {what}")
        stated = self.interpreter.state.stated
        for group in GROUPS:
            if group not in stated and group not in ("motion", "arc-distance"):
                code = self.pipeline.source.initial[group]
                certificate.assumed.append(f"{group} {code}, which the program does not state")
        for axis, value in self.interpreter.reading.start.items():
            certificate.assumed.append(f"{axis} stands at {value:g} before the first block")


# --- checks of chains ---


def facts_after(passes: Sequence[Pass]) -> frozenset[Fact]:
    """Return the facts that hold after a chain."""
    facts = set(AT_READING)
    for step in passes:
        facts = (facts - step.clears) | step.ensures
    return frozenset(facts)


def check_chain(passes: Sequence[Pass], others: Sequence[type[Pass]] = ()) -> None:
    """Raise UsageError where a pass requires a fact that the chain does not have there."""
    facts: set[Fact] = set(AT_READING)
    cleared: dict[Fact, str] = {}
    for number, step in enumerate(passes, 1):
        for fact in sorted(step.requires - facts, key=lambda f: f.name):
            culprit = cleared.get(fact)
            why = f"which {culprit} has taken away" if culprit else "which no step before ensures"
            raise UsageError.one(
                "GX725",
                f"step {number}, {step.name}, requires {fact.name} ({fact.meaning}), {why}",
                hint=_mend(fact, culprit, step.name),
            )
        for fact in step.clears:
            cleared[fact] = f"step {number}, {step.name},"
        facts = (facts - step.clears) | step.ensures


def _mend(fact: Fact, culprit: str | None, name: str) -> str:
    if culprit:
        return f"put {name} before it, or leave one of the two out"
    makers = [
        p.name
        for p in default_registry().passes.values()
        if issubclass(p, Pass) and fact in p.ensures
    ]
    if makers:
        return f"put {' or '.join(sorted(makers))} before {name}"
    return f"no pass that is installed ensures {fact.name}"


# --- small parts ---


def _numbers(target: type[Dialect], spec: PipelineSpec) -> tuple[NumberFormat, dict[str, int]]:
    """Return number format and decimals by address of an output section."""
    numbers, decimals = target.numbers, spec.output.decimals
    if spec.output.trailing_zeros is not None:
        numbers = replace(numbers, zeros=spec.output.trailing_zeros)
    if isinstance(decimals, int):
        numbers = replace(numbers, mm=decimals, inch=decimals, angle=decimals)
        return numbers, {}
    chosen = dict(decimals or {})
    for axis, centre in zip("XYZ", "IJK", strict=True):
        if axis in chosen:
            chosen.setdefault(centre, chosen[axis])
    return numbers, chosen


def _reading(source: type[Dialect], spec: PipelineSpec) -> Reading:
    given = spec.input
    return Reading(dict(given.start), given.increment, given.feed, given.block_delete, given.units)


def _with_assumed_start(pipeline: Pipeline, axes: str) -> Reading:
    """Return what is known at the start; where only programmed words are written, the rest is 0."""
    reading = pipeline.reading
    if pipeline.words != "programmed":
        return reading
    zeros = {axis: 0.0 for axis in axes if axis in LINEAR}
    return replace(reading, start={**zeros, **reading.start})


def _first_units(pipeline: Pipeline) -> str:
    """Return the units the output starts in: every block that needs others states them."""
    return "in" if pipeline.target.initial["units"] == "G20" else "mm"


def _described(step: Pass | TextPass) -> dict[str, object]:
    """Return a step's name, options and promise for the certificate."""
    from gcxform.options import to_toml

    entry: dict[str, object] = {"use": step.name, **to_toml(step)}
    if isinstance(step, Pass):
        entry["promise"] = step.promise if np.isfinite(step.promise) else None
    return entry


def _budget(pipeline: Pipeline) -> dict[str, object]:
    promised = pipeline.promised()
    return {
        "deviation": pipeline.limit(),
        "explicit": pipeline.budget is not None,
        "steps": promised if np.isfinite(promised) else None,
        "rounding": pipeline.rounding(),
    }


def _located(error: InputError, window: Window, file: str) -> GcxformError:
    """Return an error with the text of the lines it is about."""
    found = []
    for diagnostic in error.diagnostics:
        where = diagnostic.where
        if where is not None and not where.file and where.line:
            text = window.line(where.line - 1 - window.first_line).decode("latin-1")
            start = len(text) - len(text.lstrip()) + 1
            where = Location(file, where.line, start, text, max(1, len(text.strip())))
            diagnostic = diagnostic.at(where)
        found.append(diagnostic)
    return InputError(tuple(found))


def windows_of(source: Source, dialect: type[Dialect]) -> Iterator[tuple[Window, WindowReader]]:
    """Yield the windows of a program with the reader that knows their shapes."""
    reader = WindowReader(dialect)
    for text in source.windows():
        yield reader.read(text), reader
