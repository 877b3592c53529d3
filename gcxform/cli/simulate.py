"""`gcxform simulate`: what an instrument would read on a machine, before and after compensation."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack
from dataclasses import dataclass
from typing import Annotated, Any, TypeVar

import click
import numpy as np

from gcxform import plot
from gcxform.cli import VERBS
from gcxform.cli.described import built, options_of
from gcxform.cli.outputs import STDOUT, check_places, destination
from gcxform.cli.readings import ballbar_rtcp, balls
from gcxform.diagnostics import Location, UsageError
from gcxform.machine.errors import AXES, FloatArray, Outside
from gcxform.options import Length, ModelFile, Option, Vector
from gcxform.registry import default_registry
from gcxform.simulate import report
from gcxform.simulate.positions import Chain
from gcxform.simulate.programs import PLANES
from gcxform.simulate.virtual import (
    BODY,
    FACES,
    Ballbar,
    LinearTest,
    Outcome,
    axis_line,
    diagonal_line,
    possible,
    ranges,
)

Command = TypeVar("Command", bound=Callable[..., Any])
SHARE = 0.4  # of the shortest travel: the radius if none is given


@dataclass(frozen=True)
class Common:
    """What all tests are told."""

    model: Annotated[ModelFile, Option("error model of the machine")]
    tolerance: Annotated[Length, Option("tolerance of the compensation", above=0.0)] = 0.001
    decimals: Annotated[
        int | None, Option("decimals of the compensated program", at_least=0, at_most=9)
    ] = None
    outside: Annotated[Outside, Option("what the error is beyond the tables")] = Outside.ERROR
    feed: Annotated[float, Option("feed in mm/min", above=0.0)] = 1000.0
    noise: Annotated[Length, Option("standard deviation of a reading", at_least=0.0)] = 0.0
    seed: Annotated[int, Option("seed of the noise", at_least=0)] = 0

    def chain(self, dialect: str) -> Chain:
        """Return how the standard program is compensated."""
        kind = default_registry().dialect(dialect)
        return Chain(self.model, kind, self.tolerance, self.decimals, self.outside)

    @property
    def box(self) -> FloatArray:
        """The volume (3, 2) of the model, mm."""
        return ranges(self.model.model)


@dataclass(frozen=True)
class BallbarOptions(Common):
    """What a ballbar test is told."""

    centre: Annotated[Vector | None, Option("centre; absent: that of the model")] = None
    radius: Annotated[
        Length | None, Option("radius; absent: what fits into the model", above=0.0)
    ] = None
    planes: Annotated[str, Option("planes, of XY, YZ and ZX")] = ",".join(PLANES)

    def test(self) -> Ballbar:
        """Return the test. Raises UsageError."""
        planes = chosen("planes", self.planes, tuple(PLANES))
        centre = self.centre or middle(self.box)
        radius = self.radius or self._radius(planes)
        return Ballbar(centre, radius, planes, self.feed, self.noise, self.seed)

    def _radius(self, planes: tuple[str, ...]) -> float:
        """Return the largest whole number of millimetres within a share of the travels."""
        travels = np.ptp(self.box, axis=1)[[axis for p in planes for axis in PLANES[p].axes[:2]]]
        radius = float(np.floor(SHARE * travels.min()))
        if radius < 1.0:
            raise no_room("radius", "the model has no room for a circle in each of these planes")
        return radius


@dataclass(frozen=True)
class LinearOptions(Common):
    """What a test along lines is told."""

    runs: Annotated[int, Option("runs up and down each line", at_least=1)] = 5
    targets: Annotated[int, Option("targets on each line", at_least=2)] = 11

    def linear(self, lines: tuple[Any, ...]) -> LinearTest:
        """Return the test of some lines."""
        return LinearTest(lines, self.runs, self.feed, self.noise, self.seed)


@dataclass(frozen=True)
class PositioningOptions(LinearOptions):
    """What a positioning test is told."""

    axes: Annotated[str, Option("axes that are tested")] = ",".join(AXES)
    at: Annotated[Vector | None, Option("where the other axes stand; absent: middle")] = None
    overtravel: Annotated[Length, Option("way beyond the outer targets", at_least=0.0)] = 1.0
    scatter: Annotated[
        Length, Option("random part of the targets, so that no pitch is hidden", at_least=0.0)
    ] = 1.0

    def test(self) -> LinearTest:
        """Return the test. Raises UsageError."""
        axes = chosen("axes", self.axes, tuple(AXES))
        return self.linear(tuple(self._line(AXES.index(axis)) for axis in axes))

    def _line(self, axis: int) -> Any:
        low, high = self.box[axis].tolist()
        room = (high - low) / (self.targets - 1)
        if room <= 4.0 * max(self.scatter, self.overtravel):
            raise no_room(
                "axes", f"the model has no room for {self.targets} targets on {AXES[axis]}"
            )
        at = self.at or middle(self.box)
        place = (axis, at, low, high, self.targets)
        return axis_line(*place, self.overtravel, self.scatter, self.seed)


@dataclass(frozen=True)
class DiagonalOptions(LinearOptions):
    """What a diagonal test is told."""

    diagonals: Annotated[
        str, Option("diagonals: body, face, or names such as PPP and N0P; absent: all there are")
    ] = ""
    overtravel: Annotated[Length, Option("way beyond the outer targets", at_least=0.0)] = 0.0

    def test(self) -> LinearTest:
        """Return the test. Raises UsageError."""
        box = self.box
        words = {"body": ",".join(BODY), "face": ",".join(FACES), "": ",".join(BODY + FACES)}
        asked = ",".join(words.get(w.strip().lower(), w) for w in self.diagonals.split(","))
        names = possible(chosen("diagonals", asked, BODY + FACES), box)
        if not names:
            raise no_room("diagonals", "the model has no room for any of these diagonals")
        return self.linear(
            tuple(diagonal_line(n, box, self.targets, self.overtravel) for n in names)
        )


def chosen(option: str, text: str, known: tuple[str, ...]) -> tuple[str, ...]:
    """Return the words of a list, each once. Raises UsageError for one that is not known."""
    words = [word.strip().upper() for word in text.split(",")]
    for word in words:
        if word not in known:
            message = f"{word!r} is not one of {', '.join(known)}"
            raise UsageError.one("GX707", message, Location(f"--{option}"))
    return tuple(dict.fromkeys(words))


def no_room(option: str, message: str) -> UsageError:
    """Return the error for a test that has no place in the model."""
    hint = "name what the model has, or say where and how large the test is"
    return UsageError.one("GX738", message, Location(f"--{option}"), hint)


def middle(box: FloatArray) -> tuple[float, float, float]:
    """Return the centre of a volume, in whole micrometres."""
    x, y, z = np.round(box.mean(axis=1), 3).tolist()
    return x, y, z


# --- the verb ---


@click.group("simulate", help=VERBS["simulate"], short_help=VERBS["simulate"])
def command() -> None:
    """Choose a test."""


command.add_command(balls)
command.add_command(ballbar_rtcp)

_FILES = ("json", "plot", "program", "compensated")


def _files(command: Command) -> Command:
    """Add the options about dialect and files."""
    texts = {
        "compensated": "Write the compensated program.",
        "program": "Write the standard program.",
        "plot": "Draw what the instrument prints (SVG or PNG).",
        "json": "Write figures and readings, in mm (JSON).",
    }
    for name, text in texts.items():
        command = click.option(f"--{name}", metavar="FILE", help=text)(command)
    return click.option(
        "-f",
        "--from",
        "dialect",
        metavar="DIALECT",
        default="fanuc",
        show_default=True,
        help="Dialect of the standard program.",
    )(command)


@command.command("ballbar")
@options_of(BallbarOptions)
@_files
def ballbar(dialect: str, **given: Any) -> None:
    """Circles in both senses: circular and radial deviations of ISO 230-4."""
    files = _checked(given)
    asked = built(BallbarOptions, given, "simulate ballbar")
    test = asked.test()
    outcome = test.run(asked.chain(dialect))
    title = f"ballbar, radius {test.radius:g} mm about {_place(test.centre)}"
    _hand_out(
        files,
        _title(title, asked, outcome),
        outcome,
        lambda: report.circle_pairs(outcome),
        report.circle_readings,
        lambda title: plot.circles(outcome, title),
    )


@command.command("positioning")
@options_of(PositioningOptions)
@_files
def positioning(dialect: str, **given: Any) -> None:
    """Targets along the axes: accuracy and repeatability of ISO 230-2."""
    files = _checked(given)
    asked = built(PositioningOptions, given, "simulate positioning")
    outcome = asked.test().run(asked.chain(dialect))
    title = f"positioning, {asked.runs} runs to {asked.targets} targets"
    _hand_out(
        files,
        _title(title, asked, outcome),
        outcome,
        lambda: report.axis_pairs(outcome),
        report.line_readings,
        lambda title: plot.positioning(outcome, title),
    )


@command.command("diagonal")
@options_of(DiagonalOptions)
@_files
def diagonal(dialect: str, **given: Any) -> None:
    """Targets along the body and face diagonals: E, M and B of ISO 230-6."""
    files = _checked(given)
    asked = built(DiagonalOptions, given, "simulate diagonal")
    outcome = asked.test().run(asked.chain(dialect))
    title = f"diagonals, {asked.runs} runs to {asked.targets} targets"
    _hand_out(
        files,
        _title(title, asked, outcome),
        outcome,
        lambda: report.diagonal_pairs(outcome),
        report.line_readings,
        lambda title: plot.diagonals(outcome, title),
    )


def _checked(given: dict[str, Any]) -> dict[str, str | None]:
    """Take the names of files out of what was given, and refuse those that cannot be."""
    files = {name: given.pop(name) for name in _FILES}
    check_places({f"--{name}": file for name, file in files.items()}, [given["model"]])
    if files["plot"]:
        plot.check(files["plot"])
    return files


def _place(point: tuple[float, float, float]) -> str:
    return " ".join(f"{axis}{value:g}" for axis, value in zip(AXES, point, strict=True))


def _title(test: str, asked: Common, outcome: Outcome[Any]) -> str:
    """Return in a line what was done."""
    noise = f"; noise {1000 * asked.noise:g} um, seed {asked.seed}" if asked.noise else ""
    proved = 1000 * outcome.compensated.certificate.largest["deviation"]
    return (
        f"{test}: {asked.model.path.name}; compensated within {1000 * asked.tolerance:g} um, "
        f"proved {proved:.2f} um{noise}"
    )


def _hand_out(
    files: Mapping[str, str | None],
    title: str,
    outcome: Outcome[Any],
    pairs: Callable[[], Iterator[tuple[str, report.Pairs]]],
    readings: Callable[[Any], dict[str, Any]],
    draw: Callable[[str], Any],
) -> None:
    """Print the table and write the files, all of them or none."""
    parts: dict[str, bytes] = {}
    if files["json"]:
        found = {"format": 1, "title": title, "figures": report.data(pairs())}
        sides = {"before": outcome.before, "after": outcome.after}
        found["readings"] = {
            side: {name: readings(reading) for name, reading in read.items()}
            for side, read in sides.items()
        }
        parts["json"] = (json.dumps(found, indent=1) + "\n").encode()
    if files["plot"]:
        parts["plot"] = plot.rendered(draw(title), files["plot"])
    parts |= {"program": outcome.program.text, "compensated": outcome.compensated.text}
    with ExitStack() as stack:
        for name, content in parts.items():
            if file := files[name]:
                stack.enter_context(destination(file))(content)
    if STDOUT not in files.values():
        click.echo("\n".join([title, *report.table(pairs())]))
