"""A pipeline: a chain of passes that is checked once, then run on programs.

The chain is checked before any program is read: dialects, options, facts, budget. A run reads a
program window by window, transforms, writes and verifies it, and hands the text on; memory does not
grow with the program. Nothing here touches the file system: see `gcxform.system.files`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from gcxform.config import arguments
from gcxform.config.to_fill_in import told_open
from gcxform.contract.passes import Pass, TextPass
from gcxform.diagnostics import InputError, SpellingError, UsageError
from gcxform.dialect.dialect import Dialect, NumberFormat
from gcxform.flow.by_itself import is_subprogram
from gcxform.machine.machine import Machine
from gcxform.modal.state import Entry, Reading
from gcxform.pipeline.certificate import Certificate
from gcxform.pipeline.certify import certificate
from gcxform.pipeline.chain_text import chain_doubts, parse_chain
from gcxform.pipeline.file import PipelineSpec, load
from gcxform.pipeline.output import Output, Sink
from gcxform.pipeline.plan import Plan
from gcxform.pipeline.run import Progress, Run
from gcxform.pipeline.written_back import told
from gcxform.plugin.registry import Registry, default_registry
from gcxform.syntax.source import Source, program_of
from gcxform.system.limits import in_force
from gcxform.values import dataclass

VERIFY = ("off", "on", "full")


@dataclass(frozen=True)
class Result:
    """What a run on a program in memory gives: the text, its proof, and the source map.

    `source_map` holds, for each line of the output from 0, the line of the input it came from.
    """

    text: bytes
    certificate: Certificate
    source_map: list[int]

    def _repr_html_(self) -> str:
        """Return what a notebook shows: the certificate."""
        return self.certificate._repr_html_()


@dataclass(frozen=True)
class Pipeline(Plan):
    """A plan that is loaded and run. Build it with `load`, `parse` or the constructor."""

    # --- ways to build one ---

    @classmethod
    def load(
        cls,
        path: str | Path,
        registry: Registry | None = None,
        passes: Sequence[type[Pass] | type[TextPass]] = (),
    ) -> Pipeline:
        """Return the pipeline of a TOML file; `passes` may be named besides those of plugins.

        Raises UsageError.
        """
        registry = (registry or default_registry()).with_passes(passes)
        return cls.of_spec(load(Path(path), registry), registry)

    @classmethod
    def parse(
        cls,
        chain: str,
        dialect: str = "",
        base: Path | None = None,
        registry: Registry | None = None,
        passes: Sequence[type[Pass] | type[TextPass]] = (),
    ) -> Pipeline:
        """Return the pipeline of a chain like `absolute | segment chord-error=5um`.

        `passes` are classes that the chain may name besides those of plugins: of a script, or of
        the cell of a notebook. Raises UsageError.
        """
        registry = (registry or default_registry()).with_passes(passes)
        steps = tuple(parse_chain(chain, base or Path.cwd(), registry))
        spec = PipelineSpec(passes=steps, warnings=chain_doubts(chain))
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
                hint='dialect = "fanuc" in [input]; `gcxform list dialects`',
            )
        source = registry.dialect(name_in)
        target = registry.dialect(dialect_out or spec.output.dialect or name_in)
        numbers, decimals = _numbers(target, spec)
        file = machine or spec.machine
        with in_force(spec.limits):
            loaded = _machine(file, registry) if file else None
        return cls(
            source,
            target,
            tuple(spec.passes),
            _reading(source, spec),
            loaded,
            spec.budget,
            spec.output.words,
            numbers,
            decimals,
            spec.growth,
            spec.output.stamp,
            spec.input.again,
            spec.warnings,
            spec.limits,
            spec.open,
            spec.output.structure,
            m_codes=spec.output.m_codes,
            drop=frozenset(spec.output.drop),
            inert=frozenset(spec.output.inert),
            taps=spec.output.taps,
        )

    # --- runs ---

    def run(self, program: bytes | str | Path, verify: str = "on", name: str = "-") -> Result:
        """Run on a program: its bytes, or a path. Raises GcxformError; writes no file.

        `name` is what messages call a program that is given as bytes.
        """
        source = program_of(program, name)
        parts: list[bytes] = []
        lines: list[int] = []
        with source.stream:
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
        arguments.chosen("verify", verify, VERIFY)
        out, tell = Output(sink, source_map), progress or (lambda size: None)
        with in_force(self.limits):
            if not self.copies and is_subprogram(source, self.read_as):
                from gcxform.pipeline.subprogram import run_subprogram

                return run_subprogram(self, source, sink, verify, source_map, tell)
            try:
                run = self._run_over(source, verify, out, tell)
            except InputError as error:
                raise InputError(tuple(told_open(error.diagnostics, self.to_fill_in))) from None
            run.check_growth(out)
        return certificate(run, out)

    def _run_over(self, source: Source, verify: str, out: Output, tell: Progress) -> Run:
        """Return a run that is over; of a program whose lines cannot all be written back, whole.

        Of one that is refused that way, too, the line is told.
        """
        run = Run(self, source, verify)
        try:
            run.over(out, tell)
        except SpellingError as line:
            (why, *_) = line.diagnostics
            out.lines_in = 0
            try:
                whole = Run(replace(self, whole=told(line, source)), source, verify)
                whole.over(out, tell)
            except InputError as other:
                message = f"{why.hint}; written whole it is refused, too: {told(other, source)}"
                raise InputError((replace(why, hint=message),)) from None
            return whole
        return run


def _machine(file: Path, registry: Registry) -> Machine:
    from gcxform.machine.file import load_machine

    return load_machine(file, registry.machines)


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
    given, said = spec.input, spec.entry
    return Reading(
        dict(given.start),
        given.increment,
        given.feed,
        given.block_delete,
        given.units,
        given.feed_increment,
        dict(given.parameters),
        subprograms=given.subprograms,
        tool=given.tool,
        entry=Entry(tuple(said.modes.split()), dict(said.start), said.feed, dict(said.parameters)),
    )
