"""`gcxform machine`: what a machine file says, to be seen before it is believed."""

from __future__ import annotations

import math
from pathlib import Path

import click

from gcxform import plot
from gcxform.cli import VERBS
from gcxform.cli.common.outputs import STDOUT, check_places, destination
from gcxform.cli.common.request import Asked
from gcxform.diagnostics import Location, UsageError
from gcxform.machine.chain import Chain, chain_of
from gcxform.machine.controls.fanuc import read_fanuc
from gcxform.machine.controls.linuxcnc_hal import UNITS, read_hal
from gcxform.machine.controls.siemens import read_siemens
from gcxform.machine.jog import jog_test
from gcxform.machine.machine import Machine
from gcxform.machine.text import to_toml


@click.group("machine", help=VERBS["machine"], short_help=VERBS["machine"])
def command() -> None:
    """Choose what to do."""


_TOOL = click.option("--tool", metavar="N", type=int, help="A tool of the machine file.")
_MACHINE = click.argument("machine", metavar="MACHINE")


@command.command("jog")
@_TOOL
@click.option("--start", metavar="A=30,C=0", help="Where axes stand.  [default: all at 0]")
@click.option(
    "--step", metavar="DEGREES", type=float, default=10.0, show_default=True, help="The jog."
)
@_MACHINE
def jog(machine: str, tool: int | None, start: str | None, step: float) -> None:
    """Say of each rotary axis which way + turns, and where the tip goes.

    Jog the axes of the machine one by one and compare: a wrong sign or point shows here.
    """
    asked = Asked(machine=machine, start=start)
    chain, loaded = _chain(asked, tool)
    if not chain.axes:
        raise UsageError.one("GX452", "this machine has no rotary axis", Location(machine))
    if not math.isfinite(step):
        raise UsageError.one("GX706", f"{step} is not finite", Location("--step"))
    position = asked.input().start
    for letter in position:
        if letter not in (*"XYZ", *chain.letters):
            message = f"{loaded.name} has no axis {letter}"
            raise UsageError.one("GX707", message, Location("--start"))
    click.echo("\n".join([loaded.name, *jog_test(chain, position, step)]))


@command.command("draw")
@_TOOL
@click.option("-o", "--output", metavar="FILE", required=True, help="The picture: SVG or PNG.")
@_MACHINE
def draw(machine: str, tool: int | None, output: str) -> None:
    """Draw the rotary axes of a machine, all at 0, with the senses of +."""
    plot.check(output, "-o")
    check_places({"-o": output}, [machine])
    chain, loaded = _chain(Asked(machine=machine), tool)
    with destination(output) as put:
        put(plot.rendered(plot.chain(chain, loaded.name), output))


def _chain(asked: Asked, number: int | None) -> tuple[Chain, Machine]:
    """Return the chain of a machine, with the tip of a tool if one is named."""
    machine = asked.loaded_machine
    assert machine is not None
    if number is None:
        return chain_of(machine), machine
    if number not in machine.tools:
        known = ", ".join(map(str, sorted(machine.tools))) or "none"
        message = f"{machine.name} has no tool {number}"
        raise UsageError.one("GX707", message, Location("--tool"), f"known: {known}")
    return chain_of(machine, machine.tools[number]), machine


# --- from controls ---

_OUTPUT = click.option(
    "-o", "--output", metavar="FILE", default=STDOUT, help="The machine file.  [default: stdout]"
)


@command.group("import")
def taken_over() -> None:
    """Turn the kinematics of a control into a machine file."""


@taken_over.command("linuxcnc")
@click.option(
    "--units",
    type=click.Choice(UNITS),
    required=True,
    help="The unit of the machine, which its HAL files do not say.",
)
@_OUTPUT
@click.argument("file", metavar="HAL")
def linuxcnc(file: str, units: str, output: str) -> None:
    """Take over xyzac-trt-kins, xyzbc-trt-kins, 5axiskins or maxkins as HAL or INI files set them.

    Pins have to be set to numbers by setp, or by sets. Lengths of tools are not taken over.
    """
    _write(read_hal(Path(file), units), file, output)


@taken_over.command("fanuc")
@_OUTPUT
@click.argument("file", metavar="PARAMETERS")
def fanuc(file: str, output: str) -> None:
    """Take over the parameters 19666 and 19680 to 19714, such as N19700 P5.0, a line each."""
    _write(read_fanuc(Path(file)), file, output)


@taken_over.command("siemens")
@click.option(
    "--axes", metavar="C,A", required=True, help="First and second rotary axis of the data."
)
@_OUTPUT
@click.argument("file", metavar="DATA")
def siemens(file: str, axes: str, output: str) -> None:
    """Take over a swivel data set ($TC_CARR), or machine data of a five-axis transformation.

    The transformation is the first of the channel, of the type 24, 40 or 56.
    """
    letters = [letter.strip().upper() for letter in axes.split(",")]
    if len(letters) != 2:
        raise UsageError.one("GX707", f"{axes!r} is not two axes", Location("--axes"))
    _write(read_siemens(Path(file), (letters[0], letters[1])), file, output)


def _write(machine: Machine, file: str, output: str) -> None:
    check_places({"-o": output}, [file])
    said = [f"From {Path(file).name}. Compare with the machine: gcxform machine jog"]
    with destination(output) as put:
        put(to_toml(machine, said).encode())
