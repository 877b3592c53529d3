"""`gcxform simulate balls|ballbar-rtcp`: what is read on a machine whose axes are known."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import click
import numpy as np

from gcxform.cli.calibration.shared import check_axis, path_of, write
from gcxform.cli.common.options import SCATTER, THREE_LENGTHS, TWO_LENGTHS
from gcxform.cli.common.outputs import STDOUT, check_places
from gcxform.cli.common.request import Asked
from gcxform.diagnostics import Location, UsageError
from gcxform.machine.chain import Triple
from gcxform.machine.machine import Machine

Command = TypeVar("Command", bound=Callable[..., Any])
_PLAN = """
PLAN is a table as `gcxform calibrate plan` writes it and `calibrate bundle` reads it, with --axis
one as `calibrate rotary` reads it: angles, and X, Y, Z of the first row of each ball, which say
where the ball stands. The output has the same rows, with the readings of X, Y and Z.
"""


def _read_options(command: Command) -> Command:
    """Add what all readings are told."""
    parts = (
        click.option(
            "--true", metavar="FILE", required=True, help="The machine file of the axes there are."
        ),
        click.option("--noise", type=SCATTER, default="0", help="Standard deviation of a reading."),
        click.option(
            "--seed", metavar="N", type=click.IntRange(0), default=0, help="Seed of the noise."
        ),
        click.option(
            "-o", "--output", metavar="FILE", default=STDOUT, help="The table.  [default: stdout]"
        ),
    )
    for part in reversed(parts):
        command = part(command)
    return command


@click.command("balls", epilog=_PLAN, short_help="Balls at poses, for `calibrate rotary|bundle`.")
@_read_options
@click.option("--axis", metavar="A", type=click.Choice([*"ABC"]), help="The one axis that turns.")
@click.option("--tool", metavar="N", type=int, help="The probe: X, Y, Z are then of the axes.")
@click.argument("plan", metavar="PLAN")
def balls(
    plan: str, true: str, noise: float, seed: int, output: str, axis: str | None, tool: int | None
) -> None:
    """Centres of balls at poses, as `calibrate rotary` and `calibrate bundle` read them.

    The errors of the linear axes are those of the error model that the machine file names.
    """
    from gcxform.calibrate.rotary.ball_file import plan_csv, read_plan
    from gcxform.calibrate.rotary.machine import probing
    from gcxform.simulate.balls import simulate_poses

    check_places({"-o": output}, [plan, true])
    machine = _machine(true)
    chain, model = probing(machine, tool), _errors(machine)
    generator = np.random.default_rng(seed)
    check_axis(axis, chain.letters, machine.name)
    poses = read_plan(path_of(plan), chain.letters, axis)
    read = simulate_poses(chain, poses, model, noise=noise, generator=generator)
    write(output, plan_csv(read, chain.letters, axis))


@click.command("ballbar-rtcp", short_help="Circles with RTCP on, for `calibrate ballbar`.")
@click.option("-m", "--machine", metavar="FILE", required=True, help="The machine as it is set.")
@click.option(
    "--ball", type=THREE_LENGTHS, required=True, help="The table ball, with all rotary axes at 0."
)
@click.option(
    "--spindle-ball",
    type=TWO_LENGTHS,
    default="0,0",
    help="What the spindle ball is off the spindle.",
)
@click.option(
    "--samples",
    metavar="N",
    type=click.IntRange(3),
    default=181,
    show_default=True,
    help="Readings a test.",
)
@_read_options
def ballbar_rtcp(
    machine: str,
    true: str,
    ball: Triple,
    spindle_ball: tuple[float, float],
    samples: int,
    noise: float,
    seed: int,
    output: str,
) -> None:
    """Circular tests with RTCP on, as `gcxform calibrate ballbar` reads them.

    There are two of each axis of the table: the bar, 100 mm long, is square to the axis in the
    first and along it in the second. Arcs are the limits of the axes in the machine file that is
    set.
    """
    from gcxform.calibrate.ballbar.file import circles_csv
    from gcxform.calibrate.rotary.machine import turning
    from gcxform.simulate.ballbar import simulate_tests, standard_setups

    check_places({"-o": output}, [machine, true])
    control, actual = turning(_machine(machine)), turning(_machine(true))
    if control.letters != actual.letters:
        message = f"{machine} and {true} have other axes"
        raise UsageError.one("GX707", message, Location("--true"))
    if not control.table:
        message = f"no rotary axis of {machine} turns a table"
        raise UsageError.one("GX707", message, Location("--machine"))
    tests = standard_setups(control, ball)
    traces = simulate_tests(control, actual, tests, samples, spindle_ball, noise=noise, seed=seed)
    write(output, circles_csv(traces))


def _machine(name: str) -> Machine:
    machine = Asked(machine=name).loaded_machine
    assert machine is not None
    return machine


def _errors(machine: Machine) -> Any:
    """Return the error model that a machine file names, if it does."""
    from gcxform.errormodel.model_file import load_model
    from gcxform.plugin.registry import default_registry

    if machine.errors is None:
        return None
    return load_model(Path(machine.errors), tuple(default_registry().formats.values()))
