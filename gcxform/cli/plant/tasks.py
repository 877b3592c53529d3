"""What is to be done: every program by every pipeline for every machine, each a task.

A manifest says it in TOML, a command line for one list of programs:

    format = 1
    [[batch]]
    name = "milling"
    programs = ["programs/mill", "programs/long.nc"]
    pipelines = ["compensate.toml"]
    machines = ["vf2.toml", "vf3.toml"]

Results lie in `OUT/NAME/PIPELINE/MACHINE/`, below which programs lie as below what was named; a
part that is not said is left out.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterator, Sequence
from dataclasses import asdict, replace
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any, Final

import msgspec

from gcxform.cli.common.request import Asked
from gcxform.cli.plant.stores import is_url, programs_below
from gcxform.config.keys import says
from gcxform.config.schemas import format_schema, headed, of_toml
from gcxform.config.toml_text import Codes, TomlText, convert, read_toml
from gcxform.diagnostics import FileError, UsageError
from gcxform.system import limits
from gcxform.system.inputs import is_anywhere
from gcxform.system.limits import Limits
from gcxform.values import dataclass

CODES: Final = Codes("GX709", "GX710", "GX701", "GX705", "GX702")
Names = list[Annotated[str, msgspec.Meta(min_length=1)]]


@dataclass(frozen=True)
class Task:
    """One program by one pipeline for one machine; `below` is where its result lies in `root`.

    `limits` and `anywhere` are what the command line says for all: processes do not inherit it.
    """

    program: str
    below: str
    root: str
    asked: Asked
    verify: str = "on"
    limits: Limits | None = None
    anywhere: bool = False

    @cached_property
    def key(self) -> str:
        """What the task is known by in files and by schedulers."""
        names = json.dumps([self.program, self.below, self.options])
        return hashlib.sha256(names.encode()).hexdigest()[:24]

    @property
    def options(self) -> str:
        """What was said of it, as text."""
        said = {key: value for key, value in asdict(self.asked).items() if value}
        limits = None if self.limits is None else asdict(self.limits)
        said |= {"verify": self.verify, "limits": limits, "anywhere": self.anywhere}
        return json.dumps(said, sort_keys=True)

    @property
    def pipeline(self) -> str:
        """The pipeline, as it was named."""
        return self.asked.file or self.asked.chain or ""

    @property
    def machine(self) -> str:
        """The machine file, as it was named; nothing if the pipeline names it, or none is."""
        return self.asked.machine or ""


class Entry(msgspec.Struct, forbid_unknown_fields=True, rename="kebab"):
    """One list of programs, and what is done with each of them."""

    programs: Annotated[Names, says("programs, folders of them, or URLs")]
    name: Annotated[str, says("the folder of the results, below that of all")] = ""
    pipelines: Annotated[Names, says("pipeline files")] = []
    machines: Annotated[Names, says("machine files")] = []
    chain: Annotated[str | None, says("passes, instead of pipeline files")] = None
    dialect: Annotated[str | None, says("the dialect of the programs, for a chain")] = None
    to: Annotated[str | None, says("the dialect that is written, for a chain")] = None

    def tasks(self, root: str, verify: str, folder: str = "") -> Iterator[Task]:
        """Yield what is to be done; names of files count from `folder`. Raises GcxformError."""
        for asked, below in self._ways(folder):
            for name in self.programs:
                for program, place in programs_below(_from(folder, name)):
                    found = asked if is_url(program) else asked.beside(program)
                    path = "/".join([*filter(None, (self.name, *below)), place])
                    yield Task(program, path, root, found, verify, limits.said(), is_anywhere())

    def _ways(self, folder: str) -> Iterator[tuple[Asked, tuple[str, ...]]]:
        """Yield the pipelines for the machines, with the folders of their results."""
        said = Asked(chain=self.chain, dialect=self.dialect, to=self.to)
        for pipeline in self.pipelines or [""]:
            for machine in self.machines or [""]:
                names = tuple(Path(each).stem for each in (pipeline, machine) if each)
                files = [_from(folder, each) if each else None for each in (pipeline, machine)]
                yield replace(said, pipeline=files[0], machine=files[1]), names


class Manifest(msgspec.Struct, forbid_unknown_fields=True):
    """A manifest: what is done with which programs."""

    format: Annotated[int, says("1"), msgspec.Meta(ge=1, le=1)]
    batch: Annotated[list[Entry], says("lists of programs, with what is done with each")]


def schema() -> dict[str, Any]:
    """Return the JSON Schema of manifests."""
    found: dict[str, Any] = of_toml(msgspec.json.schema(Manifest))
    found["$defs"]["Manifest"]["properties"]["format"] = format_schema(1)
    return headed("manifest", found)


def load_manifest(path: Path) -> list[Entry]:
    """Return the lists of programs of a manifest. Raises UsageError with places in the file."""
    document: TomlText = read_toml(path, CODES)
    return convert(document, Manifest).batch


def tasks_of(entries: Sequence[Entry], root: str, verify: str, folder: str = "") -> list[Task]:
    """Return all tasks. Raises UsageError where two have one place, or a pipeline is wrong.

    Pipelines and machine files are built once here, so that what is wrong with one is said before
    a program is read.
    """
    found: dict[str, Task] = {}
    built: set[Asked] = set()
    for entry in entries:
        for task in entry.tasks(root, verify, folder):
            same = found.setdefault(task.below, task)
            if same is not task:
                message = f"{same.program} and {task.program} would both be written to {task.below}"
                raise UsageError.one("GX749", message, hint="give each list a name of its own")
            if task.asked not in built:
                task.asked.build()
                built.add(task.asked)
    if not found:
        raise FileError.one("GX901", "there are no programs")
    _check_outside(found.values(), root)
    return list(found.values())


def _check_outside(tasks: Any, root: str) -> None:
    """Raise UsageError where a result would replace its program."""
    if is_url(root):
        return
    for task in tasks:
        if os.path.realpath(task.program) == os.path.realpath(os.path.join(root, task.below)):
            message = f"{task.program} would be replaced by its result"
            raise UsageError.one("GX727", message, hint="-o with another folder")


def _from(folder: str, name: str) -> str:
    return name if is_url(name) or not folder else os.path.join(folder, name)
