"""`gcxform calibrate`: from measurements of a machine to its error model, or its axes."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import click

from gcxform.cli import VERBS
from gcxform.cli.outputs import STDOUT, check_places, destination
from gcxform.diagnostics import Location, UsageError

_FORMAT = """
DATA is a table with the stops in the order of the measurement:

\b
    diagonal, direction, X [mm], Y [mm], Z [mm], reading [mm]
    ppp,      +,         0,      0,      0,      0.0000
    ppp,      +,         48,     0,      0,      31.2799
    ppp,      +,         48,     33,     0,      46.0626

diagonal: the signs of the motions, ppp, npp, pnp and ppn are needed. X, Y, Z: nominal machine
positions; sequential steps go X, Y, Z in turn, Z, Y, X on the way back. In place of reading there
may be deviation, reading minus nominal. direction (- on the way back), run, and columns that begin
with temperature, pressure or humidity are optional. Units: mm, um, nm, m, in.

A linear test has the position of its axis: X [mm], deviation [um].

The model is given in the end-point frame: the error is zero at the low corner, EYX, EZX and EZY end
at zero, and squareness is in EXY, EXZ and EYZ. With free beams four diagonals tell the squareness,
the shapes, and of the scales only X^2 sX + Y^2 sY + Z^2 sZ; no model is written then without
linear tests of two axes. --plain takes the ends of the diagonals alone, and gives the squareness;
it is blind to scale errors with X^2 sX + Y^2 sY + Z^2 sZ = 0.
"""


@click.group("calibrate", help=VERBS["calibrate"], short_help=VERBS["calibrate"])
def command() -> None:
    """Choose the measurement."""


@command.command(
    "diagonal", epilog=_FORMAT, short_help="Body diagonals, step by step: the nine functions."
)
@click.option("--plain", is_flag=True, help="The four lengths alone: squareness.")
@click.option("--linear", metavar="FILE", multiple=True, help="Direct linear tests of an axis.")
@click.option(
    "--noise",
    metavar="LENGTH",
    default="1 um",
    show_default=True,
    help="Standard deviation of one step; with --plain of one length.",
)
@click.option(
    "--linear-noise",
    metavar="LENGTH",
    help="Standard deviation of a reading of a linear test.  [default: as --noise]",
)
@click.option(
    "--misalignment",
    type=click.Choice(["free", "none"]),
    default="free",
    show_default=True,
    help="Whether the beams may be off their diagonals.",
)
@click.option(
    "-o",
    "--output",
    metavar="FILE",
    help="Write the model (TOML).  [default: stdout, but none if only --report is given]",
)
@click.option("--report", metavar="FILE", help="Write what was found, with covariance (JSON).")
@click.argument("data", metavar="DATA")
def diagonal(
    data: str,
    plain: bool,
    linear: tuple[str, ...],
    noise: str,
    linear_noise: str | None,
    misalignment: str,
    output: str | None,
    report: str | None,
) -> None:
    """Turn readings along the four body diagonals of a volume into an error model.

    Steps of one axis at a time along the diagonals (vector method) give the nine functions with
    their covariance. Readings that contradict each other are refused: more than 3 times the noise
    over all, or beams off their diagonals where --misalignment none says that they are not.
    """
    check_places({"-o": output, "--report": report}, [data, *linear])
    sigma = _length(noise, "--noise")
    reading = None if linear_noise is None else _length(linear_noise, "--linear-noise")
    if plain and linear:
        raise UsageError.one("GX728", "--plain and --linear exclude each other")
    if output is None and report is None:
        output = STDOUT
    if plain:
        model, found = _plain(data, sigma, output is not None)
    else:
        free = misalignment == "free"
        model, found = _steps(data, linear, (sigma, reading, free), output is not None)
    if output is not None:
        _write(output, model)
    if report is not None:
        _write(report, json.dumps(found, indent=1) + "\n")


def _plain(data: str, noise: float, wanted: bool) -> tuple[str, Mapping[str, Any]]:
    """Return the model, if it is wanted, and the report of a plain test."""
    from gcxform.calibrate.diagonalfile import read_diagonals
    from gcxform.calibrate.plaindiagonal import squareness
    from gcxform.calibrate.words import plain_comments, plain_report
    from gcxform.machine.modeltext import to_toml

    measured = read_diagonals(_path(data), plain=True)
    found = squareness(measured.diagonals, noise)
    files = {"diagonals": measured.file}
    text = plain_comments(found, files) + to_toml(found.model()) if wanted else ""
    return text, plain_report(found, files, {measured.file: measured.conditions})


def _steps(
    data: str, linear: tuple[str, ...], said: tuple[float, float | None, bool], wanted: bool
) -> tuple[str, Mapping[str, Any]]:
    """Return the model, if it is wanted, and the report of sequential steps."""
    from gcxform.calibrate.diagonalfile import read_diagonals, read_linear
    from gcxform.calibrate.stepdiagonal import Assumed, identify
    from gcxform.calibrate.words import step_comments, step_report
    from gcxform.machine.modeltext import to_toml

    measured = read_diagonals(_path(data))
    beside = [read_linear(Path(name), measured.diagonals.volume) for name in linear]
    tests = [test for file in beside for test in file.tests]
    found = identify(measured.diagonals, tests, Assumed(*said))
    files = {"diagonals": measured.file, "linear": [file.file for file in beside]}
    text = step_comments(found, files) + to_toml(found.model()) if wanted else ""
    conditions = {file.file: file.conditions for file in beside}
    conditions[measured.file] = measured.conditions
    return text, step_report(found, files, conditions)


_BALLS = """
DATA is a table with a row for each position of the axis, all other rotary axes at 0:

\b
    angle [deg], X [mm],   Y [mm],   Z [mm]
    0,           363.5312, 51.2288,  128.9411
    45,          287.0892, 235.7834, 128.9533

X, Y, Z: the centre of the ball in machine coordinates, with the probe in the spindle and the ball
on the table. Where the axis turns the head the ball is fixed, X, Y and Z are those of the machine
with the tip at its centre, and --tool names the probe. Units: deg, rad; mm, um, nm, m, in.
Three centres are the least and test nothing; five and more around the whole turn are good.

An axis V and -V with the other sign are the same, and written the same way. The shift of the point
along the axis is free: it is in the plane of the circle. A machine file keeps all but direction,
point and sign of the axis.
"""


@command.command(
    "rotary", epilog=_BALLS, short_help="Ball centres at angles: where a rotary axis is."
)
@click.option("--axis", metavar="A", type=click.Choice([*"ABC"]), required=True, help="A, B or C.")
@click.option("-m", "--machine", metavar="FILE", help="The machine as it is believed to be.")
@click.option("--tool", metavar="N", type=int, help="The probe, if the axis turns the head.")
@click.option(
    "--noise",
    metavar="LENGTH",
    default="2 um",
    show_default=True,
    help="Standard deviation of a coordinate of a centre.",
)
@click.option("-o", "--output", metavar="FILE", help="Write the machine file with the axis (TOML).")
@click.option("--report", metavar="FILE", help="Write what was found, with covariance (JSON).")
@click.argument("data", metavar="DATA")
def rotary(
    data: str,
    axis: str,
    machine: str | None,
    tool: int | None,
    noise: str,
    output: str | None,
    report: str | None,
) -> None:
    """Turn centres of a ball, probed at angles of a rotary axis, into its direction and point.

    Centres that do not belong to the rest are left out and named. Printed are uncertainties, what
    the check with RTCP on will read, and what to measure next. Refused are centres that are on no
    circle, arcs too short, residuals above 3 times the noise, and an axis or a sense that is not
    that of the machine file.
    """
    from gcxform.calibrate import rotarywords
    from gcxform.calibrate.ballfile import read_balls
    from gcxform.calibrate.rotarymachine import located, with_found
    from gcxform.cli.asked import Asked

    check_places({"-o": output, "--report": report}, [data, *filter(None, [machine])])
    measured = read_balls(_path(data))
    believed = Asked(machine=machine).loaded_machine
    found, before = located(measured.centres, axis, _length(noise, "--noise"), believed, tool)
    said = rotarywords.lines(found, axis, before)
    text = with_found(found, axis, believed, rotarywords.comments(found, measured.file))
    whole = rotarywords.report(found, axis, measured.file, measured.conditions, before)
    if output is not None:
        _write(output, text)
    if report is not None:
        _write(report, json.dumps(whole, indent=1) + "\n")
    click.echo("\n".join(said), err=STDOUT in (output, report))


_POSES = """
DATA is a table with a row for each pose, and a column for each rotary axis of the machine:

\b
    ball, A [deg], C [deg], X [mm],  Y [mm],  Z [mm]
    1,    -30,     45,      82.7912, 40.1623, -35.9984

ball tells balls apart, and may be absent where there is one. 2 balls at 30 poses each, with all
axes turned in combination, are a good measurement. The direction and point of every rotary axis are
found together with the places of the balls and, unless --linear none, with what is seen of the
linear axes: differences of scale and squareness. These are reported and belong into the error
model. The absolute scale is never seen; --linear absolute asks for it and shows why not.
"""


@command.command("bundle", epilog=_POSES, short_help="Balls at any poses: all rotary axes at once.")
@click.option("-m", "--machine", metavar="FILE", required=True, help="The machine as believed.")
@click.option("--tool", metavar="N", type=int, help="The probe, if an axis turns the head.")
@click.option(
    "--noise",
    metavar="LENGTH",
    default="2 um",
    show_default=True,
    help="Standard deviation of a coordinate of a centre.",
)
@click.option(
    "--linear",
    type=click.Choice(["differences", "none", "absolute"]),
    default="differences",
    show_default=True,
    help="Which errors of the linear axes are unknown.",
)
@click.option("-o", "--output", metavar="FILE", help="Write the machine file with the axes (TOML).")
@click.option("--report", metavar="FILE", help="Write what was found, with covariance (JSON).")
@click.argument("data", metavar="DATA")
def bundle(
    data: str,
    machine: str,
    tool: int | None,
    noise: str,
    linear: str,
    output: str | None,
    report: str | None,
) -> None:
    """Turn centres of balls at any poses into all rotary axes, with squareness.

    Centres that do not belong to the rest are left out and named. Refused are unknowns that the
    poses do not determine, and residuals above 3 times the noise.
    """
    from gcxform.calibrate import bundlewords
    from gcxform.calibrate.ballfile import read_poses
    from gcxform.calibrate.bundle import bundle as fit
    from gcxform.calibrate.rotarymachine import bundled_text, probing
    from gcxform.cli.asked import Asked

    check_places({"-o": output, "--report": report}, [data, machine])
    believed = Asked(machine=machine).loaded_machine
    assert believed is not None
    chain = probing(believed, tool)
    measured = read_poses(_path(data), chain.letters)
    found = fit(chain, measured.poses, _length(noise, "--noise"), linear)
    if output is not None:
        _write(output, bundled_text(found, believed, measured.file))
    if report is not None:
        whole = bundlewords.report(found, measured.file, measured.conditions)
        _write(report, json.dumps(whole, indent=1) + "\n")
    click.echo("\n".join(bundlewords.lines(found)), err=STDOUT in (output, report))


def _path(name: str) -> Path:
    return Path("/dev/stdin" if name == STDOUT else name)


def _length(text: str, option: str) -> float:
    """Return a length in mm that is above 0. Raises UsageError."""
    from gcxform.machine.quantities import LENGTH

    try:
        length = LENGTH.parse(text, bare=True)
    except ValueError as error:
        raise UsageError.one("GX708", str(error), Location(option)) from None
    if not length > 0:
        raise UsageError.one("GX706", f"{text} is not above 0 mm", Location(option))
    return length


def _write(name: str, text: str) -> None:
    with destination(name) as put:
        put(text.encode())
