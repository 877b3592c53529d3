"""What a command line says of pipelines and programs, and the pipeline that is built from it."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from gcxform.cli.common.discovery import NAME, pipeline_above
from gcxform.cli.common.options import ENVIRONMENT
from gcxform.contract.options import Argument, build
from gcxform.contract.own_codes import with_own_codes, without_own_codes
from gcxform.diagnostics import Location, UsageError
from gcxform.dialect.dialect import Dialect
from gcxform.machine.machine import Machine
from gcxform.modal.state import Reading
from gcxform.pipeline.chain_text import chain_doubts, parse_chain
from gcxform.pipeline.file import SECTIONS, InputSpec, OutputSpec, PipelineSpec, load
from gcxform.pipeline.pipeline import Pipeline
from gcxform.plugin.registry import Registry, default_registry
from gcxform.values import dataclass

if TYPE_CHECKING:
    from gcxform.guess import Guess


@dataclass(frozen=True)
class Asked:
    """What a command line says of a pipeline; names as typed, None where nothing was said."""

    pipeline: str | None = None
    chain: str | None = None
    dialect: str | None = None
    to: str | None = None
    machine: str | None = None
    start: str | None = None
    increment: str | None = None
    block_delete: str | None = None
    feed_increment: str | None = None
    feed: str | None = None
    tool: str | None = None
    units: str | None = None
    parameters: str | None = None
    subprograms: tuple[str, ...] = ()
    entry: str | None = None
    budget: str | None = None
    growth: str | None = None
    decimals: str | None = None
    no_stamp: bool = False
    again: bool = False
    found: str | None = None
    program: str | None = None

    @property
    def file(self) -> str | None:
        """The pipeline file: of the command line, else of the environment, else of the folder."""
        if self.pipeline is None and self.chain is None:
            return os.environ.get(ENVIRONMENT) or self.found
        return self.pipeline

    def beside(self, program: str) -> Asked:
        """Return the same with the pipeline of the folder of a program if none is named.

        Raises UsageError for one that is somebody else's.
        """
        if program == "-":
            return self
        if self.says_chain:
            return replace(self, program=program)
        found = pipeline_above(Path(program))
        return replace(self, program=program, found=None if found is None else str(found))

    @property
    def says_chain(self) -> bool:
        """Whether a pipeline is named at all."""
        return self.chain is not None or self.file is not None

    @cached_property
    def loaded_machine(self) -> Machine | None:
        """The machine that is named, None if none is. Raises UsageError for what is wrong in it."""
        if not self.machine:
            return None
        from gcxform.machine.file import load_machine

        return load_machine(Path(self.machine), default_registry().machines)

    def build(self, registry: Registry | None = None) -> Pipeline:
        """Return the pipeline. Raises UsageError."""
        registry = registry or default_registry()
        spec = self._spec(registry)
        output = replace(spec.output, stamp=spec.output.stamp and not self.no_stamp)
        if self.entry is not None:
            spec = replace(spec, entry=replace(spec.entry, modes=self.entry))
        spec = self._limited(replace(spec, input=self._merged(spec.input), output=output))
        if not (self.dialect or spec.input.dialect):
            raise self._no_dialect()
        machine = Path(self.machine) if self.machine else None
        return Pipeline.of_spec(spec, registry, self.dialect or "", self.to or "", machine)

    def _spec(self, registry: Registry) -> PipelineSpec:
        if self.pipeline is not None and self.chain is not None:
            raise excluding("-p and -x")
        if self.file is not None:
            return load(Path(self.file), registry)
        if self.chain is None:
            raise self._no_pipeline()
        passes = tuple(parse_chain(self.chain, Path.cwd(), registry))
        return PipelineSpec(passes=passes, warnings=chain_doubts(self.chain))

    def _guessed(self) -> Guess | None:
        """Return in which dialects the program may be, if there is one and nobody says it."""
        from gcxform.cli.common.first_steps import guessed

        return None if self.dialect or not self.program else guessed(self.program)

    def _no_dialect(self) -> UsageError:
        """Return the error for a pipeline whose dialect nobody says."""
        guess = self._guessed()
        looks = f"{self.program} looks like {guess}; " if guess else ""
        kind = guess.dialects[0] if guess else "fanuc"
        hint = f'{looks}dialect = "{kind}" in [input]; `gcxform list dialects`'
        return UsageError.one("GX722", "which dialect is the program in?", hint=hint)

    def _no_pipeline(self) -> UsageError:
        """Return the error for a command line that says nothing of what is to be done."""
        guess = self._guessed()
        kind = guess.dialects[0] if guess else self.dialect or "DIALECT"
        looks = f"{self.program} looks like {guess}; " if guess else ""
        hint = (
            f"{looks}-x absolute -f {kind} makes its distances positions, -x '' -f {kind} changes "
            f"nothing; or a pipeline: -p FILE, {NAME} in the folder of the program, or "
            f"{ENVIRONMENT}"
        )
        return UsageError.one("GX726", "there is no pipeline", hint=hint)

    def _merged(self, given: InputSpec) -> InputSpec:
        """Return the section `[input]` of the file with what the command line says instead."""
        said = self.input()
        named = {key.replace("-", "_") for key in self._given()}
        changes = {name: getattr(said, name) for name in named}
        for name in named & {"start", "parameters"}:
            changes[name] = {**getattr(given, name), **changes[name]}
        return replace(given, again=given.again or self.again, **changes)

    def _limited(self, spec: PipelineSpec) -> PipelineSpec:
        """Return what a file says with the budget and the decimals of the command line."""
        limits = {"deviation": self.budget, "growth": self.growth}
        raw = {key: Argument(value) for key, value in limits.items() if value is not None}
        said = self._built(SECTIONS["budget"], raw)
        if said.deviation is not None:
            spec = replace(spec, budget=said.deviation)
        if said.growth is not None:
            spec = replace(spec, growth=said.growth)
        if self.decimals is None:
            return spec
        several = "=" in self.decimals
        decimals = _pairs(self.decimals, "decimals") if several else Argument(self.decimals)
        written = self._built(OutputSpec, {"decimals": decimals})
        return replace(spec, output=replace(spec.output, decimals=written.decimals))

    def input(self) -> InputSpec:
        """Return what the command line says as the section `[input]`. Raises UsageError."""
        said: InputSpec = self._built(InputSpec, self._given())
        return said

    def _given(self) -> dict[str, object]:
        """Return what is said of the program, by the keys of `[input]`."""
        keys = ("increment", "feed-increment", "block-delete", "feed", "units", "tool")
        said = {key: getattr(self, key.replace("-", "_")) for key in keys}
        raw: dict[str, object] = {key: Argument(v) for key, v in said.items() if v is not None}
        if self.start:
            raw["start"] = _pairs(self.start, "start")
        if self.parameters:
            raw["parameters"] = _pairs(self.parameters, "parameters")
        if self.subprograms:
            raw["subprograms"] = [Argument(each) for each in self.subprograms]
        return raw

    @staticmethod
    def _built(section: type[Any], raw: Mapping[str, object]) -> Any:
        """Return a section of what was said. Raises UsageError."""
        return build(section, raw, Path.cwd(), (), lambda key: Location(f"--{key}"), "input")

    def reads(self, name: str, of: str = "") -> tuple[type[Dialect], Reading]:
        """Return a dialect, with the codes of the machine file, and what is said for reading.

        `of` is the dialect of the machine, if that is another: its codes are those of no other.
        """
        kind, reading = default_registry().dialect(name), self.reading()
        if of and kind is not default_registry().dialect(of):
            reading = replace(reading, control=without_own_codes(reading.control))
        return with_own_codes(kind, reading.control), reading

    def reading(self) -> Reading:
        """Return what the command line says for reading a program without a pipeline."""
        said = self.input()
        given = (dict(said.start), said.increment, said.feed, said.block_delete, said.units)
        reading = Reading(
            *given,
            said.feed_increment,
            said.parameters,
            subprograms=said.subprograms,
            tool=said.tool,
        )
        return reading.on(self.loaded_machine) if self.loaded_machine else reading


def excluding(what: str) -> UsageError:
    """Return the error about options that cannot stand together."""
    return UsageError.one("GX728", f"{what} exclude each other", hint="leave one of them out")


def needed_dialect(name: str | None, option: str = "-f") -> str:
    """Return the dialect named, or raise UsageError."""
    if name:
        return name
    raise UsageError.one(
        "GX722",
        "which dialect is the program in?",
        hint=f"{option} DIALECT; `gcxform info FILE` says which it may be, "
        "`gcxform list dialects` which there are",
    )


WHAT: Final = {
    "start": "axis and its position",
    "decimals": "address and its decimals",
    "parameters": "parameter and its value",
}
EXAMPLES: Final = {"start": "X=4,Y=-2", "decimals": "X=4,A=3", "parameters": "100=1.5,<depth>=2"}


def _pairs(text: str, option: str) -> dict[str, Argument]:
    """Return `X=4,Y=-2` as a table; letters are those of axes or addresses."""
    pairs: dict[str, Argument] = {}
    for part in text.split(","):
        axis, equals, value = part.strip().partition("=")
        axis = axis.strip()
        axis = axis if option == "parameters" else axis.upper()
        if not equals or not axis or axis in pairs:
            raise UsageError.one(
                "GX702",
                f"{part.strip()!r} is not one {WHAT[option]}",
                Location(f"--{option}"),
                f"write --{option} {EXAMPLES[option]}",
            )
        pairs[axis] = Argument(value.strip())
    return pairs
