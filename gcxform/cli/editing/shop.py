"""Which pipeline a program in an editor is read by: that of its folder, or what the editor says.

A pipeline is kept until its files are other ones. A program of which nothing says the dialect is
read in that which it is guessed to be in.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from dataclasses import field, fields, replace
from pathlib import Path
from typing import Any, Final, NamedTuple

from gcxform.cli.common.request import Asked
from gcxform.diagnostics import Diagnostic, FileError, Location, UsageError
from gcxform.guess import guess_dialect
from gcxform.pipeline.pipeline import Pipeline
from gcxform.syntax.source import Source
from gcxform.values import dataclass

DEFAULT_FORMAT: Final = "strip comments=false"
NO_DIALECT: Final = "GX722"
Stamp = tuple[tuple[str, float], ...]


@dataclass(frozen=True)
class Wishes:
    """What an editor says (`initializationOptions`); a pipeline file goes before it.

    dialect, machine  those of programs without a pipeline file that names them
    format            the chain of text passes that formatting runs
    """

    dialect: str | None = None
    machine: str | None = None
    format: str = DEFAULT_FORMAT

    @classmethod
    def of(cls, given: object) -> Wishes:
        """Return what an editor says; what is not understood is left out."""
        said = given if isinstance(given, Mapping) else {}
        known = {each.name for each in fields(cls)}
        return cls(**{k: v for k, v in said.items() if k in known and isinstance(v, str) and v})


class Found(NamedTuple):
    """The pipeline of a program, None with what is wrong with it.

    `guessed` is the dialect if that was guessed, `file` the pipeline file if there is one.
    """

    pipeline: Pipeline | None
    wrong: tuple[Diagnostic, ...] = ()
    guessed: str = ""
    file: str = ""


@dataclass
class Shop:
    """The pipelines of programs, by their names."""

    wishes: Wishes = field(default_factory=Wishes)
    _kept: dict[str, tuple[Stamp, Found]] = field(default_factory=dict)

    def forget(self, path: str) -> None:
        """Forget the pipeline of a program: it is looked for, and guessed, anew."""
        self._kept.pop(path, None)

    def pipeline(self, path: str, data: bytes) -> Found:
        """Return the pipeline of a program."""
        kept = self._kept.get(path)
        if kept is None or kept[0] != _stamp(file for file, _ in kept[0]):
            found, files = self._sought(path, data)
            kept = self._kept[path] = _stamp(files), found
        return kept[1]

    def _sought(self, path: str, data: bytes) -> tuple[Found, list[str]]:
        """Return the pipeline of a program, and the files on which that depends."""
        files = [str(folder / "gcxform.toml") for folder in Path(path).absolute().parents]
        try:
            asked = Asked().beside(path)
            if not asked.says_chain:
                asked = Asked(chain="", **self._said())
            files += [str(each) for each in (asked.file, asked.machine) if each]
            found = _built(asked, data)._replace(file=asked.file or "")
        except (UsageError, FileError) as error:
            return Found(None, error.diagnostics), files
        machine = found.pipeline.machine if found.pipeline else None
        return found, [*files, *([str(machine.file)] if machine else [])]

    def _said(self) -> dict[str, Any]:
        machine = self.wishes.machine
        return {"dialect": self.wishes.dialect, "machine": machine}

    def text_chain(self, path: str, data: bytes, chain: str) -> Pipeline:
        """Return a pipeline of text passes for a program. Raises UsageError."""
        found = self.pipeline(path, data)
        if found.pipeline is None:
            raise UsageError(found.wrong)
        name = found.pipeline.source.name
        steps = Asked(chain=chain, dialect=name).build()
        return replace(found.pipeline, passes=steps.passes, target=found.pipeline.source)


def _built(asked: Asked, data: bytes) -> Found:
    """Return the pipeline that is asked for, of a guessed dialect if none is said."""
    try:
        return Found(asked.build())
    except UsageError as error:
        if [each.code for each in error.diagnostics] != [NO_DIALECT]:
            raise
    guess = guess_dialect(Source.of_bytes(data))
    if not guess.dialects:
        where, hint = Location(""), 'dialect = "..." in [input] of gcxform.toml'
        raise UsageError.one(NO_DIALECT, "which dialect is the program in?", where, hint)
    return Found(replace(asked, dialect=guess.dialects[0]).build(), (), guess.dialects[0])


def _stamp(files: Iterator[str] | list[str]) -> Stamp:
    """Return when files were written, 0 for those that are not there."""
    found = []
    for file in files:
        try:
            found.append((file, os.stat(file).st_mtime))
        except OSError:
            found.append((file, 0.0))
    return tuple(found)
