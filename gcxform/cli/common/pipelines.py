"""The pipeline of each program: the one that is named, or the one of its folder."""

from __future__ import annotations

from dataclasses import field

import click

from gcxform.cli.common.answer import asked as document
from gcxform.cli.common.failures import FOUND, say, warn
from gcxform.cli.common.request import Asked
from gcxform.diagnostics import shown
from gcxform.pipeline.pipeline import Pipeline
from gcxform.plugin.registry import default_registry
from gcxform.values import dataclass


@dataclass
class Pipelines:
    """Pipelines by the file that they are read from; each is built once.

    `warns`: what is odd in them is said; `says`: which was found in the folder of a program.
    """

    asked: Asked
    warns: bool = True
    says: bool = True
    built: dict[str | None, Pipeline] = field(default_factory=dict)

    @property
    def read(self) -> tuple[str | None, ...]:
        """The files that must not be overwritten."""
        return self.asked.file, self.asked.machine

    def of(self, program: str) -> Pipeline:
        """Return the pipeline of a program. Raises UsageError."""
        what = self.asked.beside(program)
        if what.file not in self.built:
            announce(what, self.says)
            pipeline = what.build()
            if self.warns:
                warn((*default_registry().diagnostics, *pipeline.warnings))
            self.built[what.file] = pipeline
        return self.built[what.file]


def announce(what: Asked, says: bool = True) -> None:
    """Say which pipeline was found in the folder of a program, or above it."""
    if what.found is None:
        return
    click.get_current_context().meta[FOUND] = what.found
    if (found := document()) is not None:
        found.values["pipeline"] = what.found
    elif says:
        say(f"pipeline {shown(what.found)}")
