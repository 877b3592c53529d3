"""What the verbs of `gcxform calibrate` share: options, files in, results out."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import click

from gcxform.cli.outputs import STDOUT, destination
from gcxform.diagnostics import Location, UsageError

Command = TypeVar("Command", bound=Callable[..., Any])
NOISE = "Standard deviation of a coordinate of a centre."


class Found(NamedTuple):
    """What a calibration found: a machine file, a report, and lines for a person."""

    text: str
    report: Mapping[str, Any]
    lines: Sequence[str]


def found_options(noise: str, default: str) -> Callable[[Command], Command]:
    """Return a decorator for the options of measurements that say where rotary axes are."""
    parts = (
        click.option("--noise", metavar="LENGTH", default=default, show_default=True, help=noise),
        click.option("-o", "--output", metavar="FILE", help="Write the machine file (TOML)."),
        click.option(
            "--report", metavar="FILE", help="Write what was found, with covariance (JSON)."
        ),
        click.argument("data", metavar="DATA"),
    )

    def decorate(command: Command) -> Command:
        for part in reversed(parts):
            command = part(command)
        return command

    return decorate


def hand_out(found: Found, output: str | None, report: str | None) -> None:
    """Write the files that are asked for; the lines go to stderr where stdout has a file."""
    if output is not None:
        write(output, found.text)
    if report is not None:
        write(report, json.dumps(found.report, indent=1) + "\n")
    click.echo("\n".join(found.lines), err=STDOUT in (output, report))


def path_of(name: str) -> Path:
    """Return the file of an argument; `-` is stdin."""
    return Path("/dev/stdin" if name == STDOUT else name)


def length_of(text: str, option: str) -> float:
    """Return a length in mm that is above 0. Raises UsageError."""
    length = any_length(text, option)
    if not length > 0:
        raise UsageError.one("GX706", f"{text} is not above 0 mm", Location(option))
    return length


def any_length(text: str, option: str) -> float:
    """Return a length in mm. Raises UsageError."""
    from gcxform.machine.quantities import LENGTH

    try:
        return LENGTH.parse(text, bare=True)
    except ValueError as error:
        raise UsageError.one("GX708", str(error), Location(option)) from None


def two_lengths(text: str, option: str) -> tuple[float, float]:
    """Return two lengths in mm. Raises UsageError."""
    x, y = _lengths(text, option, ("two", 2))
    return x, y


def three_lengths(text: str, option: str) -> tuple[float, float, float]:
    """Return three lengths in mm. Raises UsageError."""
    x, y, z = _lengths(text, option, ("three", 3))
    return x, y, z


def _lengths(text: str, option: str, count: tuple[str, int]) -> list[float]:
    parts = text.split(",")
    if len(parts) != count[1]:
        raise UsageError.one("GX708", f"{text!r} is not {count[0]} lengths", Location(option))
    return [any_length(part.strip(), option) for part in parts]


def write(name: str, text: str) -> None:
    """Write a result."""
    with destination(name) as put:
        put(text.encode())
