"""Pipelines as a user writes them: a TOML file.

    format = 1
    [input]
    dialect = "fanuc"
    [[pass]]
    use = "segment"
    chord-error = "2 um"

Whatever is not understood is an error with its place. Relative paths are relative to the file.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import field, replace
from functools import partial
from pathlib import Path
from typing import Annotated, Any, Final, Literal, TypeVar

from gcxform.config.to_fill_in import Open, split_open
from gcxform.config.toml_text import Codes, TomlText, read_toml
from gcxform.contract.options import (
    CodeList,
    CodeTable,
    Coordinates,
    FeedIncrement,
    FolderList,
    Increment,
    Length,
    Option,
    ParameterValues,
    build,
    describe,
)
from gcxform.contract.passes import Pass, TextPass
from gcxform.contract.tolerance_warnings import doubts_of
from gcxform.diagnostics import Diagnostic, UsageError
from gcxform.plugin.registry import Registry
from gcxform.system.limits import Limits, in_force
from gcxform.values import dataclass

CODES = Codes("GX709", "GX710", "GX701", "GX705", "GX702")
FORMAT: Final = 1

Step = Pass | TextPass
Section = TypeVar("Section")


@dataclass(frozen=True)
class InputSpec:
    """The section `[input]`: what has to be known of the program."""

    dialect: Annotated[str | None, Option("the controller the program is for")] = None
    start: Annotated[Coordinates, Option("where the axes are at the start")] = field(
        default_factory=dict
    )
    increment: Annotated[
        Increment | None, Option("what 1 means in a distance without a point", above=0.0)
    ] = None
    feed: Annotated[
        float | None, Option("feed before the first F word, in units per minute", above=0.0)
    ] = None
    feed_increment: Annotated[
        FeedIncrement | None,
        Option("what 1 means in an F without a point, per minute", above=0.0),
    ] = None
    tool: Annotated[
        int | None, Option("the tool in the spindle before the first block", above=0.0)
    ] = None
    block_delete: Annotated[
        Literal["execute", "skip", ""], Option("what the control does with / blocks")
    ] = ""
    units: Annotated[
        Literal["mm", "in", ""],
        Option("units before the first G20 or G21; absent: those in which its control begins"),
    ] = ""
    parameters: Annotated[
        ParameterValues, Option("values of parameters that the program reads and does not set")
    ] = field(default_factory=dict)
    subprograms: Annotated[
        FolderList, Option("folders of subprograms, besides that of the program")
    ] = ()
    again: Annotated[bool, Option("take stamped programs too, as if they were not stamped")] = False


@dataclass(frozen=True)
class EntrySpec:
    """The section `[entry]`: how a subprogram is called that stands in a file by itself."""

    modes: Annotated[str, Option("codes in force where it is called, such as G91 G21 G94")] = ""
    start: Annotated[Coordinates, Option("where the axes are then")] = field(default_factory=dict)
    feed: Annotated[float | None, Option("the feed then, in units per minute", above=0.0)] = None
    parameters: Annotated[
        ParameterValues, Option("values of parameters then, and of its arguments")
    ] = field(default_factory=dict)


@dataclass(frozen=True)
class OutputSpec:
    """The section `[output]`: how the program is written."""

    dialect: Annotated[str | None, Option("the controller to write for")] = None
    decimals: Annotated[
        int | dict[str, int] | None, Option("decimals of numbers", at_least=0, at_most=6)
    ] = None
    words: Annotated[
        Literal["changed", "programmed", "all"], Option("which axes a changed block names")
    ] = "changed"
    trailing_zeros: Annotated[bool | None, Option("write 1.500 instead of 1.5")] = None
    stamp: Annotated[bool, Option("say in comments what was done to positions")] = True
    structure: Annotated[
        Literal["keep", "written-out"], Option("what becomes of subprograms and loops")
    ] = "keep"
    m_codes: Annotated[
        CodeTable, Option("M codes of the source, and what takes the place of each")
    ] = field(default_factory=dict)
    drop: Annotated[CodeList, Option("codes of the source that are left out")] = ()
    inert: Annotated[
        CodeList, Option("M codes of the control written for that leave its axes where they stand")
    ] = ()
    taps: Annotated[
        Literal["", "alike", "in-step"],
        Option("what the spindle does in G74 and G84 of another control"),
    ] = ""


@dataclass(frozen=True)
class PipelineSpec:
    """A pipeline as written: input, entry, machine file, budget (mm), growth, passes, output.

    `warnings` is what is odd in it, and no error; `open` has the places of values in `[input]` that
    are left to be filled in.
    """

    input: InputSpec = field(default_factory=InputSpec)
    machine: Path | None = None
    budget: float | None = None
    growth: float | None = None
    passes: tuple[Step, ...] = ()
    output: OutputSpec = field(default_factory=OutputSpec)
    file: Path | None = None
    warnings: tuple[Diagnostic, ...] = field(default=(), compare=False)
    limits: Limits | None = None
    open: Open = field(default_factory=dict, compare=False)
    entry: EntrySpec = field(default_factory=EntrySpec)


@dataclass(frozen=True)
class _MachineSection:
    """The section `[machine]`: the machine that the program is for."""

    file: Annotated[Path, Option("the machine file")]


@dataclass(frozen=True)
class _BudgetSection:
    """The section `[budget]`: how far a result may be off, and how much longer it may be."""

    deviation: Annotated[
        Length | None, Option("what all steps together may deviate", above=0.0)
    ] = None
    growth: Annotated[
        float | None, Option("blocks that may be written for each one read", above=0.0)
    ] = None


SECTIONS: Final[Mapping[str, type]] = {
    "input": InputSpec,
    "entry": EntrySpec,
    "machine": _MachineSection,
    "budget": _BudgetSection,
    "output": OutputSpec,
    "limits": Limits,
}
FILLED_IN: Final = ("input",)
"""The sections in which a value may be left to be filled in."""
KEYS: Final = ("format", *SECTIONS, "pass")


def load(path: Path, registry: Registry) -> PipelineSpec:
    """Return the pipeline of a TOML file, its passes built.

    Raises UsageError, with places in the file, for all that is wrong with it.
    """
    document, still_open = split_open(read_toml(path, CODES), FILLED_IN)
    _check_version(document)
    reader = _Reader(document, path.parent, registry, _unknown_keys(document))
    limits = reader.section("limits", Limits)
    with in_force(limits):
        return replace(_spec(reader, path), limits=limits, open=still_open)


def _spec(reader: _Reader, path: Path) -> PipelineSpec:
    """Return what the file says besides its limits. Raises UsageError for all that is wrong."""
    document = reader.document
    machine_section = reader.section("machine", _MachineSection)
    budget = reader.section("budget", _BudgetSection)
    spec = PipelineSpec(
        input=reader.section("input", InputSpec) or InputSpec(),
        machine=machine_section.file if machine_section else None,
        budget=budget.deviation if budget else None,
        growth=budget.growth if budget else None,
        passes=reader.steps(),
        output=reader.section("output", OutputSpec) or OutputSpec(),
        file=path,
        warnings=tuple(reader.doubts()),
        entry=reader.section("entry", EntrySpec) or EntrySpec(),
    )
    reader.check_dialects(spec)
    if budget and budget.deviation is None and budget.growth is None:
        message = "[budget] needs 'deviation' or 'growth'"
        reader.found.append(Diagnostic(CODES.missing_key, message, document.where("budget")))
    if reader.found:
        raise UsageError(tuple(reader.found))
    return spec


def _check_version(document: TomlText) -> None:
    version = document.values.get("format")
    if version is None:
        message = "the key 'format' is missing"
        hint = f"begin the file with: format = {FORMAT}"
        raise UsageError.one(CODES.missing_key, message, document.where(), hint)
    if version != FORMAT or isinstance(version, bool):
        message = f"format {version!r} of pipelines is not known, only format = {FORMAT} is"
        raise UsageError.one("GX711", message, document.where("format"))


def _unknown_keys(document: TomlText) -> list[Diagnostic]:
    wrong = (key for key in document.values if key not in KEYS)
    return [d for key in wrong for d in document.unknown_key((key,), KEYS).diagnostics]


class _Reader:
    """Reads the parts of a pipeline file and gathers what is wrong in `found`."""

    def __init__(
        self, document: TomlText, base: Path, registry: Registry, found: list[Diagnostic]
    ) -> None:
        self.document, self.base, self.registry, self.found = document, base, registry, found

    def section(self, name: str, target: type[Section]) -> Section | None:
        """Return a section, None if it is not there or wrong."""
        raw = self.document.values.get(name)
        if raw is None:
            return None
        where = partial(self.document.where, name)
        if not isinstance(raw, dict):
            message = f"{name}: expected a table, [{name}]"
            self.found.append(Diagnostic("GX702", message, where()))
            return None
        try:
            return build(target, raw, self.base, (), where, f"[{name}]")
        except UsageError as error:
            self.found += error.diagnostics
            return None

    def steps(self) -> tuple[Step, ...]:
        """Return the passes that are right."""
        raw = self.document.values.get("pass", [])
        if not isinstance(raw, list) or not all(isinstance(step, dict) for step in raw):
            where = self.document.where("pass")
            hint = "write [[pass]], with two brackets, for each step"
            self.found.append(Diagnostic("GX702", "pass: expected a list of tables", where, hint))
            return ()
        steps = []
        for k, step in enumerate(raw):
            try:
                steps.append(self._step(k, step))
            except UsageError as error:
                self.found += error.diagnostics
        return tuple(steps)

    def _step(self, k: int, raw: Mapping[str, Any]) -> Step:
        where = partial(self.document.where, "pass", k)
        name = raw.get("use")
        if name is None:
            hint = 'add the name of a pass: use = "..."'
            raise UsageError.one("GX705", f"step {k + 1} lacks the key 'use'", where(), hint)
        if not isinstance(name, str):
            raise UsageError.one("GX702", "use: expected the name of a pass", where("use"))
        chosen = self.registry.pass_(name, where("use"))
        options = {key: value for key, value in raw.items() if key != "use"}
        return built(chosen, options, self.base, self.registry, where)

    def doubts(self) -> Iterator[Diagnostic]:
        """Yield warnings about tolerances of the file."""
        document = self.document
        steps = document.values.get("pass", [])
        for k, step in enumerate(steps if isinstance(steps, list) else []):
            if isinstance(step, dict):
                yield from doubts_of(step, partial(document.where, "pass", k))
        budget = document.values.get("budget")
        if isinstance(budget, dict):
            yield from doubts_of(budget, partial(document.where, "budget"))

    def check_dialects(self, spec: PipelineSpec) -> None:
        """Look the dialects up."""
        for name, dialect in (("input", spec.input.dialect), ("output", spec.output.dialect)):
            if dialect is not None:
                try:
                    self.registry.dialect(dialect, self.document.where(name, "dialect"))
                except UsageError as error:
                    self.found += error.diagnostics


DIRECTIONS = ("to-machine", "to-tip", "repost", "retarget")
"""What an option of `rtcp` said, which is passes of their own now."""


def built(
    chosen: type[Step], options: Mapping[str, object], base: Path, registry: Registry, where: Any
) -> Step:
    """Return a pass with its options; `where` gives the place of a key. Raises UsageError."""
    formats, machines = registry.formats.values(), registry.machines

    def elsewhere(key: str, value: object) -> str:
        if key == "direction" and value in DIRECTIONS:
            other = value in registry.passes and value != chosen.name
            return f'write "{value}" in the place of "{chosen.name}"' if other else "leave it out"
        takers = [n for n, p in registry.passes.items() if key in {o.name for o in describe(p)}]
        return f'it is an option of "{takers[0]}"' if len(takers) == 1 else ""

    return build(chosen, options, base, formats, where, machines=machines, elsewhere=elsewhere)
