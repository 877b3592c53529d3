"""`gcxform calibrate`: from measurements of a machine to its error model, or its axes."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import click

from gcxform.cli import VERBS
from gcxform.cli.calibration.circles import circles
from gcxform.cli.calibration.plan import centres, plan
from gcxform.cli.calibration.rotary_axes import ballbar, bundle, rotary
from gcxform.cli.calibration.shared import about, path_of, write
from gcxform.cli.common.answer import answer
from gcxform.cli.common.options import ABOVE_NOTHING, above_nothing, one_of
from gcxform.cli.common.outputs import STDOUT, check_places
from gcxform.diagnostics import UsageError

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


command.add_command(rotary)
command.add_command(bundle)
command.add_command(ballbar)
command.add_command(circles)
command.add_command(plan)
command.add_command(centres)


@command.command(
    "diagonal", epilog=_FORMAT, short_help="Body diagonals, step by step: the nine functions."
)
@click.option("--plain", is_flag=True, help="The four lengths alone: squareness.")
@click.option("--linear", metavar="FILE", multiple=True, help="Direct linear tests of an axis.")
@above_nothing("--noise", "1 um", "Standard deviation of one step; with --plain of one length.")
@click.option(
    "--linear-noise",
    type=ABOVE_NOTHING,
    help="Standard deviation of a reading of a linear test.  [default: as --noise]",
)
@one_of(
    "--misalignment", words=["free", "none"], help="Whether the beams may be off their diagonals."
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
    noise: float,
    linear_noise: float | None,
    misalignment: str,
    output: str | None,
    report: str | None,
) -> None:
    """Turn readings along the four body diagonals of a volume into an error model.

    Steps of one axis at a time along the diagonals (vector method) give the nine functions with
    their covariance. Readings that contradict each other are refused: more than 3 times the noise
    over all, or beams off their diagonals where --misalignment none says that they are not, or
    linear tests of another sign or scale. Residuals with the pattern of angular errors, which the
    method takes to be none, are a warning, as is more noise than was stated.
    """
    check_places({"-o": output, "--report": report}, [data, *linear])
    if plain and linear:
        raise UsageError.one("GX728", "--plain and --linear exclude each other")
    if output is None and report is None:
        output = STDOUT
    with about(data):
        if plain:
            model, found = _plain(data, noise, output is not None)
        else:
            free = misalignment == "free"
            model, found = _steps(data, linear, (noise, linear_noise, free), output is not None)
    answer({"report": found}, (f"warning: {line}" for line in found["warnings"]), err=True)
    if output is not None:
        write(output, model)
    if report is not None:
        write(report, json.dumps(found, indent=1) + "\n")


def _plain(data: str, noise: float, wanted: bool) -> tuple[str, Mapping[str, Any]]:
    """Return the model, if it is wanted, and the report of a plain test."""
    from gcxform.calibrate.diagonal.file import read_diagonals
    from gcxform.calibrate.diagonal.plain_diagonal import squareness
    from gcxform.calibrate.diagonal.report import plain_comments, plain_report
    from gcxform.errormodel.model_text import to_toml

    measured = read_diagonals(path_of(data), plain=True)
    found = squareness(measured.diagonals, noise)
    files = {"diagonals": measured.file}
    text = plain_comments(found, files) + to_toml(found.model()) if wanted else ""
    return text, plain_report(found, files, {measured.file: measured.conditions})


def _steps(
    data: str, linear: tuple[str, ...], said: tuple[float, float | None, bool], wanted: bool
) -> tuple[str, Mapping[str, Any]]:
    """Return the model, if it is wanted, and the report of sequential steps."""
    from gcxform.calibrate.diagonal.file import read_diagonals, read_linear
    from gcxform.calibrate.diagonal.report import step_comments, step_report
    from gcxform.calibrate.diagonal.step_diagonal import Assumed, identify
    from gcxform.errormodel.model_text import to_toml

    measured = read_diagonals(path_of(data))
    beside = [read_linear(Path(name), measured.diagonals.volume) for name in linear]
    tests = [test for file in beside for test in file.tests]
    found = identify(measured.diagonals, tests, Assumed(*said))
    files = {"diagonals": measured.file, "linear": [file.file for file in beside]}
    text = step_comments(found, files) + to_toml(found.model()) if wanted else ""
    conditions = {file.file: file.conditions for file in beside}
    conditions[measured.file] = measured.conditions
    return text, step_report(found, files, conditions)
