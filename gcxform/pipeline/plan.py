"""What is settled before a run: the chain of passes, from which dialect to which, and how far off.

A `Plan` is checked when it is made, before any program is read: options, facts, budget. A run takes
one and cannot change it.

The budget of a run, where the pipeline file gives none, is

    sum of promises + rounding (+ 2 last decimals if there are arcs)

Rounding to d decimals moves a point by at most half a decimal in each of three axes: with three
decimals 0.866 um. It counts twice if blocks may stay incremental. An arc turns the rounding of its
ends and centre into more along its way, hence the last term; a program without arcs has the smaller
budget. A pass that resolves counts with its promise as any other, and what is written beside its
path has the rest. A budget in the file takes the place of the sum: if promises and the least
rounding do not fit into it the pipeline is refused, and a pass without a bound needs one. `largest`
in the certificate is the largest of everything that was promised, so a pass names
(`Demands.deviates`) which of its figures no comparison of paths shows.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field, replace
from functools import cached_property
from string import ascii_uppercase

import numpy as np

from gcxform.config import arguments
from gcxform.config.to_fill_in import Open
from gcxform.contract import tip_codes
from gcxform.contract.demands import Demands
from gcxform.contract.inert_codes import with_inert
from gcxform.contract.options import taken
from gcxform.contract.own_codes import with_own_codes
from gcxform.contract.passes import Pass, PassContext, TextPass, resolved
from gcxform.contract.tilted_planes import says_the_same, treatment, with_planes
from gcxform.diagnostics import Diagnostic, UsageError
from gcxform.dialect.code_translation import Saying
from gcxform.dialect.dialect import LINEAR, MOST_DECIMALS, ROTARY, Dialect, NumberFormat
from gcxform.emit.expressible import foreign_cycles
from gcxform.emit.manner import Manner
from gcxform.machine.machine import Machine
from gcxform.modal.state import Reading
from gcxform.pipeline.chain import (
    check_chain,
    compensates,
    expands_cycles,
    facts_after,
    keeps_tip_codes,
    spared_by,
)
from gcxform.pipeline.entry_modes import check_entry
from gcxform.pipeline.own_language import check_target, target_of, writes_back
from gcxform.pipeline.reasons import Told
from gcxform.plugin.registry import dialect_of
from gcxform.stamps.chain import Marks, against, refusal, stamp_of
from gcxform.stamps.comment import stamps_in
from gcxform.stamps.writing import comment_line
from gcxform.syntax.source import Source
from gcxform.system.limits import Limits
from gcxform.toolpath.facts import ABSOLUTE, LINEAR_ONLY, METRIC, WORKPIECE_FRAME
from gcxform.values import dataclass

ARC_ROUNDING = 2.0  # of the last decimal: what rounding ends and centre can add along an arc
CENTRE_ROUNDING = 0.003  # mm: what rounding moves a centre by depends on the contour's corners
STRUCTURES = ("keep", "written-out")
WORDS = ("changed", "programmed", "all")


@dataclass(frozen=True)
class Plan:
    """Passes between two dialects, as they are to be run.

    budget   mm that the path may deviate; None: what the steps promise, and the rounding
    growth   how many blocks may be written for each one read, over the program; None: any number
    warnings what is odd in what the pipeline was built from, and no error
    words    which axis words a changed block gets: "changed", "programmed" or "all"
    stamp    whether what turns positions into others is stamped, so that it is not done twice
    again    run on stamped programs all the same, as if they were not
    limits   what a run may take; None: as much as is usual
    open     the places of values that the pipeline file leaves to be filled in
    structure  "keep": calls and loops stay where each line is written the same every time it is
             executed; "written-out": they are written as the blocks that are executed
    m_codes  M codes of the source, and what takes the place of each in the output
    drop     codes of the source that are left out
    inert    M codes of the target that leave its axes where they stand
    taps     "alike": both controls tie the spindle to the feed in the same way in G74 and G84;
             "in-step": they tap in step with the spindle, as G33.1 does
    whole    why a program in a language of its own is not written back line by line; nothing
             where it is
    chord_error  mm within which splines become lines without a step; 0: they stay
    told     takes what each step changes, for who asks why lines differ; None: nobody does
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
    open: Open = field(default_factory=dict, compare=False)
    structure: str = "keep"
    told: Told | None = field(default=None, compare=False)
    m_codes: Mapping[str, str] = field(default_factory=dict)
    drop: frozenset[str] = frozenset()
    inert: frozenset[str] = frozenset()
    taps: str = ""
    chord_error: float = 0.0
    whole: str = ""

    def __post_init__(self) -> None:
        for name, value in self._taken().items():
            object.__setattr__(self, name, value)
        target = target_of(self)
        if target is not self.target:
            object.__setattr__(self, "target", target)
            self.__dict__.pop("saying", None)  # of the target of before
        check_target(self)
        check_entry(self.reading.entry.modes, self.source)
        self.saying.check()
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
        control = machine.control if machine is not None else {}
        source, target = (
            with_planes(dialect_of(each), "refused") for each in (self.source, self.target)
        )
        same, steps = source is target, tuple(taken(step) for step in steps)
        if source.name == target.name and keeps_tip_codes(steps):
            source, target = (tip_codes.with_kept(each, control) for each in (source, target))
        source = with_own_codes(source, control)
        target = source if same else with_inert(target, self.inert)
        same = source is target
        planes = treatment(same, [step for step in steps if isinstance(step, Pass)], machine)
        return {
            "source": with_planes(source, planes),
            "target": with_planes(target, planes if same else "refused"),
            "passes": steps,
            "budget": None if self.budget is None else limit("budget", self.budget),
            "growth": None if self.growth is None else limit("growth", self.growth),
            "words": arguments.chosen("words", self.words, WORDS),
            "structure": arguments.chosen("structure", self.structure, STRUCTURES),
            "decimals": {
                arguments.chosen("decimals", letter, tuple(ascii_uppercase)): arguments.whole(
                    f"decimals of {letter}", count, MOST_DECIMALS
                )
                for letter, count in arguments.table("decimals", self.decimals).items()
            },
        }

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

    # --- what a run is told ---

    @property
    def to_fill_in(self) -> Open:
        """The places of values that its files leave to be filled in, by their keys."""
        return {**self.open, **(self.machine.open if self.machine else {})}

    @cached_property
    def path_passes(self) -> tuple[Pass, ...]:
        """The passes that change the path."""
        return tuple(step for step in self.passes if isinstance(step, Pass))

    @cached_property
    def text_passes(self) -> tuple[TextPass, ...]:
        """The passes that change text only; they run on what is written."""
        return tuple(step for step in self.passes if isinstance(step, TextPass))

    @cached_property
    def manner(self) -> Manner:
        """How the program is written."""
        numbers = self.numbers or self.target.numbers
        manner = Manner(
            self.source,
            self.target,
            numbers,
            self.words,
            self.decimals,
            expands_cycles(self.path_passes),
            curves=self.machine_reading.curves,
            said=self.saying,
            foreign_cycles=foreign_cycles(self.source, self.target, self.saying.taps_in_step),
        )
        promised = self.promised()
        if not np.isfinite(promised):
            promised = max((self.budget or 0.0) - self._repeated * manner.rounding(False), 0.0)
        rule = self.source.cycle_rule
        open_place = rule is not None and rule.place_is_open(self.machine_reading.control)
        compensating = compensates(self.path_passes)
        manner = replace(manner, compensates=compensating, open_place=open_place)
        return replace(manner, promised=promised, spares=spared_by(self.path_passes))

    @cached_property
    def keeps_tips(self) -> bool:
        """Whether codes that follow the tip are read, and stay."""
        return self.source.name == self.target.name and keeps_tip_codes(self.path_passes)

    @property
    def read_as(self) -> type[Dialect]:
        """The dialect in which programs are read: with what a pass does instead of the control."""
        if self.keeps_tips:
            return self.source
        return tip_codes.read_as(self.source, self.machine_reading.control, self._demands)

    def without_tip_codes(self, source: Source) -> tuple[Source, type[Dialect]]:
        """Return a program without what a pass does instead of the control, and its dialect."""
        return tip_codes.read_plainly(source, self.source, self.read_as, self._demands)

    @property
    def _demands(self) -> list[Demands]:
        return [step.demands for step in self.path_passes]

    @cached_property
    def machine_reading(self) -> Reading:
        """What is known of programs before they are read, with what the machine file says."""
        reading = self.reading if self.machine is None else self.reading.on(self.machine)
        expands, same = expands_cycles(self.path_passes), self.source is self.target
        folds = any(WORKPIECE_FRAME in step.ensures for step in self.path_passes)
        open_pecks, tables_stay = same and not expands, same and not folds
        counts = not same or expands or folds or not says_the_same(self.path_passes)
        counts |= any(METRIC in step.ensures for step in self.path_passes)
        stays = writes_back(self) and not self.copies
        reading = replace(reading, open_pecks=open_pecks, tables_stay=tables_stay)
        curves = not same or any(LINEAR_ONLY in step.ensures for step in self.path_passes)
        own = self.source.translator is self.target.translator and not (same or stays)
        reading = replace(reading, curves=curves, stays=stays, asides=own)
        open_ = self._open_unit(counts) if not reading.units else ""
        tips = self.keeps_tips and any(asked.turns_tips for asked in self._demands)
        reading = replace(reading, compensates=compensates(self.path_passes), keeps_tips=tips)
        return replace(
            reading, crosses=not same, turns_plainly=folds, modes_count=counts, unit_open=open_
        )

    def _open_unit(self, counts: bool) -> str:
        """Return what is done where a setting decides in which unit a program begins."""
        if not self.source.program_rule.unit_is_set:
            return ""
        says_it = any(METRIC in step.ensures for step in self.path_passes)
        if says_it or self.source is not self.target:
            return "refused"
        cuts = any(not step.demands.keeps_rows for step in self.path_passes)  # by lengths in mm
        return "told" if counts or cuts else ""

    def reading_at_start(self, axes: str) -> Reading:
        """Return what is known at the start; where only programmed words are written, 0 for axes.

        Those are the axes in `axes` whose place is not given.
        """
        reading = self.machine_reading
        if self.words != "programmed":
            return reading
        zeros = {axis: 0.0 for axis in axes if axis in LINEAR}
        return replace(reading, start={**zeros, **reading.start})

    def reading_of_output(self, reading: Reading) -> Reading:
        """Return what is known of the text written, which may be for another machine."""
        for file in filter(None, (step.demands.written_for for step in self.path_passes)):
            offsets, homes = file.machine.work_offsets, file.machine.homes
            reading = replace(reading, work_offsets=offsets, homes=homes)
        if self.source.name != self.target.name:  # of its codes the machine file says nothing
            reading = replace(reading, inert_m=frozenset())
        return replace(reading, units=self.first_units)

    @property
    def first_units(self) -> str:
        """The units the output starts in: those of its control before the program."""
        if self.source is self.target and self.reading.units:
            return self.reading.units
        return "in" if self.target.initial["units"] == "G20" else "mm"

    @property
    def context(self) -> PassContext:
        """What the passes are told."""
        return PassContext(
            self.source,
            self.target,
            self.numbers or self.target.numbers,
            self.machine,
            self.decimals,
            self.saying,
            self.keeps_tips,
        )

    @cached_property
    def saying(self) -> Saying:
        """How the target says what codes of the source do."""
        folds = any(WORKPIECE_FRAME in step.ensures for step in self.path_passes)
        tips = self.source.tip_rule.codes if folds and self.source is not self.target else {}
        return Saying(self.source, self.target, self.m_codes, self.drop, tips, self.taps)

    @property
    def copies(self) -> bool:
        """Whether there is nothing to do but to copy."""
        otherwise = self.m_codes or self.drop
        return not self.path_passes and self.source is self.target and not otherwise

    def rounding(self, inch: bool = False) -> float:
        """Return the largest distance (mm) that rounding alone can make, for blocks in a unit.

        Where distances are written, what is off in one block stays in the next: twice as much.
        """
        return self._repeated * self.manner.rounding(inch)

    @cached_property
    def _repeated(self) -> int:
        """How often a rounding can count: twice where blocks may be incremental."""
        return 1 if ABSOLUTE in facts_after(self.path_passes) else 2

    def promised(self) -> float:
        """Return the sum of what the passes promise (mm); inf if one promises nothing."""
        return sum(step.promise for step in self.path_passes) + self.chord_error

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
        """Return how far (deg) rotary axes may be off; `written`: beside what passes proved."""
        steps = self.path_passes[resolved(self.path_passes) if written else 0 :]
        promised = sum(step.demands.promise_angle for step in steps)
        return {a: promised + 1.01 * self.manner.step(a, False) for a in ROTARY}

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
