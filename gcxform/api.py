"""Programs in memory: `read` and `write` of `import gcxform as gx`, and what they hold."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from gcxform.config import arguments
from gcxform.contract.own_codes import with_own_codes
from gcxform.contract.tilted_planes import with_known_planes
from gcxform.diagnostics import InputError, Location
from gcxform.dialect.dialect import Dialect
from gcxform.errormodel.model import ErrorModel
from gcxform.errormodel.model_file import load_model
from gcxform.flow.straightened import located, written_out
from gcxform.machine.file import load_machine
from gcxform.machine.machine import Machine
from gcxform.modal.interpreter import Interpreter
from gcxform.modal.reader import WindowReader
from gcxform.modal.state import Reading
from gcxform.notebook import drawn, shown
from gcxform.pipeline.pipeline import Result
from gcxform.plugin.registry import default_registry, dialect_of
from gcxform.syntax.source import Source, program_of
from gcxform.system.distinct import one_of
from gcxform.system.files import write_atomically
from gcxform.toolpath.columns import COLUMNS
from gcxform.toolpath.drawn import strokes
from gcxform.toolpath.path import BLOCK_MODES, Form, Toolpath
from gcxform.values import dataclass

AROUND = (Form.NURBS, Form.TILTED)
"""Legs between control points."""
SHOWN = 400  # characters of a program that a notebook shows


def write(result: Result | bytes, path: str | Path) -> None:
    """Write a result's program to a file, whole or not at all. Raises FileError."""
    text = result.text if isinstance(result, Result) else result
    arguments.instance("result", text, bytes, "the result of a run, or bytes")
    arguments.instance("path", path, (str, Path), "a path")
    with write_atomically(Path(path)) as put:
        put(text)


@dataclass(frozen=True)
class Program:
    """A program in memory, and what its dialect says it does.

    `path` is its whole toolpath; asking for it raises InputError where the program is refused.
    Codes that the machine file declares are of the dialect; UsageError for those that it has.
    Tilted planes are followed where it says what turns the table.
    """

    text: bytes
    dialect: type[Dialect]
    reading: Reading = field(default_factory=Reading)
    name: str = "-"

    def __post_init__(self) -> None:
        kind = with_own_codes(self.dialect, self.reading.control)
        object.__setattr__(self, "dialect", with_known_planes(kind, self.reading))

    @cached_property
    def path(self) -> Toolpath:
        """The moves of the whole program: mm and degrees; its lines are those of `executed`."""
        source = self._executed
        try:
            return self._read(source)
        except InputError as error:
            raise located(error, source) from None

    @cached_property
    def curved(self) -> Toolpath:
        """The moves, with curves in place of the legs between control points that they stay in."""
        if not one_of(self.path.form, AROUND).any():
            return self.path
        return replace(self, reading=replace(self.reading, curves=True)).path

    @cached_property
    def _executed(self) -> Source:
        return written_out(Source.of_bytes(self.text, self.name), self.dialect, self.reading)

    @property
    def executed(self) -> bytes:
        """The blocks that the control executes: the text itself, but for calls and loops."""
        return b"".join(self._executed.windows())

    def line_of(self, line: int) -> int:
        """Return the line of the text, from 1, of an executed line; 0 stands for none."""
        return self._executed.line_of(line)

    def place_of(self, line: int) -> tuple[str, int]:
        """Return the file, and its line, from 1, of an executed line."""
        return self._executed.place_of(line)

    def located(self, error: InputError) -> InputError:
        """Return an error about executed lines as one about those of the text, which it shows."""
        texts, found = self.executed.split(b"\n"), []
        for diagnostic in error.diagnostics:
            where = diagnostic.where
            if where is not None and where.line and where.file in ("", self.name):
                text = texts[where.line - 1].decode("latin-1").rstrip("\r")
                start = len(text) - len(text.lstrip()) + 1
                bare = Location("", 0, start, text, max(1, len(text.strip())))
                place = replace(where if where.text else bare, file=self.name)
                diagnostic = diagnostic.at(self._executed.shown(replace(place, line=where.line)))
            found.append(diagnostic)
        return InputError(tuple(found))

    def _repr_html_(self) -> str:
        """Return what a notebook shows: the moves, where they go, and a picture; or the refusal."""
        rows: list[tuple[str, object]] = [("dialect", self.dialect.name)]
        try:
            path = self.path
        except InputError as error:
            return shown(self.name, rows, text=str(error))
        rows.append(("moves", len(path)))
        for axis, ends in zip(path.axes, path.end.T, strict=True):
            if len(known := ends[np.isfinite(ends)]):
                rows.append((axis, f"{known.min():g} to {known.max():g}"))
        head = self.text[:SHOWN].decode("latin-1").rpartition("\n")[0]
        return shown(self.name, rows, drawn(strokes(path), "the path"), head)

    def _read(self, source: Source) -> Toolpath:
        axes = self.reading.axes_of(source, self.dialect)
        interpreter = Interpreter(self.dialect, self.reading, axes, self.name)
        interpreter.undecided = source.undecided
        reader = WindowReader(self.dialect)
        texts = [*source.windows()] or [b""]
        windows = (reader.read(text) for text in texts)
        return joined([interpreter.interpret(w, reader.table).path for w in windows])


def read(
    program: bytes | str | Path,
    dialect: str | type[Dialect],
    machine: str | Path | Machine | None = None,
    **reading: Any,
) -> Program:
    """Return a program: its bytes, or the file of that name.

    `reading` is what the program does not say of itself: `start`, `increment`, `feed`, `tool`,
    `block_delete`, `units`, as in `Reading`; `machine` a machine file, whose offsets, homes, tools
    and settings count. Raises FileError, and UsageError for the dialect and the machine file.
    """
    kind, said = dialect_of(dialect), Reading(**reading)
    if machine is not None:
        said = said.on(_machine_of(machine))
    source = program_of(program)
    with source.stream as stream:
        return Program(stream.read(), kind, said, source.name)


def _machine_of(given: object) -> Machine:
    """Return a machine that is given as itself, or by its file. Raises UsageError."""
    if isinstance(given, str | Path):
        return load_machine(Path(given), default_registry().machines)
    arguments.instance("machine", given, Machine, "a machine file, or what it was loaded to")
    assert isinstance(given, Machine)
    return given


def read_model(path: str | Path) -> ErrorModel:
    """Return the error model of a file, TOML or a format of a plugin. Raises UsageError."""
    arguments.instance("path", path, (str, Path), "a path")
    return load_model(Path(path), tuple(default_registry().formats.values()))


def joined(parts: Sequence[Toolpath]) -> Toolpath:
    """Return toolpaths of the windows of one program as one toolpath."""
    counts = np.cumsum([0, *(len(part) for part in parts)])
    columns = {name: np.concatenate([getattr(p, name) for p in parts]) for name in COLUMNS}
    events = tuple(
        event.at(event.row + int(first))
        for part, first in zip(parts, counts[:-1], strict=True)
        for event in part.events
    )
    before = np.cumsum([0, *(len(part.frames) for part in parts)])
    columns["frame"] = np.concatenate(
        [part.frame + int(first) for part, first in zip(parts, before[:-1], strict=True)]
    )
    frames = tuple(frame for part in parts for frame in part.frames)
    modes: dict[str, Any] = {
        name: np.concatenate([getattr(p.blocks, name) for p in parts]) for name in BLOCK_MODES
    }
    blocks = replace(parts[0].blocks, **modes)
    return parts[0].replace(**columns, events=events, blocks=blocks, frames=frames)
