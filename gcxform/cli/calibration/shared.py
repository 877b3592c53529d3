"""What the verbs of `gcxform calibrate` share: options, files in, results out."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import click

from gcxform import plot
from gcxform.cli.common.answer import answer
from gcxform.cli.common.options import ABOVE_NOTHING
from gcxform.cli.common.outputs import STDOUT, check_places, destination
from gcxform.diagnostics import GcxformError, Location, UsageError
from gcxform.system.stages import stage
from gcxform.values import dataclass

Command = TypeVar("Command", bound=Callable[..., Any])
NOISE = "Standard deviation of a coordinate of a centre."


@contextmanager
def about(file: str) -> Iterator[None]:
    """Let what is wrong with measurements as a whole name their file.

    Numbers beyond all measure are refused by what becomes of them, without a warning of numpy.
    """
    import numpy as np

    stage(file)
    try:
        with np.errstate(all="ignore"):
            yield
    except GcxformError as error:
        found = (d if d.where else d.at(Location(file)) for d in error.diagnostics)
        raise type(error)(tuple(found)) from None


class Found(NamedTuple):
    """What a calibration found: a machine file, a report, lines for a person, and a picture."""

    text: str
    report: Mapping[str, Any]
    lines: Sequence[str]
    draw: Callable[[], Any]


@dataclass(frozen=True)
class Files:
    """The names of the files that are asked for, by option."""

    output: str | None
    report: str | None
    plot: str | None

    def check(self, *read: str | None) -> None:
        """Raise UsageError for places that cannot be written, and pictures that cannot be drawn."""
        written = {"-o": self.output, "--report": self.report, "--plot": self.plot}
        check_places(written, [name for name in read if name])
        if self.plot:
            plot.check(self.plot)


def found_options(
    noise: str,
    default: str,
    output: str = "Write the machine file (TOML).",
    plot: str = "Draw the residuals (SVG or PNG).",
) -> Callable[[Command], Command]:
    """Return a decorator for what measurements of machines are asked: noise, and files."""
    parts = (
        click.option("--noise", type=ABOVE_NOTHING, default=default, show_default=True, help=noise),
        click.option("-o", "--output", metavar="FILE", help=output),
        click.option(
            "--report", metavar="FILE", help="Write what was found, with covariance (JSON)."
        ),
        click.option("--plot", metavar="FILE", help=plot),
        click.argument("data", metavar="DATA"),
    )

    def decorate(command: Command) -> Command:
        for part in reversed(parts):
            command = part(command)
        return command

    return decorate


def hand_out(found: Found, files: Files) -> None:
    """Write the files that are asked for; the lines go to stderr where stdout has a file."""
    picture = plot.rendered(found.draw(), files.plot) if files.plot else b""
    if files.output is not None:
        write(files.output, found.text)
    if files.report is not None:
        write(files.report, json.dumps(found.report, indent=1) + "\n")
    if files.plot is not None:
        with destination(files.plot) as put:
            put(picture)
    answer({"report": found.report}, found.lines, err=STDOUT in (files.output, files.report))


def check_axis(axis: str | None, letters: Sequence[str], machine: str) -> None:
    """Raise UsageError for an axis that is named and that a machine does not have."""
    if axis is not None and axis not in letters:
        raise UsageError.one("GX707", f"{machine} has no axis {axis}", Location("--axis"))


def path_of(name: str) -> Path:
    """Return the file of an argument; `-` is stdin."""
    return Path("/dev/stdin" if name == STDOUT else name)


def write(name: str, text: str) -> None:
    """Write a result."""
    with destination(name) as put:
        put(text.encode())
