"""A pipeline: a chain of passes that is checked once, then run on programs.

The chain is checked before any program is read: dialects, options, facts, budget. A run reads a
program window by window, transforms, writes and verifies it, and hands the text on; memory does not
grow with the program. Nothing here touches the file system: see `gcxform.system.files`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from string import ascii_uppercase

import numpy as np

from gcxform.config import arguments
from gcxform.contract.options import taken
from gcxform.contract.passes import Pass, PassContext, TextPass, resolved
from gcxform.contract.tip_codes import with_refusal, with_switches, with_vectors, without_tip_codes
from gcxform.diagnostics import Diagnostic, UsageError
from gcxform.dialect.dialect import MOST_DECIMALS, ROTARY, Dialect, NumberFormat
from gcxform.emit.manner import Manner
from gcxform.machine.file import load_machine
from gcxform.machine.machine import Machine
from gcxform.modal.state import Reading
from gcxform.pipeline.certificate import Certificate
from gcxform.pipeline.certify import certificate
from gcxform.pipeline.chain import check_chain, facts_after
from gcxform.pipeline.file import PipelineSpec, chain_doubts, load, parse_chain
from gcxform.pipeline.output import Output, Sink
from gcxform.pipeline.run import Progress, Run
from gcxform.plugin.registry import Registry, default_registry, dialect_of
from gcxform.stamps.chain import Marks, against, refusal, stamp_of
from gcxform.stamps.comment import stamps_in
from gcxform.stamps.writing import comment_line
from gcxform.syntax.source import Source, program_of
from gcxform.system.limits import Limits, in_force
from gcxform.toolpath.facts import ABSOLUTE, LINEAR_ONLY, NO_CYCLES

ARC_ROUNDING = 2.0  # of the last decimal: what rounding ends and centre can add along an arc
CENTRE_ROUNDING = 0.003  # mm: what rounding moves a centre by depends on the contour's corners
VERIFY = ("off", "on", "full")
WORDS = ("changed", "programmed", "all")


@dataclass(frozen=True)
class Result:
    """What a run on a program in memory gives: the text, its proof, and the source map.

    `source_map` holds, for each line of the output from 0, the line of the input it came from.
    """

    text: bytes
    certificate: Certificate
    source_map: list[int]


def check_written(dialect: type[Dialect]) -> None:
    """Raise UsageError for a dialect in which nothing is written."""
    if dialect.translator is not None:
        message = f"programs for {dialect.name} are read, and not written"
        hint = 'dialect = "linuxcnc" in [output]; `gcxform list dialects`'
        raise UsageError.one("GX747", message, hint=hint)


@dataclass(frozen=True)
class Pipeline:
    """Passes between two dialects. Build it with `load`, `parse` or the constructor.

    budget   mm that the path may deviate; None: what the steps promise, and the rounding
    growth   how many blocks may be written for each one read, over the program; None: any number
    warnings what is odd in what the pipeline was built from, and no error
    words    which axis words a changed block gets: "changed", "programmed" or "all"
    stamp    whether what turns positions into others is stamped, so that it is not done twice
    again    run on stamped programs all the same, as if they were not
    limits   what a run may take; None: as much as is usual
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
    growth: float | None = None
    stamp: bool = True
    again: bool = False
    warnings: tuple[Diagnostic, ...] = field(default=(), compare=False)
    limits: Limits | None = None

    def __post_init__(self) -> None:
        for name, value in self._taken().items():
            object.__setattr__(self, name, value)
        self._check_target()
        check_chain(self.path_passes)
        for step in self.path_passes:
            step.begin(self.context)
        self._check_budget()

    def _taken(self) -> dict[str, object]:
        """Return what was given as what is meant by it. Raises UsageError for all else."""
        steps = self.passes if isinstance(self.passes, list | tuple) else (self.passes,)
        for step in steps:
            arguments.instance(
                "passes", step, (Pass, TextPass), "passes, each made with its options"
            )
        arguments.instance("reading", self.reading, Reading, "a Reading")
        numbers, machine, limit = self.numbers, self.machine, arguments.positive
        if numbers is not None:
            arguments.instance("numbers", numbers, NumberFormat, "a NumberFormat")
        if machine is not None:
            arguments.instance("machine", machine, Machine, "a machine, as load_machine gives it")
        return {
            "source": dialect_of(self.source),
            "target": dialect_of(self.target),
            "passes": tuple(taken(step) for step in steps),
            "budget": None if self.budget is None else limit("budget", self.budget),
            "growth": None if self.growth is None else limit("growth", self.growth),
            "words": arguments.chosen("words", self.words, WORDS),
            "decimals": {
                arguments.chosen("decimals", letter, tuple(ascii_uppercase)): arguments.whole(
                    f"decimals of {letter}", count, MOST_DECIMALS
                )
                for letter, count in arguments.table("decimals", self.decimals).items()
            },
        }

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
        spec = PipelineSpec(passes=passes, warnings=chain_doubts(chain))
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
            loaded = load_machine(file, registry.kinematics) if file else None
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
        expands = any(NO_CYCLES in step.ensures for step in self.path_passes)
        manner = Manner(self.source, self.target, numbers, self.words, self.decimals, expands)
        promised = self.promised()
        if not np.isfinite(promised):
            promised = max((self.budget or 0.0) - self._repeated * manner.rounding(False), 0.0)
        return replace(manner, promised=promised)

    @property
    def read_as(self) -> type[Dialect]:
        """The dialect in which programs are read: with what a pass does instead of the control."""
        reads = any(step.reads_tip_codes for step in self.path_passes)
        read = with_switches if reads else with_refusal
        return read(self.source, self.machine_reading.control)

    def without_tip_codes(self, source: Source) -> tuple[Source, type[Dialect]]:
        """Return a program without what a pass does instead of the control, and its dialect."""
        dialect = self.read_as
        if any(step.reads_vectors for step in self.path_passes):
            plain = without_tip_codes(source, self.source.vector_codes)
            return plain, dialect if plain is source else with_vectors(dialect)
        if any(step.reads_tip_codes for step in self.path_passes):
            source = without_tip_codes(source, self.source.tip_codes)
        return source, dialect

    @property
    def machine_reading(self) -> Reading:
        """What is known of programs before they are read, with what the machine file says."""
        return self.reading if self.machine is None else self.reading.on(self.machine)

    @property
    def context(self) -> PassContext:
        """What the passes are told."""
        return PassContext(
            self.source,
            self.target,
            self.numbers or self.target.numbers,
            self.machine,
            self.decimals,
        )

    @property
    def copies(self) -> bool:
        """Whether there is nothing to do but to copy."""
        return not self.path_passes and self.source is self.target

    def rounding(self, inch: bool = False) -> float:
        """Return the largest distance (mm) that rounding alone can make, for blocks in a unit.

        Where distances are written, what is off in one block stays in the next: twice as much.
        """
        return self._repeated * self.manner.rounding(inch)

    @property
    def _repeated(self) -> int:
        """How often a rounding can count: twice where blocks may be incremental."""
        return 1 if ABSOLUTE in facts_after(self.path_passes) else 2

    def promised(self) -> float:
        """Return the sum of what the passes promise (mm); inf if one promises nothing."""
        return sum(step.promise for step in self.path_passes)

    @property
    def bounded(self) -> bool:
        """Whether the steps promise how far the path may be off, all of them together."""
        return self.promised() < np.inf and self.words != "programmed"

    def limit(self, inch: bool = False, compensated: bool = False, arcs: bool = True) -> float:
        """Return the deviation (mm) that a run may have, in blocks of a unit.

        `compensated`: that of the tool's centre where the control offsets a contour; `arcs`:
        whether there is any arc or spline, as far as the passes leave some.
        """
        if self.budget is not None:
            return self.budget
        if compensated:
            return max(self.limit(inch, arcs=arcs), CENTRE_ROUNDING)
        total = self.promised() + self.rounding(inch)
        if arcs and LINEAR_ONLY not in facts_after(self.path_passes):
            total += self._repeated * ARC_ROUNDING * self.manner.step("X", inch)
        return total

    def limit_of_written(self, inch: bool, compensated: bool, arcs: bool) -> float:
        """Return what of `limit` is left to what is written, beside the path that passes proved."""
        proved = self.path_passes[: resolved(self.path_passes)]
        return self.limit(inch, compensated, arcs) - sum(step.promise for step in proved)

    def angle_limits(self, written: bool = False) -> dict[str, float]:
        """Return how far (deg) rotary axes may be off: what steps promise, and the rounding.

        `written`: beside the path that passes have proved.
        """
        steps = self.path_passes[resolved(self.path_passes) if written else 0 :]
        promised = sum(step.promise_angle for step in steps)
        return {a: promised + 1.01 * self.manner.step(a, False) for a in ROTARY}

    def _check_target(self) -> None:
        """Refuse to write, or to change the text of, programs that are only read."""
        if not self.copies or self.passes:
            check_written(self.target)

    def _check_budget(self) -> None:
        """Refuse a budget that the steps cannot keep, and steps without bound or budget."""
        total = self.promised() + self.manner.rounding(False)
        if self.budget is None:
            if not self.bounded:
                raise UsageError.one(
                    "GX723",
                    "a step promises no bound, so the pipeline needs an explicit budget",
                    hint='deviation = "20 um" in [budget]; the certificate says what was measured',
                )
        elif self.bounded and total > self.budget * (1 + 1e-9):
            raise UsageError.one(
                "GX724",
                f"the steps may deviate by {self.promised() * 1000:g} um and rounding by "
                f"{self.manner.rounding(False) * 1000:.2f} um: more than the budget of "
                f"{self.budget * 1000:g} um",
                hint="raise the budget, lower a tolerance, or write more decimals",
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

    def marks(self, source: Source) -> Marks:
        """Return the stamps of a run on a program.

        Raises InputError where the program is stamped, and not what the chain takes it for.
        """
        read, context = stamps_in(source), self.context
        new = stamp_of(self.passes, context, self.words)
        found = against(read, self.path_passes, context, new)
        if found is not None and not self.again:
            raise refusal(read, source, found)
        why = "" if found is None else found[1]
        writes = self.stamp and new is not None and bool(comment_line(self.target, new.content))
        return Marks(read, new if writes else None, new is not None, why)

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
        out = Output(sink, source_map)
        with in_force(self.limits):
            run = Run(self, source, verify)
            run.over(out, progress or (lambda size: None))
            run.check_growth(out)
        return certificate(run, out)


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
    return Reading(
        dict(given.start),
        given.increment,
        given.feed,
        given.block_delete,
        given.units,
        given.feed_increment,
        dict(given.parameters),
    )
