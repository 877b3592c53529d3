"""`gcxform calibrate rotary|bundle|ballbar`: from balls to where rotary axes are."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import click

from gcxform import plot
from gcxform.cli.calibration.shared import NOISE, Files, Found, found_options, hand_out, path_of
from gcxform.cli.common.options import TWO_LENGTHS, above_nothing, one_of
from gcxform.cli.common.request import Asked

_BALLS = """
DATA is a table with a row for each position of the axis, all other rotary axes at 0:

\b
    angle [deg], X [mm],   Y [mm],   Z [mm]
    0,           363.5312, 51.2288,  128.9411
    45,          287.0892, 235.7834, 128.9533

X, Y, Z: the centre of the ball in machine coordinates, with the probe in the spindle and the ball
on the table. Where the axis turns the head the ball is fixed, X, Y and Z are those of the machine
with the tip at its centre, and --tool names the probe; with --tool they are so of a table too.
Units: deg, rad; mm, um, nm, m, in. Three centres are the least and test nothing; five and more
around the whole turn are good.

An axis V and -V with the other sign are the same, and written the same way. The shift of the point
along the axis is free: it is in the plane of the circle. A machine file keeps all but direction,
point and sign of the axis.
"""


@click.command(
    "rotary", epilog=_BALLS, short_help="Ball centres at angles: where a rotary axis is."
)
@click.option("--axis", metavar="A", type=click.Choice([*"ABC"]), required=True, help="A, B or C.")
@click.option("-m", "--machine", metavar="FILE", help="The machine as it is believed to be.")
@click.option("--tool", metavar="N", type=int, help="The probe: X, Y, Z are then of the axes.")
@found_options(NOISE, "2 um")
def rotary(
    data: str,
    axis: str,
    machine: str | None,
    tool: int | None,
    noise: float,
    **files: str | None,
) -> None:
    """Turn centres of a ball, probed at angles of a rotary axis, into its direction and point.

    Centres that do not belong to the rest are left out and named. Printed are uncertainties, what
    the check with RTCP on will read, and what to measure next. Refused are centres that are on no
    circle, arcs too short, residuals above 3 times the noise, and an axis or a sense that is not
    that of the machine file.
    """
    from gcxform.calibrate.rotary import report as rotarywords
    from gcxform.calibrate.rotary.ball_file import read_balls
    from gcxform.calibrate.rotary.machine import located, with_found

    places = Files(**files)
    places.check(data, machine)
    measured = read_balls(path_of(data))
    believed = Asked(machine=machine).loaded_machine
    found, before = located(measured.centres, axis, noise, believed, tool)
    text = with_found(found, axis, believed, rotarywords.comments(found, measured.file))
    whole = rotarywords.report(found, axis, measured.file, measured.conditions, before)
    title = f"axis {axis}, {Path(measured.file).name}"
    said = rotarywords.lines(found, axis, before)
    hand_out(Found(text, whole, said, lambda: plot.placed(found, axis, title)), places)


_POSES = """
DATA is a table with a row for each pose, and a column for each rotary axis of the machine:

\b
    ball, A [deg], C [deg], X [mm],  Y [mm],  Z [mm]
    1,    -30,     45,      82.7912, 40.1623, -35.9984

ball tells balls apart, and may be absent where there is one. 2 balls at 30 poses each, with all
axes turned in combination, are a good measurement. X, Y and Z are the centre of the ball in machine
coordinates; with --tool, which a head needs, the axes with the tip there. The direction and point
of every rotary axis are found together with the places of the balls and, unless --linear none, with
what is seen of the linear axes: differences of scale and squareness. These are reported and belong
into the error model. The absolute scale is never seen; --linear absolute asks for it and shows why
not.
"""


@click.command("bundle", epilog=_POSES, short_help="Balls at any poses: all rotary axes at once.")
@click.option("-m", "--machine", metavar="FILE", required=True, help="The machine as believed.")
@click.option("--tool", metavar="N", type=int, help="The probe: X, Y, Z are then of the axes.")
@one_of(
    "--linear",
    words=["differences", "none", "absolute"],
    help="Which errors of the linear axes are unknown.",
)
@found_options(NOISE, "2 um")
def bundle(
    data: str,
    machine: str,
    tool: int | None,
    noise: float,
    linear: str,
    **files: str | None,
) -> None:
    """Turn centres of balls at any poses into all rotary axes, with squareness.

    Centres that do not belong to the rest are left out and named. Refused are unknowns that the
    poses do not determine, and residuals above 3 times the noise.
    """
    from gcxform.calibrate.bundle import report as bundlewords
    from gcxform.calibrate.bundle.bundle import bundle as fit
    from gcxform.calibrate.rotary.ball_file import read_poses
    from gcxform.calibrate.rotary.machine import bundled_text, probing

    places = Files(**files)
    places.check(data, machine)
    believed = Asked(machine=machine).loaded_machine
    assert believed is not None
    chain = probing(believed, tool)
    measured = read_poses(path_of(data), chain.letters)
    found = fit(chain, measured.poses, noise, linear)
    text = bundled_text(found, believed, measured.file) if places.output else ""
    whole = bundlewords.report(found, measured.file, measured.conditions)
    said = bundlewords.lines(found)
    hand_out(
        Found(text, whole, said, lambda: plot.bundled(found, Path(measured.file).name)), places
    )


_CIRCLES = """
DATA is a table with a row for each reading of a bar between a ball on the table and one in the
spindle, while the control follows the tip (RTCP on) and one axis turns, the others at 0:

\b
    axis, bar, X [mm], Y [mm], Z [mm], angle [deg], reading [um]
    A,    Z,   65,     -32,    25,     -90,         12.3
    A,    X,   65,     -32,    25,     -90,         4.1

bar: the direction from the table ball to the spindle ball, X, Y, Z, -X, -Y or -Z, and X, Y, Z the
place of the table ball, both with all rotary axes at 0 and in machine coordinates. Each axis needs
a bar square to it, which tells where it is, and one along it, which tells its direction. An arc of
180 degrees will do. How far the spindle ball is off the spindle tells a dial in X and one in Y:
half of what they read with the spindle at 0 less what they read at 180 degrees. Where the
eccentricities are known already a row has cosine [um] and sine [um] in place of angle and reading,
and --noise is that of an eccentricity.
"""


@click.command(
    "ballbar", epilog=_CIRCLES, short_help="Circular tests with RTCP on: the axes of the table."
)
@click.option("-m", "--machine", metavar="FILE", required=True, help="The machine as it is set.")
@click.option(
    "--spindle-ball",
    type=TWO_LENGTHS,
    default="0,0",
    help="How far the spindle ball is off the spindle.  [default: 0,0, with a warning]",
)
@above_nothing("--bar", "100 mm", "Length of the bar.")
@found_options("Standard deviation of a reading.", "1 um")
def ballbar(
    data: str,
    machine: str,
    bar: float,
    spindle_ball: tuple[float, float],
    noise: float,
    **files: str | None,
) -> None:
    """Turn circular tests with a ballbar into the rotary axes of a table, AC, BC or any other.

    For a trunnion these are the eight errors from axis to axis. Printed are uncertainties, and what
    the check with RTCP on will read. Refused are arcs too short, tests that leave an error open,
    and residuals above 3 times the noise.
    """
    from gcxform.calibrate.ballbar import report as ballbarwords
    from gcxform.calibrate.ballbar.ballbar import identify
    from gcxform.calibrate.ballbar.file import read_circles
    from gcxform.calibrate.rotary.machine import turning, with_axes

    places = Files(**files)
    places.check(data, machine)
    believed = Asked(machine=machine).loaded_machine
    assert believed is not None
    measured = read_circles(path_of(data), noise, bar)
    found = identify(turning(believed), measured.tests, spindle_ball, noise)
    above = partial(ballbarwords.comments, found, file=measured.file)
    text = with_axes(found.chain.table, believed, above) if places.output else ""
    whole = ballbarwords.report(found, measured.file, measured.conditions)
    said = ballbarwords.lines(found)
    hand_out(
        Found(text, whole, said, lambda: plot.circled(found, Path(measured.file).name)), places
    )
