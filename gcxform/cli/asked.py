"""What a command line says of pipelines and programs, and the pipeline that is built from it."""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

from gcxform.cli.options import ENVIRONMENT
from gcxform.diagnostics import Location, UsageError
from gcxform.machine.machine import Machine
from gcxform.machine.machinefile import load_machine
from gcxform.modal.state import Reading
from gcxform.options import Argument, build
from gcxform.pipeline import Pipeline
from gcxform.pipelinefile import InputSpec, PipelineSpec, load, parse_chain
from gcxform.registry import Registry, default_registry


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

    @property
    def file(self) -> str | None:
        """The pipeline file: that of the command line, else that of the environment."""
        if self.pipeline is None and self.chain is None:
            return os.environ.get(ENVIRONMENT) or None
        return self.pipeline

    @property
    def says_chain(self) -> bool:
        """Whether a pipeline is named at all."""
        return self.chain is not None or self.file is not None

    @cached_property
    def loaded_machine(self) -> Machine | None:
        """The machine that is named, None if none is. Raises UsageError for what is wrong in it."""
        kinds = default_registry().kinematics
        return load_machine(Path(self.machine), kinds) if self.machine else None

    def build(self, registry: Registry | None = None) -> Pipeline:
        """Return the pipeline. Raises UsageError."""
        registry = registry or default_registry()
        spec = self._spec(registry)
        spec = replace(spec, input=self._merged(spec.input))
        machine = Path(self.machine) if self.machine else None
        return Pipeline.of_spec(spec, registry, self.dialect or "", self.to or "", machine)

    def _spec(self, registry: Registry) -> PipelineSpec:
        if self.pipeline is not None and self.chain is not None:
            raise excluding("-p and -x")
        if self.file is not None:
            return load(Path(self.file), registry)
        if self.chain is None:
            raise UsageError.one(
                "GX726",
                "there is no pipeline",
                hint=f"-p FILE, -x 'absolute | ...', or set {ENVIRONMENT}; "
                "-x '' -f DIALECT is the pipeline that changes nothing",
            )
        return PipelineSpec(passes=tuple(parse_chain(self.chain, Path.cwd(), registry)))

    def _merged(self, given: InputSpec) -> InputSpec:
        """Return the section `[input]` of the file with what the command line says instead."""
        said = self.input()
        return replace(
            given,
            start={**given.start, **said.start},
            increment=given.increment if said.increment is None else said.increment,
            feed_increment=(
                given.feed_increment if said.feed_increment is None else said.feed_increment
            ),
            block_delete=said.block_delete or given.block_delete,
        )

    def input(self) -> InputSpec:
        """Return what the command line says as the section `[input]`. Raises UsageError."""
        raw: dict[str, object] = {}
        if self.start:
            raw["start"] = _pairs(self.start)
        if self.increment is not None:
            raw["increment"] = Argument(self.increment)
        if self.feed_increment is not None:
            raw["feed-increment"] = Argument(self.feed_increment)
        if self.block_delete:
            raw["block-delete"] = self.block_delete
        where = {key: f"--{key}" for key in ("start", "increment", "feed-increment")}
        return build(
            InputSpec, raw, Path.cwd(), (), lambda key: Location(where.get(key, key)), "input"
        )

    def reading(self) -> Reading:
        """Return what the command line says for reading a program without a pipeline."""
        said = self.input()
        given = (dict(said.start), said.increment, None, said.block_delete, said.units)
        reading = Reading(*given, said.feed_increment)
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
        hint=f"{option} fanuc; `gcxform list dialects`",
    )


def _pairs(text: str) -> dict[str, Argument]:
    """Return `X=4,Y=-2` as a table."""
    pairs: dict[str, Argument] = {}
    for part in text.split(","):
        axis, equals, value = part.strip().partition("=")
        axis = axis.strip().upper()
        if not equals or not axis or axis in pairs:
            raise UsageError.one(
                "GX702",
                f"{part.strip()!r} is not one axis and its position",
                Location("--start"),
                "write --start X=4,Y=-2",
            )
        pairs[axis] = Argument(value.strip())
    return pairs
