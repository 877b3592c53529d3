"""`gcxform calibrate plan|centres`: where to probe balls, by which program, and what it found."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import click

from gcxform.cli.calibration.shared import check_axis, path_of, write
from gcxform.cli.common.answer import answer
from gcxform.cli.common.options import LENGTH, THREE_LENGTHS, above_nothing, one_of
from gcxform.cli.common.outputs import STDOUT, check_places
from gcxform.cli.common.request import Asked
from gcxform.diagnostics import FileError, UsageError
from gcxform.system import inputs

if TYPE_CHECKING:
    from gcxform.calibrate.bundle.bundle import Poses
    from gcxform.calibrate.bundle.plan import Wanted
    from gcxform.machine.chain import Chain, Triple

_USE = """
The table that is written has a row for each pose: the angles, and X, Y, Z where the probe is at the
centre of the ball. `gcxform simulate balls` reads it, and tells what a calibration would find. The
program probes each ball five times at each pose; LinuxCNC writes the touches to touches.txt, and
`gcxform calibrate centres` makes of them what `calibrate bundle` reads.
"""

_OUTPUT = click.option(
    "-o", "--output", metavar="FILE", default=STDOUT, help="The table.  [default: stdout]"
)


@click.command("plan", epilog=_USE, short_help="Where to probe balls, and the program for it.")
@click.option("-m", "--machine", metavar="FILE", required=True, help="The machine, with limits.")
@click.option(
    "--ball",
    type=THREE_LENGTHS,
    multiple=True,
    required=True,
    help="Where a ball stands, with all rotary axes at 0; once for each.",
)
@click.option(
    "--axis", metavar="A", type=click.Choice([*"ABC"]), help="A circle of this axis alone."
)
@click.option("--tool", metavar="N", type=int, help="The probe: X, Y, Z are then of the axes.")
@click.option(
    "--poses", metavar="N", type=click.IntRange(3), default=60, show_default=True, help="How many."
)
@click.option(
    "--tilt",
    metavar="DEGREES",
    type=click.FloatRange(0.0, 90.0),
    default=80.0,
    show_default=True,
    help="How far table and probe may lean, from Z and each other.",
)
@one_of(
    "--linear", words=["differences", "none"], help="Which errors of the linear axes are unknown."
)
@above_nothing("--noise", "2 um", "Standard deviation of a coordinate of a centre.")
@click.option(
    "-o", "--output", metavar="FILE", default=STDOUT, help="The poses.  [default: stdout]"
)
@click.option("--program", metavar="FILE", help="Write the program that probes them.")
@one_of("-t", "--to", "dialect", words=["linuxcnc", "fanuc"], help="The control of the program.")
@above_nothing("--radius", "15 mm", "Of ball and stylus.")
@above_nothing("--clearance", "5 mm", "Around a touch.")
@click.option("--after-touch", metavar="BLOCK", help="A block of the program that stores a touch.")
def plan(
    machine: str,
    ball: tuple[Triple, ...],
    axis: str | None,
    tool: int | None,
    output: str,
    program: str | None,
    **given: Any,
) -> None:
    """Choose poses inside the limits that tell the rotary axes and the squareness best.

    Printed are the conditioning, and the uncertainties that a bundle of them will have; with --axis
    it is a circle for `calibrate rotary`, at equal steps. A head may turn the probe: the program
    then probes along and across it, and starts with all rotary axes at 0.
    """
    from gcxform.calibrate.bundle.plan import Wanted
    from gcxform.calibrate.bundle.touching import Probing, probing_program
    from gcxform.calibrate.rotary.ball_file import plan_csv
    from gcxform.calibrate.rotary.machine import probing

    check_places({"-o": output, "--program": program}, [machine])
    believed = Asked(machine=machine).loaded_machine
    assert believed is not None
    chain = probing(believed, tool)
    check_axis(axis, chain.letters, believed.name)
    lengths = Probing(given["radius"], given["clearance"])
    room = lengths.radius + lengths.clearance
    wanted = Wanted(given["poses"], room, given["tilt"], given["linear"])
    poses, said = (
        _circle(chain, axis, ball, wanted, given["noise"])
        if axis
        else _bundle(chain, ball, wanted, given["noise"])
    )
    if program:
        text = probing_program(chain, poses, lengths, given["dialect"], given["after_touch"])
        write(program, text)
    write(output, plan_csv(poses, chain.letters, axis))
    answer({"said": said}, said, err=STDOUT in (output, program))


def _bundle(
    chain: Chain, balls: Sequence[Triple], wanted: Wanted, noise: float
) -> tuple[Poses, list[str]]:
    """Return the poses of a bundle, and how well they will tell the axes."""
    from gcxform.calibrate.bundle import report as bundlewords
    from gcxform.calibrate.bundle.plan import planned

    found = planned(chain, balls, wanted, noise)
    return found.layout.poses, bundlewords.expected(found)


def _circle(
    chain: Chain, axis: str, balls: Sequence[Triple], wanted: Wanted, noise: float
) -> tuple[Poses, list[str]]:
    """Return the poses of a circle about one axis, and how well they will tell it."""
    from gcxform.calibrate.bundle.plan import planned_circle
    from gcxform.calibrate.rotary import report as rotarywords
    from gcxform.calibrate.rotary.axis import Centres, locate

    if len(balls) > 1:
        raise UsageError.one("GX728", "a circle of one axis is that of one ball")
    poses = planned_circle(chain, axis, balls[0], wanted)
    k = chain.letters.index(axis)
    tip = chain.tip if axis in [one.letter for one in chain.head] else None
    found = locate(Centres(poses.degrees[:, k], poses.points), noise, tip)
    return poses, rotarywords.expected(found, axis)


@click.command("centres", short_help="Touches of a probing program: the centres of the balls.")
@click.option("-m", "--machine", metavar="FILE", required=True, help="The machine of the plan.")
@click.option("--plan", "poses", metavar="FILE", required=True, help="The poses that were probed.")
@click.option(
    "--axis", metavar="A", type=click.Choice([*"ABC"]), help="The axis of a plan of one axis."
)
@click.option("--radius", type=LENGTH, required=True, help="Of ball and stylus together.")
@_OUTPUT
@click.argument("touches", metavar="TOUCHES")
def centres(
    machine: str, poses: str, axis: str | None, radius: float, output: str, touches: str
) -> None:
    """Turn touches, X Y Z A B C a line as LinuxCNC writes them, into a table of ball centres.

    Five at each pose in the order of the plan, in mm and degrees; A, B and C may be missing.
    """
    from gcxform.calibrate.bundle.touching import centres as found
    from gcxform.calibrate.bundle.touching import parse_touches
    from gcxform.calibrate.rotary.ball_file import plan_csv, read_plan
    from gcxform.calibrate.rotary.machine import turning

    check_places({"-o": output}, [machine, poses, touches])
    believed = Asked(machine=machine).loaded_machine
    assert believed is not None
    chain = turning(believed)
    check_axis(axis, chain.letters, believed.name)
    try:
        text = inputs.read(path_of(touches)).decode("ascii")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "it is not plain text"
        raise FileError.one("GX901", f"cannot read {touches}: {reason}") from None
    plan = read_plan(path_of(poses), chain.letters, axis)
    read = found(chain, plan, parse_touches(text, touches), radius, touches)
    write(output, plan_csv(read, chain.letters, axis))
