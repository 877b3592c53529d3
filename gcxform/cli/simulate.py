"""`gcxform simulate`: what an instrument would read on a machine, before and after compensation."""

from __future__ import annotations

import json
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack
from dataclasses import replace
from typing import Annotated, Any, ClassVar, TypeVar

import click
import numpy as np

from gcxform import plot
from gcxform.cli import VERBS
from gcxform.cli.calibration.readings import ballbar_rtcp, balls
from gcxform.cli.common.answer import answer
from gcxform.cli.common.derived_options import built, options_of
from gcxform.cli.common.outputs import STDOUT, check_places, destination
from gcxform.contract.options import Length, ModelFile, Option, Vector
from gcxform.diagnostics import Location, UsageError
from gcxform.errormodel.model import AXES, Outside
from gcxform.plugin.registry import default_registry
from gcxform.simulate import report
from gcxform.simulate.drives import NONE, Drives
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
from gcxform.system.arrays import Floats
from gcxform.values import dataclass

Command = TypeVar("Command", bound=Callable[..., Any])
SHARE = 0.4  # of the shortest travel: the radius if none is given


@dataclass(frozen=True)
class Common(ABC):
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
    time: Annotated[str | None, Option("time (ISO 8601) whose temperatures hold")] = None

    def chain(self, dialect: str) -> Chain:
        """Return how the standard program is compensated."""
        kind = default_registry().dialect(dialect)
        return Chain(self.model, kind, self.tolerance, self.decimals, self.outside)

    @property
    @abstractmethod
    def headline(self) -> str:
        """What the test is, in a few words."""

    @property
    def box(self) -> Floats:
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
    lag: Annotated[Vector, Option("what X, Y, Z are behind their commands at the feed")] = NONE
    backlash: Annotated[Vector, Option("what X, Y, Z lose where they turn back")] = NONE
    play: Annotated[Vector, Option("how far X, Y, Z jump aside where they turn back")] = NONE
    stick: Annotated[Vector, Option("way for which X, Y, Z stand where they turn back")] = NONE
    cyclic: Annotated[Vector, Option("amplitude of a cyclic error of X, Y, Z")] = NONE
    pitch: Annotated[Length, Option("pitch of the cyclic error", above=0.0)] = 10.0
    pivot: Annotated[Vector, Option("how far the pivot is set off the centre")] = NONE
    samples: Annotated[int, Option("readings a run of --readings", at_least=8, at_most=7200)] = 720

    def test(self) -> Ballbar:
        """Return the test. Raises UsageError."""
        planes = chosen("planes", self.planes, tuple(PLANES))
        centre = self.centre or middle(self.box)
        radius = self.radius or self._radius(planes)
        drives = Drives(self.lag, self.backlash, self.play, self.stick, self.cyclic, self.pitch)
        said = (planes, self.feed, self.noise, self.seed, drives, self.pivot)
        return Ballbar(centre, radius, *said)

    @property
    def headline(self) -> str:
        """What the test is, in a few words."""
        test = self.test()
        return f"ballbar, radius {test.radius:g} mm about {_words_of(test.centre)}"

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

    name: ClassVar[str]

    @property
    def headline(self) -> str:
        """What the test is, in a few words."""
        return f"{self.name}, {self.runs} runs to {self.targets} targets"

    def linear(self, lines: tuple[Any, ...]) -> LinearTest:
        """Return the test of some lines."""
        return LinearTest(lines, self.runs, self.feed, self.noise, self.seed)


@dataclass(frozen=True)
class PositioningOptions(LinearOptions):
    """What a positioning test is told."""

    name = "positioning"
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

    name = "diagonals"
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


def middle(box: Floats) -> tuple[float, float, float]:
    """Return the centre of a volume, in whole micrometres."""
    x, y, z = np.round(box.mean(axis=1), 3).tolist()
    return x, y, z


def _words_of(point: tuple[float, float, float]) -> str:
    return " ".join(f"{axis}{value:g}" for axis, value in zip(AXES, point, strict=True))


# --- the verb ---


@click.group("simulate", help=VERBS["simulate"], short_help=VERBS["simulate"])
def command() -> None:
    """Choose a test."""


command.add_command(balls)
command.add_command(ballbar_rtcp)

_FILES = ("report", "plot", "program", "compensated", "readings")


def _files(command: Command) -> Command:
    """Add the options about dialect and files."""
    texts = {
        "compensated": "Write the compensated program.",
        "program": "Write the standard program.",
        "plot": "Draw what the instrument prints (SVG or PNG).",
        "report": "Write figures and readings, in mm (JSON).",
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
@click.option(
    "--readings",
    metavar="FILE",
    help="Write the readings before compensation, as `calibrate circles` reads them (CSV).",
)
@_files
def ballbar(**given: Any) -> None:
    """Circles in both senses: circular and radial deviations of ISO 230-4.

    The machine has the errors of its model and, if they are given, those of its drives, of which no
    model by position knows and which no program can compensate.
    """
    telling = Telling(report.circle_pairs, report.circle_readings, plot.circles, _table)
    _simulate("ballbar", BallbarOptions, telling, **given)


@command.command("positioning")
@options_of(PositioningOptions)
@_files
def positioning(**given: Any) -> None:
    """Targets along the axes: accuracy and repeatability of ISO 230-2."""
    telling = Telling(report.axis_pairs, report.line_readings, plot.positioning)
    _simulate("positioning", PositioningOptions, telling, **given)


@command.command("diagonal")
@options_of(DiagonalOptions)
@_files
def diagonal(**given: Any) -> None:
    """Targets along the body and face diagonals: E, M and B of ISO 230-6."""
    telling = Telling(report.diagonal_pairs, report.line_readings, plot.diagonals)
    _simulate("diagonal", DiagonalOptions, telling, **given)


def _table(asked: Any, outcome: Outcome[Any]) -> str:
    return report.circles_table(asked.test(), outcome.before, asked.samples)


@dataclass(frozen=True)
class Telling:
    """How the outcome of a kind of test is told: its figures, its readings, its picture."""

    pairs: Callable[[Any], Iterator[tuple[str, report.Pairs]]]
    readings: Callable[[Any], dict[str, Any]]
    draw: Callable[[Any, str], Any]
    table: Callable[[Any, Outcome[Any]], str] | None = None


def _simulate(name: str, kind: type[Any], telling: Telling, dialect: str, **given: Any) -> None:
    """Run a test before and after compensation, and hand out what it gives."""
    files = _checked(given)
    asked = built(kind, given, f"simulate {name}")
    if asked.time is not None:
        asked = replace(asked, model=asked.model.at_time(asked.time))
    outcome = asked.test().run(asked.chain(dialect))
    table = telling.table(asked, outcome) if telling.table and files["readings"] else ""
    _hand_out(files, _title(asked, outcome), outcome, telling, table)


def _checked(given: dict[str, Any]) -> dict[str, str | None]:
    """Take the names of files out of what was given, and refuse those that cannot be."""
    files = {name: given.pop(name, None) for name in _FILES}
    check_places({f"--{name}": file for name, file in files.items()}, [given["model"]])
    if files["plot"]:
        plot.check(files["plot"])
    return files


def _title(asked: Common, outcome: Outcome[Any]) -> str:
    """Return in a line what was done."""
    noise = f"; noise {1000 * asked.noise:g} um, seed {asked.seed}" if asked.noise else ""
    proved = 1000 * outcome.compensated.certificate.largest["deviation"]
    return (
        f"{asked.headline}: {asked.model.path.name}; "
        f"compensated within {1000 * asked.tolerance:g} um, proved {proved:.2f} um{noise}"
    )


def _hand_out(
    files: Mapping[str, str | None],
    title: str,
    outcome: Outcome[Any],
    telling: Telling,
    table: str,
) -> None:
    """Print the table and write the files, all of them or none."""
    parts: dict[str, bytes] = {}
    found = _found(title, outcome, telling)
    if files["report"]:
        parts["report"] = (json.dumps(found, indent=1) + "\n").encode()
    if files["plot"]:
        parts["plot"] = plot.rendered(telling.draw(outcome, title), files["plot"])
    parts["readings"] = table.encode()
    parts |= {"program": outcome.program.text, "compensated": outcome.compensated.text}
    with ExitStack() as stack:
        for name, content in parts.items():
            if file := files[name]:
                stack.enter_context(destination(file))(content)
    if STDOUT not in files.values():
        answer({"report": found}, [title, *report.table(telling.pairs(outcome))])


def _found(title: str, outcome: Outcome[Any], telling: Telling) -> dict[str, Any]:
    """Return figures and readings, in mm, as plain values."""
    sides = {"before": outcome.before, "after": outcome.after}
    readings = {
        side: {name: telling.readings(reading) for name, reading in read.items()}
        for side, read in sides.items()
    }
    figures = report.data(telling.pairs(outcome))
    return {"format": 1, "title": title, "figures": figures, "readings": readings}
